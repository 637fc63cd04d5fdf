//! Families of designs that grow: holes, pieces, rings in rings, stars, bars.
//! The built program takes no longer for them than the square of their size
//! allows, and less than a gibibyte. All of them with
//! `cargo test --release --test growing`; without `--release` the quick ones.

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use morphospace::DVec2;

/// What a run of the program took.
#[derive(Clone, Copy, Debug)]
struct Cost {
    /// Processor time: what else the machine does is not counted.
    seconds: f64,
    mebibytes: f64,
}

/// Runs the program, and looks at it until it ends.
fn cost(folder: &Path, line: &str) -> Cost {
    let mut child = Command::new(env!("CARGO_BIN_EXE_morphospace"))
        .current_dir(folder)
        .args(line.split_whitespace())
        .stdout(Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut most = Cost {
        seconds: 0.0,
        mebibytes: 0.0,
    };
    loop {
        let ended = child.try_wait().expect("a child");
        if let Some(cost) = cost_so_far(child.id()) {
            most = cost;
        }
        if let Some(status) = ended {
            assert!(status.success(), "{line}: {status}");
            return most;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Processor time and peak memory, from what Linux tells of a process; none
/// once it has ended.
fn cost_so_far(process: u32) -> Option<Cost> {
    let of = |file: &str| fs::read_to_string(format!("/proc/{process}/{file}")).ok();
    let status = of("status")?;
    let peak = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = peak.trim().strip_suffix(" kB")?.parse().ok()?;
    // The name may hold anything but its last parenthesis; ticks are 1/100 s.
    let stat = of("stat")?;
    let fields: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field)?.parse::<f64>().ok();
    Some(Cost {
        seconds: (ticks(11)? + ticks(12)?) / 100.0,
        mebibytes: kibibytes / 1024.0,
    })
}

/// Sizes that grow by twos.
const SIZES: [u32; 4] = [10, 20, 40, 80];

/// How much worse than n² log n a family may grow, and what is too short to
/// be measured.
const SLACK: f64 = 5.0;
const SHORT: f64 = 0.25;

/// A family of designs against a square: time grows no worse than n² log n,
/// and memory stays below a gibibyte.
fn grows_slowly(name: &str, design: impl Fn(u32) -> String) {
    let folder = tempfile::tempdir().expect("a folder");
    let put =
        |name: &str, text: String| fs::write(folder.path().join(name), text).expect("written");
    put("square.json", "[[0,0],[4,0],[4,4],[0,4]]".to_owned());
    let costs = SIZES.map(|n| {
        put("a.json", design(n));
        cost(
            folder.path(),
            "render a.json square.json --at 0.5 --out half.svg",
        )
    });
    let work = |n: u32| f64::from(n).powi(2) * f64::from(n).ln();
    for (small, large) in [(1, 3), (0, 2), (2, 3)] {
        let grown = work(SIZES[large]) / work(SIZES[small]);
        let allowed = SLACK * grown * costs[small].seconds.max(SHORT);
        assert!(
            costs[large].seconds < allowed,
            "{name} of {}: {costs:?}",
            SIZES[large]
        );
    }
    assert!(
        costs.iter().all(|cost| cost.mebibytes < 1024.0),
        "{name}: {costs:?}"
    );
}

/// Rings as a file of polygons holds them.
fn polygons(rings: impl Iterator<Item = Vec<DVec2>>) -> String {
    let ring = |ring: Vec<DVec2>| ring.iter().map(|p| p.to_array()).collect::<Vec<_>>();
    serde_json::to_string(&rings.map(ring).collect::<Vec<_>>()).expect("numbers")
}

fn around(middle: DVec2, radius: f64, points: u32) -> Vec<DVec2> {
    let place =
        |k: u32| middle + radius * DVec2::from_angle(TAU * f64::from(k) / f64::from(points));
    (0..points).map(place).collect()
}

/// So many places in rows of ten.
fn places(count: u32) -> impl Iterator<Item = DVec2> {
    (0..count).map(|k| DVec2::new(f64::from(k % 10) + 0.5, f64::from(k / 10) + 0.5))
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes minutes unless optimised")]
fn many_holes_take_no_more_than_their_square() {
    grows_slowly("holes", |n| {
        let sheet = [(0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)].map(DVec2::from);
        let holes = places(n).map(|p| around(p, 0.3, 6));
        polygons(std::iter::once(sheet.to_vec()).chain(holes))
    });
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes minutes unless optimised")]
fn many_pieces_take_no_more_than_their_square() {
    grows_slowly("pieces", |n| polygons(places(n).map(|p| around(p, 0.3, 6))));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "takes minutes unless optimised")]
fn rings_in_rings_take_no_more_than_their_square() {
    grows_slowly("nested", |n| {
        polygons((1..=n).map(|k| around(DVec2::ZERO, f64::from(k), 6)))
    });
}

#[test]
fn stars_take_no_more_than_the_square_of_their_pieces() {
    // {n/k}: a star of n points has some n² / 4 crossings, so that the sizes
    // here are those of its pieces' roots.
    grows_slowly("stars", |n| {
        let points = (2.0 * f64::from(n).sqrt()) as u32 | 1;
        let step = TAU * f64::from(points / 2) / f64::from(points);
        let star = (0..points).map(|k| DVec2::from_angle(f64::from(k) * step));
        polygons(std::iter::once(star.collect()))
    });
}

#[test]
fn many_bars_take_no_more_than_their_square() {
    grows_slowly("bars", |n| {
        let nodes: Vec<_> = (0..=5 * n).map(|k| [k, k % 2]).collect();
        let bars: Vec<_> = (0..5 * n).map(|k| [k, k + 1]).collect();
        serde_json::json!({ "nodes": nodes, "bars": bars }).to_string()
    });
}
