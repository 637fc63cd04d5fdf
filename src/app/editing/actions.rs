//! Acts on what the hand does in the match editor.

use bevy::prelude::{MessageReader, Res, ResMut, Vec2};

use crate::app::editing::editor::{CutEnd, EditorGrab, EditorHandle, MatchEditor};
use crate::app::editing::panes::EditorPane;
use crate::app::editing::sheet::{MatchSheet, PieceFate, SheetPiece};
use crate::app::input::editor_action::{EditorAction, EditorPointer, EditorTool};
use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::session::state::Session;
use crate::content::ContentKind;
use crate::correspondence::{MatchSettings, PointPair, RingCut, UnmatchedPart};
use crate::geometry::{DVec2, Side, SourceTarget};
use crate::project::Project;
use crate::warp::WarpKind;

/// Said of a point that no pin can be set on.
const NO_PARTNER: &str = "Nothing on the other side belongs to this boundary, so it cannot be \
     pinned. Pin two boundaries that are matched, or pair their parts.";

/// Said where nothing was matched yet.
const NOTHING_TO_PAIR: &str = "There is no part here. Click inside a part.";

/// Acts on the intents that concern the match editor.
pub fn apply(
    mut intents: MessageReader<Intent>,
    mut editor: ResMut<MatchEditor>,
    mut session: ResMut<Session>,
    (sheet, gesture): (Res<MatchSheet>, Res<Gesture>),
) {
    for intent in intents.read() {
        let act = match intent {
            Intent::Editor(act) => act,
            Intent::FitView if editor.is_open => {
                editor.panes.fit();
                continue;
            }
            _ => continue,
        };
        let mut matching = session
            .project()
            .map(|project| project.options.matching.clone())
            .unwrap_or_default();
        // Most acts change how it is looked at and not what is said: those are no change of the
        // project.
        let before = matching.clone();
        editor.act(act, &sheet, &session, &mut matching);
        if *act == EditorAction::Toggle && editor.is_open {
            // Only on opening: whoever then chooses a method that moves nothing means it.
            session.change(gesture.mark(), choose_what_moves);
            let is_free = session
                .project()
                .is_some_and(|p| p.content != Some(ContentKind::Solid));
            if editor.tool == EditorTool::Parts && is_free
                || editor.tool == EditorTool::Lines && !is_free
            {
                editor.tool = EditorTool::Pins;
            }
        }
        if matching != before {
            session.change(gesture.mark(), |project| {
                project.options.matching = matching;
            });
        }
    }
}

/// Where nothing moves there is nothing to match: outlines then become rigid parts, and pictures
/// follow points.
fn choose_what_moves(project: &mut Project) {
    if project.warp == Some(WarpKind::None) {
        let (warp, content) = match project.content {
            Some(ContentKind::Colours) => (WarpKind::Scattered, ContentKind::Colours),
            _ => (WarpKind::Arap, ContentKind::Solid),
        };
        project.warp = Some(warp);
        project.content = Some(content);
    }
}

impl MatchEditor {
    fn act(
        &mut self,
        act: &EditorAction,
        sheet: &MatchSheet,
        session: &Session,
        said: &mut MatchSettings,
    ) {
        match act {
            EditorAction::Toggle => self.is_open = !self.is_open && session.can_match(),
            EditorAction::Tool(tool) => {
                self.tool = *tool;
                self.first_part = None;
            }
            EditorAction::Snap(on) => self.snaps = *on,
            EditorAction::Triangles(on) => self.triangles = *on,
            EditorAction::Hover(touch) => self.hover(*touch, sheet),
            EditorAction::Press(touch) => self.press(*touch, sheet),
            EditorAction::Drag(touch, delta) => self.drag(*touch, *delta, sheet, said),
            EditorAction::Release => self.grabbed = None,
            EditorAction::Click(touch) => self.click(*touch, sheet, said),
            EditorAction::Remove(touch) => self.remove(*touch, sheet, said),
            EditorAction::RemoveSelected => {
                if let Some(handle) = self.selected.take() {
                    remove_handle(handle, sheet, said);
                }
            }
            EditorAction::Clear => {
                (said.pins, said.links, said.cuts) = Default::default();
                said.lines.clear();
                said.lone.clear();
                self.selected = None;
            }
            EditorAction::Film(on) => self.panes.film = *on,
            EditorAction::Together(on) => self.panes.set_together(*on),
            EditorAction::Pan(pane, delta) => self.panes.pan(*pane, *delta),
            EditorAction::Zoom { pane, at, factor } => self.panes.zoom_at(*pane, *at, *factor),
        }
    }

    fn hover(&mut self, touch: Option<EditorPointer>, sheet: &MatchSheet) {
        let is_pinning = self.tool != EditorTool::Parts;
        self.hovered = touch.and_then(|touch| sheet.handle_at(touch));
        self.trace = touch
            .filter(|_| is_pinning && self.hovered.is_none())
            .and_then(|touch| sheet.trace(touch));
        self.part = touch
            .filter(|_| !is_pinning)
            .and_then(|touch| Some((touch.side, sheet.part(touch.side, touch.at, touch.reach)?)));
    }

    fn press(&mut self, touch: EditorPointer, sheet: &MatchSheet) {
        self.refusal = None;
        let handle = sheet.handle_at(touch);
        // A press on nothing moves the view, and what is selected stays so.
        self.selected = handle.or(self.selected);
        let grab = match handle {
            None if self.tool == EditorTool::Lines && sheet.is_free() => {
                EditorGrab::NewLine(touch.at)
            }
            None => EditorGrab::View,
            Some(EditorHandle::Pin(k)) => EditorGrab::Pin(k),
            Some(EditorHandle::Line(k, end)) => EditorGrab::Line(k, end),
            Some(EditorHandle::Feature(k)) => EditorGrab::Feature(k),
            // `handle_at` counts the cuts of this very sheet, so there is one of that number.
            Some(EditorHandle::Cut(k, end)) => match sheet.cuts[k].asked {
                Some(asked) => EditorGrab::Cut(asked, end),
                None => EditorGrab::FoundCut(k, end),
            },
        };
        self.grabbed = Some((touch.side, grab));
    }

    fn drag(
        &mut self,
        touch: EditorPointer,
        delta: Vec2,
        sheet: &MatchSheet,
        said: &mut MatchSettings,
    ) {
        let Some((side, grab)) = self.grabbed else {
            return;
        };
        // A hand that crosses the middle goes on in the design that it began in.
        let touch = EditorPointer { side, ..touch };
        let grab = taken(grab, sheet, said);
        self.grabbed = Some((side, grab));
        match grab {
            EditorGrab::View => self.panes.pan(EditorPane::Design(side), delta),
            EditorGrab::Pin(k) => {
                self.selected = Some(EditorHandle::Pin(k));
                if let (Some(pin), Some(to)) =
                    (said.pins.get_mut(k), sheet.landing(touch, self.snaps))
                {
                    pin[side] = sheet.own(side, to);
                }
            }
            EditorGrab::Cut(k, end) => {
                if let (Some(cut), Some(foot)) =
                    (said.cuts.get_mut(k), sheet.on_boundary(side, touch.at))
                {
                    let to = sheet.own(side, foot.point);
                    match end {
                        CutEnd::Outer => cut.outer = to,
                        CutEnd::Hole => cut.hole = to,
                    }
                }
            }
            EditorGrab::Line(k, end) => {
                self.selected = Some(EditorHandle::Line(k, end));
                if let Some(line) = said.lines.get_mut(k) {
                    line[side][end] = sheet.own(side, touch.at);
                }
            }
            EditorGrab::Stretch(k) => {
                self.selected = Some(EditorHandle::Line(k, 1));
                if let Some(line) = said.lines.get_mut(k) {
                    for side in Side::BOTH {
                        line[side][1] = sheet.own(side, touch.at);
                    }
                }
            }
            // None is left: `taken` has made them what is asked for.
            EditorGrab::Feature(_) | EditorGrab::FoundCut(..) | EditorGrab::NewLine(_) => {}
        }
    }

    fn click(&mut self, touch: EditorPointer, sheet: &MatchSheet, said: &mut MatchSettings) {
        self.refusal = None;
        match (sheet.handle_at(touch), self.tool) {
            (Some(handle), _) => self.selected = Some(handle),
            (None, EditorTool::Pins) => self.add_pin(touch, sheet, said),
            (None, EditorTool::Lines) => {}
            (None, EditorTool::Parts) => self.pair(touch, sheet, said),
        }
    }

    fn add_pin(&mut self, touch: EditorPointer, sheet: &MatchSheet, said: &mut MatchSettings) {
        self.selected = None;
        let is_near = sheet
            .on_boundary(touch.side, touch.at)
            .is_some_and(|foot| foot.distance <= touch.reach);
        let landing = sheet.landing(touch, self.snaps);
        let Some(here) = landing.filter(|_| is_near || sheet.is_free()) else {
            return self.take_part(touch, sheet, said);
        };
        let partner = if sheet.is_free() {
            Some(here)
        } else {
            sheet.partner(touch.side, here)
        };
        let Some(there) = partner else {
            match sheet.is_alone(touch) {
                true => self.take_part(touch, sheet, said),
                false => self.refusal = Some(NO_PARTNER),
            }
            return;
        };
        let pin = sheet.own_pair(&SourceTarget::on(touch.side, here, there));
        keep_found(sheet, said);
        said.pins.push(pin);
        self.selected = Some(EditorHandle::Pin(said.pins.len() - 1));
    }

    /// Where there is nothing to pin, a click takes a part, of several, to be paired by the next.
    fn take_part(&mut self, touch: EditorPointer, sheet: &MatchSheet, said: &mut MatchSettings) {
        let is_part = sheet.part(touch.side, touch.at, touch.reach).is_some();
        if sheet.pieces.len() > 1 && is_part {
            self.tool = EditorTool::Parts;
            self.pair(touch, sheet, said);
        }
    }

    fn pair(&mut self, touch: EditorPointer, sheet: &MatchSheet, said: &mut MatchSettings) {
        let Some(part) = sheet.part(touch.side, touch.at, touch.reach) else {
            match self.first_part.take() {
                // A partner was looked for on the other side, and there is none.
                Some((side, part, at)) if side != touch.side => {
                    unlink(
                        sheet,
                        said,
                        SourceTarget::on(side, Some(part), None).to_array(),
                    );
                    let at = sheet.own(side, at);
                    said.lone.push(UnmatchedPart { side, at });
                }
                _ => self.refusal = Some(NOTHING_TO_PAIR),
            }
            return;
        };
        match self.first_part.take() {
            Some((side, _, first)) if side != touch.side => {
                let link = sheet.own_pair(&SourceTarget::on(side, first, touch.at));
                let parts = Side::BOTH.map(|side| sheet.part(side, sheet.framed(&link, side), 0.0));
                unlink(sheet, said, parts);
                said.links.push(link);
            }
            Some((_, first, _)) if first == part => {}
            _ => self.first_part = Some((touch.side, part, touch.at)),
        }
    }

    fn remove(&mut self, touch: EditorPointer, sheet: &MatchSheet, said: &mut MatchSettings) {
        self.refusal = None;
        if let Some(handle) = sheet.handle_at(touch) {
            remove_handle(handle, sheet, said);
            // What came after it in its list has another number now.
            (self.selected, self.hovered) = (None, None);
        } else if self.tool == EditorTool::Parts {
            let mut parts = [None; 2];
            parts[touch.side] = sheet.part(touch.side, touch.at, touch.reach);
            unlink(sheet, said, parts);
            self.first_part = None;
        }
    }
}

/// What is found becomes what is asked for once the hand moves it.
fn taken(grab: EditorGrab, sheet: &MatchSheet, said: &mut MatchSettings) -> EditorGrab {
    match grab {
        EditorGrab::Feature(k) => match sheet.features.get(k) {
            Some(_) if sheet.is_free() => {
                keep_found(sheet, said);
                EditorGrab::Pin(k)
            }
            Some(pair) => {
                said.pins.push(sheet.own_pair(pair));
                EditorGrab::Pin(said.pins.len() - 1)
            }
            None => EditorGrab::View,
        },
        EditorGrab::FoundCut(k, end) => match sheet.cuts.get(k) {
            Some(found) => {
                let RingCut { side, outer, hole } = found.cut;
                let [outer, hole] = [outer, hole].map(|p| sheet.own(side, p));
                said.cuts.push(RingCut { side, outer, hole });
                EditorGrab::Cut(said.cuts.len() - 1, end)
            }
            None => EditorGrab::View,
        },
        EditorGrab::NewLine(from) => {
            keep_found(sheet, said);
            said.lines
                .push(SourceTarget::of(|side| [sheet.own(side, from); 2]));
            EditorGrab::Stretch(said.lines.len() - 1)
        }
        known => known,
    }
}

/// A warp of the plane finds no pins once one is set: whoever sets or moves one
/// keeps those that were found.
fn keep_found(sheet: &MatchSheet, said: &mut MatchSettings) {
    if sheet.is_free() && said.pins.is_empty() && said.lines.is_empty() {
        let found = sheet.features.iter().map(|pair| sheet.own_pair(pair));
        said.pins.extend(found);
    }
}

fn remove_handle(handle: EditorHandle, sheet: &MatchSheet, said: &mut MatchSettings) {
    match handle {
        EditorHandle::Pin(k) if k < said.pins.len() => {
            said.pins.remove(k);
        }
        EditorHandle::Cut(k, _) => {
            let asked = sheet.cuts.get(k).and_then(|cut| cut.asked);
            if let Some(k) = asked.filter(|k| *k < said.cuts.len()) {
                said.cuts.remove(k);
            }
        }
        EditorHandle::Line(k, _) if k < said.lines.len() => {
            said.lines.remove(k);
        }
        EditorHandle::Pin(_) | EditorHandle::Feature(_) | EditorHandle::Line(..) => {}
    }
}

/// Drops every pair that one of these parts is in, and that it has none.
fn unlink(sheet: &MatchSheet, said: &mut MatchSettings, parts: [Option<usize>; 2]) {
    said.links.retain(|link| {
        Side::BOTH.into_iter().all(|side| {
            let wanted = parts[side];
            wanted.is_none() || sheet.part(side, sheet.framed(link, side), 0.0) != wanted
        })
    });
    said.lone.retain(|lone| {
        let (side, at) = (lone.side, sheet.by[lone.side].apply(lone.at));
        parts[side].is_none() || sheet.part(side, at, 0.0) != parts[side]
    });
}

impl MatchSheet {
    /// There is a part here that has no partner.
    fn is_alone(&self, touch: EditorPointer) -> bool {
        let part = self.part(touch.side, touch.at, touch.reach);
        let is_it = |piece: &SheetPiece| piece.parts[touch.side] == part;
        let mut alone = self
            .pieces
            .iter()
            .filter(|piece| piece.fate != PieceFate::Paired);
        part.is_some() && alone.any(is_it)
    }

    /// A point of the frame in a design's own coordinates.
    fn own(&self, side: Side, p: DVec2) -> DVec2 {
        self.by[side].inverse().apply(p)
    }

    /// A pair of the frame in the designs' own coordinates.
    fn own_pair(&self, pair: &PointPair) -> PointPair {
        SourceTarget::of(|side| self.own(side, pair[side]))
    }

    /// One end of a pair of the project, in the frame.
    fn framed(&self, pair: &PointPair, side: Side) -> DVec2 {
        self.by[side].apply(pair[side])
    }
}
