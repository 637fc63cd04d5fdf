//! Writes five SVG images of a transition between two polygons; needs only the core library.
//!
//! `cargo run --release --no-default-features --example polygons_to_svg`

use morphospace::{Camera, Design, Error, Transition};

pub(crate) fn main() -> Result<(), Error> {
    let kite = [[2.0, 0.0], [4.0, 3.0], [2.0, 4.0], [0.0, 3.0]];
    let house = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 5.0], [0.0, 3.0]];
    let source = Design::from_rings("kite", [kite])?;
    let target = Design::from_rings("house", [house])?;
    let camera = Camera::around(Transition::between(source, target)?, 480);
    for i in 0..5 {
        let svg = camera.svg(f64::from(i) / 4.0);
        std::fs::write(format!("between-{i}.svg"), svg)?;
    }
    Ok(())
}
