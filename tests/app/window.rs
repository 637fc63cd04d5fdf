//! The window without a window: its systems, keys pressed by hand, and what came of them.

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
use morphospace::app::{
    EditorAction, GalleryEntries, Intent, LogicPlugin, MatchEditor, MatchSheet, NoticeKind,
    Notices, Playback, Preferences, Session, WindowPlugins,
};
use morphospace::correspondence::MatchSettings;
use morphospace::project::gallery;
use morphospace::stage::MorphPlugin;

pub const FRAME: Duration = Duration::from_millis(20);

pub struct Window(pub App);

impl Window {
    pub fn new() -> Self {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, InputPlugin, MorphPlugin, LogicPlugin));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        app.update();
        Self(app)
    }

    /// With its panels, cameras and all: only the screen is missing.
    pub fn with_panels() -> Self {
        let mut app = App::new();
        let render_creation = RenderCreation::Automatic(Box::new(WgpuSettings {
            backends: None,
            ..Default::default()
        }));
        let unseen = RenderPlugin {
            render_creation,
            ..Default::default()
        };
        let plugins = DefaultPlugins.set(unseen);
        app.add_plugins(plugins.disable::<WinitPlugin>().disable::<LogPlugin>());
        app.insert_resource(WinitSettings::default())
            // Their strips would be drawn beside the tests.
            .insert_resource(GalleryEntries(Vec::new()))
            .add_plugins((MorphPlugin, LogicPlugin, WindowPlugins))
            .insert_resource(TimeUpdateStrategy::ManualDuration(FRAME));
        app.finish();
        app.cleanup();
        let mut window = Self(app);
        window.open_first();
        window
    }

    pub fn with_gallery() -> Self {
        let mut window = Self::new();
        window.open_first();
        window
    }

    fn open_first(&mut self) {
        let window = self;
        let name = entries().remove(0);
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

    pub fn problems(&self) -> Vec<String> {
        let notices = self.0.world().resource::<Notices>().list();
        notices
            .iter()
            .filter(|n| matches!(n.kind, NoticeKind::Problem(_)))
            .map(|n| n.text.clone())
            .collect()
    }

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

    pub fn press(&mut self, code: KeyCode, key: Key) {
        self.key(ButtonState::Pressed, code, key.clone(), false);
        self.key(ButtonState::Released, code, key, false);
    }

    pub fn type_char(&mut self, code: KeyCode, text: &str) {
        self.press(code, Key::Character(text.into()));
    }

    pub fn hold(&mut self, code: KeyCode, key: Key, then: impl FnOnce(&mut Self)) {
        self.key(ButtonState::Pressed, code, key.clone(), false);
        then(self);
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

    pub fn act(&mut self, act: EditorAction) {
        self.send(Intent::Editor(act));
    }

    pub fn messages(&self) -> Vec<Intent> {
        let messages = self.0.world().resource::<Messages<Intent>>();
        messages.get_cursor().read(messages).cloned().collect()
    }
}

pub fn entries() -> Vec<String> {
    gallery::list()
        .expect("a gallery")
        .into_iter()
        .map(|entry| entry.name)
        .collect()
}

pub fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}
