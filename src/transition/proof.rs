//! Checks a transition at every t: whether a face folds, or an outline crosses itself or another
//! one.

#[cfg(doc)]
use super::options::CollisionAvoidance;
use super::transition::Transition;
use crate::content::{Content, SolidContent};
use crate::recording::proof::{DrawnLoop, RecordingProof};
use crate::recording::{Recording, RecordingError, RecordingOptions};
use crate::warp::{Arap, PartClock};
use crate::work::progress::{Progress, ProgressSpan};
use serde::Serialize;
use std::fmt;

/// Progress reported once the motion has been recorded, in [0, 1] (heuristic).
const RECORDING_PROGRESS: f64 = 0.5;

/// Result of checking a transition for folded faces and crossing outlines at every t, with the
/// extent of the check.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TransitionProof {
    /// Result of the check of the recorded motion.
    pub proof: RecordingProof,
    /// Number of faces that were checked; 0 for boundary paths.
    pub faces: usize,
    /// Largest distance between a vertex in the recording and in the solved motion, as a fraction
    /// of the diameter of the designs; see [`Recording::error`].
    pub film_error: f64,
    /// Number of unmatched holes plus number of swelling parts, which grow in thickness within
    /// their outline. The check covers neither these holes nor these parts.
    pub left_out: usize,
    /// Largest distance by which a point is moved aside to avoid collisions, in diameters of the
    /// designs; `None` if nothing is moved. See [`CollisionAvoidance`].
    pub moved_aside: Option<f64>,
}

impl Transition {
    /// Records the transition if necessary, and checks at every t in [0, 1] whether a face folds or
    /// an outline crosses itself or another. Returns `None` for distance fields and pictures, and
    /// for trusses, whose bars may cross.
    ///
    /// # Errors
    /// [`RecordingError`] if the transition cannot be recorded or the work is cancelled.
    pub fn prove(
        &self,
        options: &RecordingOptions,
        progress: &dyn Progress,
    ) -> Result<Option<TransitionProof>, RecordingError> {
        let Content::Solid(solid) = self.content() else {
            return Ok(None);
        };
        // The bars of a truss may cross, and the mesh faces between them are invisible.
        if solid.loops.is_empty() {
            return Ok(None);
        }
        let [recording, checking] = [(0.0, RECORDING_PROGRESS), (RECORDING_PROGRESS, 1.0)]
            .map(|(a, b)| ProgressSpan::new(progress, a, b));
        let recorded: Recording = self.record(options, &recording)?;
        Ok(Some(TransitionProof {
            proof: recorded.prove(&drawn_loops(solid), &checking)?,
            faces: self.compatible().map_or(0, |mesh| mesh.faces().len()),
            film_error: recorded.error(),
            left_out: solid.holes.len() + solid.swelling_shapes.len(),
            moved_aside: self.arap().and_then(Arap::max_guard_displacement),
        }))
    }
}

/// Returns the boundary loops whose vertices are drawn at their positions in the mesh: all loops
/// except those of swelling parts.
fn drawn_loops(solid: &SolidContent) -> Vec<DrawnLoop> {
    let swells = |k: usize| {
        solid
            .swelling_shapes
            .iter()
            .any(|swell| swell.loop_indices().contains(&k))
    };
    let level = |k: usize| match &solid.paint_layers {
        Some(coating) => coating.of_loops[k],
        None => 0,
    };
    let visible_interval = |k: usize| {
        let seed_shape = solid
            .seed_shapes
            .iter()
            .find(|seed_shape| seed_shape.loop_indices.contains(&k));
        let clock = solid.part_clocks.as_ref();
        let clock = clock.map_or(PartClock::WHOLE, |clocks| clocks.clocks[clocks.of_loops[k]]);
        seed_shape.map_or([0.0, 1.0], |seed_shape| {
            seed_shape
                .window
                .visible_interval(|t| clock.transition_time(t))
        })
    };
    let loops = solid.loops.iter().enumerate();
    loops
        .filter(|(k, _)| !swells(*k))
        .map(|(k, boundary_loop)| DrawnLoop {
            vertices: boundary_loop.clone(),
            layer: level(k),
            visible_interval: visible_interval(k),
        })
        .collect()
}

impl TransitionProof {
    /// Returns whether no checked face folds and no checked outlines meet at any t.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.proof.holds()
    }

    /// Returns whether the check covers all faces and outlines at every t.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.left_out == 0 && self.proof.touching == 0
    }

    /// Returns the first t at which a face folds or outlines meet; `None` if there is no such t.
    #[must_use]
    pub fn first_failure_time(&self) -> Option<f64> {
        let fold = self.proof.fold.map(|fold| fold.t);
        let meeting = self.proof.meeting.map(|meeting| meeting.t);
        fold.into_iter().chain(meeting).min_by(f64::total_cmp)
    }

    /// Writes how far points are moved aside, and which holes, parts and outlines the check does
    /// not cover.
    fn write_exceptions(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(by) = self.moved_aside {
            let percent = 100.0 * by;
            write!(
                f,
                "; points are moved aside by up to {percent:.2} % of the diameter to avoid collisions"
            )?;
        }
        let touching = self.proof.touching;
        if touching > 0 {
            write!(
                f,
                "; not checked: {touching} points near the start or end, where they touch an edge"
            )?;
        }
        if self.left_out > 0 {
            let count = self.left_out;
            write!(
                f,
                "; not checked: {count} holes and parts that appear or disappear within their outline"
            )?;
        }
        Ok(())
    }
}

impl fmt::Display for TransitionProof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let RecordingProof { fold, meeting, .. } = &self.proof;
        match (fold, meeting) {
            (None, None) => {
                let faces = if self.faces > 0 {
                    "no face folds, "
                } else {
                    ""
                };
                write!(f, "checked at every moment: {faces}no outlines cross")?;
            }
            _ => f.write_str("not proved")?,
        }
        if let Some(fold) = fold {
            write!(f, "; face {} may fold at t = {:.9}", fold.face + 1, fold.t)?;
        }
        if let Some(meeting) = meeting {
            let (t, place) = (meeting.t, meeting.place);
            write!(
                f,
                "; outlines may cross at t = {t:.9}, near ({:.4}, {:.4})",
                place.x, place.y
            )?;
        }
        self.write_exceptions(f)
    }
}
