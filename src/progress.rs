//! How long work tells how far it is, and how it is cancelled.
//!
//! Everything slow in the core (import, matching, triangulation,
//! factorisation, export) takes a [`Progress`]. It promises to report often
//! enough for a progress bar and to stop soon after a cancel; it does not
//! promise that fractions are proportional to time.

/// Receives progress and says whether the work is still wanted.
pub trait Progress: Sync {
    /// The work is in `stage`, a few words for people, and `fraction` in
    /// [0, 1] of that stage is done.
    fn report(&self, stage: &'static str, fraction: f64);

    /// `true` once nobody wants the result any more.
    fn is_cancelled(&self) -> bool;
}

/// Reports to nobody and is never cancelled.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn report(&self, _stage: &'static str, _fraction: f64) {}

    fn is_cancelled(&self) -> bool {
        false
    }
}

/// The work was cancelled; nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the work was cancelled; start it again to have its result")]
pub struct Cancelled;

/// Reports, and turns a cancel into an error.
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more.
///
/// ```
/// use morphospace::progress::{Silent, checkpoint};
/// assert!(checkpoint(&Silent, "matching", 0.5).is_ok());
/// ```
pub fn checkpoint(
    progress: &dyn Progress,
    stage: &'static str,
    fraction: f64,
) -> Result<(), Cancelled> {
    progress.report(stage, fraction);
    if progress.is_cancelled() {
        Err(Cancelled)
    } else {
        Ok(())
    }
}
