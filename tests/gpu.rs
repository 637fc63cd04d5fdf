//! Compares images of the stage, rendered on the GPU, with images that the exporters render on the
//! CPU, and recordings played on the GPU with solved frames.
//!
//! The tests need a graphics adapter (a software one suffices), but no window. Without an adapter
//! each test counts as ignored and the reason is printed; with `MORPHOSPACE_REQUIRE_GPU=1` a
//! missing adapter is a failure. `MORPHOSPACE_PICTURES=DIR` saves all compared images to `DIR`.

#[path = "gpu/drawings.rs"]
mod drawings;
#[path = "gpu/gpu_playback.rs"]
mod gpu_playback;
#[path = "gpu/offscreen.rs"]
mod offscreen;
#[path = "gpu/pictures.rs"]
mod pictures;
#[path = "gpu/runner.rs"]
mod runner;
#[path = "gpu/transitions.rs"]
mod transitions;

use std::process::ExitCode;

use image::RgbaImage;
use morphospace::colour::Rgb;
use morphospace::content::Content;
use morphospace::export::{Drawing, PixelSize, PlaneView, rasterise};
use morphospace::geometry::{Bounds, DVec2};
use morphospace::stage::StageVisibility;

use offscreen::{OffscreenRenderer, RenderedScene};
use transitions::{field, from_gallery, perforated, solid, truss};

/// Difference of a colour channel, on a scale of 0 to 255, above which a pixel counts as different
/// (tolerance: antialiasing differs between GPU and CPU).
const CHANNEL_TOLERANCE: u8 = 64;

/// Maximum fraction of pixels that may differ between the images of GPU and CPU (tolerance:
/// antialiasing differs).
const MAX_DIFFERENT_FRACTION: f64 = 0.005;

/// Name and function of a test.
type GpuTest = (&'static str, fn(&mut OffscreenRenderer));

/// All tests of this file and its modules, in the order in which they run.
const TESTS: &[GpuTest] = &[
    ("meshes_match", meshes_match),
    ("vanishing_holes_match", vanishing_holes_match),
    ("trusses_match", trusses_match),
    ("fields_match", fields_match),
    ("carried_fields_match", carried_fields_match),
    ("pictures_match", pictures::pictures_match),
    (
        "transparent_pictures_match",
        pictures::transparent_pictures_match,
    ),
    ("zoomed_pictures_match", pictures::zoomed_pictures_match),
    ("drawings_match", drawings::drawings_match),
    ("painted_fields_match", drawings::painted_fields_match),
    (
        "a_transparent_background_has_straight_alpha",
        a_transparent_background_has_straight_alpha,
    ),
    (
        "contours_are_exact_and_antialiased_at_any_zoom",
        contours_are_exact_and_antialiased_at_any_zoom,
    ),
    (
        "designs_far_from_the_origin_match",
        designs_far_from_the_origin_match,
    ),
    (
        "valid_sizes_are_drawn_and_others_refused",
        valid_sizes_are_drawn_and_others_refused,
    ),
    ("overlays_change_the_image", overlays_change_the_image),
    (
        "gpu_playback_matches_solved_frames",
        gpu_playback::gpu_playback_matches_solved_frames,
    ),
    (
        "gpu_playback_of_wireframes_matches_solved_frames",
        gpu_playback::gpu_playback_of_wireframes_matches_solved_frames,
    ),
    (
        "gpu_playback_writes_no_meshes",
        gpu_playback::gpu_playback_writes_no_meshes,
    ),
    (
        "replacing_a_transition_leaves_no_empty_frame",
        gpu_playback::replacing_a_transition_leaves_no_empty_frame,
    ),
    (
        "recordings_are_released_with_their_transitions",
        gpu_playback::recordings_are_released_with_their_transitions,
    ),
    (
        "without_storage_buffers_the_cpu_plays",
        gpu_playback::without_storage_buffers_the_cpu_plays,
    ),
];

impl OffscreenRenderer {
    /// Renders a scene on the GPU and on the CPU, asserts that the two images agree, and returns
    /// them in this order.
    pub fn compare(&mut self, scene: &RenderedScene, t: f64) -> (RgbaImage, RgbaImage) {
        let gpu = self.render(scene, t).expect("a picture");
        let size = PixelSize::new(scene.size[0], scene.size[1]).expect("a size");
        let view = PlaneView::fit(scene.view, size);
        let frame = scene.transition.frame(t);
        let cpu = rasterise(&Drawing::of_frame(
            &frame,
            &scene.style,
            &view,
            scene.ground,
        ));
        self.save_image(&format!("{}-gpu", scene.name), t, &gpu);
        self.save_image(&format!("{}-cpu", scene.name), t, &cpu);
        let name = format!("{} at {t}", scene.name);
        assert_images_match(&name, scene, t, &gpu, &cpu);
        (gpu, cpu)
    }
}

fn meshes_match(renderer: &mut OffscreenRenderer) {
    let scene = RenderedScene::new("mesh", solid(0.0));
    for t in [-0.25, 0.0, 0.35, 1.0] {
        renderer.compare(&scene, t);
    }
}

fn vanishing_holes_match(renderer: &mut OffscreenRenderer) {
    let scene = RenderedScene::new("perforated", perforated());
    for t in [0.0, 0.4, 0.9, 1.0] {
        renderer.compare(&scene, t);
    }
}

fn trusses_match(renderer: &mut OffscreenRenderer) {
    let mut scene = RenderedScene::new("truss", truss());
    for joints in [true, false] {
        scene.style.joints = joints;
        for t in [0.0, 0.6] {
            renderer.compare(&scene, t);
        }
    }
}

fn fields_match(renderer: &mut OffscreenRenderer) {
    for (name, transition) in field() {
        let scene = RenderedScene::new(name, transition);
        for t in [0.0, 0.3, 0.5, 1.0, 1.2] {
            renderer.compare(&scene, t);
        }
    }
}

/// Compares distance fields that are moved by a warp: by rigid parts, scattered points, a lattice
/// or lines.
fn carried_fields_match(renderer: &mut OffscreenRenderer) {
    for name in [
        "letters-carried",
        "letters-points",
        "letters-lattice",
        "cantilevers-carried",
        "cantilevers-lines",
    ] {
        let mut scene = RenderedScene::new(name, from_gallery(name));
        // The exporter samples the moved fields on a grid, the stage samples them at each pixel.
        // Where the warp folds, spikes thinner than a grid cell appear only on the stage.
        scene.max_misplaced_pixels = 4;
        for t in [0.0, 0.3, 0.5, 1.0] {
            renderer.compare(&scene, t);
        }
    }
}

/// Compares the stage with the sign of the exact field at the centre of each pixel, because the
/// exporter's contours are less precise: straight chords across grid cells.
fn contours_are_exact_and_antialiased_at_any_zoom(renderer: &mut OffscreenRenderer) {
    for (name, transition) in field() {
        let Content::Field(fields) = transition.content().clone() else {
            panic!("{name} is not a field");
        };
        let t = 0.4;
        let pair = fields.first_pair();
        let on_contour = pair.contour(t)[0][0];
        for (zoom, half_width) in [("near", 0.05), ("far", 40.0)] {
            let mut scene = RenderedScene::new(name, transition.clone());
            scene.view = Bounds {
                min: on_contour - half_width,
                max: on_contour + half_width,
            };
            scene.size = [300, 300];
            let picture = renderer.render(&scene, t).expect("a picture");
            renderer.save_image(&format!("{name}-{zoom}"), t, &picture);
            let pixel = 2.0 * half_width / 300.0;
            let is_inside = |(x, y, _): (u32, u32, &image::Rgba<u8>)| {
                let from_corner = DVec2::new(f64::from(x) + 0.5, 299.5 - f64::from(y));
                pair.is_inside(scene.view.min + pixel * from_corner, t)
            };
            let exact: Vec<bool> = picture.enumerate_pixels().map(is_inside).collect();
            let fill = scene.style.fill_at(t);
            let drawn = mask(&picture, fill, scene.ground);
            assert_eq!(misplaced_pixels(&exact, &drawn, 300), 0, "{name} {zoom}");
            let ground = scene.style.ground.0;
            let is_soft = |p: &&image::Rgba<u8>| ![fill.0, ground].contains(&[p[0], p[1], p[2]]);
            let soft = picture.pixels().filter(is_soft).count();
            assert!(
                (20..4000).contains(&soft),
                "{name} {zoom}: {soft} antialiased pixels"
            );
        }
    }
}

fn designs_far_from_the_origin_match(renderer: &mut OffscreenRenderer) {
    let scene = RenderedScene::new("far", solid(1e8));
    renderer.compare(&scene, 0.35);
}

fn a_transparent_background_has_straight_alpha(renderer: &mut OffscreenRenderer) {
    let mut scene = RenderedScene::new("transparent", truss());
    scene.ground = None;
    let (gpu, cpu) = renderer.compare(&scene, 0.5);
    assert!(gpu.pixels().any(|p| p[3] == 0) && gpu.pixels().any(|p| p[3] == 255));
    // Alpha is not premultiplied, so edge pixels that are half covered have the colour of the bars.
    let fill = scene.style.fill_at(0.5).0;
    for (picture, name) in [(&gpu, "gpu"), (&cpu, "cpu")] {
        let mut edges = 0;
        for p in picture.pixels().filter(|p| (100..200).contains(&p[3])) {
            let difference = (0..3).map(|k| p[k].abs_diff(fill[k])).max();
            edges += 1;
            assert!(
                difference <= Some(6),
                "{name}: {p:?} at an edge of {fill:?}"
            );
        }
        assert!(edges > 100, "{name}: {edges} edge pixels");
    }
}

fn valid_sizes_are_drawn_and_others_refused(renderer: &mut OffscreenRenderer) {
    let mut scene = RenderedScene::new("sizes", solid(0.0));
    for size in [[1, 1], [333, 77], [3840, 2160]] {
        scene.size = size;
        let picture = renderer.render(&scene, 0.5).expect("a picture");
        assert_eq!(<[u32; 2]>::from(picture.dimensions()), size);
    }
    for size in [[0, 5], [5, 0], [1 << 20, 5]] {
        scene.size = size;
        let reason = renderer.render(&scene, 0.5).expect_err("an invalid size");
        assert!(reason.contains("choose another size"), "{reason}");
    }
}

fn overlays_change_the_image(renderer: &mut OffscreenRenderer) {
    let fill_only = StageVisibility {
        bars: true,
        ..StageVisibility::default()
    };
    type VisibilitySwitch = fn(&mut StageVisibility);
    let overlays: [(&str, VisibilitySwitch); 4] = [
        ("wireframe", |show| show.wireframe = true),
        ("ghosts", |show| show.ghosts = true),
        ("iso-lines", |show| show.iso_lines = true),
        ("signed", |show| show.signed_colours = true),
    ];
    let (_, blended) = field().swap_remove(0);
    for (name, switch) in overlays {
        let of_field = matches!(name, "iso-lines" | "signed");
        let transition = if of_field {
            blended.clone()
        } else {
            solid(0.0)
        };
        let mut scene = RenderedScene::new(name, transition);
        scene.visibility = fill_only;
        let plain = renderer.render(&scene, 0.4).expect("a picture");
        switch(&mut scene.visibility);
        let with_overlay = renderer.render(&scene, 0.4).expect("a picture");
        let changed = different_fraction(&plain, &with_overlay);
        assert!(changed > 0.01, "{name} changes {changed} of the image");
        renderer.save_image(name, 0.4, &with_overlay);
    }
}

/// Fraction of the pixels of two images in which a channel differs by more than
/// [`CHANNEL_TOLERANCE`]; colours are compared with premultiplied alpha.
fn different_fraction(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let differs = |(p, q): (&image::Rgba<u8>, &image::Rgba<u8>)| {
        let premultiplied = |p: &image::Rgba<u8>, k: usize| u32::from(p[k]) * u32::from(p[3]) / 255;
        (0..3).any(|k| {
            premultiplied(p, k).abs_diff(premultiplied(q, k)) > u32::from(CHANNEL_TOLERANCE)
        }) || p[3].abs_diff(q[3]) > CHANNEL_TOLERANCE
    };
    let count = a
        .pixels()
        .zip(b.pixels())
        .filter(|&pair| differs(pair))
        .count();
    count as f64 / f64::from(a.width() * a.height())
}

/// For each pixel: whether it is closer to the fill colour than to the background colour or, on a
/// transparent background, at least half opaque.
fn mask(picture: &RgbaImage, fill: Rgb, ground: Option<Rgb>) -> Vec<bool> {
    let distance = |p: &image::Rgba<u8>, Rgb(c): Rgb| -> u32 {
        (0..3).map(|k| u32::from(p[k].abs_diff(c[k])).pow(2)).sum()
    };
    let is_fill = |p: &image::Rgba<u8>| match ground {
        Some(ground) => distance(p, fill) < distance(p, ground),
        None => p[3] >= 128,
    };
    picture.pixels().map(is_fill).collect()
}

/// Number of pixels of the mask `b` whose value does not occur in `a` among the 3 × 3 pixels around
/// the same place.
///
/// If it is 0, the boundaries of the two masks are at most one pixel apart.
fn misplaced_pixels(a: &[bool], b: &[bool], width: u32) -> usize {
    let width = width as usize;
    let height = a.len() / width;
    let occurs_nearby = |x: usize, y: usize| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        rows.flat_map(|row| columns.clone().map(move |column| (row, column)))
            .any(|(row, column)| a[row * width + column] == b[y * width + x])
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.filter(|&(x, y)| !occurs_nearby(x, y)).count()
}

/// Asserts that the images of GPU and CPU agree: few pixels differ, and except for
/// [`RenderedScene::max_misplaced_pixels`] the contours are at most one pixel apart.
fn assert_images_match(
    name: &str,
    scene: &RenderedScene,
    t: f64,
    gpu: &RgbaImage,
    cpu: &RgbaImage,
) {
    let (fill, ground) = (scene.style.fill_at(t), scene.ground);
    let fraction = different_fraction(gpu, cpu);
    assert!(
        fraction <= MAX_DIFFERENT_FRACTION,
        "{name}: {fraction} of the pixels differ"
    );
    let masks = [gpu, cpu].map(|picture| mask(picture, fill, ground));
    assert!(masks[1].iter().any(|&m| m), "{name}: an empty image");
    for [a, b] in [[0, 1], [1, 0]] {
        let misplaced = misplaced_pixels(&masks[a], &masks[b], gpu.width());
        assert!(
            misplaced <= scene.max_misplaced_pixels,
            "{name}: {misplaced} pixels more than one pixel off the contour"
        );
    }
}

fn main() -> ExitCode {
    runner::run(TESTS)
}
