//! Whether a film that was written can be read again, frame by frame, before it
//! takes the place of an earlier one.

use std::fmt::Display;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use crate::work::progress::{Progress, checkpoint};

use super::error::ExportError;

/// The stage, as [`Progress`] is told.
pub(super) const CHECKING_STAGE: &str = "checking the film";

/// How much is done once all frames are drawn and written, as it is told;
/// reading them takes about a tenth of that.
pub(super) const DRAWN_FRACTION: f64 = 0.9;

/// Reads a GIF to its end.
///
/// # Errors
/// [`ExportError::NotWhole`] where it has other than `count` frames, or
/// [`ExportError::Cancelled`]; `path` is what it is going to be called.
pub(super) fn check_gif(
    written: &File,
    count: usize,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let mut options = gif::DecodeOptions::new();
    // A frame is as large as the user wanted it.
    options.set_memory_limit(gif::MemoryLimit::Unlimited);
    let mut decoder = (options.read_info(BufReader::new(written)))
        .map_err(|error| ExportError::not_whole(path, error))?;
    // One more than there are is the end.
    for number in 0..=count {
        checkpoint(progress, CHECKING_STAGE, number as f64 / count as f64)?;
        let frame = decoder.read_next_frame();
        let frame = frame.map_err(broken_at(path, number, count))?;
        if frame.is_some() != (number < count) {
            let reason = format!("it has other than {count} frames");
            return Err(ExportError::not_whole(path, reason));
        }
    }
    Ok(())
}

/// Reads an animated PNG to its end.
///
/// # Errors
/// As [`check_gif`].
pub(super) fn check_apng(
    written: &File,
    count: usize,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    let limits = png::Limits { bytes: usize::MAX };
    let decoder = png::Decoder::new_with_limits(BufReader::new(written), limits);
    let mut reader = (decoder.read_info()).map_err(|error| ExportError::not_whole(path, error))?;
    let control = reader.info().animation_control;
    if control.map(|control| control.num_frames as usize) != Some(count) {
        let reason = format!("it has other than {count} frames");
        return Err(ExportError::not_whole(path, reason));
    }
    let mut pixels = vec![0; reader.output_buffer_size().unwrap_or_default()];
    for number in 0..count {
        checkpoint(progress, CHECKING_STAGE, number as f64 / count as f64)?;
        let read = reader.next_frame(&mut pixels);
        read.map_err(broken_at(path, number, count))?;
    }
    reader.finish().map_err(broken_at(path, count, count))
}

fn broken_at<E: Display>(
    path: &Path,
    number: usize,
    count: usize,
) -> impl FnOnce(E) -> ExportError {
    move |error| {
        let reason = format!("it cannot be read beyond frame {number} of {count} ({error})");
        ExportError::not_whole(path, reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::test_camera::camera;
    use crate::export::{FilmSpec, write_apng, write_gif};
    use crate::work::progress::Silent;
    use std::sync::Mutex;

    /// What a check says of a film that lacks its last bytes, or has others.
    fn is_noticed(
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
            let said = check(&whole, count).expect_err("another count");
            assert!(said.to_string().contains("frames"), "{said}");
        }
        for length in [0, 10, whole.len() / 2, whole.len() - 1] {
            let said = check(&whole[..length], 5).expect_err("cut off").to_string();
            assert!(said.contains("did not come out whole"), "{said}");
        }
        let mut holed = whole.clone();
        // Among the frames: nothing tells whether a colour is the right one.
        holed[whole.len() * 2 / 3..whole.len() * 3 / 4].fill(0);
        assert!(check(&holed, 5).is_err(), "zeros in the middle");
    }

    /// What is told while a film is written.
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
    fn the_share_that_is_told_never_goes_down() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("film");
        let film = FilmSpec::evenly(0.0, 1.0, 30, 25.0).expect("a film");
        for write in [write_gif, write_apng] {
            let heard = ReportedFractions::default();
            write(&camera(8, 6, None), &film, &path, &heard).expect("written");
            let heard = heard.0.into_inner().expect("free");
            assert!(heard.is_sorted_by(|a, b| a.1 <= b.1), "{heard:?}");
            let checking = heard.iter().find(|told| told.0 == CHECKING_STAGE);
            assert_eq!(checking, Some(&(CHECKING_STAGE, DRAWN_FRACTION)));
        }
    }

    #[test]
    fn a_gif_that_is_not_whole_is_noticed() {
        is_noticed(write_gif, check_gif);
    }

    #[test]
    fn an_animated_png_that_is_not_whole_is_noticed() {
        is_noticed(write_apng, check_apng);
    }
}
