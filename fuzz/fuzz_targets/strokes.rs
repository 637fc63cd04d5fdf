//! Fuzzes strokes and text on a path: any path data, style and words give a design or a one-line
//! error.
#![no_main]

#[path = "../../tests/fuzzed/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod fuzzed;
#[path = "../../tests/random/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod random;

libfuzzer_sys::fuzz_target!(|input: (&str, &str, &str)| fuzzed::check_strokes(
    input.0, input.1, input.2
));
