//! The first fold or collision of a motion: the smallest t at which its proof fails.

use super::drawn_pieces::DrawnPieces;
use crate::recording::proof::{OutlineMeeting, RecordingProof};
use crate::recording::{Recording, RecordingError, RecordingOptions};
use crate::transition::error::BuildError;
use crate::warp::Arap;
use crate::work::progress::Progress;
use std::sync::Arc;

/// First time at which a face folds or outlines meet, or at which the proof cannot exclude that one
/// of these happens.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstDefect {
    pub t: f64,
    /// The vertex and edge that meet; `None` if the defect is a fold.
    pub meeting: Option<OutlineMeeting>,
}

/// Records a motion and returns its first defect; `Some(None)` if it has none. Returns `None` if
/// the motion cannot be recorded.
///
/// # Errors
/// If the work is cancelled.
pub(super) fn trouble(
    film: &Arap,
    drawn: &DrawnPieces,
    progress: &dyn Progress,
) -> Result<Option<Option<FirstDefect>>, BuildError> {
    let recorded = Recording::record(
        Arc::new(film.clone()),
        &RecordingOptions::default(),
        progress,
    );
    let recorded = match recorded {
        Ok(recorded) => recorded,
        Err(RecordingError::Cancelled(cancelled)) => return Err(cancelled.into()),
        Err(_) => return Ok(None),
    };
    let RecordingProof { fold, meeting, .. } = recorded.prove(&drawn.walks(film), progress)?;
    let folds = fold.map(|fold| FirstDefect {
        t: fold.t,
        meeting: None,
    });
    let meets = meeting.map(|meeting| FirstDefect {
        t: meeting.t,
        meeting: Some(meeting),
    });
    let both = folds.into_iter().chain(meets);
    Ok(Some(both.min_by(|a, b| a.t.total_cmp(&b.t))))
}
