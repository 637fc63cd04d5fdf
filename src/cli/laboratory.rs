//! Measurements behind `morphospace check`: reports of one transition, of a table of pairs, and of
//! a design space.
//!
//! Prints nothing and has no flags except those that select what is measured. Lengths and areas are
//! in design units, angles in degrees (those of causes in radians), times in seconds. Infinite
//! numbers, such as the distortion of a folded face, are `null` in JSON.
//!
//! - `clock`: time taken by each stage of building
//! - `report`: all measures of one transition
//! - `text`, `number`: the report as text; `space`: the report of a design space
//! - `columns`: the report as a row of a table, and the description of each column
//! - `table`: the table of pairs given as input
//! - `rows`: the rows of the output, saved while the work goes on
//! - `pairs`: measures the pairs of a table on all cores
//! - `histogram`, `summary`: summary of all pairs

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
