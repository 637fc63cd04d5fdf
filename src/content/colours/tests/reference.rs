//! Slow and direct implementation of picture rendering, against which the fast one is tested.

use super::super::*;
use image::Rgba;
use proptest::prelude::*;

/// Distance from an edge of a face, in pixels, below which a pixel may belong to the face on either
/// side (tolerance: far above the rounding of both implementations).
const UNDECIDED: f64 = 1e-5;

/// Output image whose pixels are shifted by fractions of a pixel against those of the pictures.
const RASTER: PictureRaster = PictureRaster {
    size: [50, 40],
    corner: DVec2::new(-3.25, 36.5),
    pixel_size: 1.0,
};

/// Picture with opaque and transparent regions, in which neighbouring pixels differ.
fn picture(width: u32, height: u32, seed: u32) -> Picture {
    let pixel = |x: u32, y: u32| {
        let value = |k: u32| ((x * x * 37 + y * 91 + x * y * k * 53 + seed * 17) % 256) as u8;
        let alpha = [255, 255, value(5), 0][(x / 5 + y / 7 + seed) as usize % 4];
        Rgba([value(1), value(2), value(3), alpha])
    };
    Picture::new(RgbaImage::from_fn(width, height, pixel))
}

/// Converts an sRGB pixel with straight alpha to linear light with premultiplied alpha.
fn decoded(pixel: Rgba<u8>) -> [f64; 4] {
    let [.., alpha] = pixel.0.map(|v| f64::from(v) / 255.0);
    let light = |k: usize| {
        let v = f64::from(pixel[k]) / 255.0;
        let light = if v <= 0.04045 {
            v / 12.92
        } else {
            ((v + 0.055) / 1.055).powf(2.4)
        };
        light * alpha
    };
    [light(0), light(1), light(2), alpha]
}

/// Converts linear light with premultiplied alpha to an sRGB pixel with straight alpha.
fn encoded(light: [f64; 4]) -> [u8; 4] {
    let alpha = light[3];
    let channel = |k: usize| {
        let light = (light[k] / alpha).clamp(0.0, 1.0);
        let v = if light <= 0.003_130_8 {
            12.92 * light
        } else {
            1.055 * light.powf(1.0 / 2.4) - 0.055
        };
        (255.0 * v).round() as u8
    };
    if alpha <= 0.0 {
        return [0; 4];
    }
    let opacity = (255.0 * alpha).round() as u8;
    [channel(0), channel(1), channel(2), opacity]
}

fn sum(parts: &[(f64, [f64; 4])]) -> [f64; 4] {
    std::array::from_fn(|k| parts.iter().map(|(share, light)| share * light[k]).sum())
}

/// Returns the light of a picture at a point of the plane: bilinear between pixel centres, mirrored
/// at the edges. Pixels have the side length 1.
fn look(picture: &Picture, p: DVec2) -> [f64; 4] {
    let pixels = picture.pixels();
    let last = DVec2::new(
        f64::from(pixels.width() - 1),
        f64::from(pixels.height() - 1),
    );
    let size = last + 1.0;
    let mirrored = |x: f64, size: f64| {
        let x = x.rem_euclid(2.0 * size);
        x.min(2.0 * size - x) - 0.5
    };
    let at = DVec2::new(mirrored(p.x, size.x), mirrored(size.y - p.y, size.y));
    let at = at.clamp(DVec2::ZERO, last);
    let low = at.floor();
    let [u, v] = (at - low).to_array();
    let pixel = |dx: f64, dy: f64| {
        let at = (low + DVec2::new(dx, dy)).min(last);
        decoded(*pixels.get_pixel(at.x as u32, at.y as u32))
    };
    sum(&[
        ((1.0 - u) * (1.0 - v), pixel(0.0, 0.0)),
        (u * (1.0 - v), pixel(1.0, 0.0)),
        ((1.0 - u) * v, pixel(0.0, 1.0)),
        (u * v, pixel(1.0, 1.0)),
    ])
}

/// Returns the last face that covers a point, with the barycentric coordinates of the point.
/// `Some(None)` means that no face covers it, `None` that it is too close to an edge to decide.
fn face_at(placement: &Placement, p: DVec2) -> Option<Option<([u32; 3], [f64; 3])>> {
    let mut last_cover = None;
    for &face in placement.faces.iter() {
        let [a, b, c] = face.map(|v| placement.in_frame[v as usize]);
        let det = (b - a).perp_dot(c - a);
        let part = |u: DVec2, v: DVec2| (v - u).perp_dot(p - u) / det;
        let parts = [part(b, c), part(c, a), part(a, b)];
        let sides = [b.distance(c), c.distance(a), a.distance(b)];
        let to_side = |k: usize| parts[k] * det.abs() / sides[k];
        let depth = to_side(0).min(to_side(1)).min(to_side(2));
        if depth.abs() < UNDECIDED {
            return None;
        }
        if depth > 0.0 {
            last_cover = Some((face, parts));
        }
    }
    Some(last_cover)
}

/// Returns the expected value of the output pixel (x, y); `None` if the reference cannot decide.
fn expected_pixel(
    pictures: &[Picture; 2],
    placement: &Placement,
    t: f64,
    [x, y]: [u32; 2],
) -> Option<[u8; 4]> {
    let corner = RASTER.corner + DVec2::new(f64::from(x), -f64::from(y));
    let Some((face, parts)) = face_at(placement, corner + DVec2::new(0.5, -0.5))? else {
        return Some([0; 4]);
    };
    let seen = |k: usize, points: &[DVec2]| {
        let place = |k: usize| parts[k] * points[face[k] as usize];
        look(&pictures[k], place(0) + place(1) + place(2))
    };
    let light = sum(&[
        (1.0 - t, seen(0, &placement.in_source)),
        (t, seen(1, &placement.in_target)),
    ]);
    let [a, b] = [0, 1].map(|k| pictures[k].bounds());
    let (low, high) = (a.min.lerp(b.min, t), a.max.lerp(b.max, t));
    let across = (corner.x + 1.0).min(high.x) - corner.x.max(low.x);
    let down = corner.y.min(high.y) - (corner.y - 1.0).max(low.y);
    Some(encoded(sum(&[(across.max(0.0) * down.max(0.0), light)])))
}

/// Placement of a grid of faces over the pictures. Each vertex is displaced in the frame, in the
/// source and in the target.
fn placement(moves: &[[(f64, f64); 3]]) -> Placement {
    let at = |k: usize| 9.0 * DVec2::new((k % 6) as f64, (k / 6) as f64);
    let moved = |list: usize| {
        let place = |(k, by): (usize, &[(f64, f64); 3])| at(k) + DVec2::from(by[list]);
        moves.iter().enumerate().map(place).collect()
    };
    let cell = |k: u32| [[k, k + 1, k + 7], [k, k + 7, k + 6]];
    let cells = (0..24).filter(|k| k % 6 < 5).flat_map(cell);
    Placement {
        faces: cells.collect(),
        in_frame: moved(0),
        in_source: moved(1),
        in_target: moved(2),
    }
}

fn rendered(pictures: &[Picture; 2], placement: &Placement, t: f64) -> RgbaImage {
    let [a, b] = pictures;
    let pair = PicturePair::new(a, b, ColourMix::default()).expect("a mix");
    pair.render(placement, t, &RASTER)
}

fn pictures() -> [Picture; 2] {
    [picture(44, 31, 1), picture(37, 35, 2)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Compares both implementations for random placements with folds and overlaps, and pictures
    /// with transparent regions.
    #[test]
    fn pixels_are_those_of_the_reference(
        moves in prop::collection::vec(prop::array::uniform3((-9.0f64..9.0, -9.0f64..9.0)), 30),
        t in prop_oneof![Just(0.0), Just(1.0), 0.0f64..1.0],
    ) {
        let (pictures, placement) = (pictures(), placement(&moves));
        let fast = rendered(&pictures, &placement, t);
        let mut compared = 0;
        for (x, y, pixel) in fast.enumerate_pixels() {
            let Some(slow) = expected_pixel(&pictures, &placement, t, [x, y]) else { continue };
            let off = (0..4).map(|k| slow[k].abs_diff(pixel[k])).max();
            prop_assert!(off <= Some(1), "({x}, {y}): {slow:?}, {pixel:?}");
            compared += 1;
        }
        prop_assert!(compared > 1900, "only {compared} pixels were compared");
    }
}

/// Renders placements with vertices that are NaN, infinite or far away.
#[test]
fn any_placement_is_rendered() {
    let pictures = pictures();
    let values = [f64::NAN, f64::INFINITY, -1e300, 1e18, 1e-300, 7.0];
    for (k, &value) in values.iter().enumerate() {
        for list in 0..3 {
            let mut moves = [[(0.5, 0.25); 3]; 30];
            moves[8 + k][list] = (value, -value);
            moves[20][list].1 = value;
            rendered(&pictures, &placement(&moves), 0.4);
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let pictures = [picture(60, 200, 1), picture(70, 180, 2)];
    let moves: Vec<[(f64, f64); 3]> = (0..30)
        .map(|k| [k, 2 * k, 3 * k].map(|k| (f64::from(k % 7), f64::from(k % 5))))
        .collect();
    let placement = placement(&moves);
    let rendered_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool")
            .install(|| rendered(&pictures, &placement, 0.3))
    };
    let one = rendered_on(1);
    assert!(one.pixels().any(|p| p[3] > 0));
    assert!(
        [2, 3, 7]
            .into_iter()
            .all(|threads| rendered_on(threads) == one)
    );
}
