//! Designs that the asset server reads.

use super::{has, until};
use bevy::prelude::*;
use morphospace::stage::{Blend, BlendWeights, BuildFailed, Morph, MorphDesigns, MorphPlugin};

/// A triangle as an SVG, so many units wide.
fn drawn(width: u32) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 99 9'><path d='M0 0H{width}L0 9Z'/></svg>"
    )
}

/// A drawing app whose assets are these drawings.
fn app_of(drawings: &[(&str, String)]) -> (App, tempfile::TempDir) {
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

fn load(app: &App, names: &[&str]) -> MorphDesigns {
    let server = app.world().resource::<AssetServer>();
    let paths = names.iter().map(|name| (*name).to_owned());
    MorphDesigns(paths.map(|path| server.load(path)).collect())
}

fn width(world: &World, entity: Entity) -> f64 {
    let frame = world.get::<Morph>(entity).expect("a morph").frame();
    let places = frame.placement().in_frame.iter();
    let xs = || places.clone().map(|p| p.x);
    xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min)
}

#[test]
fn designs_are_assets_and_read_again() {
    let drawings = [
        ("a.svg", drawn(20)),
        ("b.svg", drawn(40)),
        ("c.svg", drawn(80)),
    ];
    let (mut app, folder) = app_of(&drawings);
    let pair = load(&app, &["a.svg", "b.svg"]);
    let pair = app.world_mut().spawn((pair, Blend { t: 1.0 })).id();
    let many = load(&app, &["a.svg", "b.svg", "c.svg"]);
    let weights = BlendWeights(vec![0.0, 0.0, 1.0]);
    let many = app.world_mut().spawn((many, weights)).id();
    until(&mut app, |world| {
        has::<Morph>(pair)(world) && has::<Morph>(many)(world)
    });
    assert!((width(app.world(), pair) - 40.0).abs() < 1e-9);
    app.update();
    assert!((width(app.world(), many) - 80.0).abs() < 1e-9);

    std::fs::write(folder.path().join("b.svg"), drawn(60)).expect("a file");
    app.world().resource::<AssetServer>().reload("b.svg");
    until(&mut app, |world| (width(world, pair) - 60.0).abs() < 1e-9);
    // Where one cannot be read any more, what was there stays.
    std::fs::write(folder.path().join("b.svg"), "no drawing").expect("a file");
    #[derive(Resource, Default)]
    struct Said(Vec<(Entity, String)>);
    app.init_resource::<Said>();
    app.add_observer(|failed: On<BuildFailed>, mut said: ResMut<Said>| {
        said.0.push((failed.entity, failed.error.to_string()));
    });
    app.world().resource::<AssetServer>().reload("b.svg");
    // More than once, maybe: the asset server itself tries a second time.
    let is_told = |world: &World, entity| {
        let said = &world.resource::<Said>().0;
        said.iter().any(|&(of, _)| of == entity)
    };
    until(&mut app, |world| {
        is_told(world, pair) && is_told(world, many)
    });
    let said = &app.world().resource::<Said>().0;
    assert!(
        said.iter().all(|(_, words)| words.contains("b.svg")),
        "{said:?}"
    );
    assert!((width(app.world(), pair) - 60.0).abs() < 1e-9);
}
