//! Tests with mutated inputs, without a fuzzer: fonts, cached matches, projects, and drawings with
//! strokes and text on paths; and inputs that the fuzzer found. The checks are those of the fuzz
//! targets of the same names.
//!
//! `cargo test --release --no-default-features --test fuzzed_inputs -- --include-ignored` tests 50
//! times as many.

#[allow(dead_code, unused_imports, reason = "the fuzzer uses the rest")]
mod fuzzed;
#[allow(dead_code, reason = "other tests use the rest")]
mod random;

use morphospace::project::gallery;
use random::SeededRandom;

/// Factor by which the ignored test checks more inputs of each kind (resource limit: minutes in an
/// optimised build).
const IGNORED_TEST_FACTOR: u64 = 50;

/// Number of bytes at the start in which the tables of a font lie (heuristic).
const HEADER_BYTES: usize = 1000;

/// Changes up to `count` + 1 bytes, half of them among the first [`HEADER_BYTES`], and cuts off the
/// end of one input in eight.
fn mutated(random: &mut SeededRandom, bytes: &[u8], count: usize) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(count) {
        let room = [bytes.len(), bytes.len().min(HEADER_BYTES)][random.below(2)];
        let at = random.below(room);
        bytes[at] = [0, 1, 0x7f, 0xff, random.below(256) as u8][random.below(5)];
    }
    let length = bytes.len();
    if random.below(8) == 0 {
        bytes.truncate(random.below(length));
    }
    bytes
}

fn check_fonts(count: u64) {
    let font = include_bytes!("../assets/fonts/Roboto-Bold.ttf");
    for seed in 0..count {
        fuzzed::check_font(&mutated(&mut SeededRandom::new(seed), font, 12));
    }
}

fn check_matches(count: u64) {
    for seed in 0..count {
        let random = &mut SeededRandom::new(seed);
        let changes: Vec<(u32, u8)> = (0..=random.below(3))
            .map(|_| (random.below(1 << 20) as u32, random.below(256) as u8))
            .collect();
        fuzzed::check_cached_match(&changes);
    }
}

/// Replaces numbers in the text of a project.
fn with_other_numbers(random: &mut SeededRandom, text: &str) -> String {
    let other = [
        "0", "-1", "1e300", "1e-300", "nan", "inf", "99999999", "0.5",
    ];
    let mut changed = String::new();
    for word in text.split_inclusive([' ', '\n', ',']) {
        let is_number = word
            .trim_end_matches([' ', '\n', ','])
            .parse::<f64>()
            .is_ok();
        match is_number && random.below(6) == 0 {
            true => {
                changed += &format!(
                    "{}{}",
                    other[random.below(other.len())],
                    &word[word.len() - 1..]
                )
            }
            false => changed += word,
        }
    }
    changed
}

fn check_projects(count: u64) {
    let names: Vec<String> = gallery::list()
        .expect("a gallery")
        .into_iter()
        .map(|entry| entry.name)
        .collect();
    for seed in 0..count {
        let random = &mut SeededRandom::new(seed);
        let project = gallery::document(&names[random.below(names.len())]).expect("a project");
        let text = project.to_toml().expect("text");
        let mut text = with_other_numbers(random, &text);
        if random.below(3) == 0 {
            text = String::from_utf8_lossy(&mutated(random, text.as_bytes(), 3)).into_owned();
        }
        fuzzed::check_project(&text);
    }
}

/// Random words of a grammar, one after the other.
fn words(random: &mut SeededRandom, of: &[&str], count: usize) -> String {
    let word = |_| of[random.below(of.len())];
    (0..count).map(word).collect::<Vec<_>>().join(" ")
}

fn check_drawings(count: u64) {
    let path = [
        "M", "L", "h", "v", "C", "q", "A", "z", "10", "50", "-3", "0", "1", "1e9", "1e-9", "90",
        "20", "20",
    ];
    let style = [
        "stroke-width:3;",
        "stroke-width:1e-6;",
        "stroke-width:1e6;",
        "stroke-dasharray:1e-4;",
        "stroke-dasharray:5,0,1;",
        "stroke-dashoffset:-1e9;",
        "stroke-linejoin:round;",
        "stroke-linecap:square;",
        "stroke-miterlimit:1e9;",
        "marker-mid:url(#m);",
        "letter-spacing:-9px;",
        "font-size:1e5px;",
        "vector-effect:non-scaling-stroke;",
        "clip-path:circle(9px);",
        "transform:scale(1e-9,1);",
    ];
    for seed in 0..count {
        let random = &mut SeededRandom::new(seed);
        let commands = 2 + random.below(60);
        let data = format!("M 10 50 L 90 20 {}", words(random, &path, commands));
        let declarations = random.below(4);
        let style = words(random, &style, declarations);
        let letters = random.below(20);
        let text = words(
            random,
            &["A", "שלום", "fi", "👩\u{200d}🎨", "\u{202e}"],
            letters,
        );
        fuzzed::check_strokes(&data, &style, &text);
    }
}

#[test]
fn mutated_fonts_give_letters_or_one_line_errors() {
    check_fonts(40);
}

#[test]
fn mutated_matches_give_the_film_of_the_designs() {
    check_matches(10);
}

#[test]
fn mutated_projects_give_frames_or_one_line_errors() {
    check_projects(12);
}

#[test]
fn random_strokes_and_text_on_paths_give_designs_or_one_line_errors() {
    check_drawings(30);
}

/// Inputs that the fuzzer found, few enough that each adds covered code (`-set_cover_merge=1
/// -use_counters=0`).
#[test]
fn inputs_found_by_fuzzing_hold_the_checks() {
    let drawings: Vec<[String; 3]> =
        serde_json::from_str(include_str!("fuzzed/corpus/strokes.json")).expect("drawings");
    for [data, style, words] in &drawings {
        fuzzed::check_strokes(data, style, words);
    }
    let changes: Vec<Vec<(u32, u8)>> =
        serde_json::from_str(include_str!("fuzzed/corpus/cached_match.json")).expect("changes");
    for changes in &changes {
        fuzzed::check_cached_match(changes);
    }
}

#[test]
#[ignore = "50 times as many inputs: minutes even in an optimised build"]
fn many_mutated_inputs_hold_all_checks() {
    check_fonts(40 * IGNORED_TEST_FACTOR);
    check_matches(10 * IGNORED_TEST_FACTOR);
    check_projects(12 * IGNORED_TEST_FACTOR);
    check_drawings(30 * IGNORED_TEST_FACTOR);
}
