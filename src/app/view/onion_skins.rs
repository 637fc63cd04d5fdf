//! Onion skins: thin outlines of the film at its stops, or at regular t, all shown at once.

use bevy::prelude::{DetectChanges, DetectChangesMut, Res, ResMut, Resource};

use crate::app::input::preferences::Preferences;
use crate::app::playback::player::landmarks;
use crate::app::session::state::Session;
use crate::geometry::DVec2;
use crate::transition::{Sequence, VectorFigure};

/// Number of skins between the two ends of a film without stops (heuristic).
const SKINS_BETWEEN: usize = 4;

/// Maximum number of skins (heuristic: more would cover each other).
const MAX_SKINS: usize = 12;

/// Outline of the film at one value of t.
#[derive(Clone, Debug, PartialEq)]
pub struct OnionSkin {
    /// Value of t at which the film has this outline.
    pub t: f64,
    /// Closed outlines, each as a list of vertices.
    pub rings: Vec<Vec<DVec2>>,
    /// Bars of a truss, by their ends; empty for other content.
    pub bars: Vec<[DVec2; 2]>,
}

/// Onion skins of the film on the stage, while they are shown.
#[derive(Resource, Debug, Default)]
pub struct OnionSkins {
    of: Option<(Sequence, Vec<f64>)>,
    skins: Vec<OnionSkin>,
}

impl OnionSkins {
    /// The skins, sorted by t.
    #[must_use]
    pub fn skins(&self) -> &[OnionSkin] {
        &self.skins
    }
}

/// Values of t of all skins, at most [`MAX_SKINS`]: the stops, and the start and end of the film;
/// without stops, evenly spaced values.
fn times(session: &Session) -> Vec<f64> {
    let places = landmarks(session.timing(), session.stops());
    match places.as_slice() {
        [from, to] => (0..=SKINS_BETWEEN + 1)
            .map(|k| from + (to - from) * k as f64 / (SKINS_BETWEEN + 1) as f64)
            .collect(),
        all if all.len() > MAX_SKINS => (0..MAX_SKINS)
            .map(|k| all[k * (all.len() - 1) / (MAX_SKINS - 1)])
            .collect(),
        all => all.to_vec(),
    }
}

/// Computes the skins again when the film, its stops or the preference changes.
pub fn follow(session: Res<Session>, preferences: Res<Preferences>, mut onion: ResMut<OnionSkins>) {
    if !session.is_changed() && !preferences.is_changed() {
        return;
    }
    let sequence = preferences.onion.then(|| session.sequence()).flatten();
    let requested = sequence.map(|sequence| (sequence, times(&session)));
    let is_same = match (&requested, &onion.bypass_change_detection().of) {
        (Some((new, now)), Some((old, old_times))) => now == old_times && new.is_same(old),
        (requested, old) => requested.is_none() && old.is_none(),
    };
    if is_same {
        return;
    }
    onion.skins = requested
        .iter()
        .flat_map(|(sequence, times)| skins(sequence, times))
        .collect();
    onion.of = requested;
}

/// Computes the skin of the film at each of the given values of t.
fn skins(sequence: &Sequence, times: &[f64]) -> Vec<OnionSkin> {
    let mut frame = sequence.frame(0.0);
    let skin = |&t: &f64| {
        frame.seek(t);
        let VectorFigure { rings, bars, .. } = frame.frame().figure();
        OnionSkin { t, rings, bars }
    };
    times.iter().map(skin).collect()
}
