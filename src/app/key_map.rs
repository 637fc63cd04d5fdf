//! Which key means what.
//!
//! The rows of [`keytable`](super::keytable) serve both the keys and the list of keys that the
//! window shows: what the list calls a key is made from what recognises it. Letters and signs go
//! by what the key prints, digits by where they are, so that the number row works on a French
//! keyboard and `[` on a German one. While a text field has the focus no key means anything here.

use std::fmt;

use bevy::input::keyboard::{Key, KeyCode, KeyboardFocusLost, KeyboardInput};
use bevy::prelude::{Local, MessageReader, MessageWriter, Res, Resource};

use crate::app::editing::editor::MatchEditor;
use crate::app::files::drop::DroppedDesign;
use crate::app::input::editor_action::EditorAction;
use crate::app::input::gesture::KeyboardFocus;
use crate::app::input::intent::Intent;
use crate::app::map::map_view::MapView;
use crate::app::persistence::autosave::Autosave;
use crate::app::presentation::presenter::Presentation;
use crate::app::unsaved_question::UnsavedQuestion;

/// How a binding recognises its key.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyTrigger {
    /// A key with a name, such as an arrow.
    Named(Key),
    /// A letter, by what the key prints, in lower case.
    Letter(char),
    /// A sign, by what the key prints, whatever else must be held to print it.
    Sign(char),
    /// A digit, by where it is: number row or number pad.
    Digit(u8),
}

/// One key and what it means.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyBinding {
    /// The key.
    pub trigger: KeyTrigger,
    /// What must be held besides it; matters for letters and named keys only.
    pub held: KeyModifiers,
    /// What it means.
    pub intent: Intent,
}

/// Keys that belong together: a line of the list of keys.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyTableRow {
    /// The heading that it is listed under.
    pub group: &'static str,
    /// What the keys do.
    pub help: &'static str,
    /// The keys.
    pub bindings: Vec<KeyBinding>,
}

/// Keys that are held besides the one that was pressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeyModifiers {
    /// Either shift key.
    pub shift: bool,
    /// Either control key, or Command.
    pub control: bool,
    /// The left alt key.
    pub alt: bool,
}

impl KeyModifiers {
    /// Notes that a key went down or up; only modifiers matter.
    fn note(&mut self, input: &KeyboardInput) {
        let is_down = input.state.is_pressed();
        match input.key_code {
            KeyCode::ShiftLeft | KeyCode::ShiftRight => self.shift = is_down,
            KeyCode::ControlLeft
            | KeyCode::ControlRight
            | KeyCode::SuperLeft
            | KeyCode::SuperRight => self.control = is_down,
            // Not the right one: as AltGr it prints signs on many keyboards, and signs are bound.
            KeyCode::AltLeft => self.alt = is_down,
            _ => {}
        }
    }
}

/// The key map in use.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct KeyMap(Vec<KeyTableRow>);

impl KeyMap {
    /// A key map of these rows.
    #[must_use]
    pub const fn new(rows: Vec<KeyTableRow>) -> Self {
        Self(rows)
    }

    /// All rows, in the order of the list.
    #[must_use]
    pub fn rows(&self) -> &[KeyTableRow] {
        &self.0
    }

    /// What a pressed key means, if anything. Signs win over digits: where a digit's key prints
    /// a sign that is bound, the sign is meant. While the match is being edited its own keys win.
    #[must_use]
    pub fn intent(
        &self,
        input: &KeyboardInput,
        held: KeyModifiers,
        is_editing: bool,
    ) -> Option<&Intent> {
        if !input.state.is_pressed() {
            return None;
        }
        let rank = |binding: &KeyBinding| match (binding.in_editor(), &binding.trigger) {
            (true, _) => 0,
            (false, KeyTrigger::Named(_) | KeyTrigger::Letter(_) | KeyTrigger::Sign(_)) => 1,
            (false, KeyTrigger::Digit(_)) => 2,
        };
        self.0
            .iter()
            .flat_map(|row| &row.bindings)
            .filter(|binding| is_editing || !binding.in_editor())
            .filter(|binding| binding.repeats() || !input.repeat)
            .filter(|binding| binding.matches(input, held))
            .min_by_key(|binding| rank(binding))
            .map(|binding| &binding.intent)
    }
}

impl KeyTableRow {
    /// What the list calls its keys: modifiers that all of them share are said once, and digits
    /// from the first to the last.
    #[must_use]
    pub fn keys(&self) -> String {
        let labels = |with: fn(&KeyBinding) -> String| -> Vec<String> {
            self.bindings.iter().map(with).collect()
        };
        let (Some(first), Some(last)) = (self.bindings.first(), self.bindings.last()) else {
            return String::new();
        };
        if matches!(first.trigger, KeyTrigger::Digit(_)) {
            return format!("{} – {}", first.trigger, last.trigger);
        }
        let modifiers = first.modifiers();
        if self.bindings.iter().all(|b| b.modifiers() == modifiers) {
            modifiers.to_owned() + &labels(|b| b.trigger.to_string()).join("  ")
        } else {
            labels(KeyBinding::chord).join("  ")
        }
    }
}

impl fmt::Display for KeyTrigger {
    /// What is printed on the key.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Self::Letter(letter) => return write!(out, "{}", letter.to_ascii_uppercase()),
            Self::Sign(sign) => return write!(out, "{sign}"),
            Self::Digit(digit) => return write!(out, "{digit}"),
            Self::Named(Key::ArrowRight) => "Right",
            Self::Named(Key::ArrowLeft) => "Left",
            Self::Named(Key::ArrowUp) => "Up",
            Self::Named(Key::ArrowDown) => "Down",
            Self::Named(Key::PageUp) => "Page Up",
            Self::Named(Key::PageDown) => "Page Down",
            Self::Named(Key::Escape) => "Esc",
            Self::Named(Key::Delete) => "Del",
            Self::Named(key) => return write!(out, "{key:?}"),
        };
        out.write_str(name)
    }
}

impl KeyBinding {
    /// The key with what is held besides it, as `Ctrl Shift S`.
    #[must_use]
    pub fn chord(&self) -> String {
        format!("{}{}", self.modifiers(), self.trigger)
    }

    const fn modifiers(&self) -> &'static str {
        match (self.held.control, self.held.shift) {
            (true, true) => "Ctrl Shift ",
            (true, false) => "Ctrl ",
            (false, true) => "Shift ",
            (false, false) => "",
        }
    }

    /// Holding the key repeats the act: what goes on by a step may, what is there once or turns
    /// back and forth may not.
    #[must_use]
    pub const fn repeats(&self) -> bool {
        matches!(
            self.intent,
            Intent::Step(_) | Intent::Slower | Intent::Faster
        )
    }

    /// The key means this while the match editor is open, and nothing otherwise.
    #[must_use]
    pub const fn in_editor(&self) -> bool {
        matches!(self.intent, Intent::Editor(EditorAction::RemoveSelected))
    }

    fn matches(&self, input: &KeyboardInput, held: KeyModifiers) -> bool {
        let modifiers_match = held == self.held;
        match &self.trigger {
            KeyTrigger::Named(key) => input.logical_key == *key && modifiers_match,
            KeyTrigger::Letter(letter) => {
                printed(input).is_some_and(|c| c.to_lowercase().eq([*letter])) && modifiers_match
            }
            KeyTrigger::Sign(sign) => printed(input) == Some(*sign),
            KeyTrigger::Digit(digit) => {
                digit_at(input.key_code) == Some(*digit) && !held.control && !held.alt
            }
        }
    }
}

fn printed(input: &KeyboardInput) -> Option<char> {
    let Key::Character(text) = &input.logical_key else {
        return None;
    };
    let mut chars = text.chars();
    // A composed text of several signs is none that a key is bound to.
    chars.next().filter(|_| chars.next().is_none())
}

fn digit_at(code: KeyCode) -> Option<u8> {
    const ROW: [[KeyCode; 2]; 10] = [
        [KeyCode::Digit0, KeyCode::Numpad0],
        [KeyCode::Digit1, KeyCode::Numpad1],
        [KeyCode::Digit2, KeyCode::Numpad2],
        [KeyCode::Digit3, KeyCode::Numpad3],
        [KeyCode::Digit4, KeyCode::Numpad4],
        [KeyCode::Digit5, KeyCode::Numpad5],
        [KeyCode::Digit6, KeyCode::Numpad6],
        [KeyCode::Digit7, KeyCode::Numpad7],
        [KeyCode::Digit8, KeyCode::Numpad8],
        [KeyCode::Digit9, KeyCode::Numpad9],
    ];
    (0u8..)
        .zip(ROW)
        .find(|(_, codes)| codes.contains(&code))
        .map(|(digit, _)| digit)
}

/// Turns pressed keys into intents; does nothing while a text field has the focus.
///
/// Which modifiers are held is read from the same messages, in their order: in a slow frame Shift
/// may be up again before the frame that is to act on Shift+S.
pub fn read_keys(
    mut inputs: MessageReader<KeyboardInput>,
    mut focus_lost: MessageReader<KeyboardFocusLost>,
    (map, on_map): (Res<KeyMap>, Res<MapView>),
    (typing, editor, presenting): (Res<KeyboardFocus>, Res<MatchEditor>, Res<Presentation>),
    (question, drop, autosave): (Res<UnsavedQuestion>, Res<DroppedDesign>, Res<Autosave>),
    mut held: Local<KeyModifiers>,
    mut intents: MessageWriter<Intent>,
) {
    if focus_lost.read().count() > 0 {
        // A key that is let go in another window never tells of it here.
        *held = KeyModifiers::default();
    }
    for input in inputs.read() {
        // Also while a text is written: what is held when the field is left still counts.
        held.note(input);
        let meant = map.intent(input, *held, editor.is_open);
        let is_asked = question.text().is_some() || drop.asks() || autosave.lost().is_some();
        let may = |intent: &&Intent| match **intent {
            Intent::Back => !typing.0,
            _ if typing.0 || is_asked => false,
            ref act => !presenting.is_on() || act.is_of_a_talk(),
        };
        if let Some(intent) = meant.filter(may) {
            intents.write(on_map.instead(intent).unwrap_or_else(|| intent.clone()));
        }
    }
}
