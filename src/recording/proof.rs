//! Certificates that hold at every t of a recording: no face folds, and no outlines meet.
//!
//! Within an interval of a recording every vertex is a polynomial of s, which runs from 0 to 1 over
//! the interval. So are twice the area of a face and the side of an edge on which a vertex lies. A
//! polynomial whose Bernstein coefficients are all positive is positive throughout; otherwise both
//! halves are examined, down to a thousand-millionth of the interval. Without folds and meetings,
//! every frame is drawn as it should be.
//!
//! The certificate covers the recording as it is played: all bounds include its rounding. The
//! recording itself is as close to the warp as it states ([`Recording::error`]).
//!
//! Guaranteed: whatever is reported as proved is true. Not guaranteed: that everything true can be
//! proved; undecided cases are reported as failures, at the first t where the decision failed. A
//! vertex that touches an edge at an end of the motion, like the sides of a cut, is not tested
//! against that edge for the first or last 1024th, and is counted. At the ends themselves the
//! designs decide the orientation, even of faces smaller than rounding.
//!
//! - `bernstein`: polynomials with bounded errors; `vertex_curve`: the curves of vertices
//! - `folds`: the first face that may fold; `meetings`: the first outlines that may meet
//! - `drawn_loop`: the boundary loops to examine

mod bernstein;
mod drawn_loop;
mod folds;
mod meetings;
mod vertex_curve;

#[cfg(test)]
mod tests;

pub use drawn_loop::DrawnLoop;

use super::Recording;
use crate::geometry::DVec2;
use crate::work::progress::{Cancelled, Progress, checkpoint};
use serde::Serialize;
use vertex_curve::IntervalCurves;

/// The result of examining a recording at every t.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RecordingProof {
    /// The first time at which a face is not proved to be positively oriented.
    pub fold: Option<FaceFold>,
    /// The first time at which outlines are not proved to be apart.
    pub meeting: Option<OutlineMeeting>,
    /// Number of vertices that touch an edge at an end of the motion and were not tested against
    /// that edge for the 1024th next to that end.
    pub touching: usize,
}

impl RecordingProof {
    /// Returns whether no face folds and no outlines meet at any t.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.fold.is_none() && self.meeting.is_none()
    }
}

/// A face that folds, or could not be proved not to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FaceFold {
    /// t at which the fold begins, accurate to 1e-9 of an interval.
    pub t: f64,
    /// Index of the face.
    pub face: usize,
}

/// A vertex that meets an edge of an outline, or could not be proved not to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OutlineMeeting {
    /// t of the meeting, accurate to 1e-9 of an interval.
    pub t: f64,
    /// Index of the vertex.
    pub vertex: u32,
    /// Indices of the vertices of the edge.
    pub edge: [u32; 2],
    /// Position of the vertex at that time.
    pub place: DVec2,
}

impl Recording {
    /// Examines all faces and all given boundary loops of the recording at every t in [0, 1]. Takes
    /// about 20 µs per face, plus a search for nearby edges.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled.
    ///
    /// # Panics
    /// If a loop contains the index of a vertex that does not exist.
    pub fn prove(
        &self,
        loops: &[DrawnLoop],
        progress: &dyn Progress,
    ) -> Result<RecordingProof, Cancelled> {
        let mut proof = RecordingProof::default();
        // If nothing moves in the frame, every frame equals the designs.
        if !self.0.channels.in_frame {
            return Ok(proof);
        }
        let faces = self.0.warp.placer().placement().faces.clone();
        for interval in &self.0.intervals {
            checkpoint(progress, "proving", interval.from)?;
            let curves = IntervalCurves::of(interval);
            let time = |s: f64| interval.from + s * (interval.to - interval.from);
            let at_ends = [interval.from == 0.0, interval.to == 1.0];
            if proof.fold.is_none() {
                let fold = folds::first_fold(&curves, &faces, at_ends, progress)?;
                proof.fold = fold.map(|(s, face)| FaceFold { t: time(s), face });
            }
            if proof.meeting.is_none() {
                let is_visible = |boundary_loop: &&DrawnLoop| {
                    boundary_loop.visible_interval[0] < interval.to
                        && boundary_loop.visible_interval[1] > interval.from
                };
                let visible_loops: Vec<&DrawnLoop> = loops.iter().filter(is_visible).collect();
                let meetings = meetings::first_meeting(&curves, &visible_loops, at_ends, progress)?;
                proof.touching += meetings.touching;
                proof.meeting = meetings
                    .first
                    .map(|(s, vertex, edge, place)| OutlineMeeting {
                        t: time(s),
                        vertex,
                        edge,
                        place,
                    });
            }
        }
        Ok(proof)
    }
}
