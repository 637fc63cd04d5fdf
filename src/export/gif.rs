//! Writes a film as a compact animated GIF.
//!
//! Guarantees: all frames share one palette; on a coloured background, each frame stores only the
//! rectangle that differs from the previous frame; delays are in hundredths of a second, and their
//! sum is the duration of the film to the nearest hundredth; a pause is one long frame. A GIF pixel
//! is either opaque or transparent, so pixels that are covered less than half are transparent.

pub(super) mod changes;

use std::collections::HashMap;
use std::io::{BufWriter, Write};
use std::path::Path;

use gif::{DisposalMethod, Encoder, Frame, Repeat};
use image::RgbaImage;

use crate::io::atomic_file::AtomicFile;
use crate::work::progress::{Progress, ProgressSpan};

use super::camera::{Camera, DRAWING_STAGE};
use super::error::ExportError;
use super::film_spec::{FilmSpec, FrameRun};
use super::palette::{ColourHistogram, GifPalette};
use super::raster::rasterise;
use super::readback::{DRAWN_FRACTION, check_gif};
use changes::{FramePatch, GifCanvas, IndexedFrame, TRANSPARENT};

/// Maximum frame rate that players respect, in frames per second (derived: players take delays
/// below 0.02 s for errors and use 0.1 s instead).
pub const MAX_GIF_FPS: f64 = 50.0;

/// GIF delay units per second.
const TICKS_PER_SEC: f64 = 100.0;

/// Size of a frame without its data, in bytes: graphic control extension, image descriptor and end
/// of the data (GIF89a, sections 20 to 23).
const FRAME_HEADER: usize = 8 + 10 + 1;

/// Number of frames whose colours determine the palette (resource limit: they are drawn twice).
/// Colours that occur only in other frames are replaced by the nearest.
const PALETTE_SAMPLES: usize = 24;

/// Progress reported once the palette is chosen, in [0, 1] (heuristic: for a typical film of about
/// 90 frames, 24 additional drawings are needed for the palette).
const PALETTE_FRACTION: f64 = 0.2;

/// Writes the film to `path`, and verifies the file before it replaces an earlier one.
///
/// # Errors
/// [`ExportError`] if the frame rate is above [`MAX_GIF_FPS`], the file cannot be written, or the
/// export is cancelled.
pub fn write_gif(
    camera: &Camera,
    film: &FilmSpec,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    if film.fps() > MAX_GIF_FPS {
        return Err(ExportError::GifRate(film.fps()));
    }
    // The file is created before anything is drawn, so that an unwritable folder is reported at
    // once.
    let file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    let choosing = ProgressSpan::new(progress, 0.0, PALETTE_FRACTION);
    let palette = film_palette(camera, &film.runs(), &choosing)?;
    let drawing = ProgressSpan::new(progress, PALETTE_FRACTION, 1.0);
    write_with_palette(camera, film, &palette, file, path, &drawing)?;
    Ok(())
}

/// Writes a section of a film with the palette of the whole film. Returns the size of each frame in
/// bytes.
///
/// # Errors
/// Same as for [`write_gif`].
pub(super) fn write_gif_section(
    camera: &Camera,
    section: &FilmSpec,
    palette: &GifPalette,
    path: &Path,
    progress: &dyn Progress,
) -> Result<Vec<usize>, ExportError> {
    let file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    write_with_palette(camera, section, palette, file, path, progress)
}

/// Writes the film to `file`, whose final path is `path`. Returns the size of each frame in bytes.
fn write_with_palette(
    camera: &Camera,
    film: &FilmSpec,
    palette: &GifPalette,
    mut file: AtomicFile,
    path: &Path,
    progress: &dyn Progress,
) -> Result<Vec<usize>, ExportError> {
    let writer = BufWriter::new(file.file_mut());
    let mut encoder = encoder(writer, camera, film, palette).map_err(ExportError::encode(path))?;
    let mut canvas = camera.ground.map(|_| GifCanvas::default());
    // Pauses, and the first and the last frame of a whole film, are shown long enough to be looked
    // at, so each of their pixels gets the nearest palette colour.
    let frames = film.times().len();
    let mut frame_sizes = Vec::new();
    let is_still =
        |run: FrameRun| run.count > 1 || run.first == 0 || run.first + run.count == frames;
    camera.draw_runs(
        &film.runs(),
        DRAWING_STAGE,
        &ProgressSpan::new(progress, 0.0, DRAWN_FRACTION),
        |drawing| Ok(index_image(rasterise(&drawing), palette)),
        |run, drawn| {
            let mut frame = encode_next_frame(&drawn, canvas.as_mut(), is_still(run), palette);
            frame.delay = u16::try_from(film.ticks(run, TICKS_PER_SEC)).unwrap_or(u16::MAX);
            // The data is stored in blocks of 255 bytes, each with its length.
            let data = frame.buffer.len();
            frame_sizes.push(FRAME_HEADER + data + data.div_ceil(255));
            let written = encoder.write_lzw_pre_encoded_frame(&frame);
            written.map_err(ExportError::encode(path))
        },
    )?;
    // The writer is taken back explicitly, because dropping the encoder would ignore errors when it
    // writes the end of the file.
    let mut writer = encoder.into_inner().map_err(ExportError::encode(path))?;
    writer.flush().map_err(ExportError::write(path))?;
    drop(writer);
    let written = file.reread().map_err(ExportError::write(path))?;
    let checking = ProgressSpan::new(progress, DRAWN_FRACTION, 1.0);
    check_gif(written, film.runs().len(), path, &checking)?;
    file.commit().map_err(ExportError::write(path))?;
    Ok(frame_sizes)
}

/// Returns an encoder that has written the header and the palette.
fn encoder<W: Write>(
    writer: W,
    camera: &Camera,
    film: &FilmSpec,
    palette: &GifPalette,
) -> Result<Encoder<W>, gif::EncodingError> {
    let mut table = palette.colours().as_flattened().to_vec();
    // The palette must have entries for all indices up to that of transparent pixels.
    table.resize(3 * 256, 0);
    let size = camera.view.size();
    // Sides fit in 16 bits: `MAX_SIDE_PX` is 16,384.
    let mut encoder = Encoder::new(writer, size.width() as u16, size.height() as u16, &table)?;
    if film.repeats() {
        encoder.set_repeat(Repeat::Infinite)?;
    }
    Ok(encoder)
}

/// Chooses the palette from frames spread evenly over the film.
pub(super) fn film_palette(
    camera: &Camera,
    runs: &[FrameRun],
    progress: &dyn Progress,
) -> Result<GifPalette, ExportError> {
    let step = runs.len().div_ceil(PALETTE_SAMPLES).max(1);
    let mut sampled: Vec<FrameRun> = runs.iter().step_by(step).copied().collect();
    // The stride may skip the last frame, which is often shown longest.
    sampled.extend(runs.last());
    let mut counts = ColourHistogram::new();
    camera.draw_runs(
        &sampled,
        "choosing colours",
        progress,
        |drawing| Ok(histogram(&rasterise(&drawing))),
        |_, of_frame| {
            for (colour, count) in of_frame {
                *counts.entry(colour).or_default() += count;
            }
            Ok(())
        },
    )?;
    Ok(GifPalette::of(counts, usize::from(TRANSPARENT)))
}

/// Counts the colours of the opaque pixels.
fn histogram(image: &RgbaImage) -> ColourHistogram {
    let mut histogram = ColourHistogram::new();
    for colour in image.pixels().filter_map(|pixel| opaque_colour(pixel.0)) {
        *histogram.entry(colour).or_default() += 1;
    }
    histogram
}

/// Returns the colour of a pixel that is at least half covered; `None` for other pixels.
fn opaque_colour([r, g, b, a]: [u8; 4]) -> Option<[u8; 3]> {
    (a >= 128).then_some([r, g, b])
}

/// Replaces each pixel of an image by the index of the nearest palette colour.
fn index_image(image: RgbaImage, palette: &GifPalette) -> IndexedFrame {
    // Frames have few distinct colours, so caching avoids comparing each pixel with up to 255
    // palette entries.
    let mut cache = HashMap::new();
    let mut index_of = |pixel: &image::Rgba<u8>| match opaque_colour(pixel.0) {
        None => TRANSPARENT,
        Some(colour) => *cache
            .entry(colour)
            .or_insert_with(|| palette.nearest(colour)),
    };
    let indices = image.pixels().map(&mut index_of).collect();
    IndexedFrame { image, indices }
}

/// Encodes the next frame. With a `canvas` (on a coloured background), only the changes are stored.
/// Without one (on a transparent background), the opaque part of the frame is stored. Players erase
/// this part before the next frame; otherwise it would show through the next frame's transparent
/// pixels.
fn encode_next_frame(
    drawn: &IndexedFrame,
    canvas: Option<&mut GifCanvas>,
    is_still: bool,
    palette: &GifPalette,
) -> Frame<'static> {
    match canvas {
        Some(canvas) => encode_patch(canvas.patch(drawn, is_still, palette), DisposalMethod::Keep),
        None => {
            let patch = changes::crop_to_opaque(drawn.image.width(), &drawn.indices);
            encode_patch(patch, DisposalMethod::Background)
        }
    }
}

/// Compresses the part of a frame that is stored, and returns it as a GIF frame.
fn encode_patch(patch: FramePatch, dispose: DisposalMethod) -> Frame<'static> {
    // Sides fit in 16 bits: `MAX_SIDE_PX` is 16,384.
    let mut frame = Frame {
        left: patch.left as u16,
        top: patch.top as u16,
        width: patch.width as u16,
        height: patch.height() as u16,
        dispose,
        transparent: Some(TRANSPARENT),
        buffer: patch.indices.into(),
        ..Frame::default()
    };
    frame.make_lzw_pre_encoded();
    frame
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::Rgb;
    use crate::export::test_camera::camera;
    use crate::transition::PlayMode;
    use crate::work::progress::Silent;

    const CREAM: Rgb = Rgb([250, 248, 240]);

    struct DecodedGif {
        repeat: Repeat,
        delays: Vec<u16>,
        frames: Vec<RgbaImage>,
    }

    fn round_trip(camera: &Camera, film: &FilmSpec) -> DecodedGif {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film.gif");
        write_gif(camera, film, &path, &Silent).expect("written");
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let file = std::fs::File::open(path).expect("opened");
        let mut decoder = options.read_info(file).expect("a GIF");
        let (mut delays, mut frames) = (vec![], vec![]);
        let size = camera.view.size();
        let mut canvas = RgbaImage::new(size.width(), size.height());
        while let Some(frame) = decoder.read_next_frame().expect("a frame") {
            delays.push(frame.delay);
            let (width, height) = (u32::from(frame.width), u32::from(frame.height));
            let pixels = frame.buffer.to_vec();
            let patch = RgbaImage::from_vec(width, height, pixels).expect("all pixels");
            let (left, top) = (i64::from(frame.left), i64::from(frame.top));
            image::imageops::overlay(&mut canvas, &patch, left, top);
            frames.push(canvas.clone());
            if frame.dispose == DisposalMethod::Background {
                let gone = RgbaImage::new(width, height);
                image::imageops::replace(&mut canvas, &gone, left, top);
            }
        }
        DecodedGif {
            repeat: decoder.repeat(),
            delays,
            frames,
        }
    }

    #[test]
    fn frame_count_delays_and_looping_match_the_film() {
        let film = FilmSpec::evenly(0.0, 1.0, 7, 30.0).expect("a film");
        let once = round_trip(&camera(40, 30, None), &film);
        assert_eq!(once.delays, [3, 4, 3, 3, 4, 3, 3]);
        assert_eq!(once.frames[0].dimensions(), (40, 30));
        assert_eq!(once.repeat, Repeat::Finite(0));
        let film = film.with_play_mode(PlayMode::PingPong);
        let looped = round_trip(&camera(40, 30, None), &film);
        assert_eq!(looped.frames.len(), 12);
        assert_eq!(looped.repeat, Repeat::Infinite);
        assert_eq!(looped.frames[1], looped.frames[11], "the way back");
    }

    #[test]
    fn colours_stay_close_to_the_drawing_and_the_background_is_exact() {
        let camera = camera(80, 60, Some(CREAM));
        let film = FilmSpec::evenly(0.0, 1.0, 40, 25.0).expect("a film");
        let decoded = round_trip(&camera, &film);
        for (&t, frame) in film.times().iter().zip(&decoded.frames) {
            let exact = rasterise(&camera.draw(t));
            for (a, b) in exact.pixels().zip(frame.pixels()) {
                let worst = a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max();
                assert!(worst <= Some(24), "{a:?} became {b:?} at t = {t}");
            }
            assert_eq!(frame.get_pixel(0, 0).0, [250, 248, 240, 255]);
        }
    }

    #[test]
    fn a_transparent_background_stays_transparent_in_every_frame() {
        let camera = camera(40, 30, None);
        let film = FilmSpec::evenly(0.0, 1.0, 5, 25.0).expect("a film");
        for (&t, frame) in film.times().iter().zip(round_trip(&camera, &film).frames) {
            let exact = rasterise(&camera.draw(t));
            for (a, b) in exact.pixels().zip(frame.pixels()) {
                assert_eq!(a.0[3] >= 128, b.0[3] == 255, "t = {t}");
            }
        }
    }

    #[test]
    fn a_frame_rate_that_players_would_slow_down_is_refused() {
        let film = FilmSpec::evenly(0.0, 1.0, 5, 60.0).expect("a film");
        let path = Path::new("/no/such/folder/film.gif");
        let refused = write_gif(&camera(4, 3, None), &film, path, &Silent);
        assert!(matches!(refused, Err(ExportError::GifRate(_))));
    }
}
