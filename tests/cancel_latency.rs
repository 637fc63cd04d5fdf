//! Tests that long work reports progress and can be cancelled without delay in each of its stages:
//! building every kind of transition, the search for a method, and measuring. Also tests that
//! builds that would take very long are refused.
//!
//! The target of the program is half a second, both for the delay until the first report and for
//! the delay until cancelled work ends. The bound here is five times as large, since the tests run
//! with little optimisation. Work that exceeds the bound is repeated: a busy machine delays one
//! attempt, but a stage that does not check for cancellation delays every attempt.

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use morphospace::content::ContentKind;
use morphospace::correspondence::PointPair;
use morphospace::design::Truss;
use morphospace::measure::{self, Verdict};
use morphospace::mesh::TriangleMesh;
use morphospace::transition::{BuildError, TransitionSpec};
use morphospace::work::progress::{Progress, Silent};
use morphospace::{DVec2, Design, Transition, TransitionMethod};

/// Maximum delay between a request to cancel and the end of the work, and between the start of the
/// work and its first report: five times the target of half a second.
const BOUND: Duration = Duration::from_millis(2500);

/// Delay between the first report of a stage and the request to cancel it, so that the stage is
/// cancelled midway (heuristic).
const DELAY_IN_STAGE: Duration = Duration::from_millis(40);

/// Progress that logs all reports of the work, and requests cancellation [`DELAY_IN_STAGE`] after
/// the given stage has begun.
struct CancelInStage {
    /// Number of the stage to cancel; the first stage is 1.
    stage: usize,
    log: Mutex<ProgressLog>,
}

/// Log of the work's reports, and the time at which cancellation is requested.
#[derive(Default)]
struct ProgressLog {
    stages: Vec<&'static str>,
    cancel_at: Option<Instant>,
    fractions: Vec<f64>,
    first_report: Option<Instant>,
}

impl CancelInStage {
    fn at(stage: usize) -> Self {
        Self {
            stage,
            log: Mutex::default(),
        }
    }
}

impl Progress for CancelInStage {
    fn report(&self, stage: &'static str, fraction: f64) {
        let mut log = self.log.lock().expect("free");
        log.first_report.get_or_insert_with(Instant::now);
        log.fractions.push(fraction);
        if !log.stages.contains(&stage) {
            log.stages.push(stage);
            if log.stages.len() == self.stage {
                log.cancel_at = Some(Instant::now() + DELAY_IN_STAGE);
            }
        }
    }

    fn is_cancelled(&self) -> bool {
        let log = self.log.lock().expect("free");
        log.cancel_at.is_some_and(|at| Instant::now() >= at)
    }
}

/// Number of consecutive attempts that must exceed [`BOUND`] for a test to fail.
const ATTEMPTS: u32 = 3;

/// Cancels the work in stage number `stage` (the first is 1) and returns the name of the stage;
/// `None` if the work has fewer stages.
///
/// # Errors
/// If a delay is above [`BOUND`]: a description of the delay.
fn cancel_in(stage: usize, work: impl Fn(&dyn Progress)) -> Result<Option<&'static str>, String> {
    let progress = CancelInStage::at(stage);
    let start = Instant::now();
    work(&progress);
    let log = progress.log.into_inner().expect("free");
    let fractions = log.fractions;
    assert!(
        fractions.is_sorted(),
        "the progress bar goes back: {fractions:?}"
    );
    assert!(
        fractions
            .iter()
            .all(|fraction| (0.0..=1.0).contains(fraction))
    );
    // Work that ends at once need not report anything.
    let first_report = log.first_report.unwrap_or_else(Instant::now) - start;
    if first_report > BOUND {
        return Err(format!("no report for {first_report:?}"));
    }
    let Some(at) = log.cancel_at else {
        return Ok(None);
    };
    let delay = Instant::now().saturating_duration_since(at);
    let stage = log.stages[stage - 1];
    if delay > BOUND {
        return Err(format!("{stage} took {delay:?} to cancel"));
    }
    Ok(Some(stage))
}

/// Locked while a test cancels work: the tests share the worker threads and would delay each other.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// Runs the work once for each of its stages and cancels it there; returns the names of the stages.
fn cancel_everywhere(name: &str, work: impl Fn(&dyn Progress)) -> Vec<&'static str> {
    let _lock = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let mut stages = Vec::new();
    loop {
        let mut attempt = cancel_in(stages.len() + 1, &work);
        for _ in 1..ATTEMPTS {
            attempt = attempt.or_else(|_| cancel_in(stages.len() + 1, &work));
        }
        match attempt {
            Ok(Some(stage)) => stages.push(stage),
            Ok(None) => return stages,
            Err(delay) => panic!("{name}: {delay}, {ATTEMPTS} times"),
        }
    }
}

/// Returns work that builds a transition. The work asserts that the build succeeds or, if it was
/// cancelled, that the error says so.
fn build(spec: &TransitionSpec) -> impl Fn(&dyn Progress) {
    |progress| {
        let built = Transition::build(spec, progress);
        if progress.is_cancelled() {
            // The build may also have succeeded just before the request to cancel.
            let is_cancelled = |error: String| error.contains("cancelled");
            assert!(
                built
                    .err()
                    .is_none_or(|error| is_cancelled(error.to_string()))
            );
        } else {
            built.expect("built");
        }
    }
}

/// A gear of radius 1 with teeth of the given depth, and with a row of small round holes across its
/// centre.
fn gear(name: &str, teeth: u32, depth: f64, holes: u32) -> Arc<Design> {
    let tooth = |k: u32| {
        let radius = if k % 4 < 2 { 1.0 } else { 1.0 - depth };
        radius * DVec2::from_angle(TAU * f64::from(k) / f64::from(4 * teeth))
    };
    let hole = |h: u32| {
        let centre = DVec2::new(f64::from(2 * h + 1) / f64::from(holes) - 1.0, 0.0) * 0.6;
        let point = move |k: u32| centre + 0.03 * DVec2::from_angle(TAU * f64::from(k) / 12.0);
        (0..12).map(point).collect::<Vec<_>>()
    };
    let outer = (0..4 * teeth).map(tooth).collect();
    let rings = std::iter::once(outer).chain((0..holes).map(hole));
    Arc::new(Design::from_rings(name, rings).expect("a gear"))
}

/// A truss whose bars form a zigzag chain.
fn zigzag(bars: u32) -> Arc<Design> {
    let node = |k: u32| DVec2::new(f64::from(k), f64::from(k % 2));
    let pairs = (0..bars).map(|k| [k, k + 1]).collect();
    let truss = Truss::new((0..=bars).map(node).collect(), pairs).expect("a truss");
    Arc::new(Design::new("zigzag", truss))
}

/// A truss with a bar between each pair of its nodes.
fn complete_truss(nodes: u32) -> Arc<Design> {
    let node = |k: u32| DVec2::from_angle(TAU * f64::from(k * k) / f64::from(7 * nodes));
    let bars = (0..nodes).flat_map(|a| (a + 1..nodes).map(move |b| [a, b]));
    let truss = Truss::new((0..nodes).map(node).collect(), bars.collect());
    Arc::new(Design::new("net", truss.expect("a truss")))
}

/// A triangulated square grid of `side` × `side` vertices, whose rows are parabolas if `bend` is
/// not 0.
fn sheet(side: u32, bend: f64) -> Arc<Design> {
    let vertex = |k: u32| {
        let (x, y) = (f64::from(k % side), f64::from(k / side));
        DVec2::new(x, y + bend * x * x / f64::from(side))
    };
    let faces = (0..(side - 1) * (side - 1)).flat_map(|k| {
        let a = k / (side - 1) * side + k % (side - 1);
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    });
    let mesh = TriangleMesh::new((0..side * side).map(vertex).collect(), faces.collect());
    Arc::new(Design::new("sheet", mesh.expect("a mesh")))
}

fn spec(source: &Arc<Design>, target: &Arc<Design>) -> TransitionSpec {
    TransitionSpec::new(Arc::clone(source), Arc::clone(target))
}

#[test]
fn outlines_with_holes_are_cancelled_at_every_stage() {
    let spec = spec(&gear("gear", 30, 0.3, 3), &gear("ring", 17, 0.6, 1));
    let stages = cancel_everywhere("outlines", build(&spec));
    for stage in [
        "matching",
        "triangulating",
        "removing folds",
        "improving",
        "factoring",
    ] {
        assert!(stages.contains(&stage), "{stages:?}");
    }
}

#[test]
fn a_large_mesh_is_cancelled_at_every_stage() {
    let mut spec = spec(&sheet(40, 0.0), &sheet(40, 0.5));
    spec.options.arap.subdivisions = 2;
    let stages = cancel_everywhere("mesh", build(&spec));
    assert!(stages.contains(&"factoring"), "{stages:?}");
}

#[test]
fn trusses_are_cancelled_at_every_stage() {
    let net = complete_truss(32);
    cancel_everywhere("nets", build(&spec(&net, &net)));
    let stages = cancel_everywhere("bars", build(&spec(&zigzag(900), &gear("disc", 9, 0.1, 0))));
    assert!(stages.contains(&"uniting"), "{stages:?}");
}

#[test]
fn fields_are_cancelled_at_every_stage() {
    let (source, target) = (gear("gear", 40, 0.3, 3), gear("ring", 17, 0.6, 1));
    for cell in TransitionMethod::all().filter(|cell| cell.content() == ContentKind::Field) {
        let mut spec = spec(&source, &target);
        spec.method = cell;
        spec.options.field.cells = 700;
        cancel_everywhere(cell.name(), build(&spec));
    }
}

#[test]
fn the_method_search_is_cancelled_at_every_stage() {
    let mut spec = spec(&gear("gear", 20, 0.3, 2), &gear("ring", 17, 0.6, 1));
    spec.options.field.cells = 200;
    let stages = cancel_everywhere("auto", |progress| {
        let chosen = measure::build_best_method(&spec, progress);
        assert!(chosen.is_ok() || progress.is_cancelled());
    });
    assert!(stages.contains(&"measuring"), "{stages:?}");
}

#[test]
fn a_plane_warp_with_many_pins_is_cancelled_at_every_stage() {
    let mut spec = spec(&gear("gear", 30, 0.3, 3), &gear("ring", 17, 0.6, 1));
    spec.method = TransitionMethod::all()
        .find(|cell| cell.content() == ContentKind::Field)
        .expect("a cell");
    let pin = |k: u32| {
        let at = |turn: f64| 0.8 * DVec2::from_angle(0.5 * f64::from(k) + turn);
        let (source, target) = (at(0.0), at(0.3));
        PointPair { source, target }
    };
    spec.options.matching.pins = (0..12).map(pin).collect();
    cancel_everywhere("pins", build(&spec));
}

#[test]
fn measuring_is_cancelled_at_every_stage() {
    let spec = spec(&gear("gear", 20, 0.3, 2), &gear("ring", 17, 0.6, 1));
    let transition = Transition::build(&spec, &Silent).expect("built");
    cancel_everywhere("film", |progress| {
        let film = measure::film_report(&transition, 65, progress);
        assert!(film.is_ok() || progress.is_cancelled());
    });
    let film = measure::film_report(&transition, 65, &Silent).expect("not cancelled");
    cancel_everywhere("verdict", |progress| {
        let verdict = Verdict::of_film(&transition, &film, progress);
        assert!(verdict.is_ok() || progress.is_cancelled());
    });
}

#[test]
fn very_long_builds_are_refused_in_advance() {
    let net = complete_truss(32);
    let disc = gear("disc", 6000, 0.01, 0);
    let mut spec = spec(&disc, &disc);
    let refused = Transition::build(&spec, &Silent).expect_err("too much");
    assert!(
        matches!(refused.reason(), BuildError::TooMuch(_)),
        "{refused}"
    );
    assert!(
        refused.to_string().contains("simplify the outlines"),
        "{refused}"
    );
    spec.method = spec.method.fallback();
    assert!(
        Transition::build(&spec, &Silent).is_ok(),
        "the plain method replaces it"
    );
    spec.method = TransitionMethod::RIGID_PARTS;
    // The number of triangles is computed before the first subdivision, so the build is refused
    // at once.
    spec.source = Arc::clone(&net);
    spec.target = net;
    spec.options.arap.subdivisions = u32::MAX;
    let start = Instant::now();
    let refused = Transition::build(&spec, &Silent).expect_err("too much");
    assert!(
        matches!(refused.reason(), BuildError::TooMuch(_)),
        "{refused}"
    );
    spec.options.arap.subdivisions = 0;
    spec.method = TransitionMethod::FIELD_BLEND;
    spec.options.field.cells = 8192;
    let refused = Transition::build(&spec, &Silent).expect_err("too much");
    assert!(
        refused.to_string().contains("choose fewer cells"),
        "{refused}"
    );
    assert!(start.elapsed() < BOUND);
}
