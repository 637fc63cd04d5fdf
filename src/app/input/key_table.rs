//! The table of keys: every key combination, its intent, and its description in the list of keys.
//! `docs/reference/keys.md` repeats it; a test compares the two.

use bevy::input::keyboard::Key;

use crate::app::input::editor_action::EditorAction;
use crate::app::input::intent::{ExportKind, Intent};
use crate::app::input::key_map::KeyTrigger;
use crate::app::input::key_map::KeyTrigger::{Digit, Letter, Named, Sign};
use crate::app::input::key_map::{KeyBinding, KeyMap, KeyModifiers, KeyTableRow};

impl Default for KeyMap {
    fn default() -> Self {
        Self::new([playback(), stops(), talk(), edit(), view(), files()].concat())
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

fn playback() -> Vec<KeyTableRow> {
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
            ("Step by 0.01", step(1).into()),
            ("Step by 0.1", step(10).map(KeyBinding::shift).into()),
            (
                "Jump to start and end",
                ends.map(|(end, seek)| key(Named(end), seek)).into(),
            ),
            (
                "Slower and faster",
                speeds.map(|(c, intent)| key(Sign(c), intent)).into(),
            ),
            ("Reset speed", vec![key(Named(Key::Backspace), NormalSpeed)]),
            ("Reverse direction", vec![key(Letter('r'), Reverse)]),
            (
                "Once, loop, ping-pong",
                vec![key(Letter('l'), CyclePlayMode)],
            ),
            ("Jump to 0.1 … 0.9", (1..=9).map(tenth).collect()),
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
        "Stops",
        [
            (
                "Add a stop; on the map: add a stop to the path",
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
                "Play back to the previous stop and wait",
                vec![key(Named(Key::PageUp), PlayToPreviousStop)],
            ),
        ],
    )
}

fn talk() -> Vec<KeyTableRow> {
    use Intent::{Present, ToggleBlackScreen, ToggleCaptions, ToggleSpeaker};
    let present = Present { is_all: false };
    group(
        "Talk",
        [
            (
                "Start a talk: full screen, from the first stop",
                vec![key(Named(Key::F5), present)],
            ),
            (
                "Black screen on and off",
                vec![
                    key(Letter('b'), ToggleBlackScreen),
                    key(Sign('.'), ToggleBlackScreen),
                ],
            ),
            (
                "Captions on and off",
                vec![key(Letter('t'), ToggleCaptions)],
            ),
            (
                "Speaker window: notes and next stop",
                vec![key(Letter('n'), ToggleSpeaker)],
            ),
        ],
    )
}

fn edit() -> Vec<KeyTableRow> {
    let remove = |name: Key| key(Named(name), Intent::Editor(EditorAction::RemoveSelected));
    group(
        "Edit",
        [
            (
                "Edit the match; on the map: draw a path",
                vec![key(Letter('e'), Intent::Editor(EditorAction::Toggle))],
            ),
            (
                "Delete the selected pin, line or cut",
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
        Escape, FitView, NextMethod, ToggleComparison, ToggleFrameTimes, ToggleFullscreen,
        ToggleGrid, ToggleHelp, ToggleMap, ToggleOnion, TogglePanels, TogglePlots,
    };
    let letter = |c: char, intent: Intent| vec![key(Letter(c), intent)];
    let named = |name: Key, intent: Intent| key(Named(name), intent);
    group(
        "View",
        [
            ("Next method", vec![named(Key::Tab, NextMethod)]),
            (
                "Compare with a second method",
                letter('v', ToggleComparison),
            ),
            (
                "Map of all designs; arrow keys move on it",
                letter('d', ToggleMap),
            ),
            (
                "On the map: save this blend",
                letter('k', Intent::SaveBlend),
            ),
            (
                "Grid of the warp; on the map: record a path",
                letter('w', ToggleGrid),
            ),
            (
                "Onion skins: outlines at all stops",
                letter('o', ToggleOnion),
            ),
            ("Graphs over time", letter('p', TogglePlots)),
            ("Fit to view", letter('z', FitView)),
            (
                "Full screen",
                vec![
                    key(Letter('f'), ToggleFullscreen),
                    named(Key::F11, ToggleFullscreen),
                ],
            ),
            ("Hide everything but the stage", letter('h', TogglePanels)),
            ("Close, cancel or go back", vec![named(Key::Escape, Escape)]),
            (
                "List of keys",
                vec![key(Sign('?'), ToggleHelp), named(Key::F1, ToggleHelp)],
            ),
            ("Frame times", vec![named(Key::F3, ToggleFrameTimes)]),
        ],
    )
}

fn files() -> Vec<KeyTableRow> {
    use Intent::{AskExport, AskOpen, Close, CopyImage, CopySvg, New, Save, SaveAs, Screenshot};
    let letter = |c: char, intent: Intent| key(Letter(c), intent);
    let picture = |with_panels: bool| letter('s', Screenshot { with_panels });
    group(
        "Files and export",
        [
            ("New project", vec![letter('n', New).control()]),
            ("Open", vec![letter('o', AskOpen).control()]),
            ("Save", vec![letter('s', Save).control()]),
            ("Save as", vec![letter('s', SaveAs).control().shift()]),
            ("Save image", vec![picture(false)]),
            ("Save image with panels", vec![picture(true).shift()]),
            (
                "Copy as image, as SVG",
                vec![
                    letter('c', CopyImage).control(),
                    letter('c', CopySvg).control().shift(),
                ],
            ),
            (
                "Export film",
                vec![letter('g', AskExport(ExportKind::Film))],
            ),
            (
                "Export a comparison sheet of all methods",
                vec![letter('c', AskExport(ExportKind::MethodSheet))],
            ),
            ("Quit", vec![letter('q', Close).control()]),
        ],
    )
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Key combinations in one row of the documented table. `keys` is the cell that lists the keys,
    /// such as `R`, `→ ←`, `1 – 9` or `Ctrl+S, Ctrl+O`; `does` is the cell that describes the
    /// action.
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
    fn the_docs_list_exactly_the_bound_keys() {
        let page = include_str!("../../../docs/reference/keys.md");
        let table = page.split_once("| key | does |").expect("a table").1;
        let documented: BTreeSet<String> = table
            .lines()
            .skip(2)
            .map_while(|line| line.strip_prefix('|')?.strip_suffix('|')?.rsplit_once('|'))
            .flat_map(|(keys, does)| chords(keys, does))
            .collect();
        let map = KeyMap::default();
        let bindings = map.rows().iter().flat_map(|row| &row.bindings);
        let bound: BTreeSet<String> = bindings
            // Backspace has two bindings, one of them only in the match editor. The page lists the
            // key once, and so does the set.
            .map(KeyBinding::chord)
            .collect();
        assert_eq!(documented, bound);
    }

    #[test]
    fn no_two_keys_are_the_same() {
        let map = KeyMap::default();
        let mut chords = BTreeSet::new();
        for binding in map.rows().iter().flat_map(|row| &row.bindings) {
            assert!(
                chords.insert((binding.is_editor_only(), binding.chord())),
                "{} means two things",
                binding.chord()
            );
        }
    }

    #[test]
    fn the_list_abbreviates_keys() {
        let map = KeyMap::default();
        let keys: Vec<String> = map.rows().iter().map(KeyTableRow::keys).collect();
        for expected in [
            "Space",
            "Shift Right  Left",
            "1 – 9",
            "Ctrl Shift Z  Ctrl Y",
        ] {
            assert!(keys.iter().any(|keys| keys == expected), "{keys:?}");
        }
        assert!(map.rows().iter().all(|row| !row.help.is_empty()));
    }
}
