//! Progress reports and cancellation of long computations.
//!
//! Every slow operation of the core (import, matching, triangulation, factorisation, export) takes
//! a [`Progress`]. The operation reports often enough for a progress bar, with fractions that never
//! decrease, and stops within half a second of being cancelled: loops of more than a few
//! milliseconds call [`check_cancelled`], and long calls into a library run through
//! [`run_cancellable`]. Fractions are not proportional to time.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Receives progress reports and decides whether the work continues.
pub trait Progress: Sync {
    /// Reports the current stage, in a few words for people, and the fraction done, in [0, 1].
    ///
    /// The fraction refers to the whole computation, not to the stage.
    fn report(&self, stage: &'static str, fraction: f64);

    /// Returns `true` once the work has been cancelled.
    fn is_cancelled(&self) -> bool;

    /// Returns whether jobs that exceed the limits of [`crate::work::budget`] may start.
    ///
    /// `false` if a user is waiting and has not yet confirmed such a job.
    fn is_patient(&self) -> bool {
        true
    }
}

/// A [`Progress`] that ignores reports and is never cancelled.
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
#[error("the work was cancelled; start it again to get the result")]
pub struct Cancelled;

/// Reports progress, and returns an error if the work was cancelled.
///
/// # Errors
/// [`Cancelled`] if the work was cancelled.
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
    check_cancelled(progress)
}

/// Returns an error if the work was cancelled, without reporting progress.
///
/// Cheap enough for every iteration of a loop within a stage.
///
/// # Errors
/// [`Cancelled`] if the work was cancelled.
pub fn check_cancelled(progress: &dyn Progress) -> Result<(), Cancelled> {
    if progress.is_cancelled() {
        Err(Cancelled)
    } else {
        Ok(())
    }
}

/// Interval at which [`run_cancellable`] checks for cancellation (heuristic).
const CANCEL_POLL_INTERVAL: Duration = Duration::from_millis(20);

/// Runs a call that cannot be interrupted, on a separate thread. Returns when the call ends or is
/// cancelled.
///
/// A cancelled call keeps running in the background until it ends, and its result is dropped.
/// If the caller is a rayon thread, parallel work inside the call gets its own thread pool:
/// otherwise it could deadlock, because all shared threads may be waiting in this function.
///
/// # Errors
/// [`Cancelled`] if the work was cancelled.
///
/// # Panics
/// If the call panics, or if no thread can be started.
///
/// ```
/// use morphospace::work::progress::{Silent, run_cancellable};
/// assert_eq!(run_cancellable(&Silent, || 6 * 7), Ok(42));
/// ```
pub fn run_cancellable<T: Send + 'static>(
    progress: &dyn Progress,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<T, Cancelled> {
    let (sender, receiver) = channel();
    let is_shared = rayon::current_thread_index().is_some();
    let thread = std::thread::spawn(move || {
        let result = if is_shared { in_own_pool(work) } else { work() };
        sender.send(result).is_ok()
    });
    loop {
        match receiver.recv_timeout(CANCEL_POLL_INTERVAL) {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => check_cancelled(progress)?,
            // The sender is dropped without a result only if the call panics.
            Err(RecvTimeoutError::Disconnected) => match thread.join() {
                Err(panic) => std::panic::resume_unwind(panic),
                Ok(_) => return Err(Cancelled),
            },
        }
    }
}

/// Runs the work in a separate rayon thread pool.
fn in_own_pool<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().build() {
        Ok(pool) => pool.install(work),
        // If no pool can be created, the work still runs, on the shared threads.
        Err(_) => work(),
    }
}

/// Fraction in [0, 1] that any thread can raise and none can lower.
///
/// Stored as the bits of an `f64`: bit patterns of non-negative floats are ordered like the
/// numbers.
#[derive(Debug, Default)]
struct MonotoneFraction(AtomicU64);

impl MonotoneFraction {
    /// Sets the fraction, unless it is already larger.
    fn raise(&self, fraction: f64) {
        // Relaxed ordering suffices: no other data depends on this number.
        let bits = fraction.clamp(0.0, 1.0).to_bits();
        self.0.fetch_max(bits, Ordering::Relaxed);
    }

    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

/// Progress of a whole computation. Passes reports on, with a fraction that never decreases.
pub struct OverallProgress<'a> {
    inner: &'a dyn Progress,
    /// Largest fraction reported so far. The lock is held while a report is passed on, so that the
    /// reports of two threads arrive in increasing order.
    reported: Mutex<f64>,
    patient: bool,
}

impl<'a> OverallProgress<'a> {
    /// Creates a progress at fraction 0 that passes reports on to `inner`. Jobs that exceed the
    /// limits may start if `inner` permits them.
    pub fn new(inner: &'a dyn Progress) -> Self {
        Self {
            inner,
            reported: Mutex::default(),
            patient: inner.is_patient(),
        }
    }

    /// Sets whether jobs that exceed the limits may start; see [`Progress::is_patient`].
    #[must_use]
    pub fn patient(mut self, patient: bool) -> Self {
        self.patient = patient;
        self
    }
}

impl Progress for OverallProgress<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        let mut reported = self.reported.lock().unwrap_or_else(PoisonError::into_inner);
        *reported = reported.max(fraction.clamp(0.0, 1.0));
        self.inner.report(stage, *reported);
    }

    fn is_cancelled(&self) -> bool {
        self.inner.is_cancelled()
    }

    fn is_patient(&self) -> bool {
        self.patient
    }
}

/// Progress of one step of a computation. The fractions of the step, from 0 to 1, are mapped to a
/// given range of fractions of the whole computation.
#[derive(Clone, Copy)]
pub struct ProgressSpan<'a> {
    inner: &'a dyn Progress,
    from: f64,
    to: f64,
}

impl<'a> ProgressSpan<'a> {
    /// Creates the progress of one step of a computation. The step advances `inner` from the
    /// fraction `from` to `to`.
    ///
    /// ```
    /// use morphospace::work::progress::{Progress, ProgressSpan, Silent};
    /// let second_half = ProgressSpan::new(&Silent, 0.5, 1.0);
    /// second_half.report("matching", 0.5); // three quarters of the whole
    /// ```
    pub fn new(inner: &'a dyn Progress, from: f64, to: f64) -> Self {
        Self { inner, from, to }
    }
}

impl Progress for ProgressSpan<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        let overall = self.from + fraction.clamp(0.0, 1.0) * (self.to - self.from);
        self.inner.report(stage, overall);
    }

    fn is_cancelled(&self) -> bool {
        self.inner.is_cancelled()
    }

    fn is_patient(&self) -> bool {
        self.inner.is_patient()
    }
}

/// Progress of a computation that consists of equally weighted tasks, which may run in any order or
/// in parallel.
///
/// The fraction reported for the whole is the mean of the tasks' fractions.
pub struct ProgressShares<'a> {
    inner: &'a dyn Progress,
    parts: Vec<MonotoneFraction>,
}

/// Progress of one task of [`ProgressShares`].
#[derive(Clone, Copy)]
pub struct ProgressShare<'a> {
    all: &'a ProgressShares<'a>,
    part: usize,
}

impl<'a> ProgressShares<'a> {
    /// Creates the given number of tasks, all at the fraction 0.
    pub fn new(inner: &'a dyn Progress, parts: usize) -> Self {
        let parts = std::iter::repeat_with(MonotoneFraction::default).take(parts);
        Self {
            inner,
            parts: parts.collect(),
        }
    }

    /// Returns the progress of the task with this index.
    ///
    /// ```
    /// use morphospace::work::progress::{Progress, ProgressShares, Silent};
    /// let parts = ProgressShares::new(&Silent, 4);
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
    fn nested_parts_make_one_fraction_that_never_decreases() {
        let recorded = RecordedProgress::default();
        let whole = OverallProgress::new(&recorded);
        ProgressSpan::new(&whole, 0.0, 0.5).report("first", 1.0);
        let second_half = ProgressSpan::new(&whole, 0.5, 1.0);
        let parts = ProgressShares::new(&second_half, 2);
        parts.part(1).report("second", 0.5);
        parts.part(0).report("second", 1.0);
        parts.part(0).report("again", 0.0);
        ProgressSpan::new(&whole, 0.0, 0.5).report("first", 0.2);
        parts.part(1).report("second", 1.0);
        assert_eq!(
            *recorded.0.lock().expect("free"),
            [0.5, 0.625, 0.875, 0.875, 0.875, 1.0]
        );
    }

    #[test]
    fn cancelling_returns_while_the_call_still_runs() {
        let cancelled = RecordedProgress::default();
        cancelled.1.store(true, Ordering::Relaxed);
        let started = Instant::now();
        let long = Duration::from_secs(20);
        assert_eq!(
            run_cancellable(&cancelled, move || std::thread::sleep(long)),
            Err(Cancelled)
        );
        assert!(started.elapsed() < long / 4);
    }

    #[test]
    fn parallel_calls_finish_while_all_shared_threads_wait() {
        let sum = || {
            let (a, b) = rayon::join(|| 1, || 2);
            a + b
        };
        // Every shared thread waits for a call that itself runs in parallel.
        let sums = rayon::broadcast(|_| run_cancellable(&Silent, sum));
        assert!(sums.iter().all(|sum| *sum == Ok(3)));
    }
}
