//! A plane graph taken apart into pieces without cut nodes, and their faces.

use crate::geometry::{DVec2, orient2d};
use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

/// What a plane graph consists of.
#[derive(Default)]
pub(super) struct Pieces {
    /// Bounded faces, counter-clockwise from their smallest node on.
    pub(super) panels: Vec<Vec<u32>>,
    /// For each piece with panels its nodes, sorted.
    pub(super) blocks: Vec<Vec<u32>>,
    /// Bars that are pieces of their own: bridges and dangling ends.
    pub(super) bridges: Vec<[u32; 2]>,
}

impl Pieces {
    /// Takes the graph apart. No two bars may cross.
    pub(super) fn of(bars: &[[u32; 2]], nodes: &[DVec2]) -> Self {
        let mut all = Self::default();
        for piece in pieces(bars, nodes.len()) {
            if let &[bar] = piece.as_slice() {
                all.bridges.push(bars[bar]);
                continue;
            }
            let edges: Vec<[u32; 2]> = piece.iter().map(|&bar| bars[bar]).collect();
            let mut block: Vec<u32> = edges.iter().flatten().copied().collect();
            block.sort_unstable();
            block.dedup();
            all.blocks.push(block);
            all.panels.extend(bounded_faces(&edges, nodes));
        }
        all.panels.sort_unstable();
        all.bridges.sort_unstable();
        all
    }
}

/// A node on the path of the search.
struct Visit {
    node: usize,
    by: Option<usize>,
    next: usize,
}

/// The blocks of the graph as lists of bars (Hopcroft and Tarjan 1973),
/// without recursion.
fn pieces(bars: &[[u32; 2]], nodes: usize) -> Vec<Vec<usize>> {
    let mut around: Vec<Vec<usize>> = vec![Vec::new(); nodes];
    for (bar, ends) in bars.iter().enumerate() {
        for &end in ends {
            around[end as usize].push(bar);
        }
    }
    let mut search = Search {
        bars,
        order: vec![0; nodes],
        low: vec![0; nodes],
        visited: 0,
        waiting: Vec::new(),
        pieces: Vec::new(),
    };
    for root in 0..nodes {
        if search.order[root] == 0 {
            search.run(root, &around);
        }
    }
    search.pieces
}

struct Search<'a> {
    bars: &'a [[u32; 2]],
    /// When a node was first met, from 1; 0 before.
    order: Vec<usize>,
    /// The earliest node that can be come back to from below.
    low: Vec<usize>,
    visited: usize,
    waiting: Vec<usize>,
    pieces: Vec<Vec<usize>>,
}

impl Search<'_> {
    fn run(&mut self, root: usize, around: &[Vec<usize>]) {
        let mut path = vec![self.visit(root, None)];
        while let Some(top) = path.last_mut() {
            let (node, by) = (top.node, top.by);
            if let Some(&bar) = around[node].get(top.next) {
                top.next += 1;
                let other = self.other_end(bar, node);
                if self.order[other] == 0 {
                    self.waiting.push(bar);
                    path.push(self.visit(other, Some(bar)));
                } else if Some(bar) != by && self.order[other] < self.order[node] {
                    self.waiting.push(bar);
                    self.low[node] = self.low[node].min(self.order[other]);
                }
                continue;
            }
            path.pop();
            if let (Some(above), Some(bar)) = (path.last(), by) {
                self.leave(node, above.node, bar);
            }
        }
    }

    fn visit(&mut self, node: usize, by: Option<usize>) -> Visit {
        self.visited += 1;
        self.order[node] = self.visited;
        self.low[node] = self.visited;
        Visit { node, by, next: 0 }
    }

    fn other_end(&self, bar: usize, node: usize) -> usize {
        let [a, b] = self.bars[bar].map(|end| end as usize);
        if a == node { b } else { a }
    }

    /// Goes back up from `node` over `bar`; what hangs below is a piece of
    /// its own if it cannot come back past `above`.
    fn leave(&mut self, node: usize, above: usize, bar: usize) {
        self.low[above] = self.low[above].min(self.low[node]);
        if self.low[node] < self.order[above] {
            return;
        }
        let from = self.waiting.iter().rposition(|&b| b == bar).unwrap_or(0);
        self.pieces.push(self.waiting.split_off(from));
    }
}

/// All faces but the outer one of a plane piece without cut nodes.
fn bounded_faces(edges: &[[u32; 2]], nodes: &[DVec2]) -> Vec<Vec<u32>> {
    let follows = successors(edges, nodes);
    let mut starts: Vec<[u32; 2]> = follows.keys().copied().collect();
    starts.sort_unstable();
    let mut seen = HashSet::new();
    let mut faces = Vec::new();
    for start in starts {
        let mut cycle = Vec::new();
        let mut edge = start;
        while seen.insert(edge) {
            cycle.push(edge[0]);
            edge = follows[&edge];
        }
        if is_counter_clockwise(&cycle, nodes) {
            let first = (0..cycle.len()).min_by_key(|&i| cycle[i]).unwrap_or(0);
            cycle.rotate_left(first);
            faces.push(cycle);
        }
    }
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
    let corner = (0..cycle.len()).min_by(|&i, &j| {
        let (p, q) = (at(i), at(j));
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
    });
    corner.is_some_and(|i| orient2d(at(i + cycle.len() - 1), at(i), at(i + 1)) > 0.0)
}
