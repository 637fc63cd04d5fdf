//! Layers upon layers, from coarse to fine, that lead features where they
//! belong.

use super::layer::{FeaturePull, SplineLayer};
use super::options::LatticeOptions;
use crate::geometry::{Bounds, DVec2};

/// The largest coordinate of a control point's displacement, in spacings.
/// Below 1 / 2.046392675 = 0.4886 a layer is injective (Choi, Lee,
/// "Injectivity conditions of 2D and 3D uniform cubic B-spline functions",
/// 2000).
const BOUND: f64 = 0.48;

/// Layers of the first level, of the others that are asked for, and of those
/// that follow: ten of spacings ¼ lead a feature across the frame.
const COMPOSED: [u32; 3] = [16, 4, 8];

/// Layers end where what is left is this share of the tolerance, so that one
/// layer more or less is no jump in a film.
const AIM: f64 = 0.1;

/// How far from the frame features begin to count less, and where they do not
/// count at all, in longer sides of the frame.
const FADE: [f64; 2] = [0.5, 1.0];

/// The lattices' place in the plane, and their sizes.
#[derive(Clone, Debug)]
pub(super) struct LatticeDomain {
    frame: Bounds,
    domain: Bounds,
    /// The longer side of the frame.
    side: f64,
    /// Lengths, where the options have shares of the diameter.
    pub(super) tolerance: f64,
    pub(super) options: LatticeOptions,
}

impl LatticeDomain {
    pub(super) fn new(frame: &Bounds, unit: f64, options: LatticeOptions) -> Self {
        let side = frame.size().max_element();
        let side = if side > 0.0 { side } else { unit };
        Self {
            frame: *frame,
            // Control points of features at the rim reach farther than them.
            domain: frame.padded((FADE[1] + 2.0 / f64::from(options.coarsest)) * side),
            side,
            tolerance: options.tolerance * unit,
            options,
        }
    }

    /// How much a feature counts that is there.
    fn weight(&self, p: DVec2) -> f64 {
        let outside = (p - p.clamp(self.frame.min, self.frame.max)).length() / self.side;
        let s = ((FADE[1] - outside) / (FADE[1] - FADE[0])).clamp(0.0, 1.0);
        s * s * (3.0 - 2.0 * s)
    }
}

/// A map from the plane to the plane.
#[derive(Clone, Debug, Default)]
pub(super) struct LayerStack {
    layers: Vec<SplineLayer>,
    /// How many of the layers are in use.
    height: usize,
    composed: bool,
    features: Vec<LatticeFeature>,
}

#[derive(Clone, Copy, Debug)]
struct LatticeFeature {
    weight: f64,
    from: DVec2,
    /// Where it was led.
    now: DVec2,
    /// Where it should be led, were it not for its weight, and with it.
    wanted: DVec2,
    goal: DVec2,
}

impl LayerStack {
    /// Builds the layers that lead features from their places by their looks.
    pub(super) fn build(
        &mut self,
        ground: &LatticeDomain,
        features: impl Iterator<Item = (DVec2, DVec2)>,
    ) {
        self.height = 0;
        self.composed = ground.options.fold_free;
        self.features.clear();
        self.features.extend(features.map(|(from, look)| {
            let weight = ground.weight(from);
            LatticeFeature {
                weight,
                from,
                now: from,
                wanted: from + look,
                goal: from + look * weight,
            }
        }));
        let levels = ground.options.levels;
        for level in 0..ground.options.most_levels() {
            let left = self.left();
            let enough = if level < levels { AIM } else { 1.0 };
            if left <= enough * ground.tolerance {
                return;
            }
            self.level(ground, level);
        }
    }

    /// All layers of one level.
    fn level(&mut self, ground: &LatticeDomain, level: u32) {
        let cells = f64::from(ground.options.coarsest) * f64::from(level).exp2();
        let spacing = ground.side / cells;
        let layers = match (self.composed, level) {
            (false, _) => 1,
            // So many steps of half a spacing lead across the frame.
            (true, 0) => COMPOSED[0].min(2 * ground.options.coarsest + 2),
            (true, _) if level < ground.options.levels => COMPOSED[1],
            (true, _) => COMPOSED[2],
        };
        let most = if self.composed {
            BOUND * spacing
        } else {
            f64::INFINITY
        };
        for _ in 0..layers {
            if self.left() <= AIM * ground.tolerance {
                return;
            }
            self.layer(ground, spacing, most);
        }
    }

    fn layer(&mut self, ground: &LatticeDomain, spacing: f64, most: f64) {
        // Layers are kept from frame to frame, with their memory.
        if self.layers.len() == self.height {
            self.layers.push(SplineLayer::default());
        }
        let layer = &mut self.layers[self.height];
        let composed = self.composed;
        // Composed, a layer moves what the layers below have moved; summed, each
        // moves the plane as it was.
        let on = |f: &LatticeFeature| if composed { f.now } else { f.from };
        let pulls = self.features.iter().filter(|f| f.weight > 0.0);
        let pulls = pulls.map(|f| FeaturePull {
            at: on(f),
            by: f.goal - f.now,
            weight: f.weight,
        });
        layer.fit(&ground.domain, spacing, pulls, most);
        for feature in &mut self.features {
            feature.now += layer.at(on(feature));
        }
        self.height += 1;
    }

    /// The farthest that a feature is from its goal.
    fn left(&self) -> f64 {
        let left = self.features.iter().map(|f| f.now.distance(f.goal));
        left.fold(0.0, f64::max)
    }

    /// How far each feature is from where it should be led.
    pub(super) fn residuals(&self) -> impl Iterator<Item = f64> + '_ {
        self.features.iter().map(|f| f.now.distance(f.wanted))
    }

    /// Where the map leads each place.
    pub(super) fn lead(&self, places: &[DVec2], out: &mut [DVec2]) {
        out.copy_from_slice(places);
        for layer in &self.layers[..self.height] {
            if self.composed {
                out.iter_mut().for_each(|p| *p += layer.at(*p));
            } else {
                let places = places.iter().zip(&mut *out);
                places.for_each(|(&place, out)| *out += layer.at(place));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DMat2;

    impl LayerStack {
        /// The determinant of the derivative at a place: composed, the product of
        /// the layers'; of these also the least.
        pub(in crate::warp::lattice) fn determinants(&self, place: DVec2) -> [f64; 2] {
            let mut at = place;
            let mut total = DMat2::IDENTITY;
            let mut least = f64::INFINITY;
            for layer in &self.layers[..self.height] {
                let [x, y] = layer.gradient(at);
                let slope = DMat2::from_cols(x, y);
                if self.composed {
                    let step = DMat2::IDENTITY + slope;
                    least = least.min(step.determinant());
                    total = step * total;
                    at += layer.at(at);
                } else {
                    total += slope;
                }
            }
            [total.determinant(), least]
        }
    }
}
