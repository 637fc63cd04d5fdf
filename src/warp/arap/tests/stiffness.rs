//! Tests of the weights of faces, of bars and thin bridges, and of parts that exist in only one
//! design.

use super::*;

#[test]
fn weights_are_validated() {
    let mesh = bent_pair();
    for bad in [vec![1.0; 3], vec![0.0; 24], vec![f64::NAN; 24]] {
        let options = ArapOptions {
            weights: FaceWeights::PerFace(bad),
            ..ArapOptions::default()
        };
        let error = Arap::build(&mesh, &options, &Silent).unwrap_err();
        assert!(
            matches!(error, ArapError::Weights { faces: 24, .. }),
            "{error}"
        );
    }
    let uniform = |weights| {
        let options = ArapOptions {
            weights,
            subdivisions: 1,
            ..ArapOptions::default()
        };
        motion(&mesh, &options)(0.5)
    };
    let difference = largest_distance(
        &uniform(FaceWeights::PerFace(vec![7.0; 24])),
        &uniform(FaceWeights::Uniform),
    );
    assert!(difference < 1e-12);
}

#[test]
fn a_heavier_face_follows_its_local_map_more_closely() {
    let mesh = bent_pair();
    let error_of = |face: usize, weight: f64| {
        let mut weights = vec![1.0; 24];
        weights[face] = weight;
        let options = ArapOptions {
            weights: FaceWeights::PerFace(weights),
            ..ArapOptions::default()
        };
        let arap = Arap::build(&mesh, &options, &Silent).unwrap();
        let expected = Homotopy::Polar.at(&arap.0.maps.faces[face].map, 0.5);
        let v = motion(&mesh, &options)(0.5);
        let edges = |points: &[DVec2]| {
            let [a, b, c] = mesh.faces()[face].map(|i| points[i as usize]);
            DMat2::from_cols(b - a, c - a)
        };
        let gap = edges(&v) * edges(mesh.source()).inverse() - expected;
        gap.x_axis.length() + gap.y_axis.length()
    };
    assert!(error_of(9, 100.0) < 0.5 * error_of(9, 1.0));
}

/// Returns two triangles of the same size, connected by a bar of the given length.
fn triangles_with_bar(length: f64) -> CompatibleMesh {
    let corners = |x: f64| [(x, 0.0), (x + 1.0, 0.0), (x, 1.0)].map(DVec2::from);
    let source = [corners(0.0), corners(length)].concat();
    let faces = vec![[0, 1, 2], [3, 4, 5]];
    CompatibleMesh::new(faces, source.clone(), source, vec![[0, 3]]).unwrap()
}

#[test]
fn a_ridge_is_reported() {
    let options = ArapOptions {
        weights: FaceWeights::Uniform,
        ..ArapOptions::default()
    };
    let ridge = |mesh| Arap::build(&mesh, &options, &Silent).unwrap().ridge();
    assert_eq!(ridge(bent_pair()), None);
    assert_eq!(ridge(triangles_with_bar(10.0)), None);
    // The bar is so long that rounding loses its stiffness next to the stiffness of the triangle.
    let (share, vertex) = (1e-13, 3);
    assert_eq!(
        ridge(triangles_with_bar(1e10)),
        Some(Ridge { share, vertex })
    );
}

#[test]
fn a_transient_part_waits_and_moves_with_the_whole() {
    // The second strip is tiny in the source and grows in the last quarter.
    let turn = DMat2::from_angle(1.0);
    let whole = parts(|p| turn * p);
    let components = whole.components();
    let (transient, middle) = (components[8], DVec2::new(6.0, 2.5));
    let vertices = || whole.source().iter().zip(&components);
    let small = |(&p, &part): (&DVec2, &u32)| match part == transient {
        true => middle + (p - middle) * 1e-4,
        false => p,
    };
    let moved = |(&p, &part): (&DVec2, &u32)| match part == transient {
        true => p + DVec2::X,
        false => turn * p,
    };
    let source = vertices().map(small).collect();
    let target = vertices().map(moved).collect();
    let faces = whole.faces().to_vec();
    let mesh = CompatibleMesh::new(faces, source, target, whole.elements().to_vec()).unwrap();
    let late = TimeWindow {
        from: 0.75,
        ..TimeWindow::whole(Side::Target)
    };
    let time_windows = [None, Some(late)];
    let arap = Arap::of_outlines(&mesh, &ArapOptions::default(), &time_windows, &Silent).unwrap();
    let back = arap.swapped(&Silent).unwrap();
    let at = |arap: &Arap, t: f64| {
        let mut placer = arap.placer();
        placer.place(t);
        placer.placement().in_frame.clone()
    };
    assert_eq!(at(&arap, 0.0), mesh.source());
    assert_eq!(at(&arap, 1.0), mesh.target());
    let length = |positions: &[DVec2]| positions[8].distance(positions[12]);
    assert!(length(&at(&arap, 0.75)) < 3e-4);
    // The part has half its size after a third of its time window.
    assert!((length(&at(&arap, 5.0 / 6.0)) - 1.0).abs() < 1e-3);
    // Before its time window, the part rotates with the other parts about their common centroid.
    let from_first_part = |positions: &[DVec2]| positions[8].distance(positions[0]);
    let waiting = from_first_part(&at(&arap, 0.5));
    assert!((waiting - from_first_part(mesh.source())).abs() < 1e-3);
    for t in TIMES {
        assert!(largest_distance(&at(&arap, t), &at(&back, 1.0 - t)) < 1e-9);
    }
}

#[test]
fn nearly_degenerate_faces_keep_their_stiffness() {
    // A fan of faces over a nearly straight polyline, whose curvature in the source is close to
    // rounding.
    let along = DVec2::new(0.31, 0.17);
    let fan = |bend: f64| -> Vec<DVec2> {
        let at = |i: u32| along * f64::from(i) - along.perp() * (bend * f64::from(i * (8 - i)));
        (0..=8).map(|i| DVec2::new(12.0, 22.0) + at(i)).collect()
    };
    let faces = (1..8).map(|i| [0, i, i + 1]).collect();
    let mesh = CompatibleMesh::new(faces, fan(1e-13), fan(0.1), vec![]).unwrap();
    let arap = Arap::build(&mesh, &ArapOptions::default(), &Silent).unwrap();
    assert_eq!(arap.ridge(), None);
    // Expected diagonal entry of the middle vertex: the sum over its faces of ½ (A |∇φ_A|² + B
    // |∇φ_B|²). A and B are the areas of a face in source and target, and φ_A and φ_B are the hat
    // functions of the vertex.
    let expected: f64 = [mesh.source(), mesh.target()]
        .iter()
        .flat_map(|at| {
            mesh.faces()
                .iter()
                .map(move |f| f.map(|v| (v, at[v as usize])))
        })
        .filter_map(|corners| {
            let k = corners.iter().position(|(v, _)| *v == 4)?;
            let [(_, a), (_, b), (_, c)] = [0, 1, 2].map(|i| corners[(k + i) % 3]);
            Some(0.25 * b.distance_squared(c) / twice_signed_area(a, b, c))
        })
        .sum();
    let system = arap.system();
    let at = system.entries().filter(|(i, j, _)| (*i, *j) == (4, 4));
    let diagonal: f64 = at.map(|(_, _, value)| value).sum();
    // Rounding leaves three correct digits in the areas of the nearly degenerate faces.
    assert!(
        (diagonal / expected - 1.0).abs() < 0.01,
        "{diagonal} {expected}"
    );
}
