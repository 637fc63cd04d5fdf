//! Small fonts whose letter would take practically forever to draw.

/// Puts 16-bit numbers into bytes, highest byte first.
fn words(numbers: &[i32]) -> Vec<u8> {
    let bytes = |&number: &i32| (number as u16).to_be_bytes();
    numbers.iter().flat_map(bytes).collect()
}

/// Font with the glyphs 0 (missing letter) and 1 (letter A), and others without a letter.
fn font(glyphs: i32, outlines: Vec<(&[u8; 4], Vec<u8>)>) -> Vec<u8> {
    let head = [
        1, 0, 1, 0, 0, 0, 0x5f0f, 0x3cf5, 0, 1000, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 900, 900, 0, 8, 2,
        0, 0,
    ];
    let hhea = [
        1, 0, 800, -200, 0, 600, 0, 0, 600, 0, 0, 0, 0, 0, 0, 0, 0, 1,
    ];
    let maxp = [1, 0, glyphs, 9, 9, 9, 9, 2, 0, 0, 0, 0, 0, 0, 9, 9];
    let segments = [65, 0xffff, 0, 65, 0xffff, 1 - 65, 1, 0, 0];
    let cmap = [&[0, 1, 3, 1, 0, 12, 4, 32, 0, 4, 4, 1, 0][..], &segments].concat();
    let hmtx = [&[600, 0][..], &vec![0; glyphs as usize - 1]].concat();
    let mut tables = vec![
        (b"cmap", words(&cmap)),
        (b"head", words(&head)),
        (b"hhea", words(&hhea)),
        (b"hmtx", words(&hmtx)),
        (b"maxp", words(&maxp)),
    ];
    tables.extend(outlines);
    tables.sort();
    let start = 12 + 16 * tables.len();
    let (mut list, mut content) = (words(&[1, 0, tables.len() as i32, 0, 0, 0]), Vec::new());
    for (tag, mut table) in tables {
        list.extend(*tag);
        for number in [0, start + content.len(), table.len()] {
            list.extend((number as u32).to_be_bytes());
        }
        table.resize(table.len().next_multiple_of(4), 0);
        content.extend(table);
    }
    [list, content].concat()
}

/// Outline of a triangle: bounds, last point, no instructions, three flags, and the differences of
/// the coordinates.
fn triangle() -> Vec<u8> {
    let [head, xs, ys] = [&[1, 0, 0, 9, 9, 2, 0][..], &[0, 9, -9], &[0, 0, 9]].map(words);
    [head, vec![1; 3], xs, ys].concat()
}

/// Font whose letter consists of two copies of a glyph that consists of two copies of another one,
/// and so on.
pub fn nested_components(levels: i32) -> Vec<u8> {
    const BOTH_ARE_WORDS: i32 = 1;
    const ARE_OFFSETS: i32 = 2;
    const HAS_MORE: i32 = 32;
    let mut outlines = vec![triangle()];
    for glyph in 2..=levels {
        let kind = BOTH_ARE_WORDS | ARE_OFFSETS;
        let copies = [kind | HAS_MORE, glyph, 0, 0, kind, glyph, 20, 0];
        outlines.push(words(&[&[-1, 0, 0, 900, 900][..], &copies].concat()));
    }
    outlines.push(triangle());
    let mut places = vec![0];
    for outline in &mut outlines {
        outline.resize(outline.len().next_multiple_of(2), 0);
        places.push(places[places.len() - 1] + outline.len() as i32 / 2);
    }
    let glyphs = outlines.len() as i32;
    font(
        glyphs,
        vec![(b"glyf", outlines.concat()), (b"loca", words(&places))],
    )
}

/// List of byte strings in a CFF table.
fn index(items: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = words(&[items.len() as i32]);
    if !items.is_empty() {
        bytes.push(2);
        let mut place = 1;
        bytes.extend(words(&[place]));
        for item in items {
            place += item.len() as i32;
            bytes.extend(words(&[place]));
        }
    }
    [bytes, items.concat()].concat()
}

/// Font whose letter calls a subroutine that calls the next one `calls` times, and so on.
pub fn nested_subroutines(levels: u8, calls: usize) -> Vec<u8> {
    const CALL: u8 = 10;
    const RETURN: u8 = 11;
    const END: u8 = 14;
    const MOVE: u8 = 21;
    const LINE: u8 = 5;
    // Small integers are stored with an offset of 139, and numbers of subroutines less 107.
    let number = |value: u8| value + 139;
    let call = |subroutine: u8| [139 - 107 + subroutine, CALL];
    let mut subroutines = Vec::new();
    for level in 1..levels {
        subroutines.push([call(level).repeat(calls), vec![RETURN]].concat());
    }
    subroutines.push(vec![number(5), number(5), LINE, RETURN]);
    let letter = [&[number(0), number(0), MOVE][..], &call(0), &[END]].concat();
    let charstrings = index(&[vec![END], letter]);
    let long = |value: usize| [&[29][..], &(value as u32).to_be_bytes()].concat();
    let private = [long(6), vec![19]].concat();
    let top = |start: usize| {
        let after = start + charstrings.len();
        [
            long(start),
            vec![17],
            long(private.len()),
            long(after),
            vec![18],
        ]
        .concat()
    };
    let head = |start: usize| {
        let lists = [
            index(&[b"A".to_vec()]),
            index(&[top(start)]),
            index(&[]),
            index(&[]),
        ];
        [vec![1, 0, 4, 2], lists.concat()].concat()
    };
    let start = head(0).len();
    let table = [
        head(start),
        charstrings.clone(),
        private.clone(),
        index(&subroutines),
    ];
    font(2, vec![(b"CFF ", table.concat())])
}
