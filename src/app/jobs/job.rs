//! Background job: a thread that reports progress and can be cancelled.
//!
//! Uses separate threads instead of Bevy's task pool: on a two-core machine that pool has one
//! worker, and exporting a film must not delay building a transition. A panic inside a job is
//! returned as an error and affects nothing else.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use crate::work::progress::Progress;

/// Function that wakes the window. There is one for the process, because the process has one event
/// loop.
static WAKE: OnceLock<Box<dyn Fn() + Send + Sync>> = OnceLock::new();

/// Sets the function that wakes the window whenever a job has news. Without it, as in tests,
/// results are picked up by polling.
pub fn set_waker(wake: impl Fn() + Send + Sync + 'static) {
    // If a function is set already, it stays: all windows of a process use the same event loop.
    drop(WAKE.set(Box::new(wake)));
}

/// Wakes the window because a job has news.
pub fn wake() {
    if let Some(wake) = WAKE.get() {
        wake();
    }
}

/// Wakes the window on drop, so that the window notices a panic of the job as quickly as a result.
struct WakeOnDrop;

impl Drop for WakeOnDrop {
    fn drop(&mut self) {
        wake();
    }
}

/// Progress of a job and its cancellation flag, shared with its thread.
#[derive(Debug, Default)]
pub struct JobTracker {
    stage: Mutex<&'static str>,
    permille: AtomicU32,
    cancelled: AtomicBool,
}

impl Progress for JobTracker {
    fn report(&self, stage: &'static str, fraction: f64) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = stage;
        // Stored in thousandths, because there is no atomic float; a progress bar 120 logical
        // pixels wide shows no finer steps.
        let permille = (fraction.clamp(0.0, 1.0) * 1000.0) as u32;
        // Relaxed ordering suffices here and below, because the values are independent.
        self.permille.store(permille, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Reason why a job has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum JobError<E> {
    /// The work itself returned an error.
    #[error(transparent)]
    Failed(E),
    /// The thread panicked or could not be started; contains the job's name.
    #[error("internal error ({0}); this is a bug, please report it")]
    Panicked(&'static str),
}

/// Work running in the background.
#[derive(Debug)]
pub struct BackgroundJob<T, E> {
    name: &'static str,
    started: Instant,
    tracker: Arc<JobTracker>,
    result: Mutex<Receiver<Result<T, E>>>,
}

impl<T: Send + 'static, E: Send + 'static> BackgroundJob<T, E> {
    /// Starts the work on a thread with this name. The name also appears in error messages.
    pub fn start(
        name: &'static str,
        work: impl FnOnce(&JobTracker) -> Result<T, E> + Send + 'static,
    ) -> Self {
        let (sender, receiver) = channel();
        let tracker = Arc::new(JobTracker::default());
        let thread_tracker = Arc::clone(&tracker);
        // If the thread cannot be started, the sender is dropped here and `poll` returns
        // `Panicked`.
        std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                // Local variables are dropped in reverse order: first the sender, then `_wakes`,
                // which wakes the window last.
                let _wakes = WakeOnDrop;
                let sender = sender;
                // Sending fails once the job has been dropped; the result is then unwanted.
                sender.send(work(&thread_tracker)).ok();
            })
            .ok();
        Self {
            name,
            started: Instant::now(),
            tracker,
            result: Mutex::new(receiver),
        }
    }

    /// Result of the work, returned once; `None` while it runs.
    ///
    /// # Errors
    /// The work failed, panicked or could not be started.
    pub fn poll(&self) -> Option<Result<T, JobError<E>>> {
        let result = self.result.lock().unwrap_or_else(PoisonError::into_inner);
        match result.try_recv() {
            Ok(result) => Some(result.map_err(JobError::Failed)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(JobError::Panicked(self.name))),
        }
    }

    /// Result of a finished job, which is then removed; `None` while it runs.
    ///
    /// # Errors
    /// As [`poll`](Self::poll).
    pub fn take_result(job: &mut Option<Self>) -> Option<Result<T, JobError<E>>> {
        let result = job.as_ref()?.poll()?;
        *job = None;
        Some(result)
    }

    /// Time since the job started.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.started.elapsed()
    }

    /// Name of the current step of the work, and the last reported progress of the whole work in
    /// [0, 1].
    #[must_use]
    pub fn progress(&self) -> (&'static str, f64) {
        let stage = *self
            .tracker
            .stage
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        (
            stage,
            f64::from(self.tracker.permille.load(Ordering::Relaxed)) / 1000.0,
        )
    }

    /// Asks the work to stop at its next cancellation check; the job then still returns a result.
    pub fn cancel(&self) {
        self.tracker.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether the job was asked to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.tracker.is_cancelled()
    }
}

impl<T, E> Drop for BackgroundJob<T, E> {
    fn drop(&mut self) {
        // The thread is not joined: it stops at its next cancellation check, and its result is
        // discarded.
        self.tracker.cancelled.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Cancelled;

    fn wait<T: Send + 'static>(
        job: &BackgroundJob<T, Cancelled>,
    ) -> Result<T, JobError<Cancelled>> {
        loop {
            if let Some(result) = job.poll() {
                return result;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn a_result_comes_back() {
        let job = BackgroundJob::start("sum", |_| Ok(1 + 1));
        assert_eq!(wait(&job), Ok(2));
    }

    #[test]
    fn a_panic_is_an_error() {
        let job: BackgroundJob<(), _> =
            BackgroundJob::start("fault", |_| panic!("intended by the test"));
        assert_eq!(wait(&job), Err(JobError::Panicked("fault")));
    }

    #[test]
    fn a_cancelled_job_stops() {
        let job = BackgroundJob::start("endless", |tracker| {
            while !tracker.is_cancelled() {
                tracker.report("waiting", 0.25);
                std::thread::yield_now();
            }
            Err(Cancelled)
        });
        job.cancel();
        assert_eq!(wait::<()>(&job), Err(JobError::Failed(Cancelled)));
    }
}
