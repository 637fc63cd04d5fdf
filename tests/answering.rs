//! The program answers: a cancel at every stage of everything, what it is at
//! from the first moment on, and before it begins what would take very long.
//!
//! The promise is half a second; the bounds here are five times as large, and
//! the library under test is hardly optimised. What is late is tried anew: a
//! machine that was busy with something else is late once, what is deaf always.

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

/// Five times the half second that is promised.
const BOUND: Duration = Duration::from_millis(2500);

/// So long after a stage was told first it is cancelled: in the midst of it.
const INTO_IT: Duration = Duration::from_millis(40);

/// Cancels a while after the stage of that number was first told.
struct Impatient {
    stage: usize,
    heard: Mutex<Heard>,
}

#[derive(Default)]
struct Heard {
    stages: Vec<&'static str>,
    cancel_at: Option<Instant>,
    shares: Vec<f64>,
    first: Option<Instant>,
}

impl Impatient {
    fn at(stage: usize) -> Self {
        Self {
            stage,
            heard: Mutex::default(),
        }
    }
}

impl Progress for Impatient {
    fn report(&self, stage: &'static str, fraction: f64) {
        let mut heard = self.heard.lock().expect("free");
        heard.first.get_or_insert_with(Instant::now);
        heard.shares.push(fraction);
        if !heard.stages.contains(&stage) {
            heard.stages.push(stage);
            if heard.stages.len() == self.stage {
                heard.cancel_at = Some(Instant::now() + INTO_IT);
            }
        }
    }

    fn is_cancelled(&self) -> bool {
        let heard = self.heard.lock().expect("free");
        heard.cancel_at.is_some_and(|at| Instant::now() >= at)
    }
}

/// How often what is late is tried.
const TRIES: u32 = 3;

/// Cancels the work in its stage of a number from 1 and returns its name; none
/// if it has fewer stages. Fails with what was late.
fn cancel_in(stage: usize, work: impl Fn(&dyn Progress)) -> Result<Option<&'static str>, String> {
    let progress = Impatient::at(stage);
    let begun = Instant::now();
    work(&progress);
    let heard = progress.heard.into_inner().expect("free");
    let shares = heard.shares;
    assert!(shares.is_sorted(), "the bar goes back: {shares:?}");
    assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
    // What is done at once need not say what it was at.
    let first = heard.first.unwrap_or_else(Instant::now) - begun;
    if first > BOUND {
        return Err(format!("said nothing for {first:?}"));
    }
    let Some(at) = heard.cancel_at else {
        return Ok(None);
    };
    let late = Instant::now().saturating_duration_since(at);
    let stage = heard.stages[stage - 1];
    if late > BOUND {
        return Err(format!("{stage} was cancelled after {late:?} only"));
    }
    Ok(Some(stage))
}

/// Held while work is cancelled: all tests share the threads that it runs on,
/// and one would wait for what another does.
static ALONE: Mutex<()> = Mutex::new(());

/// Cancels the work in each of its stages; the stages by name.
fn cancel_everywhere(name: &str, work: impl Fn(&dyn Progress)) -> Vec<&'static str> {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut stages = Vec::new();
    loop {
        let mut tried = cancel_in(stages.len() + 1, &work);
        for _ in 1..TRIES {
            tried = tried.or_else(|_| cancel_in(stages.len() + 1, &work));
        }
        match tried {
            Ok(Some(stage)) => stages.push(stage),
            Ok(None) => return stages,
            Err(late) => panic!("{name}: {late}, {TRIES} times"),
        }
    }
}

fn build(spec: &TransitionSpec) -> impl Fn(&dyn Progress) {
    |progress| {
        let built = Transition::build(spec, progress);
        if progress.is_cancelled() {
            // It may have been done just before.
            let cancelled = |error: String| error.contains("cancelled");
            assert!(built.err().is_none_or(|error| cancelled(error.to_string())));
        } else {
            built.expect("built");
        }
    }
}

/// Teeth around a circle, and holes in a row through its middle.
fn gear(name: &str, teeth: u32, depth: f64, holes: u32) -> Arc<Design> {
    let tooth = |k: u32| {
        let radius = if k % 4 < 2 { 1.0 } else { 1.0 - depth };
        radius * DVec2::from_angle(TAU * f64::from(k) / f64::from(4 * teeth))
    };
    let hole = |h: u32| {
        let middle = DVec2::new(f64::from(2 * h + 1) / f64::from(holes) - 1.0, 0.0) * 0.6;
        let place = move |k: u32| middle + 0.03 * DVec2::from_angle(TAU * f64::from(k) / 12.0);
        (0..12).map(place).collect::<Vec<_>>()
    };
    let outer = (0..4 * teeth).map(tooth).collect();
    let rings = std::iter::once(outer).chain((0..holes).map(hole));
    Arc::new(Design::of_rings(name, rings).expect("a gear"))
}

fn zigzag(bars: u32) -> Arc<Design> {
    let node = |k: u32| DVec2::new(f64::from(k), f64::from(k % 2));
    let bars_of = (0..bars).map(|k| [k, k + 1]).collect();
    let truss = Truss::new((0..=bars).map(node).collect(), bars_of).expect("a truss");
    Arc::new(Design::new("zigzag", truss))
}

/// Every node joined to every other.
fn everything_joined(nodes: u32) -> Arc<Design> {
    let node = |k: u32| DVec2::from_angle(TAU * f64::from(k * k) / f64::from(7 * nodes));
    let bars = (0..nodes).flat_map(|a| (a + 1..nodes).map(move |b| [a, b]));
    let truss = Truss::new((0..nodes).map(node).collect(), bars.collect());
    Arc::new(Design::new("net", truss.expect("a truss")))
}

fn sheet(side: u32, bend: f64) -> Arc<Design> {
    let place = |k: u32| {
        let (x, y) = (f64::from(k % side), f64::from(k / side));
        DVec2::new(x, y + bend * x * x / f64::from(side))
    };
    let faces = (0..(side - 1) * (side - 1)).flat_map(|k| {
        let a = k / (side - 1) * side + k % (side - 1);
        [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]
    });
    let mesh = TriangleMesh::new((0..side * side).map(place).collect(), faces.collect());
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
    let net = everything_joined(32);
    cancel_everywhere("nets", build(&spec(&net, &net)));
    let stages = cancel_everywhere("bars", build(&spec(&zigzag(900), &gear("disc", 9, 0.1, 0))));
    assert!(stages.contains(&"uniting"), "{stages:?}");
}

#[test]
fn fields_are_cancelled_at_every_stage() {
    let (source, target) = (gear("gear", 40, 0.3, 3), gear("ring", 17, 0.6, 1));
    for cell in TransitionMethod::all().filter(|cell| cell.content() == ContentKind::Field) {
        let mut spec = spec(&source, &target);
        spec.cell = cell;
        spec.options.field.cells = 700;
        cancel_everywhere(cell.name(), build(&spec));
    }
}

#[test]
fn the_choice_of_a_method_is_cancelled_at_every_stage() {
    let mut spec = spec(&gear("gear", 20, 0.3, 2), &gear("ring", 17, 0.6, 1));
    spec.options.field.cells = 200;
    let stages = cancel_everywhere("auto", |progress| {
        let chosen = measure::auto(&spec, progress);
        assert!(chosen.is_ok() || progress.is_cancelled());
    });
    assert!(stages.contains(&"measuring"), "{stages:?}");
}

#[test]
fn a_plane_about_many_pins_is_cancelled_at_every_stage() {
    let mut spec = spec(&gear("gear", 30, 0.3, 3), &gear("ring", 17, 0.6, 1));
    spec.cell = TransitionMethod::all()
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
        let film = measure::film(&transition, 65, progress);
        assert!(film.is_ok() || progress.is_cancelled());
    });
    let film = measure::film(&transition, 65, &Silent).expect("not cancelled");
    cancel_everywhere("verdict", |progress| {
        let verdict = Verdict::of_film(&transition, &film, progress);
        assert!(verdict.is_ok() || progress.is_cancelled());
    });
}

#[test]
fn what_would_take_very_long_is_said_in_advance() {
    let net = everything_joined(32);
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
    spec.cell = spec.cell.plain();
    assert!(
        Transition::build(&spec, &Silent).is_ok(),
        "a blend meanwhile"
    );
    spec.cell = TransitionMethod::RIGID_PARTS;
    // Subdivisions are counted before anything is done.
    spec.source = Arc::clone(&net);
    spec.target = net;
    spec.options.arap.subdivisions = u32::MAX;
    let begun = Instant::now();
    let refused = Transition::build(&spec, &Silent).expect_err("too much");
    assert!(
        matches!(refused.reason(), BuildError::TooMuch(_)),
        "{refused}"
    );
    spec.options.arap.subdivisions = 0;
    spec.cell = TransitionMethod::FIELD_BLEND;
    spec.options.field.cells = 8192;
    let refused = Transition::build(&spec, &Silent).expect_err("too much");
    assert!(
        refused.to_string().contains("choose fewer cells"),
        "{refused}"
    );
    assert!(begun.elapsed() < BOUND);
}
