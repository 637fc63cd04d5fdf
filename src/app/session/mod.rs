//! The project that is open: [`open`] where it comes from and what was changed, [`history`] the
//! steps that can be taken back, [`loading`] and [`saving`] its files, [`rescue`]
//! what is kept of it while it is not saved, [`work`] what goes on beside the stage; [`state`] puts
//! them together.

pub mod history;
pub mod loading;
pub mod open;
pub mod origin;
pub mod rescue;
pub mod saving;
pub mod state;
pub mod work;
