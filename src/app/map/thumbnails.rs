//! What lies on the map: small pictures of the blends, and of the designs.

use std::sync::Arc;

use image::RgbaImage;

use crate::export::{Drawing, PixelSize, PixelSizeError, PlaneView, rasterise};
use crate::geometry::{Bounds, DVec2};
use crate::space::{DesignSpace, WeightMap};
use crate::transition::TransitionStyle;

/// How far the map reaches from its middle: sites are within 1 of it.
pub const REACH: f64 = 1.2;

/// Small pictures along each side of the map.
const CELLS: u32 = 9;

/// Pixels along each side of the picture of what lies between the designs.
const SIDE_PX: u32 = 1056;

/// How much of a design's picture on the map is wider than that of a blend.
const DESIGN: f64 = 1.3;

/// Pictures of the whole map, from −[`REACH`] to [`REACH`]; straight alpha on a transparent ground.
#[derive(Clone, Debug)]
pub struct MapThumbnails {
    /// How many designs there are.
    pub count: usize,
    /// What lies between the designs.
    pub between: Arc<RgbaImage>,
    /// The designs.
    pub designs: Arc<RgbaImage>,
}

/// Draws what lies between the designs, and the designs.
///
/// # Errors
/// Never: the size is one that pictures may have.
pub fn draw_thumbnails(
    space: &DesignSpace,
    map: &WeightMap,
    style: &TransitionStyle,
) -> Result<MapThumbnails, PixelSizeError> {
    let size = PixelSize::new(SIDE_PX, SIDE_PX)?;
    let cell = 2.0 * REACH / f64::from(CELLS);
    let px = f64::from(SIDE_PX) / (2.0 * REACH);
    let mut frame = space.frame();
    let mut weights = vec![0.0; space.designs().len()];
    let mut picture = |places: &[DVec2], wide: f64| {
        let mut drawing = Drawing::new(size, None);
        for &place in places {
            map.weights(place, &mut weights);
            frame.seek(&weights);
            let side = DVec2::splat(0.86 * wide * cell * px);
            let middle = DVec2::new(place.x + REACH, REACH - place.y) * px;
            let seen = square(space.bounds());
            let view = PlaneView::fit_cell(seen, size, middle - 0.5 * side, side);
            drawing.push_blend(&frame, style, &view);
        }
        Arc::new(rasterise(&drawing))
    };
    let steps = (0..CELLS * CELLS).map(|at| {
        let [column, row] = [at % CELLS, at / CELLS].map(|k| (f64::from(k) + 0.5) * cell - REACH);
        DVec2::new(column, row)
    });
    // None under a design's picture, or its name below that.
    let is_free = |place: &DVec2| {
        map.sites().iter().all(|site| {
            let [across, below] = [(place.x - site.x).abs(), site.y - place.y];
            across > 0.9 * cell || !(-0.9 * cell..1.3 * cell).contains(&below)
        })
    };
    let between = steps.filter(|place| map.holds(*place, 0.3 * cell));
    let between: Vec<DVec2> = between.filter(is_free).collect();
    Ok(MapThumbnails {
        count: map.sites().len(),
        between: picture(&between, 1.0),
        designs: picture(map.sites(), DESIGN),
    })
}

/// The square around a box.
fn square(bounds: Bounds) -> Bounds {
    let half = DVec2::splat(0.5 * bounds.size().max_element());
    Bounds {
        min: bounds.centre() - half,
        max: bounds.centre() + half,
    }
}
