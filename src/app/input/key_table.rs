//! The table of keys: what each means, and what the list of keys says of it.

use bevy::input::keyboard::Key;

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::Intent;
use crate::app::key_map::KeyTrigger;
use crate::app::key_map::KeyTrigger::{Digit, Letter, Named, Sign};
use crate::app::key_map::{KeyBinding, KeyMap, KeyModifiers, KeyTableRow};

impl Default for KeyMap {
    fn default() -> Self {
        Self::new([playing(), stops(), talk(), changing(), view(), files()].concat())
    }
}

fn key(trigger: KeyTrigger, intent: Intent) -> KeyBinding {
    KeyBinding {
        trigger,
        held: KeyModifiers::default(),
        intent,
    }
}

impl KeyBinding {
    fn shift(mut self) -> Self {
        self.held.shift = true;
        self
    }

    fn control(mut self) -> Self {
        self.held.control = true;
        self
    }
}

fn group<const N: usize>(
    group: &'static str,
    rows: [(&'static str, Vec<KeyBinding>); N],
) -> Vec<KeyTableRow> {
    let row = |(help, bindings)| KeyTableRow {
        group,
        help,
        bindings,
    };
    rows.into_iter().map(row).collect()
}

fn playing() -> Vec<KeyTableRow> {
    use Intent::{
        CyclePlayMode, Faster, NormalSpeed, Reverse, Seek, SeekEnd, SeekStart, Slower, Step,
        TogglePlay,
    };
    let step = |n: i32| {
        let keys = [(Key::ArrowRight, n), (Key::ArrowLeft, -n)];
        keys.map(|(arrow, n)| key(Named(arrow), Step(n)))
    };
    let tenth = |n: u8| key(Digit(n), Seek(f64::from(n) / 10.0));
    let ends = [(Key::Home, SeekStart), (Key::End, SeekEnd)];
    let speeds = [('[', Slower), (']', Faster)];
    group(
        "Play",
        [
            ("Play or pause", vec![key(Named(Key::Space), TogglePlay)]),
            ("Step by one hundredth", step(1).into()),
            ("Ten steps", step(10).map(KeyBinding::shift).into()),
            (
                "Start and end of the pass",
                ends.map(|(end, seek)| key(Named(end), seek)).into(),
            ),
            (
                "Slower and faster",
                speeds.map(|(c, act)| key(Sign(c), act)).into(),
            ),
            ("Speed 1", vec![key(Named(Key::Backspace), NormalSpeed)]),
            ("Play the other way", vec![key(Letter('r'), Reverse)]),
            (
                "Once, loop, ping-pong",
                vec![key(Letter('l'), CyclePlayMode)],
            ),
            ("Jump to a tenth", (1..=9).map(tenth).collect()),
        ],
    )
}

fn stops() -> Vec<KeyTableRow> {
    use Intent::{AddStop, JumpToNextStop, JumpToPreviousStop, PlayToNextStop, PlayToPreviousStop};
    let jumps = [
        (Key::ArrowUp, JumpToNextStop),
        (Key::ArrowDown, JumpToPreviousStop),
    ];
    group(
        "Stops and slides",
        [
            (
                "Set a stop here; on the map: one of the path",
                vec![key(Letter('m'), AddStop)],
            ),
            (
                "Jump to the next and previous stop",
                jumps.map(|(arrow, jump)| key(Named(arrow), jump)).into(),
            ),
            (
                "Play to the next stop and wait",
                vec![key(Named(Key::PageDown), PlayToNextStop)],
            ),
            (
                "Play back to the stop before",
                vec![key(Named(Key::PageUp), PlayToPreviousStop)],
            ),
        ],
    )
}

fn talk() -> Vec<KeyTableRow> {
    use Intent::{Black, Present, ToggleCaptions, ToggleSpeaker};
    let present = Present { is_all: false };
    group(
        "Talk",
        [
            (
                "Present: the drawing alone, from the first stop",
                vec![key(Named(Key::F5), present)],
            ),
            (
                "Black, and back",
                vec![key(Letter('b'), Black), key(Sign('.'), Black)],
            ),
            ("Captions", vec![key(Letter('t'), ToggleCaptions)]),
            (
                "Notes and the next stop, in a window",
                vec![key(Letter('n'), ToggleSpeaker)],
            ),
        ],
    )
}

fn changing() -> Vec<KeyTableRow> {
    let remove = |name: Key| key(Named(name), Intent::Editor(EditorAction::RemoveSelected));
    group(
        "Match and changes",
        [
            (
                "Edit the match; on the map: draw a path",
                vec![key(Letter('e'), Intent::Editor(EditorAction::Toggle))],
            ),
            (
                "Delete the chosen pin or cut",
                vec![remove(Key::Delete), remove(Key::Backspace)],
            ),
            ("Undo", vec![key(Letter('z'), Intent::Undo).control()]),
            (
                "Redo",
                vec![
                    key(Letter('z'), Intent::Redo).control().shift(),
                    key(Letter('y'), Intent::Redo).control(),
                ],
            ),
        ],
    )
}

fn view() -> Vec<KeyTableRow> {
    use Intent::{
        Back, FitView, NextMethod, ToggleFullscreen, ToggleGrid, ToggleHelp, ToggleMap,
        ToggleOnion, TogglePanels, TogglePlots, ToggleTimes, ToggleTwin,
    };
    let letter = |c: char, intent: Intent| vec![key(Letter(c), intent)];
    let named = |name: Key, intent: Intent| key(Named(name), intent);
    group(
        "View",
        [
            ("Next method", vec![named(Key::Tab, NextMethod)]),
            ("A second method beside the stage", letter('v', ToggleTwin)),
            (
                "The map of all designs; arrows walk on it",
                letter('d', ToggleMap),
            ),
            (
                "Keep the blend under the puck of the map",
                letter('k', Intent::Keep),
            ),
            (
                "A grid of the warp; on the map: record a way",
                letter('w', ToggleGrid),
            ),
            (
                "Onion skins: the film at its stops, in thin lines",
                letter('o', ToggleOnion),
            ),
            ("Plots of the measures against t", letter('p', TogglePlots)),
            ("Show the whole transition", letter('z', FitView)),
            (
                "Whole screen",
                vec![
                    key(Letter('f'), ToggleFullscreen),
                    named(Key::F11, ToggleFullscreen),
                ],
            ),
            ("Hide everything but the stage", letter('h', TogglePanels)),
            (
                "Back, or stop what is being built",
                vec![named(Key::Escape, Back)],
            ),
            (
                "This list",
                vec![key(Sign('?'), ToggleHelp), named(Key::F1, ToggleHelp)],
            ),
            ("Times of a frame", vec![named(Key::F3, ToggleTimes)]),
        ],
    )
}

fn files() -> Vec<KeyTableRow> {
    use Intent::{AskOpen, Compare, CopyPicture, CopyShapes, Record, Save, SaveAs, Screenshot};
    let letter = |c: char, intent: Intent| key(Letter(c), intent);
    let picture = |with_panels: bool| letter('s', Screenshot { with_panels });
    group(
        "Files and pictures",
        [
            ("Open", vec![letter('o', AskOpen).control()]),
            ("Save", vec![letter('s', Save).control()]),
            ("Save as", vec![letter('s', SaveAs).control().shift()]),
            ("Picture of the stage", vec![picture(false)]),
            ("Picture with the panels", vec![picture(true).shift()]),
            (
                "Copy the stage: as a picture, as SVG",
                vec![
                    letter('c', CopyPicture).control(),
                    letter('c', CopyShapes).control().shift(),
                ],
            ),
            ("Record one pass", vec![letter('g', Record)]),
            (
                "Sheet of all methods, side by side",
                vec![letter('c', Compare)],
            ),
        ],
    )
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// The chords of one row of the README: `R`, `→ ←`, `1 – 9`, `Ctrl+S, Ctrl+O`.
    fn chords(keys: &str, does: &str) -> BTreeSet<String> {
        let keys = keys.replace("Page ", "Page_").replace('`', "");
        let mut words: Vec<String> = keys
            .split([' ', ','])
            .filter(|word| !word.is_empty() && *word != "or")
            .map(|word| match word {
                "→" => "Right".to_owned(),
                "←" => "Left".to_owned(),
                "↑" => "Up".to_owned(),
                "↓" => "Down".to_owned(),
                other => other.replace(['_', '+'], " "),
            })
            .collect();
        if words.contains(&"–".to_owned()) {
            words = (1..=9).map(|n| n.to_string()).collect();
        }
        if does.contains("with Shift") {
            let shifted: Vec<String> = words.iter().map(|word| format!("Shift {word}")).collect();
            words.extend(shifted);
        }
        words.into_iter().collect()
    }

    #[test]
    fn the_readme_tells_of_all_keys_and_of_no_others() {
        let readme = include_str!("../../../README.md");
        let table = readme.split_once("| key | does |").expect("a table").1;
        let told: BTreeSet<String> = table
            .lines()
            .skip(2)
            .map_while(|line| line.strip_prefix('|')?.strip_suffix('|')?.rsplit_once('|'))
            .flat_map(|(keys, does)| chords(keys, does))
            .collect();
        let map = KeyMap::default();
        let bindings = map.rows().iter().flat_map(|row| &row.bindings);
        let bound: BTreeSet<String> = bindings
            // Backspace deletes as Del does; the README tells of its other meaning.
            .map(KeyBinding::chord)
            .collect();
        assert_eq!(told, bound);
    }

    #[test]
    fn no_two_keys_are_the_same() {
        let map = KeyMap::default();
        let mut seen = BTreeSet::new();
        for binding in map.rows().iter().flat_map(|row| &row.bindings) {
            assert!(
                seen.insert((binding.in_editor(), binding.chord())),
                "{} means two things",
                binding.chord()
            );
        }
    }

    #[test]
    fn the_list_tells_keys_in_few_words() {
        let map = KeyMap::default();
        let keys: Vec<String> = map.rows().iter().map(KeyTableRow::keys).collect();
        for known in [
            "Space",
            "Shift Right  Left",
            "1 – 9",
            "Ctrl Shift Z  Ctrl Y",
        ] {
            assert!(keys.iter().any(|keys| keys == known), "{keys:?}");
        }
        assert!(map.rows().iter().all(|row| !row.help.is_empty()));
    }
}
