//! A space with its map, and what is drawn of them.

use std::sync::Arc;

use image::RgbaImage;

use crate::app::jobs::job::BackgroundJob;
use crate::app::map::contours::MapContours;
use crate::app::map::thumbnails::{MapThumbnails, draw_thumbnails};
use crate::colour::Rgb;
use crate::design::DesignForm;
use crate::export::{Drawing, PixelSize, PixelSizeError, PlaneView, rasterise, text_colour_on};
use crate::geometry::DVec2;
use crate::measure::MapMeasure;
use crate::project::SavedPlace;
use crate::space::{DesignSpace, SpaceFrame, WeightMap};
use crate::transition::TransitionStyle;

/// Pixels along each side of a place that is kept.
const KEPT_PX: u32 = 96;

/// How many of them are drawn in one frame: a blend of fields takes some milliseconds.
const KEPT_AT_ONCE: usize = 4;

/// A space with its map, and what is drawn of them.
#[derive(Debug)]
pub struct MapPictures {
    space: DesignSpace,
    map: WeightMap,
    frame: SpaceFrame,
    /// What lies between the designs, and the designs.
    ground: Option<MapThumbnails>,
    drawing: Option<BackgroundJob<MapThumbnails, PixelSizeError>>,
    /// How that is drawn.
    style: Option<TransitionStyle>,
    /// The blend under the puck.
    blend: Option<BlendPicture>,
    /// What is measured all over the map.
    land: MapContours,
    /// The places that are kept, in small.
    kept: Vec<(DVec2, Arc<RgbaImage>)>,
    /// Some of them are not drawn yet.
    lacks_kept: bool,
}

/// The blend as it was drawn last.
#[derive(Debug)]
struct BlendPicture {
    of: (Vec<f64>, PixelSize, TransitionStyle),
    picture: Arc<RgbaImage>,
}

impl MapPictures {
    /// Not drawn yet, but for what was drawn before.
    #[must_use]
    pub fn new(space: DesignSpace, map: WeightMap, ground: Option<MapThumbnails>) -> Self {
        Self {
            map,
            frame: space.frame(),
            space,
            ground,
            drawing: None,
            style: None,
            blend: None,
            land: MapContours::default(),
            kept: Vec::new(),
            lacks_kept: false,
        }
    }

    /// The space.
    #[must_use]
    pub fn space(&self) -> &DesignSpace {
        &self.space
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &WeightMap {
        &self.map
    }

    /// The weights under the puck.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        self.frame.weights()
    }

    /// What lies on the map, once it was drawn.
    #[must_use]
    pub fn ground(&self) -> Option<&MapThumbnails> {
        self.ground.as_ref()
    }

    /// What is measured all over the map.
    #[must_use]
    pub fn land(&self) -> &MapContours {
        &self.land
    }

    /// The blend under the puck.
    #[must_use]
    pub fn blend(&self) -> Option<&Arc<RgbaImage>> {
        self.blend.as_ref().map(|blend| &blend.picture)
    }

    /// Whether its outlines were matched for it.
    #[must_use]
    pub fn is_matched(&self) -> bool {
        let designs = self.space.designs().iter();
        let mut forms = designs.map(|design| &design.form);
        self.space.family().is_some() && forms.any(|form| matches!(form, DesignForm::Outline(_)))
    }

    /// A place that is kept, in small.
    #[must_use]
    pub fn kept(&self, at: DVec2) -> Option<&Arc<RgbaImage>> {
        let found = self.kept.iter().find(|(place, _)| *place == at);
        found.map(|(_, picture)| picture)
    }

    /// Draws the places that are kept and not drawn yet; whether there were some.
    fn draw_kept(&mut self, places: &[SavedPlace], style: &TransitionStyle) -> bool {
        let Ok(size) = PixelSize::new(KEPT_PX, KEPT_PX) else {
            return false;
        };
        self.kept
            .retain(|(at, _)| places.iter().any(|kept| kept.at == *at));
        let before = self.kept.len();
        let mut weights = vec![0.0; self.space.designs().len()];
        self.lacks_kept = false;
        for place in places {
            if self.kept(place.at).is_none() {
                if self.kept.len() >= before + KEPT_AT_ONCE {
                    self.lacks_kept = true;
                    break;
                }
                self.map.weights(place.at, &mut weights);
                self.frame.seek(&weights);
                let picture = rasterise(&self.drawing(size, style, None));
                self.kept.push((place.at, Arc::new(picture)));
            }
        }
        let is_new = self.kept.len() > before;
        if is_new {
            // The frame is the puck's.
            self.blend = None;
        }
        is_new
    }

    /// The blend under the puck, over a ground or none.
    #[must_use]
    pub fn drawing(
        &self,
        size: PixelSize,
        style: &TransitionStyle,
        ground: Option<Rgb>,
    ) -> Drawing {
        let bounds = self.space.bounds();
        let view = PlaneView::fit(bounds.padded(0.04 * bounds.diameter()), size);
        let mut drawing = Drawing::new(size, ground);
        drawing.push_blend(&self.frame, style, &view);
        drawing
    }

    /// Draws the blend at a place, unless it is drawn so already; whether it was.
    pub fn look(&mut self, puck: DVec2, size: PixelSize, style: TransitionStyle) -> bool {
        let mut weights = vec![0.0; self.space.designs().len()];
        self.map.weights(puck, &mut weights);
        let of = (weights, size, style);
        if self.blend.as_ref().is_some_and(|blend| blend.of == of) {
            return false;
        }
        self.frame.seek(&of.0);
        let picture = Arc::new(rasterise(&self.drawing(size, &style, None)));
        self.blend = Some(BlendPicture { of, picture });
        true
    }

    /// It is being drawn, or measured.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.drawing.is_some() || self.lacks_kept || self.land.is_busy()
    }

    /// Has drawn what is not drawn yet, or otherwise: what lies on the map, the places that are
    /// kept, and, where no better map is to come, what lies under it. Whether something new is
    /// there.
    pub fn work(
        &mut self,
        style: TransitionStyle,
        kept: &[SavedPlace],
        shown: Option<MapMeasure>,
        is_final: bool,
    ) -> bool {
        let mut is_new = self.paint(style);
        is_new |= self.draw_kept(kept, &style);
        // First what is seen of all, then what is known of it.
        if is_final && self.ground.is_some() && self.drawing.is_none() {
            let ink = text_colour_on(Some(style.ground));
            is_new |= self.land.work((&self.space, &self.map), shown, ink);
        }
        is_new
    }

    /// Has the map drawn, where it is not drawn so; whether something new is there.
    fn paint(&mut self, style: TransitionStyle) -> bool {
        if let Some(answer) = BackgroundJob::take(&mut self.drawing) {
            // What cannot be drawn is not shown: the sites and the puck are.
            self.ground = answer.ok();
            return true;
        }
        if self.style == Some(style) {
            return false;
        }
        self.kept.clear();
        self.style = Some(style);
        let (space, map) = (self.space.clone(), self.map.clone());
        self.drawing = Some(BackgroundJob::start("the map", move |_| {
            draw_thumbnails(&space, &map, &style)
        }));
        false
    }
}
