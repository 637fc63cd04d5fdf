//! Tests of designs that the asset server loads and reloads, and of failures to read them.

use super::{has, update_until};
use bevy::prelude::*;
use morphospace::stage::{Blend, BlendWeights, BuildFailed, Morph, MorphDesigns, MorphPlugin};

/// SVG text of a triangle that is `width` wide.
fn triangle_svg(width: u32) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 99 9'><path d='M0 0H{width}L0 9Z'/></svg>"
    )
}

/// An app whose asset folder is a temporary folder with the given files (name and SVG text).
fn app_with_assets(drawings: &[(&str, String)]) -> (App, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, drawing) in drawings {
        std::fs::write(folder.path().join(name), drawing).expect("a file");
    }
    let mut app = App::new();
    let file_path = folder.path().to_string_lossy().into_owned();
    let assets = AssetPlugin {
        file_path,
        ..default()
    };
    app.add_plugins((MinimalPlugins, assets, MorphPlugin));
    (app, folder)
}

/// Starts to load the named designs; returns a component with their handles.
fn load(app: &App, names: &[&str]) -> MorphDesigns {
    let server = app.world().resource::<AssetServer>();
    let paths = names.iter().map(|name| (*name).to_owned());
    MorphDesigns(paths.map(|path| server.load(path)).collect())
}

/// Width of the entity's drawing in its current frame.
fn width(world: &World, entity: Entity) -> f64 {
    let frame = world.get::<Morph>(entity).expect("a morph").frame();
    let vertices = frame.placement().in_frame.iter();
    let xs = || vertices.clone().map(|p| p.x);
    xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min)
}

#[test]
fn designs_are_loaded_as_assets_and_reloaded() {
    let drawings = [
        ("a.svg", triangle_svg(20)),
        ("b.svg", triangle_svg(40)),
        ("c.svg", triangle_svg(80)),
    ];
    let (mut app, folder) = app_with_assets(&drawings);
    let pair = load(&app, &["a.svg", "b.svg"]);
    let pair = app.world_mut().spawn((pair, Blend { t: 1.0 })).id();
    let many = load(&app, &["a.svg", "b.svg", "c.svg"]);
    let weights = BlendWeights(vec![0.0, 0.0, 1.0]);
    let many = app.world_mut().spawn((many, weights)).id();
    update_until(&mut app, |world| {
        has::<Morph>(pair)(world) && has::<Morph>(many)(world)
    });
    assert!((width(app.world(), pair) - 40.0).abs() < 1e-9);
    app.update();
    assert!((width(app.world(), many) - 80.0).abs() < 1e-9);

    std::fs::write(folder.path().join("b.svg"), triangle_svg(60)).expect("a file");
    app.world().resource::<AssetServer>().reload("b.svg");
    update_until(&mut app, |world| (width(world, pair) - 60.0).abs() < 1e-9);
    // If a reloaded design cannot be read, the previous version stays.
    std::fs::write(folder.path().join("b.svg"), "no drawing").expect("a file");
    #[derive(Resource, Default)]
    struct AssetFailures(Vec<(Entity, String)>);
    app.init_resource::<AssetFailures>();
    app.add_observer(
        |failed: On<BuildFailed>, mut failures: ResMut<AssetFailures>| {
            failures.0.push((failed.entity, failed.error.to_string()));
        },
    );
    app.world().resource::<AssetServer>().reload("b.svg");
    // A failure may be reported several times, since the asset server retries by itself.
    let has_failed = |world: &World, entity| {
        let failures = &world.resource::<AssetFailures>().0;
        failures.iter().any(|&(failed, _)| failed == entity)
    };
    update_until(&mut app, |world| {
        has_failed(world, pair) && has_failed(world, many)
    });
    let failures = &app.world().resource::<AssetFailures>().0;
    assert!(
        failures.iter().all(|(_, text)| text.contains("b.svg")),
        "{failures:?}"
    );
    assert!((width(app.world(), pair) - 60.0).abs() < 1e-9);
}
