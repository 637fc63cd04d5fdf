//! Counts the frames of an MP4 from its box structure (ISO/IEC 14496-12), independently of the
//! encoder that wrote it.
//!
//! A count is returned only if the boxes fill the file to its last byte and the sizes of all frames
//! together fit into its media data. Whether the bytes of a frame decode to an image is not checked
//! here.

use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

/// Types of the nested boxes, from the outermost to the sample size box (`stsz`) of a track.
const SAMPLE_SIZE_PATH: [&[u8; 4]; 6] = [b"moov", b"trak", b"mdia", b"minf", b"stbl", b"stsz"];

/// Type of a box and the byte range of its content.
type Mp4Box = ([u8; 4], Range<u64>);

/// Returns the number of frames of the first track.
///
/// # Errors
/// An [`io::Error`] if the file is truncated or lacks a required box.
pub(super) fn frame_count(file: &mut (impl Read + Seek)) -> io::Result<usize> {
    let end = file.seek(SeekFrom::End(0))?;
    let top = boxes(file, 0..end)?;
    let media = top.iter().filter(|(kind, _)| kind == b"mdat");
    let room: u64 = media.map(|(_, range)| range.end - range.start).sum();
    let mut content = 0..end;
    for kind in SAMPLE_SIZE_PATH {
        let inside = boxes(file, content)?;
        content = find_content(&inside, kind)?;
    }
    file.seek(SeekFrom::Start(content.start))?;
    // The sample size box starts with three 32-bit numbers: version and flags, the common size of
    // all frames (0 if their sizes differ), and the number of frames.
    let [_, common, count] = [word(file)?, word(file)?, word(file)?];
    let mut total = u64::from(common) * u64::from(count);
    if common == 0 {
        // Reading stops at the end of the box, even if the box claims more frames.
        let mut sizes = file.take(content.end.saturating_sub(content.start + 12));
        for _ in 0..count {
            total += u64::from(word(&mut sizes)?);
        }
    }
    if total > room {
        let message = format!("its frames need {total} bytes, but it has only {room}");
        return Err(io::Error::other(message));
    }
    Ok(count as usize)
}

/// Lists the boxes in the byte range `within`, which they must fill completely.
fn boxes(file: &mut (impl Read + Seek), within: Range<u64>) -> io::Result<Vec<Mp4Box>> {
    let mut listed = Vec::new();
    let mut start = within.start;
    while start < within.end {
        file.seek(SeekFrom::Start(start))?;
        let (size, mut kind) = (word(file)?, [0; 4]);
        file.read_exact(&mut kind)?;
        let (head, size) = match size {
            // Size 0 means that the box extends to the end of `within`.
            0 => (8, within.end - start),
            // Size 1 means that a 64-bit size follows.
            1 => (16, u64::from(word(file)?) << 32 | u64::from(word(file)?)),
            size => (8, u64::from(size)),
        };
        let end = start.checked_add(size).filter(|end| *end <= within.end);
        let end = end.filter(|_| size >= head).ok_or_else(|| {
            let kind = kind.escape_ascii();
            io::Error::other(format!("its part `{kind}` is cut off"))
        })?;
        listed.push((kind, start + head..end));
        start = end;
    }
    Ok(listed)
}

/// Returns the byte range of the content of the first box of a type.
fn find_content(boxes: &[Mp4Box], kind: &[u8; 4]) -> io::Result<Range<u64>> {
    let first_box = boxes.iter().find(|(name, _)| name == kind);
    let content = first_box.map(|(_, content)| content.clone());
    content.ok_or_else(|| io::Error::other(format!("it has no part `{}`", kind.escape_ascii())))
}

/// Reads a big-endian 32-bit number.
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

    /// Returns an MP4 with frames of the given sizes and `media` bytes of media data.
    fn film(sizes: &[u32], media: usize) -> Vec<u8> {
        let words = [0, 0, sizes.len() as u32].into_iter();
        let words = words.chain(sizes.iter().copied());
        let table: Vec<u8> = words.flat_map(u32::to_be_bytes).collect();
        let inside = SAMPLE_SIZE_PATH
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

    fn count_frames(bytes: &[u8]) -> Result<usize, String> {
        frame_count(&mut Cursor::new(bytes)).map_err(|error| error.to_string())
    }

    #[test]
    fn frames_are_counted_only_in_complete_files() {
        let whole = film(&[5, 3, 4], 12);
        assert_eq!(count_frames(&whole), Ok(3));
        let message = count_frames(&film(&[5, 3, 5], 12)).expect_err("too little");
        assert!(message.contains("13 bytes"), "{message}");
        for length in 1..whole.len() {
            // Also checks lengths at which the file ends exactly at the end of a box.
            assert!(count_frames(&whole[..length]).is_err(), "{length}");
        }
        assert!(count_frames(b"").expect_err("empty").contains("`moov`"));
    }

    #[test]
    fn false_numbers_do_not_panic() {
        let whole = film(&[5, 3, 4], 12);
        for at in 0..whole.len() {
            for value in [0, 1, 2, 255] {
                let mut other = whole.clone();
                other[at] = value;
                // The result does not matter; only a panic would be a failure.
                drop(count_frames(&other));
            }
        }
    }
}
