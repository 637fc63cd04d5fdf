//! Displacements of the nodes: the axes in which they are measured, and which of them are fixed.

use super::restraints::RestraintAt;
use crate::geometry::DVec2;

/// Presence from which a support counts as rigid (numerical tolerance: a spring of larger stiffness
/// would cost digits of the results).
const RIGID_FROM: f64 = 1.0 - 1e-9;

/// Axes of a node and the displacements that are fixed there.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeAxes {
    /// Direction of the first displacement; the second is a quarter turn to the left of it.
    pub(super) x: DVec2,
    /// Whether the displacements along both axes and the rotation are fixed.
    pub(super) is_fixed: [bool; 3],
}

/// Spring between a node and the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroundSpring {
    pub(super) node: u32,
    /// Displacement that stretches the spring by 1, in the axes of the node.
    pub(super) mode: [f64; 3],
    /// Stiffness in N/m, or in N m for a rotation.
    pub(super) stiffness: f64,
}

impl NodeAxes {
    pub(super) const FREE: Self = Self {
        x: DVec2::X,
        is_fixed: [false; 3],
    };

    /// Fixes what a restraint fixes if it is rigid.
    pub(super) fn fix(&mut self, restraint: &RestraintAt) {
        if !restraint.is_rigid() {
            return;
        }
        match restraint.along {
            None => self.is_fixed[2] = true,
            Some(along) if !self.is_fixed[0] => {
                self.x = along;
                self.is_fixed[0] = true;
            }
            Some(along) if along.perp_dot(self.x).abs() > 1e-9 => self.is_fixed[1] = true,
            Some(_) => {}
        }
    }

    /// Returns the components of a vector and a moment in the axes of the node.
    pub(super) fn local(&self, vector: DVec2, moment: f64) -> [f64; 3] {
        [vector.dot(self.x), vector.dot(self.x.perp()), moment]
    }

    /// Returns the vector with the given components in the axes of the node.
    pub(super) fn global(&self, [x, y, rotation]: [f64; 3]) -> [f64; 3] {
        let vector = x * self.x + y * self.x.perp();
        [vector.x, vector.y, rotation]
    }
}

impl RestraintAt {
    /// Returns whether the support is rigid, and not a spring.
    pub(super) fn is_rigid(&self) -> bool {
        self.presence >= RIGID_FROM
    }

    /// Returns the spring that stands for a restraint that is not rigid. `stiffness` holds k₀ for
    /// displacements and for rotations.
    pub(super) fn spring(&self, axes: &NodeAxes, stiffness: [f64; 2]) -> GroundSpring {
        let (mode, k0) = match self.along {
            None => ([0.0, 0.0, 1.0], stiffness[1]),
            Some(along) => (axes.local(along, 0.0), stiffness[0]),
        };
        GroundSpring {
            node: self.node,
            mode,
            stiffness: k0 * self.presence / (1.0 - self.presence),
        }
    }
}
