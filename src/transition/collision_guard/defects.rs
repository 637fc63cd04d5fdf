//! What is first not proved of a film.

use super::drawn_pieces::DrawnPieces;
use crate::recording::proof::{OutlineMeeting, RecordingProof};
use crate::recording::{Recording, RecordingError, RecordingOptions};
use crate::transition::error::BuildError;
use crate::warp::Arap;
use crate::work::progress::Progress;
use std::sync::Arc;

/// Where a film folds or its outlines meet first.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstDefect {
    pub t: f64,
    /// What meets then.
    pub meeting: Option<OutlineMeeting>,
}

/// What is first not proved of a film; nothing where it does not settle.
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
