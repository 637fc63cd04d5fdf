//! Work beside the window: a thread that tells how far it is and can be cancelled.
//!
//! A thread of its own, not a place in Bevy's pool: on a machine with two cores that pool has a
//! single worker, and a film that is being written must not keep a transition from being built.
//! A panic in the work is an answer like any other and takes nothing else down.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use crate::work::progress::Progress;

/// What wakes the window. One for the process, as its event loop is.
static WAKE: OnceLock<Box<dyn Fn() + Send + Sync>> = OnceLock::new();

/// Has the window woken by this whenever work has something to tell. Without it, as in tests,
/// answers are found where they are looked for.
pub fn set_waker(wake: impl Fn() + Send + Sync + 'static) {
    // A second window of one process would wake by the same event loop.
    drop(WAKE.set(Box::new(wake)));
}

/// Work has something to tell.
pub fn wake() {
    if let Some(wake) = WAKE.get() {
        wake();
    }
}

/// Wakes when it is dropped, so that a panic is told as soon as an answer.
struct WakeOnDrop;

impl Drop for WakeOnDrop {
    fn drop(&mut self) {
        wake();
    }
}

/// How far the work is, and whether it is still wanted.
#[derive(Debug, Default)]
pub struct JobTracker {
    stage: Mutex<&'static str>,
    permille: AtomicU32,
    cancelled: AtomicBool,
}

impl Progress for JobTracker {
    fn report(&self, stage: &'static str, fraction: f64) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = stage;
        // There is no atomic float, and a bar of 120 points shows no more than a thousandth.
        let permille = (fraction.clamp(0.0, 1.0) * 1000.0) as u32;
        // Relaxed, here and below: each value stands alone, and nothing is read because of another.
        self.permille.store(permille, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// Why work came to nothing.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum JobError<E> {
    /// It says so.
    #[error(transparent)]
    Failed(E),
    /// It did not come back: it panicked, or no thread could be had for it.
    #[error("the work on {0} broke off; this is a fault of the program, please report it")]
    Broken(&'static str),
}

/// A piece of work that runs beside the window.
#[derive(Debug)]
pub struct BackgroundJob<T, E> {
    name: &'static str,
    started: Instant,
    tracker: Arc<JobTracker>,
    answer: Mutex<Receiver<Result<T, E>>>,
}

impl<T: Send + 'static, E: Send + 'static> BackgroundJob<T, E> {
    /// Starts the work on a thread of that name.
    pub fn start(
        name: &'static str,
        work: impl FnOnce(&JobTracker) -> Result<T, E> + Send + 'static,
    ) -> Self {
        let (sender, receiver) = channel();
        let tracker = Arc::new(JobTracker::default());
        let theirs = Arc::clone(&tracker);
        // Where no thread can be had the sender is dropped here, and `poll` says that it broke.
        std::thread::Builder::new()
            .name(name.to_owned())
            .spawn(move || {
                // Before the sender, so that it is dropped after.
                let _wakes = WakeOnDrop;
                let sender = sender;
                // Nobody listens any more once the job was dropped; then the answer is not wanted.
                sender.send(work(&theirs)).ok();
            })
            .ok();
        Self {
            name,
            started: Instant::now(),
            tracker,
            answer: Mutex::new(receiver),
        }
    }

    /// The answer, once, when it is there.
    ///
    /// # Errors
    /// The work failed, panicked or could not be started.
    pub fn poll(&self) -> Option<Result<T, JobError<E>>> {
        let answer = self.answer.lock().unwrap_or_else(PoisonError::into_inner);
        match answer.try_recv() {
            Ok(answer) => Some(answer.map_err(JobError::Failed)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(JobError::Broken(self.name))),
        }
    }

    /// The answer, when it is there; then the job is gone.
    ///
    /// # Errors
    /// As [`poll`](Self::poll).
    pub fn take(job: &mut Option<Self>) -> Option<Result<T, JobError<E>>> {
        let answer = job.as_ref()?.poll()?;
        *job = None;
        Some(answer)
    }

    /// How long it has been going on.
    #[must_use]
    pub fn lasts(&self) -> Duration {
        self.started.elapsed()
    }

    /// What it is at, and how far, 0 to 1.
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

    /// Asks the work to stop; it answers when it has.
    pub fn cancel(&self) {
        self.tracker.cancelled.store(true, Ordering::Relaxed);
    }

    /// It was asked to stop.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.tracker.is_cancelled()
    }
}

impl<T, E> Drop for BackgroundJob<T, E> {
    fn drop(&mut self) {
        // Nobody takes the answer any more, and the thread is not joined: it ends where it looks.
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
            if let Some(answer) = job.poll() {
                return answer;
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn an_answer_comes_back() {
        let job = BackgroundJob::start("sum", |_| Ok(1 + 1));
        assert_eq!(wait(&job), Ok(2));
    }

    #[test]
    fn a_panic_is_an_answer() {
        let job: BackgroundJob<(), _> =
            BackgroundJob::start("fault", |_| panic!("as the test wants it"));
        assert_eq!(wait(&job), Err(JobError::Broken("fault")));
    }

    #[test]
    fn work_hears_that_it_is_cancelled() {
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
