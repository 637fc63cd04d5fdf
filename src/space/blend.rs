//! Blends of a built design space: the space, which is prepared for blending its designs with any
//! weights, and its frames, each of which shows one blend.

use super::design_distance::DesignDistances;
use super::error::SpaceNote;
use super::picture_space::PictureSpace;
use crate::compatible::CompatibleFamily;
use crate::content::{FieldSet, PictureRaster};
use crate::design::Design;
use crate::geometry::{Bounds, DVec2};
use crate::transition::{SequenceLayout, VectorFigure, colour_fraction};
use crate::warp::{ArapBlend, BlendPlacer};
use image::RgbaImage;
use std::sync::Arc;

/// Several designs that are prepared for blending with any weights. Cloning is cheap.
///
/// ```
/// use morphospace::Design;
/// use morphospace::work::progress::Silent;
/// use morphospace::space::{DesignSpace, SpaceSpec};
/// use std::sync::Arc;
///
/// let tent = |h: f64| {
///     Design::from_rings("tent", [[[0.0, 0.0], [2.0, 0.0], [1.0, h]]]).map(Arc::new)
/// };
/// let designs = vec![tent(1.0)?, tent(2.0)?, tent(4.0)?];
/// let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent)?;
/// let mut frame = space.frame();
/// frame.seek(&[0.5, 0.25, 0.25]);
/// assert_eq!(frame.figure().rings.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct DesignSpace(Arc<DesignSpaceData>);

/// Shared data of a [`DesignSpace`].
#[derive(Debug)]
pub(super) struct DesignSpaceData {
    pub designs: Vec<Arc<Design>>,
    pub content: BlendContent,
    pub bounds: Bounds,
    pub bar_width: f64,
    pub distances: DesignDistances,
    pub notes: Vec<SpaceNote>,
}

/// Prepared designs of a space, by the kind of content.
#[derive(Debug)]
pub(super) enum BlendContent {
    /// Rigid parts.
    Solid {
        blend: ArapBlend,
        /// Boundary loops of the filled area, as vertex indices.
        boundary_loops: Vec<Vec<u32>>,
        /// Bars of trusses, as pairs of vertex indices.
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
    /// Returns the designs, placed in one frame.
    #[must_use]
    pub fn designs(&self) -> &[Arc<Design>] {
        &self.0.designs
    }

    /// Returns a box that contains nearly every blend with weights in [0, 1].
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// Returns the common mesh of the designs if they are blended as rigid parts.
    #[must_use]
    pub fn family(&self) -> Option<&CompatibleFamily> {
        match &self.0.content {
            BlendContent::Solid { blend, .. } => Some(blend.family()),
            BlendContent::Field(_) | BlendContent::Colours(_) => None,
        }
    }

    /// Returns the dissimilarities of the designs.
    #[must_use]
    pub fn distances(&self) -> &DesignDistances {
        &self.0.distances
    }

    /// Returns whether the designs are blended as pictures.
    #[must_use]
    pub fn is_of_pictures(&self) -> bool {
        matches!(self.0.content, BlendContent::Colours(_))
    }

    /// Returns the content that is blended.
    pub(super) fn content(&self) -> &BlendContent {
        &self.0.content
    }

    /// Returns the width of the bars of trusses, in design units.
    pub(super) fn bar_width(&self) -> f64 {
        self.0.bar_width
    }

    /// Returns the notes on what was done differently from what was requested.
    #[must_use]
    pub fn notes(&self) -> &[SpaceNote] {
        &self.0.notes
    }

    /// Returns the position of a blend's colour between the first (0) and the second (1) colour of
    /// the style.
    ///
    /// The first design has the first colour and the last design the second. The colours of the
    /// designs between them are evenly spaced.
    #[must_use]
    pub fn colour_fraction(&self, weights: &[f64]) -> f64 {
        let layout = SequenceLayout {
            segment_count: self.0.designs.len().saturating_sub(1),
            is_closed: false,
        };
        let each = weights.iter().enumerate();
        each.map(|(k, weight)| weight * colour_fraction(k as f64, layout))
            .sum()
    }

    /// Creates a frame at the first design. Each frame has its own memory.
    #[must_use]
    pub fn frame(&self) -> SpaceFrame {
        let mut weights = vec![0.0; self.0.designs.len()];
        weights[0] = 1.0;
        let placer = match &self.0.content {
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

/// One blend of a design space. A frame can be moved to any other blend.
#[derive(Debug)]
pub struct SpaceFrame {
    space: DesignSpace,
    /// Evaluator of rigid parts; `None` for other content.
    placer: Option<BlendPlacer>,
    weights: Vec<f64>,
}

impl SpaceFrame {
    /// Moves the frame to the given weights, one per design, without allocating.
    ///
    /// Weights that are not finite count as 0. If the sum is not one, the difference is distributed
    /// evenly over all weights. Weights outside [0, 1] extrapolate.
    ///
    /// # Panics
    /// If the number of weights differs from that of the designs.
    pub fn seek(&mut self, weights: &[f64]) {
        assert_eq!(
            weights.len(),
            self.weights.len(),
            "a weight for each design"
        );
        let finite = |&w: &f64| if w.is_finite() { w } else { 0.0 };
        let sum: f64 = weights.iter().map(finite).sum();
        let correction = (1.0 - sum) / weights.len() as f64;
        for (corrected, weight) in self.weights.iter_mut().zip(weights) {
            // A rounding error of the sum is not corrected, so that weight 1 on a design shows
            // exactly that design.
            *corrected = finite(weight)
                + if correction.abs() < 1e-12 {
                    0.0
                } else {
                    correction
                };
        }
        if let Some(placer) = &mut self.placer {
            placer.place(&self.weights);
        }
    }

    /// Returns the current weights, which sum to one.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Returns whether a weight is outside [0, 1].
    #[must_use]
    pub fn is_extrapolated(&self) -> bool {
        self.weights.iter().any(|w| !(0.0..=1.0).contains(w))
    }

    /// Returns the vertex positions of the common mesh; `None` if there is no common mesh.
    #[must_use]
    pub fn places(&self) -> Option<&[DVec2]> {
        self.placer.as_ref().map(BlendPlacer::places)
    }

    /// Returns the space to which this frame belongs.
    #[must_use]
    pub fn space(&self) -> &DesignSpace {
        &self.space
    }

    /// Renders the blend of pictures, in sRGB with straight alpha; `None` for other content.
    #[must_use]
    pub fn picture(&self, raster: &PictureRaster) -> Option<RgbaImage> {
        match &self.space.0.content {
            BlendContent::Colours(pictures) => Some(pictures.render(&self.weights, raster)),
            BlendContent::Solid { .. } | BlendContent::Field(_) => None,
        }
    }

    /// Returns the rectangle to which the blended pictures are cropped: the mean of their bounding
    /// boxes, weighted as the pictures; `None` for other content.
    #[must_use]
    pub fn window(&self) -> Option<Bounds> {
        match &self.space.0.content {
            BlendContent::Colours(pictures) => Some(pictures.set.window(&self.weights)),
            BlendContent::Solid { .. } | BlendContent::Field(_) => None,
        }
    }

    /// Returns the blend as polygons and bars; empty for pictures.
    #[must_use]
    pub fn figure(&self) -> VectorFigure {
        let bar_width = self.space.0.bar_width;
        match (&self.space.0.content, self.places()) {
            (
                BlendContent::Solid {
                    boundary_loops,
                    bars,
                    ..
                },
                Some(places),
            ) => VectorFigure {
                rings: boundary_loops
                    .iter()
                    .map(|boundary_loop| {
                        boundary_loop.iter().map(|&v| places[v as usize]).collect()
                    })
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
