//! How long each stage of some work took, heard from its progress.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::work::progress::Progress;

/// Stages and the seconds that they took.
pub(in crate::cli) type StageDurations = BTreeMap<&'static str, f64>;

/// Stages that belong to rigid parts once a mesh is there, and to fields.
const NOT_TRIANGULATING: [&str; 5] = [
    "subdividing",
    "decomposing",
    "factoring",
    "preparing frames",
    "measuring distances",
];

/// A progress that passes everything on and looks at the clock. A stage lasts
/// from its first report to the first of another one; what goes on before any
/// report belongs to no stage. Where several threads report, a time belongs to
/// the stage that was reported last, so that the stages add up to the whole.
pub(in crate::cli) struct StageClock<'a> {
    inner: &'a dyn Progress,
    heard: Mutex<StageReports>,
}

#[derive(Default)]
struct StageReports {
    now: Option<(&'static str, Instant)>,
    stages: StageDurations,
}

impl StageReports {
    fn change_to(&mut self, stage: Option<&'static str>) {
        let at = Instant::now();
        let before = std::mem::replace(&mut self.now, stage.map(|stage| (stage, at)));
        if let Some((name, begin)) = before {
            *self.stages.entry(name).or_default() += at.duration_since(begin).as_secs_f64();
        }
    }
}

impl<'a> StageClock<'a> {
    pub fn new(inner: &'a dyn Progress) -> Self {
        Self {
            inner,
            heard: Mutex::default(),
        }
    }

    /// Ends the stage that runs, and tells of all.
    pub fn stages(&self) -> StageDurations {
        // Times are whole whenever the lock is free, even after a panic.
        let mut heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        heard.change_to(None);
        std::mem::take(&mut heard.stages)
    }
}

impl Progress for StageClock<'_> {
    fn report(&self, stage: &'static str, fraction: f64) {
        let mut heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        if heard.now.is_none_or(|(now, _)| now != stage) {
            heard.change_to(Some(stage));
        }
        // Whoever listens next may take long, and others report meanwhile.
        drop(heard);
        self.inner.report(stage, fraction);
    }

    fn is_cancelled(&self) -> bool {
        self.inner.is_cancelled()
    }
}

/// Seconds of the stages that match boundaries and parts.
pub(super) fn matching(stages: &StageDurations) -> f64 {
    total(stages, is_matching)
}

/// Seconds of the stages that make a common triangulation.
pub(super) fn triangulating(stages: &StageDurations) -> f64 {
    total(stages, |stage| {
        !is_matching(stage) && !NOT_TRIANGULATING.contains(&stage)
    })
}

fn is_matching(stage: &str) -> bool {
    stage.starts_with("match") || stage.starts_with("pairing")
}

fn total(stages: &StageDurations, is: impl Fn(&str) -> bool) -> f64 {
    let chosen = stages.iter().filter(|(stage, _)| is(stage));
    // Not summed: of none that is -0.
    chosen.fold(0.0, |sum, (_, seconds)| sum + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Silent;
    use std::time::Duration;

    #[test]
    fn stages_are_told_apart_and_added_up() {
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
