//! Tests of the distance transforms: brute force as oracle, limits, threads and cancellation.

use super::super::testing::mask;
use super::*;
use crate::work::progress::Silent;
use proptest::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Every metric, for tests that compare all of them with the oracle.
const METRICS: [Metric; 4] = [
    Metric::Euclidean,
    Metric::CityBlock,
    Metric::Chessboard,
    Metric::QuasiEuclidean,
];

/// Distance between two cells that are `dx` columns and `dy` rows apart, by the definition of
/// `metric`.
fn distance(metric: Metric, dx: f64, dy: f64) -> f64 {
    let (max, min) = (dx.max(dy), dx.min(dy));
    match metric {
        Metric::Euclidean => (dx * dx + dy * dy).sqrt(),
        Metric::CityBlock => dx + dy,
        Metric::Chessboard => max,
        Metric::QuasiEuclidean => max + (SQRT_2 - 1.0) * min,
    }
}

/// Oracle: signed distance of each cell, found by a search for the nearest cell on the other side
/// of the boundary. Searches all cells of the mask and a border of outside cells around it.
fn brute_force(mask: &Mask, metric: Metric) -> Vec<f64> {
    let (width, height) = (i64::from(mask.width()), i64::from(mask.height()));
    let inside = |x: i64, y: i64| {
        let in_picture = (0..width).contains(&x) && (0..height).contains(&y);
        in_picture && mask.bits()[(y * width + x) as usize]
    };
    let all = || (-1..=height).flat_map(|y| (-1..=width).map(move |x| (x, y)));
    let nearest = |x: i64, y: i64| {
        let ring = |p: i64, count: i64| p < 0 || p >= count;
        all()
            // The border counts as outside, so outside cells skip it.
            .filter(|&(i, j)| inside(i, j) != inside(x, y))
            .filter(|&(i, j)| inside(x, y) || !(ring(i, width) || ring(j, height)))
            .map(|(i, j)| distance(metric, (i - x).abs() as f64, (j - y).abs() as f64))
            .fold(f64::INFINITY, f64::min)
    };
    let signed = |x: i64, y: i64| {
        let d = nearest(x, y) - 0.5;
        if inside(x, y) { d } else { -d }
    };
    (0..height)
        .flat_map(|y| (0..width).map(move |x| signed(x, y)))
        .collect()
}

/// Asserts that the distances `values` equal those of the oracle.
fn check(mask: &Mask, metric: Metric, values: &[f32]) {
    let expected = brute_force(mask, metric);
    assert_eq!(values.len(), expected.len());
    for (i, (&f, &e)) in values.iter().zip(&expected).enumerate() {
        // Sums of multiples of √2 are rounded differently by the oracle; all other distances are
        // exact.
        let near = match metric {
            Metric::QuasiEuclidean => (f64::from(f) - e).abs() <= 1e-6 * e.abs(),
            _ => f == e as f32,
        };
        assert!(near, "{metric:?}: cell {i} is {f}, should be {e}");
    }
}

fn transform(mask: &Mask, metric: Metric) -> Vec<f32> {
    distance_transform(mask, metric, &Silent).expect("never cancelled")
}

/// Strategy for random masks of at most `side` × `side` cells, of which 2 % to 98 % are inside.
fn masks(side: u32) -> impl Strategy<Value = Mask> {
    (1..=side, 1..=side, 0.02..0.98_f64).prop_flat_map(|(width, height, inside_fraction)| {
        let cells = (width * height) as usize;
        (
            proptest::collection::vec(proptest::bool::weighted(inside_fraction), cells),
            0..cells,
        )
            .prop_map(move |(mut bits, inside_cell)| {
                bits[inside_cell] = true;
                Mask::new(width, height, bits).expect("a legal mask")
            })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn every_metric_equals_brute_force(mask in masks(20)) {
        for metric in METRICS {
            check(&mask, metric, &transform(&mask, metric));
        }
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn a_few_cells_in_a_large_picture_equal_brute_force(
        seeds in proptest::collection::vec((0..44_u32, 0..33_u32), 1..5),
        invert in proptest::bool::ANY,
    ) {
        let mut bits = vec![invert; 44 * 33];
        for (x, y) in seeds {
            bits[(y * 44 + x) as usize] = !invert;
        }
        let mask = Mask::new(44, 33, bits).expect("a legal mask");
        for metric in METRICS {
            check(&mask, metric, &transform(&mask, metric));
        }
    }
}

#[test]
fn a_small_figure_has_the_distances_counted_by_hand() {
    let figure = mask(
        "
        .......
        .####..
        .####..
        .####..
        .......",
    );
    // Distances from the lowest row up, doubled so that halves become integers.
    let doubled = |metric| -> Vec<i32> {
        let values = transform(&figure, metric);
        values.iter().map(|v| (2.0 * v) as i32).collect()
    };
    #[rustfmt::skip]
    assert_eq!(doubled(Metric::CityBlock), [
        -3, -1, -1, -1, -1, -3, -5,
        -1,  1,  1,  1,  1, -1, -3,
        -1,  1,  3,  3,  1, -1, -3,
        -1,  1,  1,  1,  1, -1, -3,
        -3, -1, -1, -1, -1, -3, -5,
    ]);
    #[rustfmt::skip]
    assert_eq!(doubled(Metric::Chessboard), [
        -1, -1, -1, -1, -1, -1, -3,
        -1,  1,  1,  1,  1, -1, -3,
        -1,  1,  3,  3,  1, -1, -3,
        -1,  1,  1,  1,  1, -1, -3,
        -1, -1, -1, -1, -1, -1, -3,
    ]);
    let corner = |metric: Metric| transform(&figure, metric)[0];
    assert_eq!(corner(Metric::Euclidean), -(SQRT_2 - 0.5) as f32);
    assert_eq!(corner(Metric::QuasiEuclidean), -(SQRT_2 - 0.5) as f32);
}

#[test]
fn a_full_mask_has_its_boundary_at_the_border() {
    let full = Mask::new(7, 5, vec![true; 35]).expect("a legal mask");
    for metric in METRICS {
        let values = transform(&full, metric);
        check(&full, metric, &values);
        assert_eq!(values[0], 0.5);
        assert_eq!(values[2 * 7 + 3], 2.5, "the middle");
    }
}

#[test]
fn a_full_mask_is_the_limit_of_one_with_a_hole() {
    let full = Mask::new(40, 40, vec![true; 1600]).expect("a legal mask");
    let mut bits = vec![true; 1600];
    bits[0] = false;
    let pierced = Mask::new(40, 40, bits).expect("a legal mask");
    for metric in METRICS {
        let (a, b) = (transform(&full, metric), transform(&pierced, metric));
        let max_change = a
            .iter()
            .zip(&b)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max);
        assert!(max_change <= 1.0, "{metric:?}: {max_change}");
    }
}

#[test]
fn the_largest_sides_do_not_overflow() {
    let side = super::super::Grid::MAX_SIDE;
    for (width, height) in [(side, 2), (2, side)] {
        let mut bits = vec![false; 2 * side as usize];
        bits[0] = true;
        let mask = Mask::new(width, height, bits).expect("a legal mask");
        let last = *transform(&mask, Metric::Euclidean).last().expect("cells");
        let long = f64::from(side - 1);
        assert_eq!(last, -((long * long + 1.0).sqrt() - 0.5) as f32);
    }
}

#[test]
fn swapping_the_sides_swaps_the_signs_away_from_the_border() {
    let mut bits = vec![false; 32 * 32];
    for y in 0..32_usize {
        for x in 0..32_usize {
            bits[y * 32 + x] = (x * 7 + y * 13) % 11 < 5;
        }
    }
    let swapped = bits.iter().map(|b| !b).collect();
    let mask = Mask::new(32, 32, bits).expect("a legal mask");
    let swapped = Mask::new(32, 32, swapped).expect("a legal mask");
    for metric in METRICS {
        let (a, b) = (transform(&mask, metric), transform(&swapped, metric));
        for y in 8..24 {
            for x in 8..24 {
                assert_eq!(a[y * 32 + x], -b[y * 32 + x]);
            }
        }
    }
}

#[test]
fn one_thread_and_many_give_equal_results() -> Result<(), rayon::ThreadPoolBuildError> {
    let bits = (0..300 * 200_u32).map(|i| i.wrapping_mul(2_654_435_761) > 3_900_000_000);
    let mask = Mask::new(300, 200, bits.collect()).expect("a legal mask");
    let transform_on = |threads: usize| {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let pool = builder.build()?;
        let values = pool.install(|| transform(&mask, Metric::Euclidean));
        Ok::<_, rayon::ThreadPoolBuildError>(values)
    };
    assert_eq!(transform_on(1)?, transform_on(3)?);
    Ok(())
}

/// Progress that is cancelled after the given number of reports, which it counts down.
struct CancelAfter(AtomicUsize);

impl Progress for CancelAfter {
    fn report(&self, _stage: &'static str, fraction: f64) {
        assert!((0.0..=1.0).contains(&fraction));
        let reports_left = self.0.load(Ordering::Relaxed);
        self.0
            .store(reports_left.saturating_sub(1), Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

#[test]
fn every_metric_can_be_cancelled_midway() {
    let mask = Mask::new(200, 300, vec![true; 200 * 300]).expect("a legal mask");
    for metric in METRICS {
        for reports in [1, 3] {
            let progress = CancelAfter(AtomicUsize::new(reports));
            let result = distance_transform(&mask, metric, &progress);
            assert_eq!(result, Err(Cancelled), "{metric:?} after {reports}");
        }
    }
}

#[test]
fn metrics_are_written_as_words() -> Result<(), serde_json::Error> {
    let words = METRICS.map(|m| serde_json::to_string(&m).expect("a word"));
    let expected = ["euclidean", "city-block", "chessboard", "quasi-euclidean"];
    assert_eq!(words, expected.map(|w| format!("\"{w}\"")));
    let back: Metric = serde_json::from_str("\"quasi-euclidean\"")?;
    assert_eq!(back, Metric::QuasiEuclidean);
    Ok(())
}
