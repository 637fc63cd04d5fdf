//! Character encodings of text files: UTF-8, UTF-16 and Windows-1252, and gzip compression around
//! them (SVGZ).

use super::note::ImportNote;
use crate::io::read::MAX_FILE_BYTES;
use std::borrow::Cow;
use std::io::Read;

/// Characters of the bytes 0x80 to 0x9f in Windows-1252; bytes without a character map to the
/// control character of the same number, as browsers do.
const WINDOWS_1252: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}',
    '\u{90}', '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

/// Names of encodings that browsers read as Windows-1252 (WHATWG Encoding, section 4.2).
const LATIN: [&str; 7] = [
    "windows-1252",
    "cp1252",
    "iso-8859-1",
    "iso8859-1",
    "latin1",
    "us-ascii",
    "ascii",
];

/// Returns the character of a byte in Windows-1252.
pub(super) fn from_windows_1252(byte: u8) -> char {
    match byte {
        0x80..=0x9f => WINDOWS_1252[usize::from(byte - 0x80)],
        _ => char::from(byte),
    }
}

/// Unpacks a gzip file; returns `None` if it is damaged or larger than a file may be.
pub(super) fn unpacked_gzip(data: &[u8]) -> Option<Vec<u8>> {
    let mut unpacked = Vec::new();
    let reader = flate2::read::MultiGzDecoder::new(data);
    reader
        .take(MAX_FILE_BYTES + 1)
        .read_to_end(&mut unpacked)
        .ok()?;
    (unpacked.len() as u64 <= MAX_FILE_BYTES).then_some(unpacked)
}

/// Returns the content of a file as it would be without compression and in an encoding that
/// contains ASCII: unpacks gzip, and converts UTF-16 to UTF-8. Other files are returned unchanged.
pub(super) fn plain_bytes(bytes: &[u8]) -> Cow<'_, [u8]> {
    let unpacked = match bytes.starts_with(&[0x1f, 0x8b]) {
        true => unpacked_gzip(bytes).map_or(Cow::Borrowed(bytes), Cow::Owned),
        false => Cow::Borrowed(bytes),
    };
    match from_utf16(&unpacked) {
        Some(text) => Cow::Owned(text.into_bytes()),
        None => unpacked,
    }
}

/// Decodes UTF-16 with a byte order mark, or XML in UTF-16 without one. Returns `None` for other
/// and for invalid text.
fn from_utf16(bytes: &[u8]) -> Option<String> {
    let read: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] | [b'<', 0, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] | [0, b'<', ..] => u16::from_be_bytes,
        _ => return None,
    };
    let pairs = bytes.chunks_exact(2);
    let units = pairs.map(|pair| read([pair[0], pair[1]]));
    let text: String = char::decode_utf16(units).collect::<Result<_, _>>().ok()?;
    Some(text.trim_start_matches('\u{feff}').to_owned())
}

/// Text of an XML file.
#[derive(Debug)]
pub(super) struct XmlText<'b> {
    pub text: Cow<'b, str>,
    /// Note on an encoding that could only be read approximately.
    pub note: Option<ImportNote>,
}

/// Decodes XML by the encoding that its declaration names. Unknown encodings are read as
/// Windows-1252 and reported: their tags and numbers are the same. Returns the number of the first
/// invalid line, counted from 1, of text that should be UTF-8.
pub(super) fn xml_text(bytes: &[u8]) -> Result<XmlText<'_>, usize> {
    let invalid = match std::str::from_utf8(bytes) {
        Ok(text) => {
            let text = Cow::Borrowed(text.trim_start_matches('\u{feff}'));
            return Ok(XmlText { text, note: None });
        }
        Err(error) => error.valid_up_to(),
    };
    let name = declared_encoding(bytes).unwrap_or_default();
    if matches!(name.as_str(), "" | "utf-8" | "utf8") {
        let lines = bytes[..invalid].iter().filter(|&&b| b == b'\n').count();
        return Err(1 + lines);
    }
    let text: String = bytes.iter().copied().map(from_windows_1252).collect();
    let note = (!LATIN.contains(&name.as_str())).then(|| ImportNote::LostFeature {
        feature: format!("encoding {name}"),
        replacement: Some("read as Windows-1252, so names and texts may have wrong letters".into()),
        elements: vec!["<?xml>".to_owned()],
        count: 1,
    });
    Ok(XmlText {
        text: Cow::Owned(text),
        note,
    })
}

/// Returns the encoding that an XML declaration names, in lower case.
fn declared_encoding(bytes: &[u8]) -> Option<String> {
    let end = bytes.windows(2).position(|pair| pair == b"?>")?;
    let declaration = std::str::from_utf8(&bytes[..end]).ok()?;
    let declaration = declaration.trim_start().strip_prefix("<?xml")?;
    let (_, value) = declaration.split_once("encoding")?;
    let value = value.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let (name, _) = value[1..].split_once(quote)?;
    Some(name.to_ascii_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn gzip(data: &[u8]) -> Vec<u8> {
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packer.write_all(data).expect("packs");
        packer.finish().expect("packs")
    }

    #[test]
    fn packed_files_and_utf_16_become_plain_bytes() {
        assert_eq!(&*plain_bytes(b"v 0 0 0"), b"v 0 0 0");
        assert_eq!(&*plain_bytes(&gzip(b"<svg/>")), b"<svg/>");
        let utf16 = |mark: &[u8], to_bytes: fn(u16) -> [u8; 2]| {
            let units = "<é/>".encode_utf16().flat_map(to_bytes);
            mark.iter().copied().chain(units).collect::<Vec<_>>()
        };
        for file in [
            utf16(b"\xff\xfe", u16::to_le_bytes),
            utf16(b"\xfe\xff", u16::to_be_bytes),
            utf16(b"", u16::to_le_bytes),
            gzip(&utf16(b"", u16::to_be_bytes)),
        ] {
            assert_eq!(&*plain_bytes(&file), "<é/>".as_bytes());
        }
    }

    #[test]
    fn damaged_and_exploding_archives_are_not_unpacked() {
        let mut damaged = gzip(b"<svg/>");
        damaged.truncate(12);
        assert_eq!(&*plain_bytes(&damaged), damaged.as_slice());
        let bomb = gzip(&vec![b' '; MAX_FILE_BYTES as usize + 1]);
        assert!(unpacked_gzip(&bomb).is_none());
    }

    #[test]
    fn xml_is_decoded_by_its_declaration() {
        let read = |head: &str| {
            let bytes = [head.as_bytes(), b"\n<a>\xe9\x80</a>"].concat();
            xml_text(&bytes).map(|found| (found.text.into_owned(), found.note.is_some()))
        };
        let latin = r#"<?xml version="1.0" encoding='ISO-8859-1'?>"#;
        assert_eq!(read(latin), Ok((format!("{latin}\n<a>é€</a>"), false)));
        let other = r#"<?xml version="1.0" encoding="KOI8-R"?>"#;
        assert!(read(other).expect("readable").1);
        assert_eq!(read(r#"<?xml version="1.0" encoding="UTF-8"?>"#), Err(2));
        assert_eq!(read("<!-- none -->"), Err(2));
    }
}
