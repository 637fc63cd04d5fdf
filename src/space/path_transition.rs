//! Films along a path over a map: one transition per segment between two stops.
//!
//! Each stop shows exactly the blend of its place, so a stop at a design's site shows that design.
//! Between stops, the weights depend on the content. For rigid parts, they are smooth
//! approximations of the weights of the map. For distance fields, they are piecewise linear in t.
//! For pictures, they are linear from stop to stop.

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
use crate::work::progress::{Progress, check_cancelled};
use std::sync::Arc;

/// For distance fields: number of equal intervals of t into which a segment of a path is divided.
/// Within an interval the weights are linear (resource limit: each interval stores a field; on
/// random curves over a map of six designs, these weights differ from the smooth ones by at most
/// 0.05).
pub(super) const FIELD_PIECES: usize = 32;

/// Number of steps in which a segment is sampled to find its bounding box (heuristic).
const BOUNDS_STEPS: u32 = 16;

impl DesignSpace {
    /// Builds the film along a path, one transition per segment.
    ///
    /// # Errors
    /// As [`Self::segment`].
    pub fn path_sequence(
        &self,
        map: &WeightMap,
        path: &MapPath,
        progress: &dyn Progress,
    ) -> Result<Sequence, SpaceError> {
        let build = |index| self.segment(map, path, index, progress);
        let segments = (0..path.segment_count()).map(build);
        let segments = segments.collect::<Result<Vec<_>, _>>()?;
        Sequence::new(segments).ok_or(SpaceError::NoPath)
    }

    /// Builds the transition of one segment of a path, from stop to stop.
    ///
    /// # Errors
    /// [`SpaceError`] if there is no such segment, if the map does not have one site per design, if
    /// the distance fields of all segments need too much memory, or if the work was cancelled.
    pub fn segment(
        &self,
        map: &WeightMap,
        path: &MapPath,
        segment: usize,
        progress: &dyn Progress,
    ) -> Result<Transition, SpaceError> {
        let designs = self.designs().len();
        let curve = MapCurve::new(path).ok_or(SpaceError::NoPath)?;
        let segments = curve.segment_count();
        if segment >= segments || map.sites().len() != designs {
            return Err(SpaceError::NoPath);
        }
        check_cancelled(progress)?;
        let names: Vec<&str> = path.stops().map(|(_, stop)| stop.name.as_str()).collect();
        let map = map.clone();
        let on_map = move |t: f64, weights: &mut [f64]| {
            map.weights(curve.place(segment, t), weights);
        };
        let polynomials = WeightPolynomials::new(designs, &on_map);
        let weights = move |t: f64, weights: &mut [f64]| match (0.0..=1.0).contains(&t) {
            true => polynomials.at(t, weights),
            // Outside [0, 1], the polynomials would diverge quickly, so the weights of the map are
            // used.
            false => on_map(t, weights),
        };
        let weights_at = |t: f64| {
            let mut current = vec![0.0; designs];
            weights(t, &mut current);
            current
        };
        let end = |k: usize| Arc::new(self.design(&weights_at(k as f64), names[segment + k]));
        let mut ends = BlendEnds {
            designs: [end(0), end(1)],
            bounds: self.bounds(),
            bar_width: self.bar_width(),
        };
        Ok(match self.content() {
            BlendContent::Solid {
                blend,
                boundary_loops,
                bars,
            } => {
                let warp = AlongBlend::new(blend.clone(), weights);
                let width = if bars.is_empty() { 0.0 } else { ends.bar_width };
                ends.bounds = swept_bounds(&warp, width);
                Transition::along_blend(ends, warp, self.solid_content(boundary_loops, bars))
            }
            BlendContent::Field(set) => {
                // The limit allows 18 segments of 512² cells, whose fields take 0.6 GB.
                let cells = 2 * segments * set.grid().cells();
                let check = WorkloadKind::Cells.check(cells, progress);
                check.map_err(BuildError::from)?;
                Transition::through_fields(ends, fields_along(set, weights_at))
            }
            BlendContent::Colours(pictures) => {
                let [from, to] = [weights_at(0.0), weights_at(1.0)];
                pictures.transition_between(ends.designs, [&from, &to], progress)?
            }
        })
    }

    /// Returns a blend as a new design with the given name, or named by [`Self::blend_label`] if
    /// the name is empty.
    ///
    /// With weight 1 on one design, returns a copy of that design.
    #[must_use]
    pub fn design(&self, weights: &[f64], name: &str) -> Design {
        let label = if name.is_empty() {
            self.blend_label(weights)
        } else {
            name.to_owned()
        };
        let nearest = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b]));
        let nearest = &self.designs()[nearest.unwrap_or_default()];
        let copy_of_nearest = || Design {
            name: label.clone(),
            ..Design::clone(nearest)
        };
        if weights.contains(&1.0) {
            return copy_of_nearest();
        }
        if let BlendContent::Colours(pictures) = self.content() {
            let blend = pictures.picture(weights);
            let design = super::picture_space::picture_design(label.clone(), blend);
            return design.unwrap_or_else(copy_of_nearest);
        }
        let mut frame = self.frame();
        frame.seek(weights);
        let form = match (self.content(), frame.places()) {
            (BlendContent::Solid { blend, bars, .. }, Some(places)) => form_at(blend, bars, places),
            _ => None,
        };
        match form {
            Some(form) => Design::new(label.clone(), form),
            // A contour that is empty or too large cannot become a design.
            None => Design::from_rings(label.clone(), frame.figure().rings)
                .unwrap_or_else(|_| copy_of_nearest()),
        }
    }

    /// Returns the content drawn on the common mesh: filled boundary loops and bars.
    pub(super) fn solid_content(
        &self,
        boundary_loops: &[Vec<u32>],
        bars: &[[u32; 2]],
    ) -> SolidContent {
        SolidContent {
            loops: boundary_loops.to_vec(),
            bars: bars.to_vec(),
            bar_width: self.bar_width(),
            ..SolidContent::default()
        }
    }

    /// Describes a blend by its two largest weights: "cat 60 %, dog 40 %".
    #[must_use]
    pub fn blend_label(&self, weights: &[f64]) -> String {
        let designs = self.designs().iter().zip(weights);
        let mut percentages: Vec<(&str, f64)> = designs
            .map(|(design, &weight)| (design.name.as_str(), 100.0 * weight))
            .filter(|(_, percent)| percent.abs() >= 0.5)
            .collect();
        // The sort is stable: of equal weights the first design comes first.
        percentages.sort_by(|a, b| b.1.total_cmp(&a.1));
        match percentages.as_slice() {
            [] => String::new(),
            [(only, _)] => (*only).to_owned(),
            [(first, percent), (second, second_percent), ..] => {
                format!("{first} {percent:.0} %, {second} {second_percent:.0} %")
            }
        }
    }
}

/// Returns a mesh, or a truss if there are bars, with vertices at the given places; `None` if it
/// would be invalid.
fn form_at(blend: &ArapBlend, bars: &[[u32; 2]], places: &[DVec2]) -> Option<DesignForm> {
    if bars.is_empty() {
        let faces = blend.family().faces().to_vec();
        return Some(TriangleMesh::new(places.to_vec(), faces).ok()?.into());
    }
    Some(Truss::new(places.to_vec(), bars.to_vec()).ok()?.into())
}

/// Returns the bounding box of all blends along a segment, widened by half of `bar_width`.
fn swept_bounds(warp: &AlongBlend, bar_width: f64) -> Bounds {
    let mut placer = warp.placer();
    let boxes = (0..=BOUNDS_STEPS).filter_map(|k| {
        placer.place(f64::from(k) / f64::from(BOUNDS_STEPS));
        Bounds::of(placer.placement().in_frame.iter().copied())
    });
    let all = boxes.reduce(|a, b| a.union(&b));
    let all = all.unwrap_or_else(|| unreachable!("a family has vertices"));
    all.padded(0.5 * bar_width)
}

/// Blends the distance fields at evenly spaced t of a segment, and returns the pairs of consecutive
/// fields.
fn fields_along(set: &FieldSet, weights_at: impl Fn(f64) -> Vec<f64>) -> FieldContent {
    let field = |k: usize| Arc::new(set.blended(&weights_at(k as f64 / FIELD_PIECES as f64)));
    let fields: Vec<_> = (0..=FIELD_PIECES).map(field).collect();
    let pair =
        |two: &[Arc<_>]| FieldPair::new(Arc::clone(&two[0]), Arc::clone(&two[1]), set.blend());
    let pairs = fields.windows(2).map(pair).collect::<Result<Vec<_>, _>>();
    let content = pairs.ok().and_then(FieldContent::sequence);
    content.unwrap_or_else(|| unreachable!("all are on one grid, and the blend was checked"))
}
