//! The match editor: source and target side by side, and the film beside them.
//!
//! The designs are drawn with egui, the film is the stage itself; what the hand does becomes an
//! [`EditorAct`](crate::app::EditorAct) in the coordinates of the frame. Colours run along the
//! boundary, the same on both sides, and numbers and letters say the same again, so that nothing
//! hangs on colour alone: numbers are pins, as the project counts them, letters what was found.

mod boundary_stripe;
mod colours;
mod design_pane;
mod film_pane;
mod handles;
mod panes;
mod toolbar;

pub use panes::{overlay, show};
pub use toolbar::{ADVICE_HEIGHT, BAR_HEIGHT};
