//! The open project.
//!
//! [`document`] holds its settings and its segments on the stage, [`history`] its undo steps;
//! [`load`] and [`save`] read and write files, [`save_conflict`] stores whether the user is being
//! asked about a file that was changed elsewhere, [`unsaved_project`] stores unsaved changes, [`transition_work`] builds
//! transitions in the background, and [`transition_problem`] says why one cannot be built;
//! [`origin`] records where a project comes from; [`state`] combines all these into the resource
//! that the rest of the application uses.

pub mod document;
pub mod history;
pub mod load;
pub mod origin;
pub mod save;
pub mod save_conflict;
pub mod state;
pub mod transition_problem;
pub mod transition_work;
pub mod unsaved_project;
