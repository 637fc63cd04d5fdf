//! How the panes of the editor are looked at: both designs, and the film between them.

use bevy::prelude::Vec2;

use crate::geometry::Side;

/// The least and the most that a pane is enlarged: bounds that keep a slip of the wheel from
/// losing the design. No test needs these very numbers.
const ZOOMS: [f32; 2] = [0.2, 100.0];

/// What is seen of a design or of the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EditorPane {
    /// One of the designs.
    Design(Side),
    /// The film between them.
    Film,
}

/// How far a pane was moved and enlarged from where all of it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaneView {
    /// How far it was moved, in logical pixels, y down.
    pub pan: Vec2,
    /// How much larger than fitted.
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
        let zoom = (self.zoom * factor).clamp(ZOOMS[0], ZOOMS[1]);
        // What lies under `at` is (at - pan) / zoom from the middle, before and after.
        self.pan = at + (self.pan - at) * (zoom / self.zoom);
        self.zoom = zoom;
    }
}

/// The panes of the editor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EditorPanes {
    /// The film is shown beside the designs.
    pub film: bool,
    /// What is done to one pane is done to all.
    pub together: bool,
    views: [PaneView; 3],
    moved_last: EditorPane,
}

impl Default for EditorPanes {
    fn default() -> Self {
        Self {
            film: true,
            together: true,
            views: [PaneView::default(); 3],
            moved_last: EditorPane::Film,
        }
    }
}

impl EditorPanes {
    /// How a pane is looked at.
    #[must_use]
    pub fn view(&self, pane: EditorPane) -> PaneView {
        self.views[index(pane)]
    }

    /// Shows all of everything again.
    pub fn fit(&mut self) {
        self.views = [PaneView::default(); 3];
    }

    /// Lets all go together, as the one that was moved last, or each alone.
    pub fn set_together(&mut self, together: bool) {
        self.together = together;
        if together {
            self.views = [self.view(self.moved_last); 3];
        }
    }

    /// Moves a pane, or all.
    pub fn pan(&mut self, pane: EditorPane, delta: Vec2) {
        for view in self.moved(pane) {
            view.pan += delta;
        }
    }

    /// Enlarges a pane, or all, about a point given in logical pixels from its middle, y down.
    pub fn zoom_at(&mut self, pane: EditorPane, at: Vec2, factor: f32) {
        for view in self.moved(pane) {
            view.zoom_at(at, factor);
        }
    }

    fn moved(&mut self, pane: EditorPane) -> &mut [PaneView] {
        self.moved_last = pane;
        if self.together {
            &mut self.views
        } else {
            std::slice::from_mut(&mut self.views[index(pane)])
        }
    }
}

fn index(pane: EditorPane) -> usize {
    match pane {
        EditorPane::Design(side) => side.index(),
        EditorPane::Film => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: EditorPane = EditorPane::Design(Side::Source);

    #[test]
    fn what_is_under_the_pointer_stays_there() {
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
    fn panes_go_together_or_apart() {
        let mut panes = EditorPanes {
            together: false,
            ..EditorPanes::default()
        };
        panes.pan(SOURCE, Vec2::X);
        assert_eq!(panes.view(EditorPane::Film), PaneView::default());
        panes.set_together(true);
        assert_eq!(panes.view(EditorPane::Film).pan, Vec2::X);
        panes.fit();
        assert_eq!(panes.view(SOURCE), PaneView::default());
    }
}
