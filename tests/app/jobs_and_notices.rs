//! Tests of background jobs and notices. Problems are shown until their cause is removed; methods
//! that fail are replaced. Long builds show a draft or a field blend and can be cancelled. Builds
//! that were refused start if the user asks for them. Exports and measuring run in the background.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::testing::{
    ExportKind, FilmExportOptions, FilmExporter, Intent, Preferences, Session, StageMeasures,
    UnsavedAnswer, UnsavedQuestion,
};
use morphospace::correspondence::PointPair;
use morphospace::export::{Aspect, PictureLayout};
use morphospace::geometry::DVec2;
use morphospace::project::{LoadedProject, Project};
use morphospace::transition::{BuildQuality, TransitionMethod};
use morphospace::work::progress::Silent;

use crate::headless_window::HeadlessWindow;

/// SVG path data of a square.
const SQUARE: &str = "M10 10 H90 V90 H10 Z";
/// SVG path data of an L.
const TALL_L: &str = "M10 5 H30 V70 H80 V95 H10 Z";

fn write_outline(folder: &Path, name: &str, d: &str) -> PathBuf {
    let path = folder.join(name);
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><path d="{d}"/></svg>"#
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

/// A window with a transition from a square to an L.
fn with_outlines(folder: &Path) -> HeadlessWindow {
    with_pair(folder, SQUARE, TALL_L)
}

fn with_pair(folder: &Path, source: &str, target: &str) -> HeadlessWindow {
    let source = write_outline(folder, "source.svg", source);
    let target = write_outline(folder, "target.svg", target);
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(vec![source, target]));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    window
}

/// Changes the project of the window and waits until its transition is built.
fn edit(window: &mut HeadlessWindow, change: impl FnOnce(&mut Project)) {
    let mut project = window.session().project().cloned().expect("a project");
    change(&mut project);
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
}

/// Adds a pin at each of three corners of the square. Two of the pins cross: their order along the
/// outline differs between source and target.
fn cross_pins(project: &mut Project) {
    let pin = |[a, b]: [[f64; 2]; 2]| PointPair {
        source: DVec2::from(a),
        target: DVec2::from(b),
    };
    // The y axis points down in SVG files and up in the project.
    project.options.matching.pins = [
        [[10.0, 90.0], [10.0, 95.0]],
        [[90.0, 90.0], [80.0, 5.0]],
        [[90.0, 10.0], [30.0, 95.0]],
    ]
    .map(pin)
    .into();
}

fn method(window: &HeadlessWindow) -> Option<TransitionMethod> {
    window.session().transition().map(|t| t.method())
}

#[test]
fn a_problem_disappears_with_its_cause() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, cross_pins);
    assert_eq!(window.problems().len(), 1, "{:?}", window.problems());
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(
        window.problems(),
        Vec::<String>::new(),
        "undo removes the cause"
    );
    window.send(Intent::Redo);
    window.wait();
    assert_eq!(window.problems().len(), 1);
    let field = TransitionMethod::FIELD_BLEND;
    window.send(Intent::SetMethod(field.warp(), field.content()));
    window.wait();
    assert_eq!(method(&window), Some(field));
    assert_eq!(
        window.problems(),
        Vec::<String>::new(),
        "another method does not use the pins"
    );
    window.send(Intent::Open(vec!["/nowhere/at-all.morph".into()]));
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Discard));
    window.wait();
    assert_eq!(window.problems().len(), 1);
    let other = TransitionMethod::all()
        .find(|method| *method != field)
        .expect("another method");
    window.send(Intent::SetMethod(other.warp(), other.content()));
    window.send(Intent::SetMethod(field.warp(), field.content()));
    window.wait();
}

/// Exports a film to a folder and waits until the export ends.
fn export_film(window: &mut HeadlessWindow, folder: PathBuf) {
    window.send(Intent::Export(ExportKind::Film, folder.join("film")));
    while window.0.world().resource::<FilmExporter>().work().is_some() {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.update();
}

#[test]
fn a_successful_export_removes_the_problem_of_a_failed_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| project.timing.duration_secs = 0.1);
    let file = folder.path().join("source.svg");
    // A folder inside a file cannot be created, so the export fails.
    export_film(&mut window, file.join("below"));
    assert_eq!(window.problems().len(), 1);
    export_film(&mut window, folder.path().join("films"));
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn an_exported_film_has_the_chosen_aspect_ratio() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| project.timing.duration_secs = 0.1);
    let layout = PictureLayout {
        aspect: Aspect::Tall,
        lines: 90,
        ..PictureLayout::default()
    };
    window.send(Intent::SetPreferences(Preferences {
        film: FilmExportOptions {
            layout,
            ..Default::default()
        },
        film_options: true,
        ..Preferences::default()
    }));
    let films = folder.path().join("films");
    export_film(&mut window, films.clone());
    let written = std::fs::read_dir(films).expect("a folder").next();
    let file = File::open(written.expect("a film").expect("readable").path());
    let film = gif::Decoder::new(file.expect("a film")).expect("a GIF");
    assert_eq!((film.width(), film.height()), (90, 160));
    // Escape closes the export settings.
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!window.0.world().resource::<Preferences>().film_options);
}

#[test]
fn discarding_changes_does_not_stop_an_export_and_closing_asks_about_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| project.timing.duration_secs = 600.0);
    let film = folder.path().join("films").join("film");
    window.send(Intent::Export(ExportKind::Film, film));
    let other = write_outline(folder.path(), "other.svg", SQUARE);
    window.send(Intent::Open(vec![other.clone(), other]));
    assert!(
        window
            .0
            .world()
            .resource::<UnsavedQuestion>()
            .text()
            .is_some()
    );
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Discard));
    window.wait();
    assert!(!window.session().is_dirty());
    let is_exporting =
        |window: &HeadlessWindow| window.0.world().resource::<FilmExporter>().work().is_some();
    for _ in 0..20 {
        std::thread::sleep(Duration::from_millis(5));
        window.update();
    }
    assert!(is_exporting(&window));
    // Closing the window asks about the running export. If the user closes anyway, the window
    // waits until the partial file is removed.
    window.send(Intent::Close);
    assert!(
        window
            .0
            .world()
            .resource::<UnsavedQuestion>()
            .text()
            .is_some()
    );
    window.press(KeyCode::Escape, Key::Escape);
    assert!(is_exporting(&window) && window.0.should_exit().is_none());
    window.send(Intent::Close);
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Discard));
    while window.0.should_exit().is_none() {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    let films = std::fs::read_dir(folder.path().join("films")).expect("a folder");
    assert_eq!(films.count(), 0);
}

#[test]
fn a_method_that_fails_is_replaced_by_one_that_works() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    let requested = method(&window);
    edit(&mut window, cross_pins);
    let path = folder.path().join("crossed.morph");
    window.send(Intent::SaveTo(path.clone()));
    let mut reopened = HeadlessWindow::new();
    reopened.send(Intent::Open(vec![path]));
    reopened.wait();
    assert_eq!(method(&reopened), Some(TransitionMethod::FIELD_BLEND));
    let [problem] = &reopened.problems()[..] else {
        panic!("one problem was expected");
    };
    assert!(problem.contains("pin") && problem.contains(TransitionMethod::FIELD_BLEND.name()));
    assert!(!reopened.session().is_dirty(), "the project is unchanged");
    let project = reopened.session().project().expect("a project");
    let field = TransitionMethod::FIELD_BLEND;
    let shown = (Some(field.warp()), Some(field.content()));
    assert_eq!((project.warp, project.content), shown, "the panel names it");
    // A project saved now renders in the same way elsewhere.
    let saved = folder.path().join("saved.morph");
    reopened.send(Intent::SaveTo(saved.clone()));
    let loaded = LoadedProject::open(&saved).expect("a project");
    let rendered = loaded.build(&Silent).expect("a film");
    assert_eq!(rendered.method(), field);
    edit(&mut reopened, |project| {
        project.options.matching.pins.clear();
    });
    assert_eq!(method(&reopened), requested);
    assert_eq!(reopened.problems(), Vec::<String>::new());
}

#[test]
fn a_slow_build_shows_a_field_blend_meanwhile() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_pair(folder.path(), &star(11, 10.0), &star(4, 30.0));
    let mut project = window.session().project().cloned().expect("a project");
    // The mesh gets almost 400,000 triangles. They take longer to build than the window waits
    // before it shows a field blend, but are too few for the build to be refused.
    project.options.arap.subdivisions = 5;
    window.send(Intent::ReplaceSettings(Box::new(project.clone())));
    let path = folder.path().join("fine.morph");
    window.send(Intent::SaveTo(path.clone()));
    drop(window);
    let mut reopened = HeadlessWindow::new();
    reopened.send(Intent::Open(vec![path]));
    let state = |window: &HeadlessWindow| {
        let session: &Session = window.session();
        (session.work().is_some(), session.transition().is_some())
    };
    while state(&reopened) == (true, false) {
        std::thread::sleep(Duration::from_millis(1));
        reopened.update();
    }
    assert_eq!(state(&reopened), (true, true), "it is still being built");
    assert_eq!(method(&reopened), Some(TransitionMethod::FIELD_BLEND));
    let requested = reopened
        .session()
        .project()
        .map(|p| p.options.arap.subdivisions);
    assert_eq!(requested, Some(5));
    // A change of style does not restart the build, which can still be cancelled.
    let mut restyled = reopened.session().project().cloned().expect("a project");
    restyled.style.joints = !restyled.style.joints;
    reopened.send(Intent::ReplaceSettings(Box::new(restyled)));
    reopened.send(Intent::CancelWork);
    assert_eq!(state(&reopened), (false, true));
    let current = reopened
        .session()
        .project()
        .and_then(|p| Some((p.warp?, p.content?)));
    let field = TransitionMethod::FIELD_BLEND;
    assert_eq!(current, Some((field.warp(), field.content())));
}

/// SVG path data of a star with the given number of tips and inner radius; the outer radius is 45.
fn star(tips: u32, inner: f64) -> String {
    let corner = |k: u32| {
        let radius = if k.is_multiple_of(2) { 45.0 } else { inner };
        let p = DVec2::from_angle(f64::from(k) * std::f64::consts::PI / f64::from(tips)) * radius;
        format!("L{} {}", 50.0 + p.x, 50.0 + p.y)
    };
    let corners: String = (0..2 * tips).map(corner).collect();
    format!("M{}Z", &corners[1..])
}

/// Quality with which the film on the stage was built.
fn staged_quality(window: &HeadlessWindow) -> Option<BuildQuality> {
    let settings = window.session().staged_settings();
    settings.map(|settings| settings.options.quality)
}

/// A window that shows a draft on the stage while the final film is built.
fn with_draft(folder: &Path) -> HeadlessWindow {
    let source = write_outline(folder, "source.svg", &star(11, 10.0));
    let target = write_outline(folder, "target.svg", &star(4, 30.0));
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(vec![source, target]));
    while staged_quality(&window) != Some(BuildQuality::Draft) {
        assert!(
            window.session().work().is_some(),
            "the build ended without a draft"
        );
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window
}

#[test]
fn a_draft_plays_until_the_final_film_replaces_it_at_an_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_draft(folder.path());
    // The progress of a build is shown only once the build has run for a while. The draft may be
    // on the stage before that.
    wait_for_shown_work(&mut window);
    let stage = window.session().visible_work().map(|(stage, _)| stage);
    assert_eq!(stage, Some("Improving film"));
    let requested = window.session().project().map(|p| p.options.quality);
    assert_eq!(
        requested,
        Some(BuildQuality::Best),
        "the requested quality is unchanged"
    );
    window.send(Intent::TogglePlay);
    while staged_quality(&window) == Some(BuildQuality::Draft) {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    let (t, is_playing) = (window.t(), window.playback().is_playing());
    assert!(
        !is_playing || !(0.04..=0.96).contains(&t),
        "replaced visibly at t = {t}"
    );
    assert_eq!(window.problems(), Vec::<String>::new());
    assert!(!window.session().is_dirty());
}

#[test]
fn cancelling_the_improvement_keeps_the_draft() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_draft(folder.path());
    window.send(Intent::CancelWork);
    assert!(window.session().work().is_none() && window.session().transition().is_some());
    let settings = window.session().project().map(|p| p.options.quality);
    assert_eq!(settings, Some(BuildQuality::Draft), "the setting follows");
}

/// Updates the window until it shows the work in progress.
fn wait_for_shown_work(window: &mut HeadlessWindow) {
    while window.session().visible_work().is_none() {
        assert!(
            window.session().work().is_some(),
            "the work ended before it was shown"
        );
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
}

#[test]
fn a_refused_long_build_starts_on_request_and_escape_cancels_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| {
        let field = TransitionMethod::FIELD_BLEND;
        (project.warp, project.content) = (Some(field.warp()), Some(field.content()));
    });
    assert_eq!(method(&window), Some(TransitionMethod::FIELD_BLEND));
    let cells = |window: &HeadlessWindow| window.session().project().map(|p| p.options.field.cells);
    let before = cells(&window);
    edit(&mut window, |project| project.options.field.cells = 4000);
    let problems = window.problems();
    assert!(problems[0].contains("choose fewer cells"), "{problems:?}");
    window.send(Intent::BuildAnyway);
    wait_for_shown_work(&mut window);
    window.press(KeyCode::Escape, Key::Escape);
    assert_eq!(window.session().work(), None);
    assert_eq!(cells(&window), before);
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn a_build_refused_on_opening_starts_on_request() {
    let folder = tempfile::tempdir().expect("a folder");
    // The two designs have 2,000 parts, so the match starts only once the user has confirmed it.
    let squares = |name: &str, side: f64| {
        let square = |k: usize| {
            let [x, y] = [k % 40, k / 40].map(|c| c * 10);
            format!("M{x},{y}h{side}v{side}h-{side}z")
        };
        let all: String = (0..1000).map(square).collect();
        let path = folder.path().join(name);
        let svg = format!(r#"<svg xmlns="http://www.w3.org/2000/svg"><path d="{all}"/></svg>"#);
        std::fs::write(&path, svg).expect("a file");
        path
    };
    let files = vec![squares("a.svg", 4.0), squares("b.svg", 6.0)];
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(files));
    window.wait();
    let problems = window.problems();
    assert!(problems[0].contains("2000 parts"), "{problems:?}");
    assert_eq!(
        method(&window),
        Some(TransitionMethod::FIELD_BLEND),
        "the fallback is on the stage"
    );
    window.send(Intent::BuildAnyway);
    wait_for_shown_work(&mut window);
    window.press(KeyCode::Escape, Key::Escape);
    let requested = window
        .session()
        .project()
        .and_then(|p| p.warp.zip(p.content));
    let shown = (
        TransitionMethod::FIELD_BLEND.warp(),
        TransitionMethod::FIELD_BLEND.content(),
    );
    assert_eq!(
        requested,
        Some(shown),
        "the settings are those of the stage"
    );
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn measuring_can_be_cancelled_and_restarted() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    // The mesh has 16,000 faces, which take many seconds to measure.
    edit(&mut window, |project| project.options.arap.subdivisions = 4);
    let state = |window: &HeadlessWindow| {
        let measured: &StageMeasures = window.0.world().resource();
        (
            measured.visible_progress().is_some(),
            measured.was_stopped(),
        )
    };
    while state(&window) != (true, false) {
        let measures: &StageMeasures = window.0.world().resource();
        assert!(
            measures.measures().is_none(),
            "measured before it was shown"
        );
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.press(KeyCode::Escape, Key::Escape);
    assert_eq!(state(&window), (false, true));
    // Cancelled measuring does not restart by itself.
    window.update();
    assert_eq!(state(&window), (false, true));
    window.send(Intent::MeasureAgain);
    window.update();
    let measures: &StageMeasures = window.0.world().resource();
    assert!(measures.is_busy() && !measures.was_stopped());
}
