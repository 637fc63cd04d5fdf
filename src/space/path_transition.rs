//! A path over the map as a film: from stop to stop a transition.
//!
//! Guaranteed: at each stop its blend, and so at the site of a design the design itself.
//! Not guaranteed: in between the very blend of the place that the path has come to, but one
//! by smooth weights that are nearly its; of fields these run in straight pieces, and of
//! pictures straight from stop to stop.

use super::blend::{BlendContent, DesignSpace};
use super::error::SpaceError;
use super::map::WeightMap;
use super::path::{MapCurve, MapPath};
use super::weight_polynomials::WeightPolynomials;
use crate::content::{FieldContent, FieldPair, FieldSet, SolidContent};
use crate::design::{Design, DesignForm, Truss};
use crate::geometry::{Bounds, DVec2};
use crate::mesh::TriangleMesh;
use crate::transition::{BlendEnds, BuildError, Sequence, Transition};
use crate::warp::{AlongBlend, ArapBlend, Warp};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Progress, still_wanted};
use std::sync::Arc;

/// Pieces of a leg in which the weights of fields run straight. On wild curves over a map of
/// six designs these are off by 0.05 of a weight at worst, and 16 by 0.13; each takes a field.
pub(super) const PIECES: usize = 32;

/// Looks at a leg for the box around all that is seen.
const LOOKS: u32 = 16;

impl DesignSpace {
    /// The film along a path.
    ///
    /// # Errors
    /// As [`Self::leg`].
    pub fn film(
        &self,
        map: &WeightMap,
        path: &MapPath,
        progress: &dyn Progress,
    ) -> Result<Sequence, SpaceError> {
        let legs = (0..path.leg_count()).map(|leg| self.leg((map, path), leg, progress));
        let legs = legs.collect::<Result<Vec<_>, _>>()?;
        Sequence::new(legs).ok_or(SpaceError::NoPath)
    }

    /// One way of it, from stop to stop.
    ///
    /// # Errors
    /// [`SpaceError`] if there is no such way, the map has other sites than there are
    /// designs, or the fields of all ways are too much.
    pub fn leg(
        &self,
        (map, path): (&WeightMap, &MapPath),
        leg: usize,
        progress: &dyn Progress,
    ) -> Result<Transition, SpaceError> {
        let designs = self.designs().len();
        let curve = MapCurve::new(path).ok_or(SpaceError::NoPath)?;
        let legs = curve.leg_count();
        if leg >= legs || map.sites().len() != designs {
            return Err(SpaceError::NoPath);
        }
        still_wanted(progress)?;
        let names: Vec<&str> = path.stops().map(|(_, stop)| stop.name.as_str()).collect();
        let map = map.clone();
        let on_map = move |t: f64, weights: &mut [f64]| {
            map.weights(curve.place(leg, t), weights);
        };
        let course = WeightPolynomials::new(designs, &on_map);
        let weights = move |t: f64, weights: &mut [f64]| match (0.0..=1.0).contains(&t) {
            true => course.at(t, weights),
            // Polynomials run far off beyond their ends.
            false => on_map(t, weights),
        };
        let at = |t: f64| {
            let mut own = vec![0.0; designs];
            weights(t, &mut own);
            own
        };
        let end = |k: usize| Arc::new(self.design(&at(k as f64), names[leg + k]));
        let mut ends = BlendEnds {
            designs: [end(0), end(1)],
            bounds: self.bounds(),
            bar_width: self.bar_width(),
        };
        Ok(match self.seen() {
            BlendContent::Solid { blend, walks, bars } => {
                let warp = AlongBlend::new(blend.clone(), weights);
                ends.bounds = swept(&warp, if bars.is_empty() { 0.0 } else { ends.bar_width });
                Transition::along_blend(ends, warp, self.solid(walks, bars))
            }
            BlendContent::Field(set) => {
                // 18 ways of 512² cells are 0.6 GB.
                let allowed = WorkloadKind::Cells.allow(2 * legs * set.grid().cells(), progress);
                allowed.map_err(BuildError::from)?;
                Transition::through_fields(ends, in_turn(set, at))
            }
            BlendContent::Colours(pictures) => {
                let weights = [at(0.0), at(1.0)];
                let [from, to] = &weights;
                pictures.film(ends.designs, [from, to], progress)?
            }
        })
    }

    /// A blend as a design of its own, under this name or one that says what it is made
    /// of. With all weight on one design it is that design.
    #[must_use]
    pub fn design(&self, weights: &[f64], name: &str) -> Design {
        let told = if name.is_empty() {
            self.told(weights)
        } else {
            name.to_owned()
        };
        let nearest = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b]));
        let nearest = &self.designs()[nearest.unwrap_or_default()];
        let own = || Design {
            name: told.clone(),
            ..Design::clone(nearest)
        };
        if weights.contains(&1.0) {
            return own();
        }
        if let BlendContent::Colours(pictures) = self.seen() {
            let blend = pictures.picture(weights);
            return super::picture_space::design(told.clone(), blend).unwrap_or_else(own);
        }
        let mut frame = self.frame();
        frame.seek(weights);
        let form = match (self.seen(), frame.places()) {
            (BlendContent::Solid { blend, bars, .. }, Some(places)) => form(blend, bars, places),
            _ => None,
        };
        match form {
            Some(form) => Design::new(told.clone(), form),
            // Nothing may be left of a field, or be too large.
            None => Design::of_rings(told.clone(), frame.figure().rings).unwrap_or_else(|_| own()),
        }
    }

    /// What is drawn over the vertices of the common mesh.
    pub(super) fn solid(&self, walks: &[Vec<u32>], bars: &[[u32; 2]]) -> SolidContent {
        SolidContent {
            loops: walks.to_vec(),
            bars: bars.to_vec(),
            bar_width: self.bar_width(),
            ..SolidContent::default()
        }
    }

    /// What a blend is made of, in a few words: the largest two shares.
    #[must_use]
    pub fn told(&self, weights: &[f64]) -> String {
        let designs = self.designs().iter().zip(weights);
        let mut shares: Vec<(&str, f64)> = designs
            .map(|(design, &weight)| (design.name.as_str(), 100.0 * weight))
            .filter(|(_, percent)| percent.abs() >= 0.5)
            .collect();
        // Of equal ones the first stays first.
        shares.sort_by(|a, b| b.1.total_cmp(&a.1));
        match shares.as_slice() {
            [] => String::new(),
            [(only, _)] => (*only).to_owned(),
            [(first, most), (second, less), ..] => {
                format!("{first} {most:.0} %, {second} {less:.0} %")
            }
        }
    }
}

/// Vertices at these places as a form; none where they make no mesh or truss.
fn form(blend: &ArapBlend, bars: &[[u32; 2]], places: &[DVec2]) -> Option<DesignForm> {
    if bars.is_empty() {
        let faces = blend.family().faces().to_vec();
        return Some(TriangleMesh::new(places.to_vec(), faces).ok()?.into());
    }
    Some(Truss::new(places.to_vec(), bars.to_vec()).ok()?.into())
}

/// The box around all that is seen on the way.
fn swept(warp: &AlongBlend, room: f64) -> Bounds {
    let mut placer = warp.placer();
    let boxes = (0..=LOOKS).filter_map(|k| {
        placer.place(f64::from(k) / f64::from(LOOKS));
        Bounds::of(placer.placement().in_frame.iter().copied())
    });
    let all = boxes.reduce(|a, b| a.union(&b));
    let all = all.unwrap_or_else(|| unreachable!("a family has vertices"));
    all.padded(0.5 * room)
}

/// The fields at evenly spaced t, each pair of neighbours in turn.
fn in_turn(set: &FieldSet, at: impl Fn(f64) -> Vec<f64>) -> FieldContent {
    let node = |k: usize| Arc::new(set.blended(&at(k as f64 / PIECES as f64)));
    let nodes: Vec<_> = (0..=PIECES).map(node).collect();
    let pair =
        |two: &[Arc<_>]| FieldPair::new(Arc::clone(&two[0]), Arc::clone(&two[1]), set.blend());
    let pairs = nodes.windows(2).map(pair).collect::<Result<Vec<_>, _>>();
    let fields = pairs.ok().and_then(FieldContent::in_turn);
    fields.unwrap_or_else(|| unreachable!("all are on one grid, and the blend was checked"))
}
