//! A path through the blends of many designs, as a warp with a time parameter.

use super::ArapBlend;
use crate::compatible::CompatibleMesh;
use crate::warp::{Placement, Placer, Warp};
use std::fmt::{Debug, Formatter, Result};
use std::sync::Arc;

/// Writes the weights at t, one per design, which sum to 1.
pub type WeightsAt = dyn Fn(f64, &mut [f64]) + Send + Sync;

/// As-rigid-as-possible interpolation of many designs along a path through their blends, for t from
/// 0 to 1. Its source and target are the blends at t = 0 and t = 1. Cloning is cheap.
///
/// Guaranteed: at each t the result equals the blend bit for bit.
#[derive(Clone)]
pub struct AlongBlend {
    blend: ArapBlend,
    weights: Arc<WeightsAt>,
    ends: Arc<CompatibleMesh>,
}

impl Debug for AlongBlend {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.debug_struct("AlongBlend")
            .field("blend", &self.blend)
            .finish_non_exhaustive()
    }
}

impl AlongBlend {
    /// Creates the interpolation along the path on which the blend at t has the given `weights`.
    /// `weights` is called with t in any order, also outside [0, 1].
    #[must_use]
    pub fn new(
        blend: ArapBlend,
        weights: impl Fn(f64, &mut [f64]) + Send + Sync + 'static,
    ) -> Self {
        let mut placer = blend.placer();
        let mut own = vec![0.0; blend.family().count()];
        let ends = [0.0, 1.0].map(|t| {
            weights(t, &mut own);
            placer.place(&own).to_vec()
        });
        Self {
            ends: Arc::new(blend.family().with_embeddings(ends)),
            blend,
            weights: Arc::new(weights),
        }
    }

    /// Returns the mesh whose source and target are the blends at t = 0 and t = 1. Faces may be
    /// folded in these blends.
    #[must_use]
    pub fn mesh(&self) -> &CompatibleMesh {
        &self.ends
    }
}

impl Warp for AlongBlend {
    fn placer(&self) -> Placer {
        let ends = &self.ends;
        let faces = Arc::clone(ends.faces());
        let placement = Placement::of_source(faces, ends.source(), ends.target());
        let mut placer = self.blend.placer();
        let mut own = vec![0.0; self.blend.family().count()];
        let weights = Arc::clone(&self.weights);
        Placer::new(placement, move |t, placement| {
            weights(t, &mut own);
            placement.in_frame.copy_from_slice(placer.place(&own));
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compatible::CompatibleFamily;
    use crate::geometry::{DMat2, DVec2};
    use crate::work::progress::Silent;

    #[test]
    fn a_way_along_an_edge_is_the_blend_of_two() {
        let first = vec![DVec2::ZERO, DVec2::X, DVec2::new(0.3, 1.0), DVec2::Y];
        let other = |by: f64, wide: f64| -> Vec<DVec2> {
            let map = DMat2::from_angle(by) * DMat2::from_diagonal(DVec2::new(wide, 1.0));
            first.iter().map(|&p| map * p).collect()
        };
        let places = vec![first.clone(), other(1.0, 1.5), other(-0.5, 0.7)];
        let family = CompatibleFamily::new(vec![[0, 1, 2], [0, 2, 3]], places, vec![]);
        let blend = ArapBlend::build(&family.expect("a family"), &Silent).expect("a blend");
        let along = AlongBlend::new(blend.clone(), |t, weights: &mut [f64]| {
            weights.copy_from_slice(&[0.0, 1.0 - t, t]);
        });
        let (mut placer, mut solved) = (along.placer(), blend.placer());
        for t in [0.0, 0.25, 1.0, 1.5, 0.5] {
            placer.place(t);
            assert_eq!(
                placer.placement().in_frame,
                solved.place(&[0.0, 1.0 - t, t])
            );
        }
        let placement = along.placer().placement().clone();
        assert_eq!(placement.in_source, blend.family().embeddings()[1]);
        assert_eq!(placement.in_target, blend.family().embeddings()[2]);
    }
}
