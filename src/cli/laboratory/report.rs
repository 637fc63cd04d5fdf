//! Builds a transition and measures it: mesh, film, defects with causes and fixes, and times.
//!
//! The report is data for JSON and CSV; `text` formats it for people.

use std::sync::Arc;
use std::time::{Duration, Instant};

use clap::Args;
use serde::Serialize;

use super::clock;
use super::clock::{StageClock, StageDurations};
use crate::cli::error::CliError;
use crate::cli::inputs::{InputArgs, OpenedPair};
use crate::cli::options::MethodArgs;
use crate::content::{Content, ContentKind};
use crate::design::{Design, DesignForm};
use crate::measure::{self, FilmReport, Finding, MeshReport, Verdict};
use crate::recording::{RecordingError, RecordingOptions};
use crate::transition::{Transition, TransitionNote, TransitionProof};
use crate::warp::WarpKind;
use crate::work::progress::{OverallProgress, Progress, ProgressSpan};

/// Number of frames that are timed. The number is odd, so the median is one of the times; it is
/// large enough that the first, slower frames do not affect the median (heuristic).
const TIMED_FRAMES: usize = 15;

/// Progress reported once the transition is built, in [0, 1] (heuristic).
const BUILT_FRACTION: f64 = 0.6;

/// Options for building and measuring transitions.
#[derive(Debug, Args)]
pub(in crate::cli) struct MeasuringArgs {
    /// Number of values of t, evenly spaced from 0 to 1, at which the film is measured
    #[arg(long, value_name = "N", default_value_t = 65, value_parser = clap::value_parser!(u64).range(2..=10_000))]
    samples: u64,

    /// Prove that no face folds and no outlines meet at any t, or report the first t at which this
    /// is uncertain
    #[arg(long)]
    prove: bool,

    #[command(flatten)]
    method: MethodArgs,
}

impl MeasuringArgs {
    /// Returns the options for building transitions.
    pub fn method(&self) -> &MethodArgs {
        &self.method
    }

    /// Builds and measures the transition between two designs; see [`Self::of`].
    pub fn of_pair(
        &self,
        inputs: &InputArgs,
        progress: &dyn Progress,
    ) -> Result<(OpenedPair, PairReport), CliError> {
        let first = self.of(inputs, progress)?.into_iter().next();
        Ok(first.unwrap_or_else(|| unreachable!("no segment")))
    }

    /// Builds and measures a transition, or each segment of a sequence.
    ///
    /// # Errors
    /// A design cannot be read, a transition cannot be built, or the work was cancelled.
    pub fn of(
        &self,
        inputs: &InputArgs,
        progress: &dyn Progress,
    ) -> Result<Vec<(OpenedPair, PairReport)>, CliError> {
        let whole = OverallProgress::new(progress);
        let building = ProgressSpan::new(&whole, 0.0, BUILT_FRACTION);
        let clock = StageClock::new(&building);
        let measuring = ProgressSpan::new(&whole, BUILT_FRACTION, 1.0);
        let mut measured = Vec::new();
        let input = inputs.read(&self.method, &clock)?;
        input.open_each(&clock, |opened| {
            let samples = self.samples as usize;
            let mut report = PairReport::of(&opened, clock.stages(), samples, &measuring)?;
            if self.prove {
                report.proof = ProofReport::of(&opened.transition, progress)?;
            }
            measured.push((opened, report));
            Ok(())
        })?;
        Ok(measured)
    }
}

/// All measures of one transition.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct PairReport {
    pub title: String,
    pub warp: WarpKind,
    pub content: ContentKind,
    pub designs: Vec<DesignReport>,
    /// Number of vertices of the common triangulation; `None` without one.
    pub vertices: Option<usize>,
    /// Number of faces of the common triangulation; `None` without one.
    pub faces: Option<usize>,
    /// Width and height of the grid of distance fields, in cells; `None` without fields.
    pub grid: Option<[u32; 2]>,
    pub seconds: ReportSeconds,
    pub verdict: VerdictReport,
    pub mesh: Option<MeshReport>,
    pub film: FilmReport,
    /// Proof that the film has no defects at any t; `None` unless `--prove` was given and the
    /// transition has faces.
    pub proof: Option<ProofReport>,
    /// Number of samples of the film, also after [`Self::without_samples`].
    #[serde(skip)]
    pub samples: usize,
}

/// Description of one design.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct DesignReport {
    pub name: String,
    /// Kind of the design: outline, mesh or truss.
    pub kind: &'static str,
    /// Number of points of the outline, vertices of the mesh, or nodes of the truss.
    pub points: usize,
    /// Notes on what was repaired or ignored on import.
    pub notes: Vec<String>,
}

/// Measured durations, in seconds.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct ReportSeconds {
    /// Duration of reading and importing the designs.
    pub import: f64,
    /// Duration of matching boundaries and parts.
    #[serde(rename = "match")]
    pub matching: f64,
    /// Duration of all other stages of building, except the preparation of rigid parts and of
    /// distance fields. For outlines, this is mostly the common triangulation. Reading the designs
    /// is included.
    pub triangulate: f64,
    /// Total duration of building the transition.
    pub build: f64,
    /// Median duration of moving a frame to another t.
    pub frame: f64,
    /// Median duration of computing the polygons of a frame.
    pub figure: f64,
    /// Duration of measuring the transition, without the proof.
    pub measure: f64,
    /// Duration of each progress stage of building, by the name of the stage.
    pub stages: StageDurations,
}

/// Result of the proof that the film has no folds and no crossings at any t.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct ProofReport {
    /// The result in words.
    pub words: String,
    /// Duration of recording the film and proving it, in seconds.
    pub seconds: f64,
    /// The proof itself; `None` if the film could not be recorded.
    #[serde(flatten)]
    pub proved: Option<TransitionProof>,
}

impl ProofReport {
    /// Records the film and tries to prove it; `None` if the transition has no faces.
    fn of(transition: &Transition, progress: &dyn Progress) -> Result<Option<Self>, CliError> {
        let start = Instant::now();
        let result = match transition.prove(&RecordingOptions::default(), progress) {
            Err(RecordingError::Cancelled(cancelled)) => return Err(CliError::failed(cancelled)),
            result => result,
        };
        let words = match &result {
            Ok(None) => return Ok(None),
            Ok(Some(proof)) => proof.to_string(),
            Err(error) => format!("not proved: {error}"),
        };
        Ok(Some(Self {
            words,
            seconds: start.elapsed().as_secs_f64(),
            proved: result.ok().flatten(),
        }))
    }

    /// Returns the first t at which folds or crossings are not excluded; `None` if there is none.
    pub fn first_t(&self) -> Option<f64> {
        self.proved.as_ref()?.first_failure_time()
    }
}

/// Defects of a film, in words and as data.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct VerdictReport {
    /// All defects in one line, or a text such as "no folds, no crossings".
    pub words: String,
    pub findings: Vec<FindingReport>,
    /// Notes on what was done differently from what was requested.
    pub notes: Vec<TransitionNote>,
}

/// One defect: the texts for people, and the data.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct FindingReport {
    pub words: String,
    pub cause_words: String,
    pub remedy_words: String,
    #[serde(flatten)]
    pub finding: Finding,
}

impl VerdictReport {
    fn of(verdict: Verdict) -> Self {
        let words = verdict.headline();
        let with_texts = |finding: Finding| FindingReport {
            words: finding.headline(),
            cause_words: finding.cause.to_string(),
            remedy_words: finding.remedy.to_string(),
            finding,
        };
        Self {
            words,
            findings: verdict.findings.into_iter().map(with_texts).collect(),
            notes: verdict.notes,
        }
    }
}

impl PairReport {
    /// Measures a transition at `samples` evenly spaced t. `stages` holds the durations of the
    /// progress stages of building.
    ///
    /// # Errors
    /// The work was cancelled.
    pub fn of(
        opened: &OpenedPair,
        stages: StageDurations,
        samples: usize,
        progress: &dyn Progress,
    ) -> Result<Self, CliError> {
        let transition = &opened.transition;
        let (frame, figure) = frame_times(transition);
        let start = Instant::now();
        let mesh = transition.compatible();
        let mesh_report = mesh.and_then(measure::mesh_report);
        let [sampling, checking] =
            [(0.0, 0.5), (0.5, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
        let film =
            measure::film_report(transition, samples, &sampling).map_err(CliError::failed)?;
        let verdict = Verdict::of_film(transition, &film, &checking).map_err(CliError::failed)?;
        let seconds = ReportSeconds {
            import: opened.import_time.as_secs_f64(),
            matching: clock::matching(&stages),
            triangulate: clock::triangulating(&stages),
            build: opened.build_time.as_secs_f64(),
            frame: frame.as_secs_f64(),
            figure: figure.as_secs_f64(),
            measure: start.elapsed().as_secs_f64(),
            stages,
        };
        Ok(Self {
            title: opened.title(),
            warp: transition.method().warp(),
            content: transition.method().content(),
            designs: transition.designs().iter().map(describe).collect(),
            vertices: mesh.map(|mesh| mesh.source().len()),
            faces: mesh.map(|mesh| mesh.faces().len()),
            grid: match transition.content() {
                Content::Field(fields) => {
                    let grid = fields.first_pair().grid();
                    Some([grid.width, grid.height])
                }
                Content::Solid(_) | Content::Colours(_) => None,
            },
            seconds,
            verdict: VerdictReport::of(verdict),
            mesh: mesh_report,
            samples: film.samples.len(),
            film,
            proof: None,
        })
    }

    /// Removes the samples of the film. They need most of the memory, and a table may have many
    /// pairs.
    pub fn without_samples(mut self) -> Self {
        self.film.samples = Vec::new();
        self
    }
}

/// Returns the description of a design.
fn describe(design: &Arc<Design>) -> DesignReport {
    let (kind, points) = match &design.form {
        DesignForm::Outline(regions) => {
            let points = regions.rings().map(|ring| ring.points().len()).sum();
            ("outline", points)
        }
        DesignForm::Mesh(mesh) => ("mesh", mesh.positions().len()),
        DesignForm::Truss(truss) => ("truss", truss.nodes().len()),
    };
    DesignReport {
        name: design.name.clone(),
        kind,
        points,
        notes: design.notes.iter().map(ToString::to_string).collect(),
    }
}

/// Measures the median time to move a frame to another t, and to compute its polygons.
fn frame_times(transition: &Transition) -> (Duration, Duration) {
    let mut frame = transition.frame(0.0);
    let times = (0..TIMED_FRAMES).map(|i| {
        let start = Instant::now();
        frame.seek((i as f64 + 0.5) / TIMED_FRAMES as f64);
        let seek_time = start.elapsed();
        let start = Instant::now();
        // The polygons are not used, so the compiler could remove their computation.
        std::hint::black_box(frame.figure());
        (seek_time, start.elapsed())
    });
    let (frames, figures): (Vec<_>, Vec<_>) = times.unzip();
    (median(frames), median(figures))
}

/// Returns the median of an odd number of times. For an even number, returns the larger of the two
/// middle times; without times, 0.
fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_middle() {
        let ms = Duration::from_millis;
        assert_eq!(median(vec![ms(9), ms(1), ms(2)]), ms(2));
        assert_eq!(median(vec![]), Duration::ZERO);
    }
}
