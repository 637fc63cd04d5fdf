//! What goes wrong is told, with a way on, and no longer than it is wrong.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bevy::input::keyboard::{Key, KeyCode};
use morphospace::app::{
    CaptureFolder, FilmExportOptions, FilmExporter, Intent, Preferences, Session, StageMeasures,
    UnsavedAnswer, UnsavedQuestion,
};
use morphospace::correspondence::PointPair;
use morphospace::export::{Aspect, PictureLayout};
use morphospace::geometry::DVec2;
use morphospace::project::Project;
use morphospace::transition::{BuildQuality, TransitionMethod};

use crate::window::Window;

const SQUARE: &str = "M10 10 H90 V90 H10 Z";
const TALL_L: &str = "M10 5 H30 V70 H80 V95 H10 Z";

fn write_outline(folder: &Path, name: &str, d: &str) -> PathBuf {
    let path = folder.join(name);
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><path d="{d}"/></svg>"#
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

fn with_outlines(folder: &Path) -> Window {
    with_pair(folder, SQUARE, TALL_L)
}

fn with_pair(folder: &Path, source: &str, target: &str) -> Window {
    let source = write_outline(folder, "source.svg", source);
    let target = write_outline(folder, "target.svg", target);
    let mut window = Window::new();
    window.send(Intent::Open(vec![source, target]));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    window
}

/// The open project, changed.
fn edit(window: &mut Window, change: impl FnOnce(&mut Project)) {
    let mut project = window.session().project().cloned().expect("a project");
    change(&mut project);
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
}

/// Three corners of the square, of which two have changed places.
fn cross_pins(project: &mut Project) {
    let pin = |[a, b]: [[f64; 2]; 2]| PointPair {
        source: DVec2::from(a),
        target: DVec2::from(b),
    };
    // SVG files have y down, the project up.
    project.options.matching.pins = [
        [[10.0, 90.0], [10.0, 95.0]],
        [[90.0, 90.0], [80.0, 5.0]],
        [[90.0, 10.0], [30.0, 95.0]],
    ]
    .map(pin)
    .into();
}

fn cell(window: &Window) -> Option<TransitionMethod> {
    window.session().transition().map(|t| t.cell())
}

#[test]
fn a_problem_goes_with_its_cause() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, cross_pins);
    assert_eq!(window.problems().len(), 1, "{:?}", window.problems());
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new(), "taken back");
    window.send(Intent::Redo);
    window.wait();
    assert_eq!(window.problems().len(), 1);
    let field = TransitionMethod::FIELD_BLEND;
    window.send(Intent::UseCell(field.warp(), field.content()));
    window.wait();
    assert_eq!(cell(&window), Some(field));
    assert_eq!(window.problems(), Vec::<String>::new(), "another method");
    window.send(Intent::Open(vec!["/nowhere/at-all.morph".into()]));
    window.send(Intent::Answer(UnsavedAnswer::Discard));
    window.wait();
    assert_eq!(window.problems().len(), 1);
    let dissolved = TransitionMethod::all()
        .find(|cell| *cell != field)
        .expect("another");
    window.send(Intent::UseCell(dissolved.warp(), dissolved.content()));
    window.send(Intent::UseCell(field.warp(), field.content()));
    window.wait();
}

fn record(window: &mut Window, folder: PathBuf) {
    window.0.insert_resource(CaptureFolder(folder));
    window.send(Intent::Record);
    while window.0.world().resource::<FilmExporter>().work().is_some() {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.update();
}

#[test]
fn a_film_that_is_written_takes_back_that_one_was_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| project.timing.duration_secs = 0.1);
    let file = folder.path().join("source.svg");
    record(&mut window, file.join("below"));
    assert_eq!(window.problems().len(), 1);
    record(&mut window, folder.path().join("films"));
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn a_film_has_the_shape_that_was_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| project.timing.duration_secs = 0.1);
    let layout = PictureLayout {
        aspect: Aspect::Tall,
        lines: 90,
        ..PictureLayout::default()
    };
    window.send(Intent::Prefer(Preferences {
        film: FilmExportOptions {
            layout,
            ..Default::default()
        },
        film_options: true,
        ..Preferences::default()
    }));
    let films = folder.path().join("films");
    record(&mut window, films.clone());
    let written = std::fs::read_dir(films).expect("a folder").next();
    let file = File::open(written.expect("a film").expect("readable").path());
    let film = gif::Decoder::new(file.expect("a film")).expect("a GIF");
    assert_eq!((film.width(), film.height()), (90, 160));
    // Esc goes back to the options of the transition.
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!window.0.world().resource::<Preferences>().film_options);
}

#[test]
fn not_saving_before_another_project_opens_leaves_a_film_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| project.timing.duration_secs = 600.0);
    window
        .0
        .insert_resource(CaptureFolder(folder.path().join("films")));
    window.send(Intent::Record);
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
    window.send(Intent::Answer(UnsavedAnswer::Discard));
    window.wait();
    assert!(!window.session().is_dirty());
    let is_recording =
        |window: &Window| window.0.world().resource::<FilmExporter>().work().is_some();
    for _ in 0..20 {
        std::thread::sleep(Duration::from_millis(5));
        window.update();
    }
    assert!(is_recording(&window));
    // Closing asks about it, and waits until what was begun is taken away.
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
    assert!(is_recording(&window) && window.0.should_exit().is_none());
    window.send(Intent::Close);
    window.send(Intent::Answer(UnsavedAnswer::Discard));
    while window.0.should_exit().is_none() {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    let films = std::fs::read_dir(folder.path().join("films")).expect("a folder");
    assert_eq!(films.count(), 0);
}

#[test]
fn a_method_that_cannot_be_had_is_replaced_by_one_that_can() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    let asked = cell(&window);
    edit(&mut window, cross_pins);
    let path = folder.path().join("crossed.morph");
    window.send(Intent::SaveTo(path.clone()));
    let mut again = Window::new();
    again.send(Intent::Open(vec![path]));
    again.wait();
    assert_eq!(cell(&again), Some(TransitionMethod::FIELD_BLEND));
    let [problem] = &again.problems()[..] else {
        panic!("one problem");
    };
    assert!(problem.contains("pin") && problem.contains(TransitionMethod::FIELD_BLEND.name()));
    assert!(!again.session().is_dirty(), "the document is as it was");
    edit(&mut again, |project| {
        project.options.matching.pins.clear();
    });
    assert_eq!(cell(&again), asked);
    assert_eq!(again.problems(), Vec::<String>::new());
}

#[test]
fn what_takes_long_to_open_is_shown_by_the_plainest_method_meanwhile() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_pair(folder.path(), &star(11, 10.0), &star(4, 30.0));
    let mut project = window.session().project().cloned().expect("a project");
    // Almost 400,000 triangles, which is not much less than what is refused.
    project.options.arap.subdivisions = 5;
    window.send(Intent::Edit(Box::new(project.clone())));
    let path = folder.path().join("fine.morph");
    window.send(Intent::SaveTo(path.clone()));
    drop(window);
    let mut again = Window::new();
    again.send(Intent::Open(vec![path]));
    let session = |window: &Window| {
        let session: &Session = window.session();
        (session.work().is_some(), session.transition().is_some())
    };
    while session(&again) == (true, false) {
        std::thread::sleep(Duration::from_millis(1));
        again.update();
    }
    assert_eq!(session(&again), (true, true), "it is still being built");
    assert_eq!(cell(&again), Some(TransitionMethod::FIELD_BLEND));
    let asked = again
        .session()
        .project()
        .map(|p| p.options.arap.subdivisions);
    assert_eq!(asked, Some(5));
    // What is painted is no other film: the work goes on.
    let mut painted = again.session().project().cloned().expect("a project");
    painted.style.joints = !painted.style.joints;
    again.send(Intent::Edit(Box::new(painted)));
    again.send(Intent::CancelWork);
    assert_eq!(session(&again), (false, true));
    let now = again
        .session()
        .project()
        .and_then(|p| Some((p.warp?, p.content?)));
    let field = TransitionMethod::FIELD_BLEND;
    assert_eq!(now, Some((field.warp(), field.content())));
}

/// A star of so many tips, thin or thick.
fn star(tips: u32, inner: f64) -> String {
    let corner = |k: u32| {
        let far = if k.is_multiple_of(2) { 45.0 } else { inner };
        let p = DVec2::from_angle(f64::from(k) * std::f64::consts::PI / f64::from(tips)) * far;
        format!("L{} {}", 50.0 + p.x, 50.0 + p.y)
    };
    let corners: String = (0..2 * tips).map(corner).collect();
    format!("M{}Z", &corners[1..])
}

fn staged(window: &Window) -> Option<BuildQuality> {
    let settings = window.session().staged_settings();
    settings.map(|settings| settings.options.quality)
}

/// A window with a draft on its stage, while a better film is made.
fn with_draft(folder: &Path) -> Window {
    let source = write_outline(folder, "source.svg", &star(11, 10.0));
    let target = write_outline(folder, "target.svg", &star(4, 30.0));
    let mut window = Window::new();
    window.send(Intent::Open(vec![source, target]));
    while staged(&window) != Some(BuildQuality::Draft) {
        assert!(window.session().work().is_some(), "there was no draft");
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window
}

#[test]
fn a_draft_plays_until_a_better_film_takes_its_place_unseen() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_draft(folder.path());
    // The draft may be there sooner than a word is worth its while.
    wait_for_word(&mut window);
    let told = window.session().told_work().map(|(stage, _)| stage);
    assert_eq!(told, Some("improving the film"));
    let asked = window.session().project().map(|p| p.options.quality);
    assert_eq!(asked, Some(BuildQuality::Best), "what is asked for stays");
    window.send(Intent::TogglePlay);
    while staged(&window) == Some(BuildQuality::Draft) {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    let (t, is_playing) = (window.t(), window.playback().is_playing());
    assert!(!is_playing || !(0.04..=0.96).contains(&t), "seen at {t}");
    assert_eq!(window.problems(), Vec::<String>::new());
    assert!(!window.session().is_dirty());
}

#[test]
fn a_draft_that_is_good_enough_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_draft(folder.path());
    window.send(Intent::CancelWork);
    assert!(window.session().work().is_none() && window.session().transition().is_some());
    let settings = window.session().project().map(|p| p.options.quality);
    assert_eq!(settings, Some(BuildQuality::Draft), "and says so");
}

/// Until the work is worth a word.
fn wait_for_word(window: &mut Window) {
    while window.session().told_work().is_none() {
        assert!(window.session().work().is_some(), "nothing is begun");
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
}

#[test]
fn what_takes_very_long_is_begun_when_it_is_wanted_all_the_same_and_esc_ends_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    edit(&mut window, |project| {
        let field = TransitionMethod::FIELD_BLEND;
        (project.warp, project.content) = (Some(field.warp()), Some(field.content()));
    });
    assert_eq!(cell(&window), Some(TransitionMethod::FIELD_BLEND));
    let cells = |window: &Window| window.session().project().map(|p| p.options.field.cells);
    let before = cells(&window);
    edit(&mut window, |project| project.options.field.cells = 4000);
    let problems = window.problems();
    assert!(problems[0].contains("choose fewer cells"), "{problems:?}");
    window.send(Intent::Insist);
    wait_for_word(&mut window);
    window.press(KeyCode::Escape, Key::Escape);
    assert_eq!(window.session().work(), None);
    assert_eq!(cells(&window), before);
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn what_was_refused_as_it_was_opened_is_built_when_it_is_wanted_all_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    // More pieces than are matched unasked.
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
    let mut window = Window::new();
    window.send(Intent::Open(files));
    window.wait();
    let problems = window.problems();
    assert!(problems[0].contains("2000 outlines"), "{problems:?}");
    assert_eq!(
        cell(&window),
        Some(TransitionMethod::FIELD_BLEND),
        "what is shown"
    );
    window.send(Intent::Insist);
    wait_for_word(&mut window);
    window.press(KeyCode::Escape, Key::Escape);
    let asked = window
        .session()
        .project()
        .and_then(|p| p.warp.zip(p.content));
    let shown = (
        TransitionMethod::FIELD_BLEND.warp(),
        TransitionMethod::FIELD_BLEND.content(),
    );
    assert_eq!(asked, Some(shown), "the panel says what is shown");
    assert_eq!(window.problems(), Vec::<String>::new());
}

#[test]
fn measuring_is_stopped_and_taken_up_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path());
    // 16,000 faces, whose measures take many seconds.
    edit(&mut window, |project| project.options.arap.subdivisions = 4);
    let measured = |window: &Window| {
        let measured: &StageMeasures = window.0.world().resource();
        (measured.told().is_some(), measured.is_broken_off())
    };
    while measured(&window) != (true, false) {
        let found: &StageMeasures = window.0.world().resource();
        assert!(found.measures().is_none(), "measured too soon");
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.press(KeyCode::Escape, Key::Escape);
    assert_eq!(measured(&window), (false, true));
    // It is not begun again by itself.
    window.update();
    assert_eq!(measured(&window), (false, true));
    window.send(Intent::Measure);
    window.update();
    let again: &StageMeasures = window.0.world().resource();
    assert!(again.is_busy() && !again.is_broken_off());
}
