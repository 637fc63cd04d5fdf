//! Reads the keyboard and turns key presses into intents, depending on what is open.

use bevy::ecs::system::SystemParam;
use bevy::input::keyboard::{KeyboardFocusLost, KeyboardInput};
use bevy::prelude::{Local, MessageReader, MessageWriter, Res};

use crate::app::editing::editor::MatchEditor;
use crate::app::input::gesture::KeyboardFocus;
use crate::app::input::intent::Intent;
use crate::app::input::key_map::{KeyMap, KeyModifiers};
use crate::app::map::map_view::MapView;
use crate::app::open_questions::OpenQuestions;
use crate::app::presentation::presenter::Presentation;

/// Keyboard focus, open views and open questions, which together decide the effect of a key.
#[derive(SystemParam)]
pub struct KeyContext<'w> {
    focus: Res<'w, KeyboardFocus>,
    editor: Res<'w, MatchEditor>,
    presentation: Res<'w, Presentation>,
    map_view: Res<'w, MapView>,
    questions: OpenQuestions<'w>,
}

impl KeyContext<'_> {
    /// Whether an intent triggered by a key may be carried out now.
    fn allows(&self, intent: &Intent) -> bool {
        match intent {
            Intent::Escape => !self.focus.0,
            _ if self.focus.0 || self.questions.any() => false,
            other => !self.presentation.is_active() || other.is_allowed_in_talk(),
        }
    }
}

/// Turns key presses into intents, but not while a text field or menu has the keyboard focus.
///
/// The state of the modifier keys is read from the same messages in the same order. If screen
/// updates are slow, Shift may already be released when the key press of Shift+S is handled.
pub fn read_keys(
    mut inputs: MessageReader<KeyboardInput>,
    mut focus_lost: MessageReader<KeyboardFocusLost>,
    map: Res<KeyMap>,
    context: KeyContext,
    mut held: Local<KeyModifiers>,
    mut intents: MessageWriter<Intent>,
) {
    if focus_lost.read().count() > 0 {
        // If a key is released while another window has the focus, this window receives no message.
        *held = KeyModifiers::default();
    }
    for input in inputs.read() {
        // The state of the modifiers is updated even while a text field has the focus, because a
        // modifier may still be held when the text field loses the focus.
        held.update(input);
        let key_intent = map.intent(input, *held, context.editor.is_open);
        if let Some(intent) = key_intent.filter(|intent| context.allows(intent)) {
            let on_map = context.map_view.map_intent(intent);
            intents.write(on_map.unwrap_or_else(|| intent.clone()));
        }
    }
}
