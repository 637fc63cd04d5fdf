//! Source or target.

use serde::{Deserialize, Serialize};

/// One of the two designs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// The design at t = 0.
    Source,
    /// The design at t = 1.
    Target,
}

impl Side {
    /// Source, then target.
    pub const BOTH: [Self; 2] = [Self::Source, Self::Target];

    /// 0 for the source, 1 for the target.
    #[must_use]
    pub const fn index(self) -> usize {
        match self {
            Self::Source => 0,
            Self::Target => 1,
        }
    }

    /// The one across.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Source => Self::Target,
            Self::Target => Self::Source,
        }
    }
}
