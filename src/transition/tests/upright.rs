//! Designs stay upright where that costs little, and turn where they are the
//! same thing turned.

use super::*;
use crate::design::import_file;
use std::path::Path;

/// How far the one is turned on its way to the other, in degrees.
fn turned(source: &str, target: &str) -> f64 {
    let letter = |text: &str| {
        let path = Path::new(text);
        Arc::new(import_file(path, &ImportOptions::default()).unwrap())
    };
    let spec = TransitionSpec::new(letter(source), letter(target));
    let transition = Transition::build(&spec, &Silent).unwrap();
    transition.arap().unwrap().rotation().to_degrees().abs()
}

#[test]
fn letters_stay_upright() {
    for (source, target) in [("O", "c"), ("F", "r"), ("K", "p")] {
        let turned = turned(&format!("glyph:{source}"), &format!("glyph:{target}"));
        assert!(turned < 30.0, "{source} to {target}: {turned}°");
    }
}

#[test]
fn what_is_the_same_turned_turns() {
    let turned = turned("glyph:p", "glyph:d");
    assert!((turned - 180.0).abs() < 15.0, "{turned}°");
}
