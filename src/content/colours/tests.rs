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

fn still(pair: &PicturePair) -> crate::warp::Placer {
    let [a, b] = [0, 1].map(|k| pair.layers()[k].bounds());
    IdentityWarp::new(a.union(&b).padded(2.0)).placer()
}

/// The pixels of the picture themselves.
const OWN: PictureRaster = PictureRaster {
    size: [40, 30],
    corner: DVec2::new(0.0, 30.0),
    pixel: 1.0,
};

#[test]
fn the_ends_are_the_pictures() {
    let [a, b] = [picture(0), picture(5)];
    let pair = PicturePair::new(&a, &b, ColourMix::default()).expect("a mix");
    let placer = still(&pair);
    assert_eq!(&pair.render(placer.placement(), 0.0, &OWN), &**a.pixels());
    assert_eq!(&pair.render(placer.placement(), 1.0, &OWN), &**b.pixels());
}

#[test]
fn in_the_middle_light_is_halved() {
    let grey = |v: u8| Picture::new(RgbaImage::from_pixel(4, 4, Rgba([v, v, v, 255])));
    let pair = PicturePair::new(&grey(0), &grey(255), ColourMix::default()).expect("a mix");
    let raster = PictureRaster {
        size: [4, 4],
        corner: DVec2::new(0.0, 4.0),
        pixel: 1.0,
    };
    let half = pair.render(still(&pair).placement(), 0.5, &raster);
    assert!(half.pixels().all(|p| p.0 == [188, 188, 188, 255]));
}

#[test]
fn the_colour_of_what_is_transparent_does_not_bleed() {
    let red = Picture::new(RgbaImage::from_pixel(2, 2, Rgba([255, 0, 0, 255])));
    let none = Picture::new(RgbaImage::from_pixel(2, 2, Rgba([0, 255, 0, 0])));
    let pair = PicturePair::new(&red, &none, ColourMix::default()).expect("a mix");
    let raster = PictureRaster {
        size: [2, 2],
        corner: DVec2::new(0.0, 2.0),
        pixel: 1.0,
    };
    let half = pair.render(still(&pair).placement(), 0.5, &raster);
    assert!(half.pixels().all(|p| p.0 == [255, 0, 0, 128]));
}

#[test]
fn the_window_cuts_within_pixels() {
    let white = Picture::new(RgbaImage::from_pixel(4, 4, Rgba([255; 4])));
    let wide = white.transformed(&Similarity {
        scale: 2.0,
        ..Similarity::default()
    });
    let pair = PicturePair::new(&white, &wide, ColourMix::default()).expect("a mix");
    let raster = PictureRaster {
        size: [9, 9],
        corner: DVec2::new(-0.5, 8.5),
        pixel: 1.0,
    };
    // Half way it is 6 wide: half a pixel at each side.
    let half = pair.render(still(&pair).placement(), 0.5, &raster);
    let alpha: Vec<u8> = (0..9).map(|x| half.get_pixel(x, 5).0[3]).collect();
    assert_eq!(alpha, [128, 255, 255, 255, 255, 255, 128, 0, 0]);
}

#[test]
fn a_span_that_is_none_is_refused() {
    for (from, to) in [(0.5, 0.5), (0.6, 0.2), (-0.1, 1.0), (0.0, f64::NAN)] {
        let mix = ColourMix {
            from,
            to,
            ..ColourMix::default()
        };
        assert!(mix.check().is_err());
    }
}
