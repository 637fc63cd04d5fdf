//! Options with a fixed list of named values, and the key, title and help sentence of each value.

mod choice;

pub use choice::{Choice, ChoiceName, UnknownKey, choice_keys};
pub(crate) use choice::{deserialize_choice, named};
