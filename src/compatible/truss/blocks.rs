//! Splits a plane graph of bars into its blocks (maximal connected subgraphs without cut nodes) and
//! finds their bounded faces.
//!
//! The boundary loop around a face of the graph passes each cut node more than once. Wherever the
//! loop returns to a node, it is split. The result is a set of simple cycles: each one bounds a
//! face of one block, or is a single bar passed in both directions.

use crate::geometry::{DVec2, orient2d, ring_edges};
use crate::mesh::{components, undirected};
use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

/// Panels and bridges of a plane graph, and the blocks to which nodes belong.
pub(super) struct PlanarBlocks {
    /// Bounded faces of all blocks, each as its nodes in counter-clockwise order, starting with the
    /// smallest index.
    pub(super) panels: Vec<Vec<u32>>,
    /// Bars that form a block alone: bridges and dangling ends.
    pub(super) bridges: Vec<[u32; 2]>,
    /// For each node of a panel, the indices of the blocks that contain the node.
    blocks_of: HashMap<u32, Vec<u32>>,
}

impl PlanarBlocks {
    /// Splits the graph into blocks. No two bars may cross.
    pub(super) fn of(bars: &[[u32; 2]], nodes: &[DVec2]) -> Self {
        let panels = bounded_faces(bars, nodes);
        let mut panel_at: HashMap<[u32; 2], u32> = HashMap::new();
        let mut links = Vec::new();
        for (panel, cycle) in (0..).zip(&panels) {
            for (a, b) in ring_edges(cycle) {
                // Two panels that share a bar belong to the same block.
                let neighbour = panel_at.insert(undirected([a, b]), panel);
                links.extend(neighbour.map(|other| [panel, other]));
            }
        }
        // All faces of a block, including the outer one, are connected across bars. Since a block
        // has no cut nodes, its panels stay connected when the outer face is removed. The connected
        // components of the panels are therefore the blocks.
        let mut blocks_of: HashMap<u32, Vec<u32>> = HashMap::new();
        for (cycle, block) in panels.iter().zip(components(panels.len(), links)) {
            for &node in cycle {
                blocks_of.entry(node).or_default().push(block);
            }
        }
        let in_no_panel = |bar: &[u32; 2]| !panel_at.contains_key(&undirected(*bar));
        let mut bridges: Vec<[u32; 2]> = bars.iter().copied().filter(in_no_panel).collect();
        bridges.sort_unstable();
        Self {
            panels,
            bridges,
            blocks_of,
        }
    }

    /// Returns whether both nodes of a bar belong to the same block with panels.
    pub(super) fn contain_both_ends(&self, [a, b]: [u32; 2]) -> bool {
        let of = |node| self.blocks_of.get(&node).map_or(&[][..], Vec::as_slice);
        of(a).iter().any(|block| of(b).contains(block))
    }
}

/// Returns the bounded faces of all blocks, sorted.
fn bounded_faces(bars: &[[u32; 2]], nodes: &[DVec2]) -> Vec<Vec<u32>> {
    let successor = successors(bars, nodes);
    let mut seen = HashSet::new();
    let mut faces = Vec::new();
    // For each node, its index in `path`, the nodes visited since the last complete cycle; `None`
    // if `path` does not contain the node.
    let mut position = vec![None; nodes.len()];
    for &start in successor.keys() {
        let mut path = Vec::new();
        let mut edge = start;
        // Each directed bar runs along exactly one face.
        while seen.insert(edge) {
            let [from, to] = edge;
            position[from as usize] = Some(path.len());
            path.push(from);
            // `path` has returned to a node. The nodes since the last visit to this node form a
            // cycle.
            if let Some(back) = position[to as usize] {
                let mut cycle = path.split_off(back);
                cycle
                    .iter()
                    .for_each(|&node| position[node as usize] = None);
                // Cycles around outer faces run clockwise. A bar passed in both directions has no
                // orientation.
                if is_counter_clockwise(&cycle, nodes) {
                    let first = (0..cycle.len()).min_by_key(|&i| cycle[i]).unwrap_or(0);
                    cycle.rotate_left(first);
                    faces.push(cycle);
                }
            }
            edge = successor[&edge];
        }
    }
    // Sorted, because the hash map yields the start edges in no fixed order.
    faces.sort_unstable();
    faces
}

/// For each directed bar, the next directed bar along the face on its left: the first one clockwise
/// from the reversed bar.
fn successors(edges: &[[u32; 2]], nodes: &[DVec2]) -> HashMap<[u32; 2], [u32; 2]> {
    let mut around: HashMap<u32, Vec<u32>> = HashMap::new();
    for &[a, b] in edges {
        around.entry(a).or_default().push(b);
        around.entry(b).or_default().push(a);
    }
    let mut successor = HashMap::new();
    for (&node, ends) in &mut around {
        let centre = nodes[node as usize];
        ends.sort_by(|&p, &q| compare_angles(centre, nodes[p as usize], nodes[q as usize]));
        for (i, &end) in ends.iter().enumerate() {
            // The ends are sorted counter-clockwise, so the previous end in the list is the next
            // one clockwise.
            let before = ends[(i + ends.len() - 1) % ends.len()];
            successor.insert([end, node], [node, before]);
        }
    }
    successor
}

/// Exact comparison of two points by angle around `centre`, counter-clockwise from the positive x
/// axis.
fn compare_angles(centre: DVec2, p: DVec2, q: DVec2) -> Ordering {
    let lower_half = |r: DVec2| r.y < centre.y || (r.y == centre.y && r.x < centre.x);
    lower_half(p)
        .cmp(&lower_half(q))
        .then_with(|| 0.0f64.total_cmp(&orient2d(centre, p, q)))
}

/// Returns whether a simple polygon runs counter-clockwise. The leftmost corner (ties: the lowest)
/// is convex, so the turn at this corner decides.
fn is_counter_clockwise(cycle: &[u32], nodes: &[DVec2]) -> bool {
    let at = |i: usize| nodes[cycle[i % cycle.len()] as usize];
    // The sign of the computed area could be wrong by rounding; the turn at one corner is exact.
    let corner = (0..cycle.len()).min_by(|&i, &j| {
        let (p, q) = (at(i), at(j));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    corner.is_some_and(|i| orient2d(at(i + cycle.len() - 1), at(i), at(i + 1)) > 0.0)
}
