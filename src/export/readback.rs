//! Verifies a written GIF or APNG by decoding it frame by frame before it replaces an earlier file.
//! Detects truncated and damaged files and wrong frame counts, but not wrong pixel values.

use std::fmt::Display;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use crate::work::progress::{Progress, checkpoint};

use super::error::ExportError;

/// Name of the progress stage in which a film is verified.
pub(super) const CHECKING_STAGE: &str = "checking the film";

/// Progress reported once all frames are drawn and written, in [0, 1] (heuristic: verifying takes
/// about a tenth of the time).
pub(super) const DRAWN_FRACTION: f64 = 0.9;

/// Decodes a whole GIF and counts its frames. `path` is its final name, for error messages.
///
/// # Errors
/// [`ExportError::Corrupt`] if it cannot be decoded or does not have `count` frames, or
/// [`ExportError::Cancelled`].
pub(super) fn check_gif(
    written: &File,
    count: usize,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let mut options = gif::DecodeOptions::new();
    // The file was just written by this program, so its frame size needs no limit.
    options.set_memory_limit(gif::MemoryLimit::Unlimited);
    let mut decoder = (options.read_info(BufReader::new(written)))
        .map_err(|error| ExportError::corrupt(path, error))?;
    // The loop reads once more than there are frames; this last read must report the end of the
    // file.
    for number in 0..=count {
        checkpoint(progress, CHECKING_STAGE, number as f64 / count as f64)?;
        let frame = decoder.read_next_frame();
        let frame = frame.map_err(broken_at(path, number, count))?;
        if frame.is_some() != (number < count) {
            let reason = format!("it does not have {count} frames");
            return Err(ExportError::corrupt(path, reason));
        }
    }
    Ok(())
}

/// Decodes a whole animated PNG and counts its frames.
///
/// # Errors
/// Same as for [`check_gif`].
pub(super) fn check_apng(
    written: &File,
    count: usize,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let limits = png::Limits { bytes: usize::MAX };
    let decoder = png::Decoder::new_with_limits(BufReader::new(written), limits);
    let mut reader = (decoder.read_info()).map_err(|error| ExportError::corrupt(path, error))?;
    let control = reader.info().animation_control;
    if control.map(|control| control.num_frames as usize) != Some(count) {
        let reason = format!("it does not have {count} frames");
        return Err(ExportError::corrupt(path, reason));
    }
    let mut pixels = vec![0; reader.output_buffer_size().unwrap_or_default()];
    for number in 0..count {
        checkpoint(progress, CHECKING_STAGE, number as f64 / count as f64)?;
        let read = reader.next_frame(&mut pixels);
        read.map_err(broken_at(path, number, count))?;
    }
    reader.finish().map_err(broken_at(path, count, count))
}

/// Returns a function that turns a decoder error at a frame into an export error.
fn broken_at<E: Display>(
    path: &Path,
    number: usize,
    count: usize,
) -> impl FnOnce(E) -> ExportError {
    move |error| {
        let reason = format!("it is unreadable after frame {number} of {count} ({error})");
        ExportError::corrupt(path, reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::test_camera::camera;
    use crate::export::{FilmSpec, write_apng, write_gif};
    use crate::work::progress::Silent;
    use std::sync::Mutex;

    /// Asserts that `check` accepts the file that `write` has written, and refuses this file if it
    /// is truncated, if a part of it is overwritten with zeros, or if another frame count is
    /// expected.
    fn assert_damage_is_noticed(
        write: fn(
            &crate::export::Camera,
            &FilmSpec,
            &Path,
            &dyn Progress,
        ) -> Result<(), ExportError>,
        check: fn(&File, usize, &Path, &dyn Progress) -> Result<(), ExportError>,
    ) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film");
        let film = FilmSpec::evenly(0.0, 1.0, 5, 25.0).expect("a film");
        write(&camera(40, 30, None), &film, &path, &Silent).expect("written");
        let whole = std::fs::read(&path).expect("read");
        let check = |bytes: &[u8], count| {
            std::fs::write(&path, bytes).expect("written");
            let file = File::open(&path).expect("opened");
            check(&file, count, &path, &Silent)
        };
        assert!(check(&whole, 5).is_ok());
        for count in [4, 6] {
            let message = check(&whole, count).expect_err("another count");
            assert!(message.to_string().contains("frames"), "{message}");
        }
        for length in [0, 10, whole.len() / 2, whole.len() - 1] {
            let message = check(&whole[..length], 5).expect_err("cut off").to_string();
            assert!(message.contains("was not written completely"), "{message}");
        }
        let mut zeroed = whole.clone();
        // The zeros are in the compressed frame data, where they break the decoding.
        zeroed[whole.len() * 2 / 3..whole.len() * 3 / 4].fill(0);
        assert!(check(&zeroed, 5).is_err(), "zeros in the middle");
    }

    /// Records the reported stages and fractions.
    #[derive(Default)]
    struct ReportedFractions(Mutex<Vec<(&'static str, f64)>>);

    impl Progress for ReportedFractions {
        fn report(&self, stage: &'static str, fraction: f64) {
            self.0.lock().expect("free").push((stage, fraction));
        }

        fn is_cancelled(&self) -> bool {
            false
        }
    }

    #[test]
    fn reported_progress_never_decreases() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film");
        let film = FilmSpec::evenly(0.0, 1.0, 30, 25.0).expect("a film");
        for write in [write_gif, write_apng] {
            let reports = ReportedFractions::default();
            write(&camera(8, 6, None), &film, &path, &reports).expect("written");
            let reports = reports.0.into_inner().expect("free");
            assert!(reports.is_sorted_by(|a, b| a.1 <= b.1), "{reports:?}");
            let checking = reports.iter().find(|report| report.0 == CHECKING_STAGE);
            assert!(checking.is_some_and(|report| report.1 >= DRAWN_FRACTION));
        }
    }

    #[test]
    fn a_damaged_gif_is_noticed() {
        assert_damage_is_noticed(write_gif, check_gif);
    }

    #[test]
    fn a_damaged_animated_png_is_noticed() {
        assert_damage_is_noticed(write_apng, check_apng);
    }
}
