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
    Answer, Intent, Kind, LogicPlugin, Notices, OnStage, Playback, Preferences, Question, Session,
    Typing,
};
use morphospace::content::{Content, ContentKind};
use morphospace::project::gallery;
use morphospace::stage::{Blend, MorphPlugin, StageTransition};
use morphospace::transition::PlayMode;

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
    window.press(KeyCode::Tab, Key::Tab);
    window.wait();
    let second = cell(&window);
    assert_ne!(first, second);
    window.press(KeyCode::Tab, Key::Tab);
    window.wait();
    assert_eq!(cell(&window), first);
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
    project.arap.subdivisions = 1;
    project.field.cells = 96;
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
    project.field.blend.threshold = 2.0;
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    assert_eq!(source(&window), before);
    let Some(Content::Field(pair)) = window.session().transition().map(|t| t.content()) else {
        panic!("a field is on the stage");
    };
    assert_eq!(pair.blend().threshold, 2.0);
}
