//! How many frames an MP4 holds, told from its boxes (ISO/IEC 14496-12) and not
//! by the program that wrote it.
//!
//! Guarantees: boxes fill the file to its last byte, and the sizes of all frames
//! together fit into what the file has of them. That the bytes of a frame make a
//! picture is not seen here.

use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

/// The way from the file to the sizes of a track's frames.
const TO_SIZES: [&[u8; 4]; 6] = [b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsz"];

/// A box's kind, and where its content is.
type Mp4Box = ([u8; 4], Range<u64>);

/// The number of frames of the first track.
///
/// # Errors
/// An [`io::Error`] where the file is cut off, or lacks a box.
pub(super) fn frame_count(file: &mut (impl Read + Seek)) -> io::Result<usize> {
    let end = file.seek(SeekFrom::End(0))?;
    let top = boxes(file, 0..end)?;
    let media = top.iter().filter(|(kind, _)| kind == b"mdat");
    let room: u64 = media.map(|(_, content)| content.end - content.start).sum();
    let mut at = 0..end;
    for kind in TO_SIZES {
        let inside = boxes(file, at)?;
        at = content_of(&inside, kind)?;
    }
    file.seek(SeekFrom::Start(at.start))?;
    // Version and flags, the size of all frames if that is one, and how many.
    let [_, common, count] = [word(file)?, word(file)?, word(file)?];
    let mut total = u64::from(common) * u64::from(count);
    if common == 0 {
        // Not longer than the box, whatever number it says.
        let mut sizes = file.take(at.end.saturating_sub(at.start + 12));
        for _ in 0..count {
            total += u64::from(word(&mut sizes)?);
        }
    }
    if total > room {
        let words = format!("{total} bytes of frames are told of, and {room} are there");
        return Err(io::Error::other(words));
    }
    Ok(count as usize)
}

/// The boxes in a part of the file, which they fill.
fn boxes(file: &mut (impl Read + Seek), within: Range<u64>) -> io::Result<Vec<Mp4Box>> {
    let mut found = Vec::new();
    let mut start = within.start;
    while start < within.end {
        file.seek(SeekFrom::Start(start))?;
        let (size, mut kind) = (word(file)?, [0; 4]);
        file.read_exact(&mut kind)?;
        let (head, size) = match size {
            // To the end.
            0 => (8, within.end - start),
            // Too long for 32 bits.
            1 => (16, u64::from(word(file)?) << 32 | u64::from(word(file)?)),
            size => (8, u64::from(size)),
        };
        let end = start.checked_add(size).filter(|end| *end <= within.end);
        let end = end.filter(|_| size >= head).ok_or_else(|| {
            let kind = kind.escape_ascii();
            io::Error::other(format!("its part `{kind}` is cut off"))
        })?;
        found.push((kind, start + head..end));
        start = end;
    }
    Ok(found)
}

fn content_of(boxes: &[Mp4Box], wanted: &[u8; 4]) -> io::Result<Range<u64>> {
    let found = boxes.iter().find(|(kind, _)| kind == wanted);
    let found = found.map(|(_, content)| content.clone());
    found.ok_or_else(|| io::Error::other(format!("it has no part `{}`", wanted.escape_ascii())))
}

fn word(file: &mut impl Read) -> io::Result<u32> {
    let mut bytes = [0; 4];
    file.read_exact(&mut bytes)?;
    Ok(u32::from_be_bytes(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn boxed(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
        let size = (content.len() as u32 + 8).to_be_bytes();
        [&size, kind, content].concat()
    }

    /// Frames of the given sizes, with `media` bytes of them.
    fn film(sizes: &[u32], media: usize) -> Vec<u8> {
        let words = [0, 0, sizes.len() as u32].into_iter();
        let words = words.chain(sizes.iter().copied());
        let table: Vec<u8> = words.flat_map(u32::to_be_bytes).collect();
        let inside = TO_SIZES
            .iter()
            .rev()
            .fold(table, |inside, kind| boxed(kind, &inside));
        [
            boxed(b"ftyp", b"isom"),
            inside,
            boxed(b"mdat", &vec![7; media]),
        ]
        .concat()
    }

    fn found(bytes: &[u8]) -> Result<usize, String> {
        frame_count(&mut Cursor::new(bytes)).map_err(|error| error.to_string())
    }

    #[test]
    fn frames_are_counted_where_the_file_has_them() {
        let whole = film(&[5, 3, 4], 12);
        assert_eq!(found(&whole), Ok(3));
        let said = found(&film(&[5, 3, 5], 12)).expect_err("too little");
        assert!(said.contains("13 bytes"), "{said}");
        for length in 1..whole.len() {
            // At some lengths the file ends where a box does.
            assert!(found(&whole[..length]).is_err(), "{length}");
        }
        assert!(found(b"").expect_err("empty").contains("`moov`"));
    }

    #[test]
    fn numbers_that_lie_are_no_panic() {
        let whole = film(&[5, 3, 4], 12);
        for at in 0..whole.len() {
            for value in [0, 1, 2, 255] {
                let mut other = whole.clone();
                other[at] = value;
                // A number or an error.
                drop(found(&other));
            }
        }
    }
}
