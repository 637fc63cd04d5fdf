//! A mapping of the plane, built from displacement layers, coarse to fine, that moves the features
//! from their positions in the frame to those in a design.

use super::layer::{FeaturePull, SplineLayer};
use super::options::LatticeOptions;
use crate::geometry::{Bounds, DVec2};

/// Bound of each coordinate of a control point's displacement, in lattice spacings.
///
/// Cited: below 1 / 2.046392675 = 0.4886 a layer is injective (Choi, Lee, "Injectivity conditions
/// of 2D and 3D uniform cubic B-spline functions", 2000).
const MAX_DISPLACEMENT: f64 = 0.48;

/// Maximum number of composed layers: in the first level, in each other requested level, and in
/// each added level (resource limit).
///
/// A layer moves a point by up to about half a lattice spacing. With the default spacing of a
/// quarter of the frame, the first level needs ten layers to move a feature across the frame.
const MAX_LAYERS: [u32; 3] = [16, 4, 8];

/// No further layer is added once the largest error of all features is at most this fraction of the
/// permitted error (tolerance: one layer more or less must not cause a visible jump from one film
/// frame to the next).
const TARGET_RESIDUAL: f64 = 0.1;

/// Distances from the frame, in lengths of its longer side, at which the influence of a feature
/// starts to fade and at which it vanishes (heuristic).
const FADE: [f64; 2] = [0.5, 1.0];

/// Extent and resolution of the lattices.
#[derive(Clone, Debug)]
pub(super) struct LatticeDomain {
    frame: Bounds,
    /// Area covered by the lattices.
    domain: Bounds,
    /// Length of the frame's longer side; 1 for a frame of zero size.
    side: f64,
    /// Permitted error of a feature in plane units; `options.tolerance` is a fraction of the
    /// frame's diameter.
    pub(super) tolerance: f64,
    pub(super) options: LatticeOptions,
}

impl LatticeDomain {
    /// Creates the domain around `frame`; `unit` is the frame's diameter, or 1 for a frame of zero
    /// size.
    pub(super) fn new(frame: &Bounds, unit: f64, options: LatticeOptions) -> Self {
        let side = frame.size().max_element();
        let side = if side > 0.0 { side } else { unit };
        Self {
            frame: *frame,
            // A feature moves control points up to two lattice spacings away from it. The domain is
            // that much wider than the region in which features have influence.
            domain: frame.padded((FADE[1] + 2.0 / f64::from(options.coarsest)) * side),
            side,
            tolerance: options.tolerance * unit,
            options,
        }
    }

    /// Returns the weight of a feature at `p`: 1 up to the first distance in [`FADE`], falling to 0
    /// at the second.
    fn weight(&self, p: DVec2) -> f64 {
        let outside = (p - p.clamp(self.frame.min, self.frame.max)).length() / self.side;
        let s = ((FADE[1] - outside) / (FADE[1] - FADE[0])).clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    }
}

/// Mapping of the plane: the composition or the sum of displacement layers.
#[derive(Clone, Debug, Default)]
pub(super) struct LayerStack {
    /// Allocated layers, reused from one t to the next.
    layers: Vec<SplineLayer>,
    /// Number of leading entries of `layers` that are in use.
    height: usize,
    /// Whether layers are composed; otherwise they are summed.
    is_composed: bool,
    features: Vec<LatticeFeature>,
}

/// A feature, with its position in the frame, after the layers built so far, and in the design.
#[derive(Clone, Copy, Debug)]
struct LatticeFeature {
    weight: f64,
    /// Position in the frame.
    from: DVec2,
    /// Position after the layers built so far.
    now: DVec2,
    /// Position in the design.
    expected: DVec2,
    /// Position to which the layers move the feature: `from` plus `weight` times the displacement
    /// to `expected`.
    goal: DVec2,
}

impl LayerStack {
    /// Builds layers that approximately move each feature `(position, displacement)` by its
    /// displacement times a weight. The weight is 1 in the frame and falls to 0 far outside it.
    pub(super) fn build(
        &mut self,
        ground: &LatticeDomain,
        features: impl Iterator<Item = (DVec2, DVec2)>,
    ) {
        self.height = 0;
        self.is_composed = ground.options.fold_free;
        self.features.clear();
        self.features.extend(features.map(|(from, displacement)| {
            let weight = ground.weight(from);
            LatticeFeature {
                weight,
                from,
                now: from,
                expected: from + displacement,
                goal: from + displacement * weight,
            }
        }));
        let levels = ground.options.levels;
        for level in 0..ground.options.max_levels() {
            let residual = self.max_residual();
            // Levels beyond the requested ones are built only while an error exceeds the full
            // tolerance.
            let target = if level < levels { TARGET_RESIDUAL } else { 1.0 };
            if residual <= target * ground.tolerance {
                return;
            }
            self.add_level(ground, level);
        }
    }

    /// Adds all layers of one level.
    fn add_level(&mut self, ground: &LatticeDomain, level: u32) {
        let cells = f64::from(ground.options.coarsest) * f64::from(level).exp2();
        let spacing = ground.side / cells;
        let layers = match (self.is_composed, level) {
            (false, _) => 1,
            // About two layers per cell suffice to move a point across the frame, because each
            // layer moves it by up to about half a spacing.
            (true, 0) => MAX_LAYERS[0].min(2 * ground.options.coarsest + 2),
            (true, _) if level < ground.options.levels => MAX_LAYERS[1],
            (true, _) => MAX_LAYERS[2],
        };
        let bound = if self.is_composed {
            MAX_DISPLACEMENT * spacing
        } else {
            f64::INFINITY
        };
        for _ in 0..layers {
            if self.max_residual() <= TARGET_RESIDUAL * ground.tolerance {
                return;
            }
            self.add_layer(ground, spacing, bound);
        }
    }

    /// Fits one more layer to the remaining displacements.
    fn add_layer(&mut self, ground: &LatticeDomain, spacing: f64, bound: f64) {
        // Layers are reused from one t to the next to avoid allocation.
        if self.layers.len() == self.height {
            self.layers.push(SplineLayer::default());
        }
        let layer = &mut self.layers[self.height];
        let is_composed = self.is_composed;
        // A composed layer displaces the result of the previous layers; a summed layer displaces
        // the original positions.
        let argument = |f: &LatticeFeature| if is_composed { f.now } else { f.from };
        let features = self.features.iter().filter(|f| f.weight > 0.0);
        let pulls = features.map(|f| FeaturePull {
            at: argument(f),
            by: f.goal - f.now,
            weight: f.weight,
        });
        layer.fit(&ground.domain, spacing, pulls, bound);
        for feature in &mut self.features {
            feature.now += layer.displacement(argument(feature));
        }
        self.height += 1;
    }

    /// Returns the largest distance of a feature from its goal.
    fn max_residual(&self) -> f64 {
        let distances = self.features.iter().map(|f| f.now.distance(f.goal));
        distances.fold(0.0, f64::max)
    }

    /// Returns, for each feature, the distance between its image under the mapping and its position
    /// in the design.
    pub(super) fn residuals(&self) -> impl Iterator<Item = f64> + '_ {
        self.features.iter().map(|f| f.now.distance(f.expected))
    }

    /// Writes the image of each point of `places` to `out`.
    pub(super) fn apply(&self, places: &[DVec2], out: &mut [DVec2]) {
        out.copy_from_slice(places);
        for layer in &self.layers[..self.height] {
            if self.is_composed {
                out.iter_mut().for_each(|p| *p += layer.displacement(*p));
            } else {
                let places = places.iter().zip(&mut *out);
                places.for_each(|(&place, out)| *out += layer.displacement(place));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DMat2;

    impl LayerStack {
        /// Returns two Jacobian determinants at a point: that of the mapping, and the smallest one
        /// of a single layer. The second is infinite if the layers are summed.
        pub(in crate::warp::lattice) fn determinants(&self, place: DVec2) -> [f64; 2] {
            let mut at = place;
            let mut total = DMat2::IDENTITY;
            let mut smallest = f64::INFINITY;
            for layer in &self.layers[..self.height] {
                let [x, y] = layer.gradient(at);
                let slope = DMat2::from_cols(x, y);
                if self.is_composed {
                    let step = DMat2::IDENTITY + slope;
                    smallest = smallest.min(step.determinant());
                    total = step * total;
                    at += layer.displacement(at);
                } else {
                    total += slope;
                }
            }
            [total.determinant(), smallest]
        }
    }
}
