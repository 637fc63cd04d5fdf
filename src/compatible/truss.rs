//! A common triangulation of two trusses with the same nodes and bars.
//!
//! Only what bars enclose carries faces; pockets of the outer contour stay
//! open. The steps:
//!
//! 1. Bars that cross others without a node, in either design, are no
//!    constraints. The bar with the most crossings is let go first, of equal
//!    ones the one listed last, until no two cross. Where that does not lead
//!    to a triangulation, all bars that cross any other are let go.
//! 2. The remaining graph is taken apart where a single bar or a single node
//!    holds it together. A piece of one bar is a bridge or a dangling end and
//!    becomes a two-point element; in every other piece each face is a simple
//!    polygon, a panel.
//! 3. Panels are cut by diagonals so that all triangles are positive in both
//!    designs, by exact predicates, and the smallest angle of both is as
//!    large as can be: a dynamic program (Gilbert 1979, Klincsek 1980) in
//!    O(n³) for a panel of n nodes.
//! 4. Bars that were let go are carried along where panels that hang together
//!    by bars hold both of their nodes; elsewhere they become two-point
//!    elements.
//!
//! Guaranteed: exchanging the designs gives the same triangles; every node is
//! in a face or a two-point element. Not guaranteed: a triangulation where
//! only further points inside a panel would make one possible, and that
//! pieces which lie inside a panel without a bar to it move with it.

mod bar_conflicts;
mod blocks;
mod error;
mod panel_triangulation;

use crate::design::Truss;
use crate::geometry::{DVec2, Side, SourceTarget, signed_area};
use crate::mesh::undirected;
use crate::work::progress::{Progress, checkpoint, still_wanted};
use blocks::PlanarBlocks;
use error::MAX_PANEL_NODES;
pub use error::TrussError;
pub(super) use error::list_first;
use std::collections::HashSet;

/// Faces, and bars that are two-point elements.
pub(super) type PanelMesh = (Vec<[u32; 3]>, Vec<[u32; 2]>);

/// Triangles between the bars, positive in both designs, and the bars that
/// are in no panel.
///
/// # Errors
/// [`TrussError`] names the first difference, or the nodes of a panel that
/// cannot be triangulated, or tells that the work was cancelled.
pub(super) fn triangulate_panels(
    source: &Truss,
    target: &Truss,
    progress: &dyn Progress,
) -> Result<PanelMesh, TrussError> {
    check_same(source, target)?;
    let nodes = SourceTarget {
        source: source.nodes(),
        target: target.nodes(),
    };
    let bars = source.bars();
    let conflicts = bar_conflicts::find_conflicts(bars, nodes, progress)?;
    let thinned = bar_conflicts::remove_greedily(bars.len(), &conflicts, progress)?;
    let first = with_kept(bars, nodes, &thinned, progress);
    still_wanted(progress)?;
    if first.is_ok() || conflicts.is_empty() {
        return first;
    }
    let uncrossed = bar_conflicts::keep_uncrossed(bars.len(), &conflicts);
    // Of two failures the first: it is about the bars that are there.
    with_kept(bars, nodes, &uncrossed, progress).or(first)
}

fn check_same(source: &Truss, target: &Truss) -> Result<(), TrussError> {
    let counts = [source.nodes().len(), target.nodes().len()];
    if counts[0] != counts[1] {
        return Err(TrussError::NodeCounts(counts));
    }
    for (of, without, only_in) in [
        (source, target, Side::Source),
        (target, source, Side::Target),
    ] {
        let others: HashSet<_> = without.bars().iter().map(|&b| undirected(b)).collect();
        let missing = |bar: &&[u32; 2]| !others.contains(&undirected(**bar));
        if let Some(&nodes) = of.bars().iter().find(missing) {
            return Err(TrussError::BarsDiffer { nodes, only_in });
        }
    }
    Ok(())
}

/// The panels between the bars that are kept, triangulated.
fn with_kept(
    bars: &[[u32; 2]],
    nodes: SourceTarget<&[DVec2]>,
    kept: &[bool],
    progress: &dyn Progress,
) -> Result<PanelMesh, TrussError> {
    let those = |are_kept: bool| {
        let those = bars.iter().zip(kept).filter(move |(_, k)| **k == are_kept);
        those.map(|(bar, _)| *bar)
    };
    let plane: Vec<[u32; 2]> = those(true).collect();
    let pieces = PlanarBlocks::of(&plane, nodes.source);
    check_sides(&pieces.panels, nodes)?;
    let mut faces = Vec::new();
    let count = pieces.panels.len() as f64;
    for (k, panel) in pieces.panels.iter().enumerate() {
        checkpoint(progress, "triangulating", k as f64 / count)?;
        faces.extend(triangles(panel, nodes, progress)?);
    }
    let mut elements = pieces.bridges.clone();
    elements.extend(those(false).filter(|&bar| !pieces.hold(bar)));
    Ok((faces, elements))
}

/// Panels run counter-clockwise in the source. Where none does in the target it
/// is a mirror image; where some do not, the first is a fault.
fn check_sides(cycles: &[Vec<u32>], nodes: SourceTarget<&[DVec2]>) -> Result<(), TrussError> {
    let turned = |cycle: &Vec<u32>| {
        let corners = cycle.iter().map(|&node| nodes.target[node as usize]);
        // Where rounding errs the panel is flat, and gets no triangles either.
        signed_area(&corners.collect::<Vec<_>>()) < 0.0
    };
    if !cycles.is_empty() && cycles.iter().all(turned) {
        return Err(TrussError::Mirrored);
    }
    match cycles.iter().find(|cycle| turned(cycle)) {
        Some(cycle) => Err(TrussError::Flipped(cycle.clone())),
        None => Ok(()),
    }
}

fn triangles(
    cycle: &[u32],
    nodes: SourceTarget<&[DVec2]>,
    progress: &dyn Progress,
) -> Result<Vec<[u32; 3]>, TrussError> {
    if cycle.len() > MAX_PANEL_NODES {
        return Err(TrussError::TooLarge(cycle.to_vec()));
    }
    let found = panel_triangulation::triangulate_panel(cycle, nodes, progress)?;
    found.ok_or_else(|| TrussError::NoTriangulation(cycle.to_vec()))
}

#[cfg(test)]
mod tests;
