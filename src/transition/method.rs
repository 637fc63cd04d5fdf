//! The table of methods: which warp can be combined with which content.

use crate::content::ContentKind;
use crate::warp::{CellLabels, CellSupport, WarpKind};

/// A method: a supported combination of warp and content.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TransitionMethod {
    warp: WarpKind,
    content: ContentKind,
}

/// Error: a combination of warp and content that is not supported, with the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct UnsupportedMethod {
    reason: &'static str,
}

impl TransitionMethod {
    /// Solid parts that move as rigidly as possible.
    pub const RIGID_PARTS: Self = Self {
        warp: WarpKind::Arap,
        content: ContentKind::Solid,
    };

    /// Distance fields that blend in place.
    pub const FIELD_BLEND: Self = Self {
        warp: WarpKind::None,
        content: ContentKind::Field,
    };

    /// Pictures that cross-dissolve in place.
    pub const CROSS_DISSOLVE: Self = Self {
        warp: WarpKind::None,
        content: ContentKind::Colours,
    };

    /// Returns the method to use where this one cannot be built. With the returned method nothing
    /// moves, so that nothing needs to be matched; solids are blended as distance fields.
    ///
    /// ```
    /// use morphospace::transition::TransitionMethod;
    /// assert_eq!(TransitionMethod::RIGID_PARTS.fallback(), TransitionMethod::FIELD_BLEND);
    /// assert_eq!(TransitionMethod::CROSS_DISSOLVE.fallback(), TransitionMethod::CROSS_DISSOLVE);
    /// ```
    #[must_use]
    pub const fn fallback(self) -> Self {
        match self.content {
            ContentKind::Solid | ContentKind::Field => Self::FIELD_BLEND,
            ContentKind::Colours => Self::CROSS_DISSOLVE,
        }
    }

    /// Returns all methods, grouped by content. Within each group, those with the fewest
    /// requirements on the designs come last.
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        let cells = |content| {
            WarpKind::BY_DEMAND
                .into_iter()
                .filter_map(move |warp| Self::new(warp, content).ok())
        };
        ContentKind::ALL.into_iter().flat_map(cells)
    }

    /// Returns the method with a warp and a content.
    ///
    /// # Errors
    /// [`UnsupportedMethod`] with the reason if the two cannot be combined.
    ///
    /// ```
    /// use morphospace::{content::ContentKind, transition::TransitionMethod, warp::WarpKind};
    /// assert!(TransitionMethod::new(WarpKind::Arap, ContentKind::Solid).is_ok());
    /// assert!(TransitionMethod::new(WarpKind::None, ContentKind::Solid).is_err());
    /// ```
    pub const fn new(warp: WarpKind, content: ContentKind) -> Result<Self, UnsupportedMethod> {
        match labels_of(warp, content) {
            Ok(_) => Ok(Self { warp, content }),
            Err(reason) => Err(UnsupportedMethod { reason }),
        }
    }

    /// Returns the texts with which the method is shown to users, such as its name and description.
    #[must_use]
    pub const fn labels(self) -> CellLabels {
        match labels_of(self.warp, self.content) {
            Ok(words) => words,
            Err(_) => unreachable!(), // no constructor makes such a cell
        }
    }

    /// Returns the name of the method: a few words.
    ///
    /// ```
    /// use morphospace::transition::TransitionMethod;
    /// assert_eq!(TransitionMethod::RIGID_PARTS.name(), "rigid parts");
    /// let last = TransitionMethod::all().last();
    /// assert_eq!(last.map(TransitionMethod::name), Some("cross-dissolve"));
    /// ```
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.labels().name
    }

    /// Returns the warp, which determines the row of the method in the table of methods.
    #[must_use]
    pub const fn warp(self) -> WarpKind {
        self.warp
    }

    /// Returns the content, which determines the column of the method in the table of methods.
    #[must_use]
    pub const fn content(self) -> ContentKind {
        self.content
    }
}

/// Returns the texts with which a combination is shown to users, or the reason why it is not
/// supported.
const fn labels_of(warp: WarpKind, content: ContentKind) -> CellSupport {
    let words = warp.labels();
    match content {
        ContentKind::Solid => words.solid,
        ContentKind::Field => words.field,
        ContentKind::Colours => words.colours,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_contains_every_method_that_the_constructor_accepts() {
        let mut found = Vec::new();
        for warp in WarpKind::ALL {
            for content in ContentKind::ALL {
                found.extend(TransitionMethod::new(warp, content));
            }
        }
        assert_eq!(found.len(), TransitionMethod::all().count());
        assert!(TransitionMethod::all().all(|cell| found.contains(&cell)));
    }
}
