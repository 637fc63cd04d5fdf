//! Two lists of points in, five SVGs out: the core alone, without a window.
//!
//! `cargo run --release --no-default-features --example polygons_to_svg [FOLDER]`

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use morphospace::design::Design;
use morphospace::export::{Camera, PixelSize, View, even_times, framing, to_svg};
use morphospace::progress::Silent;
use morphospace::transition::{Style, Transition, TransitionSpec};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1);
    write_svgs(&folder.map_or_else(PathBuf::new, PathBuf::from))
}

/// Writes `between-0.svg` to `between-4.svg` into a folder.
pub fn write_svgs(folder: &Path) -> Result<(), Box<dyn Error>> {
    let kite = [[0.0, -3.0], [2.0, 0.0], [0.0, 1.0], [-2.0, 0.0]];
    let house = [
        [-2.0, -2.0],
        [2.0, -2.0],
        [2.0, 1.0],
        [0.0, 3.0],
        [-2.0, 1.0],
    ];
    let source = Arc::new(Design::of_rings("kite", [kite])?);
    let target = Arc::new(Design::of_rings("house", [house])?);
    let transition = Transition::build(&TransitionSpec::new(source, target), &Silent)?;
    let times = even_times(0.0, 1.0, 5);
    let bounds = framing(&transition, &times);
    let camera = Camera {
        transition,
        style: Style::default(),
        view: View::fit(bounds, PixelSize::of_shape(bounds, 480)),
        ground: None,
    };
    for (i, t) in times.into_iter().enumerate() {
        let svg = to_svg(&camera.shoot(t));
        std::fs::write(folder.join(format!("between-{i}.svg")), svg)?;
    }
    Ok(())
}
