//! Recognises the format of a file by its content. It ignores the file name, so a file with the
//! wrong extension is still imported.

use super::format::Format;
use image::ImageFormat;
use serde::de::IgnoredAny;
use std::collections::HashMap;

/// Error for content that no importer supports.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UnknownFormat {
    /// The format is well known but not supported.
    #[error("this is {found}; {way_out}")]
    Other {
        /// Name of the format.
        found: &'static str,
        /// Advice for the user.
        way_out: &'static str,
    },
    /// The content is XML without an `<svg>` element.
    #[error("this is XML without an <svg> element; save the drawing as SVG")]
    XmlWithoutSvg,
    /// The content is a JSON object that is neither polygons nor a truss.
    #[error(
        "this JSON is not a design; it needs \"nodes\" and \"bars\" for a truss, \"rings\" or \"polygons\" for outlines, or a GeoJSON \"type\""
    )]
    Json,
    /// The content was not recognised.
    #[error("the file format is not supported; use {}", Format::or_list_of_names(&Format::ALL))]
    Unknown,
}

/// Common unsupported formats: first bytes, name and advice for the user.
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
const UNPACK: &str = "unpack it and open the file inside";
const UTF8: &str = "save it as UTF-8";

/// Recognises the format of a file from its bytes.
///
/// # Errors
/// Returns an [`UnknownFormat`] that names the format, if it is well known, and advises the user.
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

/// Returns the picture format, if it is one that is imported.
fn picture(bytes: &[u8]) -> Option<ImageFormat> {
    let guessed = image::guess_format(bytes).ok()?;
    let is_supported = Format::PICTURES.contains(&Format::Picture(guessed));
    let is_picture = is_supported && (guessed != ImageFormat::Bmp || is_bmp(bytes));
    is_picture.then_some(guessed)
}

/// Returns whether bytes that begin with `BM` are a BMP file and not text: the size of its second
/// header must be one of those that BMP defines.
fn is_bmp(bytes: &[u8]) -> bool {
    let header_size = bytes.get(14..18).and_then(|b| b.try_into().ok());
    header_size
        .map(u32::from_le_bytes)
        .is_some_and(|size| matches!(size, 12 | 16 | 40 | 52 | 56 | 64 | 108 | 124))
}

/// Recognises the formats that are text: SVG, JSON, DXF and OBJ.
fn text_format(bytes: &[u8]) -> Result<Format, UnknownFormat> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match bytes.trim_ascii_start().first() {
        Some(b'<') if has_svg_element(bytes) => Ok(Format::Svg),
        Some(b'<') => Err(UnknownFormat::XmlWithoutSvg),
        Some(b'[') => Ok(Format::Polygons),
        Some(b'{') => json_format(bytes),
        Some(_) if is_dxf(bytes) => Ok(Format::Dxf),
        // OBJ is tested last, because many other texts have a line that begins with "v".
        Some(_) if is_obj(bytes) => Ok(Format::Obj),
        _ => Err(UnknownFormat::Unknown),
    }
}

/// Recognises the format of a JSON object by its members.
fn json_format(bytes: &[u8]) -> Result<Format, UnknownFormat> {
    // Skipping values does not recurse, so deep nesting cannot overflow the stack.
    let Ok(members) = serde_json::from_slice::<HashMap<String, IgnoredAny>>(bytes) else {
        // Invalid JSON is left to the polygon importer, which reports the position of the error.
        return Ok(Format::Polygons);
    };
    let has = |names: &[&str]| names.iter().any(|name| members.contains_key(*name));
    // GeoJSON may have additional members, even "nodes"; a truss may not.
    if has(&["type", "rings", "polygons"]) {
        Ok(Format::Polygons)
    } else if has(&["nodes", "bars"]) {
        Ok(Format::Truss)
    } else {
        Err(UnknownFormat::Json)
    }
}

/// Returns whether any tag is named `svg`, with or without a namespace prefix.
fn has_svg_element(bytes: &[u8]) -> bool {
    let is_svg = |tag: &[u8]| {
        let end = tag
            .iter()
            .position(|&b| b.is_ascii_whitespace() || b == b'>' || b == b'/')
            .unwrap_or(tag.len());
        tag[..end].rsplit(|&b| b == b':').next() == Some(b"svg")
    };
    // The text is searched instead of parsed: comments and a DOCTYPE may precede the element, and
    // the SVG importer should report a malformed drawing.
    bytes.split(|&b| b == b'<').skip(1).any(is_svg)
}

/// Returns whether the first pair of lines after comments (group code 999) begins a DXF
/// section.
fn is_dxf(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    loop {
        match (lines.next(), lines.next()) {
            (Some(b"999"), Some(_)) => {}
            (code, name) => return (code, name) == (Some(b"0"), Some(b"SECTION")),
        }
    }
}

/// Returns whether any line defines an OBJ vertex.
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
    fn each_format_is_recognised_by_its_content() {
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
    fn unsupported_content_is_refused_with_advice() {
        let words = |bytes: &[u8]| sniff(bytes).expect_err("not readable").to_string();
        assert!(words(b"\x1f\x8b\x08rest").contains("SVGZ"));
        assert!(words(b"GIF89a").contains("save it as PNG"));
        assert!(words(b"\xff\xfe<\0s\0v\0g\0").contains("UTF-8"));
        assert!(words(b"<html><body/></html>").contains("<svg>"));
        assert!(words(b"BM, a word that is no picture").contains("not supported"));
        assert!(words(b"{\"a\": 1}").contains("GeoJSON"));
        assert!(words(b"   ").contains("not supported"));
    }
}
