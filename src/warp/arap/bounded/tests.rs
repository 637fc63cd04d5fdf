//! Tests motions with bounded distortion.

use super::super::assembly::LocalMaps;
use super::super::evaluation_times::EvaluationTimes;
use super::Bounded;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2, PolarDecomposition, SymmetricEigen, orient2d};
use crate::warp::homotopy::Homotopy;
use crate::warp::{Arap, ArapOptions, Warp};
use crate::work::progress::Silent;
use std::f64::consts::TAU;

const N: u32 = 12;

/// Returns a mesh whose source is a square plate of N × N cells about the origin, with side length
/// 2, and whose target is the image of the plate under `image`.
fn plate(image: impl Fn(DVec2) -> DVec2) -> CompatibleMesh {
    let point =
        |i: u32, j: u32| DVec2::new(f64::from(i), f64::from(j)) * (2.0 / f64::from(N)) - 1.0;
    let source: Vec<DVec2> = (0..=N)
        .flat_map(|j| (0..=N).map(move |i| point(i, j)))
        .collect();
    let squares = (0..N).flat_map(|j| (0..N).map(move |i| j * (N + 1) + i));
    let faces = squares.flat_map(|a| {
        let [b, c, d] = [a + 1, a + N + 2, a + N + 1];
        // Diagonals alternate, so that no direction is preferred.
        match (a / (N + 1) + a % (N + 1)) % 2 {
            0 => [[a, b, c], [a, c, d]],
            _ => [[a, b, d], [b, c, d]],
        }
    });
    let target = source.iter().map(|&p| image(p)).collect();
    CompatibleMesh::new(faces.collect(), source, target, vec![]).expect("positive")
}

/// Returns a mesh whose source is an annulus about the origin, divided into rows of triangles, and
/// whose target is the image of the annulus under `image`.
fn ring(image: impl Fn(DVec2) -> DVec2) -> CompatibleMesh {
    const AROUND: u32 = 48;
    const ROWS: u32 = 6;
    let point = |row: u32, k: u32| {
        let angle = TAU * (f64::from(k) + 0.5 * f64::from(row)) / f64::from(AROUND);
        DVec2::from_angle(angle) * (0.4 + 0.6 * f64::from(row) / f64::from(ROWS))
    };
    let rows = (0..=ROWS).flat_map(|row| (0..AROUND).map(move |k| point(row, k)));
    let source: Vec<DVec2> = rows.collect();
    let faces = (0..ROWS).flat_map(|row| {
        (0..AROUND).flat_map(move |k| {
            let at = |row: u32, k: u32| row * AROUND + k % AROUND;
            let [a, b, c, d] = [
                at(row, k),
                at(row, k + 1),
                at(row + 1, k),
                at(row + 1, k + 1),
            ];
            [[a, c, b], [c, d, b]]
        })
    });
    let target = source.iter().map(|&p| image(p)).collect();
    CompatibleMesh::new(faces.collect(), source, target, vec![]).expect("positive")
}

fn bounded(mesh: &CompatibleMesh) -> Arap {
    let options = ArapOptions {
        homotopy: Homotopy::Bounded,
        ..ArapOptions::default()
    };
    Arap::build(mesh, &options, &Silent).expect("a film")
}

/// Returns the largest distortion of a face between the source and the positions `places`.
fn sheared(mesh: &CompatibleMesh, places: &[DVec2]) -> f64 {
    let sheared = mesh.faces().iter().map(|face| {
        let [p, q] = [mesh.source(), places].map(|points| {
            let [a, b, c] = face.map(|v| points[v as usize]);
            DMat2::from_cols(b - a, c - a)
        });
        let [large, small] =
            SymmetricEigen::of(PolarDecomposition::of(q * p.inverse()).stretch).values;
        large / small
    });
    sheared.fold(0.0, f64::max)
}

/// Returns the largest distortion of a face during the motion, divided by the largest distortion in
/// the target.
fn by_end(mesh: &CompatibleMesh, film: &Arap) -> f64 {
    let mut placer = film.placer();
    let worst = (0..=32).map(|step| {
        placer.place(f64::from(step) / 32.0);
        sheared(mesh, &placer.placement().in_frame)
    });
    worst.fold(0.0, f64::max) / sheared(mesh, mesh.target())
}

/// Stretches and bends the plane near the origin.
fn stretched(p: DVec2) -> DVec2 {
    let bump = (-3.0 * p.length_squared()).exp();
    DVec2::new(
        p.x + 0.9 * bump * p.x,
        p.y - 0.5 * bump * p.y + 0.2 * p.x * p.x,
    )
}

#[test]
fn a_disc_keeps_the_bound() {
    let mesh = plate(stretched);
    let film = bounded(&mesh);
    assert_eq!(film.unflattened_count(), 0);
    let found = by_end(&mesh, &film);
    assert!(found <= 1.0 + 1e-9, "{found}");
}

#[test]
fn it_is_the_conformal_image_of_the_metric_between() {
    let mesh = plate(stretched);
    let film = bounded(&mesh);
    let mut placer = film.placer();
    let connectivity = mesh.connectivity();
    for t in [0.2, 0.5, 0.9] {
        placer.place(t);
        let places = &placer.placement().in_frame;
        let length =
            |points: &[DVec2], a: u32, b: u32| points[a as usize].distance(points[b as usize]);
        let of_metric = |a: u32, b: u32| {
            let [p, q] = [mesh.source(), mesh.target()].map(|points| length(points, a, b).powi(2));
            ((1.0 - t) * p + t * q).sqrt()
        };
        for (face, corners) in mesh.faces().iter().enumerate() {
            for k in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|step| corners[(k + step) % 3]);
                match connectivity.twin(face, k) {
                    // A boundary edge has the length that follows from its linearly interpolated
                    // squared length.
                    None => {
                        let ratio = length(places, a, b) / of_metric(a, b);
                        assert!((ratio - 1.0).abs() < 1e-9, "{t}: {ratio}");
                    }
                    // Conformal equivalence preserves the cross-ratios of lengths.
                    Some(twin) => {
                        let d = mesh.faces()[twin as usize / 3][(twin as usize + 2) % 3];
                        let ratio =
                            |l: &dyn Fn(u32, u32) -> f64| l(a, d) * l(b, c) / (l(d, b) * l(c, a));
                        let now = ratio(&|a, b| length(places, a, b));
                        let metric = ratio(&of_metric);
                        assert!((now / metric - 1.0).abs() < 1e-9, "{t}: {now} {metric}");
                    }
                }
            }
        }
    }
}

#[test]
fn angles_around_a_hole_close() {
    // Half of the ring grows while the ring rotates.
    let mesh = ring(|p| {
        DMat2::from_angle(2.5) * p * (1.0 + 0.4 * p.x) * 1.1 + DVec2::new(0.0, 0.1 * p.x * p.x)
    });
    let film = bounded(&mesh);
    assert_eq!(film.unflattened_count(), 0);
    // The swapped motion is the same in reverse.
    let back = film.swapped(&Silent).expect("a film");
    for (mesh, film) in [(&mesh, &film), (back.mesh(), &back)] {
        let found = by_end(mesh, film);
        assert!(found < 1.011, "{found}");
    }
    let [mut there, mut here] = [&film, &back].map(Arap::placer);
    there.place(0.3);
    here.place(0.7);
    let places = [&there, &here].map(|placer| &placer.placement().in_frame);
    for (p, q) in places[0].iter().zip(places[1]) {
        assert!(p.distance(*q) < 1e-9, "{p} {q}");
    }
    let mut placer = film.placer();
    placer.place(0.5);
    let places = &placer.placement().in_frame;
    let is_positive = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| places[v as usize]);
        orient2d(a, b, c) > 0.0
    };
    assert!(mesh.faces().iter().all(is_positive));
}

#[test]
fn a_needle_keeps_the_bound() {
    // A vertex is moved close to the opposite side of one of its faces, which becomes a needle.
    let even = ring(|p| p);
    let (inner, next) = (12, 13);
    let near = |points: &[DVec2], share: f64| {
        let mut points = points.to_vec();
        let [a, b] = [inner, next].map(|v| points[v]);
        points[inner + 48] = a.lerp(b, 0.5) * (1.0 + share);
        points
    };
    let bent: Vec<DVec2> = even.source().iter().map(|&p| stretched(p)).collect();
    let [source, target] = [near(even.source(), 2e-2), near(&bent, 2e-4)];
    let mesh = CompatibleMesh::new(even.faces().to_vec(), source, target, vec![]);
    let mesh = mesh.expect("positive");
    let found = by_end(&mesh, &bounded(&mesh));
    assert!(found <= 1.02, "{found}");
}

#[test]
fn a_sheet_that_is_not_flat_takes_each_metric_by_itself() {
    let mesh = plate(stretched);
    let maps = LocalMaps::new(&mesh, &ArapOptions::default(), &[]).expect("maps");
    let mut bounded = Bounded::new(&mesh, &maps);
    bounded.sheets[0].is_flat = false;
    assert_eq!(bounded.unflattened(), 1);
    let mut found = vec![DVec2::ZERO; mesh.source().len()];
    let mut expected = found.clone();
    bounded.add(
        EvaluationTimes::Uniform(0.3),
        &mut bounded.memory(),
        &mut found,
    );
    for (face, of) in mesh.faces().iter().zip(&maps.faces) {
        let pulled = Homotopy::Bounded.at(&of.map, 0.3) * of.weighted;
        expected[face[1] as usize] += pulled.x_axis;
        expected[face[2] as usize] += pulled.y_axis;
        expected[face[0] as usize] -= pulled.x_axis + pulled.y_axis;
    }
    for (a, b) in found.iter().zip(&expected) {
        assert!(a.distance(*b) < 1e-12, "{a} {b}");
    }
}

#[test]
fn whole_turns_are_kept() {
    let mesh = plate(|p| DMat2::from_angle(0.4 * p.x) * stretched(p));
    let options = ArapOptions {
        homotopy: Homotopy::Bounded,
        extra_turns: vec![2],
        ..ArapOptions::default()
    };
    let film = Arap::build(&mesh, &options, &Silent).expect("a film");
    let mut placer = film.placer();
    let (mut turned, mut before) = (0.0, 0.0);
    // The vertices at the left and right end of the plate's middle row.
    let ends = [N / 2 * (N + 1), N / 2 * (N + 1) + N].map(|v| v as usize);
    for step in 0..=64 {
        placer.place(f64::from(step) / 64.0);
        let places = &placer.placement().in_frame;
        let angle = (places[ends[1]] - places[ends[0]]).to_angle();
        let by: f64 = angle - before;
        turned += by - TAU * (by / TAU).round();
        before = angle;
    }
    assert!((turned - 2.0 * TAU).abs() < 1.0, "{turned}");
}
