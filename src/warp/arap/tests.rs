//! Tests of the rigidity-preserving interpolation: exact identities and comparison with the
//! definition of the energy.
#![expect(clippy::unwrap_used, reason = "tests")]

mod stiffness;

use super::*;
use crate::geometry::{DMat2, PolarDecomposition, Side, twice_signed_area};
use crate::warp::homotopy::Homotopy;
use crate::work::progress::Silent;
use std::f64::consts::{PI, TAU};

/// Times inside and outside [0, 1].
const TIMES: [f64; 7] = [-0.3, 0.1, 0.25, 0.5, 0.77, 0.9, 1.4];

/// Returns a strip of `2 * n` faces over the rectangle from (0, 0) to (length, width).
fn strip(n: usize, length: f64, width: f64) -> (Vec<[u32; 3]>, Vec<DVec2>) {
    let points = (0..=n)
        .flat_map(|i| {
            let x = length * i as f64 / n as f64;
            [DVec2::new(x, 0.0), DVec2::new(x, width)]
        })
        .collect();
    let faces = (0..n as u32)
        .flat_map(|i| {
            let v = 2 * i;
            [[v, v + 2, v + 3], [v, v + 3, v + 1]]
        })
        .collect();
    (faces, points)
}

/// Returns a mesh without symmetry: a strip in the source and its bent, stretched and sheared image
/// in the target.
fn bent_pair() -> CompatibleMesh {
    let (faces, source) = strip(12, 6.0, 1.0);
    let target = source
        .iter()
        .map(|p| {
            let angle = 0.4 * p.x;
            let radius = 3.0 + 1.3 * p.y + 0.1 * p.x;
            DVec2::new(radius * angle.cos() + 5.0, radius * angle.sin() - 2.0)
        })
        .map(|p| DVec2::new(-p.y, p.x))
        .collect::<Vec<_>>();
    let target: Vec<_> = target.iter().map(|p| DVec2::new(-p.x, p.y)).collect();
    match CompatibleMesh::new(faces.clone(), source.clone(), target.clone(), vec![]) {
        Ok(mesh) => mesh,
        Err(_) => {
            let mirrored = target.iter().map(|p| DVec2::new(-p.x, p.y)).collect();
            CompatibleMesh::new(faces, source, mirrored, vec![]).unwrap()
        }
    }
}

/// Returns a mesh whose source is two separate strips, with a bar attached to the first;
/// `target_of` maps source points to target points.
fn parts(target_of: impl Fn(DVec2) -> DVec2) -> CompatibleMesh {
    let (mut faces, mut source) = strip(3, 3.0, 1.0);
    let first = source.len() as u32;
    let (second_faces, points) = strip(2, 2.0, 1.0);
    faces.extend(second_faces.iter().map(|f| f.map(|v| v + first)));
    source.extend(points.iter().map(|p| *p + DVec2::new(5.0, 2.0)));
    source.push(DVec2::new(-1.5, 0.5));
    let bar_end = source.len() as u32 - 1;
    let target = source.iter().map(|&p| target_of(p)).collect();
    CompatibleMesh::new(faces, source, target, vec![[0, bar_end]]).unwrap()
}

/// Returns a function that maps t to the vertex positions of the interpolation.
fn motion(mesh: &CompatibleMesh, options: &ArapOptions) -> impl FnMut(f64) -> Vec<DVec2> + use<> {
    let mut placer = Arap::build(mesh, options, &Silent).unwrap().placer();
    move |t| {
        placer.place(t);
        placer.placement().in_frame.clone()
    }
}

fn largest_distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(p, q)| p.distance(*q))
        .fold(0.0, f64::max)
}

fn with(homotopy: Homotopy) -> ArapOptions {
    ArapOptions {
        homotopy,
        ..ArapOptions::default()
    }
}

/// Returns all combinations of homotopy, symmetry and weights.
fn all_options() -> Vec<ArapOptions> {
    let mut all = Vec::new();
    for homotopy in Homotopy::ALL {
        for symmetric in [true, false] {
            for weights in [FaceWeights::Area, FaceWeights::Uniform] {
                all.push(ArapOptions {
                    homotopy,
                    symmetric,
                    weights,
                    ..ArapOptions::default()
                });
            }
        }
    }
    all
}

#[test]
fn ends_are_exact_bit_for_bit() {
    for mesh in [bent_pair(), parts(|p| DMat2::from_angle(2.0) * p + p * 0.3)] {
        for mut options in all_options() {
            for path in [ArapPath::Centroid, ArapPath::Pole, ArapPath::Anchor(3)] {
                options.path = path;
                let mut at = motion(&mesh, &options);
                at(0.4); // An earlier frame must have no effect on later ones.
                assert_eq!(at(0.0), mesh.source(), "{options:?}");
                assert_eq!(at(1.0), mesh.target(), "{options:?}");
            }
        }
    }
}

#[test]
fn a_rigid_target_of_several_parts_moves_rigidly() {
    let (angle, offset) = (2.5, DVec2::new(3.0, -7.0));
    let rigid = |t: f64| move |p: DVec2| DMat2::from_angle(t * angle) * p + offset * t;
    let mesh = parts(rigid(1.0));
    for homotopy in [Homotopy::Polar, Homotopy::Exponential, Homotopy::Bounded] {
        let mut at = motion(&mesh, &with(homotopy));
        for t in TIMES {
            let positions = at(t);
            for (i, p) in mesh.source().iter().enumerate() {
                for (j, q) in mesh.source().iter().enumerate().skip(i) {
                    let error = positions[i].distance(positions[j]) - p.distance(*q);
                    assert!(
                        error.abs() < 1e-12 * mesh.diameter(),
                        "{i} {j} at {t}: {error}"
                    );
                }
            }
            let edge = positions[1] - positions[0];
            let sine = edge.perp_dot(mesh.source()[1] - mesh.source()[0]);
            let expected = -(t * angle).sin();
            assert!((sine - expected).abs() < 1e-11);
        }
    }
}

#[test]
fn equal_designs_do_not_move() {
    let (faces, points) = strip(5, 4.0, 0.7);
    let mesh = CompatibleMesh::new(faces, points.clone(), points.clone(), vec![]).unwrap();
    for options in all_options() {
        let mut at = motion(&mesh, &options);
        for t in TIMES {
            assert!(largest_distance(&at(t), &points) < 1e-13, "{options:?}");
        }
    }
}

#[test]
fn exchanged_designs_reverse_the_motion_under_the_symmetric_energy() {
    for mesh in [
        bent_pair(),
        parts(|p| DMat2::from_angle(1.0) * p * 1.2 + DVec2::new(p.y, p.x) * 0.2),
    ] {
        let about_pole = ArapOptions {
            path: ArapPath::Pole,
            ..ArapOptions::default()
        };
        let symmetric = all_options().into_iter().filter(|o| o.symmetric);
        for options in symmetric.chain([about_pole]) {
            if options.homotopy == Homotopy::LinearAfterPolar {
                continue; // This homotopy is not reversible.
            }
            let mut forward = motion(&mesh, &options);
            let mut backward = motion(&mesh.swapped(), &options);
            for t in TIMES {
                let error = largest_distance(&forward(t), &backward(1.0 - t)) / mesh.diameter();
                assert!(error < 1e-12, "{options:?} at {t}: {error:e}");
            }
        }
    }
}

#[test]
fn the_one_sided_energy_is_not_symmetric() {
    let options = ArapOptions {
        symmetric: false,
        ..ArapOptions::default()
    };
    let mesh = bent_pair();
    let (mut forward, mut backward) = (motion(&mesh, &options), motion(&mesh.swapped(), &options));
    let error = largest_distance(&forward(0.5), &backward(0.5)) / mesh.diameter();
    assert!(error > 1e-6, "the symmetry test could not fail: {error:e}");
}

/// Evaluates the one-sided energy E(A→B, t) by its definition, with the source areas as weights.
fn one_sided_energy(
    mesh: &CompatibleMesh,
    angles: &[f64],
    t: f64,
    v: &[DVec2],
    homotopy: Homotopy,
) -> f64 {
    mesh.faces()
        .iter()
        .zip(angles)
        .map(|(face, &angle)| {
            let edges = |points: &[DVec2]| {
                let [a, b, c] = face.map(|i| points[i as usize]);
                (
                    DMat2::from_cols(b - a, c - a),
                    0.5 * twice_signed_area(a, b, c),
                )
            };
            let (d, area) = edges(mesh.source());
            let m = edges(mesh.target()).0 * d.inverse();
            let map = PolarDecomposition {
                angle,
                stretch: DMat2::from_angle(-angle) * m,
            };
            let gap = edges(v).0 * d.inverse() - homotopy.at(&map, t);
            area * (gap.x_axis.length_squared() + gap.y_axis.length_squared())
        })
        .sum()
}

#[test]
fn the_symmetric_solution_minimises_the_sum_of_both_energies() {
    let mesh = bent_pair();
    let back = mesh.swapped();
    for homotopy in [Homotopy::Polar, Homotopy::Exponential, Homotopy::Linear] {
        let angles = Arap::build(&mesh, &with(homotopy), &Silent)
            .unwrap()
            .face_angles();
        let reversed: Vec<f64> = angles.iter().map(|a| -a).collect();
        let two_sided = |t: f64, v: &[DVec2]| {
            0.5 * one_sided_energy(&mesh, &angles, t, v, homotopy)
                + 0.5 * one_sided_energy(&back, &reversed, 1.0 - t, v, homotopy)
        };
        let mut at = motion(&mesh, &with(homotopy));
        for t in [0.2, 0.5, 0.9] {
            let v = at(t);
            let minimum = two_sided(t, &v);
            // At the minimum all directional derivatives vanish. Central differences are exact
            // for a quadratic function.
            for i in 0..v.len() {
                for step in [DVec2::X, DVec2::Y] {
                    let (mut plus, mut minus) = (v.clone(), v.clone());
                    plus[i] += step;
                    minus[i] -= step;
                    let (up, down) = (two_sided(t, &plus), two_sided(t, &minus));
                    assert!(
                        (up - down).abs() < 1e-9 * (up + down),
                        "{homotopy:?} {t} {i}"
                    );
                    assert!(up > minimum && down > minimum);
                }
            }
        }
    }
}

/// Returns a mesh whose source is a strip rolled up by `turns` turns and whose target is the
/// straight strip.
fn spiral(turns: f64) -> CompatibleMesh {
    let n = 240;
    let (faces, straight) = strip(n, 60.0, 0.5);
    let rolled = straight
        .iter()
        .map(|p| {
            // Archimedean spiral with a gap between its windings.
            let angle = turns * TAU * (p.x / 60.0);
            DVec2::from_angle(angle) * (1.0 + 1.0 * angle / TAU - p.y + 0.5)
        })
        .collect();
    CompatibleMesh::new(faces, rolled, straight, vec![]).unwrap()
}

#[test]
fn a_spiral_uncoils_by_three_turns_without_a_fold() {
    let mesh = spiral(3.0);
    for homotopy in [Homotopy::Polar, Homotopy::Exponential] {
        let arap = Arap::build(&mesh, &with(homotopy), &Silent).unwrap();
        let angles = arap.face_angles();
        let range = angles
            .iter()
            .fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
        assert!(range.1 - range.0 > 0.95 * 3.0 * TAU, "{range:?}");
        let mut at = motion(&mesh, &with(homotopy));
        for step in 0..=64 {
            let v = at(f64::from(step) / 64.0);
            for face in mesh.faces().iter() {
                let [a, b, c] = face.map(|i| v[i as usize]);
                assert!(twice_signed_area(a, b, c) > 0.0, "{homotopy:?} step {step}");
            }
        }
    }
}

#[test]
fn a_ring_wound_twice_around_its_hole_is_rejected() {
    // The target of this annulus winds twice around the hole. All faces are positively oriented,
    // but no consistent angles exist.
    let n = 24_u32;
    let ring = |speed: f64| -> Vec<DVec2> {
        (0..n)
            .flat_map(|i| {
                let angle = speed * TAU * f64::from(i) / f64::from(n);
                [DVec2::from_angle(angle), DVec2::from_angle(angle) * 2.0]
            })
            .collect()
    };
    let faces = (0..n)
        .flat_map(|i| {
            let (v, w) = (2 * i, 2 * ((i + 1) % n));
            [[v, v + 1, w + 1], [v, w + 1, w]]
        })
        .collect();
    let mesh = CompatibleMesh::new(faces, ring(1.0), ring(2.0), vec![]).unwrap();
    let result = Arap::build(&mesh, &ArapOptions::default(), &Silent);
    assert!(matches!(
        result,
        Err(ArapError::Angles(AngleError::Winding(_)))
    ));
}

#[test]
fn extra_turns_add_rotation_and_keep_the_ends() {
    let (faces, source) = strip(4, 4.0, 1.0);
    let target = source.iter().map(|&p| DMat2::from_angle(1.0) * p).collect();
    let mesh = CompatibleMesh::new(faces, source, target, vec![]).unwrap();
    let options = ArapOptions {
        extra_turns: vec![1],
        ..ArapOptions::default()
    };
    let mut at = motion(&mesh, &options);
    assert_eq!(at(1.0), mesh.target());
    let v = at(0.5);
    let angle = (v[2] - v[0]).to_angle();
    let expected = 0.5 * (1.0 + TAU); // 3.64…, which `to_angle` returns as 3.64 − 2π
    assert!((angle - (expected - TAU)).abs() < 1e-9, "{angle}");
    for (p, q) in [(0, 1), (0, 8), (3, 6)] {
        let rigid = v[p].distance(v[q]) - mesh.source()[p].distance(mesh.source()[q]);
        assert!(rigid.abs() < 1e-9);
    }
}

#[test]
fn parts_rotated_by_half_a_turn_do_not_collide() {
    let mesh = parts(|p| DMat2::from_angle(PI - 1e-9) * p);
    let mut at = motion(&mesh, &ArapOptions::default());
    let v = at(0.5);
    let apart = v[0].distance(v[8]) - mesh.source()[0].distance(mesh.source()[8]);
    assert!(apart.abs() < 1e-6);
}

#[test]
fn an_anchor_moves_on_a_straight_line() {
    let mesh = bent_pair();
    let options = ArapOptions {
        path: ArapPath::Anchor(5),
        ..ArapOptions::default()
    };
    let mut at = motion(&mesh, &options);
    for t in TIMES {
        let straight = mesh.source()[5] * (1.0 - t) + mesh.target()[5] * t;
        assert!(at(t)[5].distance(straight) < 1e-12);
    }
    let missing = ArapOptions {
        path: ArapPath::Anchor(999),
        ..ArapOptions::default()
    };
    assert!(matches!(
        Arap::build(&mesh, &missing, &Silent),
        Err(ArapError::Anchor {
            anchor: 999,
            last: 25
        })
    ));
}

#[test]
fn the_pole_path_reproduces_a_rotation_about_a_fixed_point() {
    let pole = DVec2::new(-4.0, 9.0);
    for angle in [2.5, -0.8, 0.05] {
        let rigid = |t: f64| move |p: DVec2| DMat2::from_angle(t * angle) * (p - pole) + pole;
        let mesh = parts(rigid(1.0));
        let options = ArapOptions {
            path: ArapPath::Pole,
            ..ArapOptions::default()
        };
        let mut at = motion(&mesh, &options);
        for t in TIMES {
            let expected: Vec<_> = mesh.source().iter().map(|&p| rigid(t)(p)).collect();
            let error = largest_distance(&at(t), &expected) / mesh.diameter();
            assert!(error < 1e-12, "{angle} at {t}: {error:e}");
        }
    }
    // A pure translation has no pole and follows the straight path.
    let mesh = parts(|p| p + DVec2::X);
    let [mut straight, mut about] = [ArapPath::Centroid, ArapPath::Pole].map(|path| {
        let options = ArapOptions {
            path,
            ..ArapOptions::default()
        };
        motion(&mesh, &options)
    });
    assert_eq!(straight(0.3), about(0.3));
}

#[test]
fn the_centroid_of_fixed_masses_moves_on_a_straight_line() {
    let mesh = bent_pair();
    let masses = LocalMaps::new(&mesh, &ArapOptions::default(), &[])
        .unwrap()
        .masses;
    let centroid = |v: &[DVec2]| -> DVec2 { v.iter().zip(&masses).map(|(&p, &m)| p * m).sum() };
    let (from, to) = (centroid(mesh.source()), centroid(mesh.target()));
    let mut at = motion(&mesh, &ArapOptions::default());
    for t in TIMES {
        assert!(centroid(&at(t)).distance(from * (1.0 - t) + to * t) < 1e-12);
    }
}

#[test]
fn vectorised_homotopies_equal_the_scalar_ones() {
    // A single face follows its local map M(t) exactly, for any weights.
    let source = vec![DVec2::ZERO, DVec2::new(2.0, 0.1), DVec2::new(0.3, 1.0)];
    let target = vec![
        DVec2::new(1.0, 1.0),
        DVec2::new(-0.7, 0.4),
        DVec2::new(0.5, -1.5),
    ];
    let mesh =
        CompatibleMesh::new(vec![[0, 1, 2]], source.clone(), target.clone(), vec![]).unwrap();
    let edges = |v: &[DVec2]| DMat2::from_cols(v[1] - v[0], v[2] - v[0]);
    let map = PolarDecomposition::of(edges(&target) * edges(&source).inverse());
    for homotopy in Homotopy::ALL {
        let mut at = motion(&mesh, &with(homotopy));
        for t in TIMES {
            let jacobian = edges(&at(t)) * edges(&source).inverse();
            assert!(
                jacobian.abs_diff_eq(homotopy.at(&map, t), 1e-13),
                "{homotopy:?} {t}"
            );
        }
    }
}
