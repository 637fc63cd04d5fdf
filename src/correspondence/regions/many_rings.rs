//! Designs of very many rings: what is not tried for them.
//!
//! Each ring is matched for itself, in time that grows with the square of its
//! samples, and each hole without a partner could be cut open in dozens of
//! ways. What an icon deserves is too much for a net of 100 holes: beyond a
//! crowd the samples of all rings together stay as many as those of a crowd,
//! holes without a partner close, and the match that was asked for is the only
//! one.

use super::super::{HoleRule, MatchOptions};
use crate::geometry::Regions;

/// Rings in one design from which on they are a crowd: the public icons and
/// letters have up to 28, but for a net of 72. 100 holes against none took
/// 40 s as no crowd.
const CROWD: usize = 32;

/// The fewest samples of a ring: enough for the corners of a letter.
const LEAST_SAMPLES: u32 = 24;

fn rings(designs: [&Regions; 2]) -> usize {
    let count = |design: &Regions| design.rings().count();
    designs.map(count).into_iter().max().unwrap_or(0)
}

/// Whether one of the designs has very many rings.
pub(super) fn has_many_rings(designs: [&Regions; 2]) -> bool {
    rings(designs) > CROWD
}

/// How each ring is matched.
pub(super) fn options(options: &MatchOptions, designs: [&Regions; 2]) -> MatchOptions {
    let rings = rings(designs).max(CROWD);
    let share = (options.samples as usize * CROWD / rings) as u32;
    MatchOptions {
        samples: share.max(LEAST_SAMPLES.min(options.samples)),
        ..options.clone()
    }
}

/// What becomes of holes without a partner.
pub(super) fn hole_rule(rule: HoleRule, is_crowd: bool) -> HoleRule {
    match rule {
        HoleRule::Auto if is_crowd => HoleRule::Close,
        rule => rule,
    }
}
