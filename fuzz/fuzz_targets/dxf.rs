//! Fuzzes the import of DXF drawings: any bytes give a design or a one-line error.
#![no_main]

mod import_check;

use morphospace::design::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    import_check::check_import(bytes, |format| matches!(format, Format::Dxf));
});
