//! A coat of paint: what a drawing shows is several, one over the other.

use crate::colour::{Gradient, Line, Paint};
use crate::geometry::{Regions, Similarity};

/// Regions in one paint. What is in one coat neither overlaps nor hides the
/// rest of it; what is in a later coat hides what lies under it.
#[derive(Clone, Debug, PartialEq)]
pub struct Coat {
    /// What it covers.
    pub regions: Regions,
    /// Its paint; none where the design has no colour of its own.
    pub paint: Option<Paint>,
    /// The gradient that the paint is the mean of, if it is of one.
    pub gradient: Option<Gradient>,
    /// The line along all its outlines, if there is one; it covers the paint.
    pub line: Option<Line>,
    /// What the file calls it, if it is one shape; or empty.
    pub name: String,
    /// Whether it is text.
    pub is_text: bool,
}

impl Coat {
    pub(super) fn transformed(&self, by: &Similarity) -> Self {
        Self {
            regions: self.regions.transformed(by),
            paint: self.paint,
            gradient: self
                .gradient
                .as_ref()
                .map(|gradient| gradient.moved(by.affine())),
            line: self.line.map(|line| Line {
                width: by.scale * line.width,
                ..line
            }),
            name: self.name.clone(),
            is_text: self.is_text,
        }
    }
}

/// What a file has in one paint.
pub(super) struct Sheet {
    pub regions: Regions,
    pub paint: Option<Paint>,
    pub name: String,
}

/// Sheets without an order of their own as coats, so that nothing hides what is
/// smaller. None where none has a colour of its own.
pub(super) fn stacked(mut sheets: Vec<Sheet>) -> Vec<Coat> {
    if sheets.iter().all(|sheet| sheet.paint.is_none()) {
        return Vec::new();
    }
    sheets.sort_by(|a, b| b.regions.area().total_cmp(&a.regions.area()));
    let coat = |sheet: Sheet| Coat {
        regions: sheet.regions,
        paint: sheet.paint,
        gradient: None,
        line: None,
        name: sheet.name,
        is_text: false,
    };
    sheets.into_iter().map(coat).collect()
}
