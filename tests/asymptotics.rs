//! Tests how the program's time and memory grow with the size n of its input, at the best quality.
//!
//! n is the number of holes, of separate polygons, of nested rings, of dashes, of letters, of pieces
//! into which a star cuts itself or of designs on a map, a fifth of the number of bars, or a tenth
//! of the number of points of an outline. The time grows at most as n² log n, and the memory stays
//! below 1 GiB. Without `--release`, n is at most 40, and dashes and letters are left out. `cargo
//! test --release --no-default-features --features cli --test asymptotics -- --nocapture
//! --test-threads 1` prints the measured times.

#![expect(clippy::print_stdout, reason = "measured times are printed")]

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
const SIZES: &[u32] = match cfg!(debug_assertions) {
    true => &[10, 20, 40],
    false => &[10, 20, 40, 80],
};

/// A design of one family of inputs.
enum FamilyDesign {
    /// Name and content of its file.
    File(&'static str, String),
    /// Text to be drawn.
    Letters(String),
}

/// Factor by which the growth of the time may exceed that of n² log n (tolerance: timing noise).
const SLACK: f64 = 5.0;

/// Minimum time, in seconds, relative to which growth is measured; shorter times count as this one
/// (tolerance: shorter times mostly consist of the start of the program).
const MIN_SECONDS: f64 = 0.25;

/// Asserts that time and memory for a transition from `design(n)` to a square grow slowly with n,
/// and prints them.
fn assert_slow_growth(name: &str, design: impl Fn(u32) -> FamilyDesign) {
    assert_slow_growth_of_run(name, |folder, n| {
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).expect("written");
        write("square.json", "[[0,0],[4,0],[4,4],[0,4]]");
        let source = match design(n) {
            FamilyDesign::File(name, text) => {
                write(name, &text);
                name.to_owned()
            }
            FamilyDesign::Letters(letters) => format!("glyph:{letters}"),
        };
        format!("render {source} square.json --at 0.5 --out half.svg")
    });
}

/// Asserts that time and memory of the program grow slowly with n, and prints them. `line` writes
/// the inputs into a folder and returns the arguments.
fn assert_slow_growth_of_run(name: &str, line: impl Fn(&Path, u32) -> String) {
    let folder = tempfile::tempdir().expect("a folder");
    let cost = |&n: &u32| run_cost(folder.path(), &line(folder.path(), n));
    let costs: Vec<RunCost> = SIZES.iter().map(cost).collect();
    let seconds: Vec<f64> = costs.iter().map(|cost| cost.cpu_seconds).collect();
    let last = SIZES.len() - 1;
    let exponent = (seconds[last] / seconds[last - 1]).log2();
    println!("{name}: {seconds:.2?} s for n = {SIZES:?}, exponent {exponent:.1}");
    let work = |n: u32| f64::from(n).powi(2) * f64::from(n).ln();
    for (small, large) in (0..last).map(|small| (small, last)) {
        let expected_factor = work(SIZES[large]) / work(SIZES[small]);
        let allowed = SLACK * expected_factor * seconds[small].max(MIN_SECONDS);
        assert!(
            seconds[large] < allowed,
            "{name} of {}: {costs:?}",
            SIZES[large]
        );
    }
    assert!(
        costs.iter().all(|cost| cost.peak_mebibytes < 1024.0),
        "{name}: {costs:?}"
    );
}

/// A polygon file with these rings.
fn polygons(rings: impl Iterator<Item = Vec<DVec2>>) -> FamilyDesign {
    let ring = |ring: Vec<DVec2>| ring.iter().map(|p| p.to_array()).collect::<Vec<_>>();
    let text = serde_json::to_string(&rings.map(ring).collect::<Vec<_>>()).expect("numbers");
    FamilyDesign::File("a.json", text)
}

/// A polygon file with one ring around the origin, of `points` points in equal directions at the
/// distances that `radius` returns for their index.
fn closed_curve(points: u32, radius: impl Fn(u32) -> f64) -> FamilyDesign {
    let point = |k: u32| radius(k) * DVec2::from_angle(TAU * f64::from(k) / f64::from(points));
    polygons(std::iter::once((0..points).map(point).collect()))
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
fn time_for_holes_grows_at_most_quadratically() {
    assert_slow_growth("holes", |n| {
        let sheet = [(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)].map(DVec2::from);
        let holes = grid_positions(n).map(|p| regular_polygon(p, 0.3, 6));
        polygons(std::iter::once(sheet.to_vec()).chain(holes))
    });
}

#[test]
fn time_for_pieces_grows_at_most_quadratically() {
    assert_slow_growth("pieces", |n| {
        polygons(grid_positions(n).map(|p| regular_polygon(p, 0.3, 6)))
    });
}

#[test]
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
        let truss = serde_json::json!({ "nodes": nodes, "bars": bars });
        FamilyDesign::File("truss.json", truss.to_string())
    });
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes a minute unless optimised")]
fn time_for_dashes_grows_at_most_quadratically() {
    assert_slow_growth("dashes", |n| {
        let dash = TAU * 40.0 / (2.0 * f64::from(n));
        let circle = format!(
            "<circle cx='50' cy='50' r='40' fill='none' stroke='black' stroke-width='2' \
             stroke-dasharray='{dash}'/>"
        );
        let svg =
            format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{circle}</svg>");
        FamilyDesign::File("a.svg", svg)
    });
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes a minute unless optimised")]
fn time_for_letters_grows_at_most_quadratically() {
    assert_slow_growth("letters", |n| {
        let letters = ('A'..='Z').cycle().take(n as usize);
        FamilyDesign::Letters(letters.collect())
    });
}

#[test]
fn time_for_noisy_outlines_grows_at_most_quadratically_in_their_points() {
    assert_slow_growth("noisy outline", |n| {
        // The fractional parts of k² · 0.618… are spread evenly and look like noise (Weyl, 1916).
        closed_curve(10 * n, |k| 8.0 + (f64::from(k * k) * 0.618_034).fract())
    });
}

#[test]
fn time_for_combs_grows_at_most_quadratically_in_their_points() {
    assert_slow_growth("comb", |n| {
        let tooth = |k: u32| {
            [(0.0, 60.0), (0.5, 60.0), (0.5, 10.0), (1.0, 10.0)]
                .map(|(x, y)| DVec2::new(f64::from(k) + x, y))
        };
        let teeth = 5 * n / 2;
        let ends = [DVec2::new(f64::from(teeth), 0.0), DVec2::ZERO];
        polygons(std::iter::once(
            (0..teeth).flat_map(tooth).chain(ends).collect(),
        ))
    });
}

#[test]
fn time_for_smooth_outlines_grows_at_most_quadratically_in_their_points() {
    assert_slow_growth("smooth outline", |n| {
        let lobes = TAU * 5.0 / f64::from(10 * n);
        closed_curve(10 * n, |k| 8.0 + 2.0 * (lobes * f64::from(k)).sin())
    });
}

#[test]
fn time_for_maps_grows_at_most_quadratically_in_their_designs() {
    // Blobs of 30 points; the fractional parts of k · 0.618… are spread evenly (Weyl, 1916).
    let blob = |k: u32| {
        let spread = move |j: u32| (f64::from(k * 7 + j) * 0.618_034).fract();
        regular_polygon(DVec2::ZERO, 1.0, 30)
            .into_iter()
            .map(move |p| {
                let wave =
                    |j: u32| (f64::from(j) * p.to_angle() + TAU * spread(j)).cos() * spread(9 + j);
                p * (8.0 + (2..6).map(wave).sum::<f64>())
            })
    };
    assert_slow_growth_of_run("designs on a map", |folder, n| {
        let name = |k: u32| format!("blob{k}.json");
        for k in 0..n {
            let ring: Vec<_> = blob(k).map(|p| p.to_array()).collect();
            let text = serde_json::to_string(&ring).expect("numbers");
            fs::write(folder.join(name(k)), text).expect("written");
        }
        let names: Vec<String> = (0..n).map(name).collect();
        format!(
            "render {} --map 4x4 --quality draft --size 200x200 --out map.png",
            names.join(" ")
        )
    });
}
