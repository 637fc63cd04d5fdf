//! Many meshes of the same faces, blended by weights.

use super::{bare_app, drawing_app, places, straight, strip, turned, until};
use bevy::prelude::*;
use morphospace::geometry::DVec2;
use morphospace::stage::{BlendWeights, BuildFailed, MeshFamily, Morph};

#[test]
fn many_meshes_are_blended_by_their_weights() {
    let mut app = drawing_app();
    let wide = strip(4, |p| DVec2::new(1.5 * p.x, 0.8 * p.y));
    let meshes = vec![straight(), turned(), wide.clone()];
    let entity = app.world_mut().spawn(MeshFamily(meshes)).id();
    until(&mut app, |world| world.get::<Morph>(entity).is_some());
    // Nothing was said of how much of each: it is the first.
    assert_eq!(places(&app, entity), straight().positions());
    let weigh = |app: &mut App, weights: &[f64]| {
        app.world_mut()
            .entity_mut(entity)
            .insert(BlendWeights(weights.to_vec()));
        app.update();
        places(app, entity)
    };
    assert_eq!(weigh(&mut app, &[0.0, 0.0, 1.0]), wide.positions());
    let mixed = weigh(&mut app, &[0.25, 0.5, 0.25]);
    assert!(mixed.iter().all(|p| p.is_finite()) && mixed != wide.positions());
    // What are no weights leave it as it is.
    assert_eq!(weigh(&mut app, &[1.0]), mixed);
    assert_eq!(weigh(&mut app, &[f64::NAN, 0.5, 0.5]), mixed);
    assert_eq!(weigh(&mut app, &[0.0, 1.0, 0.0]), turned().positions());
    // It is drawn as two are.
    let parts = app.world().get::<Children>(entity).map(|parts| parts.len());
    assert!(parts.is_some_and(|parts| parts > 0));
    // Another family takes its place.
    app.world_mut()
        .entity_mut(entity)
        .insert(MeshFamily(vec![turned(), straight()]))
        .insert(BlendWeights(vec![0.0, 1.0]));
    until(&mut app, |world| {
        let morph = world.get::<Morph>(entity).expect("a morph");
        morph.frame().placement().in_frame == straight().positions()
    });
}

#[test]
fn meshes_of_other_faces_are_no_family() {
    #[derive(Resource, Default)]
    struct Said(Vec<String>);
    let mut app = bare_app();
    app.init_resource::<Said>();
    app.add_observer(|failed: On<BuildFailed>, mut said: ResMut<Said>| {
        said.0.push(failed.error.to_string());
    });
    let meshes = vec![straight(), strip(3, |p| p)];
    app.world_mut().spawn(MeshFamily(meshes));
    app.world_mut().spawn(MeshFamily(vec![straight()]));
    until(&mut app, |world| world.resource::<Said>().0.len() == 2);
    let said = app.world().resource::<Said>();
    assert!(
        said.0.iter().any(|words| words.contains("at least two")),
        "{:?}",
        said.0
    );
}
