//! The table of cells: which warp goes with which content.

use crate::content::ContentKind;
use crate::warp::WarpKind;

/// A cell of the table that exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cell {
    warp: WarpKind,
    content: ContentKind,
}

/// A warp and a content that do not go together, with the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct NoSuchCell {
    reason: &'static str,
}

impl Cell {
    /// The cells, in the order of the table.
    pub const ALL: [Self; 2] = [
        Self {
            warp: WarpKind::Arap,
            content: ContentKind::Solid,
        },
        Self {
            warp: WarpKind::None,
            content: ContentKind::Field,
        },
    ];

    /// The cell of a warp and a content.
    ///
    /// # Errors
    /// [`NoSuchCell`] with the reason why they do not go together.
    ///
    /// ```
    /// use morphospace::{content::ContentKind, transition::Cell, warp::WarpKind};
    /// assert!(Cell::new(WarpKind::Arap, ContentKind::Solid).is_ok());
    /// assert!(Cell::new(WarpKind::None, ContentKind::Solid).is_err());
    /// ```
    pub const fn new(warp: WarpKind, content: ContentKind) -> Result<Self, NoSuchCell> {
        match (warp, content) {
            (WarpKind::Arap, ContentKind::Solid) | (WarpKind::None, ContentKind::Field) => {
                Ok(Self { warp, content })
            }
            (WarpKind::None, ContentKind::Solid) => Err(NoSuchCell {
                reason: "a solid changes by moving, so it needs a warp; choose rigid parts (arap)",
            }),
            (WarpKind::Arap, ContentKind::Field) => Err(NoSuchCell {
                reason: "fields do not travel with moving parts yet; choose the field without a warp, or solid rigid parts",
            }),
        }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_what_the_constructor_accepts() {
        let mut found = Vec::new();
        for warp in [WarpKind::None, WarpKind::Arap] {
            for content in [ContentKind::Solid, ContentKind::Field] {
                found.extend(Cell::new(warp, content));
            }
        }
        assert_eq!(found.len(), Cell::ALL.len());
        assert!(Cell::ALL.iter().all(|cell| found.contains(cell)));
    }
}
