//! Tests the collision avoidance with squares that pass, overlap or appear.

use super::*;
use crate::compatible::CompatibleMesh;
use crate::geometry::Side;
use crate::transition::transients::layers::PieceLayers;
use crate::warp::{ArapOptions, TimeWindow};
use crate::work::progress::Silent;

/// For source and target, the centre of a square that stands on a corner, and the distance of its
/// corners from the centre.
type MovingSquare = [(DVec2, f64); 2];

/// Builds the motion of several squares above a long bar, which prevents the whole design from
/// rotating.
fn film(squares: &[MovingSquare], lives: &[Option<TimeWindow>]) -> Arap {
    let corners = [DVec2::X, DVec2::Y, -DVec2::X, -DVec2::Y];
    let bar = [[-30.0, -29.0], [30.0, -29.0], [30.0, -11.0], [-30.0, -11.0]];
    let mut places = [0, 1].map(|_| bar.map(DVec2::from_array).to_vec());
    for square in squares {
        for (places, (middle, half)) in places.iter_mut().zip(square) {
            places.extend(corners.map(|c| *middle + c * *half));
        }
    }
    let faces = (0..=squares.len() as u32).flat_map(|k| {
        let at = |corner: u32| 4 * k + corner;
        [[at(0), at(1), at(2)], [at(0), at(2), at(3)]]
    });
    let [source, target] = places;
    let mesh = CompatibleMesh::new(faces.collect(), source, target, vec![]).expect("squares");
    Arap::of_outlines(&mesh, &ArapOptions::default(), lives, &Silent).expect("a film")
}

fn at(film: &Arap, t: f64) -> Vec<DVec2> {
    let mut placer = film.placer();
    placer.place(t);
    placer.placement().in_frame.clone()
}

fn kept_apart(film: &Arap, drawn: DrawnPieces) -> Arap {
    match FailedProof::of_drawn(film, drawn, &Silent).expect("nobody cancels") {
        Some(unproved) => unproved.kept_apart(&Silent).expect("a film"),
        None => film.clone(),
    }
}

fn is_proved(film: &Arap, drawn: &DrawnPieces) -> bool {
    let trouble = trouble(film, drawn, &Silent).expect("nobody cancels");
    trouble.expect("a film that settles").is_none()
}

/// Builds the motion of two squares that pass each other: one moves to the right, the other to the
/// left at the height `above`.
fn passing(above: f64) -> Arap {
    let x = DVec2::new(5.0, 0.0);
    let up = DVec2::new(0.0, above);
    film(
        &[[(-x, 1.0), (x, 1.0)], [(x + up, 1.0), (up - x, 1.0)]],
        &[],
    )
}

#[test]
fn where_nothing_is_wrong_the_film_is_the_plain_one() {
    let (plain, drawn) = (
        passing(2.1),
        DrawnPieces::of(3, &[], &PieceLayers::default()),
    );
    assert!(is_proved(&plain, &drawn));
    let guarded = kept_apart(&plain, drawn);
    assert!(guarded.guard().is_none());
    assert_eq!(at(&guarded, 0.4), at(&plain, 0.4));
}

#[test]
fn what_would_graze_is_moved_aside_and_no_more() {
    let (plain, drawn) = (
        passing(1.8),
        DrawnPieces::of(3, &[], &PieceLayers::default()),
    );
    assert!(!is_proved(&plain, &drawn));
    let guarded = kept_apart(&plain, drawn.clone());
    assert!(is_proved(&guarded, &drawn));
    for t in [0.0, 1.0] {
        assert_eq!(at(&guarded, t), at(&plain, t), "{t}");
    }
    // Each square yields by half of the overlap plus half of the clearance.
    let farthest = guarded.max_guard_displacement().expect("a guard") * plain.mesh().diameter();
    assert!((0.05..0.5).contains(&farthest), "{farthest}");
    let [was, is] = [&plain, &guarded].map(|film| at(film, 0.5));
    assert!(was[..4] == is[..4], "the bar is in nobody's way");
    let lowered = |k: usize| was[k].y - is[k].y;
    assert!(lowered(5) > 0.05 && lowered(11) < -0.05, "{is:?}");
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn backwards_it_is_the_film_of_the_exchanged_designs() {
    let (plain, drawn) = (
        passing(1.8),
        DrawnPieces::of(3, &[], &PieceLayers::default()),
    );
    let there = kept_apart(&plain, drawn.clone());
    let swapped = plain.swapped(&Silent).expect("a film");
    let back = kept_apart(&swapped, drawn);
    for t in [0.3, 0.45, 0.5, 0.62] {
        let (a, b) = (at(&there, t), at(&back, 1.0 - t));
        let off = a
            .iter()
            .zip(&b)
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f64::max);
        assert!(off < 1e-4, "{t}: {off}");
    }
}

#[test]
fn what_goes_all_the_way_through_stays_as_it_is() {
    // The square moves to the other side of the bar, and there is no way around the bar.
    let y = DVec2::new(0.0, 1.0);
    let plain = film(&[[(y * 6.0, 1.0), (y * -46.0, 1.0)]], &[]);
    let drawn = DrawnPieces::of(2, &[], &PieceLayers::default());
    assert!(!is_proved(&plain, &drawn));
    let guarded = kept_apart(&plain, drawn);
    assert_eq!(
        [0.0, 1.0].map(|t| at(&guarded, t)),
        [0.0, 1.0].map(|t| at(&plain, t))
    );
}

#[test]
fn what_is_born_on_the_way_of_another_waits() {
    let x = DVec2::new(10.0, 0.0);
    let speck = 1e-3;
    let squares = [
        [(-0.1 * x, 0.5), (0.9 * x, 0.5)],
        [(DVec2::ZERO, speck), (DVec2::ZERO, 0.5)],
    ];
    let born = TimeWindow {
        from: 0.1,
        ..TimeWindow::whole(Side::Target)
    };
    let plain = film(&squares, &[None, None, Some(born)]);
    let drawn = DrawnPieces::of(3, &[], &PieceLayers::default());
    let unproved = FailedProof::of_drawn(&plain, drawn.clone(), &Silent).expect("nobody cancels");
    let unproved = unproved.expect("it is run over");
    // The first collision seen from t = 0, and the first one seen from t = 1.
    let met = unproved.births();
    assert!(
        met.len() == 2 && met[0] >= born.from && met[0] < met[1],
        "{met:?}"
    );
    let guarded = unproved.kept_apart(&Silent).expect("a film");
    assert!(is_proved(&guarded, &drawn) && guarded.guard().is_none());
    let life = guarded.time_windows()[2].expect("a birth");
    assert!(
        (0.15..0.25).contains(&life.from) && life.to == 1.0,
        "{life:?}"
    );
}
