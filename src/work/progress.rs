//! How long work tells how far it is, and how it is cancelled.
//!
//! Everything slow in the core (import, matching, triangulation,
//! factorisation, export) takes a [`Progress`]. It promises to report often
//! enough for a progress bar, with shares of the whole that never go down, and
//! to stop within half a second of a cancel: what runs for longer than some
//! milliseconds asks whether it is [`still_wanted`], and a library's long call
//! runs [`beside`]. It does not promise that shares are proportional to time.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Receives progress and says whether the work is still wanted.
pub trait Progress: Sync {
    /// The work is in `stage`, a few words for people, and `fraction` in
    /// [0, 1] of it is done: of all that whoever started it waits for.
    fn report(&self, stage: &'static str, fraction: f64);

    /// `true` once nobody wants the result any more.
    fn is_cancelled(&self) -> bool;

    /// Whether whoever waits was told that it takes long, and wants it all the
    /// same, or has not been asked; see [`crate::work::budget`].
    fn is_patient(&self) -> bool {
        true
    }
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
/// use morphospace::work::progress::{Silent, checkpoint};
/// assert!(checkpoint(&Silent, "matching", 0.5).is_ok());
/// ```
pub fn checkpoint(
    progress: &dyn Progress,
    stage: &'static str,
    fraction: f64,
) -> Result<(), Cancelled> {
    progress.report(stage, fraction);
    still_wanted(progress)
}

/// Turns a cancel into an error and reports nothing: for loops within a stage,
/// which may ask at every turn.
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more.
pub fn still_wanted(progress: &dyn Progress) -> Result<(), Cancelled> {
    if progress.is_cancelled() {
        Err(Cancelled)
    } else {
        Ok(())
    }
}

/// How long a cancel may go unseen while something runs [`beside`].
const LOOKED_EVERY: Duration = Duration::from_millis(20);

/// Runs a long call that cannot be stopped on a thread of its own. On a cancel
/// it is left behind, to end when it ends; nobody waits for it. What it does in
/// parallel it does on threads of its own where the caller is one of those that
/// are shared: all of these may be waiting like this one.
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more.
///
/// # Panics
/// If the work does, or if no thread can be had.
///
/// ```
/// use morphospace::work::progress::{Silent, beside};
/// assert_eq!(beside(&Silent, || 6 * 7), Ok(42));
/// ```
pub fn beside<T: Send + 'static>(
    progress: &dyn Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Cancelled> {
    let (sender, answer) = channel();
    let is_shared = rayon::current_thread_index().is_some();
    let thread = std::thread::spawn(move || {
        let found = if is_shared { apart(work) } else { work() };
        sender.send(found).is_ok()
    });
    loop {
        match answer.recv_timeout(LOOKED_EVERY) {
            Ok(found) => return Ok(found),
            Err(RecvTimeoutError::Timeout) => still_wanted(progress)?,
            // The sender is dropped without a word by a panic alone.
            Err(RecvTimeoutError::Disconnected) => match thread.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(_) => return Err(Cancelled),
            },
        }
    }
}

/// Does the work with threads that nobody else waits for.
fn apart<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().build() {
        Ok(pool) => pool.install(work),
        // One that could not be had is no reason to give up what was asked for.
        Err(_) => work(),
    }
}

/// A share in [0, 1] that only grows, whoever tells it. Bits of such numbers
/// are ordered as the numbers are.
#[derive(Debug, Default)]
struct MonotoneFraction(AtomicU64);

impl MonotoneFraction {
    fn raise(&self, share: f64) {
        // Relaxed: the number stands alone.
        let bits = share.clamp(0.0, 1.0).to_bits();
        self.0.fetch_max(bits, Ordering::Relaxed);
    }

    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

/// All of some work: passes on what its parts tell as a share that never goes
/// down.
pub struct WholeProgress<'a> {
    inner: &'a dyn Progress,
    /// Locked while it is told on: else of two threads the one with the smaller
    /// share might come last.
    told: Mutex<f64>,
    patient: bool,
}

impl<'a> WholeProgress<'a> {
    /// Nothing is done yet.
    pub fn new(inner: &'a dyn Progress) -> Self {
        Self {
            inner,
            told: Mutex::default(),
            patient: inner.is_patient(),
        }
    }

    /// The same for somebody who is patient, or is not.
    #[must_use]
    pub fn patient(mut self, patient: bool) -> Self {
        self.patient = patient;
        self
    }
}

impl Progress for WholeProgress<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        *told = told.max(fraction.clamp(0.0, 1.0));
        self.inner.report(stage, *told);
    }

    fn is_cancelled(&self) -> bool {
        self.inner.is_cancelled()
    }

    fn is_patient(&self) -> bool {
        self.patient
    }
}

/// A part of some work that takes it from one share to another.
#[derive(Clone, Copy)]
pub struct ProgressSpan<'a> {
    inner: &'a dyn Progress,
    from: f64,
    to: f64,
}

impl<'a> ProgressSpan<'a> {
    /// The part from one share of the work to another.
    ///
    /// ```
    /// use morphospace::work::progress::{Progress, Silent, Span};
    /// let second_half = Span::new(&Silent, 0.5, 1.0);
    /// second_half.report("matching", 0.5); // three quarters of the whole
    /// ```
    pub fn new(inner: &'a dyn Progress, from: f64, to: f64) -> Self {
        Self { inner, from, to }
    }
}

impl Progress for ProgressSpan<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        let whole = self.from + fraction.clamp(0.0, 1.0) * (self.to - self.from);
        self.inner.report(stage, whole);
    }

    fn is_cancelled(&self) -> bool {
        self.inner.is_cancelled()
    }

    fn is_patient(&self) -> bool {
        self.inner.is_patient()
    }
}

/// Parts of some work that are done in any order, or side by side, and take
/// alike: what is done is the mean of their shares.
pub struct ProgressShares<'a> {
    inner: &'a dyn Progress,
    parts: Vec<MonotoneFraction>,
}

/// One of [`ProgressShares`].
#[derive(Clone, Copy)]
pub struct ProgressShare<'a> {
    all: &'a ProgressShares<'a>,
    part: usize,
}

impl<'a> ProgressShares<'a> {
    /// So many parts, none of them begun.
    pub fn new(inner: &'a dyn Progress, parts: usize) -> Self {
        let parts = std::iter::repeat_with(MonotoneFraction::default).take(parts);
        Self {
            inner,
            parts: parts.collect(),
        }
    }

    /// What a part reports to.
    ///
    /// ```
    /// use morphospace::work::progress::{Progress, Silent, Several};
    /// let parts = Several::new(&Silent, 4);
    /// parts.part(2).report("matching", 1.0); // a quarter of the whole
    /// ```
    pub fn part(&self, part: usize) -> ProgressShare<'_> {
        ProgressShare { all: self, part }
    }
}

impl Progress for ProgressShare<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        let parts = &self.all.parts;
        if let Some(part) = parts.get(self.part) {
            part.raise(fraction);
        }
        let done: f64 = parts.iter().map(MonotoneFraction::get).sum();
        self.all.inner.report(stage, done / parts.len() as f64);
    }

    fn is_cancelled(&self) -> bool {
        self.all.inner.is_cancelled()
    }

    fn is_patient(&self) -> bool {
        self.all.inner.is_patient()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicBool;
    use std::time::Instant;

    #[derive(Default)]
    struct RecordedProgress(Mutex<Vec<f64>>, AtomicBool);

    impl Progress for RecordedProgress {
        fn report(&self, _: &'static str, fraction: f64) {
            self.0.lock().expect("free").push(fraction);
        }

        fn is_cancelled(&self) -> bool {
            self.1.load(Ordering::Relaxed)
        }
    }

    #[test]
    fn parts_within_parts_make_one_share_that_never_goes_down() {
        let heard = RecordedProgress::default();
        let whole = WholeProgress::new(&heard);
        ProgressSpan::new(&whole, 0.0, 0.5).report("first", 1.0);
        let rest = ProgressSpan::new(&whole, 0.5, 1.0);
        let parts = ProgressShares::new(&rest, 2);
        parts.part(1).report("second", 0.5);
        parts.part(0).report("second", 1.0);
        parts.part(0).report("again", 0.0);
        ProgressSpan::new(&whole, 0.0, 0.5).report("first", 0.2);
        parts.part(1).report("second", 1.0);
        assert_eq!(
            *heard.0.lock().expect("free"),
            [0.5, 0.625, 0.875, 0.875, 0.875, 1.0]
        );
    }

    #[test]
    fn a_cancel_is_answered_while_work_goes_on_beside() {
        let heard = RecordedProgress::default();
        heard.1.store(true, Ordering::Relaxed);
        let begun = Instant::now();
        let long = Duration::from_secs(20);
        assert_eq!(
            beside(&heard, move || std::thread::sleep(long)),
            Err(Cancelled)
        );
        assert!(begun.elapsed() < long / 4);
    }

    #[test]
    fn work_in_parallel_is_done_while_all_threads_wait_for_such() {
        let sum = || {
            let (a, b) = rayon::join(|| 1, || 2);
            a + b
        };
        // Each of the shared threads waits for work that is done in parallel.
        let sums = rayon::broadcast(|_| beside(&Silent, sum));
        assert!(sums.iter().all(|sum| *sum == Ok(3)));
    }
}
