//! Compares coloured drawings on GPU and CPU: paint layers, strokes, gradients and transparency.

use image::RgbaImage;
use morphospace::content::ContentKind;
use morphospace::design::{ImportOptions, import_file};
use morphospace::export::{Drawing, PixelSize, PlaneView, rasterise};
use morphospace::transition::{Transition, TransitionMethod, TransitionSpec};
use morphospace::warp::WarpKind;
use morphospace::work::progress::Silent;
use std::path::Path;
use std::sync::Arc;

use crate::offscreen::{OffscreenRenderer, RenderedScene};
use crate::pictures::Difference;

/// Maximum difference between the images of GPU and CPU (tolerance: the GPU antialiases edges with
/// only four samples per pixel).
const EDGE_TOLERANCE: Difference = Difference {
    mean: 0.25,
    different_fraction: 0.02,
};

/// Names of the source and target drawing of each compared transition, from `tests/drawings`.
const PAIRS: [(&str, &str); 3] = [
    ("sunset", "poster"),
    ("lighthouse", "badge"),
    ("fish", "sunset"),
];

fn build(names: [&str; 2], cell: TransitionMethod) -> Transition {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/drawings");
    let [source, target] = names.map(|name| {
        let path = folder.join(format!("{name}.svg"));
        Arc::new(import_file(&path, &ImportOptions::default()).expect("a drawing"))
    });
    let mut spec = TransitionSpec::new(source, target);
    spec.method = cell;
    Transition::build(&spec, &Silent).expect("a transition")
}

/// Renders a scene on the GPU and on the CPU.
fn render_both(
    renderer: &mut OffscreenRenderer,
    scene: &RenderedScene,
    t: f64,
) -> (RgbaImage, RgbaImage) {
    let gpu = renderer.render(scene, t).expect("a picture");
    let [width, height] = scene.size;
    let view = PlaneView::fit(scene.view, PixelSize::new(width, height).expect("a size"));
    let frame = scene.transition.frame(t);
    let drawing = Drawing::of_frame(&frame, &scene.style, &view, scene.ground);
    let cpu = rasterise(&drawing);
    renderer.save_image(&format!("{}-gpu", scene.name), t, &gpu);
    renderer.save_image(&format!("{}-cpu", scene.name), t, &cpu);
    (gpu, cpu)
}

pub fn drawings_match(renderer: &mut OffscreenRenderer) {
    for (source, target) in PAIRS {
        compare(
            renderer,
            [source, target],
            (WarpKind::Arap, ContentKind::Solid),
        );
    }
}

/// Compares blends of one distance field per paint layer: without a warp, and moved by a warp.
pub fn painted_fields_match(renderer: &mut OffscreenRenderer) {
    for warp in [WarpKind::None, WarpKind::Scattered] {
        compare(renderer, ["sunset", "poster"], (warp, ContentKind::Field));
    }
}

fn compare(
    renderer: &mut OffscreenRenderer,
    [source, target]: [&'static str; 2],
    cell: (WarpKind, ContentKind),
) {
    let of = TransitionMethod::new(cell.0, cell.1).expect("a cell");
    let mut scene = RenderedScene::new(source, build([source, target], of));
    for (t, is_clear) in [
        (0.0, false),
        (0.3, false),
        (0.5, true),
        (0.8, false),
        (1.0, true),
    ] {
        scene.ground = Some(scene.style.ground).filter(|_| !is_clear);
        let (gpu, cpu) = render_both(renderer, &scene, t);
        let name = format!("{source} to {target}, {cell:?}, at {t}");
        Difference::between(&gpu, &cpu).check(&name, EDGE_TOLERANCE);
    }
}
