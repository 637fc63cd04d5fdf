//! The measuring laboratory: a transition, or a table of pairs, in numbers and
//! in words.
//!
//! Guarantees: prints nothing and knows no terminal and no flags but those
//! that say what is measured; what comes out is data. Lengths and areas are in the
//! units of the designs, angles in degrees (of causes in radians), times in
//! seconds. A number that is infinite (a folded face is infinitely distorted)
//! is `null`, as JSON has no other way.
//!
//! - `clock`: how long each stage of building took
//! - `report`: everything that is measured of one transition
//! - `text`, `number`: the report for people; `space`: that of many designs
//! - `columns`: the report as a row of a table, and what is said of each column
//! - `table`: a table of pairs as it is given
//! - `rows`: its report, kept row by row
//! - `pairs`: the pairs of a table, over all cores
//! - `histogram`, `summary`: what came out, in short

mod clock;
mod columns;
mod histogram;
mod number;
mod pairs;
mod report;
mod rows;
mod space;
mod summary;
mod table;
mod text;

pub(super) use pairs::PairBatchArgs;
pub(super) use report::MeasuringArgs;
pub(super) use space::SpaceMeasurement;
pub(super) use text::text;
