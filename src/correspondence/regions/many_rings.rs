//! Limits the effort of matching designs with very many rings (outer boundaries and holes).
//!
//! The time to match a ring grows with the square of its samples, and each unmatched hole could be
//! cut open in dozens of ways. If a design has more than [`MAX_RINGS`] rings, the samples of all
//! rings together are limited, unmatched holes close, and no variants of the requested match are
//! tried.

use super::super::{HoleRule, MatchOptions};
use crate::geometry::Regions;

/// Number of rings in one design above which the limits apply (resource limit: almost all icons and
/// letters have fewer).
const MAX_RINGS: usize = 32;

/// Minimum number of samples of a ring if rings are many, enough for the corners of a letter
/// (heuristic).
const MIN_SAMPLES: u32 = 24;

/// Returns the larger of the two designs' numbers of rings.
fn max_ring_count(designs: [&Regions; 2]) -> usize {
    let count = |design: &Regions| design.rings().count();
    designs.map(count).into_iter().max().unwrap_or(0)
}

/// Returns whether one of the designs has very many rings.
pub(super) fn has_many_rings(designs: [&Regions; 2]) -> bool {
    max_ring_count(designs) > MAX_RINGS
}

/// Returns the options with which each ring is matched: with many rings, each gets fewer samples.
pub(super) fn options(options: &MatchOptions, designs: [&Regions; 2]) -> MatchOptions {
    let rings = max_ring_count(designs).max(MAX_RINGS);
    let share = (options.samples as usize * MAX_RINGS / rings) as u32;
    MatchOptions {
        samples: share.max(MIN_SAMPLES.min(options.samples)),
        ..options.clone()
    }
}

/// Returns the rule for unmatched holes: with many rings, `Auto` means that they close.
pub(super) fn hole_rule(rule: HoleRule, is_crowd: bool) -> HoleRule {
    match rule {
        HoleRule::Auto if is_crowd => HoleRule::Close,
        rule => rule,
    }
}
