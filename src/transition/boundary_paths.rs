//! Transitions that move only boundaries: outlines are matched, but their interior is not
//! triangulated.
//!
//! Two meshes whose boundary loops consist of the same vertex indices are matched by these indices;
//! all other designs are matched as outlines. The first match is used without a search for better
//! ones, because there is no interior that a bad match could fold.

use super::any_warp::{AnyWarp, BuiltWarp};
use super::drawing_pair::DrawingPair;
use super::error::BuildError;
use super::piece_coating;
use super::piece_coating::PieceBoundaryLoops;
use super::spec::TransitionSpec;
use crate::content::SolidContent;
use crate::correspondence::{MatchPlan, PieceMatch, RegionMatch, RingKind, RingMatch};
use crate::design::DesignForm;
use crate::geometry::{DVec2, signed_area, winding};
use crate::mesh::TriangleMesh;
use crate::warp::{BoundaryPaths, RingPair, Warp};
use crate::work::progress::{Progress, ProgressSpan, checkpoint};
use std::iter::repeat_n;
use std::sync::Arc;

/// Builds the warp that moves the boundaries, and the content that is shown.
///
/// # Errors
/// If outlines cannot be matched, the paths cannot be built, or the work is cancelled.
pub(super) fn build_boundary_paths(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<(BuiltWarp, SolidContent), BuildError> {
    checkpoint(progress, "matching", 0.0)?;
    let (parts, matched) = match (&spec.source.form, &spec.target.form) {
        (DesignForm::Mesh(source), DesignForm::Mesh(target)) => shared_loops(source, target),
        _ => None,
    }
    .map_or_else(
        || match_outlines(spec, bar_width, &ProgressSpan::new(progress, 0.0, 0.9)),
        |parts| Ok((parts, None)),
    )?;
    let paths = BoundaryPaths::new(&parts, spec.options.paths)?;
    checkpoint(progress, "preparing frames", 0.9)?;
    let paint_layers = matched.as_ref().and_then(|(drawings, matched)| {
        let pieces = parts.iter().enumerate();
        let placer = paths.placer();
        let loops = PieceBoundaryLoops {
            loops: paths.loops(),
            pieces: pieces
                .flat_map(|(k, rings)| repeat_n(k, rings.len()))
                .collect(),
            places: [&placer.placement().in_source, &placer.placement().in_target],
        };
        piece_coating::paint_layer_stack(drawings, matched, &loops, &[])
    });
    let solid = SolidContent {
        loops: paths.loops(),
        paint_layers,
        ..SolidContent::default()
    };
    let note = matched.as_ref().and_then(|(drawings, _)| drawings.note());
    let built = BuiltWarp {
        notes: note.into_iter().collect(),
        matched: matched.map(|(_, matched)| matched),
        ..AnyWarp::Paths(Arc::new(paths)).into()
    };
    Ok((built, solid))
}

/// Result of matching boundaries: for each piece, its pairs of rings; and, if outlines were
/// matched, the drawings and their match.
type MatchedBoundaries = (Vec<Vec<RingPair>>, Option<(DrawingPair, RegionMatch)>);

/// Matches the outlines of two designs and returns the pairs of rings of each piece.
fn match_outlines(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<MatchedBoundaries, BuildError> {
    let drawings = spec.drawings(bar_width, progress)?;
    let (designs, requested) = (drawings.outlines.each_ref(), &spec.options.matching);
    let prepared = MatchPlan::new(designs, &drawings.appearances, requested, progress)?;
    let matched = prepared.match_all_groups(&requested.options(), progress)?;
    let parts = matched.pieces.iter().map(rings).collect();
    Ok((parts, Some((drawings, matched))))
}

/// Returns the pairs of rings of a piece. For a ring that is missing in one of the designs, the
/// match has a small seed shape there. It is replaced by a point, because boundary paths, unlike
/// triangulations, need no extent.
fn rings(piece: &PieceMatch) -> Vec<RingPair> {
    let Some(outer_ring) = piece.rings.first() else {
        return Vec::new();
    };
    let pair = |ring: &RingMatch| {
        let [mut source, mut target] = [ring.source.clone(), ring.target.clone()];
        match ring.kind {
            RingKind::Opens => source.fill(centroid_of_points(&ring.source)),
            RingKind::Closes => target.fill(centroid_of_points(&ring.target)),
            RingKind::Matched => {}
        }
        // In the design in which a part is missing, the part and its holes become a single point.
        if piece.source_part.is_none() {
            source.fill(centroid_of_points(&outer_ring.source));
        }
        if piece.target_part.is_none() {
            target.fill(centroid_of_points(&outer_ring.target));
        }
        RingPair { source, target }
    };
    piece.rings.iter().chain(&piece.lone).map(pair).collect()
}

/// Returns the mean of the points.
fn centroid_of_points(ring: &[DVec2]) -> DVec2 {
    ring.iter().sum::<DVec2>() / ring.len().max(1) as f64
}

/// Returns the boundary loops of two meshes, grouped into parts; `None` unless the loops of both
/// meshes consist of the same vertices and have the same orientation.
fn shared_loops(source: &TriangleMesh, target: &TriangleMesh) -> Option<Vec<Vec<RingPair>>> {
    // Identical indices mean that the meshes were made to correspond vertex by vertex.
    let loops = source.boundary_loops();
    if loops != target.boundary_loops() {
        return None;
    }
    let ring_of = |mesh: &TriangleMesh, boundary_loop: &[u32]| -> Vec<DVec2> {
        let positions = mesh.positions();
        boundary_loop
            .iter()
            .map(|&v| positions[v as usize])
            .collect()
    };
    let rings: Vec<RingPair> = loops
        .iter()
        .map(|boundary_loop| RingPair {
            source: ring_of(source, boundary_loop),
            target: ring_of(target, boundary_loop),
        })
        .collect();
    let areas: Vec<[f64; 2]> = rings
        .iter()
        .map(|ring| [signed_area(&ring.source), signed_area(&ring.target)])
        .collect();
    // A loop with opposite orientations in the two meshes would pass through itself during the
    // motion.
    let has_same_orientation = areas.iter().all(|[a, b]| a * b > 0.0);
    has_same_orientation.then(|| parts(rings, &areas))
}

/// Groups each hole with the smallest outer ring that contains it in the source. Outer rings may be
/// clockwise, because a mesh may list its faces clockwise.
fn parts(rings: Vec<RingPair>, areas: &[[f64; 2]]) -> Vec<Vec<RingPair>> {
    // Outer rings enclose more area than their holes, so the sum of all areas has the sign of outer
    // rings.
    let orientation: f64 = areas.iter().map(|[a, _]| a).sum();
    let (mut outer, mut holes) = (Vec::new(), Vec::new());
    for (ring, [area, _]) in rings.into_iter().zip(areas) {
        if area * orientation > 0.0 {
            outer.push((area.abs(), vec![ring]));
        } else {
            holes.push(ring);
        }
    }
    for hole in holes {
        let contains_hole =
            |part: &&mut (f64, Vec<RingPair>)| winding(&part.1[0].source, hole.source[0]) != 0;
        let container = outer
            .iter_mut()
            .filter(contains_hole)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match container {
            Some((_, part)) => part.push(hole),
            None => outer.push((0.0, vec![hole])),
        }
    }
    outer.into_iter().map(|(_, part)| part).collect()
}
