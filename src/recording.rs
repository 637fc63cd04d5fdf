//! A warp recorded as polynomials in t.
//!
//! Where vertices are is a smooth function of t for every warp, between the
//! times at which something sets out or arrives. So a few placements give the
//! whole film: from them any other is a short sum, however dear each was. What is
//! kept is the deviation from the straight line between the ends of a reel, a stretch
//! of time: a polynomial that is zero at both ends, which are met to the last bit.
//!
//! A [`Recording`] is a warp itself, so that contents, stage, export and measures know
//! nothing of it. Outside [0, 1] it is the warp that it was recorded from.
//!
//! Guaranteed: at t = 0 and t = 1 the places of the warp to the last bit; no jump
//! between two reels; the same film on any number of threads. Not guaranteed: the
//! stated [`error`](Film::error) is measured against fresh placements, not proved.
//!
//! - `options`: how closely; `moving`: which places of a placement a warp moves
//! - `nodes`: the times at which a warp is looked at, and polynomials through them
//! - `record`: from placements to reels, as many as it takes
//! - `reel`: the polynomials between two times, and their sum
//! - `single`: the same in single precision, for graphics cards
//! - [`proof`]: what holds of a film at every t

mod channels;
mod interval;
mod nodes;
mod options;
pub mod proof;
mod record;
#[cfg(feature = "bevy")]
mod single_precision;

#[cfg(test)]
mod tests;

#[cfg(feature = "bevy")]
pub(crate) use nodes::MAX_NODES as MOST_COEFFICIENTS;
pub use options::RecordingOptions;
pub use record::RecordingError;
#[cfg(feature = "bevy")]
pub(crate) use single_precision::{IntervalWeights, SinglePrecisionInterval};

use crate::warp::{MissedFeatures, Placement, Placer, Warp};
use crate::work::progress::Progress;
use channels::MovingChannels;
use interval::RecordingInterval;
use std::sync::Arc;

/// A warp that was recorded. Cloning is cheap.
///
/// ```
/// use morphospace::compatible::CompatibleMesh;
/// use morphospace::recording::{Film, FilmOptions};
/// use morphospace::geometry::{DMat2, DVec2};
/// use morphospace::work::progress::Silent;
/// use morphospace::warp::{Arap, ArapOptions, Warp};
/// use std::sync::Arc;
///
/// let source = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let target = source.iter().map(|&p| DMat2::from_angle(2.0) * p).collect();
/// let mesh = CompatibleMesh::new(vec![[0, 1, 2]], source, target, vec![])?;
/// let arap = Arap::build(&mesh, &ArapOptions::default(), &Silent)?;
/// let film = Film::record(Arc::new(arap), &FilmOptions::default(), &Silent)?;
/// assert!(film.solves() < 20);
/// let mut placer = film.placer();
/// placer.place(0.37);
/// let at = &placer.placement().in_frame;
/// assert!((at[0].distance(at[1]) - 1.0).abs() < 1e-8); // turned, not shrunk
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Recording(Arc<RecordingData>);

#[derive(Debug)]
struct RecordingData {
    warp: Arc<dyn Warp>,
    moving: MovingChannels,
    /// In the order of t, from 0 to 1 without a gap.
    reels: Vec<RecordingInterval>,
    error: f64,
    solves: usize,
}

impl Recording {
    /// Records a warp over [0, 1], as closely as the options ask.
    ///
    /// # Errors
    /// [`RecordingError`] if the film would take too much memory, if the warp jumps or
    /// is not smooth somewhere that it does not tell of, and on a cancel.
    pub fn record(
        warp: Arc<dyn Warp>,
        options: &RecordingOptions,
        progress: &dyn Progress,
    ) -> Result<Self, RecordingError> {
        let recorded = record::record(warp.as_ref(), options, progress)?;
        Ok(Self(Arc::new(RecordingData {
            warp,
            moving: recorded.moving,
            reels: recorded.reels,
            error: recorded.error,
            solves: recorded.solves,
        })))
    }

    /// How far a vertex was from a fresh placement at most, where the film was
    /// tried, and what was rounded since; as a share of the diameter.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.0.error
    }

    /// How many placements of the warp it took.
    #[must_use]
    pub fn solves(&self) -> usize {
        self.0.solves
    }

    /// How many polynomials a vertex has, one after the other.
    #[must_use]
    pub fn reel_count(&self) -> usize {
        self.0.reels.len()
    }

    /// The memory that its coefficients take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.0.reels.iter().map(RecordingInterval::bytes).sum()
    }
}

impl Recording {
    /// Moves a placement of the warp to `t`; does nothing and says so where that lies
    /// outside [0, 1].
    pub(crate) fn place(&self, t: f64, placement: &mut Placement) -> bool {
        let is_within = (0.0..=1.0).contains(&t);
        if is_within {
            self.0.place(t, placement);
        }
        is_within
    }
}

impl RecordingData {
    /// Which reel shows a `t` within [0, 1].
    fn reel_at(&self, t: f64) -> usize {
        let after = self.reels.partition_point(|reel| reel.to < t);
        after.min(self.reels.len() - 1)
    }

    fn place(&self, t: f64, placement: &mut Placement) {
        let reel = &self.reels[self.reel_at(t)];
        let mut first = 0;
        for channel in self.moving.channels() {
            let places = channel.of_mut(placement);
            reel.place(t, first, places);
            first += interval::block_count(places.len());
        }
    }
}

impl Warp for Recording {
    fn placer(&self) -> Placer {
        let film = self.clone();
        let placer = self.0.warp.placer();
        placer.after(move |t, placement| film.place(t, placement))
    }

    fn missed(&self, t: f64) -> Option<MissedFeatures> {
        self.0.warp.missed(t)
    }

    fn breaks(&self) -> Vec<f64> {
        self.0.warp.breaks()
    }
}
