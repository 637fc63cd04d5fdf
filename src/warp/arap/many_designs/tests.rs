//! Tests blends of many designs with bent strips.

use super::*;
use crate::compatible::CompatibleMesh;
use crate::warp::{Arap, Warp};
use crate::work::progress::Silent;
use proptest::prelude::*;

/// A strip of one row of squares, bent by `by`, stretched, and rotated by `turn` radians.
fn bent(by: f64, stretch: f64, turn: f64) -> Vec<DVec2> {
    let place = |i: u32| {
        let (x, y) = (f64::from(i / 2), f64::from(i % 2));
        let p = DMat2::from_angle(by * x) * DVec2::new(x * stretch, 4.0 - y);
        DMat2::from_angle(turn) * p + DVec2::new(3.0 * turn, by)
    };
    (0..12).map(place).collect()
}

fn strip() -> Vec<[u32; 3]> {
    let cells = (0..5_u32).map(|i| 2 * i);
    cells
        .flat_map(|v| [[v, v + 1, v + 2], [v + 2, v + 1, v + 3]])
        .collect()
}

fn family(designs: &[[f64; 3]]) -> CompatibleFamily {
    let places = designs
        .iter()
        .map(|&[by, stretch, turn]| bent(by, stretch, turn));
    CompatibleFamily::new(strip(), places.collect(), vec![]).expect("positive faces")
}

const THREE: [[f64; 3]; 3] = [[0.0, 1.0, 0.0], [0.2, 1.3, 0.9], [-0.15, 0.8, -0.7]];

#[test]
fn each_design_is_met_to_the_last_bit() {
    let family = family(&THREE);
    let blend = ArapBlend::build(&family, &Silent).expect("a blend");
    let mut placer = blend.placer();
    for (k, places) in family.embeddings().iter().enumerate() {
        let mut weights = [0.0; 3];
        weights[k] = 1.0;
        assert_eq!(placer.place(&weights), &places[..]);
    }
}

#[test]
fn the_order_of_the_designs_has_no_influence() {
    let [a, b, c] = THREE;
    let place = |designs: [[f64; 3]; 3], weights: [f64; 3]| {
        let blend = ArapBlend::build(&family(&designs), &Silent).expect("a blend");
        blend.placer().place(&weights).to_vec()
    };
    let first = place([a, b, c], [0.5, 0.2, 0.3]);
    for (designs, weights) in [
        ([b, c, a], [0.2, 0.3, 0.5]),
        ([c, b, a], [0.3, 0.2, 0.5]),
        ([b, a, c], [0.2, 0.5, 0.3]),
    ] {
        let again = place(designs, weights);
        let off = first.iter().zip(&again).map(|(p, q)| p.distance(*q));
        assert!(off.fold(0.0, f64::max) < 1e-12);
    }
}

#[test]
fn a_rigid_design_moves_rigidly() {
    let designs = [[0.1, 1.2, 0.0], [0.1, 1.2, 1.0], [0.1, 1.2, -1.3]];
    let family = family(&designs);
    let blend = ArapBlend::build(&family, &Silent).expect("a blend");
    let mut placer = blend.placer();
    let places = placer.place(&[0.3, 0.3, 0.4]);
    let lengths = |places: &[DVec2]| -> Vec<f64> {
        let first = places[0];
        places.iter().map(|p| p.distance(first)).collect()
    };
    for (a, b) in lengths(places).iter().zip(lengths(&family.embeddings()[0])) {
        assert!((a - b).abs() < 1e-10);
    }
}

#[test]
fn parts_are_carried_about_the_whole() {
    // Two strips apart from each other, rotated together by `turn` radians.
    let two = |turn: f64| -> Vec<DVec2> {
        let strip = bent(0.0, 1.0, 0.0);
        let other = strip.iter().map(|&p| p + DVec2::Y * 20.0);
        let all = strip.iter().copied().chain(other);
        all.map(|p| DMat2::from_angle(turn) * p).collect()
    };
    let faces = strip().into_iter();
    let again = strip().into_iter().map(|face| face.map(|v| v + 12));
    let places = vec![two(0.0), two(2.0), two(3.0)];
    let family =
        CompatibleFamily::new(faces.chain(again).collect(), places, vec![]).expect("positive");
    let blend = ArapBlend::build(&family, &Silent).expect("a blend");
    let at = blend.placer().place(&[0.25, 0.25, 0.5]).to_vec();
    assert!((at[0].distance(at[12]) - 20.0).abs() < 1e-9);
}

#[test]
fn from_a_fold_it_goes_towards_the_nearest_design_until_there_is_none() {
    // Uses weights far outside [0, 1], for which folds cannot be avoided.
    let family = family(&THREE);
    let blend = ArapBlend::build(&family, &Silent).expect("a blend");
    let mut placer = blend.placer();
    let mut folded = 0;
    for k in 1..60 {
        let beyond = f64::from(k);
        for weights in [
            [1.0 + 2.0 * beyond, -beyond, -beyond],
            [-beyond, 1.0 + 1.5 * beyond, -0.5 * beyond],
        ] {
            if placer.solve(&weights) {
                continue;
            }
            folded += 1;
            placer.retreat(&weights);
            for face in family.faces().iter() {
                let [a, b, c] = face.map(|v| placer.places()[v as usize]);
                assert!(twice_signed_area(a, b, c) > 0.0, "{weights:?}");
            }
        }
    }
    assert!(folded > 0);
}

proptest! {
    #[test]
    fn two_designs_are_the_pair(
        bends in prop::array::uniform2(-0.1..0.1_f64),
        stretches in prop::array::uniform2(0.6..1.6_f64),
        turn in -2.5..2.5_f64,
        t in -0.5..1.5_f64,
    ) {
        let designs = [[bends[0], stretches[0], 0.0], [bends[1], stretches[1], turn]];
        let family = family(&designs);
        let blend = ArapBlend::build(&family, &Silent).expect("a blend");
        let options = ArapOptions { homotopy: Homotopy::Exponential, ..ArapOptions::default() };
        let mesh: CompatibleMesh = family.pair(0, 1);
        let mut pair = Arap::build(&mesh, &options, &Silent).expect("a pair").placer();
        pair.place(t);
        let mut placer = blend.placer();
        let many = placer.place(&[1.0 - t, t]);
        for (p, q) in many.iter().zip(&pair.placement().in_frame) {
            prop_assert!(p.distance(*q) < 1e-11, "{p} {q}");
        }
    }
}
