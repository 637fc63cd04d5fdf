//! Onion skins: thin outlines of the film at its stops and tenths, all at once.

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::input::preferences::Preferences;
use crate::app::playback::player::landmarks;
use crate::app::session::state::Session;
use crate::geometry::DVec2;
use crate::transition::{Sequence, VectorFigure};

/// How many skins there are between two ends where there are no stops.
const BETWEEN: usize = 4;

/// The most skins: more cover each other.
const MOST: usize = 12;

/// The film at one t.
#[derive(Clone, Debug, PartialEq)]
pub struct OnionSkin {
    /// Where.
    pub t: f64,
    /// Its outlines, closed.
    pub rings: Vec<Vec<DVec2>>,
    /// Its bars.
    pub bars: Vec<[DVec2; 2]>,
}

/// All skins of the film on the stage, while they are shown.
#[derive(Resource, Debug, Default)]
pub struct OnionSkins {
    of: Option<(Sequence, Vec<f64>)>,
    skins: Vec<OnionSkin>,
}

impl OnionSkins {
    /// The skins, by ascending t.
    #[must_use]
    pub fn skins(&self) -> &[OnionSkin] {
        &self.skins
    }
}

/// The t of the skins: the stops and the ends; where there are none but the ends, some between.
fn times(session: &Session) -> Vec<f64> {
    let places = landmarks(session.timing(), session.stops());
    match places.as_slice() {
        [from, to] => (0..=BETWEEN + 1)
            .map(|k| from + (to - from) * k as f64 / (BETWEEN + 1) as f64)
            .collect(),
        all if all.len() > MOST => (0..MOST)
            .map(|k| all[k * (all.len() - 1) / (MOST - 1)])
            .collect(),
        all => all.to_vec(),
    }
}

/// Keeps the skins of what is on the stage.
pub fn follow(session: Res<Session>, preferences: Res<Preferences>, mut onion: ResMut<OnionSkins>) {
    if !session.is_changed() && !preferences.is_changed() {
        return;
    }
    let sequence = preferences.onion.then(|| session.sequence()).flatten();
    let wanted = sequence.map(|sequence| (sequence, times(&session)));
    let is_same = match (&wanted, &onion.bypass_change_detection().of) {
        (Some((new, now)), Some((old, then))) => now == then && new.is(old),
        (wanted, had) => wanted.is_none() && had.is_none(),
    };
    if is_same {
        return;
    }
    onion.skins = wanted
        .iter()
        .flat_map(|(sequence, times)| skins(sequence, times))
        .collect();
    onion.of = wanted;
}

fn skins(sequence: &Sequence, times: &[f64]) -> Vec<OnionSkin> {
    let mut frame = sequence.frame(0.0);
    let skin = |&t: &f64| {
        frame.seek(t);
        let VectorFigure { rings, bars, .. } = frame.now().figure();
        OnionSkin { t, rings, bars }
    };
    times.iter().map(skin).collect()
}
