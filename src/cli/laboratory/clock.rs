//! Measures how long each stage of a computation takes, from its progress reports.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::work::progress::Progress;

/// Duration of each progress stage in seconds, by the name of the stage.
pub(in crate::cli) type StageDurations = BTreeMap<&'static str, f64>;

/// Progress stages that [`triangulating`] does not count: the preparation of rigid parts once they
/// have a mesh, and the computation of distance fields. (Matching is not counted either.)
const NOT_TRIANGULATING: [&str; 5] = [
    "subdividing",
    "decomposing",
    "factoring",
    "preparing frames",
    "measuring distances",
];

/// A [`Progress`] that forwards all reports and measures the duration of each stage.
///
/// A stage lasts from its first report to the first report of another stage. Time before the first
/// report belongs to no stage. If several threads report, the time counts for the stage that was
/// reported last, so the durations add up to the elapsed time.
pub(in crate::cli) struct StageClock<'a> {
    inner: &'a dyn Progress,
    timer: Mutex<StageTimer>,
}

/// Current progress stage, and the durations of the stages that have ended.
#[derive(Default)]
struct StageTimer {
    /// Name of the current progress stage and the moment of its first report; `None` before the
    /// first stage and after [`StageClock::stages`].
    current: Option<(&'static str, Instant)>,
    stages: StageDurations,
}

impl StageTimer {
    /// Ends the current progress stage and starts `stage`, if there is one.
    fn change_to(&mut self, stage: Option<&'static str>) {
        let now = Instant::now();
        let previous = std::mem::replace(&mut self.current, stage.map(|stage| (stage, now)));
        if let Some((name, start)) = previous {
            *self.stages.entry(name).or_default() += now.duration_since(start).as_secs_f64();
        }
    }
}

impl<'a> StageClock<'a> {
    /// Creates a clock that forwards all reports to `inner`.
    pub fn new(inner: &'a dyn Progress) -> Self {
        Self {
            inner,
            timer: Mutex::default(),
        }
    }

    /// Ends the current progress stage and returns the durations of all stages since the last call.
    pub fn stages(&self) -> StageDurations {
        // The data is complete whenever the lock is free, even after a panic.
        let mut timer = self.timer.lock().unwrap_or_else(PoisonError::into_inner);
        timer.change_to(None);
        std::mem::take(&mut timer.stages)
    }
}

impl Progress for StageClock<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        let mut timer = self.timer.lock().unwrap_or_else(PoisonError::into_inner);
        if timer.current.is_none_or(|(name, _)| name != stage) {
            timer.change_to(Some(stage));
        }
        // The inner progress may take long, and other threads must not wait for it.
        drop(timer);
        self.inner.report(stage, fraction);
    }

    fn is_cancelled(&self) -> bool {
        self.inner.is_cancelled()
    }
}

/// Returns the duration of the progress stages that match boundaries and parts, in seconds.
pub(super) fn matching(stages: &StageDurations) -> f64 {
    total(stages, is_matching)
}

/// Returns the duration of all progress stages that are neither matching nor in
/// [`NOT_TRIANGULATING`], in seconds. For outlines this is mostly the common triangulation and its
/// improvement; reading the designs is included.
pub(super) fn triangulating(stages: &StageDurations) -> f64 {
    total(stages, |stage| {
        !is_matching(stage) && !NOT_TRIANGULATING.contains(&stage)
    })
}

fn is_matching(stage: &str) -> bool {
    stage.starts_with("match") || stage.starts_with("pairing")
}

/// Returns the sum of the durations of the selected progress stages, in seconds.
fn total(stages: &StageDurations, is_selected: impl Fn(&str) -> bool) -> f64 {
    let selected = stages.iter().filter(|(stage, _)| is_selected(stage));
    // `sum` would return -0.0 for no stages, which prints as "-0".
    selected.fold(0.0, |sum, (_, seconds)| sum + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Silent;
    use std::time::Duration;

    #[test]
    fn stages_are_timed_separately_and_summed() {
        let clock = StageClock::new(&Silent);
        for stage in [
            "matching",
            "matching",
            "triangulating",
            "matching",
            "factoring",
        ] {
            clock.report(stage, 0.5);
            std::thread::sleep(Duration::from_millis(2));
        }
        let stages = clock.stages();
        let names: Vec<_> = stages.keys().copied().collect();
        assert_eq!(names, ["factoring", "matching", "triangulating"]);
        assert!(matching(&stages) >= 0.006);
        assert_eq!(triangulating(&stages), stages["triangulating"]);
        assert_eq!(clock.stages(), StageDurations::new());
    }
}
