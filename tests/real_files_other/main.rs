//! Tests with files of the kinds that people reported problems with, other than SVG: drawings of CAD
//! programs, pictures, maps, meshes, trusses, and the films made of them. All geometry is made
//! here; areas are exact to 1 %, counts and colours exactly.

mod drawings;
mod films;
mod fonts;
mod maps_and_meshes;
mod pictures;

use morphospace::design::{Design, ImportOptions, import};
use morphospace::geometry::{DVec2, FillRule, Regions};
use morphospace::transition::{Frame, Transition};

/// Imports a file with default options.
fn imported(bytes: impl AsRef<[u8]>) -> Design {
    import("file", bytes.as_ref(), &ImportOptions::default()).expect("a design")
}

fn outline(design: &Design) -> Regions {
    design.outline(0.02).expect("an outline")
}

/// Number of holes.
fn holes(regions: &Regions) -> usize {
    regions.rings().count() - regions.len()
}

/// Notes of an import as messages.
fn notes(design: &Design) -> Vec<String> {
    design.notes.iter().map(ToString::to_string).collect()
}

/// Asserts that a measure differs from the expected value by at most 1 %.
#[track_caller]
fn assert_close(found: f64, expected: f64) {
    assert!(
        (found / expected - 1.0).abs() < 0.01,
        "{found}, expected {expected}"
    );
}

/// Transition of two designs with default options.
fn transition(source: &Design, target: &Design) -> Transition {
    Transition::between(source.clone(), target.clone()).expect("a transition")
}

/// Visible area of a frame.
fn frame_regions(frame: &Frame) -> Regions {
    Regions::from_rings(&frame.figure().rings, FillRule::NonZero).expect("an area")
}

/// Signed area of a polygon.
fn signed_area(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    0.5 * ring
        .iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
}
