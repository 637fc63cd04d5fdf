//! Sparse system with two displacements and a rotation for each node of a structure.

use super::error::StructureError;
use crate::numerics::{PatternCholesky, PatternWorkspace};

/// Rows and columns of the six entries of the lower triangle of a node's 3×3 block.
pub(super) const NODE_ENTRIES: [[usize; 2]; 6] = [[0, 0], [1, 0], [1, 1], [2, 0], [2, 1], [2, 2]];

/// Symmetric matrix whose entries are 3×3 blocks: one for each node, and one for each member.
pub(super) struct NodeMatrix {
    pattern: PatternCholesky,
    memory: PatternWorkspace,
    bars: Vec<[u32; 2]>,
    /// Index of each entry in the memory: 6 for each node, then 9 for each member.
    slots: Vec<u32>,
    /// Values of the entries, in the order of `slots`.
    pub(super) values: Vec<f64>,
    nodes: usize,
}

impl std::fmt::Debug for NodeMatrix {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("NodeMatrix")
            .field("nodes", &self.nodes)
            .field("bars", &self.bars)
            .finish_non_exhaustive()
    }
}

impl NodeMatrix {
    /// Computes the elimination order for the members `bars`.
    ///
    /// # Errors
    /// [`StructureError::TooLarge`] if the system does not fit into memory.
    pub(super) fn new(nodes: usize, bars: &[[u32; 2]]) -> Result<Self, StructureError> {
        let of_nodes = (0..nodes as u32)
            .flat_map(|node| NODE_ENTRIES.map(|[i, j]| [3 * node + i as u32, 3 * node + j as u32]));
        let of_members = bars.iter().flat_map(|&[a, b]| {
            (0..9_u32).map(move |entry| [3 * a + entry / 3, 3 * b + entry % 3])
        });
        let places: Vec<[u32; 2]> = of_nodes.chain(of_members).collect();
        let (pattern, slots) =
            PatternCholesky::new(3 * nodes, &places).map_err(|_| StructureError::TooLarge)?;
        Ok(Self {
            memory: pattern.memory(),
            pattern,
            bars: bars.to_vec(),
            values: vec![0.0; slots.len()],
            slots,
            nodes,
        })
    }

    /// Adds to the block of a node: `entry(i, j)` for each pair of its displacements.
    pub(super) fn add_node(&mut self, node: u32, entry: impl Fn(usize, usize) -> f64) {
        let block = &mut self.values[6 * node as usize..][..6];
        for (value, [i, j]) in block.iter_mut().zip(NODE_ENTRIES) {
            *value += entry(i, j);
        }
    }

    /// Adds to the block of a member: `entry(i, j)` for each displacement of its first node and
    /// each of its second.
    pub(super) fn add_member(&mut self, member: usize, entry: impl Fn(usize, usize) -> f64) {
        let block = &mut self.values[6 * self.nodes + 9 * member..][..9];
        for (slot, value) in block.iter_mut().enumerate() {
            *value += entry(slot / 3, slot % 3);
        }
    }

    /// Adds the 6×6 matrix `entry(i, j)` of a member.
    pub(super) fn add_element(&mut self, member: usize, entry: impl Fn(usize, usize) -> f64) {
        for (end, node) in self.bars[member].into_iter().enumerate() {
            self.add_node(node, |i, j| entry(3 * end + i, 3 * end + j));
        }
        self.add_member(member, |i, j| entry(i, 3 + j));
    }

    /// Returns an entry of the diagonal.
    pub(super) fn diagonal(&self, unknown: usize) -> f64 {
        self.values[6 * (unknown / 3) + [0, 2, 5][unknown % 3]]
    }

    /// Returns the largest entry of the diagonal.
    pub(super) fn largest_diagonal(&self) -> f64 {
        (0..3 * self.nodes)
            .map(|unknown| self.diagonal(unknown))
            .fold(0.0, f64::max)
    }

    /// Factors the matrix plus `shift` on the diagonal. Fixed unknowns have an equation of their
    /// own. Returns whether the matrix is positive definite.
    pub(super) fn factor(
        &mut self,
        is_fixed: impl Fn(usize) -> bool,
        shift: impl Fn(usize) -> f64,
    ) -> bool {
        let largest = self.largest_diagonal();
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let entries = self.memory.entries();
        entries.fill(0.0);
        for node in 0..self.nodes {
            for (k, [i, j]) in NODE_ENTRIES.into_iter().enumerate() {
                let (i, j) = (3 * node + i, 3 * node + j);
                let slot = 6 * node + k;
                let value = match (i == j, is_fixed(i) || is_fixed(j)) {
                    (true, true) => scale,
                    (true, false) => self.values[slot] + shift(i),
                    (false, true) => 0.0,
                    (false, false) => self.values[slot],
                };
                entries[self.slots[slot] as usize] += value;
            }
        }
        for (member, &[a, b]) in self.bars.iter().enumerate() {
            for entry in 0..9 {
                let slot = 6 * self.nodes + 9 * member + entry;
                let (i, j) = (3 * a as usize + entry / 3, 3 * b as usize + entry % 3);
                if !(is_fixed(i) || is_fixed(j)) {
                    entries[self.slots[slot] as usize] += self.values[slot];
                }
            }
        }
        self.pattern.factor(&mut self.memory)
    }

    /// Solves in place with the factors of the last [`Self::factor`].
    pub(super) fn back_substitute(&mut self, rhs: &mut [f64]) {
        self.pattern.back_substitute(&mut self.memory, rhs);
    }
}
