//! How the transition is looked at: the view, what is shown, a second method, measures.

pub mod measuring;
pub mod preferences;
pub mod times;
pub mod twin;
pub mod view;
