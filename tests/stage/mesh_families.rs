//! Tests of blends of several meshes by weights; the meshes must have the same faces.

use super::{bare_app, drawing_app, rotated, straight, strip, update_until, vertices};
use bevy::prelude::*;
use morphospace::geometry::DVec2;
use morphospace::stage::{BlendWeights, BuildFailed, MeshFamily, Morph};

#[test]
fn several_meshes_are_blended_by_their_weights() {
    let mut app = drawing_app();
    let wide = strip(4, |p| DVec2::new(1.5 * p.x, 0.8 * p.y));
    let meshes = vec![straight(), rotated(), wide.clone()];
    let entity = app.world_mut().spawn(MeshFamily(meshes)).id();
    update_until(&mut app, |world| world.get::<Morph>(entity).is_some());
    // Without weights the first mesh is shown.
    assert_eq!(vertices(&app, entity), straight().positions());
    let set_weights = |app: &mut App, weights: &[f64]| {
        app.world_mut()
            .entity_mut(entity)
            .insert(BlendWeights(weights.to_vec()));
        app.update();
        vertices(app, entity)
    };
    assert_eq!(set_weights(&mut app, &[0.0, 0.0, 1.0]), wide.positions());
    let mixed = set_weights(&mut app, &[0.25, 0.5, 0.25]);
    assert!(mixed.iter().all(|p| p.is_finite()) && mixed != wide.positions());
    // Invalid weights are ignored: the previous blend stays.
    assert_eq!(set_weights(&mut app, &[1.0]), mixed);
    assert_eq!(set_weights(&mut app, &[f64::NAN, 0.5, 0.5]), mixed);
    assert_eq!(
        set_weights(&mut app, &[0.0, 1.0, 0.0]),
        rotated().positions()
    );
    // A mesh family is drawn, like a pair of meshes.
    let parts = app.world().get::<Children>(entity).map(|parts| parts.len());
    assert!(parts.is_some_and(|parts| parts > 0));
    // Inserting another family replaces the first.
    app.world_mut()
        .entity_mut(entity)
        .insert(MeshFamily(vec![rotated(), straight()]))
        .insert(BlendWeights(vec![0.0, 1.0]));
    update_until(&mut app, |world| {
        let morph = world.get::<Morph>(entity).expect("a morph");
        morph.frame().placement().in_frame == straight().positions()
    });
}

#[test]
fn meshes_with_different_faces_and_single_meshes_are_refused() {
    #[derive(Resource, Default)]
    struct FamilyFailures(Vec<String>);
    let mut app = bare_app();
    app.init_resource::<FamilyFailures>();
    app.add_observer(
        |failed: On<BuildFailed>, mut failures: ResMut<FamilyFailures>| {
            failures.0.push(failed.error.to_string());
        },
    );
    let meshes = vec![straight(), strip(3, |p| p)];
    app.world_mut().spawn(MeshFamily(meshes));
    app.world_mut().spawn(MeshFamily(vec![straight()]));
    update_until(&mut app, |world| {
        world.resource::<FamilyFailures>().0.len() == 2
    });
    let failures = app.world().resource::<FamilyFailures>();
    assert!(
        failures.0.iter().any(|text| text.contains("at least two")),
        "{:?}",
        failures.0
    );
}
