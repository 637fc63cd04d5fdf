//! Tests of the remedies for defects: they are tried first, and only those that help are offered.

use std::path::{Path, PathBuf};

use morphospace::app::testing::{Intent, StageMeasures, Suggestions};
use morphospace::measure::{Finding, Remedy};
use morphospace::warp::homotopy::Homotopy;

use crate::headless_window::HeadlessWindow;

/// Writes a sheet of 4 × 2 squares, each divided into two triangles, as an OBJ file. `place` moves
/// its points.
fn write_sheet(folder: &Path, name: &str, place: impl Fn(f64, f64) -> (f64, f64)) -> PathBuf {
    let mut text = String::new();
    for row in 0..=2 {
        for column in 0..=4 {
            let (x, y) = place(f64::from(column), f64::from(row));
            text.push_str(&format!("v {x} {y} 0\n"));
        }
    }
    for row in 0..2 {
        for column in 0..4 {
            let a = row * 5 + column + 1;
            let (b, c, d) = (a + 1, a + 6, a + 5);
            text.push_str(&format!("f {a} {b} {c}\nf {a} {c} {d}\n"));
        }
    }
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    path
}

/// A window with a sheet that rotates by half a turn along straight paths, so that all of its faces
/// fold.
fn with_folds(folder: &Path) -> HeadlessWindow {
    let source = write_sheet(folder, "a.obj", |x, y| (x, y));
    let target = write_sheet(folder, "b.obj", |x, y| (-x, -3.0 * y));
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(vec![source, target]));
    window.wait();
    let mut project = window.session().project().cloned().expect("a project");
    project.options.arap.homotopy = Homotopy::Linear;
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
    window
}

/// Waits until the film is measured and all changes have been tried; returns its findings.
fn findings(window: &mut HeadlessWindow) -> Vec<Finding> {
    for _ in 0..60_000 {
        window.update();
        let world = window.0.world();
        let measures = world.resource::<StageMeasures>().measures();
        let suggestions = world.resource::<Suggestions>();
        if let Some(measures) = measures
            && (measures.verdict.is_clear() || suggestions.is_done())
        {
            return measures.verdict.findings.clone();
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    panic!("the film is not checked in time");
}

#[test]
fn a_remedy_that_helps_is_offered_and_removes_the_defect() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_folds(folder.path());
    let found = findings(&mut window);
    let remedy = &found[0].remedy;
    assert!(matches!(remedy, Remedy::Change { .. }), "{remedy:?}");
    assert!(window.0.world().resource::<Suggestions>().offers(remedy));
    window.send(Intent::ApplyRemedy(0));
    window.wait();
    assert!(window.session().can_undo());
    assert!(findings(&mut window).is_empty());
}

#[test]
fn a_remedy_that_was_not_found_to_help_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_folds(folder.path());
    window.send(Intent::SaveTo(folder.path().join("folds.morph")));
    // The film is measured, but no remedy has been tried yet.
    while window
        .0
        .world()
        .resource::<StageMeasures>()
        .measures()
        .is_none()
    {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.update();
    }
    let before = window.session().project().cloned();
    window.send(Intent::ApplyRemedy(0));
    assert_eq!(window.session().project().cloned(), before);
    assert!(!window.session().is_dirty());
}
