//! What lies under the map: the contours of a measure, and hatching where blends fold or cross
//! themselves. Measured beside the window, coarsely first.

use std::sync::Arc;

use image::{Rgba, RgbaImage};

use crate::app::jobs::job::BackgroundJob;
use crate::app::map::thumbnails::REACH;
use crate::colour::Rgb;
use crate::geometry::DVec2;
use crate::measure::{MapLandscape, MapMeasure};
use crate::space::{DesignSpace, WeightMap};
use crate::work::progress::Cancelled;

/// Places along each side of the map: at once, and after some seconds.
const SIDES: [usize; 2] = [16, 64];

/// Pixels along each side of the picture.
const SIDE_PX: u32 = 704;

/// Contours between the least and the largest value.
const CONTOURS: f64 = 9.0;

/// Pixels from one line of the hatching to the next, and how wide it is.
const HATCH_PX: (u32, u32) = (9, 2);

/// What is hatched, on light and on dark grounds.
const TROUBLE: Rgb = Rgb([196, 84, 40]);

/// A landscape and its picture, on their way.
#[derive(Debug, Default)]
pub struct MapContours {
    found: Option<MapLandscape>,
    surveying: Option<BackgroundJob<MapLandscape, Cancelled>>,
    of: Option<(ShownMeasure, Rgb, usize)>,
    painting: Option<BackgroundJob<Arc<RgbaImage>, Cancelled>>,
    picture: Option<Arc<RgbaImage>>,
}

/// What is shown, if anything.
type ShownMeasure = Option<MapMeasure>;

impl MapContours {
    /// The picture, once there is one.
    #[must_use]
    pub fn picture(&self) -> Option<&Arc<RgbaImage>> {
        self.picture.as_ref()
    }

    /// The measures, as far as they are known.
    #[must_use]
    pub fn found(&self) -> Option<&MapLandscape> {
        self.found.as_ref()
    }

    /// It is being measured, or drawn.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.surveying.is_some() || self.painting.is_some()
    }

    /// Measures what is not measured as finely as it is to be, and draws it with this ink;
    /// whether something new is there.
    pub fn work(
        &mut self,
        (space, map): (&DesignSpace, &WeightMap),
        shown: ShownMeasure,
        ink: Rgb,
    ) -> bool {
        if let Some(Ok(found)) = BackgroundJob::take(&mut self.surveying) {
            self.found = Some(found);
        }
        let known = self.found.as_ref().map_or(0, MapLandscape::side);
        let next = SIDES.into_iter().find(|side| *side > known);
        if let Some(side) = next.filter(|_| self.surveying.is_none()) {
            let (space, map) = (space.clone(), map.clone());
            self.surveying = Some(BackgroundJob::start("measuring the map", move |progress| {
                MapLandscape::of((&space, &map), side, REACH, progress)
            }));
        }
        let mut is_new = false;
        if let Some(answer) = BackgroundJob::take(&mut self.painting) {
            self.picture = answer.ok();
            is_new = true;
        }
        let of = (shown, ink, known);
        if let Some(found) = self.found.as_ref().filter(|_| self.of != Some(of)) {
            let found = found.clone();
            self.of = Some(of);
            self.painting = Some(BackgroundJob::start("drawing the map", move |_| {
                Ok(Arc::new(painted(&found, shown, ink)))
            }));
        }
        is_new
    }
}

/// The contours of what is shown, and the hatching; straight alpha on a transparent ground.
fn painted(land: &MapLandscape, shown: ShownMeasure, ink: Rgb) -> RgbaImage {
    let px = 2.0 * REACH / f64::from(SIDE_PX);
    let place = |x: u32, y: u32| {
        let [across, down] = [x, y].map(|k| (f64::from(k) + 0.5) * px - REACH);
        DVec2::new(across, -down)
    };
    let range = shown.and_then(|measure| Some((measure, land.range(measure)?)));
    // What is the same everywhere has no contours.
    let range = range.filter(|(_, [least, most])| most - least > 1e-9 * most.abs());
    RgbaImage::from_fn(SIDE_PX, SIDE_PX, |x, y| {
        let at = place(x, y);
        let is_line = (x + y) % HATCH_PX.0 < HATCH_PX.1;
        if is_line && land.trouble(at) > 0.5 {
            let Rgb([r, g, b]) = TROUBLE;
            return Rgba([r, g, b, 200]);
        }
        let shade = range.and_then(|(measure, [least, most])| {
            let height = |at: DVec2| {
                let value = land.value(measure, at)?;
                Some((value - least) / (most - least) * CONTOURS)
            };
            let here = height(at)?;
            let slope = DVec2::new(
                height(at + DVec2::X * px)? - here,
                height(at + DVec2::Y * px)? - here,
            );
            // How many pixels it is to the nearest contour.
            let far = (here - here.round()).abs() / slope.length().max(1e-9);
            let line = (1.3 - far).clamp(0.0, 1.0);
            Some(0.22 * here / CONTOURS + 0.4 * line)
        });
        let Rgb([r, g, b]) = ink;
        Rgba([r, g, b, (shade.unwrap_or(0.0).min(1.0) * 255.0) as u8])
    })
}
