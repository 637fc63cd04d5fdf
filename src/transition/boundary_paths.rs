//! Two designs by their boundaries alone: matched, not triangulated.
//!
//! Two meshes whose boundary walks are the same, number by number, bring
//! their match along; all other forms are matched as outlines. The match is
//! the first that rigid parts would try: whether it folds inside is not asked,
//! since there is no inside.

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

/// The paths, and what is seen of them.
pub(super) fn paths(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<(BuiltWarp, SolidContent), BuildError> {
    checkpoint(progress, "matching", 0.0)?;
    let (parts, matched) = match (&spec.source.form, &spec.target.form) {
        (DesignForm::Mesh(source), DesignForm::Mesh(target)) => numbered(source, target),
        _ => None,
    }
    .map_or_else(
        || matched(spec, bar_width, &ProgressSpan::new(progress, 0.0, 0.9)),
        |parts| Ok((parts, None)),
    )?;
    let paths = BoundaryPaths::new(&parts, spec.options.paths)?;
    checkpoint(progress, "preparing frames", 0.9)?;
    let coating = matched.as_ref().and_then(|(drawings, matched)| {
        let pieces = parts.iter().enumerate();
        let placer = paths.placer();
        let walks = PieceBoundaryLoops {
            walks: paths.loops(),
            pieces: pieces
                .flat_map(|(k, rings)| repeat_n(k, rings.len()))
                .collect(),
            places: [&placer.placement().in_source, &placer.placement().in_target],
        };
        piece_coating::coating(drawings, matched, &walks, &[])
    });
    let solid = SolidContent {
        loops: paths.loops(),
        coating,
        ..SolidContent::default()
    };
    let moved = BuiltWarp {
        matched: matched.map(|(_, matched)| matched),
        ..AnyWarp::Paths(Arc::new(paths)).into()
    };
    Ok((moved, solid))
}

/// The rings of each part, and the match that brings them together, of what
/// drawings.
type MatchedBoundaries = (Vec<Vec<RingPair>>, Option<(DrawingPair, RegionMatch)>);

fn matched(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<MatchedBoundaries, BuildError> {
    let drawings = spec.drawings(bar_width, progress)?;
    let (designs, asked) = (drawings.outlines.each_ref(), &spec.options.matching);
    let prepared = MatchPlan::new(designs, &drawings.looks, asked, progress)?;
    let matched = prepared.matched(&asked.options(), progress)?;
    let parts = matched.pieces.iter().map(rings).collect();
    Ok((parts, Some((drawings, matched))))
}

/// The rings of a piece. What a match keeps as a tiny ring, so that it can be
/// triangulated, is a point here.
fn rings(piece: &PieceMatch) -> Vec<RingPair> {
    let Some(outer) = piece.rings.first() else {
        return Vec::new();
    };
    let pair = |ring: &RingMatch| {
        let [mut source, mut target] = [ring.source.clone(), ring.target.clone()];
        match ring.kind {
            RingKind::Opens => source.fill(middle(&ring.source)),
            RingKind::Closes => target.fill(middle(&ring.target)),
            RingKind::Matched => {}
        }
        // A part that is born or dies is one point, its holes included.
        if piece.source_part.is_none() {
            source.fill(middle(&outer.source));
        }
        if piece.target_part.is_none() {
            target.fill(middle(&outer.target));
        }
        RingPair { source, target }
    };
    piece.rings.iter().chain(&piece.lone).map(pair).collect()
}

fn middle(ring: &[DVec2]) -> DVec2 {
    ring.iter().sum::<DVec2>() / ring.len().max(1) as f64
}

/// The boundary walks of two meshes as parts, where they are the same walks
/// and run the same way round.
fn numbered(source: &TriangleMesh, target: &TriangleMesh) -> Option<Vec<Vec<RingPair>>> {
    // Equal walks number by number: whoever made both meshes meant that match.
    let walks = source.boundary_loops();
    if walks != target.boundary_loops() {
        return None;
    }
    let of = |mesh: &TriangleMesh, walk: &[u32]| -> Vec<DVec2> {
        let positions = mesh.positions();
        walk.iter().map(|&v| positions[v as usize]).collect()
    };
    let rings: Vec<RingPair> = walks
        .iter()
        .map(|walk| RingPair {
            source: of(source, walk),
            target: of(target, walk),
        })
        .collect();
    let areas: Vec<[f64; 2]> = rings
        .iter()
        .map(|ring| [signed_area(&ring.source), signed_area(&ring.target)])
        .collect();
    // A walk that is turned over in one mesh would pass through itself.
    let has_one_sense = areas.iter().all(|[a, b]| a * b > 0.0);
    has_one_sense.then(|| parts(rings, &areas))
}

/// Each hole with the smallest outer ring that it lies in in the source. A
/// mesh may list its faces clockwise; then its outer rings are clockwise.
fn parts(rings: Vec<RingPair>, areas: &[[f64; 2]]) -> Vec<Vec<RingPair>> {
    // Outer rings enclose more than their holes, so that they settle the sign.
    let sense: f64 = areas.iter().map(|[a, _]| a).sum();
    let (mut outer, mut holes) = (Vec::new(), Vec::new());
    for (ring, [area, _]) in rings.into_iter().zip(areas) {
        if area * sense > 0.0 {
            outer.push((area.abs(), vec![ring]));
        } else {
            holes.push(ring);
        }
    }
    for hole in holes {
        let lies_in =
            |part: &&mut (f64, Vec<RingPair>)| winding(&part.1[0].source, hole.source[0]) != 0;
        let around = outer
            .iter_mut()
            .filter(lies_in)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        match around {
            Some((_, part)) => part.push(hole),
            None => outer.push((0.0, vec![hole])),
        }
    }
    outer.into_iter().map(|(_, part)| part).collect()
}
