//! What goes on beside the stage: a second method, and measures.

use std::time::Duration;

use crate::window::Window;
use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{Entity, With};
use morphospace::app::{Comparison, ComparisonMethod, Intent, OnComparison, StageMeasures};
use morphospace::content::ContentKind;
use morphospace::stage::{Blend, StageTransition};
use morphospace::transition::TransitionMethod;

fn wait_for_twin(window: &mut Window) {
    window.update();
    while window.0.world().resource::<Comparison>().is_busy() {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.update();
}

#[test]
fn a_second_method_stands_beside_the_stage_at_the_same_t() {
    let mut window = Window::with_gallery();
    while window
        .session()
        .transition()
        .is_none_or(|t| t.compatible().is_none())
    {
        window.send(Intent::NextMethod);
        window.wait();
    }
    window.type_char(KeyCode::KeyV, "v");
    wait_for_twin(&mut window);
    window.send(Intent::Seek(0.5));
    let world = window.0.world_mut();
    let mut beside = world.query_filtered::<(&StageTransition, &Blend), With<OnComparison>>();
    let (StageTransition(straight), blend) = beside.single(world).expect("one entity beside");
    assert_eq!(blend.t, 0.5);
    // Straight lines are just that: every vertex is half way.
    let mesh = straight.compatible().expect("triangles");
    let frame = straight.frame(0.5);
    let size = mesh.diameter();
    for (k, p) in frame.placement().in_frame.iter().enumerate() {
        let half = 0.5 * (mesh.source()[k] + mesh.target()[k]);
        assert!(p.distance(half) < 1e-6 * size, "{p} is not {half}");
    }
    window.send(Intent::TwinMethod(ComparisonMethod::Cell(
        TransitionMethod::FIELD_BLEND,
    )));
    wait_for_twin(&mut window);
    let twin: &Comparison = window.0.world().resource();
    assert!(twin.problem().is_none());
    let content = twin.transition().map(|t| t.cell().content());
    assert_eq!(content, Some(ContentKind::Field));
    window.press(KeyCode::Escape, Key::Escape);
    let world = window.0.world_mut();
    let mut beside = world.query_filtered::<Entity, With<OnComparison>>();
    assert_eq!(beside.iter(world).count(), 0);
}

fn wait_for_measures(window: &mut Window) {
    for _ in 0..20_000 {
        window.update();
        if window
            .0
            .world()
            .resource::<StageMeasures>()
            .measures()
            .is_some()
        {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("no measures");
}

#[test]
fn what_is_on_the_stage_is_measured() {
    let mut window = Window::with_gallery();
    wait_for_measures(&mut window);
    let measured: &StageMeasures = window.0.world().resource();
    let measures = measured.measures().expect("measures");
    assert_eq!(measures.film.samples.len(), measures.verdict.steps);
    assert!(!measured.is_busy());
    // Another transition is measured anew.
    window.send(Intent::NextMethod);
    window.wait();
    wait_for_measures(&mut window);
}
