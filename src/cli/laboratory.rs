//! Reports of `morphospace check`: of one transition, of a table of pairs, and of a design space.
//!
//! The module measures, formats the results as text, JSON or CSV, and writes the report on a table
//! of pairs. It prints nothing. Lengths and areas are in design units, angles in degrees (in
//! the causes of defects: in radians), times in seconds. Infinite numbers, such as the distortion
//! of a folded face, are `null` in JSON.
//!
//! - `clock`: measures the time of each stage of building
//! - `report`: all measures of one transition
//! - `text`, `number`: the report on one transition as text
//! - `space`: the report on a design space
//! - `table`: reads the table of pairs
//! - `pairs`: measures the pairs of a table on all cores
//! - `columns`: the columns of the report on a table, one for each measure
//! - `rows`: the rows of that report, saved while pairs are being measured
//! - `histogram`, `summary`: the summary of all pairs

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

pub(super) use number::{NumberLines, short};
pub(super) use pairs::PairBatchArgs;
pub(super) use report::MeasuringArgs;
pub(super) use space::SpaceMeasurement;
pub(super) use text::text;
