//! Undo and redo of every change of the project.
//!
//! What a hand does in one go is one step: all changes while a mouse button is held, and all that
//! is typed into one field. A change is kept as the whole project before and after it, with the
//! folder that its paths start from, so that saving elsewhere does not make old steps point to
//! nowhere.

use std::path::PathBuf;

use undo::{Edit, Merged, Record};

use crate::project::Project;

/// The most steps that are kept: each holds two whole projects, some kilobytes, and more where
/// faces have weights of their own.
const MOST_STEPS: usize = 200;

/// A project at one moment.
#[derive(Clone, Debug, PartialEq)]
pub struct ProjectSnapshot {
    /// The project.
    pub project: Project,
    /// What its relative paths are relative to; `None` where it is bundled.
    pub folder: Option<PathBuf>,
}

/// One step.
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
        // Without a mark no hand did it, and each is a step of its own.
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

/// The steps that can be taken back and taken again.
#[derive(Debug)]
pub struct UndoHistory(Record<HistoryStep>);

impl Default for UndoHistory {
    fn default() -> Self {
        Self(Record::builder().limit(MOST_STEPS).saved(false).build())
    }
}

impl UndoHistory {
    /// Notes a change that was made.
    pub fn note(&mut self, before: ProjectSnapshot, after: ProjectSnapshot, mark: Option<u64>) {
        self.push(before, after, mark, false);
    }

    /// Notes that the last change did not come to stay, or not as it was.
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

    /// There is a step to take back.
    #[must_use]
    pub fn can_undo(&self) -> bool {
        self.0.can_undo()
    }

    /// There is a step to take again.
    #[must_use]
    pub fn can_redo(&self) -> bool {
        self.0.can_redo()
    }

    /// What to go back to.
    pub fn undo(&mut self) -> Option<ProjectSnapshot> {
        self.0.undo(&mut ())
    }

    /// What to go on to.
    pub fn redo(&mut self) -> Option<ProjectSnapshot> {
        self.0.redo(&mut ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(title: &str) -> ProjectSnapshot {
        let mut project = Project::pair("a.svg", "b.svg");
        title.clone_into(&mut project.title);
        ProjectSnapshot {
            project,
            folder: None,
        }
    }

    #[test]
    fn one_movement_is_one_step() {
        let mut history = UndoHistory::default();
        history.note(at("0"), at("1"), Some(7));
        history.note(at("1"), at("2"), Some(7));
        history.note(at("2"), at("3"), Some(8));
        assert_eq!(history.undo(), Some(at("2")));
        assert_eq!(history.undo(), Some(at("0")));
        assert!(!history.can_undo());
        assert_eq!(history.redo(), Some(at("2")));
    }

    #[test]
    fn what_no_hand_did_is_never_joined() {
        let mut history = UndoHistory::default();
        history.note(at("0"), at("1"), None);
        history.note(at("1"), at("2"), None);
        assert_eq!(history.undo(), Some(at("1")));
    }

    #[test]
    fn a_movement_that_comes_back_is_no_step() {
        let mut history = UndoHistory::default();
        history.note(at("0"), at("1"), Some(7));
        history.note(at("1"), at("0"), Some(7));
        assert!(!history.can_undo());
    }

    #[test]
    fn a_change_that_was_given_up_is_no_step() {
        let mut history = UndoHistory::default();
        history.note(at("0"), at("1"), None);
        history.note(at("1"), at("2"), None);
        history.amend(at("2"), at("1"));
        assert_eq!(history.undo(), Some(at("0")));
    }

    #[test]
    fn a_new_change_forgets_what_was_taken_back() {
        let mut history = UndoHistory::default();
        history.note(at("0"), at("1"), None);
        history.undo();
        history.note(at("0"), at("2"), None);
        assert!(!history.can_redo());
    }
}
