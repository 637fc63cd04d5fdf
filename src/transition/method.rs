//! The table of cells: which warp goes with which content.

use crate::content::ContentKind;
use crate::warp::{CellLabels, CellSupport, WarpKind};

/// A cell of the table that exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TransitionMethod {
    warp: WarpKind,
    content: ContentKind,
}

/// A warp and a content that do not go together, with the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct UnsupportedMethod {
    reason: &'static str,
}

impl TransitionMethod {
    /// Solid parts that move as rigidly as they can.
    pub const RIGID_PARTS: Self = Self {
        warp: WarpKind::Arap,
        content: ContentKind::Solid,
    };

    /// Distance fields that blend where they are.
    pub const FIELD_BLEND: Self = Self {
        warp: WarpKind::None,
        content: ContentKind::Field,
    };

    /// Pictures that cross-dissolve where they are.
    pub const CROSS_DISSOLVE: Self = Self {
        warp: WarpKind::None,
        content: ContentKind::Colours,
    };

    /// What can be had where this cell cannot: nothing moves, so that nothing
    /// need be matched. Solids are blended as fields.
    ///
    /// ```
    /// use morphospace::transition::Cell;
    /// assert_eq!(Cell::RIGID_PARTS.plain(), Cell::FIELD_BLEND);
    /// assert_eq!(Cell::CROSS_DISSOLVE.plain(), Cell::CROSS_DISSOLVE);
    /// ```
    #[must_use]
    pub const fn plain(self) -> Self {
        match self.content {
            ContentKind::Solid | ContentKind::Field => Self::FIELD_BLEND,
            ContentKind::Colours => Self::CROSS_DISSOLVE,
        }
    }

    /// The cells, those that ask least of the designs last in each column.
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        let cells = |content| {
            WarpKind::BY_DEMAND
                .into_iter()
                .filter_map(move |warp| Self::new(warp, content).ok())
        };
        ContentKind::ALL.into_iter().flat_map(cells)
    }

    /// The cell of a warp and a content.
    ///
    /// # Errors
    /// [`UnsupportedMethod`] with the reason why they do not go together.
    ///
    /// ```
    /// use morphospace::{content::ContentKind, transition::Cell, warp::WarpKind};
    /// assert!(Cell::new(WarpKind::Arap, ContentKind::Solid).is_ok());
    /// assert!(Cell::new(WarpKind::None, ContentKind::Solid).is_err());
    /// ```
    pub const fn new(warp: WarpKind, content: ContentKind) -> Result<Self, UnsupportedMethod> {
        match column(warp, content) {
            Ok(_) => Ok(Self { warp, content }),
            Err(reason) => Err(UnsupportedMethod { reason }),
        }
    }

    /// What is said of it.
    #[must_use]
    pub const fn words(self) -> CellLabels {
        match column(self.warp, self.content) {
            Ok(words) => words,
            Err(_) => unreachable!(), // no constructor makes such a cell
        }
    }

    /// What it is called, in a few words.
    ///
    /// ```
    /// use morphospace::transition::Cell;
    /// assert_eq!(Cell::RIGID_PARTS.name(), "rigid parts");
    /// assert_eq!(Cell::all().last().map(Cell::name), Some("cross-dissolve"));
    /// ```
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.words().name
    }

    /// The row.
    #[must_use]
    pub const fn warp(self) -> WarpKind {
        self.warp
    }

    /// The column.
    #[must_use]
    pub const fn content(self) -> ContentKind {
        self.content
    }
}

/// What is said of a warp with a content.
const fn column(warp: WarpKind, content: ContentKind) -> CellSupport {
    let words = warp.words();
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
    fn the_list_is_what_the_constructor_accepts() {
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
