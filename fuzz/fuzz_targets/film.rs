//! Two designs of any small rings: repair, match, mesh, frames.
#![no_main]

#[path = "../../tests/random/mod.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod random;

use arbitrary::Unstructured;
use morphospace::geometry::DVec2;
use random::Rings;

/// Enough for crossings, holes and pieces; a film takes milliseconds.
const MOST_RINGS: u8 = 4;
const MOST_CORNERS: u8 = 12;

/// Whole numbers, so that points meet, lines overlap and corners are straight.
fn rings(from: &mut Unstructured<'_>) -> arbitrary::Result<Rings> {
    (0..from.int_in_range(1..=MOST_RINGS)?)
        .map(|_| {
            (0..from.int_in_range(3..=MOST_CORNERS)?)
                .map(|_| {
                    Ok(DVec2::new(
                        from.arbitrary::<i8>()?.into(),
                        from.arbitrary::<i8>()?.into(),
                    ))
                })
                .collect()
        })
        .collect()
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut from = Unstructured::new(bytes);
    let (Ok(source), Ok(target)) = (rings(&mut from), rings(&mut from)) else {
        return;
    };
    if let Err(fault) = random::seen(source.clone(), target.clone()) {
        panic!("{fault}: {source:?} {target:?}");
    }
});
