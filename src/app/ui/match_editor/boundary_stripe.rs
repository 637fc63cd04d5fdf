//! A boundary whose colour runs once round the circle of hues along its way.
//!
//! The colours have one lightness and one chroma in Oklch (Ottosson 2020), so that no part of the
//! boundary stands out; lightness follows the ground.

use bevy::color::{Oklcha, Srgba};
use bevy_egui::egui::{Color32, Mesh, Painter, Pos2, Shape, Vec2, vec2};

/// Width of the stripe in points.
const WIDTH: f32 = 3.5;

/// Width of its soft edges.
const SOFT: f32 = 0.8;

/// Points nearer than this to the one before are not drawn.
const LEAST: f32 = 0.4;

/// The longest mitre, in half widths.
const LONGEST_MITRE: f32 = 1.6;

/// The colour at a place of a ring: rings start at different hues.
pub fn colour(place: f64, ring: usize, is_light: bool) -> Color32 {
    // 77 and 360 have no common divisor: no ring begins like another before there are 360.
    let hue = (360.0 * place as f32 + 77.0 * ring as f32).rem_euclid(360.0);
    // A chroma that sRGB has for every hue, 0.10, is too grey; what lies beyond is clamped below.
    let (lightness, chroma) = if is_light { (0.60, 0.15) } else { (0.74, 0.14) };
    let srgb = Srgba::from(Oklcha::lch(lightness, chroma, hue));
    let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0).round() as u8;
    Color32::from_rgb(byte(srgb.red), byte(srgb.green), byte(srgb.blue))
}

/// Draws a closed boundary with its colours.
pub fn stripe(painter: &Painter, points: &[Pos2], places: &[f64], ring: usize, is_light: bool) {
    let mut way: Vec<(Pos2, Color32)> = Vec::with_capacity(points.len() + 1);
    let ends = points.first().map(|p| (*p, 1.0));
    for (p, place) in points
        .iter()
        .copied()
        .zip(places.iter().copied())
        .chain(ends)
    {
        // Between points that lie on each other there is no direction to be across.
        if way.last().is_none_or(|(q, _)| q.distance(p) >= LEAST) {
            way.push((p, colour(place, ring, is_light)));
        }
    }
    // Three points and the first again: less encloses nothing.
    if way.len() < 4 {
        return;
    }
    let n = way.len() - 1; // the last point is the first again
    let mut mesh = Mesh::default();
    for (k, (p, colour)) in way.iter().enumerate() {
        let before = way[(k + n - 1) % n].0;
        let after = way[(k + 1) % n].0;
        let across = mitre(*p - before, after - *p);
        let clear = Color32::TRANSPARENT;
        let half = WIDTH / 2.0;
        // Egui smooths the edges of shapes and not those of meshes: the outer rows fade.
        mesh.colored_vertex(*p + across * (half + SOFT), clear);
        mesh.colored_vertex(*p + across * half, *colour);
        mesh.colored_vertex(*p - across * half, *colour);
        mesh.colored_vertex(*p - across * (half + SOFT), clear);
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

/// Across a bend, as long as half the stripe is wide there; no longer than a sharp corner allows.
fn mitre(incoming: Vec2, outgoing: Vec2) -> Vec2 {
    let (a, b) = (incoming.normalized(), outgoing.normalized());
    let across = |v: Vec2| vec2(v.y, -v.x);
    let sum = across(a) + across(b);
    let length = sum.length();
    if length < 1e-3 {
        return across(a);
    }
    // |sum| = 2 cos(half the turn), and the mitre is 1 / cos of it.
    sum / length * (2.0 / length).min(LONGEST_MITRE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_way_has_a_mitre_of_one() {
        let across = mitre(vec2(2.0, 0.0), vec2(5.0, 0.0));
        assert!((across - vec2(0.0, -1.0)).length() < 1e-6);
        let corner = mitre(vec2(1.0, 0.0), vec2(0.0, 1.0));
        assert!((corner.length() - std::f32::consts::SQRT_2).abs() < 1e-5);
        assert!(mitre(vec2(1.0, 0.0), vec2(-1.0, 0.01)).length() <= LONGEST_MITRE + 1e-5);
    }

    #[test]
    fn hues_close_the_circle() {
        assert_eq!(colour(0.0, 0, true), colour(1.0, 0, true));
        assert_ne!(colour(0.0, 0, true), colour(0.5, 0, true));
    }
}
