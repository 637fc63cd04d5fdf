//! Tests of distance fields: brute force as oracle, units, signs, refused input and cancellation.

use super::*;
use crate::geometry::FillRule;
use crate::work::progress::Silent;
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Oracle: for each sample, the minimum distance to all edges in cells, positive if the sample is
/// inside.
fn brute_force(regions: &Regions, grid: &Grid) -> Vec<f64> {
    let to_edge = |p: DVec2, (a, b): (DVec2, DVec2)| {
        let s = (p - a).dot(b - a) / (b - a).length_squared();
        p.distance(a.lerp(b, s.clamp(0.0, 1.0))) / grid.cell
    };
    let signed = |x, y| {
        let p = grid.centre(x, y);
        let edges = regions.rings().flat_map(|ring| ring.edges());
        let d = edges.map(|e| to_edge(p, e)).fold(f64::INFINITY, f64::min);
        if regions.contains(p) { d } else { -d }
    };
    (0..grid.height)
        .flat_map(|y| (0..grid.width).map(move |x| signed(x, y)))
        .collect()
}

fn assert_near(field: &DistanceField, expected: &[f64]) {
    let width = field.grid().width as usize;
    for (i, (&f, &e)) in field.values().iter().zip(expected).enumerate() {
        let (x, y) = (i % width, i / width);
        let error = (f64::from(f) - e).abs();
        assert!(error < 1e-5 * (1.0 + e.abs()), "({x}, {y}): {f}, not {e}");
    }
}

fn exact(regions: &Regions, grid: Grid) -> DistanceField {
    DistanceField::from_regions(regions, grid, &Silent).expect("a field")
}

fn ring(count: u32, radius: impl Fn(f64) -> f64, centre: DVec2) -> Vec<DVec2> {
    (0..count)
        .map(|i| f64::from(i) * TAU / f64::from(count))
        .map(|angle| centre + radius(angle) * DVec2::from_angle(angle))
        .collect()
}

fn regions(rings: &[Vec<DVec2>]) -> Regions {
    Regions::from_rings(rings, FillRule::EvenOdd).expect("an area")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn random_polygons_equal_brute_force(
        points in proptest::collection::vec((-1.0..9.0_f64, -1.0..7.0_f64), 3..12),
        width in 1..40_u32,
        height in 1..40_u32,
    ) {
        let points = points.into_iter().map(DVec2::from).collect();
        let Ok(shape) = Regions::from_rings(&[points], FillRule::EvenOdd) else {
            return Ok(()); // all points on one line
        };
        let grid = Grid::new(width, height, DVec2::new(0.01, 0.02), 0.2371).expect("a grid");
        assert_near(&exact(&shape, grid), &brute_force(&shape, &grid));
    }
}

#[test]
fn a_star_with_a_hole_and_many_edges_equals_brute_force() {
    let wavy = |angle: f64| 10.0 + 2.0 * (9.0 * angle).sin();
    let star = regions(&[
        ring(600, wavy, DVec2::new(3.0, -2.0)),
        ring(90, |_| 4.0, DVec2::new(2.0, -1.0)),
    ]);
    let grid = Grid::covering(&star.bounds(), 101, 0.2).expect("a grid");
    let field = exact(&star, grid);
    assert_near(&field, &brute_force(&star, &grid));
    assert!(
        field.value(DVec2::new(2.0, -1.0)) < 0.0,
        "the hole is outside"
    );
}

#[test]
fn the_centre_of_a_circle_keeps_all_its_edges_as_candidates() {
    let circle = regions(&[ring(500, |_| 20.0, DVec2::ZERO)]);
    let grid = Grid::new(64, 64, DVec2::splat(-32.0), 1.0).expect("a grid");
    assert_near(&exact(&circle, grid), &brute_force(&circle, &grid));
}

#[test]
fn distances_are_in_cells_of_the_grid() {
    let square = regions(&[[(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)]
        .map(DVec2::from)
        .to_vec()]);
    for cells in [32, 64, 128] {
        let grid = Grid::covering(&square.bounds(), cells, 0.5).expect("a grid");
        let field = exact(&square, grid);
        let depth = field.value(DVec2::new(4.0, 1.0));
        assert!((depth - f64::from(cells) / 16.0).abs() < 1e-5);
    }
}

#[test]
fn a_sample_on_the_boundary_is_a_positive_zero() {
    let square = regions(&[[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]
        .map(DVec2::from)
        .to_vec()]);
    let grid = Grid::new(5, 5, DVec2::splat(-0.5), 1.0).expect("a grid");
    let field = exact(&square, grid);
    assert_eq!(field.values()[0], 0.0);
    assert!(field.values().iter().all(|v| v.is_sign_positive()));
}

#[test]
fn the_staircase_is_within_a_cell_of_the_polygon() {
    let wavy = ring(200, |angle| 9.0 + (5.0 * angle).cos(), DVec2::ZERO);
    let shape = regions(&[wavy]);
    let grid = Grid::covering(&shape.bounds(), 80, 0.2).expect("a grid");
    let field = exact(&shape, grid);
    let stairs = DistanceField::from_raster(&shape, grid, Metric::Euclidean, &Silent);
    let stairs = stairs.expect("a field");
    for (a, b) in field.values().iter().zip(stairs.values()) {
        assert!((a - b).abs() <= 1.0, "{a} and {b}");
        assert!(*a == 0.0 || (*a > 0.0) == (*b > 0.0), "{a} and {b}");
    }
}

#[test]
fn hostile_values_and_sizes_are_refused() {
    let grid = Grid::new(2, 2, DVec2::ZERO, 1.0).expect("a grid");
    assert!(matches!(
        DistanceField::new(grid, vec![0.0; 3]),
        Err(FieldError::Length(SampledFieldError { values: 3, .. }))
    ));
    assert_eq!(
        DistanceField::new(grid, vec![0.0, 1.0, f32::NAN, 0.0]),
        Err(FieldError::NotFinite { x: 0, y: 1 })
    );
    let spoiled = Grid { cell: 0.0, ..grid };
    assert!(matches!(
        DistanceField::new(spoiled, vec![0.0; 4]),
        Err(FieldError::Grid(_))
    ));
    let mask = Mask::new(1, 4, vec![true; 4]).expect("a mask");
    assert!(DistanceField::from_mask(&mask, grid, Metric::Chessboard, &Silent).is_err());
    let shape = regions(&[ring(5, |_| 1.0, DVec2::splat(9.0))]);
    let vast = Grid {
        width: u32::MAX,
        ..grid
    };
    assert!(DistanceField::from_regions(&shape, vast, &Silent).is_err());
    assert!(DistanceField::from_raster(&shape, vast, Metric::Euclidean, &Silent).is_err());
    let far = DistanceField::from_regions(&shape, grid, &Silent).expect("a field");
    assert!(
        far.values().iter().all(|&v| v < -9.0),
        "all outside is legal"
    );
}

#[test]
fn a_polygon_field_can_be_cancelled() {
    struct CancelledFieldProgress;
    impl Progress for CancelledFieldProgress {
        fn report(&self, _stage: &'static str, _fraction: f64) {}
        fn is_cancelled(&self) -> bool {
            true
        }
    }
    let shape = regions(&[ring(5, |_| 1.0, DVec2::ZERO)]);
    let grid = Grid::covering(&shape.bounds(), 32, 0.1).expect("a grid");
    assert_eq!(
        DistanceField::from_regions(&shape, grid, &CancelledFieldProgress),
        Err(FieldError::Cancelled(Cancelled))
    );
}
