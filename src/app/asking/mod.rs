//! What the user can ask for, and the keys that ask for it.

pub mod acts;
pub mod choices;
pub mod hand;
pub mod intent;
pub mod keymap;
mod keytable;
