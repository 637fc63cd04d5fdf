//! Tests of design spaces of pictures.

use super::*;
use crate::content::{PicturePair, PictureRaster};
use crate::correspondence::LinePair;
use crate::design::Picture;
use crate::warp::{ManyFeatures, WarpKind};
use image::{Rgba, RgbaImage};

/// Side length of the test pictures, in pixels.
const SIDE: u32 = 64;

/// A picture of a ball at `centre` in front of a background with colour gradients.
fn ball(name: &str, centre: [f64; 2], colour: [u8; 3]) -> Arc<Design> {
    let pixel = |x: u32, y: u32| {
        // The plane has y up.
        let p = DVec2::new(f64::from(x) + 0.5, f64::from(SIDE - y) - 0.5);
        let [r, g, b] = if p.distance(centre.into()) < 9.0 {
            colour
        } else {
            [40 + x as u8, 60 + y as u8, 90]
        };
        Rgba([r, g, b, 255])
    };
    let side = f64::from(SIDE);
    let ring = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
    let mut design = Design::from_rings(name, [ring]).expect("a design");
    design.picture = Some(Picture::new(RgbaImage::from_fn(SIDE, SIDE, pixel)));
    Arc::new(design)
}

/// Centres of the balls in three pictures, in pixels, y up.
const PLACES: [[f64; 2]; 3] = [[20.0, 20.0], [44.0, 26.0], [30.0, 46.0]];

fn line(centre: [f64; 2]) -> [DVec2; 2] {
    let centre = DVec2::from(centre);
    [centre - DVec2::X * 9.0, centre + DVec2::X * 9.0]
}

/// Specification of a space of the pictures with the given indices, in this order.
fn spec(order: &[usize], warp: WarpKind) -> SpaceSpec {
    let colours = [[250, 40, 40], [40, 220, 60], [60, 80, 250]];
    let designs = order.iter().map(|&k| ball("ball", PLACES[k], colours[k]));
    let mut spec = SpaceSpec::new(designs.collect());
    spec.content = Some(ContentKind::Colours);
    spec.warp = warp;
    spec.features = ManyFeatures {
        points: Vec::new(),
        lines: vec![order.iter().map(|&k| line(PLACES[k])).collect()],
    };
    spec
}

fn raster() -> PictureRaster {
    PictureRaster {
        size: [SIDE; 2],
        corner: DVec2::new(0.0, f64::from(SIDE)),
        pixel_size: 1.0,
    }
}

fn render(space: &DesignSpace, weights: &[f64]) -> RgbaImage {
    let mut frame = space.frame();
    frame.seek(weights);
    frame.picture(&raster()).expect("pictures")
}

/// Returns the largest difference between two images in any colour channel or the opacity of any
/// pixel.
fn max_difference(a: &RgbaImage, b: &RgbaImage) -> u8 {
    let each = a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b));
    each.max().expect("pixels")
}

/// All warps that pictures allow, including no warp.
const WARPS: [WarpKind; 4] = [
    WarpKind::None,
    WarpKind::Lines,
    WarpKind::Scattered,
    WarpKind::Lattice,
];

#[test]
#[ignore = "slow; run by scripts/test"]
fn weight_one_reproduces_each_picture_in_any_order() {
    for kind in WARPS {
        let space = DesignSpace::build(&spec(&[0, 1, 2], kind), &Silent).expect("a space");
        for (k, design) in space.designs().iter().enumerate() {
            let original = design.picture.as_ref().expect("a picture");
            assert_eq!(&render(&space, &corner(3, k)), original.pixels().as_ref());
        }
        let reordered = DesignSpace::build(&spec(&[2, 0, 1], kind), &Silent).expect("a space");
        let blend = render(&space, &[0.5, 0.2, 0.3]);
        assert!(
            max_difference(&blend, &render(&reordered, &[0.3, 0.5, 0.2])) <= 1,
            "{kind:?}"
        );
    }
}

#[test]
fn a_space_of_two_pictures_equals_their_transition() {
    for kind in [WarpKind::None, WarpKind::Lines, WarpKind::Scattered] {
        let spec = spec(&[0, 1], kind);
        let space = DesignSpace::build(&spec, &Silent).expect("a space");
        let [a, b] = [0, 1].map(|k| Arc::clone(&spec.designs[k]));
        let pictures = [&a, &b].map(|design| design.picture.clone().expect("a picture"));
        let mut pair = TransitionSpec::new(a, b);
        pair.method = TransitionMethod::new(kind, ContentKind::Colours).expect("a cell");
        pair.options.matching.lines = vec![LinePair {
            source: line(PLACES[0]),
            target: line(PLACES[1]),
        }];
        let pair = Transition::build(&pair, &Silent).expect("a transition");
        for t in [0.0, 0.3, 0.5, 0.8, 1.0] {
            let expected = pair.frame(t).picture(&raster()).expect("pictures");
            let blend = render(&space, &[1.0 - t, t]);
            // The grids on which the two warps are evaluated differ, so a few pixels at the edge of
            // the ball differ.
            let pairs = blend.pixels().zip(expected.pixels());
            let different = pairs.filter(|(a, b)| (0..3).any(|k| a.0[k].abs_diff(b.0[k]) > 2));
            assert!(different.count() < 12, "{kind:?} at {t}");
        }
        let mix = PicturePair::new(&pictures[0], &pictures[1], spec.options.colours);
        assert_eq!(mix.expect("a pair").window(0.4), space.bounds());
    }
}

#[test]
fn lines_in_all_pictures_align_the_balls() {
    let weights = [1.0 / 3.0; 3];
    let middle = PLACES.iter().map(|p| DVec2::from(*p)).sum::<DVec2>() / 3.0;
    let space = DesignSpace::build(&spec(&[0, 1, 2], WarpKind::Lines), &Silent).expect("a space");
    let picture = render(&space, &weights);
    let pixel_at = |p: DVec2| *picture.get_pixel(p.x as u32, (f64::from(SIDE) - p.y) as u32);
    // Red, green and blue are mixed in equal parts, in linear light.
    let Rgba([r, g, b, _]) = pixel_at(middle);
    assert!(
        r.abs_diff(154) < 12 && g.abs_diff(136) < 12 && b.abs_diff(158) < 12,
        "{r} {g} {b}"
    );
    // Without a warp, each ball remains visible at its original place.
    let unwarped = DesignSpace::build(&spec(&[0, 1, 2], WarpKind::None), &Silent).expect("a space");
    let picture = render(&unwarped, &weights);
    let ghost = DVec2::from(PLACES[0]) - DVec2::splat(4.0);
    let ghost = *picture.get_pixel(ghost.x as u32, (f64::from(SIDE) - ghost.y) as u32);
    assert!(ghost.0[0] > ghost.0[1] + 30, "{ghost:?}");
}

#[test]
fn a_blend_becomes_a_design_and_a_path_connects_blends() {
    let space = DesignSpace::build(&spec(&[0, 1, 2], WarpKind::Lines), &Silent).expect("a space");
    let weights = [0.25, 0.25, 0.5];
    let design = space.design(&weights, "mixed");
    let picture = design.picture.as_ref().expect("a picture");
    assert_eq!(picture.bounds(), space.bounds());
    assert!(max_difference(picture.pixels(), &render(&space, &weights)) <= 1);

    let map = WeightMap::new(&MapLayout::Polygon.sites(space.distances())).expect("sites");
    let mut path = MapPath::default();
    let sites = map.sites().to_vec();
    for site in [sites[0], DVec2::ZERO, sites[2]] {
        path.places.push(Waypoint::stop(site));
    }
    let film = space.path_sequence(&map, &path, &Silent).expect("a film");
    let first = space.designs()[0].picture.as_ref().expect("a picture");
    let image_at = |t: f64| film.frame(t).frame().picture(&raster()).expect("pictures");
    assert_eq!(&image_at(0.0), first.pixels().as_ref());
    let mut middle = vec![0.0; 3];
    map.weights(DVec2::ZERO, &mut middle);
    assert!(max_difference(&image_at(1.0), &render(&space, &middle)) <= 1);
}

#[test]
fn a_design_without_a_picture_is_an_error() {
    let mut spec = spec(&[0, 1, 2], WarpKind::None);
    spec.designs[1] = star("star", 5, 1.0);
    let error = DesignSpace::build(&spec, &Silent).expect_err("an outline");
    assert_eq!(error.to_string(), "star has no colours");
}

#[test]
fn too_many_pixels_are_refused_before_the_work_starts() {
    let large = Picture::new(RgbaImage::new(4096, 4096));
    let mut design = Design::from_rings("large", [ring(2048.0)]).expect("a design");
    design.picture = Some(large);
    let design = Arc::new(design);
    let mut spec = SpaceSpec::new(vec![design; 5]);
    spec.content = Some(ContentKind::Colours);
    let error = DesignSpace::build(&spec, &Silent).expect_err("too much");
    assert!(error.to_string().contains("picture pixels"), "{error}");
}
