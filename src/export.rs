//! Writes transitions to files: single frames (PNG, SVG, DXF), contact sheets, numbered frames,
//! GIF, animated PNG, video (MP4, WebM, MOV), and animated vector graphics (SVG, HTML, Lottie).
//! Needs neither a GPU nor a display.
//!
//! All formats are written from the same [`Drawing`] of a frame, so a frame looks the same in each.
//! Files are written atomically; films are read back and verified before they replace an earlier
//! file. The same transition gives the same bytes on every run, except for videos, which ffmpeg
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
mod estimate;
mod film_spec;
mod gif;
mod glyph_outlines;
mod labels;
mod layout;
mod map_sheet;
mod outline;
mod painted_blend;
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
#[cfg(not(target_family = "wasm"))]
mod video;
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
pub use estimate::FilmCost;
pub use film_spec::{FilmSpec, FilmSpecError, FrameRun, MAX_FPS, MAX_FRAMES, even_times};
pub use gif::{MAX_GIF_FPS, write_gif};
pub use labels::text_colour_on;
pub use layout::{Aspect, LayoutPreset, PictureLayout};
pub use map_sheet::map_sheet;
pub use outline::{MAX_COORDINATE_PX, OutlinePath, PathCommand};
pub use painted_blend::SpaceColours;
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
#[cfg(not(target_family = "wasm"))]
pub use video::{VideoContainer, has_ffmpeg, write_video};
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
                FilmKind::Mp4 | FilmKind::WebM | FilmKind::Mov => {
                    write_film_as_video(camera, film, *kind, path, progress)?;
                }
                FilmKind::Svg | FilmKind::Html | FilmKind::Lottie => {
                    vector_animation::write_motion(camera, film, *kind, path, progress)?;
                }
            }
            path
        }
    };
    Ok(vec![path.clone()])
}

/// Writes a film as a video file.
#[cfg(not(target_family = "wasm"))]
fn write_film_as_video(
    camera: &Camera,
    film: &FilmSpec,
    kind: FilmKind,
    path: &std::path::Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let container = match kind {
        FilmKind::WebM => VideoContainer::WebM,
        FilmKind::Mov => VideoContainer::Mov,
        _ => VideoContainer::Mp4,
    };
    write_video(camera, film, container, path, progress)
}

/// Refuses to write a video, because no other programs can be run here.
#[cfg(target_family = "wasm")]
fn write_film_as_video(
    _: &Camera,
    _: &FilmSpec,
    _: FilmKind,
    _: &std::path::Path,
    _: &dyn Progress,
) -> Result<(), ExportError> {
    Err(ExportError::NoFfmpeg)
}
