//! Match editor, in which the user corrects the match of two designs: source and target side by
//! side, optionally with the film in a third pane.
//!
//! The designs are drawn with egui; the film pane shows the stage itself. Pointer input becomes
//! [`EditorAction`](crate::app::EditorAction)s in the common frame of both designs. Matched
//! boundary points have the same colour in both designs. Pins also have the same number, and
//! automatically matched points the same letter, so that no meaning depends on colour alone.

mod boundary_stripe;
mod colours;
mod design_pane;
mod film_pane;
mod handles;
mod panes;
mod toolbar;

pub use panes::{overlay, show};
pub use toolbar::{BAR_HEIGHT, INSTRUCTIONS_HEIGHT};
