//! A plane graph taken apart into pieces without cut nodes, and their faces.
//!
//! A walk around a face of the graph passes a cut node more than once. Parted
//! wherever it comes back to a node, it falls into simple cycles: each is a
//! face of one piece, or a bar walked there and back.

use crate::geometry::{DVec2, orient2d, ring_edges};
use crate::mesh::{components, undirected};
use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

/// What a plane graph consists of.
pub(super) struct PlanarBlocks {
    /// Bounded faces, counter-clockwise from their smallest node on.
    pub(super) panels: Vec<Vec<u32>>,
    /// Bars that are pieces of their own: bridges and dangling ends.
    pub(super) bridges: Vec<[u32; 2]>,
    /// For each node of a panel the pieces that it is in.
    pieces_of: HashMap<u32, Vec<u32>>,
}

impl PlanarBlocks {
    /// Takes the graph apart. No two bars may cross.
    pub(super) fn of(bars: &[[u32; 2]], nodes: &[DVec2]) -> Self {
        let panels = bounded_faces(bars, nodes);
        let mut panel_at: HashMap<[u32; 2], u32> = HashMap::new();
        let mut links = Vec::new();
        for (panel, cycle) in (0..).zip(&panels) {
            for (a, b) in ring_edges(cycle) {
                let beside = panel_at.insert(undirected([a, b]), panel);
                links.extend(beside.map(|other| [panel, other]));
            }
        }
        // The panels of one piece hang together by bars: its faces meet across
        // them, and taking out the outer face of a piece without cut nodes
        // leaves the others connected.
        let mut pieces_of: HashMap<u32, Vec<u32>> = HashMap::new();
        for (cycle, piece) in panels.iter().zip(components(panels.len(), links)) {
            for &node in cycle {
                pieces_of.entry(node).or_default().push(piece);
            }
        }
        let in_no_panel = |bar: &[u32; 2]| !panel_at.contains_key(&undirected(*bar));
        let mut bridges: Vec<[u32; 2]> = bars.iter().copied().filter(in_no_panel).collect();
        bridges.sort_unstable();
        Self {
            panels,
            bridges,
            pieces_of,
        }
    }

    /// Whether one piece with panels has both nodes of a bar.
    pub(super) fn hold(&self, [a, b]: [u32; 2]) -> bool {
        let of = |node| self.pieces_of.get(&node).map_or(&[][..], Vec::as_slice);
        of(a).iter().any(|piece| of(b).contains(piece))
    }
}

/// All faces of all pieces but their outer ones.
fn bounded_faces(bars: &[[u32; 2]], nodes: &[DVec2]) -> Vec<Vec<u32>> {
    let follows = successors(bars, nodes);
    let mut seen = HashSet::new();
    let mut faces = Vec::new();
    // Where in the path each node is: a tree is walked there and back as one.
    let mut place = vec![None; nodes.len()];
    for &start in follows.keys() {
        let mut path = Vec::new();
        let mut edge = start;
        while seen.insert(edge) {
            let [from, to] = edge;
            place[from as usize] = Some(path.len());
            path.push(from);
            // Back at a node: what was walked since is a cycle of its own.
            if let Some(back) = place[to as usize] {
                let mut cycle = path.split_off(back);
                cycle.iter().for_each(|&node| place[node as usize] = None);
                // Outer faces run clockwise; a bar there and back turns nowhere.
                if is_counter_clockwise(&cycle, nodes) {
                    let first = (0..cycle.len()).min_by_key(|&i| cycle[i]).unwrap_or(0);
                    cycle.rotate_left(first);
                    faces.push(cycle);
                }
            }
            edge = follows[&edge];
        }
    }
    // The starts came in no order.
    faces.sort_unstable();
    faces
}

/// For each bar in each direction the next one around the face on its left:
/// the first clockwise from the way back.
fn successors(edges: &[[u32; 2]], nodes: &[DVec2]) -> HashMap<[u32; 2], [u32; 2]> {
    let mut around: HashMap<u32, Vec<u32>> = HashMap::new();
    for &[a, b] in edges {
        around.entry(a).or_default().push(b);
        around.entry(b).or_default().push(a);
    }
    let mut follows = HashMap::new();
    for (&node, ends) in &mut around {
        let centre = nodes[node as usize];
        ends.sort_by(|&p, &q| by_angle(centre, nodes[p as usize], nodes[q as usize]));
        for (i, &end) in ends.iter().enumerate() {
            // The last one counter-clockwise is the first one clockwise.
            let before = ends[(i + ends.len() - 1) % ends.len()];
            follows.insert([end, node], [node, before]);
        }
    }
    follows
}

/// Exact order by angle around `centre`, counter-clockwise from the x axis.
fn by_angle(centre: DVec2, p: DVec2, q: DVec2) -> Ordering {
    let lower_half = |r: DVec2| r.y < centre.y || (r.y == centre.y && r.x < centre.x);
    lower_half(p)
        .cmp(&lower_half(q))
        .then_with(|| 0.0f64.total_cmp(&orient2d(centre, p, q)))
}

/// The sense of a simple polygon, from its lowest of leftmost corners, which
/// is convex.
fn is_counter_clockwise(cycle: &[u32], nodes: &[DVec2]) -> bool {
    let at = |i: usize| nodes[cycle[i % cycle.len()] as usize];
    // The sign of the area would be rounded; that of one corner is exact.
    let corner = (0..cycle.len()).min_by(|&i, &j| {
        let (p, q) = (at(i), at(j));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    corner.is_some_and(|i| orient2d(at(i + cycle.len() - 1), at(i), at(i + 1)) > 0.0)
}
