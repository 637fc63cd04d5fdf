//! Checks that hold for any input: the fuzz targets of `fuzz/` and the tests of
//! `tests/fuzzed_inputs.rs` call them with mutated inputs. A check that fails panics.

mod cached_match;
mod design_check;
mod font;
mod project;
mod strokes;

pub use cached_match::check_cached_match;
pub use design_check::check_import;
pub use font::check_font;
pub use project::check_project;
pub use strokes::check_strokes;
