//! Reads the pairs of group code and value that make up a DXF file, from its text or binary
//! encoding (Autodesk, DXF Reference).
//!
//! Text values are slices of the file, so nothing is copied.

use super::error::{DxfError, EntityFault};
use crate::design::note::DxfPlace;
use crate::geometry::MAX_COORDINATE;

/// Signature with which a binary DXF file begins.
pub(in crate::design) const BINARY: &[u8] = b"AutoCAD Binary DXF\r\n\x1a\0";

/// Value of a pair, as read from the file.
#[derive(Clone, Copy, Debug)]
enum GroupValue<'a> {
    /// Text, or a number in text form.
    Text(&'a [u8]),
    /// Number from a binary file.
    Number(f64),
}

/// Group code with its value.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroupPair<'a> {
    /// Group code, which says what the value means.
    pub code: i32,
    /// Position of the pair in the file.
    pub at: DxfPlace,
    value: GroupValue<'a>,
}

impl<'a> GroupPair<'a> {
    /// Returns the value as text; empty for a binary number.
    pub fn text(&self) -> &'a [u8] {
        match self.value {
            GroupValue::Text(text) => text,
            GroupValue::Number(_) => b"",
        }
    }

    /// Returns the value as a real number.
    pub fn real(&self) -> Result<f64, EntityFault> {
        let number = match self.value {
            GroupValue::Number(number) => Some(number),
            GroupValue::Text(text) => std::str::from_utf8(text).ok().and_then(|t| t.parse().ok()),
        };
        // The limit also applies to angles and spline knots, so that all arithmetic stays finite.
        // The comparison also rejects NaN.
        let number = number.filter(|n: &f64| n.abs() <= MAX_COORDINATE);
        number.ok_or(EntityFault {
            at: Some(self.at),
            reason: "a value is not a number from -1e18 to 1e18",
        })
    }

    /// Returns the value as a handle, which is a hexadecimal number.
    pub fn handle(&self) -> Option<u64> {
        let text = std::str::from_utf8(self.text()).ok()?;
        u64::from_str_radix(text, 16).ok()
    }

    /// Returns the value as an integer; a fraction is truncated.
    pub fn integer(&self) -> Result<i64, EntityFault> {
        Ok(self.real()? as i64)
    }
}

/// Reader of the pairs (group code and value) of a DXF file, one after the other.
pub(super) struct PairReader<'a> {
    bytes: &'a [u8],
    /// Byte offset of the next unread byte.
    position: usize,
    /// Number of lines read so far; 0 in a binary file.
    line: usize,
    form: DxfEncoding,
}

/// Encoding of a DXF file.
#[derive(Clone, Copy, PartialEq)]
enum DxfEncoding {
    /// Text: two lines per pair, the group code and the value.
    Text,
    /// Binary, up to release 12: a group code below 255 takes one byte, any other three bytes.
    Narrow,
    /// Binary, after release 12: a group code takes two bytes.
    Wide,
}

impl<'a> PairReader<'a> {
    /// Creates a reader: detects the encoding and skips the signature of a binary file.
    pub fn of(bytes: &'a [u8]) -> Self {
        let content = bytes.strip_prefix(BINARY);
        let form = match content {
            None => DxfEncoding::Text,
            // The first group code is 0. It takes two zero bytes in the wide encoding; in the
            // narrow one it is one zero byte, followed by the text "SECTION".
            Some([0, 0, ..]) => DxfEncoding::Wide,
            Some(_) => DxfEncoding::Narrow,
        };
        let start = bytes.len() - content.map_or(bytes.len(), <[u8]>::len);
        Self {
            bytes,
            position: start,
            line: 0,
            form,
        }
    }

    /// Returns the next pair, or `None` at the end of the file.
    pub fn next(&mut self) -> Result<Option<GroupPair<'a>>, DxfError> {
        if self.form == DxfEncoding::Text {
            return self.next_text();
        }
        if self.position >= self.bytes.len() {
            return Ok(None);
        }
        let at = self.place();
        let code = self.binary_code()?;
        let value = self.binary_value(code)?;
        Ok(Some(GroupPair { code, at, value }))
    }

    /// Returns the position of the next unread line or byte.
    pub fn place(&self) -> DxfPlace {
        match self.form {
            DxfEncoding::Text => DxfPlace::Line(self.line + 1),
            _ => DxfPlace::Byte(self.position),
        }
    }

    /// Reads a pair of a text file.
    fn next_text(&mut self) -> Result<Option<GroupPair<'a>>, DxfError> {
        let at = self.place();
        let Some(code) = self.line() else {
            return Ok(None);
        };
        // Empty lines at the end of the file are not an incomplete pair.
        if code.is_empty() && self.bytes[self.position..].trim_ascii().is_empty() {
            return Ok(None);
        }
        let code = std::str::from_utf8(code).ok().and_then(|t| t.parse().ok());
        let code = code.ok_or(DxfError::Code(at))?;
        let at = self.place();
        let value = self.line().ok_or(DxfError::Truncated(at))?;
        let value = GroupValue::Text(value);
        Ok(Some(GroupPair { code, at, value }))
    }

    /// Returns the next line without surrounding white space.
    fn line(&mut self) -> Option<&'a [u8]> {
        let rest = &self.bytes[self.position..];
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.position += (end + 1).min(rest.len());
        self.line += 1;
        Some(rest[..end].trim_ascii())
    }

    /// Reads a group code of a binary file.
    fn binary_code(&mut self) -> Result<i32, DxfError> {
        // The byte 255 announces a code in the next two bytes.
        if self.form == DxfEncoding::Narrow {
            let [code] = self.take()?;
            if code != 255 {
                return Ok(code.into());
            }
        }
        Ok(i16::from_le_bytes(self.take()?).into())
    }

    /// Reads a value of a binary file. The group code determines its type.
    fn binary_value(&mut self, code: i32) -> Result<GroupValue<'a>, DxfError> {
        Ok(match code {
            10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => {
                GroupValue::Number(f64::from_le_bytes(self.take()?))
            }
            60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => {
                GroupValue::Number(i16::from_le_bytes(self.take()?).into())
            }
            90..=99 | 420..=429 | 440..=459 | 1071 => {
                GroupValue::Number(i32::from_le_bytes(self.take()?).into())
            }
            160..=169 => GroupValue::Number(i64::from_le_bytes(self.take()?) as f64),
            290..=299 => GroupValue::Number(self.take::<1>()?[0].into()),
            310..=319 | 1004 => {
                let [length] = self.take()?;
                GroupValue::Text(self.slice(length.into())?)
            }
            0..=9
            | 100..=109
            | 300..=309
            | 320..=369
            | 390..=399
            | 410..=419
            | 430..=439
            | 470..=481
            | 999..=1009 => GroupValue::Text(self.string()?),
            _ => return Err(DxfError::Code(self.place())),
        })
    }

    /// Reads text up to the next zero byte.
    fn string(&mut self) -> Result<&'a [u8], DxfError> {
        let at = self.place();
        let rest = &self.bytes[self.position..];
        let end = rest.iter().position(|&b| b == 0);
        let text = self.slice(end.ok_or(DxfError::Truncated(at))?)?;
        self.position += 1;
        Ok(text.trim_ascii())
    }

    /// Reads the next `N` bytes of a binary file.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], DxfError> {
        let at = self.place();
        let bytes = self.slice(N)?;
        bytes.try_into().map_err(|_| DxfError::Truncated(at))
    }

    /// Reads the given number of bytes without copying them.
    fn slice(&mut self, length: usize) -> Result<&'a [u8], DxfError> {
        let at = self.place();
        let slice = self.bytes.get(self.position..self.position + length);
        self.position += length;
        slice.ok_or(DxfError::Truncated(at))
    }
}
