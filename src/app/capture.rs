//! Export of images and films to files and the clipboard.

pub mod blend_image;
pub mod clipboard;
pub mod estimate;
pub mod export_folder;
pub mod film_exporter;
pub mod film_framing;
pub mod film_request;
pub mod image;
pub mod image_inputs;
pub mod saved_blends;
