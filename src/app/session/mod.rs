//! The project that is open: [`open`] where it comes from and what was changed, [`history`] the
//! steps that can be taken back, [`loading`] and [`saving`] its files, [`work`] what goes on
//! beside the stage; [`state`] puts them together.

pub mod history;
pub mod loading;
pub mod open;
pub mod saving;
pub mod state;
pub mod work;
