//! Writes a film as an animated PNG.
//!
//! Guarantees: colours and smooth transparency are lossless; a pause is one long frame; delays are
//! exact at whole frame rates, and otherwise rounded to milliseconds without drift. Readers without
//! animation support show the first frame.

use std::io::{BufWriter, Write};
use std::path::Path;

use png::{BitDepth, BlendOp, ColorType, DisposeOp, Encoder, EncodingError, Writer};

use crate::io::atomic_file::AtomicFile;
use crate::work::progress::{Progress, ProgressSpan};

use super::camera::{Camera, DRAWING_STAGE};
use super::error::ExportError;
use super::film_spec::{FilmSpec, FrameRun};
use super::raster::{rasterise, samples};
use super::readback::{DRAWN_FRACTION, check_apng};

/// Writes the film to `path`, and verifies the file before it replaces an earlier one.
///
/// # Errors
/// [`ExportError`] if the file cannot be written or the export is cancelled.
pub fn write_apng(
    camera: &Camera,
    film: &FilmSpec,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    // The file is created before anything is drawn, so that an unwritable folder is reported at
    // once.
    let mut file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    let runs = film.runs();
    let mut output = BufWriter::new(file.file_mut());
    let mut writer =
        writer(&mut output, camera, film, runs.len()).map_err(ExportError::encode(path))?;
    camera.draw_runs(
        &runs,
        DRAWING_STAGE,
        &ProgressSpan::new(progress, 0.0, DRAWN_FRACTION),
        |drawing| Ok(samples(&rasterise(&drawing), camera.ground.is_some())),
        |run, pixels| {
            let (numerator, denominator) = delay(film, run);
            let written = writer
                .set_frame_delay(numerator, denominator)
                .and_then(|()| writer.write_image_data(&pixels));
            written.map_err(ExportError::encode(path))
        },
    )?;
    writer.finish().map_err(ExportError::encode(path))?;
    // The buffer is flushed explicitly, because dropping it would ignore write errors.
    output.flush().map_err(ExportError::write(path))?;
    drop(output);
    let written = file.reread().map_err(ExportError::write(path))?;
    let checking = ProgressSpan::new(progress, DRAWN_FRACTION, 1.0);
    check_apng(written, runs.len(), path, &checking)?;
    file.commit().map_err(ExportError::write(path))
}

/// Returns a PNG writer that has written the header of the animation.
fn writer<W: Write>(
    output: W,
    camera: &Camera,
    film: &FilmSpec,
    frames: usize,
) -> Result<Writer<W>, EncodingError> {
    let size = camera.view.size();
    let mut encoder = Encoder::new(output, size.width(), size.height());
    encoder.set_color(match camera.ground {
        Some(_) => ColorType::Rgb,
        None => ColorType::Rgba,
    });
    encoder.set_depth(BitDepth::Eight);
    let plays = if film.repeats() { 0 } else { 1 };
    encoder.set_animated(frames as u32, plays)?;
    // Each frame replaces the previous one; blending would accumulate transparent frames.
    encoder.set_blend_op(BlendOp::Source)?;
    encoder.set_dispose_op(DisposeOp::None)?;
    encoder.write_header()
}

/// Returns how long a run of equal frames is shown, in seconds, as a numerator and a denominator of
/// 16 bits.
fn delay(film: &FilmSpec, run: FrameRun) -> (u16, u16) {
    let fps = film.fps();
    if fps.fract() == 0.0
        && let Ok(count) = u16::try_from(run.count)
    {
        return (count, fps as u16);
    }
    // Pauses longer than 65 s do not fit into 16 bits as milliseconds.
    let millis = film.ticks(run, 1000.0);
    match u16::try_from(millis) {
        Ok(millis) => (millis, 1000),
        Err(_) => (u16::try_from(millis / 1000).unwrap_or(u16::MAX), 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::test_camera::camera;
    use crate::work::progress::Silent;
    use std::fs::File;
    use std::io::BufReader;

    #[test]
    fn delays_are_exact_at_whole_rates() {
        let film = FilmSpec::evenly(0.0, 1.0, 6, 24.0).expect("a film");
        assert!(film.runs().iter().all(|&run| delay(&film, run) == (1, 24)));
    }

    #[test]
    fn fractional_rates_do_not_drift() {
        let film = FilmSpec::evenly(0.0, 1.0, 300, 29.97).expect("a film");
        let runs = film.runs();
        let millis = runs.iter().map(|&run| u32::from(delay(&film, run).0));
        assert_eq!(millis.sum::<u32>(), 10_010);
    }

    #[test]
    fn decoded_frames_equal_the_rasterised_drawings() {
        for ground in [
            None,
            Some(crate::transition::TransitionStyle::default().ground),
        ] {
            let camera = camera(40, 30, ground);
            let film = FilmSpec::evenly(0.0, 1.0, 4, 24.0).expect("a film");
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("film.apng");
            write_apng(&camera, &film, &path, &Silent).expect("written");
            let file = BufReader::new(File::open(path).expect("opened"));
            let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
            let control = reader.info().animation_control().expect("animated");
            assert_eq!((control.num_frames, control.num_plays), (4, 1));
            for &t in film.times() {
                let exact = samples(&rasterise(&camera.draw(t)), ground.is_some());
                let mut decoded = vec![0; exact.len()];
                reader.next_frame(&mut decoded).expect("a frame");
                assert!(exact == decoded, "t = {t}");
            }
        }
    }
}
