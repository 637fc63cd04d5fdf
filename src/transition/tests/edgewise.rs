//! Films whose outlines turn as their edges do.

use super::*;
use crate::design::import_file;
use crate::geometry::{count_crossings, turning, turning_excess};
use crate::warp::{Arap, Warp};
use std::path::Path;

/// What outlines turn beyond their ends, and how often they cross, over all steps.
fn seen(film: &Arap) -> (f64, usize) {
    let mut placer = film.placer();
    let loops = film.mesh().boundary_loops();
    let (mut turned, mut crossings) = (Vec::new(), 0);
    for step in 0..=32 {
        let t = f64::from(step) / 32.0;
        placer.place(t);
        let places = &placer.placement().in_frame;
        let ring = |ring: &Vec<u32>| ring.iter().map(|&v| places[v as usize]).collect();
        let rings: Vec<Vec<DVec2>> = loops.iter().map(ring).collect();
        turned.push([t, turning(&rings, film.mesh().diameter())]);
        crossings += if step % 32 == 0 {
            0
        } else {
            count_crossings(&rings)
        };
    }
    (turning_excess(&turned), crossings)
}

#[test]
fn outlines_turn_less_by_it_and_cross_no_more() {
    let letter = |text: &str| {
        let path = Path::new(text);
        Arc::new(import_file(path, &ImportOptions::default()).unwrap())
    };
    let mut gained = 0.0;
    for (source, target) in [("S", "e"), ("N", "z"), ("R", "k")] {
        let [source, target] = [source, target].map(|name| letter(&format!("glyph:{name}")));
        let transition = Transition::build(&TransitionSpec::new(source, target), &Silent).unwrap();
        let film = transition.arap().unwrap();
        let (led, plain) = (seen(film), seen(&film.led(&[])));
        assert!(
            led.0 <= plain.0 + 1e-9 && led.1 <= plain.1,
            "{led:?} {plain:?}"
        );
        gained += plain.0 - led.0;
    }
    assert!(gained > 0.01, "nothing was led: {gained}");
}
