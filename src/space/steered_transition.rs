//! A transition that shows any blend of a design space, with weights set from outside. The stage, a
//! Bevy plugin, uses it because entities of the plugin show transitions, not design spaces.

use super::blend::{BlendContent, DesignSpace};
use crate::transition::{BlendEnds, Transition};
use crate::warp::AlongBlend;
use std::sync::{Arc, Mutex, PoisonError};

/// Transition of rigid parts that shows the blend with the weights set last.
///
/// Cloning is cheap, and clones share their weights. A frame shows newly set weights once it is
/// moved to a t. The t determines only the colour, between those of the first and the last design.
///
/// ```
/// use morphospace::Design;
/// use morphospace::work::progress::Silent;
/// use morphospace::space::{DesignSpace, SpaceSpec, SteeredTransition};
/// use std::sync::Arc;
///
/// let tent = |h: f64| {
///     Design::from_rings("tent", [[[0.0, 0.0], [2.0, 0.0], [1.0, h]]]).map(Arc::new)
/// };
/// let designs = vec![tent(1.0)?, tent(2.0)?, tent(4.0)?];
/// let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent)?;
/// let steered = SteeredTransition::new(&space).expect("rigid parts");
/// let mut frame = steered.transition().frame(0.0);
/// let t = steered.set_weights(&[0.0, 0.0, 1.0]).expect("a weight for each");
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
    /// Creates the transition, which at first has weight 1 on the first design and 0 on all others.
    /// Returns `None` if the space blends its designs as distance fields or as pictures, because
    /// the transition can show only rigid parts.
    #[must_use]
    pub fn new(space: &DesignSpace) -> Option<Self> {
        let BlendContent::Solid {
            blend,
            boundary_loops,
            bars,
        } = space.content()
        else {
            return None;
        };
        let designs = space.designs();
        let mut first = vec![0.0; designs.len()];
        first[0] = 1.0;
        let weights = Arc::new(Mutex::new(first));
        let shared = Arc::clone(&weights);
        let warp = AlongBlend::new(blend.clone(), move |_, output: &mut [f64]| {
            let current = shared.lock().unwrap_or_else(PoisonError::into_inner);
            output.copy_from_slice(&current);
        });
        let ends = BlendEnds {
            designs: [&designs[0], &designs[designs.len() - 1]].map(Arc::clone),
            bounds: space.bounds(),
            bar_width: space.bar_width(),
        };
        Some(Self {
            space: space.clone(),
            transition: Transition::along_blend(
                ends,
                warp,
                space.solid_content(boundary_loops, bars),
            ),
            weights,
        })
    }

    /// Returns the transition. Do not record it: the recording would show only one blend.
    #[must_use]
    pub fn transition(&self) -> &Transition {
        &self.transition
    }

    /// Sets the weights, which must sum to one. Returns the t to which frames must be moved to show
    /// the weights in the colour of the blend.
    ///
    /// Returns `None`, and keeps the previous weights, if their number differs from that of the
    /// designs or one of them is not finite.
    #[must_use = "frames show the blend when they are sought again"]
    pub fn set_weights(&self, weights: &[f64]) -> Option<f64> {
        let count = self.space.designs().len();
        if weights.len() != count || !weights.iter().all(|weight| weight.is_finite()) {
            return None;
        }
        let mut current = self.weights.lock().unwrap_or_else(PoisonError::into_inner);
        current.copy_from_slice(weights);
        Some(self.space.colour_fraction(weights))
    }
}
