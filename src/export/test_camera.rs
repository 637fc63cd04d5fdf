//! Camera on a small transition for the export tests: a triangle that rotates and grows.

use std::sync::Arc;

use crate::colour::Rgb;
use crate::design::{ImportOptions, import};
use crate::transition::{Transition, TransitionSpec, TransitionStyle};
use crate::work::progress::Silent;

use super::{Camera, PixelSize, PlaneView, framing};

/// Returns a camera on a small transition, with images of the given size.
pub(super) fn camera(width: u32, height: u32, ground: Option<Rgb>) -> Camera {
    let transition = turning_triangle();
    let size = PixelSize::new(width, height).expect("a legal size");
    let view = PlaneView::fit(framing(&transition, &[0.0, 0.5, 1.0]), size);
    Camera {
        sequence: transition.into(),
        style: TransitionStyle::default(),
        view,
        ground,
        captions: None,
    }
}

/// Transition between two triangles, read from OBJ text.
fn turning_triangle() -> Transition {
    let read = |vertices: &str| {
        let obj = format!("{vertices}f 1 2 3\n");
        let design = import("triangle", obj.as_bytes(), &ImportOptions::default());
        Arc::new(design.expect("a mesh"))
    };
    let source = read("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let target = read("v 1 1 0\nv 0 3 0\nv 0 0 0\n");
    Transition::build(&TransitionSpec::new(source, target), &Silent).expect("a transition")
}
