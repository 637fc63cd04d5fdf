//! Key map: which key combination triggers which intent.
//!
//! The rows of [`key_table`](super::key_table) define both which keys are recognised and the list
//! of keys in the window, so the two always agree. Letters and signs are matched by the character
//! that the key prints, digits by the physical position of the key. So the number row works on a
//! French keyboard, and `[` works on a German one.

use std::fmt;

use bevy::input::keyboard::{Key, KeyCode, KeyboardInput};
use bevy::prelude::Resource;

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::Intent;

/// Condition by which a binding recognises its key.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyTrigger {
    /// A key with a name, such as an arrow.
    Named(Key),
    /// A letter by the character the key prints, in lower case.
    Letter(char),
    /// A sign by the character the key prints, whatever modifiers are needed to print it.
    Sign(char),
    /// A digit by physical position: number row or number pad.
    Digit(u8),
}

/// A key combination and the intent it triggers.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyBinding {
    /// Key of the combination.
    pub trigger: KeyTrigger,
    /// Modifiers that must be held; checked for letters and named keys only.
    pub held: KeyModifiers,
    /// Intent that the combination triggers.
    pub intent: Intent,
}

/// One line of the list of keys: combinations that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyTableRow {
    /// Heading of the group that the row belongs to.
    pub group: &'static str,
    /// Description of the action.
    pub help: &'static str,
    /// The key combinations.
    pub bindings: Vec<KeyBinding>,
}

/// Modifier keys that are held down.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeyModifiers {
    /// Either Shift key.
    pub shift: bool,
    /// Either Control or Command key.
    pub control: bool,
    /// The left Alt key.
    pub alt: bool,
}

impl KeyModifiers {
    /// Updates the modifiers from a key event; ignores keys that are no modifiers.
    pub fn update(&mut self, input: &KeyboardInput) {
        let is_down = input.state.is_pressed();
        match input.key_code {
            KeyCode::ShiftLeft | KeyCode::ShiftRight => self.shift = is_down,
            KeyCode::ControlLeft
            | KeyCode::ControlRight
            | KeyCode::SuperLeft
            | KeyCode::SuperRight => self.control = is_down,
            // The right Alt key is ignored: as AltGr it types symbols on many keyboards, and some
            // symbols have bindings.
            KeyCode::AltLeft => self.alt = is_down,
            _ => {}
        }
    }
}

/// The key map in use.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct KeyMap(Vec<KeyTableRow>);

impl KeyMap {
    /// A key map with these rows.
    #[must_use]
    pub const fn new(rows: Vec<KeyTableRow>) -> Self {
        Self(rows)
    }

    /// All rows, in the order of the list of keys.
    #[must_use]
    pub fn rows(&self) -> &[KeyTableRow] {
        &self.0
    }

    /// Intent that a key event triggers, given the modifiers held; `None` if no binding matches.
    ///
    /// If the key of a digit prints a sign that has a binding, the binding of the sign applies.
    /// While the match editor is open, its bindings take precedence over all others.
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
        let rank = |binding: &KeyBinding| match (binding.is_editor_only(), &binding.trigger) {
            (true, _) => 0,
            (false, KeyTrigger::Named(_) | KeyTrigger::Letter(_) | KeyTrigger::Sign(_)) => 1,
            (false, KeyTrigger::Digit(_)) => 2,
        };
        self.0
            .iter()
            .flat_map(|row| &row.bindings)
            .filter(|binding| is_editing || !binding.is_editor_only())
            .filter(|binding| binding.repeats() || !input.repeat)
            .filter(|binding| binding.matches(input, held))
            .min_by_key(|binding| rank(binding))
            .map(|binding| &binding.intent)
    }
}

impl KeyTableRow {
    /// Text for the keys of the row: shared modifiers are written once, digits as a range.
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
    /// Writes the label printed on the key.
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
    /// Full name of the combination, such as `Ctrl Shift S`.
    #[must_use]
    pub fn chord(&self) -> String {
        format!("{}{}", self.modifiers(), self.trigger)
    }

    /// Prefix with the names of the modifiers; empty if there are none.
    const fn modifiers(&self) -> &'static str {
        match (self.held.control, self.held.shift) {
            (true, true) => "Ctrl Shift ",
            (true, false) => "Ctrl ",
            (false, true) => "Shift ",
            (false, false) => "",
        }
    }

    /// Whether holding the key repeats the action. Only stepwise actions repeat; one-off actions
    /// and toggles do not.
    #[must_use]
    pub const fn repeats(&self) -> bool {
        matches!(
            self.intent,
            Intent::Step(_) | Intent::Slower | Intent::Faster
        )
    }

    /// Whether the binding applies only while the match editor is open.
    #[must_use]
    pub const fn is_editor_only(&self) -> bool {
        matches!(self.intent, Intent::Editor(EditorAction::RemoveSelected))
    }

    /// Whether a key event with these modifiers triggers the binding.
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

/// Character printed by a key event; `None` for named keys.
fn printed(input: &KeyboardInput) -> Option<char> {
    let Key::Character(text) = &input.logical_key else {
        return None;
    };
    let mut chars = text.chars();
    // A composed text of several characters matches no binding.
    chars.next().filter(|_| chars.next().is_none())
}

/// Digit at a physical key position, on the number row or the number pad.
fn digit_at(code: KeyCode) -> Option<u8> {
    /// Keys of each digit, from 0: on the number row and on the number pad.
    const DIGIT_KEYS: [[KeyCode; 2]; 10] = [
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
        .zip(DIGIT_KEYS)
        .find(|(_, codes)| codes.contains(&code))
        .map(|(digit, _)| digit)
}
