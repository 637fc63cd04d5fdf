//! A transition that is ready to be played.

use super::any_warp::{AnyWarp, BuiltWarp};
use super::cached_match::CachedMatch;
use super::method::TransitionMethod;
use super::note::TransitionNote;
use super::paint_layer_options::PaintLayerOptions;
use super::part_time::PartTime;
use crate::compatible::CompatibleMesh;
use crate::content::{Content, FieldBlend, FieldPairError};
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

/// Where the film of a warp will be, for all transitions that share the warp; or why
/// there is none.
pub(super) type RecordingSlot = Arc<OnceLock<Result<Recording, RecordingError>>>;

/// What a transition consists of.
#[derive(Clone, Debug)]
pub(super) struct TransitionData {
    pub cell: TransitionMethod,
    pub designs: [Arc<Design>; 2],
    pub moved: BuiltWarp,
    pub content: Content,
    pub bounds: Bounds,
    /// Width of the bars of trusses, in units of the designs.
    pub bar_width: f64,
    /// The film of `moved`, once it was recorded.
    pub film: RecordingSlot,
}

/// Which transition something was found out about, without keeping it.
#[derive(Clone, Debug)]
pub struct TransitionId(Weak<TransitionData>);

impl TransitionId {
    /// Whether it is of this one, or of a clone of it.
    #[must_use]
    pub fn is_of(&self, transition: &Transition) -> bool {
        std::ptr::eq(self.0.as_ptr(), Arc::as_ptr(&transition.0))
    }

    /// Nobody has that transition any more.
    #[must_use]
    pub fn is_gone(&self) -> bool {
        self.0.strong_count() == 0
    }
}

impl From<TransitionData> for Transition {
    fn from(inner: TransitionData) -> Self {
        Self(Arc::new(inner))
    }
}

impl Transition {
    /// Whether they are clones of each other. What they consist of is not compared.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Which one it is.
    #[must_use]
    pub fn id(&self) -> TransitionId {
        TransitionId(Arc::downgrade(&self.0))
    }

    /// The same fields mixed in another way, without measuring them again;
    /// `None` where there are no fields, or those of many designs in turn.
    ///
    /// # Errors
    /// [`FieldPairError`] if ε or the threshold is out of range.
    pub fn with_blend(&self, blend: FieldBlend) -> Result<Option<Self>, FieldPairError> {
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

    /// The same film, in which parts have these times of their own and no others,
    /// their places in the coordinates of the frame.
    #[must_use]
    pub fn with_part_times(&self, times: &[PartTime]) -> Self {
        Self::from(self.0.as_ref().clone().timed(times))
    }

    /// The same film with its coats as these options ask for.
    #[must_use]
    pub fn with_coats(&self, options: &PaintLayerOptions) -> Self {
        Self::from(self.0.as_ref().clone().coated(options))
    }

    /// Row and column of the table.
    #[must_use]
    pub fn cell(&self) -> TransitionMethod {
        self.0.cell
    }

    /// What is seen.
    #[must_use]
    pub fn content(&self) -> &Content {
        &self.0.content
    }

    /// The t within (0, 1) at which something sets out, arrives or changes its pace:
    /// between them every point moves smoothly. In no order.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        self.warp().breaks()
    }

    /// Where each point is at t.
    pub(super) fn warp(&self) -> &dyn Warp {
        self.0.moved.warp.as_warp()
    }

    /// The same, for a film to keep.
    pub(super) fn shared_warp(&self) -> Arc<dyn Warp> {
        self.0.moved.warp.shared()
    }

    /// Where the film is, once it was recorded.
    pub(super) fn slot(&self) -> &RecordingSlot {
        &self.0.film
    }

    /// The rigidity-preserving interpolation, where that is the warp: of
    /// solids, or of the frame that carries fields or pictures. Where the
    /// frame turns as a whole, it is the interpolation of what is left, at
    /// rest.
    #[must_use]
    pub fn arap(&self) -> Option<&Arap> {
        self.0.moved.warp.arap()
    }

    /// How another film of the same mesh is played: its parts in the times that
    /// those of this one have.
    pub(crate) fn placer_of(&self, film: &Arap) -> Placer {
        match &self.0.moved.warp {
            AnyWarp::Staggered(warp) => warp.of(film.clone()).placer(),
            _ => film.placer(),
        }
    }

    /// As [`Self::placer_of`], of the film of the exchanged designs.
    pub(crate) fn placer_backwards(&self, film: &Arap) -> Placer {
        match &self.0.moved.warp {
            AnyWarp::Staggered(warp) => warp.backwards(film.clone()).placer(),
            _ => film.placer(),
        }
    }

    /// The time that a vertex of rigid parts shows at `t`.
    pub(crate) fn time_of(&self, vertex: u32, t: f64) -> f64 {
        match &self.0.moved.warp {
            AnyWarp::Staggered(warp) => warp.clock(vertex).at(t),
            _ => t,
        }
    }

    /// What was done otherwise than asked while it was built, in that order.
    #[must_use]
    pub fn notes(&self) -> &[TransitionNote] {
        &self.0.moved.notes
    }

    /// Which point of one outline is which of the other, in the coordinates
    /// of the frame; none where the designs brought their match along or need
    /// none.
    #[must_use]
    pub fn matched(&self) -> Option<&RegionMatch> {
        self.0.moved.matched.as_ref()
    }

    /// What was found for the designs, to be kept with a document; none where
    /// nothing had to be looked for.
    #[must_use]
    pub fn found(&self) -> Option<CachedMatch> {
        self.0.moved.kept.as_ref().map(|kept| kept.packed())
    }

    /// The pairs of points that a warp of the plane goes by where nobody set
    /// any, in the coordinates of the frame; of lines where each begins.
    #[must_use]
    pub fn automatic_pins(&self) -> &[PointPair] {
        &self.0.moved.automatic
    }

    /// The features that the warp does not lead to where they belong at `t`;
    /// none where it meets all of them.
    #[must_use]
    pub fn missed(&self, t: f64) -> Option<MissedFeatures> {
        self.warp().missed(t)
    }

    /// The common triangulation of the designs, where solids have one. What
    /// carries fields and pictures is a mesh of the frame: see
    /// [`Self::arap`].
    #[must_use]
    pub fn compatible(&self) -> Option<&CompatibleMesh> {
        match (self.content(), &self.0.moved.warp) {
            (Content::Solid(_), AnyWarp::Along(warp)) => Some(warp.mesh()),
            (Content::Solid(_), _) => self.arap().map(Arap::mesh),
            (Content::Field(_) | Content::Colours(_), _) => None,
        }
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

    /// Width of the bars of trusses, in units of the designs.
    pub(super) fn bar_width(&self) -> f64 {
        self.0.bar_width
    }
}
