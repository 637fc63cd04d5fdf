//! What the hands are at: a text field, or one movement of the pointer.

use bevy::input::ButtonInput;
use bevy::prelude::{MouseButton, Res, ResMut, Resource};

/// A text field or a menu has the keyboard: keys belong to it and mean nothing here.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeyboardFocus(pub bool);

/// Words of a message are marked: Ctrl C copies them and not the stage.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextSelected(pub bool);

/// Frames from the release of a button until the last change that belongs to it was acted on:
/// panels are drawn after the systems have run, so what they ask for is acted on a frame later.
const FRAMES_AFTER: u8 = 2;

/// Which changes belong to one movement of the hand.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gesture {
    number: u64,
    frames_left: u8,
    was_typing: bool,
}

impl Gesture {
    /// The movement that is going on; changes of one movement are one step.
    #[must_use]
    pub fn mark(&self) -> Option<u64> {
        (self.frames_left > 0).then_some(self.number)
    }

    fn note(&mut self, is_new: bool, goes_on: bool) {
        if is_new {
            self.number += 1;
        }
        self.frames_left = if is_new || goes_on {
            FRAMES_AFTER
        } else {
            self.frames_left.saturating_sub(1)
        };
    }
}

/// Notes what the hand does.
pub fn track_gesture(
    buttons: Res<ButtonInput<MouseButton>>,
    typing: Res<KeyboardFocus>,
    mut gesture: ResMut<Gesture>,
) {
    // What is typed into one field is one step: a field that gets the keyboard is a new movement.
    let begins_typing = typing.0 && !gesture.was_typing;
    let is_new = buttons.get_just_pressed().next().is_some() || begins_typing;
    let goes_on = buttons.get_pressed().next().is_some() || typing.0;
    gesture.note(is_new, goes_on);
    gesture.was_typing = typing.0;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_button_marks_what_comes_shortly_after_it_too() {
        let mut gesture = Gesture::default();
        assert_eq!(gesture.mark(), None);
        gesture.note(true, true);
        let mark = gesture.mark();
        assert!(mark.is_some());
        gesture.note(false, false);
        assert_eq!(
            gesture.mark(),
            mark,
            "the release is acted on a frame later"
        );
        gesture.note(false, false);
        assert_eq!(gesture.mark(), None);
        gesture.note(true, false);
        assert_ne!(gesture.mark(), mark);
    }
}
