//! The vertices behind the stage's pictures, as plain numbers: faces, bars with
//! joints, wires and outlines.
//!
//! Guarantees: each layout is made once and only its positions are rewritten,
//! in place; positions are `f32` relative to an origin, converted here and
//! nowhere else, so that designs far from zero keep their precision.

use bevy::mesh::{Mesh, VertexAttributeValues};
use glam::DVec2;

use crate::colour::Paint;
use crate::content::{InkedBars, SolidContent};
use crate::export::{JOINT_CORE_RADIUS, JOINT_RADIUS};
use crate::transition::VectorFigure;

/// How far a bar's or disc's quad reaches beyond its edge, as a multiple of its
/// radius, so that the shader has room to fade it out: half a pixel, which
/// shapes from two pixels across on have.
const MARGIN: f32 = 1.5;

/// How far a line's corner may stand out, in half line widths: the usual
/// limit of SVG.
const MITRE_LIMIT: f64 = 4.0;

/// Vertices of a render mesh that are rewritten each frame.
pub(super) type VertexPositions = [[f32; 3]];

fn vertex(p: DVec2, origin: DVec2) -> [f32; 3] {
    let p = (p - origin).as_vec2();
    [p.x, p.y, 0.0]
}

/// A mesh's positions, to be changed in place.
pub(super) fn positions(mesh: &mut Mesh) -> &mut VertexPositions {
    match mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        Some(VertexAttributeValues::Float32x3(positions)) => positions,
        // Parts are made with positions of this kind alone.
        _ => &mut [],
    }
}

/// One vertex for each point.
pub(super) fn write_points(points: &[DVec2], origin: DVec2, out: &mut VertexPositions) {
    for (out, &p) in out.iter_mut().zip(points) {
        *out = vertex(p, origin);
    }
}

/// Three vertices for each face, shared with no other.
pub(super) fn write_corners(
    points: &[DVec2],
    faces: &[[u32; 3]],
    origin: DVec2,
    out: &mut VertexPositions,
) {
    for (out, &i) in out.iter_mut().zip(faces.as_flattened()) {
        *out = vertex(points[i as usize], origin);
    }
}

/// Where each corner of each face is in its triangle: two of its three
/// barycentric coordinates.
pub(super) fn corner_coordinates(faces: usize) -> Vec<[f32; 2]> {
    [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]].repeat(faces)
}

/// Two triangles for each quad of four vertices in a row.
pub(super) fn quad_indices(quads: usize) -> Vec<u32> {
    let corners = |q: u32| [0, 1, 2, 2, 1, 3].map(|k| 4 * q + k);
    (0..quads as u32).flat_map(corners).collect()
}

/// Bars and the discs at their ends: a quad for each bar, then one for each
/// node that a bar holds, lowest index first.
#[derive(Clone, Debug)]
pub(super) struct BarShapes {
    /// Their paints in source and target.
    pub(super) paints: [Option<Paint>; 2],
    /// How much of all bars lies below them, from 0 to 1.
    pub(super) height: f32,
    bars: Vec<[u32; 2]>,
    nodes: Vec<u32>,
    bar_width: f64,
}

impl BarShapes {
    /// Those that are painted alike, in the order in which they are drawn.
    pub(super) fn all(solid: &SolidContent) -> Vec<Self> {
        let all = InkedBars::all(solid.bars.len(), &solid.bar_paints);
        let count = all.len() as f32;
        let of = |(k, inked): (usize, &InkedBars)| Self::new(solid, inked, k as f32 / count);
        all.iter().enumerate().map(of).collect()
    }

    fn new(solid: &SolidContent, inked: &InkedBars, height: f32) -> Self {
        let bars: Vec<[u32; 2]> = inked.bars.iter().map(|&bar| solid.bars[bar]).collect();
        let mut nodes = bars.as_flattened().to_vec();
        // Bars that meet share their disc: drawn twice its smooth edge would be
        // darker.
        nodes.sort_unstable();
        nodes.dedup();
        Self {
            paints: inked.paints,
            height,
            bars,
            nodes,
            bar_width: solid.bar_width,
        }
    }

    /// For each vertex of [`Self::write`], where it is in units of the shape's
    /// radius: inside is where this vector is shorter than 1.
    pub(super) fn coordinates(&self) -> Vec<[f32; 2]> {
        let across = [-MARGIN, MARGIN, -MARGIN, MARGIN].map(|v| [0.0, v]);
        let mut out = across.repeat(self.bars.len());
        out.extend(disc_coordinates(self.nodes.len()));
        out
    }

    /// The same for [`Self::write_cores`].
    pub(super) fn core_coordinates(&self) -> Vec<[f32; 2]> {
        disc_coordinates(self.nodes.len())
    }

    /// Bars of the given width; with `joints` discs wider than the bars at
    /// their ends, else just round ends.
    pub(super) fn write(
        &self,
        points: &[DVec2],
        joints: bool,
        origin: DVec2,
        out: &mut VertexPositions,
    ) {
        let half_width = 0.5 * self.bar_width;
        let (bars, discs) = out.split_at_mut(4 * self.bars.len());
        for (quad, &[a, b]) in bars.as_chunks_mut::<4>().0.iter_mut().zip(&self.bars) {
            let (a, b) = (points[a as usize], points[b as usize]);
            // A bar without length has no direction, and shows as the disc at
            // its end.
            let across = (b - a).normalize_or_zero().perp() * half_width * f64::from(MARGIN);
            *quad = [a - across, a + across, b - across, b + across].map(|p| vertex(p, origin));
        }
        let radius = if joints {
            JOINT_RADIUS * self.bar_width
        } else {
            half_width
        };
        self.write_discs(points, radius, origin, discs);
    }

    /// The lighter cores of the joints.
    pub(super) fn write_cores(&self, points: &[DVec2], origin: DVec2, out: &mut VertexPositions) {
        self.write_discs(points, JOINT_CORE_RADIUS * self.bar_width, origin, out);
    }

    fn write_discs(&self, points: &[DVec2], radius: f64, origin: DVec2, out: &mut VertexPositions) {
        let reach = radius * f64::from(MARGIN);
        for (quad, &node) in out.as_chunks_mut::<4>().0.iter_mut().zip(&self.nodes) {
            let centre = points[node as usize];
            *quad = CORNERS.map(|c| vertex(centre + c * reach, origin));
        }
    }
}

const CORNERS: [DVec2; 4] = [
    DVec2::new(-1.0, -1.0),
    DVec2::new(-1.0, 1.0),
    DVec2::new(1.0, -1.0),
    DVec2::new(1.0, 1.0),
];

fn disc_coordinates(discs: usize) -> Vec<[f32; 2]> {
    CORNERS
        .map(|c| (c.as_vec2() * MARGIN).to_array())
        .repeat(discs)
}

/// Lines of constant width on the screen: a quad for each segment, whose vertex
/// shader pushes the corners apart.
///
/// Segments of an outline meet along the mitre, so that none overlaps its
/// neighbour: smooth edges drawn twice would show as dots.
#[derive(Clone, Debug, Default)]
pub(super) struct OutlineSegments {
    /// The segment's end that the corner belongs to.
    pub(super) positions: Vec<[f32; 3]>,
    /// Where the corner is pushed, in half line widths, and its side, −1 or 1.
    pub(super) offsets: Vec<[f32; 3]>,
}

impl OutlineSegments {
    /// The outlines and the bars' middle lines of a figure.
    pub(super) fn of(figure: &VectorFigure, origin: DVec2) -> Self {
        let mut segments = Self::default();
        for ring in &figure.rings {
            segments.push_ring(ring, origin);
        }
        for &[a, b] in &figure.bars {
            let across = (b - a).normalize_or_zero().perp();
            segments.push([a, b], [across, across], origin);
        }
        segments
    }

    /// A segment that is not seen.
    pub(super) fn push_nothing(&mut self) {
        self.push([DVec2::ZERO; 2], [DVec2::ZERO; 2], DVec2::ZERO);
    }

    /// How many quads there are.
    pub(super) fn quads(&self) -> usize {
        self.positions.len() / 4
    }

    fn push_ring(&mut self, ring: &[DVec2], origin: DVec2) {
        let n = ring.len();
        let across = |i: usize| (ring[(i + 1) % n] - ring[i % n]).normalize_or_zero().perp();
        for i in 0..n {
            let here = across(i);
            let mitres = [mitre(across(i + n - 1), here), mitre(here, across(i + 1))];
            self.push([ring[i], ring[(i + 1) % n]], mitres, origin);
        }
    }

    fn push(&mut self, ends: [DVec2; 2], offsets: [DVec2; 2], origin: DVec2) {
        for (p, offset) in ends.into_iter().zip(offsets) {
            // Two corners in the same place: the vertex shader parts them.
            for side in [-1.0, 1.0] {
                let offset = offset.as_vec2() * side;
                self.positions.push(vertex(p, origin));
                self.offsets.push([offset.x, offset.y, side]);
            }
        }
    }
}

/// Where two lines with the given unit normals have their common corner, one
/// unit off both; sharp corners are cut at [`MITRE_LIMIT`].
fn mitre(a: DVec2, b: DVec2) -> DVec2 {
    let sum = a + b;
    let length = (2.0 / sum.length()).min(MITRE_LIMIT);
    // Where an outline turns straight back, the sum is zero.
    sum.normalize_or(b) * length
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> (Vec<DVec2>, BarShapes) {
        let points = vec![DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 3.0)];
        let solid = SolidContent {
            loops: vec![],
            bars: vec![[0, 1], [1, 2], [2, 0]],
            bar_width: 0.2,
            ..SolidContent::default()
        };
        let all = BarShapes::all(&solid);
        (points, all.into_iter().next().expect("bars"))
    }

    /// Interpolates the shape's own coordinates at a point of the plane.
    fn reach(quad: &[[f32; 3]], coordinates: &[[f32; 2]], p: [f32; 2]) -> f32 {
        // Quads are parallelograms: corner 0, and edges to corners 1 and 2.
        let at = |k: usize| glam::Vec2::new(quad[k][0], quad[k][1]);
        let edges = glam::Mat2::from_cols(at(1) - at(0), at(2) - at(0));
        let w = edges.inverse() * (glam::Vec2::from(p) - at(0));
        let c = |k: usize| glam::Vec2::from(coordinates[k]);
        (c(0) + (c(1) - c(0)) * w.x + (c(2) - c(0)) * w.y).length()
    }

    #[test]
    fn bars_are_as_wide_as_they_should_be() {
        let (points, shapes) = triangle();
        let mut out = vec![[0.0; 3]; shapes.coordinates().len()];
        shapes.write(&points, true, DVec2::ZERO, &mut out);
        let coordinates = shapes.coordinates();
        assert_eq!(coordinates.len(), out.len());
        for x in [0.0, 1.0, 4.0] {
            let edge = reach(&out[0..4], &coordinates[0..4], [x, 0.1]);
            assert!((edge - 1.0).abs() < 1e-5, "{edge}");
            assert!(reach(&out[0..4], &coordinates[0..4], [x, 0.0]) < 1e-5);
        }
    }

    #[test]
    fn each_node_has_one_joint_of_the_exporters_size() {
        let (points, shapes) = triangle();
        assert_eq!(shapes.core_coordinates().len(), 4 * 3);
        let mut out = vec![[0.0; 3]; shapes.coordinates().len()];
        let coordinates = shapes.coordinates();
        for (joints, radius) in [(true, 0.2 * JOINT_RADIUS as f32), (false, 0.1)] {
            shapes.write(&points, joints, DVec2::ZERO, &mut out);
            let edge = reach(&out[12..16], &coordinates[12..16], [0.0, radius]);
            assert!((edge - 1.0).abs() < 1e-5, "{edge}");
        }
    }

    #[test]
    fn designs_far_away_keep_their_precision() {
        let far = DVec2::new(1e9, -1e9);
        let points = [far + DVec2::new(0.001, 0.002)];
        let mut out = [[0.0; 3]];
        write_points(&points, far, &mut out);
        assert!((out[0][0] - 0.001).abs() < 1e-6 && (out[0][1] - 0.002).abs() < 1e-6);
    }

    #[test]
    fn an_outline_is_closed() {
        let figure = VectorFigure {
            rings: vec![vec![DVec2::ZERO, DVec2::X, DVec2::Y]],
            ..VectorFigure::default()
        };
        let segments = OutlineSegments::of(&figure, DVec2::ZERO);
        assert_eq!(segments.quads(), 3);
        assert_eq!(segments.positions[10], [0.0, 0.0, 0.0]);
        // The right angle's mitre is a diagonal, shared by both its segments.
        assert_eq!(segments.offsets[1], [1.0, 1.0, 1.0]);
        assert_eq!(segments.offsets[11], segments.offsets[1]);
    }
}
