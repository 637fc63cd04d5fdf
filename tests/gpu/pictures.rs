//! Compares blends of bitmap pictures: the pixels that the stage draws on the GPU with those that
//! the core library computes on the CPU.

use image::{Rgba, RgbaImage};
use morphospace::content::PictureRaster;
use morphospace::export::{PixelSize, PlaneView};
use morphospace::geometry::{Bounds, DVec2};
use morphospace::transition::Transition;

use crate::offscreen::{OffscreenRenderer, RenderedScene};
use crate::transitions::{faded, from_gallery};

/// Measures of the difference between two images, compared with premultiplied alpha.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// Mean difference over all pixels and channels, on a scale of 0 to 255.
    pub mean: f64,
    /// Fraction of the pixels in which a channel differs by more than [`CHANNEL_TOLERANCE`].
    pub different_fraction: f64,
}

/// Difference of a channel, on a scale of 0 to 255, up to which pixels count as equal (tolerance:
/// rounding of filtered colours).
const CHANNEL_TOLERANCE: u8 = 4;

/// Maximum difference between the images of GPU and CPU if one screen pixel shows one pixel of the
/// picture (tolerance: GPUs interpolate between texels with 8-bit weights and, where a warp shrinks
/// the picture, between two mipmap levels; the core reads one level).
const ORIGINAL_SIZE: Difference = Difference {
    mean: 0.15,
    different_fraction: 0.0015,
};

/// Maximum difference between the images of GPU and CPU at other zooms (tolerance: the GPU
/// interpolates between two mipmap levels; the core reads one).
const ZOOMED: Difference = Difference {
    mean: 0.25,
    different_fraction: 0.01,
};

/// Values of t at which the images are compared.
const TIMES: [f64; 4] = [0.0, 0.3, 0.5, 1.0];

/// Gallery projects with pictures, one for each kind of warp.
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
        let (mut sum, mut different) = (0, 0);
        for (p, q) in a.pixels().zip(b.pixels()) {
            let difference = |k: usize| premultiplied(p, k).abs_diff(premultiplied(q, k));
            let differences = [0, 1, 2, 3].map(difference);
            sum += differences.iter().copied().map(u64::from).sum::<u64>();
            different += u64::from(
                differences
                    .iter()
                    .any(|&difference| difference > CHANNEL_TOLERANCE),
            );
        }
        let pixels = a.pixels().len() as f64;
        Self {
            mean: sum as f64 / (4.0 * pixels),
            different_fraction: different as f64 / pixels,
        }
    }

    pub fn check(self, name: &str, allowed: Self) {
        let is_allowed =
            self.mean <= allowed.mean && self.different_fraction <= allowed.different_fraction;
        assert!(is_allowed, "{name}: {self:?} exceeds {allowed:?}");
    }
}

/// Renders a scene on the GPU and on the CPU.
fn render_both(renderer: &mut OffscreenRenderer, scene: &RenderedScene, t: f64) -> [RgbaImage; 2] {
    let gpu = renderer.render(scene, t).expect("a picture");
    let [width, height] = scene.size;
    let view = PlaneView::fit(scene.view, PixelSize::new(width, height).expect("a size"));
    let raster = PictureRaster {
        size: scene.size,
        corner: view.to_plane(DVec2::ZERO),
        pixel_size: 1.0 / view.px_per_unit(),
    };
    let frame = scene.transition.frame(t);
    let cpu = frame.picture(&raster).expect("pictures");
    assert!(
        cpu.pixels().any(|p| p[3] > 0),
        "{}: an empty image",
        scene.name
    );
    renderer.save_image(&format!("{}-gpu", scene.name), t, &gpu);
    renderer.save_image(&format!("{}-cpu", scene.name), t, &cpu);
    [gpu, cpu]
}

/// A scene with `zoom` screen pixels per picture pixel, on a transparent background.
fn scene(name: &'static str, transition: Transition, zoom: f64) -> RenderedScene {
    let mut scene = RenderedScene::new(name, transition);
    let half_size = DVec2::new(240.0, 270.0);
    let centre = scene.view.centre().round();
    scene.view = Bounds {
        min: centre - half_size / zoom,
        max: centre + half_size / zoom,
    };
    scene.size = [480, 540];
    scene.ground = None;
    scene
}

pub fn pictures_match(renderer: &mut OffscreenRenderer) {
    for name in WARPS {
        let scene = scene(name, from_gallery(name), 1.0);
        for t in TIMES {
            let [gpu, cpu] = render_both(renderer, &scene, t);
            Difference::between(&gpu, &cpu).check(&format!("{name} at {t}"), ORIGINAL_SIZE);
        }
    }
}

pub fn transparent_pictures_match(renderer: &mut OffscreenRenderer) {
    for name in ["portraits-dissolve", "portraits"] {
        let scene = scene("faded", faded(name), 1.0);
        for t in TIMES {
            let [gpu, cpu] = render_both(renderer, &scene, t);
            assert!(cpu.pixels().any(|p| (60..200).contains(&p[3])));
            Difference::between(&gpu, &cpu).check(&format!("{name}, faded, at {t}"), ORIGINAL_SIZE);
        }
    }
}

pub fn zoomed_pictures_match(renderer: &mut OffscreenRenderer) {
    for zoom in [0.25, 0.4, 0.5, 3.0] {
        let scene = scene("zoomed", from_gallery("portraits"), zoom);
        let [gpu, cpu] = render_both(renderer, &scene, 0.5);
        Difference::between(&gpu, &cpu).check(&format!("zoom {zoom}"), ZOOMED);
    }
}
