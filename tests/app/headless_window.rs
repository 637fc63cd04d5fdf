//! The app without a screen, for tests: its systems are driven by injected keys and intents, one
//! frame at a time.

use std::time::Duration;

use bevy::input::keyboard::{Key, KeyCode, KeyboardInput};
use bevy::input::{ButtonState, InputPlugin};
use bevy::log::LogPlugin;
use bevy::prelude::{App, DefaultPlugins, Entity, Messages, MinimalPlugins, PluginGroup, With};
use bevy::render::RenderPlugin;
use bevy::render::settings::{RenderCreation, WgpuSettings};
use bevy::time::TimeUpdateStrategy;
use bevy::window::PrimaryWindow;
use bevy::winit::{WinitPlugin, WinitSettings};
use morphospace::app::testing::{
    EditorAction, GalleryEntries, Intent, LogicPlugin, MatchEditor, MatchSheet, NoticeKind,
    Notices, Playback, Preferences, Session, WindowPlugins,
};
use morphospace::correspondence::MatchSettings;
use morphospace::project::gallery;
use morphospace::stage::MorphPlugin;

/// Time that passes in the app between two updates.
pub const FRAME: Duration = Duration::from_millis(20);

/// The app's systems; each call of [`Self::update`] runs one frame.
pub struct HeadlessWindow(pub App);

impl HeadlessWindow {
    pub fn new() -> Self {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin, MorphPlugin, LogicPlugin));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        app.update();
        Self(app)
    }

    /// Creates a window with panels and cameras; only the GPU and the operating system's window are
    /// missing. [`Self::new`] also leaves out egui and rendering.
    pub fn with_panels() -> Self {
        let mut app = App::new();
        let render_creation = RenderCreation::Automatic(Box::new(WgpuSettings {
            backends: None,
            ..Default::default()
        }));
        let without_gpu = RenderPlugin {
            render_creation,
            ..Default::default()
        };
        let plugins = DefaultPlugins.set(without_gpu);
        app.add_plugins(plugins.disable::<WinitPlugin>().disable::<LogPlugin>());
        app.insert_resource(WinitSettings::default())
            // Gallery entries would make the app draw their thumbnail strips during the tests.
            .insert_resource(GalleryEntries(Vec::new()))
            .add_plugins((MorphPlugin, LogicPlugin, WindowPlugins))
            .insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        app.finish();
        app.cleanup();
        let mut window = Self(app);
        window.open_first_gallery_project();
        window
    }

    /// Creates a window without panels that shows the first gallery project on the stage.
    pub fn with_gallery() -> Self {
        let mut window = Self::new();
        window.open_first_gallery_project();
        window
    }

    fn open_first_gallery_project(&mut self) {
        let window = self;
        let name = gallery_names().remove(0);
        window.send(Intent::OpenGallery(name));
        window.wait();
        assert!(
            window.session().transition().is_some(),
            "{:?}",
            window.problems()
        );
    }

    pub fn update(&mut self) {
        self.0.update();
    }

    /// Updates until the session has no more transitions to build.
    pub fn wait(&mut self) {
        self.update();
        while self.session().work().is_some() {
            std::thread::sleep(Duration::from_millis(1));
            self.update();
        }
        self.update();
    }

    pub fn send(&mut self, intent: Intent) {
        self.0.world_mut().write_message(intent);
        self.update();
    }

    pub fn session(&self) -> &Session {
        self.0.world().resource()
    }

    pub fn playback(&self) -> &Playback {
        self.0.world().resource()
    }

    pub fn t(&self) -> f64 {
        self.playback().t()
    }

    pub fn preferences(&self) -> &Preferences {
        self.0.world().resource()
    }

    /// Texts of the problems that the window shows at the moment.
    pub fn problems(&self) -> Vec<String> {
        let notices = self.0.world().resource::<Notices>().list();
        notices
            .iter()
            .filter(|n| matches!(n.kind, NoticeKind::Problem(_)))
            .map(|n| n.text.clone())
            .collect()
    }

    /// Sends one keyboard event to the window and updates.
    pub fn key(&mut self, state: ButtonState, key_code: KeyCode, logical_key: Key, repeat: bool) {
        let mut windows = self
            .0
            .world_mut()
            .query_filtered::<Entity, With<PrimaryWindow>>();
        let window = windows
            .single(self.0.world())
            .unwrap_or(Entity::PLACEHOLDER);
        let input = KeyboardInput {
            key_code,
            logical_key,
            state,
            text: None,
            repeat,
            window,
        };
        self.0.world_mut().write_message(input);
        self.update();
    }

    /// Presses and releases a key.
    pub fn press(&mut self, code: KeyCode, key: Key) {
        self.key(ButtonState::Pressed, code, key.clone(), false);
        self.key(ButtonState::Released, code, key, false);
    }

    pub fn type_char(&mut self, code: KeyCode, text: &str) {
        self.press(code, Key::Character(text.into()));
    }

    /// Runs an action while a key is down.
    pub fn hold(&mut self, code: KeyCode, key: Key, action: impl FnOnce(&mut Self)) {
        self.key(ButtonState::Pressed, code, key.clone(), false);
        action(self);
        self.key(ButtonState::Released, code, key, false);
    }

    pub fn editor(&self) -> &MatchEditor {
        self.0.world().resource()
    }

    pub fn sheet(&self) -> &MatchSheet {
        self.0.world().resource()
    }

    pub fn matching(&self) -> MatchSettings {
        let project = self.session().project().expect("a project");
        project.options.matching.clone()
    }

    /// Sends an action to the match editor and updates.
    pub fn act(&mut self, action: EditorAction) {
        self.send(Intent::Editor(action));
    }

    /// Intents sent in the last two frames.
    pub fn messages(&self) -> Vec<Intent> {
        let messages = self.0.world().resource::<Messages<Intent>>();
        messages.get_cursor().read(messages).cloned().collect()
    }
}

pub fn gallery_names() -> Vec<String> {
    gallery::list()
        .expect("a gallery")
        .into_iter()
        .map(|entry| entry.name)
        .collect()
}

pub fn is_close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}
