//! A space of designs and its moments.

use super::design_distance::DesignDistances;
use super::error::SpaceNote;
use super::picture_space::PictureSpace;
use crate::compatible::CompatibleFamily;
use crate::content::{FieldSet, PictureRaster};
use crate::design::Design;
use crate::geometry::{Bounds, DVec2};
use crate::transition::{VectorFigure, colour_fraction};
use crate::warp::{ArapBlend, BlendPlacer};
use image::RgbaImage;
use std::sync::Arc;

/// Many designs, ready to be blended. Cloning is cheap.
///
/// ```
/// use morphospace::Design;
/// use morphospace::work::progress::Silent;
/// use morphospace::space::{Space, SpaceSpec};
/// use std::sync::Arc;
///
/// let tent = |h: f64| Design::of_rings("tent", [[[0.0, 0.0], [2.0, 0.0], [1.0, h]]]).map(Arc::new);
/// let designs = vec![tent(1.0)?, tent(2.0)?, tent(4.0)?];
/// let space = Space::build(&SpaceSpec::new(designs), &Silent)?;
/// let mut frame = space.frame();
/// frame.seek(&[0.5, 0.25, 0.25]);
/// assert_eq!(frame.figure().rings.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct DesignSpace(Arc<DesignSpaceData>);

/// What a space consists of.
#[derive(Debug)]
pub(super) struct DesignSpaceData {
    pub designs: Vec<Arc<Design>>,
    pub seen: BlendContent,
    pub bounds: Bounds,
    pub bar_width: f64,
    pub likeness: DesignDistances,
    pub notes: Vec<SpaceNote>,
}

/// What is seen of a blend.
#[derive(Debug)]
pub(super) enum BlendContent {
    /// Rigid parts.
    Solid {
        blend: ArapBlend,
        /// The walks around what is filled.
        walks: Vec<Vec<u32>>,
        /// Bars of trusses, by their nodes.
        bars: Vec<[u32; 2]>,
    },
    /// Distance fields.
    Field(FieldSet),
    /// Pictures.
    Colours(Box<PictureSpace>),
}

impl From<DesignSpaceData> for DesignSpace {
    fn from(inner: DesignSpaceData) -> Self {
        Self(Arc::new(inner))
    }
}

impl DesignSpace {
    /// The designs, laid into one frame.
    #[must_use]
    pub fn designs(&self) -> &[Arc<Design>] {
        &self.0.designs
    }

    /// The box that holds every blend with weights in [0, 1], nearly.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// The common mesh of the designs, where they are blended as rigid parts.
    #[must_use]
    pub fn family(&self) -> Option<&CompatibleFamily> {
        match &self.0.seen {
            BlendContent::Solid { blend, .. } => Some(blend.family()),
            BlendContent::Field(_) | BlendContent::Colours(_) => None,
        }
    }

    /// How unlike the designs are.
    #[must_use]
    pub fn likeness(&self) -> &DesignDistances {
        &self.0.likeness
    }

    /// Whether pictures are what is seen of it.
    #[must_use]
    pub fn is_of_pictures(&self) -> bool {
        matches!(self.0.seen, BlendContent::Colours(_))
    }

    /// What is seen of it.
    pub(super) fn seen(&self) -> &BlendContent {
        &self.0.seen
    }

    /// Width of the bars of trusses, in units of the designs.
    pub(super) fn bar_width(&self) -> f64 {
        self.0.bar_width
    }

    /// What was done otherwise than asked.
    #[must_use]
    pub fn notes(&self) -> &[SpaceNote] {
        &self.0.notes
    }

    /// Where between the first colour of a style and its second one a blend is: designs
    /// have colours from the one to the other, in their order.
    #[must_use]
    pub fn tint(&self, weights: &[f64]) -> f64 {
        let last = self.0.designs.len().saturating_sub(1);
        let each = weights.iter().enumerate();
        each.map(|(k, weight)| weight * colour_fraction(k as f64, (last, false)))
            .sum()
    }

    /// A frame at the first design, with memory of its own.
    #[must_use]
    pub fn frame(&self) -> SpaceFrame {
        let mut weights = vec![0.0; self.0.designs.len()];
        weights[0] = 1.0;
        let placer = match &self.0.seen {
            BlendContent::Solid { blend, .. } => Some(blend.placer()),
            BlendContent::Field(_) | BlendContent::Colours(_) => None,
        };
        SpaceFrame {
            space: self.clone(),
            placer,
            weights,
        }
    }
}

/// One blend of a space.
#[derive(Debug)]
pub struct SpaceFrame {
    space: DesignSpace,
    /// Of rigid parts.
    placer: Option<BlendPlacer>,
    weights: Vec<f64>,
}

impl SpaceFrame {
    /// Moves to these weights, one for each design, which sum to one: what they lack is
    /// shared out evenly, and those that are not finite count as 0. Outside [0, 1] they
    /// extrapolate. Allocates nothing.
    ///
    /// # Panics
    /// If there are not as many weights as designs.
    pub fn seek(&mut self, weights: &[f64]) {
        assert_eq!(
            weights.len(),
            self.weights.len(),
            "a weight for each design"
        );
        let finite = |&w: &f64| if w.is_finite() { w } else { 0.0 };
        let sum: f64 = weights.iter().map(finite).sum();
        let lack = (1.0 - sum) / weights.len() as f64;
        for (own, weight) in self.weights.iter_mut().zip(weights) {
            // What is off by rounding alone must not move a design from its corner.
            *own = finite(weight) + if lack.abs() < 1e-12 { 0.0 } else { lack };
        }
        if let Some(placer) = &mut self.placer {
            placer.place(&self.weights);
        }
    }

    /// The weights.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Whether a weight is outside [0, 1].
    #[must_use]
    pub fn is_extrapolated(&self) -> bool {
        self.weights.iter().any(|w| !(0.0..=1.0).contains(w))
    }

    /// Where the vertices of the common mesh are; none of fields.
    #[must_use]
    pub fn places(&self) -> Option<&[DVec2]> {
        self.placer.as_ref().map(BlendPlacer::places)
    }

    /// The space that this is a blend of.
    #[must_use]
    pub fn space(&self) -> &DesignSpace {
        &self.space
    }

    /// The blend as pixels, where pictures are what is seen: sRGB with straight alpha.
    #[must_use]
    pub fn picture(&self, raster: &PictureRaster) -> Option<RgbaImage> {
        match &self.space.0.seen {
            BlendContent::Colours(pictures) => Some(pictures.render(&self.weights, raster)),
            BlendContent::Solid { .. } | BlendContent::Field(_) => None,
        }
    }

    /// The box around what pictures fill; none of others.
    #[must_use]
    pub fn window(&self) -> Option<Bounds> {
        match &self.space.0.seen {
            BlendContent::Colours(pictures) => Some(pictures.set.window(&self.weights)),
            BlendContent::Solid { .. } | BlendContent::Field(_) => None,
        }
    }

    /// The blend as polygons and bars; of pictures nothing.
    #[must_use]
    pub fn figure(&self) -> VectorFigure {
        let bar_width = self.space.0.bar_width;
        match (&self.space.0.seen, self.places()) {
            (BlendContent::Solid { walks, bars, .. }, Some(places)) => VectorFigure {
                rings: walks
                    .iter()
                    .map(|walk| walk.iter().map(|&v| places[v as usize]).collect())
                    .collect(),
                bars: bars
                    .iter()
                    .map(|bar| bar.map(|v| places[v as usize]))
                    .collect(),
                bar_width,
                ..VectorFigure::default()
            },
            (BlendContent::Field(fields), _) => VectorFigure {
                rings: fields.contour(&self.weights),
                ..VectorFigure::default()
            },
            (BlendContent::Colours(_), _) => VectorFigure::default(),
            (BlendContent::Solid { .. }, None) => unreachable!("rigid parts are placed"),
        }
    }
}
