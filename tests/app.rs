//! The window's systems without a window: injected keys, intents, and what comes of them.
#![cfg(feature = "app")]

use std::path::Path;
use std::time::Duration;

use bevy::input::keyboard::{Key, KeyCode, KeyboardInput};
use bevy::input::{ButtonState, InputPlugin};
use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy::window::{FileDragAndDrop, WindowCloseRequested};
use morphospace::app::{
    Answer, Editor, EditorAct, Handle, Intent, Kind, LogicPlugin, Measured, Notices, OnStage,
    OnTwin, Playback, Preferences, Question, Session, Sheet, Tool, Touch, Twin, TwinMethod, Typing,
};
use morphospace::content::{Content, ContentKind};
use morphospace::correspondence::Matching;
use morphospace::geometry::{DVec2, Side};
use morphospace::project::gallery;
use morphospace::stage::{Blend, MorphPlugin, StageTransition};
use morphospace::transition::{Cell, PlayMode};

const FRAME: Duration = Duration::from_millis(20);

struct Window(App);

impl Window {
    fn new() -> Self {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin, MorphPlugin, LogicPlugin));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        app.update();
        Self(app)
    }

    fn with_gallery() -> Self {
        let mut window = Self::new();
        let name = entries().remove(0);
        window.send(Intent::OpenGallery(name));
        window.wait();
        assert!(
            window.session().transition().is_some(),
            "{:?}",
            window.problems()
        );
        window
    }

    fn update(&mut self) {
        self.0.update();
    }

    fn wait(&mut self) {
        self.update();
        while self.session().work().is_some() {
            std::thread::sleep(Duration::from_millis(1));
            self.update();
        }
        self.update();
    }

    fn send(&mut self, intent: Intent) {
        self.0.world_mut().write_message(intent);
        self.update();
    }

    fn session(&self) -> &Session {
        self.0.world().resource()
    }

    fn playback(&self) -> &Playback {
        self.0.world().resource()
    }

    fn t(&self) -> f64 {
        self.playback().t()
    }

    fn preferences(&self) -> &Preferences {
        self.0.world().resource()
    }

    fn problems(&self) -> Vec<String> {
        let notices = self.0.world().resource::<Notices>().list();
        notices
            .iter()
            .filter(|n| n.kind == Kind::Problem)
            .map(|n| n.text.clone())
            .collect()
    }

    fn key(&mut self, state: ButtonState, key_code: KeyCode, logical_key: Key, repeat: bool) {
        let input = KeyboardInput {
            key_code,
            logical_key,
            state,
            text: None,
            repeat,
            window: Entity::PLACEHOLDER,
        };
        self.0.world_mut().write_message(input);
        self.update();
    }

    fn press(&mut self, code: KeyCode, key: Key) {
        self.key(ButtonState::Pressed, code, key.clone(), false);
        self.key(ButtonState::Released, code, key, false);
    }

    fn type_char(&mut self, code: KeyCode, text: &str) {
        self.press(code, Key::Character(text.into()));
    }

    fn hold(&mut self, code: KeyCode, key: Key, then: impl FnOnce(&mut Self)) {
        self.key(ButtonState::Pressed, code, key.clone(), false);
        then(self);
        self.key(ButtonState::Released, code, key, false);
    }

    fn editor(&self) -> &Editor {
        self.0.world().resource()
    }

    fn sheet(&self) -> &Sheet {
        self.0.world().resource()
    }

    fn matching(&self) -> Matching {
        let project = self.session().project().expect("a project");
        project.options.matching.clone()
    }

    fn act(&mut self, act: EditorAct) {
        self.send(Intent::Editor(act));
    }

    fn messages(&self) -> Vec<Intent> {
        let messages = self.0.world().resource::<Messages<Intent>>();
        messages.get_cursor().read(messages).cloned().collect()
    }
}

fn entries() -> Vec<String> {
    gallery::list()
        .expect("a gallery")
        .into_iter()
        .map(|entry| entry.name)
        .collect()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn space_plays_and_pauses() {
    let mut window = Window::with_gallery();
    window.press(KeyCode::Space, Key::Space);
    assert!(window.playback().is_playing());
    for _ in 0..60 {
        window.update();
    }
    assert!(window.t() > 0.0);
    window.press(KeyCode::Space, Key::Space);
    let t = window.t();
    window.update();
    assert_eq!(window.t(), t);
}

#[test]
fn arrows_step_and_repeat_and_shift_makes_ten_of_one() {
    let mut window = Window::with_gallery();
    window.press(KeyCode::ArrowRight, Key::ArrowRight);
    assert!(close(window.t(), 0.01));
    window.key(
        ButtonState::Pressed,
        KeyCode::ArrowRight,
        Key::ArrowRight,
        true,
    );
    assert!(close(window.t(), 0.02));
    window.press(KeyCode::ArrowLeft, Key::ArrowLeft);
    window.hold(KeyCode::ShiftLeft, Key::Shift, |window| {
        window.press(KeyCode::ArrowLeft, Key::ArrowLeft);
    });
    assert!(close(window.t(), -0.09));
}

#[test]
fn home_and_end_go_to_the_ends() {
    let mut window = Window::with_gallery();
    window.press(KeyCode::End, Key::End);
    assert_eq!(window.t(), window.session().timing().to);
    window.press(KeyCode::Home, Key::Home);
    assert_eq!(window.t(), window.session().timing().from);
}

#[test]
fn digits_go_by_their_place_and_signs_by_what_they_print() {
    let mut window = Window::with_gallery();
    // A French keyboard prints & on the key of the 1.
    window.type_char(KeyCode::Digit1, "&");
    assert!(close(window.t(), 0.1));
    // A German keyboard prints [ with AltGr on the key of the 8.
    window.type_char(KeyCode::Digit8, "[");
    assert!(close(window.t(), 0.1));
    assert!(window.playback().speed() < 1.0);
    window.type_char(KeyCode::BracketRight, "]");
    assert_eq!(window.playback().speed(), 1.0);
    // A Dvorak keyboard prints s where a US keyboard has the semicolon.
    window.type_char(KeyCode::Semicolon, "s");
    assert!(
        window
            .messages()
            .contains(&Intent::Screenshot { with_panels: false })
    );
}

#[test]
fn backspace_is_speed_one_and_r_turns_round() {
    let mut window = Window::with_gallery();
    window.type_char(KeyCode::BracketRight, "]");
    window.press(KeyCode::Backspace, Key::Backspace);
    assert_eq!(window.playback().speed(), 1.0);
    window.type_char(KeyCode::KeyR, "r");
    assert!(window.playback().is_backwards());
}

#[test]
fn l_goes_through_the_play_modes() {
    let mut window = Window::with_gallery();
    let mut seen = vec![window.session().timing().play];
    for _ in 0..3 {
        window.type_char(KeyCode::KeyL, "l");
        seen.push(window.session().timing().play);
    }
    assert_eq!(seen[0], seen[3]);
    for mode in [PlayMode::Once, PlayMode::Loop, PlayMode::PingPong] {
        assert!(seen.contains(&mode));
    }
}

#[test]
fn stops_are_set_jumped_to_and_played_to() {
    let mut window = Window::with_gallery();
    let before = window.session().stops().len();
    window.send(Intent::Seek(0.437));
    window.type_char(KeyCode::KeyM, "m");
    window.type_char(KeyCode::KeyM, "m");
    assert_eq!(
        window.session().stops().len(),
        before + 1,
        "one stop at one place"
    );
    window.press(KeyCode::Home, Key::Home);
    window.press(KeyCode::ArrowUp, Key::ArrowUp);
    let first = window.t();
    assert!(first > window.session().timing().from);
    window.press(KeyCode::ArrowDown, Key::ArrowDown);
    assert_eq!(window.t(), window.session().timing().from);
    window.press(KeyCode::PageDown, Key::PageDown);
    assert!(window.playback().is_playing(), "played, not jumped");
    assert!(window.t() < first);
    while window.playback().is_playing() {
        window.update();
    }
    assert_eq!(window.t(), first, "waits exactly at the stop");
    window.press(KeyCode::PageUp, Key::PageUp);
    while window.playback().is_playing() {
        window.update();
    }
    assert_eq!(window.t(), window.session().timing().from);
}

#[test]
fn no_key_acts_while_text_is_written() {
    let mut window = Window::with_gallery();
    window.0.insert_resource(Typing(true));
    window.press(KeyCode::Space, Key::Space);
    window.type_char(KeyCode::Digit5, "5");
    window.type_char(KeyCode::KeyS, "s");
    assert!(!window.playback().is_playing());
    assert_eq!(window.t(), window.session().timing().from);
    assert!(window.messages().is_empty());
    window.0.insert_resource(Typing(false));
    window.update();
    assert_eq!(
        window.t(),
        window.session().timing().from,
        "nothing is made up for"
    );
}

#[test]
fn shift_and_control_tell_the_meanings_of_s_apart() {
    let mut window = Window::with_gallery();
    window.hold(KeyCode::ShiftRight, Key::Shift, |window| {
        window.type_char(KeyCode::KeyS, "S");
        assert!(
            window
                .messages()
                .contains(&Intent::Screenshot { with_panels: true })
        );
    });
    window.update();
    window.update();
    window.hold(KeyCode::ControlLeft, Key::Control, |window| {
        window.type_char(KeyCode::KeyS, "s");
        assert!(window.messages().contains(&Intent::Save));
        assert!(
            !window
                .messages()
                .contains(&Intent::Screenshot { with_panels: false })
        );
    });
}

#[test]
fn escape_goes_back_step_by_step() {
    let mut window = Window::with_gallery();
    window.type_char(KeyCode::KeyH, "h");
    window.press(KeyCode::F1, Key::F1);
    assert!(!window.preferences().panels && window.preferences().help);
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!window.preferences().panels && !window.preferences().help);
    window.press(KeyCode::Escape, Key::Escape);
    assert!(window.preferences().panels);
    window.type_char(KeyCode::Minus, "?");
    assert!(window.preferences().help);
}

#[test]
fn tab_takes_the_next_method_that_can_be_had() {
    let mut window = Window::with_gallery();
    let cell = |window: &Window| window.session().transition().map(|t| t.cell());
    let first = cell(&window);
    let mut seen = vec![first];
    loop {
        window.press(KeyCode::Tab, Key::Tab);
        window.wait();
        let next = cell(&window);
        if next == first {
            break;
        }
        assert!(!seen.contains(&next), "a method comes twice");
        seen.push(next);
    }
    // Two outlines have no colours; everything else can be had.
    let can = |cell: &Cell| cell.content() != ContentKind::Colours;
    assert_eq!(seen.len(), Cell::all().filter(can).count());
}

#[test]
fn what_is_opened_is_on_the_stage_at_t() {
    let mut window = Window::with_gallery();
    window.send(Intent::Seek(0.25));
    let world = window.0.world_mut();
    let mut staged = world.query_filtered::<(&StageTransition, &Blend), With<OnStage>>();
    let (_, blend) = staged.single(world).expect("one entity on the stage");
    assert_eq!(blend.t, 0.25);
}

#[test]
fn every_gallery_project_opens() {
    let mut window = Window::new();
    for name in entries()
        .into_iter()
        .filter(|name| !name.contains("stress"))
    {
        window.send(Intent::OpenGallery(name.clone()));
        window.wait();
        assert_eq!(window.session().gallery_name(), Some(name.as_str()));
        assert!(
            window.session().transition().is_some(),
            "{name}: {:?}",
            window.problems()
        );
    }
}

#[test]
fn a_file_that_is_none_is_said_and_the_open_project_stays() {
    let mut window = Window::with_gallery();
    let title = window.session().title();
    window.send(Intent::Open(vec!["/nowhere/at-all.morph".into()]));
    window.wait();
    assert!(
        window.problems()[0].contains("at-all.morph"),
        "{:?}",
        window.problems()
    );
    assert_eq!(window.session().title(), title);
    assert!(window.session().transition().is_some());
}

#[test]
fn a_design_that_cannot_be_read_is_not_kept() {
    let mut window = Window::with_gallery();
    let before = window.session().project().cloned();
    window.send(Intent::ReplaceDesign(1, "/nowhere/at-all.svg".into()));
    window.wait();
    assert!(!window.problems().is_empty());
    assert_eq!(window.session().project().cloned(), before);
}

#[test]
fn closing_asks_about_changes_and_only_then() {
    let mut window = Window::with_gallery();
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    assert!(window.session().is_dirty());
    let request = WindowCloseRequested {
        window: Entity::PLACEHOLDER,
    };
    window.0.world_mut().write_message(request.clone());
    window.update();
    window.update();
    assert!(window.0.world().resource::<Question>().text().is_some());
    assert!(window.0.should_exit().is_none());
    window.send(Intent::Answer(Answer::Stay));
    assert!(window.0.world().resource::<Question>().text().is_none());
    assert!(window.session().is_dirty());
    window.0.world_mut().write_message(request);
    window.update();
    window.update();
    window.send(Intent::Answer(Answer::Discard));
    window.update();
    assert!(window.0.should_exit().is_some());
}

#[test]
fn opening_something_else_asks_about_changes() {
    let mut window = Window::with_gallery();
    let title = window.session().title();
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    let other = entries().pop().expect("a gallery");
    window.send(Intent::OpenGallery(other));
    window.wait();
    assert_eq!(window.session().title(), title);
    assert!(window.0.world().resource::<Question>().text().is_some());
}

#[test]
fn what_is_saved_is_what_is_opened_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("saved.morph");
    let mut window = Window::with_gallery();
    window.send(Intent::Seek(0.3));
    window.send(Intent::AddStop);
    window.send(Intent::SaveTo(path.clone()));
    assert!(!window.session().is_dirty());
    assert_eq!(window.session().path(), Some(Path::new(&path)));
    let stops = window.session().stops().to_vec();
    let mut again = Window::new();
    again.send(Intent::Open(vec![path]));
    again.wait();
    assert_eq!(again.problems(), Vec::<String>::new());
    assert_eq!(again.session().stops(), stops);
    assert!(again.session().transition().is_some());
}

#[test]
fn settings_that_change_while_a_build_runs_are_built_too() {
    let mut window = Window::with_gallery();
    window.send(Intent::NextMethod);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.arap.subdivisions = 1;
    project.options.field.cells = 96;
    window.send(Intent::Edit(Box::new(project.clone())));
    window.wait();
    window.wait();
    assert_eq!(window.session().project(), Some(&project));
    let transition = window.session().transition().expect("a transition");
    let shown = (
        Some(transition.cell().warp()),
        Some(transition.cell().content()),
    );
    assert_eq!(shown, (project.warp, project.content));
}

#[test]
fn parts_that_carry_fields_can_turn_on_their_own() {
    let mut window = Window::new();
    window.send(Intent::OpenGallery("letters-carried".to_owned()));
    window.wait();
    let transition = window.session().transition().expect("a transition");
    assert!(matches!(transition.content(), Content::Field(_)));
    assert!(window.session().parts() > 0, "the panel has turns to offer");
}

#[test]
fn work_that_is_cancelled_takes_its_settings_back() {
    let mut window = Window::with_gallery();
    let before = window.session().project().cloned();
    window.send(Intent::NextMethod);
    window.send(Intent::CancelWork);
    if window.session().work().is_none() {
        window.wait();
    }
    let after = window.session().project().cloned();
    let transition = window.session().transition().expect("a transition");
    let shown = (
        Some(transition.cell().warp()),
        Some(transition.cell().content()),
    );
    assert_eq!(
        after.as_ref().map(|p| (p.warp, p.content)),
        Some(shown),
        "stage and panel agree"
    );
    assert!(after == before || window.session().is_dirty());
}

fn drop_files(window: &mut Window, paths: &[&Path]) {
    for path in paths {
        window
            .0
            .world_mut()
            .write_message(FileDragAndDrop::DroppedFile {
                window: Entity::PLACEHOLDER,
                path_buf: path.to_path_buf(),
            });
        window.update();
    }
    for _ in 0..20 {
        window.update();
    }
    window.wait();
}

fn write_square(folder: &Path, name: &str, side: u32) -> std::path::PathBuf {
    let path = folder.join(name);
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><rect width="{side}" height="{side}"/></svg>"#
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

#[test]
fn two_files_that_are_dropped_are_a_pair_and_one_is_asked_about() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = write_square(folder.path(), "small.svg", 30);
    let large = write_square(folder.path(), "large.svg", 80);
    let mut window = Window::with_gallery();
    drop_files(&mut window, &[&small, &large]);
    assert_eq!(window.problems(), Vec::<String>::new());
    let names = |window: &Window| {
        let designs = window.session().transition().map(|t| t.designs().clone());
        designs.map(|[a, b]| [a.name.clone(), b.name.clone()])
    };
    assert_eq!(
        names(&window),
        Some(["small".to_owned(), "large".to_owned()])
    );
    drop_files(&mut window, &[&small]);
    assert_eq!(
        names(&window),
        Some(["small".to_owned(), "large".to_owned()]),
        "asks first"
    );
    window.send(Intent::ReplaceDesign(1, small));
    window.wait();
    assert_eq!(
        names(&window),
        Some(["small".to_owned(), "small".to_owned()])
    );
    assert!(window.session().is_dirty());
}

#[test]
fn more_files_than_a_pair_are_refused() {
    let mut window = Window::with_gallery();
    let nowhere = Path::new("/nowhere/a.svg");
    drop_files(&mut window, &[nowhere, nowhere, nowhere]);
    assert_eq!(window.problems().len(), 1);
}

#[test]
fn a_changed_blend_is_shown_without_measuring_again() {
    let mut window = Window::with_gallery();
    while window.session().project().and_then(|p| p.content) != Some(ContentKind::Field) {
        window.send(Intent::NextMethod);
        window.wait();
    }
    let source = |window: &Window| match window.session().transition().map(|t| t.content()) {
        Some(Content::Field(pair)) => std::ptr::from_ref(pair.source()),
        _ => panic!("a field is on the stage"),
    };
    let before = source(&window);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.field.blend.threshold = 2.0;
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    assert_eq!(source(&window), before);
    let Some(Content::Field(pair)) = window.session().transition().map(|t| t.content()) else {
        panic!("a field is on the stage");
    };
    assert_eq!(pair.blend().threshold, 2.0);
}

#[test]
fn every_change_can_be_taken_back_and_made_again() {
    let mut window = Window::with_gallery();
    let before = window.session().project().cloned();
    window.type_char(KeyCode::KeyL, "l");
    window.send(Intent::Seek(0.437));
    window.type_char(KeyCode::KeyM, "m");
    let after = window.session().project().cloned();
    assert_ne!(before, after);
    let control = |window: &mut Window, code: KeyCode, key: &str| {
        window.hold(KeyCode::ControlLeft, Key::Control, |window| {
            window.type_char(code, key);
        });
        window.update();
    };
    control(&mut window, KeyCode::KeyZ, "z");
    assert_ne!(window.session().project().cloned(), before, "one at a time");
    control(&mut window, KeyCode::KeyZ, "z");
    assert_eq!(window.session().project().cloned(), before);
    assert!(!window.session().is_dirty());
    control(&mut window, KeyCode::KeyY, "y");
    window.hold(KeyCode::ShiftLeft, Key::Shift, |window| {
        control(window, KeyCode::KeyZ, "Z");
    });
    assert_eq!(window.session().project().cloned(), after);
    assert!(!window.session().can_redo());
}

#[test]
fn a_drag_is_one_step() {
    let mut window = Window::with_gallery();
    let before = window.session().project().cloned().expect("a project");
    let buttons = |window: &mut Window, down: bool| {
        let mut buttons = window
            .0
            .world_mut()
            .resource_mut::<ButtonInput<MouseButton>>();
        if down {
            buttons.press(MouseButton::Left);
        } else {
            buttons.release(MouseButton::Left);
        }
    };
    buttons(&mut window, true);
    let mut project = before.clone();
    for width in [0.02, 0.03, 0.04] {
        project.options.bar_width = width;
        window.send(Intent::Edit(Box::new(project.clone())));
    }
    buttons(&mut window, false);
    project.options.bar_width = 0.05;
    window.send(Intent::Edit(Box::new(project.clone())));
    window.send(Intent::Undo);
    assert_eq!(window.session().project(), Some(&before));
    window.send(Intent::Redo);
    assert_eq!(window.session().project(), Some(&project));
    window.wait();
}

#[test]
fn a_change_that_is_taken_back_is_on_the_stage_too() {
    let mut window = Window::with_gallery();
    let cell = |window: &Window| window.session().transition().map(|t| t.cell());
    let first = cell(&window);
    window.send(Intent::NextMethod);
    window.wait();
    assert_ne!(cell(&window), first);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(cell(&window), first);
}

#[test]
fn opening_forgets_what_could_be_taken_back_and_saving_does_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::with_gallery();
    window.send(Intent::CyclePlayMode);
    window.send(Intent::SaveTo(folder.path().join("one.morph")));
    assert!(window.session().can_undo());
    std::fs::create_dir(folder.path().join("in")).expect("a folder");
    window.send(Intent::SaveTo(folder.path().join("in").join("two.morph")));
    window.send(Intent::Undo);
    assert!(window.session().is_dirty());
    window.send(Intent::SaveTo(folder.path().join("in").join("three.morph")));
    let mut again = Window::new();
    again.send(Intent::Open(vec![
        folder.path().join("in").join("three.morph"),
    ]));
    again.wait();
    assert_eq!(again.problems(), Vec::<String>::new());
    assert!(again.session().transition().is_some(), "paths follow");
    window.send(Intent::OpenGallery(entries().remove(0)));
    window.wait();
    assert!(!window.session().can_undo());
}

/// An L and the same L stretched, as outlines; and two squares beside each other.
fn write_outline(folder: &Path, name: &str, d: &str) -> std::path::PathBuf {
    let path = folder.join(name);
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><path d="{d}"/></svg>"#
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

const L: &str = "M10 10 H40 V60 H90 V90 H10 Z";
const TALL_L: &str = "M10 5 H30 V70 H80 V95 H10 Z";
const TWO: &str = "M10 10 H40 V40 H10 Z M60 60 H90 V90 H60 Z";

fn with_outlines(folder: &Path, source: &str, target: &str) -> Window {
    let source = write_outline(folder, "source.svg", source);
    let target = write_outline(folder, "target.svg", target);
    let mut window = Window::new();
    window.send(Intent::Open(vec![source, target]));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    window.type_char(KeyCode::KeyE, "e");
    assert!(window.editor().is_open);
    assert!(!window.sheet().rings.is_empty());
    window
}

fn touch(side: Side, x: f64, y: f64) -> Touch {
    Touch {
        side,
        at: DVec2::new(x, y),
        reach: 3.0,
        is_free: false,
    }
}

/// The corner of the source's part that lies nearest to a point of the file.
fn corner(window: &Window, side: Side, near: DVec2) -> DVec2 {
    let sides = window.sheet().sides.as_ref().expect("outlines");
    let corners = sides[side].corners.iter().copied();
    corners
        .min_by(|a, b| a.distance(near).total_cmp(&b.distance(near)))
        .expect("a corner")
}

#[test]
fn meshes_and_trusses_have_no_match_to_edit() {
    let mut window = Window::with_gallery();
    if !window.session().can_match() {
        window.type_char(KeyCode::KeyE, "e");
        assert!(!window.editor().is_open);
    }
}

#[test]
fn the_match_editor_opens_and_escape_leaves_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let shown = window.sheet().features.len();
    assert!((4..=16).contains(&shown), "{shown}");
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!window.editor().is_open);
    assert!(window.preferences().panels);
}

#[test]
fn a_click_on_a_boundary_pins_it_where_it_is_matched() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let at = corner(&window, Side::Source, DVec2::new(100.0, 0.0));
    let place = window.sheet().partner(Side::Source, at).expect("a partner");
    // All features are handles: away from them a click sets a pin.
    let beside = at + DVec2::new(-12.0, 0.0);
    let on = window
        .sheet()
        .on_boundary(Side::Source, beside)
        .expect("a boundary");
    let mut hand = touch(Side::Source, on.point.x, on.point.y);
    hand.reach = 1.0;
    window.act(EditorAct::Click(hand));
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    assert_eq!(window.editor().selected, Some(Handle::Pin(0)));
    let pin = window.sheet().pins[0];
    assert!(pin.source.distance(on.point) < 1e-9);
    assert!(place.is_finite() && pin.target.is_finite());
    assert!(window.session().problem().is_none());
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.matching(), Matching::default());
    assert!(window.sheet().pins.is_empty());
}

#[test]
fn a_point_that_is_dragged_becomes_a_pin_that_snaps_and_is_honoured() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let from = window.sheet().features[0];
    let neighbour = |side: Side, p: DVec2| {
        let sides = window.sheet().sides.as_ref().expect("outlines");
        let others = sides[side].corners.iter().copied();
        others
            .filter(|corner| corner.distance(p) > 5.0)
            .min_by(|a, b| a.distance(p).total_cmp(&b.distance(p)))
            .expect("another corner")
    };
    let to = neighbour(Side::Target, from.target);
    let start = touch(Side::Target, from.target.x, from.target.y);
    let step = Vec2::new(3.0, 0.0);
    let before = window.session().project().cloned();
    let mut buttons = window
        .0
        .world_mut()
        .resource_mut::<ButtonInput<MouseButton>>();
    buttons.press(MouseButton::Left);
    window.act(EditorAct::Press(start));
    let halfway = from.target.lerp(to, 0.5);
    window.act(EditorAct::Drag(
        touch(Side::Target, halfway.x, halfway.y),
        step,
    ));
    let near = to + DVec2::new(1.0, 1.0);
    window.act(EditorAct::Drag(touch(Side::Target, near.x, near.y), step));
    window.act(EditorAct::Release);
    let mut buttons = window
        .0
        .world_mut()
        .resource_mut::<ButtonInput<MouseButton>>();
    buttons.release(MouseButton::Left);
    window.wait();
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    assert!(window.sheet().pins[0].target.distance(to) < 1e-9, "snapped");
    assert!(window.session().problem().is_none());
    let pin = window.sheet().pins[0];
    let honoured = window.sheet().partner(Side::Source, pin.source);
    assert!(honoured.is_some_and(|p| p.distance(pin.target) < 1e-6));
    window.send(Intent::Undo);
    assert_eq!(window.session().project().cloned(), before, "one step");
    window.wait();
}

#[test]
fn pins_that_cross_are_said_and_the_old_transition_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let places = window.sheet().features.clone();
    let [a, b, c] = [places[0], places[1], places[2]];
    let mut project = window.session().project().cloned().expect("a project");
    let by = window.sheet().by;
    let own = |source: DVec2, target: DVec2| morphospace::correspondence::PointPair {
        source: by[0].inverse().apply(source),
        target: by[1].inverse().apply(target),
    };
    project.options.matching.pins = vec![
        own(a.source, a.target),
        own(b.source, c.target),
        own(c.source, b.target),
    ];
    let stage = window
        .session()
        .transition()
        .map(|t| std::ptr::from_ref(t.content()));
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    let problem = window.session().problem().map(ToString::to_string);
    assert!(
        problem.as_ref().is_some_and(|p| p.contains("pins")),
        "{problem:?}"
    );
    assert!(window.problems().is_empty(), "the editor says it");
    let now = window
        .session()
        .transition()
        .map(|t| std::ptr::from_ref(t.content()));
    assert_eq!(stage, now);
    window.send(Intent::Undo);
    window.wait();
    assert!(window.session().problem().is_none());
}

#[test]
fn delete_and_backspace_take_the_chosen_pin_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    for (code, key) in [
        (KeyCode::Delete, Key::Delete),
        (KeyCode::Backspace, Key::Backspace),
    ] {
        let from = window.sheet().features[0];
        let hand = touch(Side::Source, from.source.x, from.source.y);
        window.act(EditorAct::Press(hand));
        window.act(EditorAct::Drag(hand, Vec2::new(1.0, 0.0)));
        window.act(EditorAct::Release);
        assert_eq!(window.matching().pins.len(), 1);
        window.send(Intent::Faster);
        let speed = window.playback().speed();
        window.press(code, key);
        assert!(window.matching().pins.is_empty());
        assert_eq!(window.playback().speed(), speed, "the key means this only");
    }
    window.wait();
}

#[test]
fn parts_are_paired_by_two_clicks_and_freed_by_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), TWO, TWO);
    let inside = |window: &Window, side: Side, part: usize| {
        let sides = window.sheet().sides.as_ref().expect("outlines");
        let ring = &sides[side].parts[part][0];
        ring.iter().sum::<DVec2>() / ring.len() as f64
    };
    window.act(EditorAct::Tool(Tool::Parts));
    let source = inside(&window, Side::Source, 0);
    let target = inside(&window, Side::Target, 1);
    let other = inside(&window, Side::Target, 0);
    window.act(EditorAct::Click(touch(Side::Source, source.x, source.y)));
    assert!(window.editor().first_part.is_some());
    window.act(EditorAct::Click(touch(Side::Target, target.x, target.y)));
    window.wait();
    assert_eq!(window.matching().links.len(), 1);
    assert!(window.sheet().pieces.iter().any(|piece| piece.is_linked));
    // A part has one partner: the new pair replaces the old one.
    window.act(EditorAct::Click(touch(Side::Target, other.x, other.y)));
    window.act(EditorAct::Click(touch(Side::Source, source.x, source.y)));
    window.wait();
    assert_eq!(window.matching().links.len(), 1);
    window.act(EditorAct::Remove(touch(Side::Source, source.x, source.y)));
    assert!(window.matching().links.is_empty());
    window.wait();
    assert!(window.session().problem().is_none());
}

#[test]
fn a_cut_that_is_dragged_is_asked_for() {
    const RING: &str = "M10 10 H90 V90 H10 Z M35 35 V65 H65 V35 Z";
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), RING, L);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.matching.holes = morphospace::correspondence::HoleRule::Cut;
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    assert!(window.session().problem().is_none());
    assert_eq!(window.sheet().cuts.len(), 1);
    let found = window.sheet().cuts[0];
    assert_eq!(found.asked, None);
    let at = found.cut.outer;
    window.act(EditorAct::Press(touch(Side::Source, at.x, at.y)));
    let to = at + DVec2::new(2.0, 2.0);
    window.act(EditorAct::Drag(touch(Side::Source, to.x, to.y), Vec2::ONE));
    window.act(EditorAct::Release);
    window.wait();
    assert_eq!(window.matching().cuts.len(), 1);
    assert_eq!(window.sheet().cuts[0].asked, Some(0));
    assert!(window.session().problem().is_none());
    window.act(EditorAct::Clear);
    window.wait();
    assert_eq!(window.sheet().cuts[0].asked, None);
}

#[test]
fn another_design_forgets_the_points_of_the_old_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let from = window.sheet().features[0];
    let hand = touch(Side::Source, from.source.x, from.source.y);
    window.act(EditorAct::Press(hand));
    window.act(EditorAct::Drag(hand, Vec2::new(1.0, 0.0)));
    window.act(EditorAct::Release);
    window.wait();
    let other = write_outline(folder.path(), "other.svg", TWO);
    window.send(Intent::ReplaceDesign(1, other));
    window.wait();
    assert!(window.matching().pins.is_empty());
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
}

#[test]
fn the_editor_zooms_to_the_pointer_and_fits_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let at = Vec2::new(40.0, -30.0);
    window.act(EditorAct::Zoom { at, factor: 2.0 });
    // What was under the pointer lies there still: at = pan + zoom * p, before and after.
    let editor = window.editor().clone();
    assert_eq!(editor.zoom, 2.0);
    assert!((editor.pan + 2.0 * at - at).length() < 1e-4);
    window.send(Intent::FitView);
    assert_eq!(
        (window.editor().pan, window.editor().zoom),
        (Vec2::ZERO, 1.0)
    );
}

fn wait_for_twin(window: &mut Window) {
    window.update();
    while window.0.world().resource::<Twin>().is_busy() {
        std::thread::sleep(Duration::from_millis(1));
        window.update();
    }
    window.update();
}

#[test]
fn a_second_method_stands_beside_the_stage_at_the_same_t() {
    let mut window = Window::with_gallery();
    while window
        .session()
        .transition()
        .is_none_or(|t| t.compatible().is_none())
    {
        window.send(Intent::NextMethod);
        window.wait();
    }
    window.type_char(KeyCode::KeyV, "v");
    wait_for_twin(&mut window);
    window.send(Intent::Seek(0.5));
    let world = window.0.world_mut();
    let mut beside = world.query_filtered::<(&StageTransition, &Blend), With<OnTwin>>();
    let (StageTransition(straight), blend) = beside.single(world).expect("one entity beside");
    assert_eq!(blend.t, 0.5);
    // Straight lines are just that: every vertex is half way.
    let mesh = straight.compatible().expect("triangles");
    let frame = straight.frame(0.5);
    let size = mesh.diameter();
    for (k, p) in frame.placement().in_frame.iter().enumerate() {
        let half = 0.5 * (mesh.source()[k] + mesh.target()[k]);
        assert!(p.distance(half) < 1e-6 * size, "{p} is not {half}");
    }
    window.send(Intent::TwinMethod(TwinMethod::Cell(Cell::FIELD_BLEND)));
    wait_for_twin(&mut window);
    let twin: &Twin = window.0.world().resource();
    assert!(twin.problem().is_none());
    let content = twin.transition().map(|t| t.cell().content());
    assert_eq!(content, Some(ContentKind::Field));
    window.press(KeyCode::Escape, Key::Escape);
    let world = window.0.world_mut();
    let mut beside = world.query_filtered::<Entity, With<OnTwin>>();
    assert_eq!(beside.iter(world).count(), 0);
}

fn wait_for_measures(window: &mut Window) {
    for _ in 0..20_000 {
        window.update();
        if window.0.world().resource::<Measured>().measures().is_some() {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("no measures");
}

#[test]
fn what_is_on_the_stage_is_measured() {
    let mut window = Window::with_gallery();
    wait_for_measures(&mut window);
    let measured: &Measured = window.0.world().resource();
    let measures = measured.measures().expect("measures");
    assert_eq!(measures.film.samples.len(), measures.verdict.steps);
    assert!(!measured.is_busy());
    // Another transition is measured anew.
    window.send(Intent::NextMethod);
    window.wait();
    wait_for_measures(&mut window);
}
