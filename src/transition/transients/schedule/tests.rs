//! Tests schedules of several combs in a row. The outline of a comb turns much, so the overshoot of
//! turning matters.

use super::optimise::absence;
use super::*;
use crate::work::progress::Silent;

/// A comb with its left side at `x`. Its outline turns much more than a convex one.
fn comb(x: f64) -> Vec<DVec2> {
    let mut ring: Vec<DVec2> = (0..=16)
        .map(|k| DVec2::new(f64::from(k) / 16.0, f64::from(k % 2)))
        .collect();
    ring.extend([DVec2::new(1.0, -1.0), DVec2::new(0.0, -1.0)]);
    ring.iter_mut().for_each(|p| p.x += x);
    ring.reverse();
    ring
}

/// Creates a schedule of one comb for each of the given designs, next to a shape that does not
/// change.
fn combs(sides: &[Side]) -> TransientSchedule {
    let coming = |(x, &side): (usize, &Side)| ScheduledTransient {
        growth: GrowthProfile::of_scaling(&[comb(x as f64)], 10.0),
        stretch: None,
        place: DVec2::X * x as f64,
        life: TimeWindow::whole(side),
        prices: Vec::new(),
    };
    let coming: Vec<ScheduledTransient> = sides.iter().enumerate().map(coming).collect();
    let sums = vec![[TAU * 10.0, 20.0]; STEPS + 1];
    let mut all = TransientSchedule { coming, sums };
    for coming in &all.coming {
        coming.add(&mut all.sums, 1.0);
    }
    all
}

fn lives(timetable: &TransientSchedule) -> Vec<TimeWindow> {
    timetable.coming.iter().map(|coming| coming.life).collect()
}

/// Optimises a schedule in which nothing collides.
fn planned(mut all: TransientSchedule) -> TransientSchedule {
    all.plan(0, |_| Vec::new(), &Silent).expect("wanted");
    all
}

#[test]
fn what_goes_makes_room_for_what_comes() {
    let sides = [Side::Source, Side::Target, Side::Source, Side::Target];
    let whole = combs(&sides);
    let calm = planned(whole.clone());
    let [before, after] = [&whole, &calm].map(|all| unrest(&all.sums));
    assert!(after < 0.7 * before, "{after} instead of {before}");
    assert_eq!(planned(combs(&[])).cost(), 0.0);
}

#[test]
fn a_word_is_taken_back_and_written_from_its_end_and_beginning() {
    let times = |side| {
        let ordered = planned(combs(&[side; 6]));
        let lives = lives(&ordered).into_iter();
        lives.map(absence).collect::<Vec<f64>>()
    };
    for side in Side::BOTH {
        let absences = times(side);
        assert!(absences.is_sorted(), "{absences:?}");
        assert!(absences[0] < absences[5], "{absences:?}");
    }
}

#[test]
fn designs_exchanged_give_the_times_reversed() {
    let sides = [
        Side::Source,
        Side::Source,
        Side::Target,
        Side::Source,
        Side::Target,
    ];
    let there = lives(&planned(combs(&sides)));
    let back = lives(&planned(combs(&sides.map(Side::other))));
    let reversed: Vec<TimeWindow> = back.into_iter().map(TimeWindow::backwards).collect();
    assert_eq!(there, reversed);
}

#[test]
fn times_that_are_not_free_are_planned_around() {
    let sides = [Side::Source, Side::Target, Side::Target];
    // Target parts are free of collisions only in the last quarter; the time window of the source
    // part is fixed.
    let price = |life: TimeWindow| f64::from(u8::from(life.from < 0.75));
    let mut all = combs(&sides);
    all.set(0, life(Side::Source, 0.5));
    let prices = |k: usize| eighths(sides[k]).map(price).collect();
    all.plan(1, prices, &Silent).expect("wanted");
    let lives = lives(&all);
    assert_eq!(lives[0], life(Side::Source, 0.5));
    assert!(lives[1..].iter().all(|life| life.from >= 0.75), "{lives:?}");
    // The optimisation clears the collision costs at its end. Without them, every cost is below 1;
    // each of them is 0 or 1 here.
    assert!(all.costs(1).iter().all(|(cost, _)| *cost < 1.0));
}

#[test]
fn two_change_places_where_neither_can_alone() {
    let mut all = combs(&[Side::Source, Side::Target]);
    let mut take = |[first, second]: [f64; 2]| {
        all.set(0, life(Side::Source, first));
        all.set(1, life(Side::Target, second));
        all.cost()
    };
    // In `now`, the first time window is short and the second long. The collision cost `dear` of
    // the long one is so low that changing only one of the two time windows would raise the total
    // cost.
    let [short, long, now] = [[0.25, 0.25], [0.75, 0.75], [0.25, 0.75]].map(&mut take);
    let dear = (short.min(long) - now) / 2.0;
    assert!(dear > 0.01, "{dear}");
    let price = |life: TimeWindow, dear: f64| match life.to - life.from {
        0.25 => 0.0,
        0.75 => dear,
        _ => 1.0,
    };
    for (k, dear) in [0.0, dear].into_iter().enumerate() {
        let times = eighths(all.coming[k].life.side);
        all.coming[k].prices = times.map(|life| price(life, dear)).collect();
    }
    let mut all = all.improved(&(0..2));
    assert_eq!(all.coming[1].life, life(Side::Target, 0.75));
    assert!(all.improve_twos(&(0..2)));
    assert_eq!(all.coming[1].life, life(Side::Target, 0.25));
    assert_eq!(all.coming[0].life, life(Side::Source, 0.75));
    assert!(!all.improve_twos(&(0..2)));
}

#[test]
fn any_eighths_of_the_film_are_times() {
    for side in Side::BOTH {
        let times: Vec<TimeWindow> = eighths(side).collect();
        assert_eq!(times.len(), 36);
        assert!(
            times
                .iter()
                .all(|life| life.is_valid() && life.side == side)
        );
        assert_eq!(times[0], TimeWindow::whole(side));
        let back = eighths(side.other()).map(TimeWindow::backwards);
        assert!(back.eq(times));
    }
}

#[test]
fn one_that_gets_another_time_is_known_of_by_the_others() {
    let mut all = planned(combs(&[Side::Source, Side::Target]));
    let before = all.costs(1);
    all.set(0, life(Side::Source, 1.0));
    assert_ne!(all.costs(1), before);
    // The short time windows come last, even if they reduce the overshoot.
    let ranked = all.ranked(1);
    let times = eighths(Side::Target).count();
    assert_eq!(ranked.len(), times + JUMPS.len());
    assert_eq!(ranked[0].0, 0.0);
    assert!(ranked.is_sorted_by(|a, b| a.0 <= b.0));
    assert!(wait(ranked[times + 1].1) > wait(ranked[times].1));
}
