//! Disk cache of the gallery's thumbnails, each a strip of a few in-betweens. Drawing all of them
//! takes half a minute on a small machine.

use std::collections::HashMap;
use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::SystemTime;

use bevy::prelude::Resource;
use image::{ImageFormat, RgbaImage};

use crate::io::atomic_file::AtomicFile;
use crate::io::read;

/// Cached strips by project name. Failures are harmless: a missing strip is drawn again.
#[derive(Resource, Clone, Debug, Default)]
pub struct GalleryStripCache {
    /// Folder of the cache; `None` if nothing is cached, as in tests.
    cache_folder: Option<StripCacheFolder>,
}

/// Cache folder, with one subfolder per version of the program, because versions draw differently.
#[derive(Clone, Debug)]
struct StripCacheFolder {
    root: PathBuf,
    version: String,
}

impl StripCacheFolder {
    /// Subfolder for the strips of this version of the program.
    fn version_folder(&self) -> PathBuf {
        self.root.join(&self.version)
    }

    /// Creates the subfolder of this version and deletes those of other versions, which would
    /// otherwise stay for ever.
    fn create(&self) -> io::Result<()> {
        fs::create_dir_all(self.version_folder())?;
        for other in fs::read_dir(&self.root)?.flatten() {
            let name = other.file_name();
            let is_version = name.to_str().is_some_and(is_version_id);
            if is_version && name != *self.version {
                // If another version is still installed, it draws its strips again.
                fs::remove_dir_all(other.path()).ok();
            }
        }
        Ok(())
    }
}

impl GalleryStripCache {
    /// Cache of this program version in the user's cache folder.
    #[must_use]
    pub fn in_user_cache() -> Self {
        let root = dirs::cache_dir().map(|cache| cache.join("morphospace").join("strips"));
        let cache_folder = root.zip(version());
        Self {
            cache_folder: cache_folder.map(|(root, version)| StripCacheFolder { root, version }),
        }
    }

    /// All cached strips with this width and height in pixels.
    #[must_use]
    pub fn read(&self, size: (u32, u32)) -> HashMap<String, RgbaImage> {
        let files = self
            .cache_folder
            .iter()
            .filter_map(|folder| fs::read_dir(folder.version_folder()).ok());
        let strips = files.flatten().flatten().filter_map(|file| {
            let path = file.path();
            let strip = image::load_from_memory(&read::read(&path).ok()?).ok()?;
            let strip = strip.into_rgba8();
            let name = path.file_stem()?.to_str()?.to_owned();
            (strip.dimensions() == size).then_some((name, strip))
        });
        strips.collect()
    }

    /// Stores the strip of the project with this name.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn store(&self, name: &str, strip: &RgbaImage) -> io::Result<()> {
        let Some(cache_folder) = &self.cache_folder else {
            return Ok(());
        };
        let folder = cache_folder.version_folder();
        if !folder.exists() {
            cache_folder.create()?;
        }
        let mut png = io::Cursor::new(Vec::new());
        let encoded = strip.write_to(&mut png, ImageFormat::Png);
        encoded.map_err(io::Error::other)?;
        let mut file = AtomicFile::create(&folder.join(format!("{name}.png")))?;
        file.file_mut().write_all(png.get_ref())?;
        file.commit()
    }
}

/// Identifies this version of the program by version number, file size and modification time.
fn version() -> Option<String> {
    let file = std::env::current_exe().and_then(fs::metadata).ok()?;
    let since = file.modified().ok()?.duration_since(SystemTime::UNIX_EPOCH);
    let mut hasher = DefaultHasher::new();
    hasher.write(env!("CARGO_PKG_VERSION").as_bytes());
    hasher.write_u64(file.len());
    hasher.write_u128(since.ok()?.as_nanos());
    Some(format!("{:016x}", hasher.finish()))
}

/// Whether a folder's name has the form of the identifiers from [`version`]; other folders are
/// never deleted.
fn is_version_id(name: &str) -> bool {
    name.len() == 16 && name.bytes().all(|byte| byte.is_ascii_hexdigit())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    /// Width and height of the test strips, in pixels.
    const SIZE: (u32, u32) = (6, 2);

    fn cache_in(folder: &tempfile::TempDir) -> GalleryStripCache {
        let cache_folder = StripCacheFolder {
            root: folder.path().to_owned(),
            version: "0123456789abcdef".to_owned(),
        };
        GalleryStripCache {
            cache_folder: Some(cache_folder),
        }
    }

    #[test]
    fn stored_strips_are_read_back() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let [other, foreign] = ["fedcba9876543210", "mine"].map(|name| folder.path().join(name));
        fs::create_dir_all(&other)?;
        fs::create_dir_all(&foreign)?;
        let cache = cache_in(&folder);
        assert!(cache.read(SIZE).is_empty());
        let strip = RgbaImage::from_fn(SIZE.0, SIZE.1, |x, y| Rgba([x as u8, y as u8, 7, 128]));
        cache.store("gears", &strip)?;
        assert_eq!(cache.read(SIZE), HashMap::from([("gears".into(), strip)]));
        assert!(!other.exists(), "strips of other versions are deleted");
        assert!(foreign.exists(), "other folders are kept");
        Ok(())
    }

    #[test]
    fn invalid_strips_are_left_out() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let cache = cache_in(&folder);
        cache.store("small", &RgbaImage::new(1, 1))?;
        let version_folder = folder.path().join("0123456789abcdef");
        fs::write(version_folder.join("broken.png"), "not a picture")?;
        // Opening a pipe would block for ever.
        #[cfg(unix)]
        std::process::Command::new("mkfifo")
            .arg(version_folder.join("pipe.png"))
            .status()?;
        assert!(cache.read(SIZE).is_empty());
        Ok(())
    }

    #[test]
    fn without_a_folder_nothing_is_cached() -> io::Result<()> {
        let cache = GalleryStripCache::default();
        cache.store("gears", &RgbaImage::new(SIZE.0, SIZE.1))?;
        assert!(cache.read(SIZE).is_empty());
        Ok(())
    }
}
