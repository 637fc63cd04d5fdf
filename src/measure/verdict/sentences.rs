//! How it is said.

use super::finding::{Finding, FindingCause, FindingKind, Remedy, SettingChange};
use crate::content::BlendSpace;
use crate::geometry::DVec2;
use std::fmt;

impl Finding {
    /// What is seen, and where on the way: "7 faces fold at t = 0.43".
    #[must_use]
    pub fn headline(&self) -> String {
        format!("{} at t = {:.2}", self.trouble, self.t)
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
            Self::Pieces { count, at_ends } => {
                write!(f, "{count} pieces instead of {at_ends}")
            }
            Self::Holes { count, at_ends } => match count {
                1 => write!(f, "1 hole instead of none"),
                count => write!(f, "{count} holes instead of {at_ends}"),
            },
            Self::Gone => write!(f, "nothing is left"),
            Self::PlaneFolds { share } => {
                write!(f, "the plane folds over {} of the frame", percent(*share))
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

/// A share, with as many digits as tell it from nothing.
fn percent(share: f64) -> String {
    // A share of 0.0 % would read as no trouble at all.
    let percent = 100.0 * share;
    if percent >= 10.0 {
        format!("{percent:.0} %")
    } else if percent >= 0.1 {
        format!("{percent:.1} %")
    } else {
        format!("{percent:.2} %")
    }
}

/// Radians in whole degrees.
fn degrees(angle: f64) -> String {
    format!("{:.0}°", angle.to_degrees())
}

fn near(place: &DVec2) -> String {
    format!("({}, {})", VerdictNumber(place.x), VerdictNumber(place.y))
}

/// A number with three digits, so that designs of any size can be read.
struct VerdictNumber(f64);

impl fmt::Display for VerdictNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        let decimals = match size {
            s if s >= 100.0 => 0,
            s if s >= 10.0 => 1,
            s if s >= 1.0 => 2,
            _ => 3,
        };
        write!(f, "{:.decimals$}", self.0)
    }
}

/// "3.2 times longer" or "shorter" than the mean.
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
                "straight paths flatten what turns, here by {}",
                degrees(turn.abs())
            ),
            Self::FarTurn { part, turn } => {
                let (what, other) = match part {
                    Some(part) => (format!("part {}", part + 1), "its neighbour"),
                    None => ("this place".to_owned(), "the whole"),
                };
                let by = degrees(turn.abs());
                write!(
                    f,
                    "{what} turns by {by} against {other}, more than half a turn"
                )
            }
            Self::UnevenMatch { ratio, source, .. } => write!(
                f,
                "near {} of the source the boundary becomes {} than elsewhere",
                near(source),
                stretched(*ratio)
            ),
            Self::UnlikeNeighbours { turn } => write!(
                f,
                "neighbouring faces turn by angles that are {} apart",
                degrees(*turn)
            ),
            Self::PlacesMeet { turns: [a, b], .. } => write!(
                f,
                "two places that turn by {} and {} run into each other",
                degrees(*a),
                degrees(*b)
            ),
            Self::LittleOverlap { share } => write!(
                f,
                "only {:.0} % of the smaller design lies on the other",
                100.0 * share
            ),
            Self::BlindFields => f.write_str("fields do not know which part becomes which"),
            Self::SeenTwice => f.write_str(
                "pins or lines near it pass each other, and the plane is turned over between them",
            ),
            Self::FeaturesMeet => f.write_str("pins come too near each other on their way"),
            Self::OutOfReach => f.write_str("the plane would have to fold to bring it there"),
            Self::NothingInside => f.write_str(
                "points of the boundary move on their own, nothing inside keeps them apart",
            ),
            Self::Unclear => f.write_str("no single cause stands out"),
        }
    }
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Change {
                change, left: 0, ..
            } => write!(f, "{change}: then there is none"),
            Self::Change { change, left, of } => {
                write!(f, "{change}: then {left} of {of} are left")
            }
            Self::Pin { source, target } => write!(
                f,
                "pin {} of the source to its place in the target, now {}",
                near(source),
                near(target)
            ),
            Self::MoveVertices { source, target } => write!(
                f,
                "move the vertices about {} of the source or {} of the target",
                near(source),
                near(target)
            ),
            Self::LayOver => write!(
                f,
                "lay the designs over each other (fit centred or same-area, or a placement)"
            ),
            Self::RigidParts => write!(f, "blend them as rigid parts"),
            Self::Lattices => write!(
                f,
                "move or delete some about it, or warp by lattices without folds"
            ),
            Self::AnotherWay => write!(f, "lead the path past it on the map"),
            Self::MovePins => write!(f, "move or delete pins about it"),
            Self::LetFold => write!(f, "move or delete pins about it, or let the lattices fold"),
        }
    }
}

impl fmt::Display for SettingChange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Homotopy(homotopy) => write!(f, "choose the {homotopy} homotopy"),
            Self::Symmetric => write!(f, "choose the symmetric energy"),
            Self::ExtraTurns(turns) => {
                let turns: Vec<_> = turns.iter().map(i32::to_string).collect();
                write!(
                    f,
                    "turn it the other way (extra turns {})",
                    turns.join(", ")
                )
            }
            Self::Space(BlendSpace::Real) => write!(f, "mix distances, not their logarithms"),
            Self::Space(BlendSpace::Log) => write!(f, "mix the logarithms of distances"),
        }
    }
}
