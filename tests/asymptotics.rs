//! Tests how the program's time and memory grow with the size n of its input.
//!
//! n is the number of holes, of separate polygons, of nested rings, of pieces into which a star
//! cuts itself, or a fifth of the number of bars. The time grows at most as n² log n, and the
//! memory stays below 1 GiB.
//! `cargo test --release --test asymptotics` tests all families of inputs; without `--release` only
//! the quick ones.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use morphospace::DVec2;

/// Time and memory that one run of the program takes.
#[derive(Clone, Copy, Debug)]
struct RunCost {
    /// Processor time, which hardly depends on other processes.
    cpu_seconds: f64,
    /// Maximum resident memory of the process since its start.
    peak_mebibytes: f64,
}

/// Runs the program with the arguments of `line`; returns its cost, sampled until it ends.
fn run_cost(folder: &Path, line: &str) -> RunCost {
    let mut child = Command::new(env!("CARGO_BIN_EXE_morphospace"))
        .current_dir(folder)
        .args(line.split_whitespace())
        .stdout(Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut total = RunCost {
        cpu_seconds: 0.0,
        peak_mebibytes: 0.0,
    };
    loop {
        let ended = child.try_wait().expect("a child");
        if let Some(cost) = cost_so_far(child.id()) {
            total = cost;
        }
        if let Some(status) = ended {
            assert!(status.success(), "{line}: {status}");
            return total;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Reads the processor time and the peak memory of a process from `/proc`; `None` once the process
/// has ended.
fn cost_so_far(process: u32) -> Option<RunCost> {
    let read = |file: &str| fs::read_to_string(format!("/proc/{process}/{file}")).ok();
    let status = read("status")?;
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = peak.trim().strip_suffix(" kB")?.parse().ok()?;
    // The program name, in parentheses, may contain spaces, so only the fields after it are split.
    // Counted from 0, fields 11 and 12 of these are the user and system time in ticks of 1/100 s.
    let stat = read("stat")?;
    let fields: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field)?.parse::<f64>().ok();
    Some(RunCost {
        cpu_seconds: (ticks(11)? + ticks(12)?) / 100.0,
        peak_mebibytes: kibibytes / 1024.0,
    })
}

/// Values of n, the size of the inputs; each is twice the previous one.
const SIZES: [u32; 4] = [10, 20, 40, 80];

/// Factor by which the growth of the time may exceed that of n² log n (tolerance: timing noise).
const SLACK: f64 = 5.0;

/// Minimum time, in seconds, relative to which growth is measured; shorter times count as this one
/// (tolerance: shorter times mostly consist of the start of the program).
const MIN_SECONDS: f64 = 0.25;

/// Asserts that time and memory for a transition from `design(n)` to a square grow slowly with n.
fn assert_slow_growth(name: &str, design: impl Fn(u32) -> String) {
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, text: String| fs::write(folder.path().join(name), text).expect("written");
    write("square.json", "[[0,0],[4,0],[4,4],[0,4]]".to_owned());
    let costs = SIZES.map(|n| {
        write("a.json", design(n));
        run_cost(
            folder.path(),
            "render a.json square.json --at 0.5 --out half.svg",
        )
    });
    let work = |n: u32| f64::from(n).powi(2) * f64::from(n).ln();
    for (small, large) in [(1, 3), (0, 2), (2, 3)] {
        let expected_factor = work(SIZES[large]) / work(SIZES[small]);
        let allowed = SLACK * expected_factor * costs[small].cpu_seconds.max(MIN_SECONDS);
        assert!(
            costs[large].cpu_seconds < allowed,
            "{name} of {}: {costs:?}",
            SIZES[large]
        );
    }
    assert!(
        costs.iter().all(|cost| cost.peak_mebibytes < 1024.0),
        "{name}: {costs:?}"
    );
}

/// JSON text of a polygon file with these rings.
fn polygons(rings: impl Iterator<Item = Vec<DVec2>>) -> String {
    let ring = |ring: Vec<DVec2>| ring.iter().map(|p| p.to_array()).collect::<Vec<_>>();
    serde_json::to_string(&rings.map(ring).collect::<Vec<_>>()).expect("numbers")
}

/// Corners of a regular polygon with `points` corners.
fn regular_polygon(centre: DVec2, radius: f64, points: u32) -> Vec<DVec2> {
    let point =
        |k: u32| centre + radius * DVec2::from_angle(TAU * f64::from(k) / f64::from(points));
    (0..points).map(point).collect()
}

/// The first `count` positions of a unit grid, in rows of ten.
fn grid_positions(count: u32) -> impl Iterator<Item = DVec2> {
    (0..count).map(|k| DVec2::new(f64::from(k % 10) + 0.5, f64::from(k / 10) + 0.5))
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes minutes unless optimised")]
fn time_for_holes_grows_at_most_quadratically() {
    assert_slow_growth("holes", |n| {
        let sheet = [(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)].map(DVec2::from);
        let holes = grid_positions(n).map(|p| regular_polygon(p, 0.3, 6));
        polygons(std::iter::once(sheet.to_vec()).chain(holes))
    });
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes minutes unless optimised")]
fn time_for_pieces_grows_at_most_quadratically() {
    assert_slow_growth("pieces", |n| {
        polygons(grid_positions(n).map(|p| regular_polygon(p, 0.3, 6)))
    });
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes minutes unless optimised")]
fn time_for_nested_rings_grows_at_most_quadratically() {
    assert_slow_growth("nested", |n| {
        polygons((1..=n).map(|k| regular_polygon(DVec2::ZERO, f64::from(k), 6)))
    });
}

#[test]
fn time_for_self_crossing_stars_grows_at_most_quadratically_in_their_pieces() {
    // A star with p points has about p² / 4 crossings and pieces, so p ≈ 2√n gives about n pieces.
    assert_slow_growth("stars", |n| {
        let points = (2.0 * f64::from(n).sqrt()) as u32 | 1;
        let step = TAU * f64::from(points / 2) / f64::from(points);
        let star = (0..points).map(|k| DVec2::from_angle(f64::from(k) * step));
        polygons(std::iter::once(star.collect()))
    });
}

#[test]
fn time_for_bars_grows_at_most_quadratically() {
    assert_slow_growth("bars", |n| {
        let nodes: Vec<_> = (0..=5 * n).map(|k| [k, k % 2]).collect();
        let bars: Vec<_> = (0..5 * n).map(|k| [k, k + 1]).collect();
        serde_json::json!({ "nodes": nodes, "bars": bars }).to_string()
    });
}
