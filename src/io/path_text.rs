//! Paths in text files, such as projects, autosaves and lists of recent files.
//!
//! A UTF-8 path is written unchanged. Any other path is written as `file:` followed by the path, with
//! `%` and each byte that is not UTF-8 percent-encoded: `file:caf%E9.svg`. Text after `file:` is
//! decoded only if the result is not UTF-8 or starts with `file:` again. Paths in older files
//! therefore keep their meaning, except for paths such as `file:%FF` and `file:file:a`; these are
//! now written encoded.
//!
//! Guarantees: reading a written path gives the same path. Outside Unix, where paths have no bytes,
//! a path that is not UTF-8 cannot be written.

use std::path::{Path, PathBuf};

/// Start of a percent-encoded path.
const PREFIX: &str = "file:";

/// Returns the text of a path; `None` if the system has no bytes for a path that is not UTF-8.
pub(crate) fn text_from_path(path: &Path) -> Option<String> {
    match path.to_str() {
        Some(text) if decoded(text).is_none() => Some(text.to_owned()),
        _ => encoded(path),
    }
}

/// Returns the path with this text.
pub(crate) fn path_from_text(text: &str) -> PathBuf {
    decoded(text).unwrap_or_else(|| text.into())
}

/// Splits a path at the first `mark`, an ASCII character; `None` if there is none.
pub(crate) fn split_path_once(path: &Path, mark: u8) -> Option<(PathBuf, PathBuf)> {
    let at = bytes_of(path)?.iter().position(|byte| *byte == mark)?;
    split_path_at(path, at)
}

/// Splits a path at the last `mark`, an ASCII character; `None` if there is none.
pub(crate) fn rsplit_path_once(path: &Path, mark: u8) -> Option<(PathBuf, PathBuf)> {
    let at = bytes_of(path)?.iter().rposition(|byte| *byte == mark)?;
    split_path_at(path, at)
}

/// Splits a path into the parts before and after the byte with index `at`.
fn split_path_at(path: &Path, at: usize) -> Option<(PathBuf, PathBuf)> {
    let bytes = bytes_of(path)?;
    Some((
        path_of(bytes[..at].to_vec())?,
        path_of(bytes[at + 1..].to_vec())?,
    ))
}

/// Decodes percent-encoding. Invalid codes stay as they are.
pub(crate) fn percent_decoded(text: &str) -> Vec<u8> {
    let mut parts = text.split('%');
    let mut bytes = parts.next().unwrap_or_default().as_bytes().to_vec();
    for part in parts {
        // The test for digits is needed because `from_str_radix` also accepts a sign.
        let code = part
            .get(..2)
            .filter(|code| code.bytes().all(|byte| byte.is_ascii_hexdigit()));
        let byte = code.and_then(|code| u8::from_str_radix(code, 16).ok());
        bytes.push(byte.unwrap_or(b'%'));
        bytes.extend(&part.as_bytes()[if byte.is_some() { 2 } else { 0 }..]);
    }
    bytes
}

fn encoded(path: &Path) -> Option<String> {
    let mut text = PREFIX.to_owned();
    for chunk in bytes_of(path)?.utf8_chunks() {
        text.push_str(&chunk.valid().replace('%', "%25"));
        let codes = chunk.invalid().iter().map(|byte| format!("%{byte:02X}"));
        text.extend(codes);
    }
    Some(text)
}

/// Returns the path that a percent-encoded text stands for; `None` if the text is to be taken as it
/// is.
fn decoded(text: &str) -> Option<PathBuf> {
    let bytes = percent_decoded(text.strip_prefix(PREFIX)?);
    // A path that looks encoded is encoded a second time.
    let is_plain = std::str::from_utf8(&bytes).is_ok_and(|text| !text.starts_with(PREFIX));
    (!is_plain).then(|| path_of(bytes)).flatten()
}

#[cfg(unix)]
fn bytes_of(path: &Path) -> Option<&[u8]> {
    use std::os::unix::ffi::OsStrExt;
    Some(path.as_os_str().as_bytes())
}

#[cfg(unix)]
fn path_of(bytes: Vec<u8>) -> Option<PathBuf> {
    use std::os::unix::ffi::OsStringExt;
    Some(std::ffi::OsString::from_vec(bytes).into())
}

#[cfg(not(unix))]
fn bytes_of(path: &Path) -> Option<&[u8]> {
    path.to_str().map(str::as_bytes)
}

#[cfg(not(unix))]
fn path_of(bytes: Vec<u8>) -> Option<PathBuf> {
    String::from_utf8(bytes).ok().map(PathBuf::from)
}

/// Serialises a path, for `#[serde(with = "path_text")]`.
pub(crate) fn serialize<S: serde::Serializer>(
    path: &Path,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&text_or_error(path)?)
}

/// Deserialises a path, for `#[serde(with = "path_text")]`.
pub(crate) fn deserialize<'de, D: serde::Deserializer<'de>>(
    deserializer: D,
) -> Result<PathBuf, D::Error> {
    let text: String = serde::Deserialize::deserialize(deserializer)?;
    Ok(path_from_text(&text))
}

fn text_or_error<E: serde::ser::Error>(path: &Path) -> Result<String, E> {
    let error = || E::custom(format!("the path {} is not text", path.display()));
    text_from_path(path).ok_or_else(error)
}

/// Optional paths, for `#[serde(with = "path_text::option")]`.
pub(crate) mod option {
    use super::{PathBuf, path_from_text, text_or_error};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// Serialises an optional path.
    pub(crate) fn serialize<S: Serializer>(
        path: &Option<PathBuf>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let text = path.as_deref().map(text_or_error::<S::Error>).transpose()?;
        text.serialize(serializer)
    }

    /// Deserialises an optional path.
    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<PathBuf>, D::Error> {
        let text = Option::<String>::deserialize(deserializer)?;
        Ok(text.as_deref().map(path_from_text))
    }
}

/// Lists of paths, for `#[serde(with = "path_text::list")]`.
#[cfg(feature = "app")]
pub(crate) mod list {
    use super::{PathBuf, path_from_text, text_or_error};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// Serialises a list of paths.
    pub(crate) fn serialize<S: Serializer>(
        paths: &[PathBuf],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let texts = paths.iter().map(|path| text_or_error::<S::Error>(path));
        texts.collect::<Result<Vec<_>, _>>()?.serialize(serializer)
    }

    /// Deserialises a list of paths.
    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<PathBuf>, D::Error> {
        let texts = Vec::<String>::deserialize(deserializer)?;
        Ok(texts.iter().map(|text| path_from_text(text)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_older_files_keep_their_meaning() {
        for text in ["a.svg", "file:a.svg", "file:a%20b.svg", "100%.svg", "%E9"] {
            assert_eq!(path_from_text(text), Path::new(text));
            assert_eq!(text_from_path(Path::new(text)).as_deref(), Some(text));
        }
    }

    #[cfg(unix)]
    #[test]
    fn any_path_is_read_back_as_it_was() {
        let path = |bytes: &[u8]| path_of(bytes.to_vec()).expect("a path");
        let cafe = path(b"caf\xe9 50%.svg");
        assert_eq!(
            text_from_path(&cafe).as_deref(),
            Some("file:caf%E9 50%25.svg")
        );
        for bytes in [
            &b"caf\xe9 50%.svg"[..],
            b"\xff",
            b"file:\xff",
            b"file:%FF",
            b"file:file:a",
            b"file:file:%25FF",
            "ä/\u{202e}%41".as_bytes(),
            b"\xc3/\xed\xa0\x80#a",
        ] {
            let text = text_from_path(&path(bytes)).expect("text");
            assert_eq!(path_from_text(&text), path(bytes), "{text}");
        }
    }
}
