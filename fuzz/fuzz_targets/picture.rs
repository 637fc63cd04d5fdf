//! Fuzzes the import of bitmap images: any bytes give a design or a one-line error.
#![no_main]

#[path = "../../tests/fuzzed/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod fuzzed;
#[path = "../../tests/random/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other targets use the rest")]
mod random;

use morphospace::design::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    fuzzed::check_import(bytes, |format| matches!(format, Format::Picture(_)));
});
