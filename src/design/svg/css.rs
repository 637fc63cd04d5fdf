//! Style sheets and style attributes of SVG drawings: CSS syntax, selectors, the cascade, custom
//! properties, mathematical functions, lengths, colours and transforms.
//!
//! `usvg` understands a small part of CSS 2. This module resolves everything else to values that
//! may be written as plain attributes. It follows CSS Syntax 3, Selectors 4, Cascade 5, Values 4,
//! Custom Properties 1, Color 5 and Transforms 2 as far as browsers draw them in static images.

pub(super) mod basic_shapes;
pub(super) mod cascade;
pub(super) mod colours;
mod conditions;
pub(super) mod math;
pub(super) mod properties;
mod selectors;
pub(super) mod syntax;
pub(super) mod tokens;
pub(super) mod transforms;
pub(super) mod variables;
