//! Match editor: source and target side by side, optionally with the film in a third pane.
//!
//! The designs are drawn with egui; the film is the stage itself. Pointer input becomes
//! [`EditorAction`](crate::app::EditorAction)s in the common frame of both designs. Matched
//! boundary points have the same colour on both sides. Numbers (pins, in the project's order) and
//! letters (automatic points) repeat this, so that no meaning depends on colour alone.

mod boundary_stripe;
mod colours;
mod design_pane;
mod film_pane;
mod handles;
mod panes;
mod toolbar;

pub use panes::{overlay, show};
pub use toolbar::{BAR_HEIGHT, INSTRUCTIONS_HEIGHT};
