//! Fuzzes the repair of rings: any coordinates give regions of finite positive area, or an error.
#![no_main]

use morphospace::geometry::{DVec2, FillRule, Regions};

libfuzzer_sys::fuzz_target!(|input: (bool, Vec<Vec<(f64, f64)>>)| {
    let (is_even_odd, rings) = input;
    let rule = if is_even_odd {
        FillRule::EvenOdd
    } else {
        FillRule::NonZero
    };
    let points = |ring: Vec<(f64, f64)>| ring.into_iter().map(DVec2::from).collect();
    let rings: Vec<Vec<DVec2>> = rings.into_iter().map(points).collect();
    if let Ok((regions, _)) = Regions::from_rings_reporting(&rings, rule) {
        assert!(regions.area().is_finite() && regions.area() > 0.0);
        assert!(regions.rings().all(|ring| ring.points().len() >= 3));
    }
});
