//! Importer of DXF drawings, text and binary, of any release.
//!
//! Reads LINE, LWPOLYLINE and POLYLINE with bulges and widths, ARC, CIRCLE, ELLIPSE, SPLINE, HELIX,
//! HATCH, MPOLYGON, SOLID, TRACE, 3DFACE, MLINE, LEADER, TEXT, MTEXT, ATTRIB, ATTDEF, DIMENSION,
//! ACAD_TABLE and INSERT. Curves are joined end to end into closed outlines; end points closer than
//! [`JOIN_TOLERANCE`] count as one. Closed outlines are filled by the even-odd rule, unless the
//! fill would hide what is drawn inside them. Curves that do not close are lines with a width:
//! their line weight in the declared unit, or relative to the default line weight, and at least the
//! fraction [`HAIR`] of the drawing. Hatches, solids and letters are areas. Each combination of DXF
//! layer and colour becomes one or more paint layers; lines lie above areas, text above both.
//!
//! One drawing unit is one design unit. Layers that are off or frozen, invisible entities and paper
//! space are left out. Entities that are not supported or broken are left out and reported.
//!
//! Does not use the `dxf` crate, which stores every entity with all attributes (hundreds of
//! bytes per byte of a hostile file) and does not report the line of an error.
//!
//! Guarantees that no input causes a panic or an infinite loop, and that memory use stays within a
//! few hundred bytes per entity; there are at most [`MAX_OBJECTS`] entities and polyline vertices.
//!
//! [`MAX_OBJECTS`]: error::MAX_OBJECTS

mod band;
mod colours;
mod cover;
mod curve;
mod drawing;
mod encoding;
mod entity;
mod error;
mod expansion;
mod hatch;
mod hidden_lines;
mod inline_codes;
mod join;
mod painter;
mod pairs;
mod polyline;
mod record;
mod report;
mod sheet;
mod spline;
mod style;
mod text;

pub use error::DxfError;
pub(super) use pairs::BINARY;

use super::flatten::MIN_TOLERANCE;
use super::options::ImportOptions;
use crate::geometry::Bounds;
use painter::DxfImport;
use sheet::{Sheet, SheetScale};

/// Maximum distance between end points that are joined, as a fraction of the drawing's longer side
/// (tolerance: covers coordinates that were rounded to four significant digits).
pub(super) const JOIN_TOLERANCE: f64 = 1e-4;

/// Distance up to which two points of one path count as equal, as a fraction of the drawing's
/// longer side (tolerance: the end points of an arc with bulge 1e-7 are accurate to 3e-10).
const ROUNDING: f64 = 1e-9;

/// Minimum width of a line, as a fraction of the drawing's longer side (derived: the default line
/// weight of 0.25 mm on a sheet of about A4 size).
pub(super) const HAIR: f64 = 0.001;

/// Maximum deviation of flattened curves, as a fraction of the tolerance that the options allow
/// (derived: the area of a circle of a tenth of the drawing is then exact to a thousandth at the
/// default tolerance, because chords lie inside the circle).
const FLATNESS: f64 = 0.25;

/// Imports a DXF file. `options.tolerance` is the maximum deviation of flattened curves, as a
/// fraction of the drawing's longer side.
///
/// # Errors
/// Returns a [`DxfError`] if the file is damaged, exceeds a limit, or nothing of it can be drawn.
pub(super) fn read(bytes: &[u8], options: &ImportOptions) -> Result<DxfImport, DxfError> {
    let drawing = drawing::read(bytes, options.tolerance)?;
    let side = Bounds::of(drawing.hull()).map_or(0.0, |hull| hull.size().max_element());
    // The drawing is empty, or all of it lies in one point.
    if side <= 0.0 {
        return Err(DxfError::Nothing(drawing.report.into_left_out()));
    }
    let scale = SheetScale {
        tolerance: FLATNESS * options.tolerance.max(MIN_TOLERANCE) * side,
        rounding: ROUNDING * side,
        gap: JOIN_TOLERANCE * side,
        hair: HAIR * side,
    };
    let sheet = Sheet::of(&drawing, scale)?;
    painter::paint(drawing, sheet, scale, options.strokes)
}

#[cfg(test)]
mod tests;
