//! Which key means what.
//!
//! One table serves the keys and the list of keys that the window shows, so the list cannot be
//! out of date. Letters and signs go by what the key prints, digits by where they are, so that
//! the number row works on a French keyboard and `[` on a German one. While a text field has the
//! focus no key means anything here.

use bevy::input::keyboard::{Key, KeyCode, KeyboardFocusLost, KeyboardInput};
use bevy::prelude::{Local, MessageReader, MessageWriter, Res, Resource};

use crate::app::asking::acts::EditorAct;
use crate::app::asking::intent::Intent;
use crate::app::editing::editor::Editor;

/// How a binding recognises its key.
#[derive(Clone, Debug, PartialEq)]
pub enum Trigger {
    /// A key with a name, such as an arrow.
    Named(Key),
    /// A letter, by what the key prints, in lower case.
    Letter(char),
    /// A sign, by what the key prints, whatever else must be held to print it.
    Sign(char),
    /// A digit, by where it is: number row or number pad.
    Digit(u8),
}

/// One key, what it means, and how the list of keys tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    /// The key.
    pub trigger: Trigger,
    /// Shift must be held; matters for letters and named keys only.
    pub shift: bool,
    /// Control (or Command) must be held; matters for letters and named keys only.
    pub control: bool,
    /// Holding the key repeats the act.
    pub repeats: bool,
    /// The key means this while the match editor is open, and nothing otherwise.
    pub in_editor: bool,
    /// What it means.
    pub intent: Intent,
    /// The heading that it is listed under.
    pub group: &'static str,
    /// The key as the list shows it; empty where the line before stands for this one too.
    pub keys: &'static str,
    /// What it does, for the list.
    pub help: &'static str,
}

/// Keys that are held besides the one that was pressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Held {
    /// Either shift key.
    pub shift: bool,
    /// Either control key, or Command.
    pub control: bool,
    /// The left alt key.
    pub alt: bool,
}

impl Held {
    /// Notes that a key went down or up; only modifiers matter.
    fn note(&mut self, input: &KeyboardInput) {
        let is_down = input.state.is_pressed();
        match input.key_code {
            KeyCode::ShiftLeft | KeyCode::ShiftRight => self.shift = is_down,
            KeyCode::ControlLeft
            | KeyCode::ControlRight
            | KeyCode::SuperLeft
            | KeyCode::SuperRight => self.control = is_down,
            KeyCode::AltLeft => self.alt = is_down,
            _ => {}
        }
    }
}

/// The key map in use.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct KeyMap(Vec<Binding>);

impl KeyMap {
    /// All bindings, in the order of the list.
    #[must_use]
    pub fn bindings(&self) -> &[Binding] {
        &self.0
    }

    /// What a pressed key means, if anything. Signs win over digits: where a digit's key prints
    /// a sign that is bound, the sign is meant. While the match is being edited its own keys win.
    #[must_use]
    pub fn intent(&self, input: &KeyboardInput, held: Held, is_editing: bool) -> Option<&Intent> {
        if !input.state.is_pressed() {
            return None;
        }
        let matching =
            |binding: &&Binding| (binding.repeats || !input.repeat) && binding.matches(input, held);
        let is_digit = |binding: &&Binding| matches!(binding.trigger, Trigger::Digit(_));
        let of_editor = self
            .0
            .iter()
            .filter(|binding| binding.in_editor && is_editing);
        let of_all = self
            .0
            .iter()
            .filter(|binding| !binding.in_editor && !is_digit(binding));
        of_editor
            .chain(of_all)
            .find(matching)
            .or_else(|| self.0.iter().filter(is_digit).find(matching))
            .map(|binding| &binding.intent)
    }
}

impl Binding {
    fn matches(&self, input: &KeyboardInput, held: Held) -> bool {
        let modifiers_match = held.shift == self.shift && held.control == self.control && !held.alt;
        match &self.trigger {
            Trigger::Named(key) => input.logical_key == *key && modifiers_match,
            Trigger::Letter(letter) => {
                printed(input).is_some_and(|c| c.to_lowercase().eq([*letter])) && modifiers_match
            }
            Trigger::Sign(sign) => printed(input) == Some(*sign),
            Trigger::Digit(digit) => {
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
    map: Res<KeyMap>,
    (typing, editor): (Res<Typing>, Res<Editor>),
    mut held: Local<Held>,
    mut intents: MessageWriter<Intent>,
) {
    if focus_lost.read().count() > 0 {
        *held = Held::default();
    }
    for input in inputs.read() {
        held.note(input);
        if let Some(intent) = map
            .intent(input, *held, editor.is_open)
            .filter(|_| !typing.0)
        {
            intents.write(intent.clone());
        }
    }
}

impl Default for KeyMap {
    fn default() -> Self {
        let mut rows = playing();
        rows.extend(stops());
        rows.extend(matching());
        rows.extend(view());
        rows.extend(files());
        Self(rows)
    }
}

fn row(trigger: Trigger, intent: Intent, keys: &'static str, help: &'static str) -> Binding {
    Binding {
        trigger,
        shift: false,
        control: false,
        repeats: false,
        in_editor: false,
        intent,
        group: "",
        keys,
        help,
    }
}

impl Binding {
    fn shift(self) -> Self {
        Self {
            shift: true,
            ..self
        }
    }

    fn control(self) -> Self {
        Self {
            control: true,
            ..self
        }
    }

    fn editing(self) -> Self {
        Self {
            in_editor: true,
            ..self
        }
    }

    fn repeating(self) -> Self {
        Self {
            repeats: true,
            ..self
        }
    }
}

fn grouped(group: &'static str, rows: Vec<Binding>) -> Vec<Binding> {
    rows.into_iter()
        .map(|binding| Binding { group, ..binding })
        .collect()
}

fn playing() -> Vec<Binding> {
    use Trigger::{Digit, Letter, Named, Sign};
    let mut rows = vec![
        row(
            Named(Key::Space),
            Intent::TogglePlay,
            "Space",
            "Play or pause",
        ),
        row(
            Named(Key::ArrowRight),
            Intent::Step(1),
            "Right  Left",
            "Step by one hundredth",
        )
        .repeating(),
        row(Named(Key::ArrowLeft), Intent::Step(-1), "", "").repeating(),
        row(
            Named(Key::ArrowRight),
            Intent::Step(10),
            "Shift Right  Left",
            "Ten steps",
        )
        .shift()
        .repeating(),
        row(Named(Key::ArrowLeft), Intent::Step(-10), "", "")
            .shift()
            .repeating(),
        row(
            Named(Key::Home),
            Intent::SeekStart,
            "Home  End",
            "Start and end of the pass",
        ),
        row(Named(Key::End), Intent::SeekEnd, "", ""),
        row(Sign(']'), Intent::Faster, "[  ]", "Slower and faster").repeating(),
        row(Sign('['), Intent::Slower, "", "").repeating(),
        row(
            Named(Key::Backspace),
            Intent::NormalSpeed,
            "Backspace",
            "Speed 1",
        ),
        row(Letter('r'), Intent::Reverse, "R", "Play the other way"),
        row(
            Letter('l'),
            Intent::CyclePlayMode,
            "L",
            "Once, loop, ping-pong",
        ),
    ];
    rows.extend((1..=9).map(|n: u8| {
        let (keys, help) = if n == 1 {
            ("1 – 9", "Jump to a tenth")
        } else {
            ("", "")
        };
        row(Digit(n), Intent::Seek(f64::from(n) / 10.0), keys, help)
    }));
    grouped("Play", rows)
}

fn stops() -> Vec<Binding> {
    use Trigger::{Letter, Named};
    grouped(
        "Stops and slides",
        vec![
            row(Letter('m'), Intent::AddStop, "M", "Set a stop here"),
            row(
                Named(Key::ArrowUp),
                Intent::JumpToNextStop,
                "Up  Down",
                "Jump to the next and previous stop",
            ),
            row(Named(Key::ArrowDown), Intent::JumpToPreviousStop, "", ""),
            row(
                Named(Key::PageDown),
                Intent::PlayToNextStop,
                "Page Down",
                "Play to the next stop and wait",
            ),
            row(
                Named(Key::PageUp),
                Intent::PlayToPreviousStop,
                "Page Up",
                "Play back to the stop before",
            ),
        ],
    )
}

fn matching() -> Vec<Binding> {
    use Trigger::{Letter, Named};
    let edit = |act: EditorAct| Intent::Editor(act);
    let remove = || edit(EditorAct::RemoveSelected);
    grouped(
        "Match",
        vec![
            row(
                Letter('e'),
                edit(EditorAct::Toggle),
                "E",
                "Edit the match: which point is which",
            ),
            row(
                Named(Key::Delete),
                remove(),
                "Del",
                "Delete the chosen pin or cut",
            )
            .editing(),
            row(Named(Key::Backspace), remove(), "", "").editing(),
        ],
    )
}

fn view() -> Vec<Binding> {
    use Trigger::{Letter, Named, Sign};
    grouped(
        "View",
        vec![
            row(Named(Key::Tab), Intent::NextMethod, "Tab", "Next method"),
            row(
                Letter('v'),
                Intent::ToggleTwin,
                "V",
                "A second method beside the stage",
            ),
            row(
                Letter('w'),
                Intent::ToggleGrid,
                "W",
                "A grid that shows the warp",
            ),
            row(
                Letter('p'),
                Intent::TogglePlots,
                "P",
                "Plots of the measures against t",
            ),
            row(
                Letter('z'),
                Intent::FitView,
                "Z",
                "Show the whole transition",
            ),
            row(
                Letter('f'),
                Intent::ToggleFullscreen,
                "F  F11",
                "Whole screen",
            ),
            row(Named(Key::F11), Intent::ToggleFullscreen, "", ""),
            row(
                Letter('h'),
                Intent::TogglePanels,
                "H",
                "Hide everything but the stage",
            ),
            row(Named(Key::Escape), Intent::Back, "Esc", "Back"),
            row(Sign('?'), Intent::ToggleHelp, "?  F1", "This list"),
            row(Named(Key::F1), Intent::ToggleHelp, "", ""),
            row(
                Named(Key::F3),
                Intent::ToggleTimes,
                "F3",
                "Times of a frame",
            ),
        ],
    )
}

fn files() -> Vec<Binding> {
    use Trigger::Letter;
    let with_panels = Intent::Screenshot { with_panels: true };
    let stage_alone = Intent::Screenshot { with_panels: false };
    grouped(
        "Files and pictures",
        vec![
            row(Letter('o'), Intent::AskOpen, "Ctrl O", "Open").control(),
            row(Letter('s'), Intent::Save, "Ctrl S", "Save").control(),
            row(Letter('s'), Intent::SaveAs, "Ctrl Shift S", "Save as")
                .control()
                .shift(),
            row(Letter('s'), stage_alone, "S", "Picture of the stage"),
            row(
                Letter('s'),
                with_panels,
                "Shift S",
                "Picture with the panels",
            )
            .shift(),
            row(Letter('g'), Intent::Record, "G", "Record one pass"),
            row(
                Letter('c'),
                Intent::Compare,
                "C",
                "Sheet of all methods, side by side",
            ),
            row(
                Letter('z'),
                Intent::Undo,
                "Ctrl Z  Ctrl Y",
                "Undo, redo (or Ctrl Shift Z)",
            )
            .control(),
            row(Letter('z'), Intent::Redo, "", "").control().shift(),
            row(Letter('y'), Intent::Redo, "", "").control(),
        ],
    )
}
