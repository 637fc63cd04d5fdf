//! The view of the stage: cameras, filmstrip, onion skins and display preferences.

pub mod filmstrip;
pub mod frame_intervals;
pub mod onion_skins;
pub mod preference_actions;
pub mod stage_camera;
