//! Analysis of a whole transition of trusses: results at evenly spaced t, findings, and the proof
//! that the structure stands at every t.

use super::blend::{LoadSelection, StructuralBlend};
use super::error::StructureError;
use super::findings::{self, StructureFault, StructureFinding};
use super::limits::StructureLimits;
use super::sample::StructureSample;
use super::shape_faults::{self, CrossingBars};
use super::sizing::{SizedMembers, SizingOptions};
use super::solver::{StructuralState, StructureSolver};
use super::stability_proof::StabilityProof;
use super::tables::StructureTables;
use crate::content::Content;
use crate::design::{DesignForm, Truss, TrussInputError};
use crate::recording::RecordingOptions;
use crate::transition::{Frame, Transition};
use crate::work::progress::{
    Cancelled, OverallProgress, Progress, ProgressSpan, check_cancelled, checkpoint,
};
use serde::Serialize;
use std::sync::Arc;

/// Soundness of a structure at one t.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Soundness {
    /// No fault was found.
    Sound,
    /// It stands and carries its loads, but exceeds a limit of use.
    Marginal,
    /// It falls over, breaks or buckles.
    Unsound,
}

/// Structure of a transition between two trusses, analysed under all load cases at any t.
///
/// ```
/// use morphospace::structure::TransitionStructure;
/// use morphospace::{project::gallery, transition::Transition, work::progress::Silent};
/// let spec = gallery::load("bracket-to-davit")?.spec()?;
/// let transition = Transition::build(&spec, &Silent)?;
/// let mut structure = TransitionStructure::new(&transition)?;
/// assert!(structure.sample(0.5, None).stands());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct TransitionStructure {
    solver: StructureSolver,
    frame: Frame,
}

impl TransitionStructure {
    /// Prepares the analysis of a transition.
    ///
    /// # Errors
    /// [`StructureError`] if the designs are no trusses or cannot be analysed.
    pub fn new(transition: &Transition) -> Result<Self, StructureError> {
        let blend = StructuralBlend::of_transition(transition)?;
        Ok(Self {
            solver: StructureSolver::new(Arc::new(blend))?,
            frame: transition.frame(0.0),
        })
    }

    /// Returns the structures of both designs.
    #[must_use]
    pub fn blend(&self) -> &Arc<StructuralBlend> {
        self.solver.blend()
    }

    /// Analyses the structure at `t`. Allocates nothing.
    pub fn solve(&mut self, t: f64) -> &StructuralState {
        self.frame.seek(t);
        let weights = StructuralBlend::pair_weights(t);
        let places = &self.frame.placement().in_frame;
        self.solver.solve(places, &weights, LoadSelection::All)
    }

    /// Returns the measures of the structure at `t`. `last_factor` is the buckling factor at a t
    /// nearby, if it is known.
    pub fn sample(&mut self, t: f64, last_factor: Option<f64>) -> StructureSample {
        self.solve(t);
        StructureSample::of(&self.solver, t, last_factor)
    }

    /// Returns all numbers at `t`, by bar and by node.
    pub fn tables(&mut self, t: f64) -> StructureTables {
        self.solve(t);
        StructureTables::of(&self.solver, t)
    }

    /// Sizes the members at `t`; `None` for a mechanism, or without loads.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled.
    pub fn sized(
        &mut self,
        t: f64,
        options: &SizingOptions,
        progress: &dyn Progress,
    ) -> Result<Option<SizedMembers>, Cancelled> {
        self.frame.seek(t);
        let weights = StructuralBlend::pair_weights(t);
        let places = &self.frame.placement().in_frame;
        let loads = LoadSelection::All;
        self.solver
            .size_members(places, &weights, loads, options, progress)
    }

    /// Returns the truss at `t`, to be written to a file.
    ///
    /// # Errors
    /// As [`StructureSolver::truss_between`].
    pub fn truss(&mut self, t: f64) -> Result<Truss, TrussInputError> {
        self.solve(t);
        self.solver.truss_between(&StructuralBlend::pair_weights(t))
    }
}

/// Analysis of a transition from t = 0 to t = 1.
///
/// ```
/// use morphospace::structure::{FilmStructure, StructureLimits};
/// use morphospace::{project::gallery, transition::Transition, work::progress::Silent};
/// let spec = gallery::load("bracket-to-davit")?.spec()?;
/// let transition = Transition::build(&spec, &Silent)?;
/// let film = FilmStructure::of(&transition, 25, &StructureLimits::default(), &Silent)?;
/// assert!(film.proof.as_ref().is_some_and(|proof| proof.holds()));
/// assert!(film.samples.iter().all(|sample| sample.stands()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct FilmStructure {
    /// Results at evenly spaced t.
    pub samples: Vec<StructureSample>,
    /// For each sample, its soundness.
    pub soundness: Vec<Soundness>,
    /// Faults, one of each kind, the gravest first.
    pub findings: Vec<StructureFinding>,
    /// Examination of every t; `None` if the transition cannot be recorded.
    pub proof: Option<StabilityProof>,
    /// Limits of the findings.
    pub limits: StructureLimits,
    /// Values that were used for numbers that the designs do not give.
    pub notes: Vec<String>,
}

/// Returns whether both designs of a transition are trusses, and any of them has supports or loads.
#[must_use]
pub fn has_structure(transition: &Transition) -> bool {
    let trusses = transition
        .designs()
        .each_ref()
        .map(|design| match &design.form {
            DesignForm::Truss(truss) => Some(truss.is_structure()),
            _ => None,
        });
    matches!(transition.content(), Content::Solid(_))
        && matches!(trusses, [Some(first), Some(second)] if first || second)
}

/// Progress reported once all samples are analysed, in [0, 1] (heuristic).
const SAMPLED_FRACTION: f64 = 0.7;

impl FilmStructure {
    /// Number of samples of a film in the window and in reports (heuristic: ten seconds at 24 frames
    /// per second, and one).
    pub const SAMPLES: usize = 241;

    /// Analyses a transition of two trusses at `samples` evenly spaced t, at least 2, under all
    /// load cases. Structures of more than 2,500 bars, or 620 members of a frame, are analysed at
    /// fewer t, but at least at 25.
    ///
    /// # Errors
    /// [`StructureError`] if the designs are no trusses or cannot be analysed, or if the work is
    /// cancelled.
    pub fn of(
        transition: &Transition,
        samples: usize,
        limits: &StructureLimits,
        progress: &dyn Progress,
    ) -> Result<Self, StructureError> {
        let progress = &OverallProgress::new(progress);
        let mut structure = TransitionStructure::new(transition)?;
        let samples = samples.min(affordable_samples(structure.blend()));
        let designs = DesignShapes::of(&mut structure, progress)?;
        let mut results = Vec::with_capacity(samples);
        let mut faults: Vec<(f64, Vec<StructureFault>)> = Vec::with_capacity(samples);
        for k in 0..samples {
            let t = k as f64 / (samples - 1).max(1) as f64;
            checkpoint(progress, "analysing", SAMPLED_FRACTION * t)?;
            let last = results
                .last()
                .and_then(|last: &StructureSample| last.critical_load_factor);
            let sample = structure.sample(t, last);
            let shape =
                shape_faults::find(&structure.solver, limits, &designs.crossings, progress)?;
            let faults_at_t = findings::faults(&sample, shape, limits, designs.least_frequency);
            faults.push((t, faults_at_t));
            results.push(sample);
        }
        let proving = ProgressSpan::new(progress, SAMPLED_FRACTION, 1.0);
        let proof = match transition.record(&RecordingOptions::default(), &proving) {
            Ok(recording) => {
                let proof = StabilityProof::of(structure.blend(), &recording, &proving)?;
                Some(proof.confirmed_by(&results))
            }
            Err(_) => {
                check_cancelled(progress)?;
                None
            }
        };
        Ok(Self {
            soundness: faults.iter().map(|(_, faults)| soundness(faults)).collect(),
            findings: findings::merged(&faults),
            samples: results,
            proof,
            limits: *limits,
            notes: structure
                .blend()
                .notes()
                .iter()
                .map(ToString::to_string)
                .collect(),
        })
    }
}

/// Number of pairs of a bar and a t that are analysed (resource limit: about 8 s).
const MAX_BAR_SAMPLES: usize = 600_000;

/// Cost of analysing a member of a frame, whose buckling factor is computed, in comparison with a
/// pinned bar (derived: measured as 3.6 for 480 members and 4.4 for 2,500).
const FRAME_COST: usize = 4;

/// Divisor of the number of steps between samples (derived: a table of nine rows has eight steps).
const SAMPLE_STEPS: usize = 8;

/// Returns the number of samples that the size of a structure allows: 1 plus a multiple of
/// [`SAMPLE_STEPS`], at least 25.
fn affordable_samples(blend: &StructuralBlend) -> usize {
    let cost = blend.bars().len() * if blend.is_frame() { FRAME_COST } else { 1 };
    let steps = (MAX_BAR_SAMPLES / cost / SAMPLE_STEPS).max(3);
    1 + SAMPLE_STEPS * steps
}

/// Properties of both designs with which every t is compared.
struct DesignShapes {
    /// Pairs of bars that cross in both designs.
    crossings: CrossingBars,
    /// Lower first frequency of both designs in Hz; `None` unless both stand.
    least_frequency: Option<f64>,
}

impl DesignShapes {
    fn of(structure: &mut TransitionStructure, progress: &dyn Progress) -> Result<Self, Cancelled> {
        let mut at = |t: f64| {
            let state = structure.solve(t);
            let frequency = (!state.is_mechanism).then_some(state.frequency);
            Ok((
                frequency,
                shape_faults::crossing_bars(&structure.solver, progress)?,
            ))
        };
        let [first, last] = [at(0.0)?, at(1.0)?];
        Ok(Self {
            crossings: first.1.intersection(&last.1).copied().collect(),
            least_frequency: first.0.zip(last.0).map(|(a, b)| a.min(b)),
        })
    }
}

/// Returns the soundness of a structure with the given faults.
fn soundness(faults: &[StructureFault]) -> Soundness {
    let worst = faults.iter().map(|fault| match fault.is_unsound() {
        true => Soundness::Unsound,
        false => Soundness::Marginal,
    });
    worst.max().unwrap_or(Soundness::Sound)
}
