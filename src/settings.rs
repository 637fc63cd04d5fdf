//! Settings that are one of several named values: key, title and sentence of each value.

pub mod choice;

pub use choice::{Choice, ChoiceName, UnknownKey, keys};
