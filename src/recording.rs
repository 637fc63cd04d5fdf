//! Recordings: warps whose vertex positions are stored as piecewise polynomials in the blend
//! parameter t.
//!
//! Between the times at which a part starts, stops or changes pace, vertex positions are smooth
//! functions of t. A few placements (evaluations of the warp at one t) therefore determine the
//! whole motion. Every other placement is a short sum, however expensive it is to evaluate the
//! warp. For each vertex, a time interval stores the exact positions at both ends of the interval,
//! and a polynomial. The polynomial is the deviation from the straight line between the two
//! positions, so it is zero at both ends.
//!
//! A [`Recording`] is itself a warp, so contents, stage, export and measures treat it like any
//! other warp. Outside [0, 1] it evaluates the warp that was recorded.
//!
//! Guaranteed: at t = 0 and t = 1 the positions of the warp, bit for bit; continuity between
//! intervals; the same recording on any number of threads. Not guaranteed: the stated
//! [`error`](Recording::error), which is measured at sampled times and not proved.
//!
//! - `options`: tolerance and memory limit of a recording
//! - `channels`: which of a placement's three position lists a warp moves
//! - `nodes`: times at which a warp is evaluated, and the polynomials through the values there
//! - `record`: converts placements to as few intervals as the tolerance allows
//! - `interval`: the polynomials of one time interval, and their evaluation
//! - `single_precision`: the intervals in single precision, for graphics cards
//! - [`proof`]: certificates that no face folds and no outlines meet, at any t

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

use crate::geometry::DVec2;
use crate::warp::{MissedFeatures, Placement, Placer, Warp};
use crate::work::progress::Progress;
use channels::MovingChannels;
use interval::RecordingInterval;
use std::sync::Arc;

/// Warp whose vertex positions are stored as piecewise polynomials in t. Cloning is cheap.
///
/// ```
/// use morphospace::compatible::CompatibleMesh;
/// use morphospace::recording::{Recording, RecordingOptions};
/// use morphospace::geometry::{DMat2, DVec2};
/// use morphospace::work::progress::Silent;
/// use morphospace::warp::{Arap, ArapOptions, Warp};
/// use std::sync::Arc;
///
/// let source = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
/// let target = source.iter().map(|&p| DMat2::from_angle(2.0) * p).collect();
/// let mesh = CompatibleMesh::new(vec![[0, 1, 2]], source, target, vec![])?;
/// let arap = Arap::build(&mesh, &ArapOptions::default(), &Silent)?;
/// let recording = Recording::record(Arc::new(arap), &RecordingOptions::default(), &Silent)?;
/// assert!(recording.evaluation_count() < 20);
/// let mut placer = recording.placer();
/// placer.place(0.37);
/// let at = &placer.placement().in_frame;
/// assert!((at[0].distance(at[1]) - 1.0).abs() < 1e-8); // turned, not shrunk
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Recording(Arc<RecordingData>);

/// Data of a recording, shared by all clones of the recording.
#[derive(Debug)]
struct RecordingData {
    warp: Arc<dyn Warp>,
    channels: MovingChannels,
    /// Intervals in ascending order of t, covering [0, 1] without gaps.
    intervals: Vec<RecordingInterval>,
    /// Largest measured distance between a vertex in the recording and the same vertex in the warp,
    /// as a fraction of the diameter of the bounding box of all moving vertices at t = 0 and t = 1.
    error: f64,
    /// Number of times that the warp was evaluated.
    evaluation_count: usize,
}

impl Recording {
    /// Records a warp over [0, 1] to the tolerance of `options`.
    ///
    /// # Errors
    /// [`RecordingError`] if the recording would exceed its memory limit, if the warp jumps or is
    /// not smooth at a time that [`Warp::break_times`] does not list, or if the work is cancelled.
    pub fn record(
        warp: Arc<dyn Warp>,
        options: &RecordingOptions,
        progress: &dyn Progress,
    ) -> Result<Self, RecordingError> {
        let recorded = record::record(warp.as_ref(), options, progress)?;
        Ok(Self(Arc::new(RecordingData {
            warp,
            channels: recorded.channels,
            intervals: recorded.intervals,
            error: recorded.error,
            evaluation_count: recorded.evaluation_count,
        })))
    }

    /// Returns the largest measured distance between a vertex in the recording and the same vertex
    /// in the warp, including rounding, as a fraction of the diameter of the bounding box of all
    /// moving vertices at t = 0 and t = 1.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.0.error
    }

    /// Returns how many times the warp was evaluated for the recording.
    #[must_use]
    pub fn evaluation_count(&self) -> usize {
        self.0.evaluation_count
    }

    /// Returns the number of time intervals, each of which has its own polynomials.
    #[must_use]
    pub fn interval_count(&self) -> usize {
        self.0.intervals.len()
    }

    /// Returns the size of the stored positions and polynomial coefficients in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.0.intervals.iter().map(RecordingInterval::bytes).sum()
    }
}

impl Recording {
    /// Writes the recorded positions at `t` to a placement of the warp and returns true. If `t` is
    /// outside [0, 1], the placement stays unchanged and the result is false.
    pub(crate) fn place(&self, t: f64, placement: &mut Placement) -> bool {
        let is_within = (0.0..=1.0).contains(&t);
        if is_within {
            self.0.place(t, placement);
        }
        is_within
    }
}

impl Recording {
    /// Writes the positions in the frame of the first vertices at `t`, which must be in [0, 1].
    pub(crate) fn write_places(&self, t: f64, places: &mut [DVec2]) {
        let mut placer = self.placer();
        placer.place(t);
        let count = places.len();
        places.copy_from_slice(&placer.placement().in_frame[..count]);
    }
}

impl RecordingData {
    /// Returns the index of the interval that contains `t`, where `t` is in [0, 1].
    fn interval_at(&self, t: f64) -> usize {
        let index = self.intervals.partition_point(|interval| interval.to < t);
        index.min(self.intervals.len() - 1)
    }

    /// Writes the recorded positions at `t`, which must be in [0, 1], to `placement`. Of its three
    /// position lists, only those that change with t are recorded and written.
    fn place(&self, t: f64, placement: &mut Placement) {
        let interval = &self.intervals[self.interval_at(t)];
        let mut first_block = 0;
        for channel in self.channels.channels() {
            let positions = channel.of_mut(placement);
            interval.place(t, first_block, positions);
            first_block += interval::block_count(positions.len());
        }
    }
}

impl Warp for Recording {
    fn placer(&self) -> Placer {
        let recording = self.clone();
        let placer = self.0.warp.placer();
        placer.with_override(move |t, placement| recording.place(t, placement))
    }

    fn missed_features(&self, t: f64) -> Option<MissedFeatures> {
        self.0.warp.missed_features(t)
    }

    fn break_times(&self) -> Vec<f64> {
        self.0.warp.break_times()
    }
}
