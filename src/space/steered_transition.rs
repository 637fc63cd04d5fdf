//! A space as a transition that shows whichever blend it is told: for a stage, whose
//! entities are transitions.

use super::blend::{BlendContent, DesignSpace};
use crate::transition::{BlendEnds, Transition};
use crate::warp::AlongBlend;
use std::sync::{Arc, Mutex, PoisonError};

/// Rigid parts of many designs whose weights are set from outside. Cloning is cheap, and
/// clones are told together.
///
/// Guaranteed: a frame that is sought after the weights were set shows that blend, to the
/// last bit; t is where its colour is between the first design and the last.
///
/// ```
/// use morphospace::Design;
/// use morphospace::work::progress::Silent;
/// use morphospace::space::{Space, SpaceSpec, Steered};
/// use std::sync::Arc;
///
/// let tent = |h: f64| Design::of_rings("tent", [[[0.0, 0.0], [2.0, 0.0], [1.0, h]]]).map(Arc::new);
/// let designs = vec![tent(1.0)?, tent(2.0)?, tent(4.0)?];
/// let space = Space::build(&SpaceSpec::new(designs), &Silent)?;
/// let steered = Steered::new(&space).expect("rigid parts");
/// let mut frame = steered.transition().frame(0.0);
/// let t = steered.set(&[0.0, 0.0, 1.0]).expect("a weight for each");
/// frame.seek(t);
/// let top = frame.figure().rings.concat().iter().map(|p| p.y).fold(0.0, f64::max);
/// assert_eq!(top, 4.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SteeredTransition {
    space: DesignSpace,
    transition: Transition,
    weights: Arc<Mutex<Vec<f64>>>,
}

impl SteeredTransition {
    /// At the first design; none of fields.
    #[must_use]
    pub fn new(space: &DesignSpace) -> Option<Self> {
        let BlendContent::Solid { blend, walks, bars } = space.seen() else {
            return None;
        };
        let designs = space.designs();
        let mut first = vec![0.0; designs.len()];
        first[0] = 1.0;
        let weights = Arc::new(Mutex::new(first));
        let told = Arc::clone(&weights);
        let warp = AlongBlend::new(blend.clone(), move |_, own: &mut [f64]| {
            let told = told.lock().unwrap_or_else(PoisonError::into_inner);
            own.copy_from_slice(&told);
        });
        let ends = BlendEnds {
            designs: [&designs[0], &designs[designs.len() - 1]].map(Arc::clone),
            bounds: space.bounds(),
            bar_width: space.bar_width(),
        };
        Some(Self {
            space: space.clone(),
            transition: Transition::along_blend(ends, warp, space.solid(walks, bars)),
            weights,
        })
    }

    /// The transition. A film of it would be that of one blend: it is not to be recorded.
    #[must_use]
    pub fn transition(&self) -> &Transition {
        &self.transition
    }

    /// Says which blend is shown, and returns the t at which frames are to be sought; none
    /// where there is no weight for each design, or one is not finite: then the last one is
    /// shown. They are to sum to one.
    #[must_use = "frames show it when they are sought again"]
    pub fn set(&self, weights: &[f64]) -> Option<f64> {
        let count = self.space.designs().len();
        if weights.len() != count || !weights.iter().all(|weight| weight.is_finite()) {
            return None;
        }
        let mut told = self.weights.lock().unwrap_or_else(PoisonError::into_inner);
        told.copy_from_slice(weights);
        Some(self.space.tint(weights))
    }
}
