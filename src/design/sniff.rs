//! Which format a file has, by what is in it. The ending of its name is never
//! looked at: a mislabelled file works where its content is good.

use super::format::Format;
use image::ImageFormat;
use serde::de::IgnoredAny;
use std::collections::HashMap;

/// Content that no reader takes.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UnknownFormat {
    /// A known format of another kind.
    #[error("this is {found}; {way_out}")]
    Other {
        /// What it is.
        found: &'static str,
        /// What to do.
        way_out: &'static str,
    },
    /// XML with some other root.
    #[error("this is XML without an <svg> element; save the drawing as SVG")]
    XmlWithoutSvg,
    /// JSON of another kind.
    #[error(
        "this JSON is no design; give \"nodes\" and \"bars\" for a truss, \"rings\" or \"polygons\" for outlines, or GeoJSON with a \"type\""
    )]
    Json,
    /// Nothing that is known.
    #[error("the content is of no known format; use {}", Format::listed(&Format::ALL))]
    Unknown,
}

/// First bytes of formats that people will try, and what to tell them.
const OTHERS: [(&[u8], &str, &str); 11] = [
    (b"\x1f\x8b", "a compressed file, perhaps an SVGZ", UNPACK),
    (b"GIF8", "a GIF", PICTURE),
    (b"II*\0", "a TIFF", PICTURE),
    (b"MM\0*", "a TIFF", PICTURE),
    (b"\0\0\x01\0", "an icon", PICTURE),
    (b"8BPS", "a Photoshop file", PICTURE),
    (b"%PDF", "a PDF", DRAWING),
    (b"%!PS", "a PostScript file", DRAWING),
    (b"PK\x03\x04", "an archive", UNPACK),
    (b"\xff\xfe", "text in UTF-16", UTF8),
    (b"\xfe\xff", "text in UTF-16", UTF8),
];
const PICTURE: &str = "save it as PNG";
const DRAWING: &str = "save the drawing as plain SVG";
const UNPACK: &str = "unpack it and open what is in it";
const UTF8: &str = "save it with the encoding UTF-8";

/// Tells the format of a file from its bytes.
///
/// # Errors
/// [`UnknownFormat`] says what the content is, where that is known, and what
/// to save it as.
///
/// ```
/// use morphospace::design::{Format, sniff};
/// assert_eq!(sniff(b"\xef\xbb\xbf<?xml version='1.0'?><svg/>"), Ok(Format::Svg));
/// ```
pub fn sniff(bytes: &[u8]) -> Result<Format, UnknownFormat> {
    if let Some(format) = picture(bytes) {
        return Ok(Format::Picture(format));
    }
    let other = OTHERS.iter().find(|(magic, ..)| bytes.starts_with(magic));
    if let Some(&(_, found, way_out)) = other {
        return Err(UnknownFormat::Other { found, way_out });
    }
    if bytes.starts_with(super::dxf::BINARY) {
        return Ok(Format::Dxf);
    }
    text_format(bytes)
}

fn picture(bytes: &[u8]) -> Option<ImageFormat> {
    let guessed = image::guess_format(bytes).ok()?;
    let is_read = Format::PICTURES.contains(&Format::Picture(guessed));
    let is_picture = is_read && (guessed != ImageFormat::Bmp || is_bmp(bytes));
    is_picture.then_some(guessed)
}

/// `BM` alone also begins words: the size of the second header must be one of
/// those that exist, too.
fn is_bmp(bytes: &[u8]) -> bool {
    let header_size = bytes.get(14..18).and_then(|b| b.try_into().ok());
    header_size
        .map(u32::from_le_bytes)
        .is_some_and(|size| matches!(size, 12 | 16 | 40 | 52 | 56 | 64 | 108 | 124))
}

fn text_format(bytes: &[u8]) -> Result<Format, UnknownFormat> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match bytes.trim_ascii_start().first() {
        Some(b'<') if has_svg_element(bytes) => Ok(Format::Svg),
        Some(b'<') => Err(UnknownFormat::XmlWithoutSvg),
        Some(b'[') => Ok(Format::Polygons),
        Some(b'{') => json_format(bytes),
        Some(_) if is_dxf(bytes) => Ok(Format::Dxf),
        // Last, for a line that begins with a v stands in many a text.
        Some(_) if is_obj(bytes) => Ok(Format::Obj),
        _ => Err(UnknownFormat::Unknown),
    }
}

/// What an object of JSON is, by its members.
fn json_format(bytes: &[u8]) -> Result<Format, UnknownFormat> {
    // Values are passed over without recursion, however deep they are.
    let Ok(members) = serde_json::from_slice::<HashMap<String, IgnoredAny>>(bytes) else {
        // The reader of polygons parses everything first, and says where it breaks.
        return Ok(Format::Polygons);
    };
    let has = |names: &[&str]| names.iter().any(|name| members.contains_key(*name));
    // GeoJSON may have members of any name, a truss has its own alone.
    if has(&["type", "rings", "polygons"]) {
        Ok(Format::Polygons)
    } else if has(&["nodes", "bars"]) {
        Ok(Format::Truss)
    } else {
        Err(UnknownFormat::Json)
    }
}

/// Whether some tag is called `svg`, with or without a namespace prefix.
fn has_svg_element(bytes: &[u8]) -> bool {
    let is_svg = |tag: &[u8]| {
        let end = tag
            .iter()
            .position(|&b| b.is_ascii_whitespace() || b == b'>' || b == b'/')
            .unwrap_or(tag.len());
        tag[..end].rsplit(|&b| b == b':').next() == Some(b"svg")
    };
    // Looked for and not parsed: comments and a DOCTYPE may stand before it, and
    // a broken drawing is to be told as a drawing.
    bytes.split(|&b| b == b'<').skip(1).any(is_svg)
}

/// Whether the first pair of lines, comments aside, begins a section.
fn is_dxf(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    loop {
        match (lines.next(), lines.next()) {
            (Some(b"999"), Some(_)) => {}
            (code, name) => return (code, name) == (Some(b"0"), Some(b"SECTION")),
        }
    }
}

/// Whether some line holds a vertex.
fn is_obj(bytes: &[u8]) -> bool {
    bytes.split(|&b| b == b'\n' || b == b'\r').any(|line| {
        let mut words = line
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        words.next() == Some(b"v") && words.next().is_some()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_format_is_known_by_its_content() {
        let cases: [(&[u8], Format); 16] = [
            (b"\x89PNG\r\n\x1a\nrest", Format::Picture(ImageFormat::Png)),
            (b"\xff\xd8\xff\xe0", Format::Picture(ImageFormat::Jpeg)),
            (
                b"RIFF\x01\x02\x03\x04WEBPVP8 ",
                Format::Picture(ImageFormat::WebP),
            ),
            (
                b"BM____________\x28\0\0\0",
                Format::Picture(ImageFormat::Bmp),
            ),
            (b" \n<svg:svg xmlns:svg='s'/>", Format::Svg),
            (b"<!-- a --><!DOCTYPE svg><svg>", Format::Svg),
            (b"# a comment\r\nv 1 2 3", Format::Obj),
            (b"o name\n  v  1 2 3", Format::Obj),
            (b"999\r\nby hand\r\n  0\r\nSECTION\r\n", Format::Dxf),
            (b"AutoCAD Binary DXF\r\n\x1a\0\0", Format::Dxf),
            (b"\xef\xbb\xbf { \"nodes\": [] }", Format::Truss),
            (b"{\"supports\": [{}], \"bars\": 0}", Format::Truss),
            (b"{\"supports\": [{}], \"bars\"", Format::Polygons),
            (
                b"{\"name\": {\"nodes\": 1}, \"rings\": []}",
                Format::Polygons,
            ),
            (b" [[0, 0]", Format::Polygons),
            (b"{\"bbox\": [1], \"type\": \"Feature\"}", Format::Polygons),
        ];
        for (bytes, format) in cases {
            assert_eq!(sniff(bytes), Ok(format));
        }
    }

    #[test]
    fn other_content_is_refused_in_words() {
        let words = |bytes: &[u8]| sniff(bytes).expect_err("not readable").to_string();
        assert!(words(b"\x1f\x8b\x08rest").contains("SVGZ"));
        assert!(words(b"GIF89a").contains("save it as PNG"));
        assert!(words(b"\xff\xfe<\0s\0v\0g\0").contains("UTF-8"));
        assert!(words(b"<html><body/></html>").contains("<svg>"));
        assert!(words(b"BM, a word that is no picture").contains("no known format"));
        assert!(words(b"{\"a\": 1}").contains("GeoJSON"));
        assert!(words(b"   ").contains("no known format"));
    }
}
