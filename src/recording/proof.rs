//! What holds of a film at every t.
//!
//! In a reel every vertex is a polynomial of s, and so is twice the area of a face,
//! and the side of an edge on which a vertex lies. Where all Bernstein coefficients
//! of one are positive, it is positive all along; where they are not, both halves are
//! looked at, down to a thousand-millionth of the reel. If no face turns over and no
//! outline meets itself or another, every frame is drawn as it should be.
//!
//! What is proved is the film that is played: all bounds are widened by what it is
//! rounded by. The film itself is as near to the warp as it states
//! ([`Recording::error`]).
//!
//! Guaranteed: what is said to be proved is so. Not guaranteed: that all that is so
//! can be proved; what cannot be decided is told as trouble, at the first t at which it
//! could not. A vertex that touches an edge at an end of the film, as the sides of a
//! cut do, is not looked at beside that edge for the first or last 1024th of the film,
//! and counted. At the ends themselves the designs are what they are: of a face that is
//! smaller than rounding they say on which side it is until it has grown.

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

/// What a film shows, or does not, at any t.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RecordingProof {
    /// The first t at which a face is not proved to be positive.
    pub fold: Option<FaceFold>,
    /// The first t at which outlines are not proved to be apart.
    pub meeting: Option<OutlineMeeting>,
    /// Vertices that touch an edge at an end of the film, and were not looked at
    /// beside that edge for the 1024th of the film that is there.
    pub touching: usize,
}

impl RecordingProof {
    /// No face turns over and no outline meets another, at any t.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.fold.is_none() && self.meeting.is_none()
    }
}

/// A face that turns over, or may.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FaceFold {
    /// When it begins, to 1e-9 of a reel.
    pub t: f64,
    /// Which.
    pub face: usize,
}

/// A vertex that meets an edge of an outline, or may.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OutlineMeeting {
    /// When, to 1e-9 of a reel.
    pub t: f64,
    /// The vertex.
    pub vertex: u32,
    /// The ends of the edge.
    pub edge: [u32; 2],
    /// Where the vertex is then.
    pub place: DVec2,
}

impl Recording {
    /// Looks at all faces and at all drawn boundaries of the film, at every t in
    /// [0, 1]. Takes some 20 µs a face, and a look at what is near each other.
    ///
    /// # Errors
    /// [`Cancelled`] if nobody wants the result any more.
    ///
    /// # Panics
    /// Where a walk names a vertex that there is not.
    pub fn prove(
        &self,
        walks: &[DrawnLoop],
        progress: &dyn Progress,
    ) -> Result<RecordingProof, Cancelled> {
        let mut proof = RecordingProof::default();
        // Where nothing moves in the frame, all is as in the designs.
        if !self.0.moving.in_frame {
            return Ok(proof);
        }
        let faces = self.0.warp.placer().placement().faces.clone();
        for reel in &self.0.reels {
            checkpoint(progress, "proving", reel.from)?;
            let ways = IntervalCurves::of(reel);
            let time = |s: f64| reel.from + s * (reel.to - reel.from);
            let at_ends = [reel.from == 0.0, reel.to == 1.0];
            if proof.fold.is_none() {
                let fold = folds::first_fold(&ways, &faces, at_ends, progress)?;
                proof.fold = fold.map(|(s, face)| FaceFold { t: time(s), face });
            }
            if proof.meeting.is_none() {
                let is_drawn =
                    |walk: &&DrawnLoop| walk.drawn[0] < reel.to && walk.drawn[1] > reel.from;
                let drawn: Vec<&DrawnLoop> = walks.iter().filter(is_drawn).collect();
                let found = meetings::first_meeting(&ways, &drawn, at_ends, progress)?;
                proof.touching += found.touching;
                proof.meeting = found.first.map(|(s, vertex, edge, place)| OutlineMeeting {
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
