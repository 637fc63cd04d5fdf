//! What is first not proved of a film.

use super::drawn::Drawn;
use crate::film::proof::{Meeting, Proof};
use crate::film::{Film, FilmError, FilmOptions};
use crate::progress::Progress;
use crate::transition::error::BuildError;
use crate::warp::Arap;
use std::sync::Arc;

/// Where a film folds or its outlines meet first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trouble {
    pub t: f64,
    /// What meets then.
    pub meeting: Option<Meeting>,
}

/// What is first not proved of a film; nothing where it does not settle.
pub(super) fn trouble(
    film: &Arap,
    drawn: &Drawn,
    progress: &dyn Progress,
) -> Result<Option<Option<Trouble>>, BuildError> {
    let recorded = Film::record(Arc::new(film.clone()), &FilmOptions::default(), progress);
    let recorded = match recorded {
        Ok(recorded) => recorded,
        Err(FilmError::Cancelled(cancelled)) => return Err(cancelled.into()),
        Err(_) => return Ok(None),
    };
    let Proof { fold, meeting, .. } = recorded.prove(&drawn.walks(film), progress)?;
    let folds = fold.map(|fold| Trouble {
        t: fold.t,
        meeting: None,
    });
    let meets = meeting.map(|meeting| Trouble {
        t: meeting.t,
        meeting: Some(meeting),
    });
    let both = folds.into_iter().chain(meets);
    Ok(Some(both.min_by(|a, b| a.t.total_cmp(&b.t))))
}
