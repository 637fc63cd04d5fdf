//! What is proved of the film of a transition.

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

/// How much is done once the film is recorded.
const RECORDED: f64 = 0.5;

/// What holds of a film at every t, and of what of it that is said.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TransitionProof {
    /// What was found.
    pub proof: RecordingProof,
    /// How many faces there are; none of boundary paths.
    pub faces: usize,
    /// How near the film is to what it was recorded from; see [`Recording::error`].
    pub film_error: f64,
    /// Holes that come and go, and parts that swell: nothing is said of these.
    pub left_out: usize,
    /// How far the guard moves a point aside at most, in diameters of the designs; none
    /// where nothing is moved. See [`CollisionAvoidance`].
    pub moved_aside: Option<f64>,
}

impl Transition {
    /// Records the film, if nobody did, and looks at it at every t in [0, 1]: does a
    /// face turn over, does an outline meet itself or another? None of what has no
    /// faces: fields and pictures.
    ///
    /// # Errors
    /// [`RecordingError`] if there is no film, or nobody wants it any more.
    pub fn prove(
        &self,
        options: &RecordingOptions,
        progress: &dyn Progress,
    ) -> Result<Option<TransitionProof>, RecordingError> {
        let Content::Solid(solid) = self.content() else {
            return Ok(None);
        };
        // Bars may cross, and their panels are not seen.
        if solid.loops.is_empty() {
            return Ok(None);
        }
        let [recording, proving] =
            [(0.0, RECORDED), (RECORDED, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
        let film: Recording = self.record(options, &recording)?;
        Ok(Some(TransitionProof {
            proof: film.prove(&walks(solid), &proving)?,
            faces: self.compatible().map_or(0, |mesh| mesh.faces().len()),
            film_error: film.error(),
            left_out: solid.holes.len() + solid.swells.len(),
            moved_aside: self.arap().and_then(Arap::moved_aside),
        }))
    }
}

/// The boundaries that are drawn as the vertices are placed.
fn walks(solid: &SolidContent) -> Vec<DrawnLoop> {
    let swells = |k: usize| solid.swells.iter().any(|swell| swell.walks().contains(&k));
    let level = |k: usize| match &solid.coating {
        Some(coating) => coating.of_walks[k],
        None => 0,
    };
    let drawn = |k: usize| {
        let speck = solid.specks.iter().find(|speck| speck.walks.contains(&k));
        let clock = solid.clocks.as_ref();
        let clock = clock.map_or(PartClock::WHOLE, |clocks| clocks.clocks[clocks.of_walks[k]]);
        speck.map_or([0.0, 1.0], |speck| speck.life.there(|t| clock.when(t)))
    };
    let walks = solid.loops.iter().enumerate();
    walks
        .filter(|(k, _)| !swells(*k))
        .map(|(k, walk)| DrawnLoop {
            vertices: walk.clone(),
            level: level(k),
            drawn: drawn(k),
        })
        .collect()
}

impl TransitionProof {
    /// No face turns over and no outline meets another, at any t, of all that is
    /// looked at.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.proof.holds()
    }

    /// Nothing is left out.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.left_out == 0 && self.proof.touching == 0
    }

    /// The first t at which something is not proved.
    #[must_use]
    pub fn first_t(&self) -> Option<f64> {
        let fold = self.proof.fold.map(|fold| fold.t);
        let meeting = self.proof.meeting.map(|meeting| meeting.t);
        fold.into_iter().chain(meeting).min_by(f64::total_cmp)
    }

    /// What was done for it, and what nothing is said of.
    fn write_exceptions(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(by) = self.moved_aside {
            let percent = 100.0 * by;
            write!(
                f,
                "; points are moved aside by up to {percent:.2} % of the diameter"
            )?;
        }
        let touching = self.proof.touching;
        if touching > 0 {
            write!(
                f,
                "; {touching} points that touch an edge at an end are left out there"
            )?;
        }
        if self.left_out > 0 {
            let count = self.left_out;
            write!(
                f,
                "; {count} holes and parts that come and go within their outline are left out"
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
                    "no face turns over, "
                } else {
                    ""
                };
                write!(f, "proved for every t in [0, 1]: {faces}no outlines meet")?;
            }
            _ => f.write_str("not proved")?,
        }
        if let Some(fold) = fold {
            write!(
                f,
                "; face {} may turn over at t = {:.9}",
                fold.face + 1,
                fold.t
            )?;
        }
        if let Some(meeting) = meeting {
            let (t, place) = (meeting.t, meeting.place);
            write!(
                f,
                "; outlines may meet at t = {t:.9}, near ({:.4}, {:.4})",
                place.x, place.y
            )?;
        }
        self.write_exceptions(f)
    }
}
