//! Writes transitions to files: single frames (PNG, SVG, DXF), contact sheets, numbered frames,
//! GIF, animated PNG, MP4, and animated vector graphics (SVG, HTML, Lottie). Needs neither a GPU
//! nor a display.
//!
//! All formats are written from the same [`Drawing`] of a frame, so a frame looks the same in each.
//! Files are written atomically; films are read back and verified before they replace an earlier
//! file. The same transition gives the same bytes on every run, except for MP4, which ffmpeg
//! encodes. Frames are drawn on all cores and written in order. This module does not depend on the
//! window or the command line.
//!
//! ```no_run
//! use morphospace::export::{Camera, ExportTarget, FilmSpec, PixelSize, PlaneView};
//! use morphospace::export::{framing, write_film};
//! use morphospace::work::progress::Silent;
//! # fn transition() -> morphospace::transition::Transition { unreachable!() }
//!
//! let transition = transition();
//! let film = FilmSpec::evenly(0.0, 1.0, 24, 24.0)?;
//! let bounds = framing(&transition, film.times());
//! let view = PlaneView::fit(bounds, PixelSize::of_shape(bounds, 960));
//! let camera = Camera {
//!     sequence: transition.into(),
//!     style: Default::default(),
//!     view,
//!     ground: None,
//!     captions: None,
//! };
//! let target = ExportTarget::of_path("film.gif".as_ref())?;
//! write_film(&camera, &film, &target, &Silent)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod apng;
mod camera;
mod captions;
#[cfg(feature = "cli")]
mod catalogue;
mod comparison_sheet;
mod contact_sheet;
mod drawing;
mod dxf;
mod error;
mod film_spec;
mod gif;
mod glyph_outlines;
mod labels;
mod layout;
mod map_sheet;
#[cfg(not(target_family = "wasm"))]
mod mp4;
mod outline;
mod pair_sheet;
mod palette;
mod png_sequence;
mod preset;
mod raster;
mod readback;
mod size;
mod still;
mod svg;
mod target;
#[cfg(test)]
mod test_camera;
mod vector_animation;
mod view;

#[cfg(feature = "bevy")]
pub(crate) use raster::make_straight;
#[cfg(feature = "cli")]
pub(crate) use still::write_atomically;

use std::path::PathBuf;

use crate::work::progress::Progress;

pub use apng::write_apng;
pub use camera::{BATCH_BYTES, Camera, framing};
pub use captions::Captions;
#[cfg(feature = "cli")]
pub use catalogue::{Catalogue, CatalogueOrder};
pub use comparison_sheet::{MethodRow, comparison_sheet};
pub use contact_sheet::{SheetLayout, contact_sheet};
pub use drawing::{Drawing, DrawingItem, JOINT_CORE_RADIUS, JOINT_RADIUS, joint_core};
pub use error::ExportError;
pub use film_spec::{FilmSpec, FilmSpecError, FrameRun, MAX_FPS, MAX_FRAMES, even_times};
pub use gif::{MAX_GIF_FPS, write_gif};
pub use labels::text_colour_on;
pub use layout::{Aspect, LayoutPreset, PictureLayout};
pub use map_sheet::map_sheet;
#[cfg(not(target_family = "wasm"))]
pub use mp4::{has_ffmpeg, write_mp4};
pub use outline::{MAX_COORDINATE_PX, OutlinePath, PathCommand};
pub use pair_sheet::{PairStrip, pair_sheet};
pub use png_sequence::write_numbered;
pub use preset::{FilmPreset, FilmPresets};
pub use raster::rasterise;
pub use size::{MAX_PIXELS, MAX_SIDE_PX, PixelSize, PixelSizeError};
pub use still::write_still;
pub use svg::to_svg;
pub use target::{
    ExportTarget, ExportTargetError, FilmKind, NumberedFiles, StillKind, extension_list,
};
pub use vector_animation::VectorAnimation;
pub use view::PlaneView;

/// Writes a film to the given target and returns the paths of the files written. A target for a
/// single image gets the film's first frame.
///
/// # Errors
/// [`ExportError`] if a file cannot be written or the export is cancelled.
pub fn write_film(
    camera: &Camera,
    film: &FilmSpec,
    target: &ExportTarget,
    progress: &dyn Progress,
) -> Result<Vec<PathBuf>, ExportError> {
    let path = match target {
        ExportTarget::Numbered(names) => return write_numbered(camera, film, names, progress),
        ExportTarget::Still(kind, path) => {
            write_still(&camera.draw(film.times()[0]), *kind, path)?;
            path
        }
        ExportTarget::Film(kind, path) => {
            match kind {
                FilmKind::Gif => write_gif(camera, film, path, progress)?,
                FilmKind::Apng => write_apng(camera, film, path, progress)?,
                #[cfg(not(target_family = "wasm"))]
                FilmKind::Mp4 => write_mp4(camera, film, path, progress)?,
                #[cfg(target_family = "wasm")]
                FilmKind::Mp4 => return Err(ExportError::NoFfmpeg),
                FilmKind::Svg | FilmKind::Html | FilmKind::Lottie => {
                    vector_animation::write_motion(camera, film, *kind, path, progress)?;
                }
            }
            path
        }
    };
    Ok(vec![path.clone()])
}
