//! Source and target, and what there is one of for each.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::{Index, IndexMut};

/// One of the two designs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
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

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Source => "source",
            Self::Target => "target",
        })
    }
}

/// A list of two is read by side as well: the source's comes first.
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

/// One thing of the source and one of the target.
///
/// ```
/// use morphospace::geometry::{Pair, Side};
/// let names = Pair { source: "A", target: "B" };
/// assert_eq!(names[Side::Target], "B");
/// assert_eq!(names.swapped().map(str::len), Pair { source: 1, target: 1 });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SourceTarget<T> {
    /// In the source.
    pub source: T,
    /// In the target.
    pub target: T,
}

impl<T> SourceTarget<T> {
    /// What `of` says of each side.
    pub fn of(mut of: impl FnMut(Side) -> T) -> Self {
        Self {
            source: of(Side::Source),
            target: of(Side::Target),
        }
    }

    /// One thing on a side, another across.
    pub fn on(side: Side, here: T, across: T) -> Self {
        let (source, target) = match side {
            Side::Source => (here, across),
            Side::Target => (across, here),
        };
        Self { source, target }
    }

    /// Both sent through one map.
    pub fn map<U>(self, mut map: impl FnMut(T) -> U) -> SourceTarget<U> {
        SourceTarget {
            source: map(self.source),
            target: map(self.target),
        }
    }

    /// The designs exchanged.
    #[must_use]
    pub fn swapped(self) -> Self {
        Self {
            source: self.target,
            target: self.source,
        }
    }

    /// Source, then target.
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
