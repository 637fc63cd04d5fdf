//! The stage on a graphics card against the exporters on the processor.
//!
//! A window is not needed, an adapter is (a software one will do). Where there
//! is none, each test is counted as ignored and the reason is printed; with
//! `MORPHOSPACE_REQUIRE_GPU=1` that is a failure. `MORPHOSPACE_PICTURES=DIR`
//! keeps every pair of pictures for looking at.

#[path = "gpu/drawings.rs"]
mod drawings;
#[path = "gpu/films.rs"]
mod films;
#[path = "gpu/pictures.rs"]
mod pictures;
#[path = "gpu/runner.rs"]
mod runner;
#[path = "gpu/scenes.rs"]
mod scenes;
#[path = "gpu/studio.rs"]
mod studio;

use std::process::ExitCode;

use image::RgbaImage;
use morphospace::colour::Rgb;
use morphospace::content::Content;
use morphospace::export::{Drawing, PixelSize, PlaneView, rasterise};
use morphospace::geometry::{Bounds, DVec2};
use morphospace::stage::StageVisibility;

use scenes::{field, of_gallery, perforated, solid, truss};
use studio::{Scene, Studio};

/// What the issue allows: pixels whose channels differ by more than this …
const CHANNEL: u8 = 64;
/// … may be at most this fraction of the picture.
const PIXELS: f64 = 0.005;

type Test = (&'static str, fn(&mut Studio));

const TESTS: &[Test] = &[
    (
        "a_mesh_looks_the_same_on_both",
        a_mesh_looks_the_same_on_both,
    ),
    (
        "holes_that_vanish_look_the_same_on_both",
        holes_that_vanish_look_the_same_on_both,
    ),
    (
        "a_truss_looks_the_same_on_both",
        a_truss_looks_the_same_on_both,
    ),
    ("fields_look_the_same_on_both", fields_look_the_same_on_both),
    (
        "carried_fields_look_the_same_on_both",
        carried_fields_look_the_same_on_both,
    ),
    (
        "pictures_look_the_same_on_both",
        pictures::pictures_look_the_same_on_both,
    ),
    (
        "transparent_pictures_look_the_same_on_both",
        pictures::transparent_pictures_look_the_same_on_both,
    ),
    (
        "pictures_look_the_same_at_any_zoom",
        pictures::pictures_look_the_same_at_any_zoom,
    ),
    (
        "drawings_look_the_same_on_both",
        drawings::drawings_look_the_same_on_both,
    ),
    (
        "painted_fields_look_the_same_on_both",
        drawings::painted_fields_look_the_same_on_both,
    ),
    (
        "a_transparent_ground_has_straight_alpha",
        a_transparent_ground_has_straight_alpha,
    ),
    (
        "contours_are_right_and_smooth_at_any_zoom",
        contours_are_right_and_smooth_at_any_zoom,
    ),
    (
        "far_from_zero_nothing_changes",
        far_from_zero_nothing_changes,
    ),
    (
        "every_size_is_drawn_and_others_are_refused",
        every_size_is_drawn_and_others_are_refused,
    ),
    ("overlays_are_seen", overlays_are_seen),
    (
        "films_are_played_as_they_would_be_solved",
        films::films_are_played_as_they_would_be_solved,
    ),
    (
        "wires_are_played_as_they_would_be_solved",
        films::wires_are_played_as_they_would_be_solved,
    ),
    (
        "what_is_played_is_not_written",
        films::what_is_played_is_not_written,
    ),
    (
        "no_frame_is_empty_where_one_takes_the_place_of_another",
        films::no_frame_is_empty_where_one_takes_the_place_of_another,
    ),
    (
        "films_come_and_go_with_their_transitions",
        films::films_come_and_go_with_their_transitions,
    ),
    (
        "without_buffers_films_are_played_from_memory",
        films::without_buffers_films_are_played_from_memory,
    ),
];

impl Studio {
    /// The scene at `t` from both, held against each other: GPU, CPU.
    pub fn compare(&mut self, scene: &Scene, t: f64) -> (RgbaImage, RgbaImage) {
        let gpu = self.picture(scene, t).expect("a picture");
        let size = PixelSize::new(scene.size[0], scene.size[1]).expect("a size");
        let view = PlaneView::fit(scene.view, size);
        let frame = scene.transition.frame(t);
        let cpu = rasterise(&Drawing::of_frame(
            &frame,
            &scene.style,
            &view,
            scene.ground,
        ));
        self.keep(&format!("{}-gpu", scene.name), t, &gpu);
        self.keep(&format!("{}-cpu", scene.name), t, &cpu);
        let name = format!("{} at {t}", scene.name);
        check(&name, scene, t, &gpu, &cpu);
        (gpu, cpu)
    }
}

fn a_mesh_looks_the_same_on_both(studio: &mut Studio) {
    let scene = Scene::new("mesh", solid(0.0));
    for t in [-0.25, 0.0, 0.35, 1.0] {
        studio.compare(&scene, t);
    }
}

fn holes_that_vanish_look_the_same_on_both(studio: &mut Studio) {
    let scene = Scene::new("perforated", perforated());
    for t in [0.0, 0.4, 0.9, 1.0] {
        studio.compare(&scene, t);
    }
}

fn a_truss_looks_the_same_on_both(studio: &mut Studio) {
    let mut scene = Scene::new("truss", truss());
    for joints in [true, false] {
        scene.style.joints = joints;
        for t in [0.0, 0.6] {
            studio.compare(&scene, t);
        }
    }
}

fn fields_look_the_same_on_both(studio: &mut Studio) {
    for (name, transition) in field() {
        let scene = Scene::new(name, transition);
        for t in [0.0, 0.3, 0.5, 1.0, 1.2] {
            studio.compare(&scene, t);
        }
    }
}

/// By moving parts, scattered points, lattices and lines.
fn carried_fields_look_the_same_on_both(studio: &mut Studio) {
    for name in [
        "letters-carried",
        "letters-points",
        "letters-lattice",
        "cantilevers-carried",
        "cantilevers-lines",
    ] {
        let mut scene = Scene::new(name, of_gallery(name));
        // The exporter reads the carried fields at the samples of a grid, the
        // stage at each pixel: where moving parts fold, the tip of a spike
        // that is thinner than a cell is seen on the stage alone.
        scene.astray = 4;
        for t in [0.0, 0.3, 0.5, 1.0] {
            studio.compare(&scene, t);
        }
    }
}

/// The core decides for the middle of each pixel: here the exporter's chords
/// across a cell would be the coarser of the two.
fn contours_are_right_and_smooth_at_any_zoom(studio: &mut Studio) {
    for (name, transition) in field() {
        let Content::Field(fields) = transition.content().clone() else {
            panic!("{name} is no field");
        };
        let t = 0.4;
        let pair = fields.first();
        let on_contour = pair.contour(t)[0][0];
        for (zoom, half) in [("near", 0.05), ("far", 40.0)] {
            let mut scene = Scene::new(name, transition.clone());
            scene.view = Bounds {
                min: on_contour - half,
                max: on_contour + half,
            };
            scene.size = [300, 300];
            let picture = studio.picture(&scene, t).expect("a picture");
            studio.keep(&format!("{name}-{zoom}"), t, &picture);
            let pixel = 2.0 * half / 300.0;
            let inside = |(x, y, _): (u32, u32, &image::Rgba<u8>)| {
                let from_corner = DVec2::new(f64::from(x) + 0.5, 299.5 - f64::from(y));
                pair.is_inside(scene.view.min + pixel * from_corner, t)
            };
            let exact: Vec<bool> = picture.enumerate_pixels().map(inside).collect();
            let fill = scene.style.fill_at(t);
            let seen = mask(&picture, fill, scene.ground);
            assert_eq!(astray(&exact, &seen, 300), 0, "{name} {zoom}");
            let ground = scene.style.ground.0;
            let soft = |p: &&image::Rgba<u8>| ![fill.0, ground].contains(&[p[0], p[1], p[2]]);
            let soft = picture.pixels().filter(soft).count();
            assert!(
                (20..4000).contains(&soft),
                "{name} {zoom}: {soft} soft pixels"
            );
        }
    }
}

fn far_from_zero_nothing_changes(studio: &mut Studio) {
    let scene = Scene::new("far", solid(1e8));
    studio.compare(&scene, 0.35);
}

fn a_transparent_ground_has_straight_alpha(studio: &mut Studio) {
    let mut scene = Scene::new("transparent", truss());
    scene.ground = None;
    let (gpu, cpu) = studio.compare(&scene, 0.5);
    assert!(gpu.pixels().any(|p| p[3] == 0) && gpu.pixels().any(|p| p[3] == 255));
    // Where an edge is half covered the colour is still the bars' own.
    let fill = scene.style.fill_at(0.5).0;
    for (picture, name) in [(&gpu, "gpu"), (&cpu, "cpu")] {
        let mut edges = 0;
        for p in picture.pixels().filter(|p| (100..200).contains(&p[3])) {
            let off = (0..3).map(|k| p[k].abs_diff(fill[k])).max();
            edges += 1;
            assert!(off <= Some(6), "{name}: {p:?} at an edge of {fill:?}");
        }
        assert!(edges > 100, "{name}: {edges} edge pixels");
    }
}

fn every_size_is_drawn_and_others_are_refused(studio: &mut Studio) {
    let mut scene = Scene::new("sizes", solid(0.0));
    for size in [[1, 1], [333, 77], [3840, 2160]] {
        scene.size = size;
        let picture = studio.picture(&scene, 0.5).expect("a picture");
        assert_eq!(<[u32; 2]>::from(picture.dimensions()), size);
    }
    for size in [[0, 5], [5, 0], [1 << 20, 5]] {
        scene.size = size;
        let why = studio.picture(&scene, 0.5).expect_err("no such picture");
        assert!(why.contains("choose another size"), "{why}");
    }
}

fn overlays_are_seen(studio: &mut Studio) {
    let fill_only = StageVisibility {
        bars: true,
        ..StageVisibility::default()
    };
    type Switch = fn(&mut StageVisibility);
    let shows: [(&str, Switch); 4] = [
        ("wireframe", |show| show.wireframe = true),
        ("ghosts", |show| show.ghosts = true),
        ("iso-lines", |show| show.iso_lines = true),
        ("signed", |show| show.signed_colours = true),
    ];
    let (_, blended) = field().swap_remove(0);
    for (name, switch) in shows {
        let of_field = matches!(name, "iso-lines" | "signed");
        let transition = if of_field {
            blended.clone()
        } else {
            solid(0.0)
        };
        let mut scene = Scene::new(name, transition);
        scene.show = fill_only;
        let plain = studio.picture(&scene, 0.4).expect("a picture");
        switch(&mut scene.show);
        let with = studio.picture(&scene, 0.4).expect("a picture");
        let changed = different(&plain, &with);
        assert!(changed > 0.01, "{name} changes {changed} of the picture");
        studio.keep(name, 0.4, &with);
    }
}

/// The fraction of pixels that differ by more than [`CHANNEL`].
fn different(a: &RgbaImage, b: &RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let differs = |(p, q): (&image::Rgba<u8>, &image::Rgba<u8>)| {
        let seen = |p: &image::Rgba<u8>, k: usize| u32::from(p[k]) * u32::from(p[3]) / 255;
        (0..3).any(|k| seen(p, k).abs_diff(seen(q, k)) > u32::from(CHANNEL))
            || p[3].abs_diff(q[3]) > CHANNEL
    };
    let count = a
        .pixels()
        .zip(b.pixels())
        .filter(|&pair| differs(pair))
        .count();
    count as f64 / f64::from(a.width() * a.height())
}

/// Whether each pixel is more like the fill than like the ground.
fn mask(picture: &RgbaImage, fill: Rgb, ground: Option<Rgb>) -> Vec<bool> {
    let off = |p: &image::Rgba<u8>, Rgb(c): Rgb| -> u32 {
        (0..3).map(|k| u32::from(p[k].abs_diff(c[k])).pow(2)).sum()
    };
    let is_fill = |p: &image::Rgba<u8>| match ground {
        Some(ground) => off(p, fill) < off(p, ground),
        None => p[3] >= 128,
    };
    picture.pixels().map(is_fill).collect()
}

/// Every pixel of `a` whose whole neighbourhood is of one kind is of that kind
/// in `b`, so that boundaries are at most a pixel apart.
fn astray(a: &[bool], b: &[bool], width: u32) -> usize {
    let width = width as usize;
    let height = a.len() / width;
    let alike = |x: usize, y: usize| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        rows.flat_map(|row| columns.clone().map(move |column| (row, column)))
            .any(|(row, column)| a[row * width + column] == b[y * width + x])
    };
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.filter(|&(x, y)| !alike(x, y)).count()
}

/// Holds both pictures to the promise.
fn check(name: &str, scene: &Scene, t: f64, gpu: &RgbaImage, cpu: &RgbaImage) {
    let (fill, ground) = (scene.style.fill_at(t), scene.ground);
    let fraction = different(gpu, cpu);
    assert!(
        fraction <= PIXELS,
        "{name}: {fraction} of the pixels differ"
    );
    let masks = [gpu, cpu].map(|picture| mask(picture, fill, ground));
    assert!(masks[1].iter().any(|&m| m), "{name}: nothing to see");
    for [a, b] in [[0, 1], [1, 0]] {
        let far = astray(&masks[a], &masks[b], gpu.width());
        assert!(
            far <= scene.astray,
            "{name}: {far} pixels more than one pixel off the contour"
        );
    }
}

fn main() -> ExitCode {
    runner::run(TESTS)
}
