//! Where a film goes wrong, tries beside the window what may help, and offers what does.
//!
//! Each alternative is built as it would be shown and rated as what is on the stage is; only those
//! with fewer faults are offered, with the faults that they leave.

use std::cmp::Ordering;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use bevy::prelude::{DetectChangesMut, MessageReader, Res, ResMut, Resource};

use crate::app::analysis::film_measures::{STEPS, StageMeasures};
use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::jobs::job::BackgroundJob;
use crate::app::session::state::Session;
use crate::app::view::is_same;
use crate::content::ContentKind;
use crate::correspondence::{HoleRule, PartRule};
use crate::measure::{FilmRating, FilmReport, film};
use crate::project::{LoadedProject, Project, ProjectError};
use crate::settings::choice::Choice;
use crate::transition::{BuildError, DesignFit, Transition, TransitionMethod};
use crate::warp::WarpKind;
use crate::work::progress::{Progress, still_wanted};

/// How long the film must have been there: while something is dragged nothing is tried.
const CALM: Duration = Duration::from_millis(800);

/// The most that are offered: they stand in one line.
const MOST: usize = 3;

/// How much more turning and change of area, as shares, an offer may have for fewer faults: with
/// every part alone a head became a bird without a crossing, and was hardly there in between.
const MORE_UNREST: f64 = 0.2;

/// What it counts, as such a share, that the target is seen mirrored or turned.
const OTHER_TARGET: f64 = 0.25;

/// Something else that may be asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SuggestedChange {
    /// The target mirrored.
    Mirror,
    /// The target turned counter-clockwise, in degrees.
    Turn(i32),
    /// The designs laid over each other otherwise.
    Frame(DesignFit),
    /// Holes made otherwise.
    Holes(HoleRule),
    /// Parts without a partner made otherwise.
    Parts(PartRule),
    /// Another method.
    Method(TransitionMethod),
}

/// An alternative, and how much trouble its film is.
#[derive(Clone, Debug, PartialEq)]
pub struct Suggestion {
    /// What to change.
    pub what: SuggestedChange,
    /// What it comes to.
    pub rating: FilmRating,
}

impl SuggestedChange {
    /// What may help with a project: first what leaves the designs as they are.
    fn all(loaded: &LoadedProject) -> Vec<Self> {
        let matching = &loaded.project.options.matching;
        let others = PartRule::ALL.into_iter();
        let others = others.filter(|other| *other != matching.parts);
        let mut all: Vec<Self> = others.map(Self::Parts).collect();
        if matching.holes != HoleRule::Auto {
            // It looks at all of them.
            all.push(Self::Holes(HoleRule::Auto));
        }
        if loaded.project.fit == DesignFit::AsDrawn {
            all.push(Self::Frame(DesignFit::Centred));
        }
        let cells = [
            (WarpKind::Arap, ContentKind::Solid),
            (WarpKind::Arap, ContentKind::Field),
            (WarpKind::None, ContentKind::Field),
        ];
        let cells = cells
            .into_iter()
            .filter_map(|(warp, content)| TransitionMethod::new(warp, content).ok());
        let now = loaded.cell().ok();
        let can = |cell: &TransitionMethod| {
            Some(*cell) != now && loaded.available(cell.warp(), cell.content()).is_ok()
        };
        all.extend(cells.filter(can).map(Self::Method));
        // What was said by hand of points of a design holds wherever that lies.
        all.push(Self::Mirror);
        all.extend([180, 90, -90].map(Self::Turn));
        all
    }

    /// The target is seen otherwise than it was drawn.
    fn changes_the_target(self) -> bool {
        matches!(self, Self::Mirror | Self::Turn(_))
    }

    /// Makes the change.
    pub fn apply(self, project: &mut Project) {
        match self {
            Self::Method(cell) => {
                project.warp = Some(cell.warp());
                project.content = Some(cell.content());
            }
            Self::Frame(fit) => project.fit = fit,
            Self::Holes(holes) => project.options.matching.holes = holes,
            Self::Parts(parts) => project.options.matching.parts = parts,
            Self::Mirror | Self::Turn(_) => {
                let Some(target) = project.designs.get_mut(1) else {
                    return;
                };
                let place = &mut target.placement;
                match self {
                    Self::Turn(degrees) => place.rotation += f64::from(degrees).to_radians(),
                    _ => place.mirror = !place.mirror,
                }
            }
        }
    }

    /// What is done, in a few words.
    #[must_use]
    pub fn words(self) -> String {
        match self {
            Self::Mirror => "Mirror the target".to_owned(),
            Self::Turn(degrees) => format!("Turn the target by {degrees}°"),
            Self::Frame(fit) => format!("Frame: {}", fit.name().title.to_lowercase()),
            Self::Holes(holes) => format!("Holes: {}", holes.name().title.to_lowercase()),
            Self::Parts(parts) => format!("Odd parts: {}", parts.name().title.to_lowercase()),
            Self::Method(cell) => format!("Take {}", cell.name()),
        }
    }
}

impl Suggestion {
    /// Fewer faults than now, and not at the price of a film that hardly shows anything between.
    fn helps(&self, now: &FilmRating) -> bool {
        let is_calm = self.rating.unrest() <= now.unrest() + MORE_UNREST;
        self.rating.has_fewer_faults_than(now) && is_calm
    }

    /// Which of two is offered first: that with fewer faults; of two alike, that which is calmer,
    /// unless it shows the target otherwise than it was drawn.
    fn compare(&self, other: &Self) -> Ordering {
        let fewer = |a: &Self, b: &Self| a.rating.has_fewer_faults_than(&b.rating);
        let price = |offer: &Self| {
            let changes = offer.what.changes_the_target();
            offer.rating.unrest() + if changes { OTHER_TARGET } else { 0.0 }
        };
        match (fewer(self, other), fewer(other, self)) {
            (true, _) => Ordering::Less,
            (_, true) => Ordering::Greater,
            _ => price(self).total_cmp(&price(other)),
        }
    }
}

/// What was tried of the film on the stage.
#[derive(Resource, Debug, Default)]
pub struct Suggestions {
    of: Option<Transition>,
    since: Option<Instant>,
    trial: Option<SuggestionJob>,
    now: Option<FilmRating>,
    offers: Vec<Suggestion>,
    is_done: bool,
}

#[derive(Debug)]
struct SuggestionJob {
    job: BackgroundJob<(), ProjectError>,
    found: Mutex<Receiver<Suggestion>>,
}

impl Suggestions {
    /// What helps, the best first.
    #[must_use]
    pub fn offers(&self) -> &[Suggestion] {
        &self.offers[..self.offers.len().min(MOST)]
    }

    /// How much trouble the film on the stage is, as the offers are rated.
    #[must_use]
    pub fn now(&self) -> Option<FilmRating> {
        self.now
    }

    /// Something is being tried, or is about to be.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.trial.is_some() || self.since.is_some()
    }

    /// Something is being tried.
    #[must_use]
    pub fn is_trying(&self) -> bool {
        self.trial.is_some()
    }

    /// All that may help was tried.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// Tries nothing more.
    pub fn stop(&mut self) {
        self.is_done |= self.is_busy();
        (self.trial, self.since) = (None, None);
    }

    /// Tries what may help with what is on the stage, of which this was measured.
    fn start(&mut self, session: &Session, film: &FilmReport) {
        self.since = None;
        self.offers.clear();
        self.now = self.of.as_ref().and_then(|of| rating(of, film));
        let Some((staged, now)) = session.staged().zip(self.now) else {
            self.is_done = true;
            return;
        };
        let (sender, found) = channel();
        let job = BackgroundJob::start("what helps", move |progress| {
            try_all(&staged, &now, &sender, progress)
        });
        self.trial = Some(SuggestionJob {
            job,
            found: Mutex::new(found),
        });
    }

    /// Whether there is anything new.
    fn take(&mut self) -> bool {
        let Some(trial) = &self.trial else {
            return false;
        };
        // Asked first: what it has found by then is there.
        let is_done = trial.job.poll().is_some();
        let receiver = trial.found.lock().unwrap_or_else(PoisonError::into_inner);
        let found: Vec<Suggestion> = receiver.try_iter().collect();
        drop(receiver);
        let is_new = is_done || !found.is_empty();
        self.offers.extend(found);
        self.offers.sort_by(Suggestion::compare);
        if is_done {
            self.trial = None;
            self.is_done = true;
        }
        is_new
    }
}

/// How much trouble a film is that was looked at as the verdict looks; none of pictures.
fn rating(of: &Transition, film: &FilmReport) -> Option<FilmRating> {
    let content = of.cell().content();
    (content != ContentKind::Colours).then(|| FilmRating::of_report(film, content))
}

fn try_all(
    loaded: &LoadedProject,
    now: &FilmRating,
    found: &Sender<Suggestion>,
    progress: &dyn Progress,
) -> Result<(), ProjectError> {
    let mut flawless = 0;
    for what in SuggestedChange::all(loaded) {
        let mut other = loaded.clone();
        what.apply(&mut other.project);
        let built = Transition::build(&other.spec()?, progress);
        still_wanted(progress).map_err(BuildError::from)?;
        // What cannot be built helps nobody.
        let Ok(built) = built else {
            continue;
        };
        let report = film(&built, STEPS, progress).map_err(BuildError::from)?;
        let Some(rating) = rating(&built, &report) else {
            continue;
        };
        let offer = Suggestion { what, rating };
        if offer.helps(now) {
            flawless += usize::from(rating.is_flawless());
            // Nobody listens any more once it is not wanted.
            found.send(offer).ok();
        }
        if flawless >= MOST {
            break;
        }
    }
    Ok(())
}

/// Keeps up with what is on the stage, and takes in what was found.
pub fn follow(
    session: Res<Session>,
    measured: Res<StageMeasures>,
    mut helping: ResMut<Suggestions>,
) {
    // Marked as changed by hand: it is looked at in each frame, and seldom new.
    let now = helping.bypass_change_detection();
    let was_busy = now.is_busy();
    let transition = session.transition();
    if !is_same(now.of.as_ref(), transition) {
        *now = Suggestions {
            of: transition.cloned(),
            ..Suggestions::default()
        };
    }
    let faulty = measured
        .measures()
        .filter(|measures| !measures.verdict.is_clear());
    // A path is led elsewhere: what is tried is of two designs.
    let is_pair = session.whole().is_some_and(|whole| !whole.follows_path());
    match faulty.filter(|_| is_pair && session.work().is_none()) {
        None => (now.trial, now.since) = (None, None),
        Some(faulty) if now.trial.is_none() && !now.is_done => {
            let since = *now.since.get_or_insert_with(Instant::now);
            if since.elapsed() >= CALM {
                now.start(&session, &faulty.film);
            }
        }
        Some(_) => {}
    }
    if now.take() || now.is_busy() != was_busy {
        helping.set_changed();
    }
}

/// Takes what is offered.
pub fn apply(
    mut intents: MessageReader<Intent>,
    (mut session, helping, gesture): (ResMut<Session>, Res<Suggestions>, Res<Gesture>),
) {
    for intent in intents.read() {
        let Intent::TakeOffer(index) = *intent else {
            continue;
        };
        if let Some(offer) = helping.offers().get(index) {
            session.change(gesture.mark(), |project| offer.what.apply(project));
        }
    }
}
