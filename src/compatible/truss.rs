//! Common triangulation of two trusses with the same nodes and bars: one list of triangles that is
//! valid in both.
//!
//! Only areas enclosed by bars get faces; pockets that are open to the outside stay empty. The
//! steps:
//!
//! 1. Bars that cross without a common node, in either design, cannot all be edges of the
//!    triangulation. The bar with the most crossings is removed first (ties: the one listed last),
//!    until no two bars cross. If this leads to no valid triangulation, all bars that cross another
//!    bar are removed instead.
//! 2. The remaining plane graph is split into blocks at bridges (bars whose removal disconnects it)
//!    and cut nodes (nodes whose removal disconnects it). A block of one bar, which is a bridge or
//!    a dangling end, becomes a two-point element. In every other block each bounded face is a
//!    simple polygon, called a panel.
//! 3. Panels are triangulated by diagonals so that all triangles are positive in both designs, by
//!    exact predicates. Among all such triangulations, the smallest angle over both designs is
//!    maximal. This takes dynamic programming (Gilbert 1979, Klincsek 1980) in O(n³) for a panel of
//!    n nodes.
//! 4. A removed bar whose two nodes belong to the same block with panels moves with these panels
//!    and is dropped. Any other removed bar becomes a two-point element.
//!
//! Guaranteed: exchanging the designs gives the same triangles; every node belongs to a face or a
//! two-point element. Not guaranteed: that a triangulation is found for a panel that has one only
//! with extra points inside; that a part of the truss that lies inside a panel, without a bar to
//! it, moves with the panel.

mod bar_conflicts;
mod blocks;
mod error;
mod panel_triangulation;
mod relabelling;

use crate::design::Truss;
use crate::geometry::{DVec2, Side, SourceTarget, signed_area};
use crate::mesh::undirected;
use crate::work::progress::{Progress, check_cancelled, checkpoint};
pub(crate) use bar_conflicts::conflicts_in;
use blocks::PlanarBlocks;
pub use error::TrussError;
pub(super) use error::{MAX_PANEL_NODES, list_first};
pub(super) use panel_triangulation::triangulate_panel;
pub(crate) use relabelling::corresponding_nodes;
use std::collections::HashSet;

/// Faces as triples of node indices, and the bars that become two-point elements.
pub(super) type PanelMesh = (Vec<[u32; 3]>, Vec<[u32; 2]>);

/// Triangulates the panels (areas enclosed by bars) with triangles that are positive in both
/// designs. Returns the triangles, and the bars that belong to no panel.
///
/// # Errors
/// [`TrussError`] names the first difference between the trusses, or the nodes of a panel that
/// cannot be triangulated, or reports that the work was cancelled.
pub(super) fn triangulate_panels(
    source: &Truss,
    target: &Truss,
    progress: &dyn Progress,
) -> Result<PanelMesh, TrussError> {
    check_same_bars(source, target)?;
    let nodes = SourceTarget {
        source: source.nodes(),
        target: target.nodes(),
    };
    let bars = source.bars();
    let conflicts = bar_conflicts::find_conflicts(bars, nodes, progress)?;
    let selected = bar_conflicts::remove_greedily(bars.len(), &conflicts, progress)?;
    let first = triangulate_selected(bars, nodes, &selected, progress);
    check_cancelled(progress)?;
    if first.is_ok() || conflicts.is_empty() {
        return first;
    }
    let uncrossed = bar_conflicts::uncrossed_bars(bars.len(), &conflicts);
    // If both attempts fail, the error of the first attempt is reported, because that attempt used
    // more bars.
    triangulate_selected(bars, nodes, &uncrossed, progress).or(first)
}

/// Checks that both trusses have the same number of nodes and the same bars, in any order.
///
/// # Errors
/// [`TrussError::NodeCounts`] or [`TrussError::BarsDiffer`].
pub(crate) fn check_same_bars(source: &Truss, target: &Truss) -> Result<(), TrussError> {
    let counts = [source.nodes().len(), target.nodes().len()];
    if counts[0] != counts[1] {
        return Err(TrussError::NodeCounts(counts));
    }
    for (truss, other, only_in) in [
        (source, target, Side::Source),
        (target, source, Side::Target),
    ] {
        // Bars have no direction: their two nodes may be listed in either order.
        let others: HashSet<_> = other.bars().iter().map(|&b| undirected(b)).collect();
        let is_missing = |bar: &&[u32; 2]| !others.contains(&undirected(**bar));
        if let Some(&nodes) = truss.bars().iter().find(is_missing) {
            return Err(TrussError::BarsDiffer { nodes, only_in });
        }
    }
    Ok(())
}

/// Triangulates the panels that the bars marked in `selected` enclose.
fn triangulate_selected(
    bars: &[[u32; 2]],
    nodes: SourceTarget<&[DVec2]>,
    selected: &[bool],
    progress: &dyn Progress,
) -> Result<PanelMesh, TrussError> {
    let bars_where = |is_selected: bool| {
        let selected = bars
            .iter()
            .zip(selected)
            .filter(move |(_, k)| **k == is_selected);
        selected.map(|(bar, _)| *bar)
    };
    let plane: Vec<[u32; 2]> = bars_where(true).collect();
    let blocks = PlanarBlocks::of(&plane, nodes.source);
    check_sides(&blocks.panels, nodes)?;
    let mut faces = Vec::new();
    let count = blocks.panels.len() as f64;
    for (k, panel) in blocks.panels.iter().enumerate() {
        checkpoint(progress, "triangulating", k as f64 / count)?;
        faces.extend(triangles(panel, nodes, progress)?);
    }
    let mut elements = blocks.bridges.clone();
    elements.extend(bars_where(false).filter(|&bar| !blocks.contain_both_ends(bar)));
    Ok((faces, elements))
}

/// Checks that panels, which run counter-clockwise in the source, do so in the target too. If all
/// panels are reversed, the target is a mirror image of the source; otherwise the first reversed
/// panel is reported.
fn check_sides(cycles: &[Vec<u32>], nodes: SourceTarget<&[DVec2]>) -> Result<(), TrussError> {
    let is_reversed = |cycle: &Vec<u32>| {
        let corners = cycle.iter().map(|&node| nodes.target[node as usize]);
        // If rounding decides the sign, the panel is flat and cannot be triangulated anyway.
        signed_area(&corners.collect::<Vec<_>>()) < 0.0
    };
    if !cycles.is_empty() && cycles.iter().all(is_reversed) {
        return Err(TrussError::Mirrored);
    }
    match cycles.iter().find(|cycle| is_reversed(cycle)) {
        Some(cycle) => Err(TrussError::Flipped(cycle.clone())),
        None => Ok(()),
    }
}

/// Triangulates one panel, given by its nodes in counter-clockwise order.
fn triangles(
    cycle: &[u32],
    nodes: SourceTarget<&[DVec2]>,
    progress: &dyn Progress,
) -> Result<Vec<[u32; 3]>, TrussError> {
    if cycle.len() > MAX_PANEL_NODES {
        return Err(TrussError::TooLarge(cycle.to_vec()));
    }
    let faces = triangulate_panel(cycle, &[nodes.source, nodes.target], progress)?;
    faces.ok_or_else(|| TrussError::NoTriangulation(cycle.to_vec()))
}

#[cfg(test)]
mod tests;
