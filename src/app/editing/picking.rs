//! Picking in the match editor: which handle, boundary or corner is under the pointer.

use crate::app::editing::editor::{CutEnd, EditorGrab, EditorHandle};
use crate::app::editing::sheet::{MatchSheet, SheetCut};
use crate::app::input::editor_action::EditorPointer;
use crate::correspondence::RingCut;
use crate::geometry::{DVec2, Side, SourceTarget};

impl MatchSheet {
    /// Position of a handle in one design; `None` if the handle exists only in the other design.
    #[must_use]
    pub fn handle_position(&self, handle: EditorHandle, side: Side) -> Option<DVec2> {
        match handle {
            EditorHandle::Pin(k) => self.pins.get(k).map(|pin| pin[side]),
            EditorHandle::Feature(k) => self.features.get(k).map(|pair| pair[side]),
            EditorHandle::Line(k, end) => self.lines.get(k).map(|line| line[side][end]),
            EditorHandle::Cut(k, end) => {
                let cut = self.cuts.get(k)?.cut;
                (cut.side == side).then_some(match end {
                    CutEnd::Outer => cut.outer,
                    CutEnd::Hole => cut.hole,
                })
            }
        }
    }

    /// The cut to draw: the cut as requested while the user drags it, otherwise the cut that the
    /// match uses.
    #[must_use]
    pub fn cut_to_draw(&self, cut: &SheetCut, grab: Option<EditorGrab>) -> RingCut {
        let is_dragged =
            matches!(grab, Some(EditorGrab::Cut(k, _)) if cut.requested_index == Some(k));
        cut.requested.filter(|_| is_dragged).unwrap_or(cut.cut)
    }

    /// All handles, topmost first.
    pub fn handles(&self) -> impl Iterator<Item = EditorHandle> {
        let cuts = (0..self.cuts.len()).flat_map(|k| {
            [
                EditorHandle::Cut(k, CutEnd::Outer),
                EditorHandle::Cut(k, CutEnd::Hole),
            ]
        });
        let features = (0..self.features.len()).map(EditorHandle::Feature);
        let lines = (0..self.lines.len())
            .flat_map(|k| [EditorHandle::Line(k, 0), EditorHandle::Line(k, 1)]);
        (0..self.pins.len())
            .map(EditorHandle::Pin)
            .chain(lines.filter(|_| self.has_free_pins()))
            .chain(cuts)
            .chain(features)
    }

    /// Nearest handle within the pointer's pick radius.
    #[must_use]
    pub fn handle_at(&self, touch: EditorPointer) -> Option<EditorHandle> {
        let in_reach = self.handles().filter_map(|handle| {
            let distance = self
                .handle_position(handle, touch.side)?
                .distance(touch.position);
            (distance <= touch.pick_radius).then_some((distance, handle))
        });
        // Of handles at the same distance, `min_by` returns the first, which is topmost.
        in_reach
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, handle)| handle)
    }

    /// Position where a new or moved pin lands: on a corner, on the boundary, or, if pins may lie
    /// anywhere, exactly at the pointer.
    #[must_use]
    pub fn pin_position(&self, touch: EditorPointer, snaps: bool) -> Option<DVec2> {
        if self.shows_pictures() {
            return Some(touch.position);
        }
        // A corner wins over the boundary it lies on.
        let corner = (snaps && !touch.ignores_snapping)
            .then(|| self.corner_near(touch.side, touch.position, touch.pick_radius))
            .flatten();
        let on_boundary = || {
            let foot = self.nearest_boundary_point(touch.side, touch.position)?;
            let snaps_to_boundary = !self.has_free_pins()
                || foot.distance <= touch.pick_radius && snaps && !touch.ignores_snapping;
            Some(if snaps_to_boundary {
                foot.point
            } else {
                touch.position
            })
        };
        corner.or_else(on_boundary)
    }

    /// The boundary point under the pointer and the point matched with it, in the order source,
    /// target.
    #[must_use]
    pub fn trace(&self, touch: EditorPointer) -> Option<[DVec2; 2]> {
        if self.has_free_pins() {
            return None;
        }
        let foot = self.nearest_boundary_point(touch.side, touch.position)?;
        let point = (foot.distance <= touch.pick_radius).then_some(foot.point)?;
        let partner = self.matched_point(touch.side, point)?;
        Some(SourceTarget::with_side(touch.side, point, partner).to_array())
    }
}
