//! The project that is open: [`document`] where it comes from and what was changed, [`history`] the
//! steps that can be taken back, [`load`] and [`save`] its files, [`unsaved_project`]
//! what is kept of it while it is not saved, [`transition_work`] what goes on beside the stage; [`state`] puts
//! them together.

pub mod document;
pub mod history;
pub mod load;
pub mod origin;
pub mod save;
pub mod state;
pub mod transition_work;
pub mod unsaved_project;
