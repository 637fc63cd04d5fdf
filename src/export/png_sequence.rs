//! Writes a film as numbered images, one file per frame.
//!
//! A file's number is the number of the frame within the whole film, so ranges rendered on
//! different machines fit together. Each file is written atomically. Files are written in order, so
//! an interrupted run leaves a range without gaps, which `--frames-range` can continue. A missing
//! folder is created; files of an earlier, longer film are not deleted.

use std::fs;
use std::path::PathBuf;

use crate::io::atomic_file;
use crate::work::progress::Progress;

use super::camera::{Camera, DRAWING_STAGE};
use super::error::ExportError;
use super::film_spec::FilmSpec;
use super::still::encode_still;
use super::target::NumberedFiles;

/// Writes the frames and returns their paths in order.
///
/// # Errors
/// [`ExportError`] if a file cannot be written or the export is cancelled; frames already written
/// remain.
pub fn write_numbered(
    camera: &Camera,
    film: &FilmSpec,
    names: &NumberedFiles,
    progress: &dyn Progress,
) -> Result<Vec<PathBuf>, ExportError> {
    fs::create_dir_all(&names.folder).map_err(ExportError::write(&names.folder))?;
    atomic_file::remove_leftovers(&names.folder);
    let mut written = Vec::with_capacity(film.times().len());
    // Encoding errors depend only on the image size, so all of them name the path of the first
    // frame.
    let first = names.path(film.first_number());
    camera.draw_runs(
        &film.runs(),
        DRAWING_STAGE,
        progress,
        |drawing| encode_still(&drawing, names.kind, &first),
        |run, bytes| {
            for number in run.first..run.first + run.count {
                let path = names.path(number);
                let result = atomic_file::write_without_cleanup(&path, &bytes);
                result.map_err(ExportError::write(&path))?;
                written.push(path);
            }
            Ok(())
        },
    )?;
    Ok(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::ExportTarget;
    use crate::export::test_camera::camera;
    use crate::work::progress::{Cancelled, Silent};
    use std::path::Path;

    fn names(folder: &Path, pattern: &str) -> NumberedFiles {
        match ExportTarget::of_path(&folder.join(pattern)) {
            Ok(ExportTarget::Numbered(names)) => names,
            other => panic!("{pattern}: {other:?}"),
        }
    }

    fn listing(folder: &Path) -> Vec<(String, Vec<u8>)> {
        let entries = fs::read_dir(folder).expect("listed").map(|entry| {
            let path = entry.expect("an entry").path();
            let name = path.file_name().expect("a name").to_string_lossy();
            (name.into_owned(), fs::read(&path).expect("read"))
        });
        let mut files: Vec<_> = entries.collect();
        files.sort();
        files
    }

    #[test]
    fn a_file_in_place_of_the_folder_is_refused_and_unharmed() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("film");
        fs::write(&file, b"mine").expect("written");
        let film = FilmSpec::evenly(0.0, 1.0, 2, 24.0).expect("a film");
        let error = write_numbered(&camera(8, 8, None), &film, &names(&file, "#.png"), &Silent);
        let message = error.expect_err("no folder").to_string();
        assert!(message.contains("the name is already in use"), "{message}");
        assert_eq!(fs::read(&file).expect("read"), b"mine");
    }

    #[test]
    fn ranges_give_the_same_files_as_the_whole_film() {
        let (whole, split) = (tempfile::tempdir(), tempfile::tempdir());
        let (whole, split) = (whole.expect("a folder"), split.expect("a folder"));
        let camera = camera(20, 16, None);
        let film = FilmSpec::evenly(0.0, 1.0, 9, 24.0).expect("a film");
        let all = names(whole.path(), "x-###.png");
        let written = write_numbered(&camera, &film, &all, &Silent).expect("written");
        assert_eq!(written.len(), 9);
        for range in [4..9, 0..4] {
            let part = film.frame_range(range).expect("a part");
            let names = names(split.path(), "x-###.png");
            write_numbered(&camera, &part, &names, &Silent).expect("written");
        }
        assert_eq!(listing(whole.path()), listing(split.path()));
        assert_eq!(listing(whole.path())[8].0, "x-008.png");
    }

    #[test]
    fn pauses_are_written_frame_by_frame_and_svg_can_be_numbered() {
        let folder = tempfile::tempdir().expect("a folder");
        let film = FilmSpec::evenly(0.5, 0.5, 3, 24.0).expect("a film");
        assert_eq!(film.runs().len(), 1);
        let names = names(folder.path(), "#.svg");
        write_numbered(&camera(20, 16, None), &film, &names, &Silent).expect("written");
        let files = listing(folder.path());
        assert_eq!(files.len(), 3);
        assert!(files.iter().all(|(_, bytes)| bytes.starts_with(b"<svg ")));
    }

    #[test]
    fn cancelling_leaves_no_partial_file() {
        struct AlwaysCancelled;
        impl Progress for AlwaysCancelled {
            fn report(&self, _: &'static str, _: f64) {}
            fn is_cancelled(&self) -> bool {
                true
            }
        }
        let folder = tempfile::tempdir().expect("a folder");
        let film = FilmSpec::evenly(0.0, 1.0, 3, 24.0).expect("a film");
        let names = names(&folder.path().join("new"), "");
        let cancelled = write_numbered(&camera(20, 16, None), &film, &names, &AlwaysCancelled);
        assert!(matches!(cancelled, Err(ExportError::Cancelled(Cancelled))));
        assert!(listing(&folder.path().join("new")).is_empty());
    }
}
