//! Tests of picture mixes: exact pictures at t = 0 and t = 1, linear light, transparency, cropping
//! and refused mixes.

mod reference;

use super::*;
use crate::geometry::Similarity;
use crate::warp::{IdentityWarp, Warp};
use image::Rgba;

fn picture(seed: u32) -> Picture {
    let value = |x: u32, y: u32, k: u32| ((x * 37 + y * 91 + k * 53 + seed * 17) % 256) as u8;
    let pixel = |x, y| Rgba([value(x, y, 0), value(x, y, 1), value(x, y, 2), 255]);
    Picture::new(RgbaImage::from_fn(40, 30, pixel))
}

fn identity_placer(pair: &PicturePair) -> crate::warp::Placer {
    let [a, b] = [0, 1].map(|k| pair.layers()[k].bounds());
    IdentityWarp::new(a.union(&b).padded(2.0)).placer()
}

/// Output image whose pixels coincide with those of the test picture.
const PICTURE_RASTER: PictureRaster = PictureRaster {
    size: [40, 30],
    corner: DVec2::new(0.0, 30.0),
    pixel_size: 1.0,
};

#[test]
fn the_ends_are_the_pictures() {
    let [a, b] = [picture(0), picture(5)];
    let pair = PicturePair::new(&a, &b, ColourMix::default()).expect("a mix");
    let placer = identity_placer(&pair);
    assert_eq!(
        &pair.render(placer.placement(), 0.0, &PICTURE_RASTER),
        &**a.pixels()
    );
    assert_eq!(
        &pair.render(placer.placement(), 1.0, &PICTURE_RASTER),
        &**b.pixels()
    );
}

#[test]
fn halfway_the_light_is_halved() {
    let grey = |v: u8| Picture::new(RgbaImage::from_pixel(4, 4, Rgba([v, v, v, 255])));
    let pair = PicturePair::new(&grey(0), &grey(255), ColourMix::default()).expect("a mix");
    let raster = PictureRaster {
        size: [4, 4],
        corner: DVec2::new(0.0, 4.0),
        pixel_size: 1.0,
    };
    let half = pair.render(identity_placer(&pair).placement(), 0.5, &raster);
    assert!(half.pixels().all(|p| p.0 == [188, 188, 188, 255]));
}

#[test]
fn transparent_colours_do_not_bleed() {
    let red = Picture::new(RgbaImage::from_pixel(2, 2, Rgba([255, 0, 0, 255])));
    let transparent = Picture::new(RgbaImage::from_pixel(2, 2, Rgba([0, 255, 0, 0])));
    let pair = PicturePair::new(&red, &transparent, ColourMix::default()).expect("a mix");
    let raster = PictureRaster {
        size: [2, 2],
        corner: DVec2::new(0.0, 2.0),
        pixel_size: 1.0,
    };
    let half = pair.render(identity_placer(&pair).placement(), 0.5, &raster);
    assert!(half.pixels().all(|p| p.0 == [255, 0, 0, 128]));
}

#[test]
fn the_visible_rectangle_cuts_within_pixels() {
    let white = Picture::new(RgbaImage::from_pixel(4, 4, Rgba([255; 4])));
    let wide = white.transformed(&Similarity {
        scale: 2.0,
        ..Similarity::default()
    });
    let pair = PicturePair::new(&white, &wide, ColourMix::default()).expect("a mix");
    let raster = PictureRaster {
        size: [9, 9],
        corner: DVec2::new(-0.5, 8.5),
        pixel_size: 1.0,
    };
    // Halfway, the visible rectangle is six pixels wide. It covers half of the first and half of
    // the seventh pixel of a row.
    let half = pair.render(identity_placer(&pair).placement(), 0.5, &raster);
    let alpha: Vec<u8> = (0..9).map(|x| half.get_pixel(x, 5).0[3]).collect();
    assert_eq!(alpha, [128, 255, 255, 255, 255, 255, 128, 0, 0]);
}

#[test]
fn an_invalid_range_is_refused() {
    for (from, to) in [(0.5, 0.5), (0.6, 0.2), (-0.1, 1.0), (0.0, f64::NAN)] {
        let mix = ColourMix {
            from,
            to,
            ..ColourMix::default()
        };
        assert!(mix.check().is_err());
    }
}
