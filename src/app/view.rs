//! View of the film: cameras of the stage, filmstrip, onion skins, times between frames of the
//! window, and the intents that change preferences.

pub mod filmstrip;
pub mod frame_intervals;
pub mod onion_skins;
pub mod preference_actions;
pub mod stage_camera;
