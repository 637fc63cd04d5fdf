//! Tests that the outline terms in the energy of rigid parts keep outlines from bending during the
//! motion.

use super::*;
use crate::design::import_file;
use crate::geometry::{count_crossings, max_overshoot, total_turning};
use crate::warp::{Arap, Warp};
use std::path::Path;

/// Returns the largest excess of the total turning (the sum of the absolute exterior angles of the
/// outlines) above its linear interpolation between t = 0 and t = 1, as a fraction of the
/// interpolated value. Also returns the number of crossings of the outlines, summed over all
/// samples.
fn excess_and_crossings(arap: &Arap) -> (f64, usize) {
    let mut placer = arap.placer();
    let loops = arap.mesh().boundary_loops();
    let (mut turned, mut crossings) = (Vec::new(), 0);
    for step in 0..=32 {
        let t = f64::from(step) / 32.0;
        placer.place(t);
        let places = &placer.placement().in_frame;
        let ring = |ring: &Vec<u32>| ring.iter().map(|&v| places[v as usize]).collect();
        let rings: Vec<Vec<DVec2>> = loops.iter().map(ring).collect();
        turned.push([t, total_turning(&rings, arap.mesh().diameter())]);
        crossings += if step % 32 == 0 {
            0
        } else {
            count_crossings(&rings)
        };
    }
    (max_overshoot(&turned), crossings)
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn outline_terms_reduce_turning_and_add_no_crossings() {
    let letter = |text: &str| {
        let path = Path::new(text);
        Arc::new(import_file(path, &ImportOptions::default()).unwrap())
    };
    let mut gained = Vec::new();
    for (source, target) in [("S", "e"), ("N", "z"), ("R", "k")] {
        let [source, target] = [source, target].map(|name| letter(&format!("glyph:{name}")));
        let transition = Transition::build(&TransitionSpec::new(source, target), &Silent).unwrap();
        let arap = transition.arap().unwrap();
        // `plain` interpolates the same mesh without the terms and constraints for outlines that
        // [`Arap::of_outlines`] adds.
        let plain = Arap::build(arap.mesh(), arap.options(), &Silent).unwrap();
        let [arap, plain] = [arap, &plain].map(excess_and_crossings);
        assert!(arap.1 <= plain.1, "{arap:?} {plain:?}");
        gained.push(plain.0 - arap.0);
    }
    assert!(gained.iter().all(|&by| by > -1e-9), "{gained:?}");
    assert!(gained.iter().sum::<f64>() > 0.05, "{gained:?}");
}
