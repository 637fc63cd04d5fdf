//! Tests that designs stay upright if that hardly worsens the match, and rotate if one is a rotated
//! copy of the other.

use super::*;
use crate::design::import_file;
use std::path::Path;

/// Returns the rotation from one design to the other, in degrees.
fn rotation_degrees(source: &str, target: &str) -> f64 {
    let letter = |text: &str| {
        let path = Path::new(text);
        Arc::new(import_file(path, &ImportOptions::default()).unwrap())
    };
    let spec = TransitionSpec::new(letter(source), letter(target));
    let transition = Transition::build(&spec, &Silent).unwrap();
    transition.arap().unwrap().rotation().to_degrees().abs()
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn letters_stay_upright() {
    for (source, target) in [("O", "c"), ("F", "r"), ("K", "p")] {
        let rotation_degrees =
            rotation_degrees(&format!("glyph:{source}"), &format!("glyph:{target}"));
        assert!(
            rotation_degrees < 30.0,
            "{source} to {target}: {rotation_degrees}°"
        );
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn rotated_copies_turn() {
    let rotation_degrees = rotation_degrees("glyph:p", "glyph:d");
    assert!(
        (rotation_degrees - 180.0).abs() < 15.0,
        "{rotation_degrees}°"
    );
}
