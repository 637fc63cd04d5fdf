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
    sheet: Res<MatchSheet>,
    gesture: Res<Gesture>,
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
            // Done only when the editor opens, so that the user can still select a method without a
            // warp later.
            session.change(gesture.id(), ensure_warp);
            let is_free = session
                .project()
                .is_some_and(|p| p.content != Some(ContentKind::Solid));
            // The tool used last may not exist for the content of this film.
            if editor.tool == EditorTool::Parts && is_free
                || editor.tool == EditorTool::Lines && !is_free
            {
                editor.tool = EditorTool::Pins;
            }
        }
        if matching != before {
            session.change(gesture.id(), |project| {
                project.options.matching = matching;
            });
        }
    }
}

/// Selects a method with a warp if the current one has none, because without a warp nothing is
/// matched: the ARAP warp for outlines, or the scattered-points warp for pictures.
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
    /// Applies one action of the user; changes of the match settings go to `matching`.
    fn act(
        &mut self,
        act: &EditorAction,
        sheet: &MatchSheet,
        session: &Session,
        matching: &mut MatchSettings,
    ) {
        match act {
            EditorAction::Toggle => self.is_open = !self.is_open && session.has_match_editor(),
            EditorAction::SelectTool(tool) => {
                self.tool = *tool;
                self.first_part = None;
            }
            EditorAction::SetSnapping(on) => self.snaps = *on,
            EditorAction::ShowTriangles(on) => self.triangles = *on,
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
            EditorAction::ShowFilm(on) => self.panes.film = *on,
            EditorAction::LinkPanes(on) => self.panes.set_linked(*on),
            EditorAction::Pan(pane, delta) => self.panes.pan(*pane, *delta),
            EditorAction::Zoom { pane, at, factor } => self.panes.zoom_at(*pane, *at, *factor),
        }
    }

    /// Updates which handle, boundary point or part under the pointer is highlighted.
    fn hover(&mut self, touch: Option<EditorPointer>, sheet: &MatchSheet) {
        let is_pinning = self.tool != EditorTool::Parts;
        self.hovered = touch.and_then(|touch| sheet.handle_at(touch));
        self.trace = touch
            .filter(|_| is_pinning && self.hovered.is_none())
            .and_then(|touch| sheet.trace(touch));
        self.part = touch.filter(|_| !is_pinning).and_then(|touch| {
            Some((
                touch.side,
                sheet.part_at(touch.side, touch.position, touch.pick_radius)?,
            ))
        });
    }

    /// Selects the handle under the pointer and starts a drag.
    fn press(&mut self, touch: EditorPointer, sheet: &MatchSheet) {
        self.refusal = None;
        let handle = sheet.handle_at(touch);
        // A press on empty space pans the view and keeps the selection.
        self.selected = handle.or(self.selected);
        let grab = match handle {
            None if self.tool == EditorTool::Lines && sheet.has_free_pins() => {
                EditorGrab::NewLine(touch.position)
            }
            None => EditorGrab::View,
            Some(EditorHandle::Pin(k)) => EditorGrab::Pin(k),
            Some(EditorHandle::Line(k, end)) => EditorGrab::Line(k, end),
            Some(EditorHandle::Feature(k)) => EditorGrab::Feature(k),
            // `handle_at` returns indices into the cuts of this sheet, so this cut exists.
            Some(EditorHandle::Cut(k, end)) => match sheet.cuts[k].requested_index {
                Some(requested) => EditorGrab::Cut(requested, end),
                None => EditorGrab::AutomaticCut(k, end),
            },
        };
        self.grabbed = Some((touch.side, grab));
    }

    /// Moves the dragged object to the pointer, or pans by `delta` if the view is dragged.
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
        // A drag that leaves the pane of its design still acts on the design in which it started.
        let touch = EditorPointer { side, ..touch };
        let grab = make_explicit(grab, sheet, matching);
        self.grabbed = Some((side, grab));
        match grab {
            EditorGrab::View => self.panes.pan(EditorPane::Design(side), delta),
            EditorGrab::Pin(k) => {
                self.selected = Some(EditorHandle::Pin(k));
                if let (Some(pin), Some(to)) = (
                    matching.pins.get_mut(k),
                    sheet.pin_position(touch, self.snaps),
                ) {
                    pin[side] = sheet.to_design(side, to);
                }
            }
            EditorGrab::Cut(k, end) => {
                if let (Some(cut), Some(foot)) = (
                    matching.cuts.get_mut(k),
                    sheet.nearest_boundary_point(side, touch.position),
                ) {
                    let to = sheet.to_design(side, foot.point);
                    match end {
                        CutEnd::Outer => cut.outer = to,
                        CutEnd::Hole => cut.hole = to,
                    }
                }
            }
            EditorGrab::Line(k, end) => {
                self.selected = Some(EditorHandle::Line(k, end));
                if let Some(line) = matching.lines.get_mut(k) {
                    line[side][end] = sheet.to_design(side, touch.position);
                }
            }
            EditorGrab::NewLineEnd(k) => {
                self.selected = Some(EditorHandle::Line(k, 1));
                if let Some(line) = matching.lines.get_mut(k) {
                    for side in Side::BOTH {
                        line[side][1] = sheet.to_design(side, touch.position);
                    }
                }
            }
            // These variants cannot occur, because `make_explicit` has converted them.
            EditorGrab::Feature(_) | EditorGrab::AutomaticCut(..) | EditorGrab::NewLine(_) => {}
        }
    }

    /// Selects the handle under the pointer or, if there is none, applies the tool at the pointer.
    fn click(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        self.refusal = None;
        match (sheet.handle_at(touch), self.tool) {
            (Some(handle), _) => self.selected = Some(handle),
            (None, EditorTool::Pins) => self.add_pin(touch, sheet, matching),
            (None, EditorTool::Lines) => {}
            (None, EditorTool::Parts) => self.pair(touch, sheet, matching),
        }
    }

    /// Adds a pin between the point at the pointer and its matched point in the other design; on a
    /// part without a match, selects the part for pairing.
    fn add_pin(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        self.selected = None;
        let is_near = sheet
            .nearest_boundary_point(touch.side, touch.position)
            .is_some_and(|foot| foot.distance <= touch.pick_radius);
        let landing = sheet.pin_position(touch, self.snaps);
        let Some(here) = landing.filter(|_| is_near || sheet.has_free_pins()) else {
            return self.start_pairing(touch, sheet, matching);
        };
        let partner = if sheet.has_free_pins() {
            Some(here)
        } else {
            sheet.matched_point(touch.side, here)
        };
        let Some(there) = partner else {
            match sheet.is_unmatched_part(touch) {
                true => self.start_pairing(touch, sheet, matching),
                false => self.refusal = Some(NO_PARTNER),
            }
            return;
        };
        let pin = sheet.to_designs(&SourceTarget::with_side(touch.side, here, there));
        adopt_automatic_pins(sheet, matching);
        matching.pins.push(pin);
        self.selected = Some(EditorHandle::Pin(matching.pins.len() - 1));
    }

    /// Selects the part under the pointer for pairing; does nothing if there is no part, or if the
    /// match has only one piece.
    fn start_pairing(
        &mut self,
        touch: EditorPointer,
        sheet: &MatchSheet,
        matching: &mut MatchSettings,
    ) {
        let is_part = sheet
            .part_at(touch.side, touch.position, touch.pick_radius)
            .is_some();
        if sheet.pieces.len() > 1 && is_part {
            self.tool = EditorTool::Parts;
            self.pair(touch, sheet, matching);
        }
    }

    /// Selects the part under the pointer as the first of a pair, or completes the pair with it.
    fn pair(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        let Some(part) = sheet.part_at(touch.side, touch.position, touch.pick_radius) else {
            match self.first_part.take() {
                // A click on empty space of the other design marks the first part as unmatched.
                Some((side, part, at)) if side != touch.side => {
                    unlink(
                        sheet,
                        matching,
                        SourceTarget::with_side(side, Some(part), None).to_array(),
                    );
                    let at = sheet.to_design(side, at);
                    matching.lone.push(UnmatchedPart { side, at });
                }
                _ => self.refusal = Some(NO_PART_HERE),
            }
            return;
        };
        match self.first_part.take() {
            Some((side, _, first)) if side != touch.side => {
                let link = sheet.to_designs(&SourceTarget::with_side(side, first, touch.position));
                let parts =
                    Side::BOTH.map(|side| sheet.part_at(side, sheet.to_frame(&link, side), 0.0));
                unlink(sheet, matching, parts);
                matching.links.push(link);
            }
            Some((_, first, _)) if first == part => {}
            _ => self.first_part = Some((touch.side, part, touch.position)),
        }
    }

    /// Deletes the handle under the pointer or, with the parts tool, all pairings of the part under
    /// the pointer.
    fn remove(&mut self, touch: EditorPointer, sheet: &MatchSheet, matching: &mut MatchSettings) {
        self.refusal = None;
        if let Some(handle) = sheet.handle_at(touch) {
            remove_handle(handle, sheet, matching);
            // Deleting a pin, cut or line changes the indices of later ones, so these two handles
            // may contain wrong indices.
            (self.selected, self.hovered) = (None, None);
        } else if self.tool == EditorTool::Parts {
            let mut parts = [None; 2];
            parts[touch.side] = sheet.part_at(touch.side, touch.position, touch.pick_radius);
            unlink(sheet, matching, parts);
            self.first_part = None;
        }
    }
}

/// Converts an automatic point or cut, or a new line, to an entry of the project when the user
/// starts to move it.
fn make_explicit(grab: EditorGrab, sheet: &MatchSheet, matching: &mut MatchSettings) -> EditorGrab {
    match grab {
        EditorGrab::Feature(k) => match sheet.features.get(k) {
            Some(_) if sheet.has_free_pins() => {
                adopt_automatic_pins(sheet, matching);
                EditorGrab::Pin(k)
            }
            Some(pair) => {
                matching.pins.push(sheet.to_designs(pair));
                EditorGrab::Pin(matching.pins.len() - 1)
            }
            None => EditorGrab::View,
        },
        EditorGrab::AutomaticCut(k, end) => match sheet.cuts.get(k) {
            Some(automatic) => {
                let RingCut { side, outer, hole } = automatic.cut;
                let [outer, hole] = [outer, hole].map(|p| sheet.to_design(side, p));
                matching.cuts.push(RingCut { side, outer, hole });
                EditorGrab::Cut(matching.cuts.len() - 1, end)
            }
            None => EditorGrab::View,
        },
        EditorGrab::NewLine(from) => {
            adopt_automatic_pins(sheet, matching);
            matching.lines.push(SourceTarget::from_fn(|side| {
                [sheet.to_design(side, from); 2]
            }));
            EditorGrab::NewLineEnd(matching.lines.len() - 1)
        }
        other => other,
    }
}

/// Adds the automatic pins to the project before the user's first change. Without this, the change
/// would remove them: warps of the plane use automatic pins only until the user sets a pin or line.
fn adopt_automatic_pins(sheet: &MatchSheet, matching: &mut MatchSettings) {
    if sheet.has_free_pins() && matching.pins.is_empty() && matching.lines.is_empty() {
        let automatic = sheet.features.iter().map(|pair| sheet.to_designs(pair));
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
            let requested = sheet.cuts.get(k).and_then(|cut| cut.requested_index);
            if let Some(k) = requested.filter(|k| *k < matching.cuts.len()) {
                matching.cuts.remove(k);
            }
        }
        EditorHandle::Line(k, _) if k < matching.lines.len() => {
            matching.lines.remove(k);
        }
        EditorHandle::Pin(_) | EditorHandle::Feature(_) | EditorHandle::Line(..) => {}
    }
}

/// Removes all pairings of these parts, of the source and of the target, including marks that a
/// part has no partner.
fn unlink(sheet: &MatchSheet, matching: &mut MatchSettings, parts: [Option<usize>; 2]) {
    matching.links.retain(|link| {
        Side::BOTH.into_iter().all(|side| {
            let part = parts[side];
            part.is_none() || sheet.part_at(side, sheet.to_frame(link, side), 0.0) != part
        })
    });
    matching.lone.retain(|unmatched| {
        let side = unmatched.side;
        let at = sheet.frame_from_design[side].apply(unmatched.at);
        parts[side].is_none() || sheet.part_at(side, at, 0.0) != parts[side]
    });
}

impl MatchSheet {
    /// Whether the part under the pointer has no partner.
    fn is_unmatched_part(&self, touch: EditorPointer) -> bool {
        let part = self.part_at(touch.side, touch.position, touch.pick_radius);
        let is_of_part = |piece: &SheetPiece| piece.parts[touch.side] == part;
        let mut unmatched = self
            .pieces
            .iter()
            .filter(|piece| piece.fate != PieceFate::Paired);
        part.is_some() && unmatched.any(is_of_part)
    }

    /// Converts a point from frame coordinates to a design's own coordinates.
    fn to_design(&self, side: Side, p: DVec2) -> DVec2 {
        self.frame_from_design[side].inverse().apply(p)
    }

    /// Converts a pair of points from frame coordinates to the designs' own coordinates.
    fn to_designs(&self, pair: &PointPair) -> PointPair {
        SourceTarget::from_fn(|side| self.to_design(side, pair[side]))
    }

    /// Converts the point of a pair in one design from that design's own coordinates to frame
    /// coordinates.
    fn to_frame(&self, pair: &PointPair, side: Side) -> DVec2 {
        self.frame_from_design[side].apply(pair[side])
    }
}
