//! Source and target of a transition, and a container with one value for each.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::{Index, IndexMut};

/// One of the two designs of a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// The design at t = 0.
    Source,
    /// The design at t = 1.
    Target,
}

impl Side {
    /// Both sides: source, then target.
    pub const BOTH: [Self; 2] = [Self::Source, Self::Target];

    /// Returns 0 for the source and 1 for the target.
    #[must_use]
    pub const fn index(self) -> usize {
        match self {
            Self::Source => 0,
            Self::Target => 1,
        }
    }

    /// Returns the other design.
    #[must_use]
    pub const fn other(self) -> Self {
        match self {
            Self::Source => Self::Target,
            Self::Target => Self::Source,
        }
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Source => "source",
            Self::Target => "target",
        })
    }
}

/// Arrays of two can be indexed by side, the source first.
impl<T> Index<Side> for [T; 2] {
    type Output = T;

    fn index(&self, side: Side) -> &T {
        &self[side.index()]
    }
}

impl<T> IndexMut<Side> for [T; 2] {
    fn index_mut(&mut self, side: Side) -> &mut T {
        &mut self[side.index()]
    }
}

/// One value for the source and one for the target.
///
/// ```
/// use morphospace::geometry::{Side, SourceTarget};
/// let names = SourceTarget { source: "A", target: "B" };
/// assert_eq!(names[Side::Target], "B");
/// assert_eq!(names.swapped().map(str::len), SourceTarget { source: 1, target: 1 });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SourceTarget<T> {
    /// Value of the source.
    pub source: T,
    /// Value of the target.
    pub target: T,
}

impl<T> SourceTarget<T> {
    /// Creates a pair from a function of the side.
    pub fn from_fn(mut value_of: impl FnMut(Side) -> T) -> Self {
        Self {
            source: value_of(Side::Source),
            target: value_of(Side::Target),
        }
    }

    /// Creates a pair with the value `here` for the given side and `across` for the other side.
    pub fn with_side(side: Side, here: T, across: T) -> Self {
        let (source, target) = match side {
            Side::Source => (here, across),
            Side::Target => (across, here),
        };
        Self { source, target }
    }

    /// Applies a function to both values.
    pub fn map<U>(self, mut map: impl FnMut(T) -> U) -> SourceTarget<U> {
        SourceTarget {
            source: map(self.source),
            target: map(self.target),
        }
    }

    /// Returns the pair with source and target exchanged.
    #[must_use]
    pub fn swapped(self) -> Self {
        Self {
            source: self.target,
            target: self.source,
        }
    }

    /// Returns the values of source and target, in this order.
    pub fn to_array(self) -> [T; 2] {
        [self.source, self.target]
    }
}

impl<T> Index<Side> for SourceTarget<T> {
    type Output = T;

    fn index(&self, side: Side) -> &T {
        match side {
            Side::Source => &self.source,
            Side::Target => &self.target,
        }
    }
}

impl<T> IndexMut<Side> for SourceTarget<T> {
    fn index_mut(&mut self, side: Side) -> &mut T {
        match side {
            Side::Source => &mut self.source,
            Side::Target => &mut self.target,
        }
    }
}
