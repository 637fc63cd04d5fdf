//! Tests of contour tracing: exact shapes, contours along the border of the grid, saddles,
//! orientation, and equal results for any number of CPU threads.

use super::*;
use std::f64::consts::PI;

/// Signed area, positive for a counter-clockwise polygon.
fn area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points
        .iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
}

/// Parses an ASCII picture whose first line is the top row: `#` is 1, anything else −1.
fn picture(text: &str) -> (u32, u32, Vec<f32>) {
    let rows: Vec<&str> = text.split_whitespace().rev().collect();
    let value = |c: char| if c == '#' { 1.0 } else { -1.0 };
    let values = rows.iter().flat_map(|r| r.chars().map(value)).collect();
    (rows[0].len() as u32, rows.len() as u32, values)
}

fn contours(text: &str) -> Vec<Vec<DVec2>> {
    let (width, height, values) = picture(text);
    let samples = SampledField::new(width, height, &values).expect("a rectangular picture");
    trace_samples(&samples, 0.0)
}

#[test]
fn a_disc_has_its_area_and_lies_on_its_circle() {
    let centre = DVec2::new(31.3, 29.8);
    let disc = trace(64, 60, |x, y| 20.0 - DVec2::new(x, y).distance(centre), 0.0);
    assert_eq!(disc.len(), 1);
    for p in &disc[0] {
        assert!((p.distance(centre) - 20.0).abs() < 1e-10, "{p}");
    }
    // The contour is an inscribed polygon. A chord of length c ≤ √2 cuts off about c³ / 12r of the
    // disc, and the sum over all chords is below 0.1 % of its area.
    let exact = PI * 400.0;
    assert!(area(&disc[0]) < exact);
    assert!(area(&disc[0]) > exact * 0.999);
}

#[test]
fn crossings_are_roots_of_the_function_and_not_of_a_chord() {
    // The samples lie at x = 0 and x = 1. The chord between them has its root at 0.2, the function
    // x³ − 0.2 at the cube root of 0.2.
    let traced = trace(2, 1, |x, _| x.powi(3) - 0.2, 0.0);
    let root = 0.2_f64.cbrt();
    assert_eq!(traced.len(), 1);
    let left = traced[0].iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
    assert!((left - root).abs() < 1e-10, "{left} is not {root}");
}

#[test]
fn a_function_that_stalls_regula_falsi_is_still_solved() {
    let f = |x: f64| (x - 0.9).powi(9) - 1e-12;
    let root = root(f);
    assert!((root - 0.9 - 1e-12_f64.powf(1.0 / 9.0)).abs() < 1e-5);
    let jump = super::root(|x| if x < 0.3 { -1.0 } else { 1e-9 });
    assert!((jump - 0.3).abs() < 1e-10);
}

#[test]
fn the_contour_of_a_full_picture_is_its_border() {
    let full = trace(5, 3, |_, _| 1.0, 0.0);
    assert_eq!(full.len(), 1);
    assert_eq!(area(&full[0]), 15.0);
    assert_eq!(full[0].len(), 4, "{full:?}");
}

#[test]
fn an_empty_picture_has_no_contour() {
    assert!(trace(5, 3, |_, _| -1.0, 0.0).is_empty());
    assert!(trace(5, 3, |_, _| f64::NAN, 0.0).is_empty());
    assert!(trace(0, 3, |_, _| 1.0, 0.0).is_empty());
}

#[test]
fn a_shape_at_the_border_is_closed_along_it() {
    // The shape reaches the left, the lower and the upper border of the picture.
    let half = trace(4, 4, |x, _| 1.25 - x, 0.0);
    assert_eq!(half.len(), 1);
    assert!((area(&half[0]) - 1.75 * 4.0).abs() < 1e-9);
}

#[test]
fn holes_run_clockwise_and_islands_counter_clockwise() {
    let traced = contours(
        "
        .........
        .#######.
        .#.....#.
        .#..#..#.
        .#.....#.
        .#######.
        .........",
    );
    let mut areas: Vec<f64> = traced.iter().map(|c| area(c)).collect();
    areas.sort_by(f64::total_cmp);
    // Contours run midway between samples. The outer contour measures 7 × 5 and the hole 5 × 3,
    // each less an eighth of a cell per corner. The island of one sample is a diamond of area ½.
    let expected = [-(5.0 * 3.0 - 4.0 / 8.0), 0.5, 7.0 * 5.0 - 4.0 / 8.0];
    assert_eq!(areas.len(), 3, "{areas:?}");
    for (a, e) in areas.iter().zip(expected) {
        assert!((a - e).abs() < 1e-9, "{areas:?} is not {expected:?}");
    }
}

#[test]
fn saddles_are_resolved_by_the_value_at_the_centre() {
    // A saddle with the value `lift` at its centre. The sign of that value decides whether the two
    // inside corners are joined.
    let saddle = |lift: f64| {
        trace(
            2,
            2,
            move |x, y| (2.0 * x - 1.0) * (2.0 * y - 1.0) + lift,
            0.0,
        )
    };
    assert_eq!(saddle(0.1).len(), 1, "the two corners are joined");
    assert_eq!(saddle(-0.1).len(), 2, "the two corners are apart");
    // The same saddle with its inside corners on the other diagonal.
    let other = |lift: f64| {
        trace(
            2,
            2,
            move |x, y| (1.0 - 2.0 * x) * (2.0 * y - 1.0) + lift,
            0.0,
        )
    };
    assert_eq!(other(0.1).len(), 1);
    assert_eq!(other(-0.1).len(), 2);
}

#[test]
fn the_area_inside_a_random_picture_is_that_of_its_contours() {
    // If every contour closes, the total area of the contours equals the sum of the inside areas of
    // all squares. Test this on random pictures.
    let mut state = 12345_u32;
    let mut bit = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state >> 31 == 1
    };
    for _ in 0..50 {
        let inside: Vec<bool> = (0..11 * 9).map(|_| bit()).collect();
        let values: Vec<f32> = inside.iter().map(|&i| if i { 1.0 } else { -1.0 }).collect();
        let samples = SampledField::new(11, 9, &values).expect("11 × 9");
        let total: f64 = trace_samples(&samples, 0.0).iter().map(|c| area(c)).sum();
        assert!((total - area_by_squares(&samples)).abs() < 1e-9);
    }
}

/// Oracle: inside area of a picture of samples ±1, summed square by square. The area in a square
/// follows from its corners and, for a saddle, from its centre.
fn area_by_squares(samples: &SampledField) -> f64 {
    let (w, h) = (f64::from(samples.width()), f64::from(samples.height()));
    let axis = |count: f64| {
        let mut at: Vec<f64> = (0..count as u32).map(f64::from).collect();
        at.insert(0, -0.5);
        at.push(count - 0.5);
        at
    };
    let (xs, ys) = (axis(w), axis(h));
    let mut total = 0.0;
    for y in ys.windows(2) {
        for x in xs.windows(2) {
            let corner = |i: usize, j: usize| samples.bilinear(x[i], y[j]) >= 0.0;
            let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let centre = samples.bilinear(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])) >= 0.0;
            let fraction = match corners.iter().filter(|&&c| c).count() {
                0 => 0.0,
                1 => 0.125,
                2 if corners[0] != corners[2] => 0.5,
                2 if centre => 0.75,
                2 => 0.25,
                3 => 0.875,
                _ => 1.0,
            };
            total += fraction * (x[1] - x[0]) * (y[1] - y[0]);
        }
    }
    total
}

#[test]
fn a_level_shifts_the_contour() {
    let cone = |level: f64| {
        let traced = trace(41, 41, |x, y| 15.0 - (x - 20.0).hypot(y - 20.0), level);
        area(&traced[0])
    };
    for (level, radius) in [(5.0, 10.0), (-3.0, 18.0)] {
        let exact = PI * radius * radius;
        assert!((cone(level) / exact - 1.0).abs() < 2e-3);
    }
}

#[test]
fn one_thread_and_many_give_equal_results() -> Result<(), rayon::ThreadPoolBuildError> {
    let waves = |x: f64, y: f64| (0.7 * x).sin() + (0.5 * y).cos() - 0.2;
    let traced_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?;
        Ok::<_, rayon::ThreadPoolBuildError>(pool.install(|| trace(50, 40, waves, 0.0)))
    };
    let one = traced_on(1)?;
    assert!(one.len() > 5);
    assert_eq!(one, traced_on(4)?);
    Ok(())
}
