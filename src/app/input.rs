//! What the user can ask for, and the keys that ask for it.

pub mod editor_action;
pub mod gesture;
pub mod intent;
mod key_table;
pub mod preferences;
