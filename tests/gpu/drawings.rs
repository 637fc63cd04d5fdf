//! Drawings in their own colours: layers, lines, gradients and what is seen through.

use image::RgbaImage;
use morphospace::content::ContentKind;
use morphospace::design::{ImportOptions, import_file};
use morphospace::export::{Drawing, PixelSize, PlaneView, rasterise};
use morphospace::transition::{Transition, TransitionMethod, TransitionSpec};
use morphospace::warp::WarpKind;
use morphospace::work::progress::Silent;
use std::path::Path;
use std::sync::Arc;

use crate::pictures::Difference;
use crate::studio::{Scene, Studio};

/// Smooth edges differ: of the card they have four samples a pixel. Reached are 0.14
/// and 0.011.
const EDGES: Difference = Difference {
    mean: 0.25,
    off: 0.02,
};

const PAIRS: [(&str, &str); 3] = [
    ("sunset", "poster"),
    ("lighthouse", "badge"),
    ("fish", "sunset"),
];

fn film(names: [&str; 2], cell: TransitionMethod) -> Transition {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/drawings");
    let [source, target] = names.map(|name| {
        let path = folder.join(format!("{name}.svg"));
        Arc::new(import_file(&path, &ImportOptions::default()).expect("a drawing"))
    });
    let mut spec = TransitionSpec::new(source, target);
    spec.cell = cell;
    Transition::build(&spec, &Silent).expect("a transition")
}

fn both(studio: &mut Studio, scene: &Scene, t: f64) -> (RgbaImage, RgbaImage) {
    let gpu = studio.picture(scene, t).expect("a picture");
    let [width, height] = scene.size;
    let view = PlaneView::fit(scene.view, PixelSize::new(width, height).expect("a size"));
    let frame = scene.transition.frame(t);
    let drawing = Drawing::of_frame(&frame, &scene.style, &view, scene.ground);
    let cpu = rasterise(&drawing);
    studio.keep(&format!("{}-gpu", scene.name), t, &gpu);
    studio.keep(&format!("{}-cpu", scene.name), t, &cpu);
    (gpu, cpu)
}

pub fn drawings_look_the_same_on_both(studio: &mut Studio) {
    for (source, target) in PAIRS {
        compare(
            studio,
            [source, target],
            (WarpKind::Arap, ContentKind::Solid),
        );
    }
}

/// A field for each paint, at rest and carried.
pub fn painted_fields_look_the_same_on_both(studio: &mut Studio) {
    for warp in [WarpKind::None, WarpKind::Scattered] {
        compare(studio, ["sunset", "poster"], (warp, ContentKind::Field));
    }
}

fn compare(
    studio: &mut Studio,
    [source, target]: [&'static str; 2],
    cell: (WarpKind, ContentKind),
) {
    let of = TransitionMethod::new(cell.0, cell.1).expect("a cell");
    let mut scene = Scene::new(source, film([source, target], of));
    for (t, is_clear) in [
        (0.0, false),
        (0.3, false),
        (0.5, true),
        (0.8, false),
        (1.0, true),
    ] {
        scene.ground = Some(scene.style.ground).filter(|_| !is_clear);
        let (gpu, cpu) = both(studio, &scene, t);
        let name = format!("{source} to {target}, {cell:?}, at {t}");
        Difference::between(&gpu, &cpu).check(&name, EDGES);
    }
}
