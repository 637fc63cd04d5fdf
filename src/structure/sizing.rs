//! Sizing of members: the least areas with which every member carries its force.
//!
//! Fully stressed design by the stress ratio (Gallagher 1973): each area becomes the least one that
//! carries the force of the last analysis, until the areas no longer change. A compressed bar that
//! is pinned at both ends must also not buckle; the shape of its section stays, so that i² = κA.
//!
//! Guaranteed: if `is_converged`, no member exceeds its strength or its Euler load by more than
//! [`TOLERANCE`]. Not guaranteed: the least mass of a statically indeterminate structure.

use super::blend::LoadSelection;
use super::element::MemberProperties;
use super::solver::StructureSolver;
use crate::geometry::DVec2;
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use serde::Serialize;
use std::f64::consts::PI;

/// Relative change of an area at which sizing ends (numerical tolerance).
pub const TOLERANCE: f64 = 1e-4;

/// Maximum number of analyses (resource limit).
const MAX_ROUNDS: usize = 200;

/// Least areas of sized members.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SizingOptions {
    /// Least area of a member in m².
    pub least_area: f64,
    /// Least area of a member as a fraction of the largest area; 0.05 by default, so that bars
    /// without force remain buildable.
    pub least_share: f64,
    /// Whether compressed bars are sized against buckling.
    pub resists_buckling: bool,
}

impl Default for SizingOptions {
    fn default() -> Self {
        Self {
            least_area: 0.0,
            least_share: 0.05,
            resists_buckling: true,
        }
    }
}

/// Result of sizing the members at one t.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SizedMembers {
    /// Area of each member in m².
    pub areas: Vec<f64>,
    /// Mass of all members in kg.
    pub mass: f64,
    /// Whether the areas no longer changed.
    pub is_converged: bool,
}

impl StructureSolver {
    /// Sizes all members for the loads with the nodes at `places`, in units of the common frame.
    /// Afterwards [`Self::state`] is that of the sized structure. `None` for a mechanism.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled.
    ///
    /// # Panics
    /// As [`Self::solve`].
    pub fn size_members(
        &mut self,
        places: &[DVec2],
        weights: &[f64],
        selection: LoadSelection,
        options: &SizingOptions,
        progress: &dyn Progress,
    ) -> Result<Option<SizedMembers>, Cancelled> {
        let mut areas: Vec<f64> = Vec::new();
        for _ in 0..MAX_ROUNDS {
            check_cancelled(progress)?;
            self.solve_with_areas(&areas, places, weights, selection);
            let Some(needed) = self.needed_areas(options) else {
                return Ok(None);
            };
            let changes = needed
                .iter()
                .zip(&areas)
                .map(|(new, old)| (new - old).abs() / new);
            let is_converged = !areas.is_empty() && changes.fold(0.0, f64::max) <= TOLERANCE;
            areas = needed;
            if is_converged {
                let mass = self
                    .solve_with_areas(&areas, places, weights, selection)
                    .mass;
                return Ok(Some(SizedMembers {
                    areas,
                    mass,
                    is_converged,
                }));
            }
        }
        let mass = self
            .solve_with_areas(&areas, places, weights, selection)
            .mass;
        Ok(Some(SizedMembers {
            areas,
            mass,
            is_converged: false,
        }))
    }

    /// Returns the areas that carry the forces of the last analysis; `None` for a mechanism, or if
    /// nothing is loaded.
    fn needed_areas(&self, options: &SizingOptions) -> Option<Vec<f64>> {
        let state = self.state();
        let members = state.forces.iter().zip(&state.properties).enumerate();
        let needed = members.map(|(bar, (forces, own))| {
            let by_strength = own.area * state.utilisation(bar);
            let compression = (-forces.axial).max(0.0);
            let is_pinned = own.fixity == [0.0; 2];
            match options.resists_buckling && is_pinned && own.radius > 0.0 {
                true => by_strength.max(area_against_buckling(own, forces.length, compression)),
                false => by_strength,
            }
        });
        let needed: Vec<f64> = needed.collect();
        let largest = needed.iter().copied().fold(0.0, f64::max);
        // A member without area could never get any.
        let least = options.least_share.max(TOLERANCE) * largest;
        let least = least.max(options.least_area);
        (least > 0.0 && !state.is_mechanism)
            .then(|| needed.into_iter().map(|area| area.max(least)).collect())
    }
}

/// Returns the area with which a pinned bar of the same shape just carries a compression in N: the
/// solution of N = π² E κ A² / L² with κ = i²/A.
fn area_against_buckling(own: &MemberProperties, length: f64, compression: f64) -> f64 {
    let shape = own.radius.powi(2) / own.area;
    (compression / (own.modulus * shape)).sqrt() * length / PI
}
