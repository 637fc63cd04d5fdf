//! Fuzzes matches that are stored in projects: whatever they contain, the motion is that of the designs.
#![no_main]

#[path = "../../tests/fuzzed/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod fuzzed;
#[path = "../../tests/random/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod random;

libfuzzer_sys::fuzz_target!(|changes: Vec<(u32, u8)>| fuzzed::check_cached_match(&changes));
