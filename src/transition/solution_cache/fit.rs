//! Checks that a stored motion belongs to two outlines. A project file may come from anybody, and
//! its key says only for which outlines the motion is meant.

use crate::compatible::CompatibleMesh;
use crate::correspondence::{PieceMatch, RingMatch};
use crate::geometry::{Bounds, DVec2, Regions, Side, signed_area};
use std::collections::HashSet;
use std::f64::consts::PI;

/// Maximum distance of a vertex from the outlines, in diameters of both together (tolerance: parts
/// that appear start close to the outlines).
const MAX_DISTANCE: f64 = 4.0;

/// Maximum rotation of a piece, in radians (definition: rotations of matches are in (−π, π]).
const MAX_ROTATION: f64 = PI;

/// Maximum distance between the vertices of an outline and of a stored motion, relative to the
/// diameter (tolerance: the key of the motion does not distinguish coordinates that are closer).
const MAX_GAP: f64 = 4e-7;

/// Maximum relative difference of the areas of an outline and of a stored motion (tolerance: a hole
/// without a counterpart ends as a ring of 2.5e-4 of the diameter).
const MAX_AREA_ERROR: f64 = 1e-4;

/// Returns the longest displacement that a stored motion may have: a motion longer than this leaves
/// the drawing.
pub(super) fn max_length(outlines: &[Regions; 2]) -> f64 {
    MAX_DISTANCE * both_bounds(outlines).diameter()
}

/// Returns whether the pieces and the mesh of a stored motion belong to the outlines: all
/// coordinates are close to them, and at either end the mesh has their vertices and their area.
pub(super) fn is_of_outlines(
    pieces: &[PieceMatch],
    mesh: &CompatibleMesh,
    outlines: &[Regions; 2],
) -> bool {
    let bounds = both_bounds(outlines);
    let reach = DVec2::splat(max_length(outlines));
    let is_close = |p: &DVec2| (*p - bounds.centre()).abs().cmple(reach).all();
    let rings = pieces
        .iter()
        .flat_map(|piece| piece.rings.iter().chain(&piece.lone));
    let ring_points = rings.flat_map(|ring| ring.source.iter().chain(&ring.target));
    let cuts = pieces.iter().flat_map(|piece| &piece.cuts);
    let cut_points = cuts.flat_map(|cut| [&cut.outer, &cut.hole]);
    let mesh_points = mesh.source().iter().chain(mesh.target());
    pieces.iter().all(has_valid_numbers)
        && ring_points
            .chain(cut_points)
            .chain(mesh_points)
            .all(is_close)
        && Side::BOTH.into_iter().all(|side| {
            let shown = StoredEnd::of(pieces, mesh, side);
            shown.is_outline(&outlines[side.index()], bounds.diameter())
        })
}

fn has_valid_numbers(piece: &PieceMatch) -> bool {
    piece.rotation.abs() <= MAX_ROTATION && piece.cost.is_finite()
}

fn both_bounds(outlines: &[Regions; 2]) -> Bounds {
    outlines[0].bounds().union(&outlines[1].bounds())
}

/// Vertices and area of a stored motion at one of its ends.
struct StoredEnd {
    /// Vertices of the mesh and of the holes that exist only at this end.
    vertices: Vec<DVec2>,
    area: f64,
}

impl StoredEnd {
    fn of(pieces: &[PieceMatch], mesh: &CompatibleMesh, side: Side) -> Self {
        let places = match side {
            Side::Source => mesh.source(),
            Side::Target => mesh.target(),
        };
        let components = mesh.components();
        let is_shown = |vertex: u32| {
            let piece = pieces.get(components[vertex as usize] as usize);
            let only = piece.and_then(PieceMatch::only_side);
            only.is_none_or(|only| only == side)
        };
        let shown = mesh.faces().iter().filter(|face| is_shown(face[0]));
        let face_area = |face: &[u32; 3]| signed_area(&face.map(|v| places[v as usize]));
        let holes = pieces.iter().flat_map(|piece| &piece.lone);
        let holes = holes.filter_map(RingMatch::transient_side);
        let holes: Vec<&[DVec2]> = holes
            .filter(|hole| hole.0 == side)
            .map(|hole| hole.1)
            .collect();
        let hole_area: f64 = holes.iter().map(|ring| signed_area(ring).abs()).sum();
        Self {
            area: shown.map(face_area).sum::<f64>() - hole_area,
            vertices: places
                .iter()
                .chain(holes.into_iter().flatten())
                .copied()
                .collect(),
        }
    }

    fn is_outline(&self, outline: &Regions, diameter: f64) -> bool {
        let gap = MAX_GAP * diameter;
        let cell = |p: DVec2| ((p.x / gap).floor() as i64, (p.y / gap).floor() as i64);
        let cells: HashSet<_> = self.vertices.iter().map(|&p| cell(p)).collect();
        let is_near = |p: &DVec2| {
            let (x, y) = cell(*p);
            (-1..=1).any(|i| (-1..=1).any(|j| cells.contains(&(x + i, y + j))))
        };
        let area = outline.area();
        (self.area - area).abs() <= MAX_AREA_ERROR * area
            && outline
                .rings()
                .all(|ring| ring.points().iter().all(is_near))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_of_up_to_half_a_turn_are_valid() {
        let is_valid = |rotation: f64| {
            has_valid_numbers(&PieceMatch {
                rotation,
                ..PieceMatch::default()
            })
        };
        assert!([0.0, 1.5, PI, -PI].into_iter().all(is_valid));
        let beyond = [PI.next_up(), -3.9, 1e300, f64::INFINITY, f64::NAN];
        assert!(!beyond.into_iter().any(is_valid));
    }
}
