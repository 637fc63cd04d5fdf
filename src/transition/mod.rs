//! Transitions: a warp and a content, built from two designs, and the frames
//! between them.
//!
//! Everything that can fail fails in [`Transition::build`]; a [`Frame`] then
//! moves to any t without allocating. A frame is unevaluated: a placement and
//! how the contents mix at t. The stage evaluates it on the GPU, export and
//! tests on the CPU through [`Frame::figure`], so that there is one way to a
//! frame and the two can be held against each other.

mod arrange;
mod boundaries;
mod build;
mod cells;
mod frame;
mod options;
mod outlines;
mod plane;
mod style;
mod timing;

#[cfg(test)]
mod tests;

pub use arrange::{Fit, arranged, arrangement};
pub use build::{BuildError, TransitionSpec};
pub use cells::{Cell, NoSuchCell};
pub use frame::{Figure, Frame};
pub use options::{Boundary, FieldOptions, Options};
pub use style::{NoColour, Rgb, Style};
pub use timing::{PlayMode, Stop, Timing, TimingError};

pub use crate::easing::Easing;

use crate::compatible::CompatibleMesh;
use crate::content::{ColourMix, ColourMixError, Content, FieldBlend, FieldPairError};
use crate::correspondence::{PointPair, RegionMatch};
use crate::design::Design;
use crate::geometry::Bounds;
use crate::progress::Progress;
use crate::warp::{Arap, Missed, Warp};
use std::sync::Arc;

/// A transition that is ready to be played. Cloning is cheap.
///
/// ```
/// use morphospace::design::{ImportOptions, import};
/// use morphospace::progress::Silent;
/// use morphospace::transition::{Transition, TransitionSpec};
/// use std::sync::Arc;
///
/// let read = |text: &str| import("t", text.as_bytes(), &ImportOptions::default()).map(Arc::new);
/// let source = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
/// let target = read("v 0 0 0\nv 0 2 0\nv -2 0 0\nf 1 2 3\n")?;
/// let transition = Transition::build(&TransitionSpec::new(source, target), &Silent)?;
/// let mut frame = transition.frame(0.0);
/// frame.seek(0.5);
/// assert_eq!(frame.figure().rings.len(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Transition(Arc<Inner>);

#[derive(Clone, Debug)]
struct Inner {
    cell: Cell,
    designs: [Arc<Design>; 2],
    warp: Arc<dyn Warp>,
    arap: Option<Arap>,
    matched: Option<RegionMatch>,
    automatic: Vec<PointPair>,
    content: Content,
    bounds: Bounds,
    bar_width: f64,
}

impl Transition {
    /// Builds the cell of the table that the specification names: imports
    /// nothing, decides everything.
    ///
    /// # Errors
    /// [`BuildError`] says what does not go together, or that the work was
    /// cancelled.
    pub fn build(spec: &TransitionSpec, progress: &dyn Progress) -> Result<Self, BuildError> {
        build::build(spec, progress).map(|inner| Self(Arc::new(inner)))
    }

    /// The same fields mixed in another way, without measuring them again;
    /// `None` where there are no fields.
    ///
    /// # Errors
    /// [`FieldPairError`] if ε or the threshold is out of range.
    pub fn with_blend(&self, blend: FieldBlend) -> Result<Option<Self>, FieldPairError> {
        let Content::Field(pair) = &self.0.content else {
            return Ok(None);
        };
        Ok(Some(
            self.with_content(Content::Field(pair.with_blend(blend)?)),
        ))
    }

    /// The same pictures mixed in another way, without decoding them again;
    /// `None` where there are no pictures.
    ///
    /// # Errors
    /// [`ColourMixError`] if the span of the mix is none.
    pub fn with_mix(&self, mix: ColourMix) -> Result<Option<Self>, ColourMixError> {
        let Content::Colours(pair) = &self.0.content else {
            return Ok(None);
        };
        Ok(Some(
            self.with_content(Content::Colours(pair.with_mix(mix)?)),
        ))
    }

    fn with_content(&self, content: Content) -> Self {
        Self(Arc::new(Inner {
            content,
            ..self.0.as_ref().clone()
        }))
    }

    /// A frame at `t`, with memory of its own. Outside [0, 1] it
    /// extrapolates; a `t` that is not finite counts as 0.
    #[must_use]
    pub fn frame(&self, t: f64) -> Frame {
        let mut frame = Frame::new(self.clone());
        frame.seek(t);
        frame
    }

    /// Row and column of the table.
    #[must_use]
    pub fn cell(&self) -> Cell {
        self.0.cell
    }

    /// What is seen.
    #[must_use]
    pub fn content(&self) -> &Content {
        &self.0.content
    }

    /// The rigidity-preserving interpolation, where that is the warp.
    #[must_use]
    pub fn arap(&self) -> Option<&Arap> {
        self.0.arap.as_ref()
    }

    /// Which point of one outline is which of the other, in the coordinates
    /// of the frame; none where the designs brought their match along or need
    /// none.
    #[must_use]
    pub fn matched(&self) -> Option<&RegionMatch> {
        self.0.matched.as_ref()
    }

    /// The pairs of points that a warp of the plane goes by where nobody set
    /// any, in the coordinates of the frame; of lines where each begins.
    #[must_use]
    pub fn automatic_pins(&self) -> &[PointPair] {
        &self.0.automatic
    }

    /// The features that the warp does not lead to where they belong at `t`;
    /// none where it meets all of them.
    #[must_use]
    pub fn missed(&self, t: f64) -> Option<Missed> {
        self.0.warp.missed(t)
    }

    /// The common triangulation, where there is one.
    #[must_use]
    pub fn compatible(&self) -> Option<&CompatibleMesh> {
        self.arap().map(Arap::mesh)
    }

    /// The box that holds every frame for t in [0, 1], nearly.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// The designs, laid into one frame: source and target.
    #[must_use]
    pub fn designs(&self) -> &[Arc<Design>; 2] {
        &self.0.designs
    }

    /// The source as it was given, for a ghost behind the frames.
    #[must_use]
    pub fn source_outline(&self) -> Figure {
        frame::ghost(&self.0.designs[0], self.0.bar_width)
    }

    /// The target as it was given.
    #[must_use]
    pub fn target_outline(&self) -> Figure {
        frame::ghost(&self.0.designs[1], self.0.bar_width)
    }
}
