//! A film as an animated GIF, as small as the picture allows.
//!
//! Guarantees: one palette for the whole film; each frame holds what differs from
//! the one before; delays in hundredths of a second
//! whose sum is the film's length to the nearest one; holds are one long frame.
//! Transparency in GIF is all or nothing: edges are cut at half coverage.

mod changes;

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

/// The highest rate that readers play as written: they take a delay below two
/// hundredths of a second for a mistake and slow it down to ten.
pub const MAX_GIF_FPS: f64 = 50.0;

const TICKS_PER_SEC: f64 = 100.0;

/// The most frames whose colours make the palette. They are drawn once more for
/// it; a colour that only others have gets its nearest.
const PALETTE_SAMPLES: usize = 24;

/// How much is done once the colours are chosen, as it is told: three seconds
/// have some 90 frames, and 24 of them are drawn for it.
const CHOSEN: f64 = 0.2;

/// Writes the film.
///
/// # Errors
/// [`ExportError`] where the rate is beyond [`MAX_GIF_FPS`], the file cannot be
/// written, or nobody wants it any more.
pub fn write_gif(
    camera: &Camera,
    film: &FilmSpec,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    if film.fps() > MAX_GIF_FPS {
        return Err(ExportError::GifRate(film.fps()));
    }
    // Before anything is drawn: a folder that cannot be written to is told at
    // once.
    let mut file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    let choosing = ProgressSpan::new(progress, 0.0, CHOSEN);
    let palette = film_palette(camera, &film.runs(), &choosing)?;
    let writer = BufWriter::new(file.file_mut());
    let mut encoder = encoder(writer, camera, film, &palette).map_err(ExportError::encode(path))?;
    let mut canvas = camera.ground.map(|_| GifCanvas::default());
    // At its ends, and where it rests, a film is looked at.
    let frames = film.times().len();
    let is_held =
        |run: FrameRun| run.count > 1 || run.first == 0 || run.first + run.count == frames;
    camera.shoot_runs(
        &film.runs(),
        DRAWING_STAGE,
        &ProgressSpan::new(progress, CHOSEN, DRAWN_FRACTION),
        |drawing| Ok(indexed(rasterise(&drawing), &palette)),
        |run, drawn| {
            let mut frame = pictured(&drawn, canvas.as_mut(), is_held(run), &palette);
            frame.delay = u16::try_from(film.ticks(run, TICKS_PER_SEC)).unwrap_or(u16::MAX);
            let written = encoder.write_lzw_pre_encoded_frame(&frame);
            written.map_err(ExportError::encode(path))
        },
    )?;
    // Dropped instead, it would lose the error of writing the end.
    let mut writer = encoder.into_inner().map_err(ExportError::encode(path))?;
    writer.flush().map_err(ExportError::write(path))?;
    drop(writer);
    let written = file.written().map_err(ExportError::write(path))?;
    let checking = ProgressSpan::new(progress, DRAWN_FRACTION, 1.0);
    check_gif(written, film.runs().len(), path, &checking)?;
    file.commit().map_err(ExportError::write(path))
}

fn encoder<W: Write>(
    writer: W,
    camera: &Camera,
    film: &FilmSpec,
    palette: &GifPalette,
) -> Result<Encoder<W>, gif::EncodingError> {
    let mut table = palette.colours().as_flattened().to_vec();
    // All indices up to the transparent one stand in the table.
    table.resize(3 * 256, 0);
    let size = camera.view.size();
    // Sides fit in 16 bits: `MAX_SIDE_PX` is 16,384.
    let mut encoder = Encoder::new(writer, size.width() as u16, size.height() as u16, &table)?;
    if film.repeats() {
        encoder.set_repeat(Repeat::Infinite)?;
    }
    Ok(encoder)
}

/// The colours of frames that are spread evenly over the film.
fn film_palette(
    camera: &Camera,
    runs: &[FrameRun],
    progress: &dyn Progress,
) -> Result<GifPalette, ExportError> {
    let step = runs.len().div_ceil(PALETTE_SAMPLES).max(1);
    let mut sampled: Vec<FrameRun> = runs.iter().step_by(step).copied().collect();
    // The steps may jump over the end, whose colours are seen the longest.
    sampled.extend(runs.last());
    let mut counts = ColourHistogram::new();
    camera.shoot_runs(
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

fn histogram(image: &RgbaImage) -> ColourHistogram {
    let mut histogram = ColourHistogram::new();
    for colour in image.pixels().filter_map(|pixel| opaque(pixel.0)) {
        *histogram.entry(colour).or_default() += 1;
    }
    histogram
}

/// The colour of a pixel that is at least half covered.
fn opaque([r, g, b, a]: [u8; 4]) -> Option<[u8; 3]> {
    (a >= 128).then_some([r, g, b])
}

fn indexed(image: RgbaImage, palette: &GifPalette) -> IndexedFrame {
    // Pictures have few colours and palettes 255 to compare each with.
    let mut known = HashMap::new();
    let mut index_of = |pixel: &image::Rgba<u8>| match opaque(pixel.0) {
        None => TRANSPARENT,
        Some(colour) => *known
            .entry(colour)
            .or_insert_with(|| palette.nearest(colour)),
    };
    let indices = image.pixels().map(&mut index_of).collect();
    IndexedFrame { image, indices }
}

/// The next frame. Over a ground it is what changes; without one each is drawn
/// anew, or the last would show through where this one is transparent.
fn pictured(
    drawn: &IndexedFrame,
    canvas: Option<&mut GifCanvas>,
    is_held: bool,
    palette: &GifPalette,
) -> Frame<'static> {
    match canvas {
        Some(canvas) => encoded(canvas.patch(drawn, is_held, palette), DisposalMethod::Keep),
        None => {
            let patch = changes::crop_to_opaque(drawn.image.width(), &drawn.indices);
            encoded(patch, DisposalMethod::Background)
        }
    }
}

fn encoded(patch: FramePatch, dispose: DisposalMethod) -> Frame<'static> {
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
    fn frames_delays_and_loops_are_those_of_the_film() {
        let film = FilmSpec::evenly(0.0, 1.0, 7, 30.0).expect("a film");
        let once = round_trip(&camera(40, 30, None), &film);
        assert_eq!(once.delays, [3, 4, 3, 3, 4, 3, 3]);
        assert_eq!(once.frames[0].dimensions(), (40, 30));
        assert_eq!(once.repeat, Repeat::Finite(0));
        let film = film.playing(PlayMode::PingPong);
        let looped = round_trip(&camera(40, 30, None), &film);
        assert_eq!(looped.frames.len(), 12);
        assert_eq!(looped.repeat, Repeat::Infinite);
        assert_eq!(looped.frames[1], looped.frames[11], "the way back");
    }

    #[test]
    fn colours_stay_near_the_raster_and_the_ground_is_exact() {
        let camera = camera(80, 60, Some(CREAM));
        let film = FilmSpec::evenly(0.0, 1.0, 40, 25.0).expect("a film");
        let decoded = round_trip(&camera, &film);
        for (&t, frame) in film.times().iter().zip(&decoded.frames) {
            let exact = rasterise(&camera.shoot(t));
            for (a, b) in exact.pixels().zip(frame.pixels()) {
                let worst = a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max();
                assert!(worst <= Some(24), "{a:?} became {b:?} at t = {t}");
            }
            assert_eq!(frame.get_pixel(0, 0).0, [250, 248, 240, 255]);
        }
    }

    #[test]
    fn a_transparent_ground_stays_transparent_in_every_frame() {
        let camera = camera(40, 30, None);
        let film = FilmSpec::evenly(0.0, 1.0, 5, 25.0).expect("a film");
        for (&t, frame) in film.times().iter().zip(round_trip(&camera, &film).frames) {
            let exact = rasterise(&camera.shoot(t));
            for (a, b) in exact.pixels().zip(frame.pixels()) {
                assert_eq!(a.0[3] >= 128, b.0[3] == 255, "t = {t}");
            }
        }
    }

    #[test]
    fn a_rate_that_readers_would_slow_down_is_refused() {
        let film = FilmSpec::evenly(0.0, 1.0, 5, 60.0).expect("a film");
        let path = Path::new("/no/such/folder/film.gif");
        let refused = write_gif(&camera(4, 3, None), &film, path, &Silent);
        assert!(matches!(refused, Err(ExportError::GifRate(_))));
    }
}
