//! Everything that is measured of one transition.

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

/// Frames whose times are taken: an odd number has a middle, and the first few,
/// which find cold caches, are far from it.
const TIMED_FRAMES: usize = 15;

/// How much is done once the transition is built, as it is told.
const BUILT: f64 = 0.6;

/// How transitions are built and measured.
#[derive(Debug, Args)]
pub(in crate::cli) struct MeasuringArgs {
    /// At how many values of t, evenly from 0 to 1, the film is measured
    #[arg(long, value_name = "N", default_value_t = 65, value_parser = clap::value_parser!(u64).range(2..=10_000))]
    samples: u64,

    /// Prove that nothing folds and no outlines meet at any t, or say when they may
    #[arg(long)]
    prove: bool,

    #[command(flatten)]
    method: MethodArgs,
}

impl MeasuringArgs {
    /// How transitions are built.
    pub fn method(&self) -> &MethodArgs {
        &self.method
    }

    /// As [`Self::of`], of what is no sequence.
    pub fn of_pair(
        &self,
        inputs: &InputArgs,
        progress: &dyn Progress,
    ) -> Result<(OpenedPair, PairReport), CliError> {
        let first = self.of(inputs, progress)?.into_iter().next();
        Ok(first.unwrap_or_else(|| unreachable!("there is a leg")))
    }

    /// Builds a transition, or each leg of a sequence, and measures it.
    pub fn of(
        &self,
        inputs: &InputArgs,
        progress: &dyn Progress,
    ) -> Result<Vec<(OpenedPair, PairReport)>, CliError> {
        let whole = OverallProgress::new(progress);
        let building = ProgressSpan::new(&whole, 0.0, BUILT);
        let clock = StageClock::new(&building);
        let measuring = ProgressSpan::new(&whole, BUILT, 1.0);
        let mut all = Vec::new();
        inputs.open_each(&self.method, &clock, |opened| {
            let samples = self.samples as usize;
            let mut report = PairReport::of(&opened, clock.stages(), samples, &measuring)?;
            if self.prove {
                report.proof = ProofReport::of(&opened.transition, progress)?;
            }
            all.push((opened, report));
            Ok(())
        })?;
        Ok(all)
    }
}

/// Everything that is measured.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct PairReport {
    pub title: String,
    pub warp: WarpKind,
    pub content: ContentKind,
    pub designs: Vec<DesignReport>,
    /// Vertices of the common triangulation.
    pub vertices: Option<usize>,
    /// Its faces.
    pub faces: Option<usize>,
    /// Width and height of the fields' grid.
    pub grid: Option<[u32; 2]>,
    pub seconds: ReportSeconds,
    pub verdict: VerdictReport,
    pub mesh: Option<MeshReport>,
    pub film: FilmReport,
    /// What holds at every t, where that was asked for and there are faces.
    pub proof: Option<ProofReport>,
    /// How many samples the film had, even if they were forgotten.
    #[serde(skip)]
    pub samples: usize,
}

#[derive(Debug, Serialize)]
pub(in crate::cli) struct DesignReport {
    pub name: String,
    pub kind: &'static str,
    /// Points of its outline, vertices of its mesh or nodes of its truss.
    pub points: usize,
    /// What was repaired or left out while it was read.
    pub notes: Vec<String>,
}

/// How long each stage took.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct ReportSeconds {
    /// Reading and importing the designs.
    pub import: f64,
    /// Matching boundaries and parts.
    #[serde(rename = "match")]
    pub matching: f64,
    /// Making a common triangulation.
    pub triangulate: f64,
    /// Building the transition, all of it.
    pub build: f64,
    /// Moving a frame to another t, the median of some.
    pub frame: f64,
    /// Evaluating it as polygons, likewise.
    pub figure: f64,
    /// Measuring all that is reported here.
    pub measure: f64,
    /// The stages of building by name.
    pub stages: StageDurations,
}

/// What is proved, with its words.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct ProofReport {
    pub words: String,
    /// How long it took to record the film and to prove it.
    pub seconds: f64,
    /// None where there is no film.
    #[serde(flatten)]
    pub proved: Option<TransitionProof>,
}

impl ProofReport {
    fn of(transition: &Transition, progress: &dyn Progress) -> Result<Option<Self>, CliError> {
        let start = Instant::now();
        let proved = match transition.prove(&RecordingOptions::default(), progress) {
            Err(RecordingError::Cancelled(cancelled)) => return Err(CliError::failed(cancelled)),
            proved => proved,
        };
        let words = match &proved {
            Ok(None) => return Ok(None),
            Ok(Some(proved)) => proved.to_string(),
            Err(error) => format!("not proved: {error}"),
        };
        Ok(Some(Self {
            words,
            seconds: start.elapsed().as_secs_f64(),
            proved: proved.ok().flatten(),
        }))
    }

    /// The first t at which it is not proved.
    pub fn first_t(&self) -> Option<f64> {
        self.proved.as_ref()?.first_failure_time()
    }
}

/// The verdict with its words.
#[derive(Debug, Serialize)]
pub(in crate::cli) struct VerdictReport {
    pub words: String,
    pub findings: Vec<FindingReport>,
    /// What was done otherwise than asked while the transition was built.
    pub notes: Vec<TransitionNote>,
}

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
        let told = |finding: Finding| FindingReport {
            words: finding.headline(),
            cause_words: finding.cause.to_string(),
            remedy_words: finding.remedy.to_string(),
            finding,
        };
        Self {
            words,
            findings: verdict.findings.into_iter().map(told).collect(),
            notes: verdict.notes,
        }
    }
}

impl PairReport {
    /// Measures a transition at so many t.
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
        let [filming, judging] =
            [(0.0, 0.5), (0.5, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
        let film = measure::film_report(transition, samples, &filming).map_err(CliError::failed)?;
        let verdict = Verdict::of_film(transition, &film, &judging).map_err(CliError::failed)?;
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
            designs: transition.designs().iter().map(of_design).collect(),
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

    /// Without the samples, which take most of the room: one in a long table.
    pub fn without_samples(mut self) -> Self {
        self.film.samples = Vec::new();
        self
    }
}

fn of_design(design: &Arc<Design>) -> DesignReport {
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

/// Median times of moving a frame and of evaluating it.
fn frame_times(transition: &Transition) -> (Duration, Duration) {
    let mut frame = transition.frame(0.0);
    let timed = (0..TIMED_FRAMES).map(|i| {
        let start = Instant::now();
        frame.seek((i as f64 + 0.5) / TIMED_FRAMES as f64);
        let moved = start.elapsed();
        let start = Instant::now();
        // Nobody looks at it, so that it might as well be left out.
        std::hint::black_box(frame.figure());
        (moved, start.elapsed())
    });
    let (frames, figures): (Vec<_>, Vec<_>) = timed.unzip();
    (median(frames), median(figures))
}

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
