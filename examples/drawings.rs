//! Drawings as Bevy assets: the asset server loads the files, and the program blends from each
//! drawing to the next.
//!
//! R reloads the files, so that a drawing changed in another program replaces the old one.
//!
//! `cargo run --release --example drawings [A.svg B.svg C.svg …]`, with paths relative to `assets`

use std::f64::consts::TAU;

use bevy::prelude::*;
use morphospace::stage::{
    Blend, BlendWeights, BuildFailed, Morph, MorphDesigns, MorphPlugin, MorphSystems, StageStyle,
};

/// Drawings that are shown if no files are given.
const BOTTLES: [&str; 3] = [
    "gallery/bottle-claret.svg",
    "gallery/bottle-demijohn.svg",
    "gallery/bottle-milk.svg",
];

/// Duration of one cycle through all drawings, in seconds.
const ROUND_SECS: f64 = 9.0;

fn main() -> AppExit {
    App::new()
        .add_plugins((DefaultPlugins, MorphPlugin))
        .insert_resource(ClearColor(Color::srgb_u8(0xf7, 0xf5, 0xf0)))
        .add_systems(Startup, spawn)
        .add_systems(Update, reload.in_set(MorphSystems::Input))
        .add_systems(Update, advance_blend.in_set(MorphSystems::Playback))
        .add_systems(Update, fit.after(MorphSystems::Solve))
        .add_observer(report_failure)
        .run()
}

fn spawn(mut commands: Commands, server: Res<AssetServer>) {
    commands.spawn(Camera2d);
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let paths = match arguments.len() {
        0 => BOTTLES.map(str::to_owned).to_vec(),
        _ => arguments,
    };
    let designs = paths.into_iter().map(|path| server.load(path)).collect();
    commands.spawn((MorphDesigns(designs), StageStyle::default()));
}

fn reload(keys: Res<ButtonInput<KeyCode>>, server: Res<AssetServer>, morphs: Query<&MorphDesigns>) {
    if !keys.just_pressed(KeyCode::KeyR) {
        return;
    }
    for design in morphs.iter().flat_map(|designs| &designs.0) {
        if let Some(path) = design.path() {
            server.reload(path.clone());
        }
    }
}

/// Blends from each design to the next, and from the last one back to the first.
fn advance_blend(
    time: Res<Time>,
    mut blends: Query<(&MorphDesigns, &mut BlendWeights, &mut Blend)>,
) {
    let round = time.elapsed_secs_f64() / ROUND_SECS;
    for (MorphDesigns(designs), mut weights, mut blend) in &mut blends {
        let count = designs.len();
        let position = round.fract() * count as f64;
        let (from, fraction) = (position as usize % count, position.fract());
        weights.0 = vec![0.0; count];
        weights.0[from] += 1.0 - fraction;
        weights.0[(from + 1) % count] += fraction;
        // Two designs are blended by t; three or more are blended by weights.
        blend.t = 0.5 - 0.5 * (TAU * round).cos();
    }
}

/// Scales a new morph to the window and centres it.
fn fit(window: Single<&Window>, mut morphs: Query<(&Morph, &mut Transform), Added<Morph>>) {
    for (morph, mut transform) in &mut morphs {
        let bounds = morph.frame().transition().bounds();
        let [centre, size] = [bounds.centre(), bounds.size()].map(|v| v.as_vec2());
        let scale = (0.8 * window.size() / size).min_element();
        transform.scale = Vec3::splat(scale);
        transform.translation = (-scale * centre).extend(0.0);
    }
}

fn report_failure(failed: On<BuildFailed>) {
    error!("{}", failed.error);
}
