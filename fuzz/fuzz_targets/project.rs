//! Fuzzes projects with designs of the gallery: any text gives frames or a one-line error.
#![no_main]

#[path = "../../tests/fuzzed/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod fuzzed;
#[path = "../../tests/random/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod random;

libfuzzer_sys::fuzz_target!(|text: &str| fuzzed::check_project(text));
