//! The film strips of the gallery, so that they are there at the next start: all of them take both
//! cores of a small machine half a minute.

use std::collections::HashMap;
use std::fs;
use std::hash::Hasher;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::SystemTime;

use bevy::prelude::Resource;
use fnv::FnvHasher;
use image::{ImageFormat, RgbaImage};

use crate::io::atomic_file::AtomicFile;

/// Strips as pictures, each by the name of its project. What cannot be kept or read is no loss: it
/// is drawn again.
#[derive(Resource, Clone, Debug, Default)]
pub struct GalleryStripCache {
    /// None where nothing is to be kept, as in tests.
    place: Option<StripCacheFolder>,
}

/// A folder for each program, which draw otherwise, in one of all.
#[derive(Clone, Debug)]
struct StripCacheFolder {
    all: PathBuf,
    program: String,
}

impl StripCacheFolder {
    fn own(&self) -> PathBuf {
        self.all.join(&self.program)
    }

    /// Makes the folder. Those of other programs would lie there for good.
    fn make(&self) -> io::Result<()> {
        fs::create_dir_all(self.own())?;
        for other in fs::read_dir(&self.all)?.flatten() {
            let name = other.file_name();
            let is_program = name.to_str().is_some_and(is_program);
            if is_program && name != *self.program {
                // Whoever else uses them draws them again.
                fs::remove_dir_all(other.path()).ok();
            }
        }
        Ok(())
    }
}

impl GalleryStripCache {
    /// Those of this program, in the user's folder for what can be made again.
    #[must_use]
    pub fn usual() -> Self {
        let all = dirs::cache_dir().map(|cache| cache.join("morphospace").join("strips"));
        let place = all.zip(program());
        Self {
            place: place.map(|(all, program)| StripCacheFolder { all, program }),
        }
    }

    /// All that there are, of that width and height in pixels.
    #[must_use]
    pub fn read(&self, size: (u32, u32)) -> HashMap<String, RgbaImage> {
        let files = self
            .place
            .iter()
            .filter_map(|it| fs::read_dir(it.own()).ok());
        let strips = files.flatten().flatten().filter_map(|file| {
            let path = file.path();
            let strip = image::open(&path).ok()?.into_rgba8();
            let name = path.file_stem()?.to_str()?.to_owned();
            (strip.dimensions() == size).then_some((name, strip))
        });
        strips.collect()
    }

    /// Keeps one.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn keep(&self, name: &str, strip: &RgbaImage) -> io::Result<()> {
        let Some(place) = &self.place else {
            return Ok(());
        };
        let folder = place.own();
        if !folder.exists() {
            place.make()?;
        }
        let mut png = io::Cursor::new(Vec::new());
        let encoded = strip.write_to(&mut png, ImageFormat::Png);
        encoded.map_err(io::Error::other)?;
        let mut file = AtomicFile::create(&folder.join(format!("{name}.png")))?;
        file.file_mut().write_all(png.get_ref())?;
        file.commit()
    }
}

/// What tells this program from others, which draw otherwise: version, length and date.
fn program() -> Option<String> {
    let file = std::env::current_exe().and_then(fs::metadata).ok()?;
    let since = file.modified().ok()?.duration_since(SystemTime::UNIX_EPOCH);
    let mut hasher = FnvHasher::default();
    hasher.write(env!("CARGO_PKG_VERSION").as_bytes());
    hasher.write_u64(file.len());
    hasher.write_u128(since.ok()?.as_nanos());
    Some(format!("{:016x}", hasher.finish()))
}

/// Whether that is such a name: nothing else is taken away.
fn is_program(name: &str) -> bool {
    name.len() == 16 && name.bytes().all(|byte| byte.is_ascii_hexdigit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    const SIZE: (u32, u32) = (6, 2);

    fn within(folder: &tempfile::TempDir) -> GalleryStripCache {
        let place = StripCacheFolder {
            all: folder.path().to_owned(),
            program: "0123456789abcdef".to_owned(),
        };
        GalleryStripCache { place: Some(place) }
    }

    #[test]
    fn what_is_kept_is_read_again() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let [other, foreign] = ["fedcba9876543210", "mine"].map(|name| folder.path().join(name));
        fs::create_dir_all(&other)?;
        fs::create_dir_all(&foreign)?;
        let kept = within(&folder);
        assert!(kept.read(SIZE).is_empty());
        let strip = RgbaImage::from_fn(SIZE.0, SIZE.1, |x, y| Rgba([x as u8, y as u8, 7, 128]));
        kept.keep("gears", &strip)?;
        assert_eq!(kept.read(SIZE), HashMap::from([("gears".into(), strip)]));
        assert!(!other.exists(), "it would lie there for good");
        assert!(foreign.exists(), "what is no program's is left alone");
        Ok(())
    }

    #[test]
    fn what_is_no_strip_is_left_out() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let kept = within(&folder);
        kept.keep("small", &RgbaImage::new(1, 1))?;
        let own = folder.path().join("0123456789abcdef");
        fs::write(own.join("broken.png"), "not a picture")?;
        assert!(kept.read(SIZE).is_empty());
        Ok(())
    }

    #[test]
    fn without_a_folder_nothing_is_kept() -> io::Result<()> {
        let kept = GalleryStripCache::default();
        kept.keep("gears", &RgbaImage::new(SIZE.0, SIZE.1))?;
        assert!(kept.read(SIZE).is_empty());
        Ok(())
    }
}
