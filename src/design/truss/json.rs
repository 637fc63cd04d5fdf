//! Layout of truss files: one key per line, and its value on the same line.

use super::parts::TrussParts;
use serde::Serialize;
use serde_json::ser::{Formatter, Serializer};
use std::io::{self, Write};

/// JSON formatter that breaks lines only between the keys of the outermost object.
#[derive(Default)]
struct KeyPerLine {
    depth: usize,
}

impl KeyPerLine {
    /// Writes the comma before an item, unless it is the first one.
    fn separate<W: Write + ?Sized>(&self, to: &mut W, is_first: bool) -> io::Result<()> {
        match (self.depth, is_first) {
            (1, true) => to.write_all(b"\n  "),
            (1, false) => to.write_all(b",\n  "),
            (_, true) => Ok(()),
            (_, false) => to.write_all(b", "),
        }
    }
}

impl Formatter for KeyPerLine {
    fn begin_object<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.depth += 1;
        to.write_all(b"{")
    }

    fn end_object<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.depth -= 1;
        if self.depth == 0 {
            to.write_all(b"\n")?;
        }
        to.write_all(b"}")
    }

    fn begin_object_key<W: Write + ?Sized>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.separate(to, first)
    }

    fn begin_object_value<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        to.write_all(b": ")
    }

    fn begin_array<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.depth += 1;
        to.write_all(b"[")
    }

    fn end_array<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.depth -= 1;
        to.write_all(b"]")
    }

    fn begin_array_value<W: Write + ?Sized>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.separate(to, first)
    }
}

/// Returns the text of a truss file.
pub(super) fn text(parts: &TrussParts) -> String {
    let mut bytes = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut bytes, KeyPerLine::default());
    let written = parts.serialize(&mut serializer);
    // Writing to memory fails only for maps whose keys are not strings.
    debug_assert!(written.is_ok());
    bytes.push(b'\n');
    String::from_utf8(bytes).unwrap_or_default()
}
