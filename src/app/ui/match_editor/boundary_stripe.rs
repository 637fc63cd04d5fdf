//! Coloured stripe along the boundary loops in the match editor. Along a loop, the hue runs once
//! around the colour circle.
//!
//! Lightness and chroma are constant in the colour space Oklch (Ottosson 2020), so that no stretch
//! of the boundary stands out. Their values depend on whether the background is light or dark.

use bevy::color::{Oklcha, Srgba};
use bevy_egui::egui::{Color32, Mesh, Painter, Pos2, Shape, Vec2, vec2};

/// Width of the stripe without its soft edges, in points.
const WIDTH: f32 = 3.5;

/// Width of the soft edge on each side of the stripe, in points; it replaces anti-aliasing.
const SOFT_EDGE: f32 = 0.8;

/// Minimum distance between two successive vertices of the stripe, in points (tolerance: the
/// direction between closer vertices is unstable).
const MIN_SPACING: f32 = 0.4;

/// Maximum length of a mitre, as a multiple of half the stripe's width (tolerance: longer mitres
/// would be spikes at sharp corners).
const MAX_MITRE: f32 = 1.6;

/// Returns the stripe's colour at `place`, the position along a boundary loop from 0 to 1. `ring`
/// is the index of the loop; each loop starts at a different hue.
pub fn colour(place: f64, ring: usize, is_light: bool) -> Color32 {
    // 77 and 360 are coprime, so the first 360 loops all start at different hues.
    let hue = (360.0 * place as f32 + 77.0 * ring as f32).rem_euclid(360.0);
    // Only a chroma up to 0.10 fits into sRGB for every hue, but it looks grey. The chroma is
    // therefore higher, and sRGB channels outside [0, 1] are clamped.
    let (lightness, chroma) = if is_light { (0.60, 0.15) } else { (0.74, 0.14) };
    let srgb = Srgba::from(Oklcha::lch(lightness, chroma, hue));
    let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
    Color32::from_rgb(byte(srgb.red), byte(srgb.green), byte(srgb.blue))
}

/// Draws the stripe along the boundary loop with the index `ring`. `places` are the positions of
/// `points` along the loop, from 0 to 1.
pub fn stripe(painter: &Painter, points: &[Pos2], places: &[f64], ring: usize, is_light: bool) {
    let mut samples: Vec<(Pos2, Color32)> = Vec::with_capacity(points.len() + 1);
    let ends = points.first().map(|p| (*p, 1.0));
    for (p, place) in points
        .iter()
        .copied()
        .zip(places.iter().copied())
        .chain(ends)
    {
        // Points that are too close to the previous vertex are skipped.
        if samples
            .last()
            .is_none_or(|(q, _)| q.distance(p) >= MIN_SPACING)
        {
            samples.push((p, colour(place, ring, is_light)));
        }
    }
    // A loop needs three different vertices; the first one is repeated at the end.
    if samples.len() < 4 {
        return;
    }
    let n = samples.len() - 1; // the last point repeats the first
    let mut mesh = Mesh::default();
    for (k, (p, colour)) in samples.iter().enumerate() {
        let before = samples[(k + n - 1) % n].0;
        let after = samples[(k + 1) % n].0;
        let across = mitre(*p - before, after - *p);
        let transparent = Color32::TRANSPARENT;
        let half = WIDTH / 2.0;
        // egui anti-aliases shapes but not meshes, so the outer vertices are transparent.
        mesh.colored_vertex(*p + across * (half + SOFT_EDGE), transparent);
        mesh.colored_vertex(*p + across * half, *colour);
        mesh.colored_vertex(*p - across * half, *colour);
        mesh.colored_vertex(*p - across * (half + SOFT_EDGE), transparent);
        if k > 0 {
            let (old, new) = (4 * (k as u32 - 1), 4 * k as u32);
            for row in 0..3 {
                mesh.add_triangle(old + row, old + row + 1, new + row);
                mesh.add_triangle(old + row + 1, new + row, new + row + 1);
            }
        }
    }
    painter.add(Shape::mesh(mesh));
}

/// Returns the offset from a corner of the centre line to the corner of the stripe's edge (mitre),
/// for a stripe whose half width is 1. `incoming` and `outgoing` are the edges of the centre line
/// at the corner. The offset is at most [`MAX_MITRE`] long.
fn mitre(incoming: Vec2, outgoing: Vec2) -> Vec2 {
    let (a, b) = (incoming.normalized(), outgoing.normalized());
    let across = |v: Vec2| vec2(v.y, -v.x);
    let sum = across(a) + across(b);
    let length = sum.length();
    if length < 1e-3 {
        return across(a);
    }
    // Let α be the angle between the two edges. Then `length` is 2 cos(α / 2), and the offset must
    // be 2 / `length` = 1 / cos(α / 2) long.
    sum / length * (2.0 / length).min(MAX_MITRE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_has_a_mitre_of_one() {
        let across = mitre(vec2(2.0, 0.0), vec2(5.0, 0.0));
        assert!((across - vec2(0.0, -1.0)).length() < 1e-6);
        let corner = mitre(vec2(1.0, 0.0), vec2(0.0, 1.0));
        assert!((corner.length() - std::f32::consts::SQRT_2).abs() < 1e-5);
        assert!(mitre(vec2(1.0, 0.0), vec2(-1.0, 0.01)).length() <= MAX_MITRE + 1e-5);
    }

    #[test]
    fn hues_close_the_circle() {
        assert_eq!(colour(0.0, 0, true), colour(1.0, 0, true));
        assert_ne!(colour(0.0, 0, true), colour(0.5, 0, true));
    }
}
