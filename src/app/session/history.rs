//! Undo and redo of all changes to the project.
//!
//! One gesture is one step: all changes while a mouse button is held, or all text typed into one
//! field. A step stores the whole project before and after it, together with the folder that its
//! relative paths refer to, so that old steps remain valid after saving to another folder.

use std::path::PathBuf;

use undo::{Edit, Merged, Record};

use crate::project::Project;

/// Maximum number of undo steps (resource limit: each stores two projects of some kilobytes, more
/// if each face has its own weight in the ARAP energy).
const MAX_STEPS: usize = 200;

/// The project at one moment, as stored in an undo step.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectSnapshot {
    /// The project's settings.
    pub project: Project,
    /// Folder that relative paths refer to; `None` for a bundled project.
    pub folder: Option<PathBuf>,
}

/// One undo step.
#[derive(Clone, Debug)]
struct HistoryStep {
    before: ProjectSnapshot,
    after: ProjectSnapshot,
    mark: Option<u64>,
    amends: bool,
}

impl Edit for HistoryStep {
    type Target = ();
    type Output = ProjectSnapshot;

    fn edit(&mut self, (): &mut ()) -> ProjectSnapshot {
        self.after.clone()
    }

    fn undo(&mut self, (): &mut ()) -> ProjectSnapshot {
        self.before.clone()
    }

    fn merge(&mut self, other: Self) -> Merged<Self> {
        // A change without a gesture number is a separate step, unless it amends the step before.
        let is_same = self.mark.is_some() && self.mark == other.mark;
        if !(is_same || other.amends) {
            return Merged::No(other);
        }
        if self.before == other.after {
            // A slider that was dragged away and back leaves nothing to undo.
            return Merged::Annul;
        }
        self.after = other.after;
        Merged::Yes
    }
}

/// The steps that can be undone and redone.
#[derive(Debug)]
pub struct UndoHistory(Record<HistoryStep>);

impl Default for UndoHistory {
    fn default() -> Self {
        Self(Record::builder().limit(MAX_STEPS).saved(false).build())
    }
}

impl UndoHistory {
    /// Records a change. Changes of the same gesture (`mark`) form one step.
    pub fn record(&mut self, before: ProjectSnapshot, after: ProjectSnapshot, mark: Option<u64>) {
        self.push(before, after, mark, false);
    }

    /// Corrects the last step, because its change was rejected or replaced.
    pub fn amend(&mut self, before: ProjectSnapshot, after: ProjectSnapshot) {
        self.push(before, after, None, true);
    }

    fn push(
        &mut self,
        before: ProjectSnapshot,
        after: ProjectSnapshot,
        mark: Option<u64>,
        amends: bool,
    ) {
        if before == after {
            return;
        }
        let step = HistoryStep {
            before,
            after,
            mark,
            amends,
        };
        self.0.edit(&mut (), step);
    }

    /// Whether there is a step to undo.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.0.can_undo()
    }

    /// Whether there is a step to redo.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.0.can_redo()
    }

    /// Undoes the last step; returns the project as it was before it, or `None` if there is no step
    /// to undo.
    pub fn undo(&mut self) -> Option<ProjectSnapshot> {
        self.0.undo(&mut ())
    }

    /// Redoes the next step; returns the project as it was after it, or `None` if there is no step
    /// to redo.
    pub fn redo(&mut self) -> Option<ProjectSnapshot> {
        self.0.redo(&mut ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(title: &str) -> ProjectSnapshot {
        let mut project = Project::from_pair("a.svg", "b.svg");
        title.clone_into(&mut project.title);
        ProjectSnapshot {
            project,
            folder: None,
        }
    }

    #[test]
    fn one_gesture_is_one_step() {
        let mut history = UndoHistory::default();
        history.record(at("0"), at("1"), Some(7));
        history.record(at("1"), at("2"), Some(7));
        history.record(at("2"), at("3"), Some(8));
        assert_eq!(history.undo(), Some(at("2")));
        assert_eq!(history.undo(), Some(at("0")));
        assert!(!history.can_undo());
        assert_eq!(history.redo(), Some(at("2")));
    }

    #[test]
    fn changes_without_a_gesture_are_separate_steps() {
        let mut history = UndoHistory::default();
        history.record(at("0"), at("1"), None);
        history.record(at("1"), at("2"), None);
        assert_eq!(history.undo(), Some(at("1")));
    }

    #[test]
    fn a_gesture_that_returns_to_its_start_is_no_step() {
        let mut history = UndoHistory::default();
        history.record(at("0"), at("1"), Some(7));
        history.record(at("1"), at("0"), Some(7));
        assert!(!history.can_undo());
    }

    #[test]
    fn a_rejected_change_is_no_step() {
        let mut history = UndoHistory::default();
        history.record(at("0"), at("1"), None);
        history.record(at("1"), at("2"), None);
        history.amend(at("2"), at("1"));
        assert_eq!(history.undo(), Some(at("0")));
    }

    #[test]
    fn a_new_change_discards_undone_steps() {
        let mut history = UndoHistory::default();
        history.record(at("0"), at("1"), None);
        history.undo();
        history.record(at("0"), at("2"), None);
        assert!(!history.can_redo());
    }
}
