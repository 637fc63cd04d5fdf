//! Outlines that turn evenly on their way.

use super::*;
use crate::design::import_file;
use crate::geometry::{count_crossings, max_overshoot, total_turning};
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
        turned.push([t, total_turning(&rings, film.mesh().diameter())]);
        crossings += if step % 32 == 0 {
            0
        } else {
            count_crossings(&rings)
        };
    }
    (max_overshoot(&turned), crossings)
}

#[test]
fn outlines_turn_less_than_faces_alone_have_it_and_cross_no_more() {
    let letter = |text: &str| {
        let path = Path::new(text);
        Arc::new(import_file(path, &ImportOptions::default()).unwrap())
    };
    let mut gained = Vec::new();
    for (source, target) in [("S", "e"), ("N", "z"), ("R", "k")] {
        let [source, target] = [source, target].map(|name| letter(&format!("glyph:{name}")));
        let transition = Transition::build(&TransitionSpec::new(source, target), &Silent).unwrap();
        let film = transition.arap().unwrap();
        // Of the same mesh, with nothing that belongs to outlines.
        let plain = Arap::build(film.mesh(), film.options(), &Silent).unwrap();
        let [film, plain] = [film, &plain].map(seen);
        assert!(film.1 <= plain.1, "{film:?} {plain:?}");
        gained.push(plain.0 - film.0);
    }
    assert!(gained.iter().all(|&by| by > -1e-9), "{gained:?}");
    assert!(gained.iter().sum::<f64>() > 0.05, "{gained:?}");
}
