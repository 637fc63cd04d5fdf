//! Keyboard focus, text selection, and gestures of the mouse or keyboard. All changes made during
//! one gesture form one undo step.

use bevy::input::ButtonInput;
use bevy::prelude::{MouseButton, Res, ResMut, Resource};

/// Whether a text field, a menu or the file dialog has the keyboard focus; keys then trigger no
/// intents.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeyboardFocus(pub bool);

/// Whether text of a notice is selected: Ctrl+C then copies the text instead of the stage.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextSelected(pub bool);

/// Number of frames after the release of a mouse button during which changes still belong to the
/// gesture. Panels are drawn after the systems have run, so the changes that they send arrive one
/// frame later.
const FRAMES_AFTER: u8 = 2;

/// The mouse gesture or text entry in progress, numbered so that its changes form one undo step.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gesture {
    number: u64,
    frames_left: u8,
    was_typing: bool,
}

impl Gesture {
    /// Number of the gesture in progress; changes with the same number form one undo step. `None`
    /// between gestures.
    #[must_use]
    pub fn id(&self) -> Option<u64> {
        (self.frames_left > 0).then_some(self.number)
    }

    /// Records whether a gesture starts or continues in this frame.
    fn note(&mut self, is_new: bool, is_ongoing: bool) {
        if is_new {
            self.number += 1;
        }
        self.frames_left = if is_new || is_ongoing {
            FRAMES_AFTER
        } else {
            self.frames_left.saturating_sub(1)
        };
    }
}

/// Detects when a gesture starts and ends.
pub fn track_gesture(
    buttons: Res<ButtonInput<MouseButton>>,
    typing: Res<KeyboardFocus>,
    mut gesture: ResMut<Gesture>,
) {
    // All text typed into one field is one undo step: a field that receives the focus starts a new
    // gesture.
    let begins_typing = typing.0 && !gesture.was_typing;
    let is_new = buttons.get_just_pressed().next().is_some() || begins_typing;
    let is_ongoing = buttons.get_pressed().next().is_some() || typing.0;
    gesture.note(is_new, is_ongoing);
    gesture.was_typing = typing.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_shortly_after_a_release_belong_to_the_gesture() {
        let mut gesture = Gesture::default();
        assert_eq!(gesture.id(), None);
        gesture.note(true, true);
        let mark = gesture.id();
        assert!(mark.is_some());
        gesture.note(false, false);
        assert_eq!(gesture.id(), mark, "the release is acted on a frame later");
        gesture.note(false, false);
        assert_eq!(gesture.id(), None);
        gesture.note(true, false);
        assert_ne!(gesture.id(), mark);
    }
}
