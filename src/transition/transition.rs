//! The type of a built transition, and access to its data.

use super::any_warp::{AnyWarp, BuiltWarp};
use super::cached_match::CachedMatch;
use super::method::TransitionMethod;
use super::note::TransitionNote;
use super::paint_layer_options::PaintLayerOptions;
use super::part_time::PartTime;
use crate::compatible::CompatibleMesh;
use crate::content::{Content, FieldBlend, FieldBlendError};
use crate::correspondence::{PointPair, RegionMatch};
use crate::design::Design;
use crate::geometry::Bounds;
use crate::recording::{Recording, RecordingError};
use crate::warp::{Arap, MissedFeatures, Placer, Warp};
use std::sync::{Arc, OnceLock, Weak};

/// A transition that is ready to be played. Cloning is cheap.
///
/// ```
/// use morphospace::design::{ImportOptions, import};
/// use morphospace::work::progress::Silent;
/// use morphospace::transition::{Transition, TransitionSpec};
/// use std::sync::{Arc, OnceLock};
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
pub struct Transition(Arc<TransitionData>);

/// The recording of a warp, or the reason why there is none; empty until a recording has been
/// requested. Shared by all transitions that share the warp.
pub(super) type RecordingSlot = Arc<OnceLock<Result<Recording, RecordingError>>>;

/// The shared data of a transition.
#[derive(Clone, Debug)]
pub(super) struct TransitionData {
    /// The method.
    pub method: TransitionMethod,
    /// Source and target, placed in the common frame.
    pub designs: [Arc<Design>; 2],
    /// The warp, with the match and the solved motion from which it was built.
    pub built_warp: BuiltWarp,
    pub content: Content,
    /// Box around all frames for t in [0, 1], found by sampling.
    pub bounds: Bounds,
    /// Width of truss bars in units of the designs.
    pub bar_width: f64,
    /// The recording of the warp, if it has been requested.
    pub recording: RecordingSlot,
}

/// Identifies a transition without keeping it alive.
#[derive(Clone, Debug)]
pub struct TransitionId(Weak<TransitionData>);

impl TransitionId {
    /// Returns whether this identifies `transition` or a clone of it.
    #[must_use]
    pub fn is_of(&self, transition: &Transition) -> bool {
        std::ptr::eq(self.0.as_ptr(), Arc::as_ptr(&transition.0))
    }

    /// Returns whether the transition no longer exists.
    #[must_use]
    pub fn is_dropped(&self) -> bool {
        self.0.strong_count() == 0
    }
}

impl From<TransitionData> for Transition {
    fn from(inner: TransitionData) -> Self {
        Self(Arc::new(inner))
    }
}

impl Transition {
    /// Returns whether two transitions are clones of each other. The data is not compared.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Returns the identity of the transition.
    #[must_use]
    pub fn id(&self) -> TransitionId {
        TransitionId(Arc::downgrade(&self.0))
    }

    /// Returns a transition of the same distance fields with another blend, without computing them
    /// again; `None` unless the content is the fields of two designs.
    ///
    /// # Errors
    /// [`FieldBlendError`] if ε or the threshold is out of range.
    pub fn with_blend(&self, blend: FieldBlend) -> Result<Option<Self>, FieldBlendError> {
        let Content::Field(fields) = &self.0.content else {
            return Ok(None);
        };
        let mixed = fields.with_blend(blend)?;
        Ok(mixed.map(|fields| {
            Self::from(TransitionData {
                content: Content::Field(fields),
                ..self.0.as_ref().clone()
            })
        }))
    }

    /// Returns the same transition with the given part timings instead of the previous ones. The
    /// points of the timings are in the coordinates of the common frame.
    #[must_use]
    pub fn with_part_times(&self, times: &[PartTime]) -> Self {
        Self::from(self.0.as_ref().clone().with_part_times(times))
    }

    /// Returns the same transition with the given options for its paint layers.
    #[must_use]
    pub fn with_paint_layers(&self, options: &PaintLayerOptions) -> Self {
        Self::from(self.0.as_ref().clone().with_paint_layers(options))
    }

    /// Returns the method: warp and content.
    #[must_use]
    pub fn method(&self) -> TransitionMethod {
        self.0.method
    }

    /// Returns the visible content.
    #[must_use]
    pub fn content(&self) -> &Content {
        &self.0.content
    }

    /// Returns every t at which a part starts, stops or abruptly changes its speed. Between these
    /// times every point moves smoothly. The list is unsorted and may include 0 and 1.
    #[must_use]
    pub fn break_times(&self) -> Vec<f64> {
        self.warp().break_times()
    }

    /// Returns the warp.
    pub(super) fn warp(&self) -> &dyn Warp {
        self.0.built_warp.warp.as_warp()
    }

    /// Returns the warp as an [`Arc`], so that a recording can own it.
    pub(super) fn shared_warp(&self) -> Arc<dyn Warp> {
        self.0.built_warp.warp.to_shared()
    }

    /// Returns the cell that holds the recording once it has been requested.
    pub(super) fn recording_slot(&self) -> &RecordingSlot {
        &self.0.recording
    }

    /// Returns the rigidity-preserving interpolation of solid designs, or of the plane that carries
    /// distance fields or pictures; `None` for other warps. If the plane also rotates as a whole,
    /// the interpolation is relative to that rigid motion.
    #[must_use]
    pub fn arap(&self) -> Option<&Arap> {
        self.0.built_warp.warp.arap()
    }

    /// Returns a placer for another interpolation of the same mesh, with the part timings of this
    /// transition.
    pub(crate) fn placer_for(&self, arap: &Arap) -> Placer {
        match &self.0.built_warp.warp {
            AnyWarp::Staggered(warp) => warp.with_arap(arap.clone()).placer(),
            _ => arap.placer(),
        }
    }

    /// Returns a placer as [`Self::placer_for`] does, but `arap` interpolates the exchanged
    /// designs, and the part timings run backwards.
    pub(crate) fn reversed_placer_for(&self, arap: &Arap) -> Placer {
        match &self.0.built_warp.warp {
            AnyWarp::Staggered(warp) => warp.backwards(arap.clone()).placer(),
            _ => arap.placer(),
        }
    }

    /// Returns the t at which a vertex is evaluated when the transition is at `t`. The two differ
    /// only if the part of the vertex has its own timing.
    pub(crate) fn part_time_at(&self, vertex: u32, t: f64) -> f64 {
        match &self.0.built_warp.warp {
            AnyWarp::Staggered(warp) => warp.clock(vertex).part_time(t),
            _ => t,
        }
    }

    /// Returns the deviations from the request and the suggestions, in the order in which they
    /// arose.
    #[must_use]
    pub fn notes(&self) -> &[TransitionNote] {
        &self.0.built_warp.notes
    }

    /// Returns the correspondence between the outlines of both designs, in the coordinates of the
    /// common frame; `None` if the designs share a mesh or no match was needed.
    #[must_use]
    pub fn matched(&self) -> Option<&RegionMatch> {
        self.0.built_warp.matched.as_ref()
    }

    /// Returns the match in a form that a document can cache; `None` if nothing had to be matched.
    #[must_use]
    pub fn cached_match(&self) -> Option<CachedMatch> {
        self.0
            .built_warp
            .solution
            .as_ref()
            .map(|kept| kept.cached_match())
    }

    /// Returns the automatic pins of a plane warp, in the coordinates of the common frame; for
    /// lines, their starting points. Empty if the user has set pins or lines.
    #[must_use]
    pub fn automatic_pins(&self) -> &[PointPair] {
        &self.0.built_warp.automatic_pins
    }

    /// Returns a summary of the pins and lines whose positions in the designs the warp reproduces
    /// only inaccurately at `t`; `None` if there are none.
    #[must_use]
    pub fn missed_features(&self, t: f64) -> Option<MissedFeatures> {
        self.warp().missed_features(t)
    }

    /// Returns the common triangulation of solid designs, if they have one. For distance fields and
    /// pictures, [`Self::arap`] gives access to the mesh of the plane that moves them.
    #[must_use]
    pub fn compatible(&self) -> Option<&CompatibleMesh> {
        match (self.content(), &self.0.built_warp.warp) {
            (Content::Solid(_), AnyWarp::Blend(warp)) => Some(warp.mesh()),
            (Content::Solid(_), _) => self.arap().map(Arap::mesh),
            (Content::Field(_) | Content::Colours(_), _) => None,
        }
    }

    /// Returns a box around every frame for t in [0, 1]. Approximate: frames are sampled.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.0.bounds
    }

    /// Returns source and target, placed in the common frame.
    #[must_use]
    pub fn designs(&self) -> &[Arc<Design>; 2] {
        &self.0.designs
    }

    /// Returns the width of truss bars in units of the designs.
    pub(super) fn bar_width(&self) -> f64 {
        self.0.bar_width
    }
}
