//! Fuzzes whole transitions between small polygons: repair, match, mesh and frames.
#![no_main]

#[path = "../../tests/random/mod.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod random;

use arbitrary::Unstructured;
use morphospace::geometry::DVec2;
use random::Rings;

/// Maximum number of rings in a design: enough for holes and several pieces (resource limit: a
/// transition takes milliseconds).
const MAX_RINGS: u8 = 4;

/// Maximum number of corners in a ring: enough for crossings (resource limit: a transition takes
/// milliseconds).
const MAX_CORNERS: u8 = 12;

/// Random rings with integer coordinates, so that points coincide, edges overlap and corners are
/// straight.
fn rings(from: &mut Unstructured<'_>) -> arbitrary::Result<Rings> {
    (0..from.int_in_range(1..=MAX_RINGS)?)
        .map(|_| {
            (0..from.int_in_range(3..=MAX_CORNERS)?)
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
    if let Err(fault) = random::check_transition(source.clone(), target.clone()) {
        panic!("{fault}: {source:?} {target:?}");
    }
});
