//! Errors and notes of the structural analysis.

use crate::io::sanitize::SanitizedLine;
use crate::work::progress::Cancelled;
use std::fmt;

/// Reason why a structure cannot be analysed. Bars are counted from 0, as in the file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StructureError {
    /// A design is not a truss. Holds its name.
    #[error("{} has no bars; open a truss to analyse it", SanitizedLine(.0))]
    NoTruss(String),
    /// The designs do not have the same bars.
    #[error("the designs do not have the same bars; give all of them the same nodes and bars")]
    BarsDiffer,
    /// The axial stiffness of a bar is outside the range of numbers.
    #[error(
        "the stiffness of bar {bar} is outside the range of numbers; correct its area, its Young's modulus or the units"
    )]
    Range {
        /// Index of the bar.
        bar: usize,
    },
    /// One bar is too stiff in comparison with another.
    #[error(
        "bar {stiff} is {ratio:.0e} times as stiff as bar {soft}, too much for accurate results; correct the areas or the Young's moduli"
    )]
    StiffnessRatio {
        /// Index of the stiffest bar.
        stiff: usize,
        /// Index of the softest bar.
        soft: usize,
        /// Ratio of their axial stiffnesses.
        ratio: f64,
    },
    /// A spring is so stiff in comparison with the bars that results would be inaccurate.
    #[error("spring {spring} is too stiff for accurate results; use a support instead")]
    StiffSpring {
        /// Index of the spring.
        spring: usize,
    },
    /// A load or the factor of a load case is too large. Holds the name of the load case.
    #[error("a load{} is too large to compute with; correct the forces, the factor or the units", in_case(.0))]
    LoadRange(String),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The system of equations does not fit into memory.
    #[error("the structure is too large to analyse; use fewer bars")]
    TooLarge,
}

/// Returns the words that name a load case; none for loads outside of load cases.
fn in_case(name: &str) -> String {
    match name {
        "" => String::new(),
        name => format!(" of the load case {}", SanitizedLine(name)),
    }
}

/// Number that a truss does not give, and the value that the analysis uses instead.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StructureNote {
    /// Bars without an area got an area that is usual for the size of the truss.
    DefaultArea,
    /// Bars without a section are round tubes.
    DefaultSection,
    /// Numbers of a material whose name contains no standard grade are those of a grade.
    AssumedGrade {
        /// Name of the material; empty for bars without a material.
        material: String,
        /// Name of the grade.
        grade: &'static str,
    },
}

impl fmt::Display for StructureNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DefaultArea => f.write_str(
                "bars have no \"areas\"; an area of (span / 500)² was assumed for each",
            ),
            Self::DefaultSection => f.write_str(
                "bars have no section; round tubes with a wall of 1/20 of the diameter were assumed",
            ),
            Self::AssumedGrade { material, grade } if material.is_empty() => {
                write!(f, "bars have no material; steel {grade} was assumed")
            }
            Self::AssumedGrade { material, grade } => {
                let material = SanitizedLine(material);
                write!(f, "missing numbers of {material} were assumed to be those of steel {grade}")
            }
        }
    }
}
