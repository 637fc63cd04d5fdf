//! The film of what is on the stage, recorded beside the window.
//!
//! What is on the stage plays from the moment it is there; once its film is recorded,
//! the same frames come from memory. Nothing is drawn anew for it, and nothing is told:
//! it is the same film.

use bevy::prelude::{DetectChanges, Res, ResMut, Resource};

use crate::app::session::state::Session;
use crate::app::telling::job::Job;
use crate::film::{FilmError, FilmOptions};
use crate::transition::Transition;

/// The recording that goes on, or went on last.
#[derive(Resource, Debug, Default)]
pub struct Recording {
    of: Option<Transition>,
    job: Option<Job<(), FilmError>>,
}

impl Recording {
    fn is_of(&self, wanted: Option<&Transition>) -> bool {
        match (&self.of, wanted) {
            (Some(old), Some(new)) => std::ptr::eq(old.content(), new.content()),
            (None, None) => true,
            _ => false,
        }
    }
}

/// Records whatever is on the stage. A recording of what was there before is given up.
pub fn follow(session: Res<Session>, mut recording: ResMut<Recording>) {
    if !session.is_changed() || recording.is_of(session.transition()) {
        return;
    }
    recording.of = session.transition().cloned();
    recording.job = recording.of.clone().map(|transition| {
        Job::start("the film", move |progress| {
            // Why there is none is kept with the transition, and shown beside the times.
            transition.record(&FilmOptions::default(), progress)?;
            Ok(())
        })
    });
}
