//! Tests of part timings: parts that move in separate time windows.

use super::*;
use crate::content::Content;
use crate::correspondence::UnmatchedPart;
use crate::geometry::Side;
use crate::measure;
use crate::time::NamedEasing;

/// Returns the timing of a part that moves only in the second half.
fn late(side: Side, at: [f64; 2]) -> PartTime {
    PartTime {
        side,
        at: at.into(),
        from: 0.5,
        to: 1.0,
        easing: NamedEasing::Linear.into(),
    }
}

/// Returns a transition from two squares to a circle and a diamond further up, with the given part
/// timings. Points are in the coordinates of the drawing, y up.
fn squares(times: Vec<PartTime>) -> Transition {
    let source = svg("M0 60h20v20h-20z M60 60h20v20h-20z");
    let target = svg("M0 10a10 10 0 0 0 20 0a10 10 0 0 0 -20 0z M60 10l10-10l10 10l-10 10z");
    let mut spec = TransitionSpec::new(source, target);
    spec.options.parts = times;
    Transition::build(&spec, &Silent).unwrap()
}

/// Returns a point in the right square of the source.
fn point_in_right_square(transition: &Transition) -> [f64; 2] {
    let bounds = transition.designs()[0].form.bounds();
    (bounds.max - DVec2::splat(5.0)).into()
}

fn rings(transition: &Transition, t: f64) -> Vec<Vec<DVec2>> {
    transition.frame(t).figure().rings
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_part_waits_and_then_moves_as_usual() {
    let plain = squares(Vec::new());
    let timed = plain.with_part_times(&[late(Side::Source, point_in_right_square(&plain))]);
    let x = |ring: &Vec<DVec2>| ring.iter().map(|p| p.x).fold(0.0, f64::max);
    for t in [0.0, 0.2, 0.5, 0.7, 0.9, 1.0] {
        let own = late(Side::Source, [0.0; 2]).clock().part_time(t);
        // Rings are sorted by position, because paint layers and loops have different orders.
        let mut expected = vec![
            rings(&plain, t)
                .into_iter()
                .min_by(|a, b| x(a).total_cmp(&x(b)))
                .unwrap(),
            rings(&plain, own)
                .into_iter()
                .max_by(|a, b| x(a).total_cmp(&x(b)))
                .unwrap(),
        ];
        let mut found = rings(&timed, t);
        expected.sort_by(|a, b| x(a).total_cmp(&x(b)));
        found.sort_by(|a, b| x(a).total_cmp(&x(b)));
        assert_eq!(found, expected, "{t}");
    }
    let without = timed.with_part_times(&[]);
    assert_eq!(without.frame(0.3).figure(), plain.frame(0.3).figure());
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_part_changes_colour_in_its_own_time() {
    let plain = squares(Vec::new());
    let timed = plain.with_part_times(&[late(Side::Source, point_in_right_square(&plain))]);
    let style = TransitionStyle::default();
    let figure = timed.frame(0.4).figure();
    let paints = figure
        .layers
        .iter()
        .map(|coat| style.paint_at(coat.paints, coat.t));
    let paints: Vec<_> = paints.collect();
    assert_eq!(
        paints,
        [style.fill_at(0.0).into(), style.fill_at(0.4).into()]
    );
    assert!(plain.frame(0.4).figure().layers.is_empty());
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn exchanging_the_designs_reverses_the_part_times() {
    let plain = squares(Vec::new());
    let timed = plain.with_part_times(&[late(Side::Source, point_in_right_square(&plain))]);
    let report = measure::film_report(&timed, 17, &Silent).unwrap();
    assert!(report.asymmetry.unwrap() < 1e-9, "{:?}", report.asymmetry);
    assert_eq!(report.worst_folds, Some(0));
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn a_part_that_splits_waits_with_all_its_pieces() {
    let one = svg("M0 0h80v20h-80z");
    let two = svg("M0 0h20v20h-20z M60 0h20v20h-20z");
    let plain = Transition::build(&TransitionSpec::new(one, two), &Silent).unwrap();
    let middle = plain.designs()[0].form.bounds().centre();
    let of_one = plain.with_part_times(&[late(Side::Source, middle.into())]);
    let of_two = plain.designs()[1].form.bounds().min + DVec2::splat(5.0);
    let of_half = plain.with_part_times(&[late(Side::Target, of_two.into())]);
    let waiting = |transition: &Transition| {
        let frame = transition.frame(0.3);
        let placement = frame.placement();
        let pairs = placement.in_frame.iter().zip(&placement.in_source);
        pairs.filter(|(p, q)| p == q).count()
    };
    let all = plain.frame(0.0).placement().in_frame.len();
    assert_eq!(waiting(&of_one), all);
    assert!((1..all).contains(&waiting(&of_half)));
}

#[test]
fn of_overlapping_parts_the_uppermost_waits() {
    let stack = |at: f64| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>\
             <rect x='{at}' width='60' height='60' fill='navy'/>\
             <rect x='{}' y='20' width='20' height='20' fill='gold'/></svg>",
            at + 20.0
        );
        design(&text)
    };
    let plain = Transition::build(&TransitionSpec::new(stack(0.0), stack(30.0)), &Silent).unwrap();
    let bounds = plain.designs()[0].form.bounds();
    // Returns the t at which the paint of each layer is mixed, the lowest layer first.
    let layer_times = |at: DVec2| -> Vec<f64> {
        let timed = plain.with_part_times(&[late(Side::Source, at.into())]);
        let coats = timed.frame(0.75).figure().layers;
        coats.iter().map(|coat| coat.t).collect()
    };
    assert_eq!(layer_times(bounds.centre()), [0.75, 0.5]);
    assert_eq!(layer_times(bounds.min + DVec2::splat(5.0)), [0.5, 0.75]);
}

#[test]
fn an_appearing_part_and_its_hole_wait() {
    let source = svg("M0 0h20v20h-20z");
    let target = svg("M0 0h20v20h-20z M40 0h30v30h-30z M50 10v10h10v-10z");
    let corner = target.form.bounds().max - DVec2::splat(2.0);
    let mut spec = TransitionSpec::new(source, target);
    spec.options.matching.lone = vec![UnmatchedPart {
        side: Side::Target,
        at: corner,
    }];
    let plain = Transition::build(&spec, &Silent).unwrap();
    let timed = plain.with_part_times(&[late(Side::Target, corner.into())]);
    let Content::Solid(solid) = timed.content() else {
        panic!("rigid parts");
    };
    assert!(solid.part_clocks.is_some());
    for t in [0.6, 0.8, 1.0] {
        let own = late(Side::Target, [0.0; 2]).clock().part_time(t);
        let area = |transition: &Transition, t: f64| area(&rings(transition, t));
        let gap = area(&timed, t) - area(&plain, own);
        assert!(gap.abs() < 1e-9, "{t}: {gap}");
    }
    assert!((area(&rings(&timed, 0.5)) - 400.0).abs() < 1e-9);
}

#[test]
fn invalid_part_times_are_refused() {
    let time = late(Side::Source, [0.0; 2]);
    let wrong = |edit: fn(&mut PartTime)| {
        let mut time = time;
        edit(&mut time);
        PartTime::check(&[time])
    };
    assert!(wrong(|_| ()).is_ok());
    assert!(wrong(|time| time.from = 1.0).is_err());
    assert!(wrong(|time| time.to = f64::NAN).is_err());
    assert!(wrong(|time| time.from = -0.1).is_err());
    assert!(wrong(|time| time.at.x = f64::INFINITY).is_err());
    let twice = time.swapped().swapped();
    assert_eq!(twice, time);
}

#[test]
fn other_methods_note_that_all_parts_move_together() {
    let source = svg("M0 60h20v20h-20z M60 60h20v20h-20z");
    let mut spec = TransitionSpec::new(Arc::clone(&source), source);
    spec.method = TransitionMethod::FIELD_BLEND;
    spec.options.parts = vec![late(Side::Source, [0.0; 2])];
    let transition = Transition::build(&spec, &Silent).unwrap();
    assert_eq!(transition.notes(), [TransitionNote::PartTimesIgnored]);
    assert!(transition.with_part_times(&[]).notes().is_empty());
}
