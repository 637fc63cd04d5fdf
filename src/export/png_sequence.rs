//! A film as numbered pictures, a file a frame.
//!
//! Guarantees: a file's number is the frame's number within the whole film, so
//! that parts rendered on different machines fit together; each file is there
//! whole or not at all; they are written in order, so that a run that ended half
//! way leaves the frames from its first one on without a gap, and
//! `--frames-range` can go on from there; their folder is made where it is
//! missing. Files of an earlier, longer film are left alone.

use std::fs;
use std::path::PathBuf;

use crate::io::atomic_file;
use crate::work::progress::Progress;

use super::camera::{Camera, DRAWING_STAGE};
use super::error::ExportError;
use super::film_spec::FilmSpec;
use super::still::encoded;
use super::target::NumberedFiles;

/// Writes the frames and returns their paths in order.
///
/// # Errors
/// [`ExportError`] where a file cannot be written or nobody wants them any
/// more; the frames before it stay.
pub fn write_numbered(
    camera: &Camera,
    film: &FilmSpec,
    names: &NumberedFiles,
    progress: &dyn Progress,
) -> Result<Vec<PathBuf>, ExportError> {
    fs::create_dir_all(&names.folder).map_err(ExportError::write(&names.folder))?;
    atomic_file::remove_leftovers(&names.folder);
    let mut written = Vec::with_capacity(film.times().len());
    // For the message alone: a frame that cannot be encoded is as large as all
    // others.
    let first = names.path(film.first_number());
    camera.shoot_runs(
        &film.runs(),
        DRAWING_STAGE,
        progress,
        |drawing| encoded(&drawing, names.kind, &first),
        |run, bytes| {
            for number in run.first..run.first + run.count {
                let path = names.path(number);
                let written_one = atomic_file::write_one_of_many(&path, &bytes);
                written_one.map_err(ExportError::write(&path))?;
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
    fn a_file_is_no_folder_for_them() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("film");
        fs::write(&file, b"mine").expect("written");
        let film = FilmSpec::evenly(0.0, 1.0, 2, 24.0).expect("a film");
        let error = write_numbered(&camera(8, 8, None), &film, &names(&file, "#.png"), &Silent);
        let told = error.expect_err("no folder").to_string();
        assert!(told.contains("something of that name is there"), "{told}");
        assert_eq!(fs::read(&file).expect("read"), b"mine");
    }

    #[test]
    fn parts_make_the_same_files_as_the_whole() {
        let (whole, split) = (tempfile::tempdir(), tempfile::tempdir());
        let (whole, split) = (whole.expect("a folder"), split.expect("a folder"));
        let camera = camera(20, 16, None);
        let film = FilmSpec::evenly(0.0, 1.0, 9, 24.0).expect("a film");
        let all = names(whole.path(), "x-###.png");
        let written = write_numbered(&camera, &film, &all, &Silent).expect("written");
        assert_eq!(written.len(), 9);
        for range in [4..9, 0..4] {
            let part = film.part(range).expect("a part");
            let names = names(split.path(), "x-###.png");
            write_numbered(&camera, &part, &names, &Silent).expect("written");
        }
        assert_eq!(listing(whole.path()), listing(split.path()));
        assert_eq!(listing(whole.path())[8].0, "x-008.png");
    }

    #[test]
    fn holds_fill_their_numbers_and_svg_can_be_numbered_too() {
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
    fn a_cancel_stops_it_and_leaves_no_half_file() {
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
