//! How long each stage of some work took, heard from its progress.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::progress::Progress;

/// Stages and the time that they took, in the order of their beginning.
pub(in crate::cli) type Stages = Vec<(&'static str, Duration)>;

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
    heard: Mutex<Heard>,
}

#[derive(Default)]
struct Heard {
    now: Option<(&'static str, Instant)>,
    stages: Stages,
}

impl Heard {
    fn change_to(&mut self, stage: Option<&'static str>) {
        let at = Instant::now();
        let before = std::mem::replace(&mut self.now, stage.map(|stage| (stage, at)));
        let Some((name, begin)) = before else { return };
        let took = at.duration_since(begin);
        match self.stages.iter_mut().find(|(other, _)| *other == name) {
            Some((_, total)) => *total += took,
            None => self.stages.push((name, took)),
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
    pub fn stages(&self) -> Stages {
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
        drop(heard);
        self.inner.report(stage, fraction);
    }

    fn is_cancelled(&self) -> bool {
        self.inner.is_cancelled()
    }
}

/// Time of the stages that match boundaries and parts.
pub(super) fn matching(stages: &Stages) -> Duration {
    total(stages, is_matching)
}

/// Time of the stages that make a common triangulation.
pub(super) fn triangulating(stages: &Stages) -> Duration {
    total(stages, |stage| {
        !is_matching(stage) && !NOT_TRIANGULATING.contains(&stage)
    })
}

fn is_matching(stage: &str) -> bool {
    stage.starts_with("match") || stage.starts_with("pairing")
}

fn total(stages: &Stages, is: impl Fn(&str) -> bool) -> Duration {
    let chosen = stages.iter().filter(|(stage, _)| is(stage));
    chosen.map(|(_, time)| *time).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Silent;

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
        let names: Vec<_> = stages.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["matching", "triangulating", "factoring"]);
        assert!(matching(&stages) >= Duration::from_millis(6));
        assert_eq!(triangulating(&stages), stages[1].1);
        assert_eq!(clock.stages(), Vec::new());
    }
}
