//! Draws the thumbnails on the map: of blends at the points of a regular grid, and of the designs
//! themselves.

use std::sync::Arc;

use image::RgbaImage;

use crate::export::{Drawing, PixelSize, PixelSizeError, PlaneView, SpaceColours, rasterise};
use crate::geometry::{Bounds, DVec2};
use crate::space::{DesignSpace, WeightMap};
use crate::transition::TransitionStyle;

/// Half the side of the square map, in map units. The designs lie within 1 of its centre along each
/// axis; the rest is margin (heuristic).
pub const MAP_HALF_SIDE: f64 = 1.2;

/// Number of blend thumbnails along each side of the map (heuristic).
const CELLS: u32 = 9;

/// Side of the square images of the whole map, in pixels (heuristic).
const SIDE_PX: u32 = 1056;

/// Size of a design's thumbnail relative to that of a blend (heuristic).
const DESIGN_SCALE: f64 = 1.3;

/// Images of the whole map, from −[`MAP_HALF_SIDE`] to [`MAP_HALF_SIDE`] along each axis, with
/// straight alpha on a transparent background.
#[derive(Clone, Debug)]
pub struct MapThumbnails {
    /// Number of designs on the map.
    pub count: usize,
    /// Image with the thumbnails of the blends.
    pub blends: Arc<RgbaImage>,
    /// Image with the thumbnails of the designs.
    pub designs: Arc<RgbaImage>,
}

/// Draws the thumbnails of the blends and of the designs, in the designs' own `colours` if they
/// have any.
///
/// # Errors
/// None in practice: `SIDE_PX` is a valid image size.
pub fn draw_thumbnails(
    space: &DesignSpace,
    map: &WeightMap,
    style: &TransitionStyle,
    colours: Option<&SpaceColours>,
) -> Result<MapThumbnails, PixelSizeError> {
    let size = PixelSize::new(SIDE_PX, SIDE_PX)?;
    let cell = 2.0 * MAP_HALF_SIDE / f64::from(CELLS);
    let px = f64::from(SIDE_PX) / (2.0 * MAP_HALF_SIDE);
    let mut frame = space.frame();
    let mut weights = vec![0.0; space.designs().len()];
    let mut picture = |places: &[DVec2], scale: f64| {
        let mut drawing = Drawing::new(size, None);
        for &place in places {
            map.weights(place, &mut weights);
            frame.seek(&weights);
            let side = DVec2::splat(0.86 * scale * cell * px);
            let middle = DVec2::new(place.x + MAP_HALF_SIDE, MAP_HALF_SIDE - place.y) * px;
            let bounds = square(space.bounds());
            let view = PlaneView::fit_cell(bounds, size, middle - 0.5 * side, side);
            match colours {
                Some(colours) => drawing.push_painted_blend(&frame, colours, &view),
                None => drawing.push_blend(&frame, style, &view),
            }
        }
        Arc::new(rasterise(&drawing))
    };
    let grid_points = (0..CELLS * CELLS).map(|index| {
        let [column, row] =
            [index % CELLS, index / CELLS].map(|k| (f64::from(k) + 0.5) * cell - MAP_HALF_SIDE);
        DVec2::new(column, row)
    });
    // No blend is drawn under a design's thumbnail or its name.
    let is_free = |place: &DVec2| {
        map.sites().iter().all(|site| {
            let [across, below] = [(place.x - site.x).abs(), site.y - place.y];
            across > 0.9 * cell || !(-0.9 * cell..1.3 * cell).contains(&below)
        })
    };
    let blend_places = grid_points.filter(|place| map.contains(*place, 0.3 * cell));
    let blend_places: Vec<DVec2> = blend_places.filter(is_free).collect();
    Ok(MapThumbnails {
        count: map.sites().len(),
        blends: picture(&blend_places, 1.0),
        designs: picture(map.sites(), DESIGN_SCALE),
    })
}

/// Smallest square around a box, with the same centre.
fn square(bounds: Bounds) -> Bounds {
    let half = DVec2::splat(0.5 * bounds.size().max_element());
    Bounds {
        min: bounds.centre() - half,
        max: bounds.centre() + half,
    }
}
