//! Tests of the comparison, which shows the same designs at the same t by a second method, next to
//! the stage. Also tests of the measures of the film on the stage.

use std::time::Duration;

use crate::headless_window::HeadlessWindow;
use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{Entity, With};
use morphospace::app::testing::{
    Comparison, ComparisonMethod, Intent, OnComparison, StageMeasures,
};
use morphospace::content::ContentKind;
use morphospace::stage::{Blend, StageTransition};
use morphospace::transition::TransitionMethod;

/// Updates the window until the comparison's transition is built.
fn wait_for_comparison(window: &mut HeadlessWindow) {
    window.update();
    while window.0.world().resource::<Comparison>().is_busy() {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.update();
}

#[test]
fn the_second_method_is_shown_at_the_same_t_as_the_stage() {
    let mut window = HeadlessWindow::with_gallery();
    while window
        .session()
        .transition()
        .is_none_or(|t| t.compatible().is_none())
    {
        window.send(Intent::NextMethod);
        window.wait();
    }
    window.type_char(KeyCode::KeyV, "v");
    wait_for_comparison(&mut window);
    window.send(Intent::Seek(0.5));
    let world = window.0.world_mut();
    let mut compared = world.query_filtered::<(&StageTransition, &Blend), With<OnComparison>>();
    let (StageTransition(linear), blend) = compared.single(world).expect("one compared entity");
    assert_eq!(blend.t, 0.5);
    // By default the comparison moves every vertex on a straight line: at t = ½ a vertex is midway.
    let mesh = linear.compatible().expect("triangles");
    let frame = linear.frame(0.5);
    let size = mesh.diameter();
    for (k, p) in frame.placement().in_frame.iter().enumerate() {
        let midpoint = 0.5 * (mesh.source()[k] + mesh.target()[k]);
        assert!(p.distance(midpoint) < 1e-6 * size, "{p} is not {midpoint}");
    }
    window.send(Intent::SetComparisonMethod(ComparisonMethod::Method(
        TransitionMethod::FIELD_BLEND,
    )));
    wait_for_comparison(&mut window);
    let comparison: &Comparison = window.0.world().resource();
    assert!(comparison.problem().is_none());
    let content = comparison.transition().map(|t| t.method().content());
    assert_eq!(content, Some(ContentKind::Field));
    window.press(KeyCode::Escape, Key::Escape);
    let world = window.0.world_mut();
    let mut compared = world.query_filtered::<Entity, With<OnComparison>>();
    assert_eq!(compared.iter(world).count(), 0);
}

/// Updates the window until the film on the stage is measured.
fn wait_for_measures(window: &mut HeadlessWindow) {
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
fn the_film_on_the_stage_is_measured() {
    let mut window = HeadlessWindow::with_gallery();
    wait_for_measures(&mut window);
    let measured: &StageMeasures = window.0.world().resource();
    let measures = measured.measures().expect("measures");
    assert_eq!(measures.film.samples.len(), measures.verdict.steps);
    assert!(!measured.is_busy());
    // After a change of the method, the new film is measured.
    window.send(Intent::NextMethod);
    window.wait();
    wait_for_measures(&mut window);
}

#[test]
fn the_structure_of_trusses_is_analysed_and_that_of_other_designs_is_not() {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::OpenGallery("portal-frame".to_owned()));
    window.wait();
    wait_for_measures(&mut window);
    let measures = window.0.world().resource::<StageMeasures>().measures();
    let structure = measures.expect("measures").structure.as_ref();
    let structure = structure.expect("a truss").as_ref().expect("a structure");
    assert!(structure.proof.as_ref().is_some_and(|proof| proof.holds()));
    assert!(
        structure
            .samples
            .iter()
            .all(|sample| sample.critical_load_factor.is_some())
    );
    window.send(Intent::OpenGallery("fern".to_owned()));
    window.wait();
    wait_for_measures(&mut window);
    let measures = window.0.world().resource::<StageMeasures>().measures();
    assert!(measures.expect("measures").structure.is_none());
}
