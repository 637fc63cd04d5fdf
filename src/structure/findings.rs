//! Findings of the concept check: faults of a structure between two designs, in the order of gravity,
//! each with its place and its t.

use super::limits::StructureLimits;
use super::sample::{BarValue, StructureSample};
use super::words::{BoundedNumber, LengthInWords, NodeList};
use serde::Serialize;
use std::fmt;

/// Fault of a structure.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum StructureFault {
    /// Parts of the structure move against each other without resistance.
    FallsOver {
        /// Nodes that move.
        nodes: Vec<u32>,
    },
    /// The structure or a piece of it moves as a whole, because supports are missing.
    NotHeld {
        /// Nodes that move.
        nodes: Vec<u32>,
    },
    /// A moment acts on a node at which all bars are pinned.
    LoadOnNothing {
        /// Nodes with a moment that nothing resists.
        nodes: Vec<u32>,
    },
    /// The bars are not connected with each other.
    InPieces {
        /// Number of pieces.
        pieces: usize,
    },
    /// The stress in a bar exceeds its strength.
    OverStrength {
        /// Index of the bar.
        bar: usize,
        /// Stress divided by strength.
        utilisation: f64,
    },
    /// A bar buckles under the loads.
    BarBuckles {
        /// Index of the bar.
        bar: usize,
        /// Compression divided by Euler's load.
        utilisation: f64,
    },
    /// The frame buckles as a whole, or nearly does.
    FrameBuckles {
        /// Load factor at which it buckles.
        factor: f64,
        /// Load factor that is required.
        limit: f64,
    },
    /// The structure bends too far.
    Sags {
        /// Node that moves farthest.
        node: u32,
        /// Its displacement in m.
        deflection: f64,
        /// Span divided by the displacement.
        span_ratio: f64,
        /// Required span divided by the displacement.
        limit: f64,
    },
    /// A bar is too slender.
    Slender {
        /// Index of the bar.
        bar: usize,
        /// Length divided by the radius of gyration.
        slenderness: f64,
        /// Largest allowed slenderness.
        limit: f64,
    },
    /// Two bars meet at a small angle.
    SharpAngle {
        /// Indices of the bars.
        bars: [usize; 2],
        /// Angle in degrees.
        angle_deg: f64,
    },
    /// A bar is shorter than its section is high.
    Stub {
        /// Index of the bar.
        bar: usize,
        /// Length in m.
        length: f64,
    },
    /// The structure vibrates much more slowly than both designs.
    Limp {
        /// First natural frequency in Hz.
        frequency: f64,
        /// That of the design with the lower frequency.
        of_designs: f64,
    },
    /// Two bars cross without a joint that do not cross in both designs.
    CrossesWithoutJoint {
        /// Indices of the bars.
        bars: [usize; 2],
    },
}

/// Fault of a structure with the times at which it was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct StructureFinding {
    /// The t at which the fault is worst.
    pub t: f64,
    /// First and last t at which a fault of this kind was found.
    pub from: f64,
    /// Last t at which a fault of this kind was found.
    pub to: f64,
    /// The fault where it is worst.
    #[serde(flatten)]
    pub fault: StructureFault,
}

impl StructureFault {
    /// Returns the rank of the kind of fault in the order of gravity, from 0, the gravest.
    #[must_use]
    pub fn rank(&self) -> usize {
        match self {
            Self::FallsOver { .. } => 0,
            Self::NotHeld { .. } => 1,
            Self::LoadOnNothing { .. } => 2,
            Self::InPieces { .. } => 3,
            Self::OverStrength { .. } => 4,
            Self::BarBuckles { .. } => 5,
            Self::FrameBuckles { .. } => 6,
            Self::Sags { .. } => 7,
            Self::Slender { .. } => 8,
            Self::SharpAngle { .. } => 9,
            Self::Stub { .. } => 10,
            Self::Limp { .. } => 11,
            Self::CrossesWithoutJoint { .. } => 12,
        }
    }

    /// Returns whether the structure is unsound with this fault. With other faults, it is marginal.
    #[must_use]
    pub fn is_unsound(&self) -> bool {
        match self {
            Self::FrameBuckles { factor, .. } => *factor <= 1.0,
            fault => fault.rank() <= 5,
        }
    }

    /// Returns a number that is larger, the worse the fault is among faults of its kind.
    fn severity(&self) -> f64 {
        match self {
            Self::FallsOver { nodes } | Self::NotHeld { nodes } | Self::LoadOnNothing { nodes } => {
                nodes.len() as f64
            }
            Self::InPieces { pieces } => *pieces as f64,
            Self::OverStrength { utilisation, .. } | Self::BarBuckles { utilisation, .. } => {
                *utilisation
            }
            Self::FrameBuckles { factor, .. } => -factor,
            Self::Sags { span_ratio, .. } => -span_ratio,
            Self::Slender {
                slenderness, limit, ..
            } => slenderness / limit,
            Self::SharpAngle { angle_deg, .. } => -angle_deg,
            Self::Stub { length, .. } => -length,
            Self::Limp { frequency, .. } => -frequency,
            Self::CrossesWithoutJoint { .. } => 0.0,
        }
    }
}

/// Returns the faults of a structure at one t. `shape` holds those of its shape; `least_frequency` is the lower first frequency of
/// both designs, if they stand.
pub(super) fn faults(
    sample: &StructureSample,
    shape: Vec<StructureFault>,
    limits: &StructureLimits,
    least_frequency: Option<f64>,
) -> Vec<StructureFault> {
    let mut faults = shape;
    let above = |value: Option<BarValue>, limit: f64| value.filter(|v| v.value > limit);
    let bar_faults = [
        above(sample.strength, 1.0).map(|found| StructureFault::OverStrength {
            bar: found.bar,
            utilisation: found.value,
        }),
        above(sample.euler, 1.0).map(|found| StructureFault::BarBuckles {
            bar: found.bar,
            utilisation: found.value,
        }),
        frame_buckles(sample, limits),
        sags(sample, limits),
    ];
    faults.extend(bar_faults.into_iter().flatten());
    for (value, limit) in [
        (sample.compressed_slenderness, limits.compressed_slenderness),
        (sample.tension_slenderness, limits.tension_slenderness),
    ] {
        faults.extend(above(value, limit).map(|found| StructureFault::Slender {
            bar: found.bar,
            slenderness: found.value,
            limit,
        }));
    }
    if let (Some(frequency), Some(of_designs)) = (sample.frequency, least_frequency)
        && frequency < limits.least_frequency_share * of_designs
    {
        faults.push(StructureFault::Limp {
            frequency,
            of_designs,
        });
    }
    faults
}

/// Returns the fault of a frame whose buckling factor is below a limit.
fn frame_buckles(sample: &StructureSample, limits: &StructureLimits) -> Option<StructureFault> {
    let factor = sample.critical_load_factor?;
    let least = limits.least_buckling_factor;
    let limit = if factor < least {
        least
    } else {
        limits.buckling_factor
    };
    (factor < limit).then_some(StructureFault::FrameBuckles { factor, limit })
}

/// Returns the fault of a structure that bends farther than its limit.
fn sags(sample: &StructureSample, limits: &StructureLimits) -> Option<StructureFault> {
    let (node, limit) = (sample.deflected_node?, limits.span_to_deflection);
    let span_ratio = sample.span / sample.deflection;
    (span_ratio < limit).then_some(StructureFault::Sags {
        node,
        deflection: sample.deflection,
        span_ratio,
        limit,
    })
}

/// Merges the faults of all samples: one finding for each kind, at the t where it is worst.
pub(super) fn merged(samples: &[(f64, Vec<StructureFault>)]) -> Vec<StructureFinding> {
    let mut findings: Vec<StructureFinding> = Vec::new();
    for (t, fault) in samples
        .iter()
        .flat_map(|(t, faults)| faults.iter().map(move |f| (*t, f)))
    {
        match findings
            .iter_mut()
            .find(|finding| finding.fault.rank() == fault.rank())
        {
            None => findings.push(StructureFinding {
                t,
                from: t,
                to: t,
                fault: fault.clone(),
            }),
            Some(finding) => {
                finding.to = t;
                if fault.severity() > finding.fault.severity() {
                    (finding.t, finding.fault) = (t, fault.clone());
                }
            }
        }
    }
    findings.sort_by_key(|finding| finding.fault.rank());
    findings
}

impl fmt::Display for StructureFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verb = |nodes: &[u32]| if nodes.len() == 1 { "moves" } else { "move" };
        match self {
            Self::FallsOver { nodes } => {
                write!(f, "falls over: {} {}", NodeList(nodes), verb(nodes))
            }
            Self::NotHeld { nodes } => {
                write!(
                    f,
                    "not held: {} {} as a whole",
                    NodeList(nodes),
                    verb(nodes)
                )
            }
            Self::LoadOnNothing { nodes } => {
                write!(f, "a moment acts on the pinned {}", NodeList(nodes))
            }
            Self::InPieces { pieces } => write!(f, "in {pieces} pieces"),
            fault => fault.write_limit(f),
        }
    }
}

impl StructureFault {
    /// Writes the faults of structures that exceed a limit or have an unsuitable shape.
    fn write_limit(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OverStrength { bar, utilisation } => {
                write!(
                    f,
                    "bar {bar} is at {} % of its strength",
                    BoundedNumber(100.0 * utilisation, 0)
                )
            }
            Self::BarBuckles { bar, utilisation } => {
                write!(
                    f,
                    "bar {bar} buckles at {} of the load",
                    BoundedNumber(utilisation.recip(), 2)
                )
            }
            Self::FrameBuckles { factor, limit } => {
                write!(
                    f,
                    "the frame buckles at {factor:.2} of the load (limit {limit})"
                )
            }
            Self::Sags {
                node,
                deflection,
                span_ratio,
                limit,
            } => {
                let decimals = usize::from(*span_ratio < 10.0);
                write!(
                    f,
                    "node {node} moves by {}, span/{span_ratio:.decimals$} (limit span/{limit})",
                    LengthInWords(*deflection)
                )
            }
            Self::Slender {
                bar,
                slenderness,
                limit,
            } => write!(
                f,
                "bar {bar} has a slenderness of {} (limit {limit})",
                BoundedNumber(*slenderness, 0)
            ),
            fault => fault.write_shape(f),
        }
    }

    /// Writes the faults of shape and vibration.
    fn write_shape(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SharpAngle {
                bars: [a, b],
                angle_deg,
            } => write!(f, "bars {a} and {b} meet at {angle_deg:.0}°"),
            Self::Stub { bar, length } => {
                write!(f, "bar {bar} is a stub of {:.0} mm", 1e3 * length)
            }
            Self::Limp {
                frequency,
                of_designs,
            } => write!(
                f,
                "vibrates at {frequency:.2} Hz, the designs at {of_designs:.2} Hz or more"
            ),
            Self::CrossesWithoutJoint { bars: [a, b] } => {
                write!(f, "bars {a} and {b} cross without a joint")
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for StructureFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} at t = {:.3}", self.fault, self.t)?;
        if self.from < self.to {
            write!(f, " (found from {:.3} to {:.3})", self.from, self.to)?;
        }
        Ok(())
    }
}
