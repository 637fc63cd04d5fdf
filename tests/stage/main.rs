//! Tests of the Bevy systems that build, solve and draw transitions, without a window or a
//! renderer.

mod design_assets;
mod mesh_families;

use std::sync::Arc;
use std::time::{Duration, Instant};

use bevy::asset::AssetEvent;
use bevy::mesh::VertexAttributeValues;
use bevy::prelude::*;
use morphospace::colour::Rgb;
use morphospace::content::ContentKind;
use morphospace::design::Design;
use morphospace::geometry::{Bounds, DVec2};
use morphospace::mesh::TriangleMesh;
use morphospace::stage::{
    Blend, BuildFailed, CaptureStage, FrameTimes, Morph, MorphPlugin, MorphSystems, SourceMesh,
    StageCamera, StageCaptured, StageStyle, StageTransition, StageView, StageVisibility,
    TargetMesh,
};
use morphospace::transition::{Transition, TransitionMethod, TransitionSpec, TransitionStyle};
use morphospace::warp::WarpKind;
use morphospace::work::progress::Silent;

/// Image under the mapping `map` of a horizontal strip of unit squares, each split into two
/// triangles.
fn strip(squares: u32, map: impl Fn(DVec2) -> DVec2) -> TriangleMesh {
    let column = |i: u32| [0.0, 1.0].map(|y| map(DVec2::new(f64::from(i), y)));
    let positions = (0..=squares).flat_map(column).collect();
    let faces = (0..squares).flat_map(|i| {
        let [a, b, c, d] = [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(positions, faces.collect()).expect("a legal mesh")
}

/// A straight strip of four squares.
fn straight() -> TriangleMesh {
    strip(4, |p| p)
}

/// The strip of four squares, rotated by 90°.
fn rotated() -> TriangleMesh {
    strip(4, |p| DVec2::new(-p.y, p.x))
}

/// Transition from the strip of four squares to the rotated strip, both translated by `offset`.
fn transition(offset: DVec2, cell: TransitionMethod) -> Transition {
    let design = |mesh: TriangleMesh| Arc::new(Design::new("strip", mesh));
    let source = design(strip(4, |p| p + offset));
    let target = design(strip(4, |p| DVec2::new(-p.y, p.x) + offset));
    let mut spec = TransitionSpec::new(source, target);
    spec.method = cell;
    spec.options.field.cells = 32;
    Transition::build(&spec, &Silent).expect("a transition")
}

fn arap() -> TransitionMethod {
    TransitionMethod::new(WarpKind::Arap, ContentKind::Solid).expect("a cell")
}

fn paths() -> TransitionMethod {
    TransitionMethod::new(WarpKind::Paths, ContentKind::Solid).expect("a cell")
}

fn field() -> TransitionMethod {
    TransitionMethod::new(WarpKind::None, ContentKind::Field).expect("a cell")
}

/// An app that builds and solves transitions but writes no meshes.
fn bare_app() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, MorphPlugin));
    app
}

/// An app that also writes the meshes to be drawn, although no renderer draws them.
fn drawing_app() -> App {
    let mut app = App::new();
    app.add_plugins((MinimalPlugins, AssetPlugin::default(), MorphPlugin));
    app
}

/// Updates the app until a condition holds; panics after a minute.
fn update_until(app: &mut App, is_done: impl Fn(&World) -> bool) {
    let start = Instant::now();
    while !is_done(app.world()) {
        assert!(start.elapsed() < Duration::from_secs(60), "waited too long");
        app.update();
    }
}

/// Returns the condition that the entity has the component `C`.
fn has<C: Component>(entity: Entity) -> impl Fn(&World) -> bool {
    move |world| world.get::<C>(entity).is_some()
}

/// Spawns an entity that blends the strip and the rotated strip, and waits until its transition is
/// built.
fn spawn_pair(app: &mut App, t: f64) -> Entity {
    let pair = (SourceMesh(straight()), TargetMesh(rotated()), Blend { t });
    let entity = app.world_mut().spawn(pair).id();
    update_until(app, has::<Morph>(entity));
    entity
}

/// Positions of the entity's vertices in its current frame.
fn vertices(app: &App, entity: Entity) -> Vec<DVec2> {
    let morph = app.world().get::<Morph>(entity).expect("a morph");
    morph.frame().placement().in_frame.clone()
}

/// Mesh and visibility of each render part of the entity (fill, wireframe and so on).
fn meshes_of(app: &App, entity: Entity) -> Vec<(Handle<Mesh>, Visibility)> {
    let world = app.world();
    let children = world.get::<Children>(entity).map(|c| c.to_vec());
    let part = |child: Entity| {
        let mesh = world.get::<Mesh2d>(child)?.0.clone();
        Some((mesh, *world.get::<Visibility>(child)?))
    };
    children
        .unwrap_or_default()
        .into_iter()
        .filter_map(part)
        .collect()
}

/// Vertex positions of a mesh asset.
fn positions(app: &App, mesh: &Handle<Mesh>) -> Vec<[f32; 3]> {
    let meshes = app.world().resource::<Assets<Mesh>>();
    let mesh = meshes.get(mesh).expect("a mesh");
    match mesh.attribute(Mesh::ATTRIBUTE_POSITION) {
        Some(VertexAttributeValues::Float32x3(positions)) => positions.clone(),
        other => panic!("positions were expected: {other:?}"),
    }
}

#[test]
fn two_meshes_with_a_blend_are_interpolated() {
    let mut app = bare_app();
    let entity = spawn_pair(&mut app, 0.0);
    for (t, end) in [(0.0, straight()), (1.0, rotated())] {
        app.world_mut().get_mut::<Blend>(entity).expect("a blend").t = t;
        app.update();
        for (p, q) in vertices(&app, entity).iter().zip(end.positions()) {
            assert!((*p - *q).length() < 1e-12, "{p} is not {q} at {t}");
        }
    }
    // The target is a rotation by 90°, so at t = ½ the strip has rotated by 45°.
    app.world_mut().get_mut::<Blend>(entity).expect("a blend").t = 0.5;
    app.update();
    let vertices = vertices(&app, entity);
    let edge = vertices[8] - vertices[0];
    assert!(
        (edge - DVec2::splat(8.0_f64.sqrt())).length() < 1e-9,
        "{edge}"
    );
    let times = app.world().resource::<FrameTimes>();
    assert!(times.solve.median().is_some());
}

#[derive(Resource, Default)]
struct ChangedMorphs(u32);

fn count_changed_morphs(changed: Query<(), Changed<Morph>>, mut count: ResMut<ChangedMorphs>) {
    count.0 += changed.iter().count() as u32;
}

#[test]
fn an_unchanged_or_non_finite_blend_is_not_solved() {
    let mut app = bare_app();
    app.init_resource::<ChangedMorphs>()
        .add_systems(Last, count_changed_morphs);
    let entity = spawn_pair(&mut app, 0.25);
    app.update();
    let before = vertices(&app, entity);
    app.world_mut().resource_mut::<ChangedMorphs>().0 = 0;
    for t in [0.25, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        app.world_mut().get_mut::<Blend>(entity).expect("a blend").t = t;
        app.update();
    }
    assert_eq!(app.world().resource::<ChangedMorphs>().0, 0);
    assert_eq!(vertices(&app, entity), before);
    app.world_mut().get_mut::<Blend>(entity).expect("a blend").t = 0.75;
    app.update();
    assert_eq!(app.world().resource::<ChangedMorphs>().0, 1);
    assert_ne!(vertices(&app, entity), before);
}

#[derive(Resource, Default)]
struct Failures(Vec<(Entity, String)>);

fn record_failure(failed: On<BuildFailed>, mut failures: ResMut<Failures>) {
    failures.0.push((failed.entity, failed.error.to_string()));
}

#[test]
fn a_failed_build_reports_its_entity_and_keeps_the_previous_morph() {
    let mut app = bare_app();
    app.init_resource::<Failures>().add_observer(record_failure);
    let good = spawn_pair(&mut app, 0.0);
    let bad = (SourceMesh(straight()), TargetMesh(strip(3, |p| p)));
    let bad = app.world_mut().spawn(bad).id();
    update_until(&mut app, |world| !world.resource::<Failures>().0.is_empty());
    app.world_mut()
        .get_mut::<TargetMesh>(good)
        .expect("a mesh")
        .0 = strip(2, |p| p);
    update_until(&mut app, |world| world.resource::<Failures>().0.len() == 2);
    let failures = &app.world().resource::<Failures>().0;
    assert_eq!([failures[0].0, failures[1].0], [bad, good]);
    assert!(!failures[0].1.is_empty());
    assert!(app.world().get::<Morph>(bad).is_none());
    assert!(app.world().get::<Morph>(good).is_some());
}

#[test]
fn entities_may_be_despawned_or_replaced_during_a_build() {
    let mut app = bare_app();
    let long = strip(4000, |p| p);
    let pair = (SourceMesh(long.clone()), TargetMesh(long));
    let despawned = app.world_mut().spawn(pair.clone()).id();
    let replaced = app.world_mut().spawn(pair).id();
    app.update();
    app.world_mut().despawn(despawned);
    let newer = (SourceMesh(straight()), TargetMesh(rotated()));
    app.world_mut().entity_mut(replaced).insert(newer);
    update_until(&mut app, has::<Morph>(replaced));
    for _ in 0..20 {
        app.update();
    }
    assert_eq!(vertices(&app, replaced).len(), straight().positions().len());
}

#[test]
fn boundaries_without_faces_are_filled() {
    let mut app = drawing_app();
    let staged = StageTransition(transition(DVec2::ZERO, paths()));
    let entity = app.world_mut().spawn((staged, Blend { t: 0.5 })).id();
    app.update();
    app.update();
    assert!(app.world().get::<SourceMesh>(entity).is_none());
    let [(fill, visibility), ..] = &meshes_of(&app, entity)[..] else {
        panic!("a fill was expected");
    };
    assert_eq!(*visibility, Visibility::Inherited);
    let area = |app: &App| -> f32 {
        let vertices = positions(app, fill);
        let meshes = app.world().resource::<Assets<Mesh>>();
        let mesh = meshes.get(fill).expect("a mesh");
        let corners: Vec<usize> = mesh.indices().expect("faces").iter().collect();
        let at = |v: usize| Vec3::from(vertices[v]).truncate();
        let faces = corners.as_chunks::<3>().0.iter();
        let twice = faces.map(|&[a, b, c]| (at(b) - at(a)).perp_dot(at(c) - at(a)));
        0.5 * twice.sum::<f32>()
    };
    // The target is a rotation of the source, so the area is constant.
    let midway_area = area(&app);
    assert!(midway_area > 0.0);
    app.world_mut().get_mut::<Blend>(entity).expect("a blend").t = 1.0;
    app.update();
    assert!((area(&app) - midway_area).abs() < 1e-4 * midway_area);
}

#[test]
fn a_built_transition_adds_and_replaces_components() {
    let mut app = drawing_app();
    let staged = StageTransition(transition(DVec2::ZERO, arap()));
    let entity = app.world_mut().spawn((staged, Blend { t: 1.0 })).id();
    app.update();
    let source = app.world().get::<SourceMesh>(entity).expect("a source");
    assert_eq!(source.0.positions(), straight().positions());
    assert!(app.world().get::<TargetMesh>(entity).is_some());
    let morph = app.world().get::<Morph>(entity).expect("a morph");
    assert_eq!(morph.frame().t(), 1.0);
    let first_parts = meshes_of(&app, entity);

    // A new transition replaces the old one, even with the same method.
    let staged = StageTransition(transition(DVec2::ONE, arap()));
    app.world_mut().entity_mut(entity).insert(staged);
    app.update();
    let solid_parts = meshes_of(&app, entity);
    assert_eq!(solid_parts.len(), first_parts.len());
    assert!(first_parts.iter().all(|part| !solid_parts.contains(part)));

    let staged = StageTransition(transition(DVec2::ZERO, field()));
    app.world_mut().entity_mut(entity).insert(staged);
    app.update();
    assert!(app.world().get::<SourceMesh>(entity).is_none());
    let morph = app.world().get::<Morph>(entity).expect("a morph");
    assert_eq!(morph.frame().t(), 1.0);
    let field_parts = meshes_of(&app, entity);
    assert!(!field_parts.is_empty());
    for (mesh, _) in &solid_parts {
        assert!(field_parts.iter().all(|(other, _)| other != mesh));
    }

    app.world_mut().entity_mut(entity).remove::<Morph>();
    app.update();
    assert!(
        meshes_of(&app, entity).is_empty(),
        "the parts are removed with the morph"
    );
}

#[derive(Resource, Default)]
struct ModifiedMeshes(usize);

fn count_modified_meshes(
    mut events: MessageReader<AssetEvent<Mesh>>,
    mut count: ResMut<ModifiedMeshes>,
) {
    let is_modified = |event: &&AssetEvent<Mesh>| matches!(event, AssetEvent::Modified { .. });
    count.0 += events.read().filter(is_modified).count();
}

#[test]
fn meshes_are_written_only_when_the_frame_changes() {
    let mut app = drawing_app();
    app.init_resource::<ModifiedMeshes>()
        .add_systems(Last, count_modified_meshes);
    let entity = spawn_pair(&mut app, 0.3);
    for _ in 0..5 {
        app.update();
    }
    let fill = meshes_of(&app, entity)[0].0.clone();
    let origin = app.world().get::<Morph>(entity).expect("a morph");
    let origin = origin.frame().transition().bounds().centre();
    for (p, q) in positions(&app, &fill).iter().zip(vertices(&app, entity)) {
        let q = q - origin;
        let distance = (f64::from(p[0]) - q.x).hypot(f64::from(p[1]) - q.y);
        assert!(distance < 1e-6, "{p:?} is not {q}");
    }
    app.world_mut().resource_mut::<ModifiedMeshes>().0 = 0;
    for _ in 0..5 {
        app.update();
    }
    assert_eq!(app.world().resource::<ModifiedMeshes>().0, 0);
    app.world_mut().get_mut::<Blend>(entity).expect("a blend").t = 0.4;
    for _ in 0..3 {
        app.update();
    }
    // Only the fill is written: the wireframe is hidden, and the outlines of source and target do
    // not change.
    assert_eq!(app.world().resource::<ModifiedMeshes>().0, 1);
}

#[test]
fn a_hidden_wireframe_is_updated_when_it_is_shown() {
    let mut app = drawing_app();
    let entity = spawn_pair(&mut app, 0.0);
    app.update();
    let corners = 3 * straight().faces().len();
    let wireframe = |app: &App| {
        let meshes = app.world().resource::<Assets<Mesh>>();
        let is_wireframe = |(mesh, _): &(Handle<Mesh>, _)| {
            meshes.contains(mesh) && positions(app, mesh).len() == corners
        };
        meshes_of(app, entity).into_iter().find(is_wireframe)
    };
    let show = |app: &mut App, wireframe: bool| {
        let visibility = StageVisibility {
            wireframe,
            ..default()
        };
        let style = StageStyle {
            visibility,
            ..default()
        };
        app.world_mut().entity_mut(entity).insert(style);
        app.update();
    };
    // The wireframe was never shown, so it has no mesh.
    assert!(wireframe(&app).is_none());
    show(&mut app, true);
    assert_eq!(wireframe(&app).expect("wires").1, Visibility::Inherited);
    show(&mut app, false);
    assert_eq!(wireframe(&app).expect("wires").1, Visibility::Hidden);
    app.world_mut().get_mut::<Blend>(entity).expect("a blend").t = 1.0;
    app.update();
    show(&mut app, true);
    let (mesh, visibility) = wireframe(&app).expect("wires");
    assert_eq!(visibility, Visibility::Inherited);
    // The first edge of the first face has rotated by 90°.
    let [a, b] = [positions(&app, &mesh)[0], positions(&app, &mesh)[1]];
    assert!((b[0] - a[0]).abs() < 1e-6 && (b[1] - a[1] - 1.0).abs() < 1e-6);
}

#[test]
fn designs_far_from_the_origin_are_drawn_relative_to_their_centre() {
    let mut app = drawing_app();
    let offset = DVec2::new(1e9, -1e9);
    let built = transition(offset, arap());
    let bounds = built.bounds();
    let entity = app.world_mut().spawn(StageTransition(built)).id();
    app.world_mut()
        .resource_mut::<StageView>()
        .fit(bounds, Vec2::new(800.0, 600.0));
    let camera = app.world_mut().spawn(StageCamera).id();
    app.update();
    let translation = |entity: Entity| app.world().get::<Transform>(entity).map(|t| t.translation);
    assert_eq!(translation(camera), Some(Vec3::ZERO));
    let children = app.world().get::<Children>(entity).expect("parts");
    let at = translation(children[0]).expect("a place");
    assert_eq!(at.truncate(), Vec2::ZERO);
    let corner = positions(&app, &meshes_of(&app, entity)[0].0)[0];
    let expected = (offset - bounds.centre()).as_vec2();
    assert!((Vec2::new(corner[0], corner[1]) - expected).length() < 1e-5);
}

#[test]
fn the_camera_follows_the_view() {
    let mut app = bare_app();
    let camera = app.world_mut().spawn(StageCamera).id();
    {
        let mut view = app.world_mut().resource_mut::<StageView>();
        let bounds = Bounds {
            min: DVec2::ZERO,
            max: DVec2::new(4.0, 2.0),
        };
        view.fit(bounds, Vec2::new(400.0, 400.0));
        view.pan_px(Vec2::new(-100.0, 0.0));
    }
    app.update();
    let transform = app.world().get::<Transform>(camera).expect("a place");
    assert!((transform.translation - Vec3::X).length() < 1e-6);
    match app.world().get::<Projection>(camera) {
        Some(Projection::Orthographic(projection)) => assert_eq!(projection.scale, 0.01),
        other => panic!("an orthographic projection was expected: {other:?}"),
    }
}

#[test]
fn a_capture_without_a_renderer_fails_with_a_reason() {
    let mut app = bare_app();
    app.world_mut().write_message(CaptureStage {
        id: 7,
        size_px: UVec2::splat(16),
        ground: None,
        view: StageView::default().visible(),
    });
    app.update();
    let mut answers = app.world_mut().resource_mut::<Messages<StageCaptured>>();
    let answers: Vec<_> = answers.drain().collect();
    assert_eq!(answers.len(), 1);
    assert_eq!(answers[0].id, 7);
    assert!(
        answers[0]
            .result
            .as_ref()
            .is_err_and(|reason| !reason.is_empty())
    );
}

#[derive(Resource, Default)]
struct SeenFrames(Vec<(f64, f64)>);

fn step_blends(mut blends: Query<&mut Blend>) {
    for mut blend in &mut blends {
        blend.t += 0.125;
    }
}

fn record_frames(morphs: Query<(&Blend, &Morph)>, mut seen: ResMut<SeenFrames>) {
    let pairs = morphs
        .iter()
        .map(|(blend, morph)| (blend.t, morph.frame().t()));
    seen.0.extend(pairs);
}

#[test]
fn systems_after_solving_see_the_frame_of_the_same_update() {
    let mut app = bare_app();
    let entity = spawn_pair(&mut app, 0.0);
    app.init_resource::<SeenFrames>()
        .add_systems(Update, step_blends.in_set(MorphSystems::Playback))
        .add_systems(Update, record_frames.after(MorphSystems::Solve));
    for _ in 0..3 {
        app.update();
    }
    let seen = &app.world().resource::<SeenFrames>().0;
    assert_eq!(*seen, [(0.125, 0.125), (0.25, 0.25), (0.375, 0.375)]);
    // A transition that is inserted is solved in the same update.
    let staged = StageTransition(transition(DVec2::ZERO, arap()));
    app.world_mut().entity_mut(entity).insert(staged);
    app.update();
    assert_eq!(
        app.world().resource::<SeenFrames>().0.last(),
        Some(&(0.5, 0.5))
    );
}

#[test]
fn components_are_registered_for_reflection() {
    let app = bare_app();
    let registry = app.world().resource::<AppTypeRegistry>().read();
    for name in [
        "SourceMesh",
        "TargetMesh",
        "Blend",
        "MorphOptions",
        "Morph",
        "StageTransition",
        "StageStyle",
        "StageCamera",
    ] {
        let registration = registry.get_with_short_type_path(name);
        let registration =
            registration.and_then(|registration| registration.data::<ReflectComponent>());
        assert!(registration.is_some(), "{name}");
    }
    let style = StageStyle {
        style: TransitionStyle {
            ground: Rgb([1, 2, 3]),
            ..default()
        },
        ..default()
    };
    let copy = style.reflect_clone_and_take::<StageStyle>();
    assert_eq!(copy.expect("a copy").style, style.style);
}
