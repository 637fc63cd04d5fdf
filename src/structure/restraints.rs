//! Supports of several designs: displacements that are prevented in at least one design.
//!
//! A support that all designs have is rigid at all weights. Rollers whose direction differs between
//! designs turn from one direction to the next. A support that not all designs have becomes a
//! spring, whose stiffness follows from the weights of the designs that have it.

use super::model::{NodeHold, NodeSupport, StructuralModel};
use crate::geometry::DVec2;
use std::collections::BTreeSet;

/// Displacement of a node that a support prevents in at least one design.
#[derive(Clone, Debug)]
pub(super) struct Restraint {
    pub(super) node: u32,
    kind: RestraintKind,
    /// For each design, whether it has the support.
    is_present: Vec<bool>,
}

/// Kind of displacement that a restraint prevents.
#[derive(Clone, Debug)]
enum RestraintKind {
    /// The rotation.
    Rotation,
    /// The displacement along a direction: for each design, its angle in radians.
    Along(Vec<f64>),
}

/// Restraint at given weights.
#[derive(Clone, Copy, Debug)]
pub(super) struct RestraintAt {
    pub(super) node: u32,
    /// Direction of the displacement that is prevented; `None` for the rotation.
    pub(super) along: Option<DVec2>,
    /// Sum of the weights of the designs that have the support, from 0 to 1.
    pub(super) presence: f64,
}

impl Restraint {
    /// Returns the restraint at the given weights.
    pub(super) fn at(&self, weights: &[f64]) -> RestraintAt {
        let present = self.is_present.iter().zip(weights);
        let presence: f64 = present.map(|(&is, w)| if is { *w } else { 0.0 }).sum();
        RestraintAt {
            node: self.node,
            along: match &self.kind {
                RestraintKind::Rotation => None,
                RestraintKind::Along(angles) => {
                    Some(DVec2::from_angle(mean_angle(angles, weights)))
                }
            },
            presence: presence.clamp(0.0, 1.0),
        }
    }

    /// Returns whether any design holds the rotation of this node.
    pub(super) fn is_rotation_of(&self, node: u32) -> bool {
        self.node == node && matches!(self.kind, RestraintKind::Rotation)
    }

    /// Returns whether all designs have the support, with the same direction, so that it is the
    /// same at all weights.
    pub(super) fn is_constant(&self) -> bool {
        let is_same = match &self.kind {
            RestraintKind::Rotation => true,
            RestraintKind::Along(angles) => angles.windows(2).all(|pair| pair[0] == pair[1]),
        };
        is_same && self.is_present.iter().all(|&is_present| is_present)
    }
}

/// Returns the weighted mean of angles.
fn mean_angle(angles: &[f64], weights: &[f64]) -> f64 {
    angles.iter().zip(weights).map(|(x, w)| x * w).sum()
}

/// Returns the restraints of all nodes that any design supports.
pub(super) fn restraints(models: &[StructuralModel]) -> Vec<Restraint> {
    let nodes: BTreeSet<u32> = models
        .iter()
        .flat_map(|m| m.supports.keys().copied())
        .collect();
    let at_node = |node: u32| {
        let supports: Vec<NodeSupport> = (models.iter())
            .map(|model| model.supports.get(&node).copied().unwrap_or_default())
            .collect();
        restraints_of_node(node, &supports)
    };
    nodes.into_iter().flat_map(at_node).collect()
}

/// Returns the restraints of a node with the given support in each design.
fn restraints_of_node(node: u32, supports: &[NodeSupport]) -> Vec<Restraint> {
    let constant = |along: DVec2, is_present: Vec<bool>| Restraint {
        node,
        kind: RestraintKind::Along(vec![along.to_angle(); supports.len()]),
        is_present,
    };
    let is_full: Vec<bool> = supports.iter().map(|s| s.hold == NodeHold::Full).collect();
    let directions: Vec<DVec2> = (supports.iter())
        .filter_map(|support| match support.hold {
            NodeHold::Along(along) => Some(along),
            NodeHold::Free | NodeHold::Full => None,
        })
        .collect();
    let are_parallel = directions
        .windows(2)
        .all(|p| p[0].perp_dot(p[1]).abs() < 1e-9);
    let mut restraints = if directions.len() == supports.len() && !are_parallel {
        vec![turning(node, &directions)]
    } else if are_parallel {
        let along = directions.first().copied().unwrap_or(DVec2::X);
        let is_held = supports.iter().map(|s| s.hold != NodeHold::Free).collect();
        vec![constant(along, is_held), constant(along.perp(), is_full)]
    } else {
        // Rollers in different directions: each direction is held in the designs that have it.
        let of_directions = directions.iter().map(|&along| {
            let is_same = |support: &NodeSupport| {
                matches!(support.hold, NodeHold::Along(other) if other.perp_dot(along).abs() < 1e-9)
            };
            constant(along, supports.iter().map(is_same).collect())
        });
        [DVec2::X, DVec2::Y]
            .into_iter()
            .map(|axis| constant(axis, is_full.clone()))
            .chain(of_directions)
            .collect()
    };
    restraints.push(Restraint {
        node,
        kind: RestraintKind::Rotation,
        is_present: supports.iter().map(|support| support.rotation).collect(),
    });
    restraints.retain(|restraint| restraint.is_present.contains(&true));
    restraints
}

/// Returns the restraint along a direction that turns from one design to the next, the short way.
fn turning(node: u32, directions: &[DVec2]) -> Restraint {
    let first = directions[0].to_angle();
    let angle = |along: &DVec2| {
        // A direction and its opposite are the same restraint.
        let turned = DVec2::from_angle(-first).rotate(*along);
        let turned = if turned.x < 0.0 { -turned } else { turned };
        first + turned.to_angle()
    };
    Restraint {
        node,
        kind: RestraintKind::Along(directions.iter().map(angle).collect()),
        is_present: vec![true; directions.len()],
    }
}
