//! User input: intents (what the user can do), the keys that trigger them, mouse gestures and
//! preferences.

pub mod editor_action;
pub mod gesture;
pub mod intent;
pub mod key_map;
mod key_table;
pub mod preferences;
