//! Vertices of render meshes: layouts for faces, wireframes, bars with joints and outlines, and
//! functions that write their positions.
//!
//! Guaranteed: each layout is created once, and later only its positions are rewritten, in place.
//! Positions are `f32` relative to an origin, which is subtracted in double precision, so that
//! designs far from zero keep their precision.

use bevy::mesh::{Mesh, VertexAttributeValues};
use glam::DVec2;

use crate::colour::Paint;
use crate::content::{InkedBars, SolidContent};
use crate::export::{JOINT_CORE_RADIUS, JOINT_RADIUS};
use crate::transition::VectorFigure;

/// Half the side of the quad that contains a bar or disc, as a multiple of the radius of the shape.
/// Derived: for shapes at least two pixels across, the extra half radius contains the half pixel by
/// which an anti-aliased edge exceeds the shape.
const MARGIN: f32 = 1.5;

/// Maximum distance of a mitred corner from the corner of the outline, in half line widths (the
/// default limit of SVG).
const MITRE_LIMIT: f64 = 4.0;

/// Vertex positions of a render mesh, which are rewritten in each frame.
pub(super) type VertexPositions = [[f32; 3]];

/// Returns the position of the point `p` relative to `origin`, as a render mesh stores it.
fn vertex(p: DVec2, origin: DVec2) -> [f32; 3] {
    let p = (p - origin).as_vec2();
    [p.x, p.y, 0.0]
}

/// Returns the vertex positions of a render mesh, to be changed in place.
pub(super) fn positions(mesh: &mut Mesh) -> &mut VertexPositions {
    match mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION) {
        Some(VertexAttributeValues::Float32x3(positions)) => positions,
        // This case does not occur: all render meshes are created with positions of this type.
        _ => &mut [],
    }
}

/// Writes one vertex position per point.
pub(super) fn write_points(points: &[DVec2], origin: DVec2, out: &mut VertexPositions) {
    for (out, &p) in out.iter_mut().zip(points) {
        *out = vertex(p, origin);
    }
}

/// Writes three vertex positions per face, for meshes whose faces do not share vertices.
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

/// Returns the first two barycentric coordinates of each corner in its own triangle, for `faces`
/// triangles.
pub(super) fn corner_coordinates(faces: usize) -> Vec<[f32; 2]> {
    [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]].repeat(faces)
}

/// Returns the vertex indices of the two triangles of each quad; a quad has four consecutive
/// vertices.
pub(super) fn quad_indices(quads: usize) -> Vec<u32> {
    let corners = |q: u32| [0, 1, 2, 2, 1, 3].map(|k| 4 * q + k);
    (0..quads as u32).flat_map(corners).collect()
}

/// All bars that have the same paints, and the discs at their ends. The mesh has a quad for each
/// bar, followed by a quad for the disc at each node, in ascending order of the node indices.
#[derive(Clone, Debug)]
pub(super) struct BarShapes {
    /// Paints of the bars in the source and in the target; `None` is the colour of the style.
    pub(super) paints: [Option<Paint>; 2],
    /// Height of these bars in the drawing order of all bars, from 0 (lowest) to below 1.
    pub(super) z_fraction: f32,
    bars: Vec<[u32; 2]>,
    nodes: Vec<u32>,
    bar_width: f64,
}

impl BarShapes {
    /// Groups the bars of a solid by paint, in drawing order.
    pub(super) fn grouped_by_paint(solid: &SolidContent) -> Vec<Self> {
        let all = InkedBars::grouped_by_paint(solid.bars.len(), &solid.bar_paints);
        let count = all.len() as f32;
        let of = |(k, inked): (usize, &InkedBars)| Self::new(solid, inked, k as f32 / count);
        all.iter().enumerate().map(of).collect()
    }

    fn new(solid: &SolidContent, inked: &InkedBars, height: f32) -> Self {
        let bars: Vec<[u32; 2]> = inked.bars.iter().map(|&bar| solid.bars[bar]).collect();
        let mut nodes = bars.as_flattened().to_vec();
        // Bars that meet share one disc: its anti-aliased edge would be darker if it were drawn
        // twice.
        nodes.sort_unstable();
        nodes.dedup();
        Self {
            paints: inked.paints,
            z_fraction: height,
            bars,
            nodes,
            bar_width: solid.bar_width,
        }
    }

    /// Returns, for each vertex that [`Self::write`] writes, its position relative to the axis of
    /// the bar or the centre of the disc, in units of the radius. A fragment is inside the shape if
    /// the interpolated vector is shorter than 1.
    pub(super) fn coordinates(&self) -> Vec<[f32; 2]> {
        let across = [-MARGIN, MARGIN, -MARGIN, MARGIN].map(|v| [0.0, v]);
        let mut out = across.repeat(self.bars.len());
        out.extend(disc_coordinates(self.nodes.len()));
        out
    }

    /// Returns, for each vertex that [`Self::write_cores`] writes, its position relative to the
    /// centre of the core, in units of the core's radius.
    pub(super) fn core_coordinates(&self) -> Vec<[f32; 2]> {
        disc_coordinates(self.nodes.len())
    }

    /// Writes the quads of the bars and of the discs at their ends. With `joints` the discs are
    /// wider than the bars; otherwise they only round the ends.
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
            // A bar without length has no direction; its quad has no area, and only its discs are
            // visible.
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

    /// Writes the quads of the cores of the joints: smaller discs in a lighter colour, one on each
    /// joint.
    pub(super) fn write_cores(&self, points: &[DVec2], origin: DVec2, out: &mut VertexPositions) {
        self.write_discs(points, JOINT_CORE_RADIUS * self.bar_width, origin, out);
    }

    /// Writes the quad of a disc of the given radius at each node.
    fn write_discs(&self, points: &[DVec2], radius: f64, origin: DVec2, out: &mut VertexPositions) {
        let reach = radius * f64::from(MARGIN);
        for (quad, &node) in out.as_chunks_mut::<4>().0.iter_mut().zip(&self.nodes) {
            let centre = points[node as usize];
            *quad = CORNERS.map(|c| vertex(centre + c * reach, origin));
        }
    }
}

/// Corners of the quad of a disc, in units of half its side.
const CORNERS: [DVec2; 4] = [
    DVec2::new(-1.0, -1.0),
    DVec2::new(-1.0, 1.0),
    DVec2::new(1.0, -1.0),
    DVec2::new(1.0, 1.0),
];

/// Returns the positions of the quad corners of `discs` discs relative to the centres of the discs,
/// in units of the radius.
fn disc_coordinates(discs: usize) -> Vec<[f32; 2]> {
    CORNERS
        .map(|c| (c.as_vec2() * MARGIN).to_array())
        .repeat(discs)
}

/// Lines of constant width on the screen: one quad per line segment, which the vertex shader widens
/// by moving its corners apart.
///
/// Segments of an outline meet along their mitre and do not overlap; if they did, dots would be
/// visible where anti-aliased edges are drawn twice.
#[derive(Clone, Debug, Default)]
pub(super) struct OutlineSegments {
    /// For each corner of a quad: the position of the line segment's end at which the corner lies
    /// before the segment is widened.
    pub(super) positions: Vec<[f32; 3]>,
    /// For each corner of a quad: its offset (x, y) from the nearer end of the line segment, in
    /// half line widths, and the side of the segment on which the corner lies, −1 or 1.
    pub(super) offsets: Vec<[f32; 3]>,
}

impl OutlineSegments {
    /// Collects the outlines of a figure and the centre lines of its bars.
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

    /// Adds an invisible line segment, since a mesh must not be empty.
    pub(super) fn push_nothing(&mut self) {
        self.push([DVec2::ZERO; 2], [DVec2::ZERO; 2], DVec2::ZERO);
    }

    /// Returns the number of quads, one per line segment.
    pub(super) fn quads(&self) -> usize {
        self.positions.len() / 4
    }

    /// Adds the line segments of a closed outline.
    fn push_ring(&mut self, ring: &[DVec2], origin: DVec2) {
        let n = ring.len();
        let across = |i: usize| (ring[(i + 1) % n] - ring[i % n]).normalize_or_zero().perp();
        for i in 0..n {
            let here = across(i);
            let mitres = [mitre(across(i + n - 1), here), mitre(here, across(i + 1))];
            self.push([ring[i], ring[(i + 1) % n]], mitres, origin);
        }
    }

    /// Adds the quad of a line segment. `offsets` are the offsets of the quad's left corners from
    /// the two ends of the segment, in half line widths.
    fn push(&mut self, ends: [DVec2; 2], offsets: [DVec2; 2], origin: DVec2) {
        for (p, offset) in ends.into_iter().zip(offsets) {
            // Both corners at an end have the same position; the vertex shader separates them.
            for side in [-1.0, 1.0] {
                let offset = offset.as_vec2() * side;
                self.positions.push(vertex(p, origin));
                self.offsets.push([offset.x, offset.y, side]);
            }
        }
    }
}

/// Returns the offset from a corner of an outline to its mitre point, in half line widths: the
/// point has the distance 1 from both edges. `a` and `b` are the unit normals of the edges. Offsets
/// longer than [`MITRE_LIMIT`] are shortened.
fn mitre(a: DVec2, b: DVec2) -> DVec2 {
    let sum = a + b;
    let length = (2.0 / sum.length()).min(MITRE_LIMIT);
    // The sum is zero if the outline reverses its direction at the corner.
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
        let all = BarShapes::grouped_by_paint(&solid);
        (points, all.into_iter().next().expect("bars"))
    }

    /// Interpolates the `coordinates` of the quad's corners at the point `p` of the plane, and
    /// returns the length of the resulting vector. The length is 1 on the edge of the shape.
    fn reach(quad: &[[f32; 3]], coordinates: &[[f32; 2]], p: [f32; 2]) -> f32 {
        // Quads are parallelograms; edges lead from corner 0 to corners 1 and 2.
        let at = |k: usize| glam::Vec2::new(quad[k][0], quad[k][1]);
        let edges = glam::Mat2::from_cols(at(1) - at(0), at(2) - at(0));
        let w = edges.inverse() * (glam::Vec2::from(p) - at(0));
        let c = |k: usize| glam::Vec2::from(coordinates[k]);
        (c(0) + (c(1) - c(0)) * w.x + (c(2) - c(0)) * w.y).length()
    }

    #[test]
    fn bars_have_their_width() {
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
        // At the right angle, the mitre is diagonal; the quads of both segments end at it.
        assert_eq!(segments.offsets[1], [1.0, 1.0, 1.0]);
        assert_eq!(segments.offsets[11], segments.offsets[1]);
    }
}
