//! Views of the editor's panes: pan and zoom of both designs and of the film between them.

use bevy::prelude::Vec2;

use crate::app::input::editor_action::EditorPane;

/// Minimum and maximum zoom factor (heuristic: the user cannot lose the design by a slip of the
/// wheel).
const ZOOM_RANGE: [f32; 2] = [0.2, 100.0];

/// Pan and zoom of a pane, relative to the view that fits all of its content.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaneView {
    /// Offset in logical pixels, y down.
    pub pan: Vec2,
    /// Zoom factor; 1 fits the content.
    pub zoom: f32,
}

impl Default for PaneView {
    fn default() -> Self {
        Self {
            pan: Vec2::ZERO,
            zoom: 1.0,
        }
    }
}

impl PaneView {
    fn zoom_at(&mut self, at: Vec2, factor: f32) {
        if !(factor.is_finite() && factor > 0.0) {
            return;
        }
        let zoom = (self.zoom * factor).clamp(ZOOM_RANGE[0], ZOOM_RANGE[1]);
        // Zooming keeps the content under `at` in place: (at − pan) / zoom, the offset of this
        // content from the centre, is the same before and after.
        self.pan = at + (self.pan - at) * (zoom / self.zoom);
        self.zoom = zoom;
    }
}

/// The panes of the editor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EditorPanes {
    /// Whether the film is shown next to the designs.
    pub film: bool,
    /// Whether all panes pan and zoom together.
    pub are_linked: bool,
    views: [PaneView; 3],
    moved_last: EditorPane,
}

impl Default for EditorPanes {
    fn default() -> Self {
        Self {
            film: true,
            are_linked: true,
            views: [PaneView::default(); 3],
            moved_last: EditorPane::Film,
        }
    }
}

impl EditorPanes {
    /// View of a pane.
    #[must_use]
    pub fn view(&self, pane: EditorPane) -> PaneView {
        self.views[index(pane)]
    }

    /// Resets all views, so that the content of each pane fits.
    pub fn fit(&mut self) {
        self.views = [PaneView::default(); 3];
    }

    /// Links all panes, adopting the view moved last, or unlinks them.
    pub fn set_linked(&mut self, together: bool) {
        self.are_linked = together;
        if together {
            self.views = [self.view(self.moved_last); 3];
        }
    }

    /// Pans a pane, or all if they are linked.
    pub fn pan(&mut self, pane: EditorPane, delta: Vec2) {
        for view in self.moved(pane) {
            view.pan += delta;
        }
    }

    /// Zooms a pane, or all panes if they are linked. The content at the point `at` stays in place;
    /// `at` is measured in logical pixels from the centre of the pane, y down.
    pub fn zoom_at(&mut self, pane: EditorPane, at: Vec2, factor: f32) {
        for view in self.moved(pane) {
            view.zoom_at(at, factor);
        }
    }

    /// Views affected by moving a pane: all of them if they are linked.
    fn moved(&mut self, pane: EditorPane) -> &mut [PaneView] {
        self.moved_last = pane;
        if self.are_linked {
            &mut self.views
        } else {
            std::slice::from_mut(&mut self.views[index(pane)])
        }
    }
}

/// Index of a pane's view.
fn index(pane: EditorPane) -> usize {
    match pane {
        EditorPane::Design(side) => side.index(),
        EditorPane::Film => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Side;

    /// Pane of the source design.
    const SOURCE: EditorPane = EditorPane::Design(Side::Source);

    #[test]
    fn zooming_fixes_the_point_under_the_pointer() {
        let mut panes = EditorPanes::default();
        let at = Vec2::new(30.0, -12.0);
        panes.zoom_at(SOURCE, at, 2.0);
        let view = panes.view(EditorPane::Film);
        assert_eq!(view.zoom, 2.0);
        assert!((view.pan + 2.0 * at - at).length() < 1e-4);
        panes.zoom_at(SOURCE, at, f32::NAN);
        assert_eq!(panes.view(SOURCE), view);
    }

    #[test]
    fn panes_move_linked_or_separately() {
        let mut panes = EditorPanes {
            are_linked: false,
            ..EditorPanes::default()
        };
        panes.pan(SOURCE, Vec2::X);
        assert_eq!(panes.view(EditorPane::Film), PaneView::default());
        panes.set_linked(true);
        assert_eq!(panes.view(EditorPane::Film).pan, Vec2::X);
        panes.fit();
        assert_eq!(panes.view(SOURCE), PaneView::default());
    }
}
