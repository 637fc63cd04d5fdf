//! Applies the user's actions in the match editor: pins, lines, cuts and pairs of parts.

use bevy::prelude::{MessageReader, Res, ResMut, Vec2};

use crate::app::editing::editor::{CutEnd, EditorGrab, EditorHandle, MatchEditor};
use crate::app::editing::sheet::{MatchSheet, PieceFate, SheetPiece};
use crate::app::input::editor_action::EditorPane;
use crate::app::input::editor_action::{EditorAction, EditorPointer, EditorTool};
use crate::app::input::gesture::Gesture;
use crate::app::input::intent::Intent;
use crate::app::session::state::Session;
use crate::content::ContentKind;
use crate::correspondence::{MatchSettings, PointPair, RingCut, UnmatchedPart};
use crate::geometry::{DVec2, Side, SourceTarget};
use crate::project::Project;
use crate::warp::WarpKind;

/// Message for a click on a boundary that cannot be pinned.
const NO_PARTNER: &str = "This boundary has no match in the other design, so it cannot be \
     pinned. Pair its part first, or pin a boundary that is matched.";

/// Message for a click outside all parts.
const NO_PART_HERE: &str = "There is no part here. Click inside a part.";

/// Applies the intents of the match editor.
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
        // Most actions change only the view; they must not count as a change of the project.
        let before = matching.clone();
        editor.act(act, &sheet, &session, &mut matching);
        if *act == EditorAction::Toggle && editor.is_open {
            // Only on opening: a user who later selects a method without a warp means it.
            session.change(gesture.mark(), ensure_warp);
            let is_free = session
                .project()
                .is_some_and(|p| p.content != Some(ContentKind::Solid));
            // The last tool used may not exist for this content.
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

/// Switches from a method without a warp, where nothing is matched, to rigid parts for outlines or
/// to scattered points for pictures.
fn ensure_warp(project: &mut Project) {
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
    /// Applies one action; changes to the match go to `matching`.
    fn act(
        &mut self,
        act: &EditorAction,
        sheet: &MatchSheet,
        session: &Session,
        matching: &mut MatchSettings,
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
            EditorAction::Drag(touch, delta) => self.drag(*touch, *delta, sheet, matching),
            EditorAction::Release => self.grabbed = None,
            EditorAction::Click(touch) => self.click(*touch, sheet, matching),
            EditorAction::Remove(touch) => self.remove(*touch, sheet, matching),
            EditorAction::RemoveSelected => {
                if let Some(handle) = self.selected.take() {
                    remove_handle(handle, sheet, matching);
                }
            }
            EditorAction::Clear => {
                (matching.pins, matching.links, matching.cuts) = Default::default();
                matching.lines.clear();
                matching.lone.clear();
                self.selected = None;
            }
            EditorAction::Film(on) => self.panes.film = *on,
            EditorAction::Together(on) => self.panes.set_together(*on),
            EditorAction::Pan(pane, delta) => self.panes.pan(*pane, *delta),
            EditorAction::Zoom { pane, at, factor } => self.panes.zoom_at(*pane, *at, *factor),
        }
    }

    /// Updates what is highlighted under the pointer.
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

    /// Selects the handle under the pointer and starts a drag.
    fn press(&mut self, touch: EditorPointer, sheet: &MatchSheet) {
        self.refusal = None;
        let handle = sheet.handle_at(touch);
        // A press on empty space pans the view and keeps the selection.
        self.selected = handle.or(self.selected);
        let grab = match handle {
            None if self.tool == EditorTool::Lines && sheet.is_free() => {
                EditorGrab::NewLine(touch.at)
            }
            None => EditorGrab::View,
            Some(EditorHandle::Pin(k)) => EditorGrab::Pin(k),
            Some(EditorHandle::Line(k, end)) => EditorGrab::Line(k, end),
            Some(EditorHandle::Feature(k)) => EditorGrab::Feature(k),
            // `handle_at` returns indices into the cuts of this sheet, so this one exists.
            Some(EditorHandle::Cut(k, end)) => match sheet.cuts[k].asked {
                Some(asked) => EditorGrab::Cut(asked, end),
                None => EditorGrab::FoundCut(k, end),
            },
        };
        self.grabbed = Some((touch.side, grab));
    }

    /// Moves what is being dragged.
    fn drag(
        &mut self,
        touch: EditorPointer,
        delta: Vec2,
        sheet: &MatchSheet,
        matching: &mut MatchSettings,
    ) {
        let Some((side, grab)) = self.grabbed else {
            return;
        };
        // A drag across the middle stays in the design it started in.
        let touch = EditorPointer { side, ..touch };
        let grab = make_explicit(grab, sheet, matching);
        self.grabbed = Some((side, grab));
        match grab {
            EditorGrab::View => self.panes.pan(EditorPane::Design(side), delta),
            EditorGrab::Pin(k) => {
                self.selected = Some(EditorHandle::Pin(k));
                if let (Some(pin), Some(to)) =
                    (matching.pins.get_mut(k), sheet.landing(touch, self.snaps))
                {
                    pin[side] = sheet.own(side, to);
                }
            }
            EditorGrab::Cut(k, end) => {
                if let (Some(cut), Some(foot)) =
                    (matching.cuts.get_mut(k), sheet.on_boundary(side, touch.at))
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
                if let Some(line) = matching.lines.get_mut(k) {
                    line[side][end] = sheet.own(side, touch.at);
                }
            }
            EditorGrab::Stretch(k) => {
                self.selected = Some(EditorHandle::Line(k, 1));
                if let Some(line) = matching.lines.get_mut(k) {
                    for side in Side::BOTH {
                        line[side][1] = sheet.own(side, touch.at);
                    }
                }
            }
            // Unreachable: `make_explicit` has converted these.
            EditorGrab::Feature(_) | EditorGrab::FoundCut(..) | EditorGrab::NewLine(_) => {}
        }
    }

    /// Selects a handle, or applies the tool to empty space.
    fn click(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        self.refusal = None;
        match (sheet.handle_at(touch), self.tool) {
            (Some(handle), _) => self.selected = Some(handle),
            (None, EditorTool::Pins) => self.add_pin(touch, sheet, matching),
            (None, EditorTool::Lines) => {}
            (None, EditorTool::Parts) => self.pair(touch, sheet, matching),
        }
    }

    /// Adds a pin at the pointer and its matched point; on a part without a match, selects the part
    /// for pairing.
    fn add_pin(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        self.selected = None;
        let is_near = sheet
            .on_boundary(touch.side, touch.at)
            .is_some_and(|foot| foot.distance <= touch.reach);
        let landing = sheet.landing(touch, self.snaps);
        let Some(here) = landing.filter(|_| is_near || sheet.is_free()) else {
            return self.take_part(touch, sheet, matching);
        };
        let partner = if sheet.is_free() {
            Some(here)
        } else {
            sheet.partner(touch.side, here)
        };
        let Some(there) = partner else {
            match sheet.is_alone(touch) {
                true => self.take_part(touch, sheet, matching),
                false => self.refusal = Some(NO_PARTNER),
            }
            return;
        };
        let pin = sheet.own_pair(&SourceTarget::on(touch.side, here, there));
        keep_automatic_pins(sheet, matching);
        matching.pins.push(pin);
        self.selected = Some(EditorHandle::Pin(matching.pins.len() - 1));
    }

    /// Selects a part for pairing, if the design has several and there is nothing to pin.
    fn take_part(
        &mut self,
        touch: EditorPointer,
        sheet: &MatchSheet,
        matching: &mut MatchSettings,
    ) {
        let is_part = sheet.part(touch.side, touch.at, touch.reach).is_some();
        if sheet.pieces.len() > 1 && is_part {
            self.tool = EditorTool::Parts;
            self.pair(touch, sheet, matching);
        }
    }

    /// Selects the first part of a pair, or completes the pair.
    fn pair(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        let Some(part) = sheet.part(touch.side, touch.at, touch.reach) else {
            match self.first_part.take() {
                // A click on empty space of the other design: the part has no partner.
                Some((side, part, at)) if side != touch.side => {
                    unlink(
                        sheet,
                        matching,
                        SourceTarget::on(side, Some(part), None).to_array(),
                    );
                    let at = sheet.own(side, at);
                    matching.lone.push(UnmatchedPart { side, at });
                }
                _ => self.refusal = Some(NO_PART_HERE),
            }
            return;
        };
        match self.first_part.take() {
            Some((side, _, first)) if side != touch.side => {
                let link = sheet.own_pair(&SourceTarget::on(side, first, touch.at));
                let parts = Side::BOTH.map(|side| sheet.part(side, sheet.framed(&link, side), 0.0));
                unlink(sheet, matching, parts);
                matching.links.push(link);
            }
            Some((_, first, _)) if first == part => {}
            _ => self.first_part = Some((touch.side, part, touch.at)),
        }
    }

    /// Deletes the handle under the pointer or, with the parts tool, the part's pairings.
    fn remove(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        self.refusal = None;
        if let Some(handle) = sheet.handle_at(touch) {
            remove_handle(handle, sheet, matching);
            // Later entries of the list have new indices now.
            (self.selected, self.hovered) = (None, None);
        } else if self.tool == EditorTool::Parts {
            let mut parts = [None; 2];
            parts[touch.side] = sheet.part(touch.side, touch.at, touch.reach);
            unlink(sheet, matching, parts);
            self.first_part = None;
        }
    }
}

/// Converts an automatic point or cut to one of the project's when the user starts to move it.
fn make_explicit(grab: EditorGrab, sheet: &MatchSheet, matching: &mut MatchSettings) -> EditorGrab {
    match grab {
        EditorGrab::Feature(k) => match sheet.features.get(k) {
            Some(_) if sheet.is_free() => {
                keep_automatic_pins(sheet, matching);
                EditorGrab::Pin(k)
            }
            Some(pair) => {
                matching.pins.push(sheet.own_pair(pair));
                EditorGrab::Pin(matching.pins.len() - 1)
            }
            None => EditorGrab::View,
        },
        EditorGrab::FoundCut(k, end) => match sheet.cuts.get(k) {
            Some(automatic) => {
                let RingCut { side, outer, hole } = automatic.cut;
                let [outer, hole] = [outer, hole].map(|p| sheet.own(side, p));
                matching.cuts.push(RingCut { side, outer, hole });
                EditorGrab::Cut(matching.cuts.len() - 1, end)
            }
            None => EditorGrab::View,
        },
        EditorGrab::NewLine(from) => {
            keep_automatic_pins(sheet, matching);
            matching
                .lines
                .push(SourceTarget::of(|side| [sheet.own(side, from); 2]));
            EditorGrab::Stretch(matching.lines.len() - 1)
        }
        known => known,
    }
}

/// Warps of the plane use no automatic pins once the user sets one. So the automatic ones are added
/// to the project before the first change.
fn keep_automatic_pins(sheet: &MatchSheet, matching: &mut MatchSettings) {
    if sheet.is_free() && matching.pins.is_empty() && matching.lines.is_empty() {
        let automatic = sheet.features.iter().map(|pair| sheet.own_pair(pair));
        matching.pins.extend(automatic);
    }
}

/// Deletes a pin, cut or line of the project; automatic ones stay.
fn remove_handle(handle: EditorHandle, sheet: &MatchSheet, matching: &mut MatchSettings) {
    match handle {
        EditorHandle::Pin(k) if k < matching.pins.len() => {
            matching.pins.remove(k);
        }
        EditorHandle::Cut(k, _) => {
            let asked = sheet.cuts.get(k).and_then(|cut| cut.asked);
            if let Some(k) = asked.filter(|k| *k < matching.cuts.len()) {
                matching.cuts.remove(k);
            }
        }
        EditorHandle::Line(k, _) if k < matching.lines.len() => {
            matching.lines.remove(k);
        }
        EditorHandle::Pin(_) | EditorHandle::Feature(_) | EditorHandle::Line(..) => {}
    }
}

/// Removes all pairings of these parts, including the mark "no partner".
fn unlink(sheet: &MatchSheet, matching: &mut MatchSettings, parts: [Option<usize>; 2]) {
    matching.links.retain(|link| {
        Side::BOTH.into_iter().all(|side| {
            let wanted = parts[side];
            wanted.is_none() || sheet.part(side, sheet.framed(link, side), 0.0) != wanted
        })
    });
    matching.lone.retain(|lone| {
        let (side, at) = (lone.side, sheet.by[lone.side].apply(lone.at));
        parts[side].is_none() || sheet.part(side, at, 0.0) != parts[side]
    });
}

impl MatchSheet {
    /// Whether there is a part without a partner here.
    fn is_alone(&self, touch: EditorPointer) -> bool {
        let part = self.part(touch.side, touch.at, touch.reach);
        let is_it = |piece: &SheetPiece| piece.parts[touch.side] == part;
        let mut alone = self
            .pieces
            .iter()
            .filter(|piece| piece.fate != PieceFate::Paired);
        part.is_some() && alone.any(is_it)
    }

    /// Converts a point from the frame to a design's own coordinates.
    fn own(&self, side: Side, p: DVec2) -> DVec2 {
        self.by[side].inverse().apply(p)
    }

    /// Converts a pair of points from the frame to the designs' own coordinates.
    fn own_pair(&self, pair: &PointPair) -> PointPair {
        SourceTarget::of(|side| self.own(side, pair[side]))
    }

    /// Converts one end of a pair from its design's own coordinates to the frame.
    fn framed(&self, pair: &PointPair, side: Side) -> DVec2 {
        self.by[side].apply(pair[side])
    }
}
