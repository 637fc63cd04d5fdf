//! Any bytes that are taken for polygons, GeoJSON and trusses: a design or an error in one line.
#![no_main]

mod importing;

use morphospace::design::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    importing::import_if(bytes, |format| {
        matches!(format, Format::Polygons | Format::Truss)
    });
});
