//! Certificates that hold at every t of a recording: no face folds, and no outlines meet.
//!
//! Within a time interval of a recording, every vertex position is a polynomial of s, which runs
//! from 0 to 1. The following are therefore polynomials of s too: twice the signed area of a face,
//! and a number whose sign shows on which side of an edge a vertex lies. A polynomial is positive
//! throughout if all its Bernstein coefficients are positive. If they are not, both halves of the
//! interval are examined, and so on, down to a thousand-millionth of the interval. If no face folds
//! and no outlines meet, the image is correct at every t.
//!
//! The certificate covers the recording as it is played: all error bounds include its rounding. How
//! close the recording is to the warp is a separate number ([`Recording::error`]).
//!
//! Guaranteed: everything that is reported as proved is true. Not guaranteed: that everything true
//! can be proved; an undecided case is reported as a failure, with the smallest t at which it could
//! not be decided. There is one exception: a vertex that touches an edge at t = 0 or t = 1, as on
//! the two sides of a cut, is not tested against that edge as long as t is within 1/1024 of that
//! end. The number of such pairs is reported. At t = 0 and t = 1 the positions are those of the
//! designs, so orientations are exact even for faces smaller than rounding.
//!
//! - `bernstein`: polynomials with error bounds; `vertex_curve`: the curves of vertices
//! - `bisection`: the limits and the shared result of both proofs
//! - `folds`: the first face in an interval that may fold; `meetings`: the earliest time in an
//!   interval at which outlines may meet
//! - `drawn_loop`: a boundary loop that is examined for meetings

mod bernstein;
mod bisection;
mod drawn_loop;
mod folds;
mod meetings;
mod vertex_curve;

#[cfg(test)]
mod tests;

pub use drawn_loop::DrawnLoop;

pub(crate) use bernstein::{BernsteinProducts, EPS, degree_elevated};
pub(crate) use vertex_curve::VertexCurve;

use super::Recording;
use crate::geometry::DVec2;
use crate::work::progress::{Cancelled, Progress, checkpoint};
use serde::Serialize;
use vertex_curve::IntervalCurves;

/// Motion of all vertices in one time interval of a recording.
#[derive(Clone, Debug)]
pub(crate) struct MotionInterval {
    /// The t at both ends of the interval.
    pub(crate) times: [f64; 2],
    /// Curve of each vertex.
    pub(crate) curves: Vec<VertexCurve>,
}

impl MotionInterval {
    /// Splits the interval in the middle.
    pub(crate) fn halves(&self) -> [Self; 2] {
        let [from, to] = self.times;
        let middle = from.midpoint(to);
        let (left, right) = self
            .curves
            .iter()
            .map(VertexCurve::halves)
            .map(|[l, r]| (l, r))
            .unzip();
        [([from, middle], left), ([middle, to], right)]
            .map(|(times, curves)| Self { times, curves })
    }
}

/// Result of examining a recording at every t.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RecordingProof {
    /// First face that is not proved to be positively oriented, with the t at which the proof
    /// fails; `None` if all faces are proved at every t.
    pub fold: Option<FaceFold>,
    /// First vertex and edge that are not proved to be apart, with the t at which the proof fails;
    /// `None` if all outlines are proved to be apart at every t.
    pub meeting: Option<OutlineMeeting>,
    /// Number of vertex–edge pairs that touch at t = 0 or t = 1 and were therefore not tested while
    /// t is within 1/1024 of that end.
    pub touching: usize,
}

impl RecordingProof {
    /// Returns whether it is proved that no face folds and no outlines meet at any t.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.fold.is_none() && self.meeting.is_none()
    }
}

/// Face that folds, or that could not be proved not to fold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FaceFold {
    /// The t at which the fold begins, accurate to 1e-9 of a time interval.
    pub t: f64,
    /// Index of the face.
    pub face: usize,
}

/// Vertex and edge of outlines that meet, or that could not be proved not to meet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OutlineMeeting {
    /// The t of the meeting, accurate to 1e-9 of a time interval.
    pub t: f64,
    /// Index of the vertex.
    pub vertex: u32,
    /// Indices of the edge's two vertices.
    pub edge: [u32; 2],
    /// Approximate position of the meeting, for display.
    pub place: DVec2,
}

impl Recording {
    /// Returns the motion of the first `vertices` vertices in the frame, interval by interval.
    pub(crate) fn motion_intervals(&self, vertices: usize) -> Vec<MotionInterval> {
        if !self.0.channels.in_frame {
            let placer = self.0.warp.placer();
            let at_rest = |&place: &DVec2| VertexCurve {
                control_points: vec![place; 2],
                error: 0.0,
            };
            let places = &placer.placement().in_frame[..vertices];
            return vec![MotionInterval {
                times: [0.0, 1.0],
                curves: places.iter().map(at_rest).collect(),
            }];
        }
        let intervals = self.0.intervals.iter().map(|interval| {
            let curves = IntervalCurves::of(interval);
            MotionInterval {
                times: [interval.from, interval.to],
                curves: (0..vertices).map(|vertex| curves.curve(vertex)).collect(),
            }
        });
        intervals.collect()
    }

    /// Examines the recording at every t in [0, 1]: whether a face folds, and whether the given
    /// boundary loops meet. Takes about 20 µs for each face, plus a search for nearby edges.
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
        // If no vertex moves in the frame, the mesh is the same at every t, so nothing can fold or
        // meet.
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
