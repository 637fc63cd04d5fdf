//! Texts of findings: the headline, the cause and the remedy in plain English.

use super::finding::{Finding, FindingCause, FindingKind, Remedy, SettingChange};
use crate::content::BlendSpace;
use crate::geometry::DVec2;
use std::fmt;

impl Finding {
    /// Returns the defect and its moment: "7 faces fold near t = 0.43".
    #[must_use]
    pub fn headline(&self) -> String {
        format!("{} near t = {:.2}", self.trouble, self.t)
    }
}

impl fmt::Display for FindingKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folds { faces } if faces.len() == 1 => write!(f, "1 face folds"),
            Self::Folds { faces } => write!(f, "{} faces fold", faces.len()),
            Self::Crossings { crossings } => match crossings.len() {
                1 => write!(f, "the boundary crosses itself"),
                2 => write!(f, "the boundary crosses itself twice"),
                n => write!(f, "the boundary crosses itself {n} times"),
            },
            Self::Pieces { count, .. } => write!(f, "breaks into {count} pieces"),
            Self::Holes { count, at_ends } => match count {
                1 => write!(f, "1 hole instead of none"),
                count => write!(f, "{count} holes instead of {at_ends}"),
            },
            Self::Gone => write!(f, "the shape disappears"),
            Self::PlaneFolds { share } => {
                write!(f, "the plane folds in {} of the frame", percent(*share))
            }
            Self::Missed { count, by } => {
                let pins = if *count == 1 { "pin is" } else { "pins are" };
                write!(
                    f,
                    "{count} {pins} missed by up to {} of the frame",
                    percent(*by)
                )
            }
        }
    }
}

/// Formats a fraction as a percentage, with enough digits that small fractions do not read as zero.
fn percent(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    if percent >= 10.0 {
        format!("{percent:.0} %")
    } else if percent >= 0.1 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.2} %")
    }
}

/// Formats an angle in radians as whole degrees.
fn degrees(angle: f64) -> String {
    format!("{:.0}°", angle.to_degrees())
}

/// Formats a position with about three digits per coordinate.
fn position(place: &DVec2) -> String {
    format!("({}, {})", VerdictNumber(place.x), VerdictNumber(place.y))
}

/// A number formatted with about three significant digits.
struct VerdictNumber(f64);

impl fmt::Display for VerdictNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let magnitude = self.0.abs();
        let decimals = match magnitude {
            s if s >= 100.0 => 0,
            s if s >= 10.0 => 1,
            s if s >= 1.0 => 2,
            _ => 3,
        };
        write!(f, "{:.decimals$}", self.0)
    }
}

/// Formats a ratio of stretches as "3.2 times longer" or "3.2 times shorter".
fn stretched(ratio: f64) -> String {
    if ratio >= 1.0 {
        format!("{ratio:.1} times longer")
    } else {
        format!("{:.1} times shorter", 1.0 / ratio)
    }
}

impl fmt::Display for FindingCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StraightPaths { turn, .. } => write!(
                f,
                "straight paths flatten parts that rotate, here by {}",
                degrees(turn.abs())
            ),
            Self::FarTurn { part, turn } => {
                let (place, other) = match part {
                    Some(part) => (format!("part {}", part + 1), "its neighbour"),
                    None => ("this place".to_owned(), "the whole shape"),
                };
                let angle = degrees(turn.abs());
                write!(
                    f,
                    "{place} rotates by {angle} relative to {other}, more than half a turn"
                )
            }
            Self::UnevenMatch { ratio, source, .. } => write!(
                f,
                "near {} in the source, the boundary becomes {} than elsewhere",
                position(source),
                stretched(*ratio)
            ),
            Self::UnlikeNeighbours { turn } => write!(
                f,
                "neighbouring faces rotate by angles that differ by {}",
                degrees(*turn)
            ),
            Self::PlacesMeet { turns: [a, b], .. } => write!(
                f,
                "two places that rotate by {} and {} collide",
                degrees(*a),
                degrees(*b)
            ),
            Self::LittleOverlap { share } => write!(
                f,
                "only {:.0} % of the smaller design overlaps the other",
                100.0 * share
            ),
            Self::BlindFields => f.write_str("distance fields do not match parts with each other"),
            Self::SeenTwice => f.write_str(
                "pins or lines near this place pass each other, so the plane folds between them",
            ),
            Self::FeaturesMeet => f.write_str("pins come too close to each other at this t"),
            Self::OutOfReach => f.write_str("no warp without folds reaches all pins and lines"),
            Self::NothingInside => f.write_str(
                "boundary points move independently, and no mesh inside keeps them apart",
            ),
            Self::Unclear => f.write_str("no single cause was found"),
        }
    }
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Change {
                change, left: 0, ..
            } => write!(f, "{change}: no defects remain"),
            Self::Change { change, left, of } => {
                write!(f, "{change}: {left} of {of} defects remain")
            }
            Self::Pin { source, target } => write!(
                f,
                "pin {} in the source to its counterpart in the target; now it is matched to {}",
                position(source),
                position(target)
            ),
            Self::MoveVertices { source, target } => write!(
                f,
                "move the vertices near {} in the source or {} in the target",
                position(source),
                position(target)
            ),
            Self::LayOver => write!(
                f,
                "make the designs overlap (align them as centred or same area, or move one of them)"
            ),
            Self::RigidParts => write!(f, "choose rigid parts as the method"),
            Self::Lattices => write!(
                f,
                "move or delete pins or lines near this place, or choose lattices without folds"
            ),
            Self::AnotherWay => {
                write!(f, "change the path on the map so that it avoids this blend")
            }
            Self::MovePins => write!(f, "move or delete pins near this place"),
            Self::LetFold => write!(
                f,
                "move or delete pins near this place, or allow the lattices to fold"
            ),
        }
    }
}

impl fmt::Display for SettingChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Homotopy(homotopy) => write!(f, "use {homotopy} interpolation"),
            Self::Symmetric => write!(f, "use the symmetric energy"),
            Self::ExtraTurns(turns) => {
                let turns: Vec<_> = turns.iter().map(i32::to_string).collect();
                write!(
                    f,
                    "rotate it the other way (extra turns {})",
                    turns.join(", ")
                )
            }
            Self::Space(BlendSpace::Real) => write!(f, "use linear distances"),
            Self::Space(BlendSpace::Log) => write!(f, "use logarithmic distances"),
        }
    }
}
