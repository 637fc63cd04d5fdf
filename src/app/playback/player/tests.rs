//! Tests of [`Playback`], action by action.

use super::*;
use crate::transition::NamedEasing;

fn timing(play: PlayMode) -> Timing {
    Timing {
        duration_secs: 2.0,
        hold_secs: 0.0,
        easing: NamedEasing::Linear.into(),
        play,
        ..Timing::default()
    }
}

fn stop(t: f64) -> TransitionStop {
    TransitionStop::at(t)
}

#[test]
fn once_stops_at_the_end_and_begins_again() {
    let timing = timing(PlayMode::Once);
    let mut playback = Playback::default();
    playback.toggle(&timing, &[]);
    playback.advance(5.0, &timing, &[]);
    assert_eq!((playback.t(), playback.is_playing()), (1.0, false));
    playback.toggle(&timing, &[]);
    playback.advance(0.5, &timing, &[]);
    assert_eq!(playback.t(), 0.25);
}

#[test]
fn a_loop_begins_again_in_either_direction() {
    let timing = timing(PlayMode::Loop);
    let mut playback = Playback::default();
    playback.toggle(&timing, &[]);
    playback.advance(2.5, &timing, &[]);
    assert_eq!(playback.t(), 0.25);
    playback.reverse();
    playback.advance(1.0, &timing, &[]);
    assert_eq!(playback.t(), 0.75);
}

#[test]
fn ping_pong_turns_round_at_both_ends() {
    let timing = timing(PlayMode::PingPong);
    let mut playback = Playback::default();
    playback.toggle(&timing, &[]);
    playback.advance(2.5, &timing, &[]);
    assert_eq!((playback.t(), playback.is_backwards()), (0.75, true));
    playback.advance(2.0, &timing, &[]);
    assert_eq!((playback.t(), playback.is_backwards()), (0.25, false));
    playback.advance(1e7 * 4.0, &timing, &[]);
    assert!(playback.is_playing());
}

#[test]
fn stops_outside_the_film_are_reached_and_waited_at() {
    let timing = timing(PlayMode::Loop);
    let stops = [stop(1.5), stop(0.5)];
    let mut playback = Playback::default();
    let mut visited = Vec::new();
    for _ in 0..4 {
        playback.apply_intent(&Intent::PlayToNextStop, &timing, &stops);
        playback.advance(100.0, &timing, &stops);
        assert!(!playback.is_playing());
        visited.push(playback.t());
    }
    assert_eq!(visited, [0.5, 1.0, 1.5, 1.5]);
}

#[test]
fn pressing_next_on_the_way_goes_one_stop_further() {
    let timing = timing(PlayMode::Once);
    let stops = [stop(0.25), stop(0.5)];
    let mut playback = Playback::default();
    playback.apply_intent(&Intent::PlayToNextStop, &timing, &stops);
    playback.advance(0.1, &timing, &stops);
    playback.apply_intent(&Intent::PlayToNextStop, &timing, &stops);
    playback.advance(100.0, &timing, &stops);
    assert_eq!(playback.t(), 0.5);
}

#[test]
fn reversing_on_the_way_to_a_stop_returns() {
    for easing in NamedEasing::ALL {
        let timing = Timing {
            easing: easing.into(),
            ..timing(PlayMode::Once)
        };
        let mut playback = Playback::default();
        playback.apply_intent(&Intent::PlayToNextStop, &timing, &[]);
        playback.advance(0.5, &timing, &[]);
        let t = playback.t();
        playback.reverse();
        playback.advance(0.0, &timing, &[]);
        assert!((playback.t() - t).abs() < 1e-12, "no jump");
        playback.advance(100.0, &timing, &[]);
        assert_eq!(playback.t(), 0.0);
    }
}

#[test]
fn non_finite_values_are_ignored() {
    let timing = timing(PlayMode::Once);
    let mut playback = Playback::default();
    let before = playback.clone();
    for t in [f64::NAN, f64::INFINITY] {
        playback.apply_intent(&Intent::Seek(t), &timing, &[]);
        playback.apply_intent(&Intent::SetSpeed(t), &timing, &[]);
    }
    assert_eq!(playback, before);
}

#[test]
fn speed_steps_through_the_list_and_stays_within_it() {
    let mut playback = Playback::default();
    for _ in 0..20 {
        playback.change_speed(true);
    }
    assert_eq!(playback.speed(), SPEEDS[SPEEDS.len() - 1]);
    for _ in 0..20 {
        playback.change_speed(false);
    }
    assert_eq!(playback.speed(), SPEEDS[0]);
}

#[test]
fn a_film_may_change_only_at_rest_or_near_a_design() {
    let full_film = timing(PlayMode::Loop);
    let mut playback = Playback::default();
    playback.toggle(&full_film, &[]);
    assert!(playback.can_swap_film(&full_film), "at its start");
    playback.advance(1.0, &full_film, &[]);
    assert!(!playback.can_swap_film(&full_film), "in between");
    playback.advance(0.98, &full_film, &[]);
    assert!(playback.can_swap_film(&full_film), "near its end");
    playback.seek(-0.5, &full_film, &[]);
    assert!(
        !playback.can_swap_film(&full_film),
        "before the first design the films differ"
    );
    let middle_part = Timing {
        from: 0.2,
        to: 0.8,
        ..full_film
    };
    playback.seek(0.5, &middle_part, &[]);
    assert!(
        playback.can_swap_film(&middle_part),
        "it never comes to an end"
    );
    playback.seek(0.5, &full_film, &[]);
    playback.toggle(&full_film, &[]);
    assert!(playback.can_swap_film(&full_film), "at rest");
}
