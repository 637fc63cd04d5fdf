//! Fonts whose letters are drawn with overlapping strokes, as variable fonts have them.

use morphospace::design::{DesignSource, ImportOptions};

use super::{assert_close, holes, outline};

/// Contour of a glyph in units of the em (1000).
type Contour<'a> = &'a [[i16; 2]];

fn words(numbers: impl IntoIterator<Item = i16>) -> Vec<u8> {
    numbers.into_iter().flat_map(i16::to_be_bytes).collect()
}

/// Data of a glyph without instructions, all of whose points are on its outline.
fn glyph(contours: &[Contour]) -> Vec<u8> {
    let points: Vec<[i16; 2]> = contours.concat();
    let (mut ends, mut count) = (Vec::new(), 0);
    for contour in contours {
        count += contour.len() as i16;
        ends.push(count - 1);
    }
    let deltas = |axis: usize| {
        let before = std::iter::once(0).chain(points.iter().map(move |p| p[axis]));
        let steps = points.iter().zip(before.collect::<Vec<_>>());
        words(
            steps
                .map(|(p, before)| p[axis] - before)
                .collect::<Vec<_>>(),
        )
    };
    let mut data = words([contours.len() as i16, -200, -200, 1000, 1000]);
    data.extend(words(ends));
    data.extend(words([0]));
    data.extend(vec![1; points.len()]);
    data.extend(deltas(0));
    data.extend(deltas(1));
    data.resize(data.len().next_multiple_of(4), 0);
    data
}

/// A TrueType font with the given glyphs for the letters from A on.
fn font(letters: &[&[Contour]]) -> Vec<u8> {
    let count = letters.len() as i16 + 1;
    let (mut outlines, mut places) = (Vec::new(), vec![0u32; 2]);
    for letter in letters {
        outlines.extend(glyph(letter));
        places.push(outlines.len() as u32);
    }
    let last = i16::from(b'A') + count - 2;
    let first = i16::from(b'A');
    let cmap = words([0, 1, 3, 1, 0, 12]).into_iter().chain(words([
        4,
        32,
        0,
        4,
        4,
        1,
        0,
        last,
        -1,
        0,
        first,
        -1,
        1 - first,
        1,
        0,
        0,
    ]));
    let head = [
        words([1, 0, 1, 0, 0, 0, 0x5f0f, 0x3cf5, 0, 1000]),
        vec![0; 16],
        words([-200, -200, 1000, 1000, 0, 8, 2, 1, 0]),
    ];
    let hhea = [
        1, 0, 800, -200, 0, 1000, 0, 0, 1000, 1, 0, 0, 0, 0, 0, 0, 0, count,
    ];
    let mut maxp = words([1, 0, count]);
    maxp.resize(32, 0);
    let tables: [(&[u8; 4], Vec<u8>); 7] = [
        (b"cmap", cmap.collect()),
        (b"glyf", outlines),
        (b"head", head.concat()),
        (b"hhea", words(hhea)),
        (b"hmtx", words((0..count).flat_map(|_| [1000, 0]))),
        (
            b"loca",
            places.into_iter().flat_map(u32::to_be_bytes).collect(),
        ),
        (b"maxp", maxp),
    ];
    font_file(&tables)
}

/// A font file with the given tables.
fn font_file(tables: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut file = words([1, 0, tables.len() as i16, 64, 2, 48]);
    let mut place = file.len() + 16 * tables.len();
    for (tag, data) in tables {
        file.extend(*tag);
        for number in [0, place, data.len()] {
            file.extend((number as u32).to_be_bytes());
        }
        place += data.len().next_multiple_of(4);
    }
    for (_, data) in tables {
        file.extend(data);
        file.resize(file.len().next_multiple_of(4), 0);
    }
    file
}

/// Corners of a rectangle, clockwise or, as a counter, counter-clockwise.
fn rectangle([left, bottom, right, top]: [i16; 4], is_counter: bool) -> [[i16; 2]; 4] {
    let corners = [[left, bottom], [left, top], [right, top], [right, bottom]];
    match is_counter {
        true => [corners[3], corners[2], corners[1], corners[0]],
        false => corners,
    }
}

#[test]
fn overlapping_strokes_of_letters_are_filled_once() {
    let upright = rectangle([190, -200, 310, 300], false);
    let across = rectangle([0, 0, 500, 120], false);
    let frame = rectangle([0, 0, 400, 400], false);
    let counter = rectangle([100, 100, 300, 300], true);
    let bar = rectangle([-100, 150, 500, 250], false);
    let font = font(&[&[&upright, &across], &[&frame, &counter, &bar]]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("strokes.ttf");
    std::fs::write(&file, font).expect("written");
    let letter = |letter: char| {
        let path = format!("glyph:{letter}@{}", file.display());
        let source = DesignSource::from_path(path.as_ref());
        outline(&source.import(&ImportOptions::default()).expect("a letter"))
    };
    let cross = letter('A');
    assert_eq!((cross.len(), holes(&cross)), (1, 0));
    assert_close(cross.area(), 60_000.0 + 60_000.0 - 14_400.0);
    let barred = letter('B');
    assert_eq!((barred.len(), holes(&barred)), (1, 2));
    assert_close(barred.area(), 120_000.0 + 20_000.0 + 20_000.0);
}
