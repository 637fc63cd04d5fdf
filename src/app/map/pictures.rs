//! Computes and stores the images for the map of a space of designs: thumbnails, contours, saved
//! blends and the blend under the marker. `app::ui::stage::map` shows them on the screen, with the
//! marker and the path.

use std::sync::Arc;

use image::RgbaImage;

use crate::app::jobs::job::BackgroundJob;
use crate::app::map::contours::MapContours;
use crate::app::map::thumbnails::{MapThumbnails, draw_thumbnails};
use crate::colour::Rgb;
use crate::design::DesignForm;
use crate::export::{
    Drawing, PixelSize, PixelSizeError, PlaneView, SpaceColours, rasterise, text_colour_on,
};
use crate::geometry::DVec2;
use crate::measure::MapMeasure;
use crate::project::SavedBlend;
use crate::space::{DesignSpace, SpaceFrame, WeightMap};
use crate::transition::TransitionStyle;

/// Side of a saved blend's thumbnail, in pixels (heuristic).
const SAVED_BLEND_PX: u32 = 96;

/// Maximum number of saved blends whose thumbnails are drawn in one screen update (resource limit:
/// a blend of distance fields takes some milliseconds).
const SAVED_BLENDS_PER_FRAME: usize = 4;

/// A space of designs, its map, and the images that are shown on and next to the map.
#[derive(Debug)]
pub struct MapPictures {
    space: DesignSpace,
    map: WeightMap,
    frame: SpaceFrame,
    /// Thumbnails of blends and designs.
    thumbnails: Option<MapThumbnails>,
    drawing: Option<BackgroundJob<DrawnMap, PixelSizeError>>,
    /// Colours with which the thumbnails were drawn or are being drawn.
    style: Option<TransitionStyle>,
    /// The designs' own colours, if they have any.
    colours: Option<Arc<SpaceColours>>,
    /// The blend under the marker.
    blend: Option<BlendPicture>,
    /// Contours of a measure over the map.
    contours: MapContours,
    /// Thumbnails of the saved blends, each with the place of its blend on the map.
    saved_blends: Vec<(DVec2, Arc<RgbaImage>)>,
    /// Whether some saved blends have no thumbnail yet.
    lacks_saved_blends: bool,
}

/// Thumbnails, and the designs' own colours if they have any.
type DrawnMap = (MapThumbnails, Option<Arc<SpaceColours>>);

/// The blend under the marker as drawn last.
#[derive(Debug)]
struct BlendPicture {
    key: (Vec<f64>, PixelSize, TransitionStyle),
    picture: Arc<RgbaImage>,
}

impl MapPictures {
    /// A map without images, except for the `thumbnails` of the previous map, if any.
    #[must_use]
    pub fn new(space: DesignSpace, map: WeightMap, thumbnails: Option<MapThumbnails>) -> Self {
        Self {
            map,
            frame: space.frame(),
            space,
            thumbnails,
            drawing: None,
            style: None,
            colours: None,
            blend: None,
            contours: MapContours::default(),
            saved_blends: Vec::new(),
            lacks_saved_blends: false,
        }
    }

    /// The space whose blends the map shows.
    #[must_use]
    pub fn space(&self) -> &DesignSpace {
        &self.space
    }

    /// Layout of the designs on the map.
    #[must_use]
    pub fn map(&self) -> &WeightMap {
        &self.map
    }

    /// Weights of the designs in the blend drawn last.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        self.frame.weights()
    }

    /// Thumbnails of blends and designs, once they are drawn.
    #[must_use]
    pub fn thumbnails(&self) -> Option<&MapThumbnails> {
        self.thumbnails.as_ref()
    }

    /// Contours of a measure over the map.
    #[must_use]
    pub fn contours(&self) -> &MapContours {
        &self.contours
    }

    /// Mean of a design's own colours; `None` if no design has any.
    #[must_use]
    pub fn own_colour(&self, design: usize) -> Option<Rgb> {
        self.colours.as_ref()?.mean_of(design)
    }

    /// Image of the blend under the marker; `None` until it is drawn.
    #[must_use]
    pub fn blend(&self) -> Option<&Arc<RgbaImage>> {
        self.blend.as_ref().map(|blend| &blend.picture)
    }

    /// Whether the designs were matched automatically for this space.
    #[must_use]
    pub fn is_matched(&self) -> bool {
        let designs = self.space.designs().iter();
        let mut forms = designs.map(|design| &design.form);
        self.space.family().is_some() && forms.any(|form| matches!(form, DesignForm::Outline(_)))
    }

    /// Thumbnail of the saved blend at this place on the map; `None` until it is drawn.
    #[must_use]
    pub fn saved_blend(&self, at: DVec2) -> Option<&Arc<RgbaImage>> {
        let saved = self.saved_blends.iter().find(|(place, _)| *place == at);
        saved.map(|(_, thumbnail)| thumbnail)
    }

    /// Draws thumbnails of saved blends that lack one; returns whether it drew any.
    fn draw_saved_blends(&mut self, places: &[SavedBlend], style: &TransitionStyle) -> bool {
        let Ok(size) = PixelSize::new(SAVED_BLEND_PX, SAVED_BLEND_PX) else {
            return false;
        };
        self.saved_blends
            .retain(|(at, _)| places.iter().any(|place| place.at == *at));
        let before = self.saved_blends.len();
        let mut weights = vec![0.0; self.space.designs().len()];
        self.lacks_saved_blends = false;
        for place in places {
            if self.saved_blend(place.at).is_none() {
                if self.saved_blends.len() >= before + SAVED_BLENDS_PER_FRAME {
                    self.lacks_saved_blends = true;
                    break;
                }
                self.map.weights(place.at, &mut weights);
                self.frame.seek(&weights);
                let picture = self.image(size, style, None);
                self.saved_blends.push((place.at, Arc::new(picture)));
            }
        }
        let is_new = self.saved_blends.len() > before;
        if is_new {
            // `frame` no longer holds the blend under the marker, which must be drawn again.
            self.blend = None;
        }
        is_new
    }

    /// Vector drawing of the blend with the current [`Self::weights`], on the colour `background`;
    /// if `background` is `None`, the drawing is transparent.
    #[must_use]
    pub fn drawing(
        &self,
        size: PixelSize,
        style: &TransitionStyle,
        background: Option<Rgb>,
    ) -> Drawing {
        let view = self.view(size);
        let mut drawing = Drawing::new(size, background);
        drawing.push_blend(&self.frame, style, &view);
        drawing
    }

    /// Image of the blend with the current [`Self::weights`], in the designs' own colours if they
    /// have any, on the colour `background`; transparent if that is `None`.
    #[must_use]
    pub fn image(
        &self,
        size: PixelSize,
        style: &TransitionStyle,
        background: Option<Rgb>,
    ) -> RgbaImage {
        let Some(colours) = &self.colours else {
            return rasterise(&self.drawing(size, style, background));
        };
        let mut drawing = Drawing::new(size, background);
        drawing.push_painted_blend(&self.frame, colours, &self.view(size));
        rasterise(&drawing)
    }

    /// View that shows every blend in an image of this size.
    fn view(&self, size: PixelSize) -> PlaneView {
        let bounds = self.space.bounds();
        PlaneView::fit(bounds.padded(0.04 * bounds.diameter()), size)
    }

    /// Draws the blend at the marker unless the current image shows it; returns whether it drew.
    pub fn draw_blend(&mut self, marker: DVec2, size: PixelSize, style: TransitionStyle) -> bool {
        let mut weights = vec![0.0; self.space.designs().len()];
        self.map.weights(marker, &mut weights);
        let key = (weights, size, style);
        if self.blend.as_ref().is_some_and(|blend| blend.key == key) {
            return false;
        }
        self.frame.seek(&key.0);
        let picture = Arc::new(self.image(size, &style, None));
        self.blend = Some(BlendPicture { key, picture });
        true
    }

    /// Whether something is still being drawn or measured.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.drawing.is_some() || self.lacks_saved_blends || self.contours.is_busy()
    }

    /// Draws whatever is missing or outdated: thumbnails, saved blends and, if no better map is
    /// still being built (`is_final`), contours. Returns whether something is new.
    pub fn update(
        &mut self,
        style: TransitionStyle,
        saved_places: &[SavedBlend],
        shown: Option<MapMeasure>,
        is_final: bool,
    ) -> bool {
        let mut is_new = self.update_thumbnails(style);
        is_new |= self.draw_saved_blends(saved_places, &style);
        // Contours are drawn only after all thumbnails.
        if is_final && self.thumbnails.is_some() && self.drawing.is_none() {
            let ink = text_colour_on(Some(style.ground));
            is_new |= self.contours.update(&self.space, &self.map, shown, ink);
        }
        is_new
    }

    /// Starts or finishes drawing the thumbnails; returns whether they are new.
    fn update_thumbnails(&mut self, style: TransitionStyle) -> bool {
        if let Some(thumbnails) = BackgroundJob::take_result(&mut self.drawing) {
            // If thumbnails fail, the map still shows the designs' places and the marker.
            let thumbnails = thumbnails.ok();
            if let Some((_, colours)) = &thumbnails
                && colours.is_some()
            {
                self.colours.clone_from(colours);
                // The blend and the saved blends are drawn again in their colours.
                self.blend = None;
                self.saved_blends.clear();
            }
            self.thumbnails = thumbnails.map(|(thumbnails, _)| thumbnails);
            return true;
        }
        if self.style == Some(style) {
            return false;
        }
        self.saved_blends.clear();
        self.style = Some(style);
        let (space, map) = (self.space.clone(), self.map.clone());
        self.drawing = Some(BackgroundJob::start("the map", move |_| {
            let colours = SpaceColours::new(&space, &style).map(Arc::new);
            let thumbnails = draw_thumbnails(&space, &map, &style, colours.as_deref())?;
            Ok((thumbnails, colours))
        }));
        false
    }
}
