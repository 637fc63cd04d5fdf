//! Pictures: the stage's pixels held against the core's own.

use image::{Rgba, RgbaImage};
use morphospace::content::PictureRaster;
use morphospace::export::{PixelSize, PlaneView};
use morphospace::geometry::{Bounds, DVec2};
use morphospace::transition::Transition;

use crate::scenes::{faded, of_gallery};
use crate::studio::{Scene, Studio};

/// By how much two pictures differ, alpha premultiplied.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// Mean over pixels and channels, in steps of 255.
    pub mean: f64,
    /// The share of pixels with a channel that is off by more than
    /// [`TOLERANCE`].
    pub off: f64,
}

/// In steps of 255.
const TOLERANCE: u8 = 4;

/// What is allowed at one pixel for each of the pictures', about twice what a
/// software adapter reaches (0.08 and 0.0005), and half as much again as a card
/// (0.00104), whose weights between texels have eight bits: where a warp shrinks
/// a picture the card begins to mix in its next smaller size, the core does not.
const OWN_SIZE: Difference = Difference {
    mean: 0.15,
    off: 0.0015,
};

/// What is allowed at other zooms (0.12 and 0.004 are reached): of the smaller
/// sizes of a picture the card mixes two, the core takes one.
const ZOOMED: Difference = Difference {
    mean: 0.25,
    off: 0.01,
};

const TIMES: [f64; 4] = [0.0, 0.3, 0.5, 1.0];

const WARPS: [&str; 5] = [
    "portraits-dissolve",
    "portraits",
    "portraits-points",
    "portraits-lattice",
    "portraits-rigid",
];

impl Difference {
    pub fn between(a: &RgbaImage, b: &RgbaImage) -> Self {
        assert_eq!(a.dimensions(), b.dimensions());
        let premultiplied = |p: &Rgba<u8>, k: usize| match k {
            3 => p[3],
            _ => (u32::from(p[k]) * u32::from(p[3]) / 255) as u8,
        };
        let (mut sum, mut off) = (0, 0);
        for (p, q) in a.pixels().zip(b.pixels()) {
            let apart = |k: usize| premultiplied(p, k).abs_diff(premultiplied(q, k));
            let apart = [0, 1, 2, 3].map(apart);
            sum += apart.iter().copied().map(u64::from).sum::<u64>();
            off += u64::from(apart.iter().any(|&apart| apart > TOLERANCE));
        }
        let pixels = a.pixels().len() as f64;
        Self {
            mean: sum as f64 / (4.0 * pixels),
            off: off as f64 / pixels,
        }
    }

    pub fn check(self, name: &str, allowed: Self) {
        let is_allowed = self.mean <= allowed.mean && self.off <= allowed.off;
        assert!(is_allowed, "{name}: {self:?}, allowed are {allowed:?}");
    }
}

/// The scene at `t` from both.
fn both(studio: &mut Studio, scene: &Scene, t: f64) -> [RgbaImage; 2] {
    let gpu = studio.picture(scene, t).expect("a picture");
    let [width, height] = scene.size;
    let view = PlaneView::fit(scene.view, PixelSize::new(width, height).expect("a size"));
    let raster = PictureRaster {
        size: scene.size,
        corner: view.to_plane(DVec2::ZERO),
        pixel: 1.0 / view.px_per_unit(),
    };
    let frame = scene.transition.frame(t);
    let cpu = frame.picture(&raster).expect("pictures");
    assert!(cpu.pixels().any(|p| p[3] > 0), "{}: nothing", scene.name);
    studio.keep(&format!("{}-gpu", scene.name), t, &gpu);
    studio.keep(&format!("{}-cpu", scene.name), t, &cpu);
    [gpu, cpu]
}

/// Pictures at `zoom` pixels for each of their own, on nothing.
fn scene(name: &'static str, transition: Transition, zoom: f64) -> Scene {
    let mut scene = Scene::new(name, transition);
    let half = DVec2::new(240.0, 270.0);
    let middle = scene.view.centre().round();
    scene.view = Bounds {
        min: middle - half / zoom,
        max: middle + half / zoom,
    };
    scene.size = [480, 540];
    scene.ground = None;
    scene
}

pub fn pictures_look_the_same_on_both(studio: &mut Studio) {
    for name in WARPS {
        let scene = scene(name, of_gallery(name), 1.0);
        for t in TIMES {
            let [gpu, cpu] = both(studio, &scene, t);
            Difference::between(&gpu, &cpu).check(&format!("{name} at {t}"), OWN_SIZE);
        }
    }
}

pub fn transparent_pictures_look_the_same_on_both(studio: &mut Studio) {
    for name in ["portraits-dissolve", "portraits"] {
        let scene = scene("faded", faded(name), 1.0);
        for t in TIMES {
            let [gpu, cpu] = both(studio, &scene, t);
            assert!(cpu.pixels().any(|p| (60..200).contains(&p[3])));
            Difference::between(&gpu, &cpu).check(&format!("{name}, faded, at {t}"), OWN_SIZE);
        }
    }
}

pub fn pictures_look_the_same_at_any_zoom(studio: &mut Studio) {
    for zoom in [0.25, 0.4, 0.5, 3.0] {
        let scene = scene("zoomed", of_gallery("portraits"), zoom);
        let [gpu, cpu] = both(studio, &scene, 0.5);
        Difference::between(&gpu, &cpu).check(&format!("{zoom} pixels a pixel"), ZOOMED);
    }
}
