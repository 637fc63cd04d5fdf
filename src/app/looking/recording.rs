//! The film of what is on the stage, recorded and proved beside the window.
//!
//! What is on the stage plays from the moment it is there; once its film is recorded,
//! the same frames come from memory. Nothing is drawn anew for it: it is the same film.
//! Then it is looked at at every t, which the verdict below the stage tells.

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::session::state::Session;
use crate::app::telling::job::Job;
use crate::app::telling::spare::give_back;
use crate::film::{FilmError, FilmOptions};
use crate::transition::{Proved, Transition};

/// The recording that goes on, or what came of the last one.
#[derive(Resource, Debug, Default)]
pub struct Recording {
    of: Option<Transition>,
    job: Option<Job<Option<Proved>, FilmError>>,
    proved: Option<Proved>,
    /// Of other legs, the last one last: while a sequence plays they come again and again.
    before: Vec<(Transition, Proved)>,
}

/// So many legs are remembered.
const REMEMBERED: usize = 64;

impl Recording {
    /// What is proved of the film on the stage; none as long as that is not known, and
    /// of what has no faces.
    #[must_use]
    pub fn proved(&self) -> Option<&Proved> {
        self.proved.as_ref()
    }

    /// It is being recorded, or proved.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    fn remember(&mut self) {
        // What was being recorded is given up.
        self.job = None;
        self.before.extend(self.of.take().zip(self.proved.take()));
        let old = self.before.len().saturating_sub(REMEMBERED);
        self.before.drain(..old);
    }

    /// Whether what is on the stage was there before, and recorded.
    fn recall(&mut self) -> bool {
        let is_it = |(of, _): &(Transition, Proved)| self.is_of(Some(of));
        let Some(known) = self.before.iter().position(is_it) else {
            return false;
        };
        self.proved = Some(self.before.swap_remove(known).1);
        true
    }

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
    // Marked as changed by hand: it is looked at in each frame, and seldom new.
    let now = recording.bypass_change_detection();
    if session.is_changed() && !now.is_of(session.transition()) {
        now.remember();
        now.of = session.transition().cloned();
        if now.recall() {
            recording.set_changed();
            return;
        }
        now.job = now.of.clone().map(|transition| {
            Job::start("the film", move |progress| {
                let options = FilmOptions::default();
                // Why there is no film is kept with the transition, and shown beside the times.
                let recorded = transition.record(&options, progress);
                let proved = recorded.and_then(|_| transition.prove(&options, progress));
                // What was on the stage before is gone by now.
                give_back();
                proved
            })
        });
    }
    if let Some(answer) = Job::take(&mut now.job) {
        now.proved = answer.ok().flatten();
        recording.set_changed();
    }
}
