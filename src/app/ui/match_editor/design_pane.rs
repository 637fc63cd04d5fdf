//! Pane of one design in the match editor. It draws the picture or the fill of the design, the
//! boundary loops, hatching over unmatched parts, and labels. It converts positions between the
//! design and the window.

use bevy_egui::egui::epaint::Vertex;
use bevy_egui::egui::{Align2, Color32, Id, Mesh, Painter, Pos2, Rect, Shape, Vec2, pos2, vec2};

use crate::app::editing::panes::PaneView;
use crate::app::editing::polyline::inside_intervals;
use crate::app::editing::sheet::{MatchSheet, PieceFate, SheetPiece};
use crate::app::editing::sheet_ring::SheetRing;
use crate::app::input::editor_action::{EditorPointer, EditorTool};
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{GRID, SMALL};
use crate::app::ui::kit::widgets::text_card;
use crate::app::ui::match_editor::boundary_stripe;
use crate::app::ui::match_editor::colours::EditorColours;
use crate::app::ui::match_editor::toolbar::BAR_HEIGHT;
use crate::app::ui::ui_state::UiState;
use crate::correspondence::RingKind;
use crate::geometry::{Bounds, DVec2, Side};

/// Maximum distance of the pointer from a handle that it picks, in points: the radius of a pin
/// with its rim.
const REACH: f32 = 9.0;

/// Maximum length of the longer side of a picture that is uploaded, in pixels (resource limit: GPU
/// memory).
const MAX_IMAGE_PX: u32 = 1024;

/// Distance between hatch lines, in points. The fill must be visible between the lines.
const HATCH_SPACING: f32 = 8.0;

/// Minimum length of the longer side of a hole's bounds at which the hole is labelled, in points. A
/// label would cover a smaller hole.
const MIN_LABELLED_HOLE: f32 = 32.0;

/// Pane of one design, with the mapping from the common frame of both designs to the window.
#[derive(Clone, Debug)]
pub struct DesignPane {
    /// Design that the pane shows: source or target.
    pub side: Side,
    /// Rectangle of the pane in the window.
    pub rect: Rect,
    /// Rectangle in the pane into which the design is fitted, without the toolbar and the
    /// instructions.
    content_rect: Rect,
    centre: DVec2,
    px_per_unit: f64,
    pan: Vec2,
}

impl DesignPane {
    /// Fits the bounds of the design into `content_rect`, then applies the zoom and pan of `view`.
    pub fn new(side: Side, rect: Rect, content_rect: Rect, bounds: Bounds, view: PaneView) -> Self {
        // The bounds of a line may have no height. The minimum avoids a division by zero.
        let size = bounds.size().max(DVec2::splat(f64::MIN_POSITIVE));
        let fitted = (f64::from(content_rect.width().max(1.0)) / size.x)
            .min(f64::from(content_rect.height().max(1.0)) / size.y);
        Self {
            side,
            rect,
            content_rect,
            centre: bounds.centre(),
            px_per_unit: fitted * f64::from(view.zoom),
            pan: vec2(view.pan.x, view.pan.y),
        }
    }

    /// Returns the offset from the centre of the pane to the centre of the rectangle into which the
    /// design is fitted.
    pub fn content_offset(&self) -> Vec2 {
        self.content_rect.center() - self.rect.center()
    }

    /// Returns the rectangle of the other design's pane.
    pub fn opposite_pane(&self) -> Rect {
        let dx = match self.side {
            Side::Source => self.rect.width(),
            Side::Target => -self.rect.width(),
        };
        self.rect.translate(vec2(dx, 0.0))
    }

    /// Converts a point of the common frame of both designs to a position in the window.
    pub fn px(&self, p: DVec2) -> Pos2 {
        let from_centre = (p - self.centre) * self.px_per_unit;
        // The y axis points up in the common frame and down in the window.
        let offset = vec2(from_centre.x as f32, -from_centre.y as f32);
        self.content_rect.center() + self.pan + offset
    }

    /// Converts the pointer position `at` in the window to the common frame of both designs, in
    /// which the match editor works. `is_free` turns snapping off.
    pub fn pointer_target(&self, at: Pos2, is_free: bool) -> EditorPointer {
        let offset = at - self.content_rect.center() - self.pan;
        let offset = DVec2::new(f64::from(offset.x), -f64::from(offset.y));
        EditorPointer {
            side: self.side,
            position: self.centre + offset / self.px_per_unit,
            pick_radius: f64::from(REACH) / self.px_per_unit,
            ignores_snapping: is_free,
        }
    }

    /// Returns `painter`, clipped to this pane.
    pub fn clip(&self, painter: &Painter) -> Painter {
        painter.with_clip_rect(self.rect.intersect(painter.clip_rect()))
    }

    /// Draws the design with its match and its labels, but without the handles that the user drags.
    pub fn draw(&self, stage: &Painter, state: &UiState, colours: &EditorColours) {
        let painter = self.clip(stage);
        let sheet = &state.sheet;
        self.picture(&painter, sheet);
        if sheet.shows_pictures() {
            // Only the title is drawn over a picture. The fill and the outline traced from the
            // picture would cover it.
            return self.title(&painter, state, colours);
        }
        self.fill(&painter, state, colours);
        for (k, piece) in sheet.pieces.iter().enumerate() {
            if self.is_unmatched(piece) {
                self.hatch(&painter, sheet, k, colours.faint);
            }
        }
        self.boundaries(&painter, sheet, colours);
        self.parts(&painter, state, colours);
        self.title(&painter, state, colours);
    }

    /// Draws the picture of the design, if the project blends pictures.
    fn picture(&self, painter: &Painter, sheet: &MatchSheet) {
        let sides = sheet.sides.as_ref().filter(|_| sheet.shows_pictures());
        let Some(picture) = sides.and_then(|sides| sides[self.side].picture.as_ref()) else {
            return;
        };
        let id = Id::new(("backdrop", self.side.index()));
        let texture = texture(painter.ctx(), id, picture.pixels(), MAX_IMAGE_PX);
        let (width, height) = picture.pixels().dimensions();
        let corner = |x: f64, y: f64| {
            let place = DVec2::new(x * f64::from(width), y * f64::from(height));
            self.px(picture.place().apply(place))
        };
        let mut quad = Mesh::with_texture(texture.id());
        for (x, y) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            quad.vertices.push(Vertex {
                pos: corner(x, y),
                uv: pos2(x as f32, 1.0 - y as f32),
                color: Color32::WHITE,
            });
        }
        quad.add_triangle(0, 1, 2);
        quad.add_triangle(0, 2, 3);
        painter.add(Shape::mesh(quad));
    }

    fn is_unmatched(&self, piece: &SheetPiece) -> bool {
        match piece.fate {
            PieceFate::Paired => false,
            PieceFate::Disappears => self.side == Side::Source,
            PieceFate::Appears => self.side == Side::Target,
        }
    }

    fn fill(&self, painter: &Painter, state: &UiState, colours: &EditorColours) {
        let compatible = state.session.transition().and_then(|t| t.compatible());
        let Some(mesh) = compatible.filter(|_| !state.sheet.rings.is_empty()) else {
            return;
        };
        let points = match self.side {
            Side::Source => mesh.source(),
            Side::Target => mesh.target(),
        };
        let points: Vec<Pos2> = points.iter().map(|p| self.px(*p)).collect();
        let colour = colours.fills[self.side];
        let mut filled = Mesh::default();
        for p in &points {
            filled.colored_vertex(*p, colour);
        }
        for [a, b, c] in mesh.faces().iter() {
            filled.add_triangle(*a, *b, *c);
        }
        painter.add(Shape::mesh(filled));
        if state.editor.triangles {
            let stroke = (0.75, colours.faint);
            for face in mesh.faces().iter() {
                for k in 0..3 {
                    let (a, b) = (face[k], face[(k + 1) % 3]);
                    // Two neighbouring faces contain their common edge in opposite directions. The
                    // condition holds for one of them, so the edge is drawn once.
                    if a < b {
                        painter.line_segment([points[a as usize], points[b as usize]], stroke);
                    }
                }
            }
        }
    }

    fn boundaries(&self, painter: &Painter, sheet: &MatchSheet, colours: &EditorColours) {
        if sheet.rings.is_empty() {
            for ring in self.parts_of(sheet).iter().flatten() {
                let stroke = (2.0, colours.faint);
                painter.add(Shape::closed_line(self.line(ring), stroke));
            }
        }
        for (k, ring) in sheet.rings.iter().enumerate() {
            let piece = sheet.pieces.get(ring.piece);
            let is_unmatched = piece.is_some_and(|piece| piece.fate != PieceFate::Paired);
            let points = self.line(&ring.sides[self.side]);
            if ring.kind == RingKind::Matched && !is_unmatched {
                boundary_stripe::stripe(painter, &points, &ring.positions, k, colours.is_light);
            } else {
                draw_unmatched_ring(painter, points, colours);
                if !is_unmatched {
                    self.label_hole(painter, ring, colours);
                }
            }
        }
    }

    /// Returns the parts of the design; each part is an outline followed by its holes.
    fn parts_of<'a>(&self, sheet: &'a MatchSheet) -> &'a [Vec<Vec<DVec2>>] {
        let sides = sheet.sides.as_ref();
        sides.map_or(&[], |sides| &sides[self.side].parts)
    }

    fn line(&self, points: &[DVec2]) -> Vec<Pos2> {
        points.iter().map(|p| self.px(*p)).collect()
    }

    /// Labels a hole that exists in only one design with "closes" or "opens".
    fn label_hole(&self, painter: &Painter, ring: &SheetRing, colours: &EditorColours) {
        let text = match (ring.kind, self.side) {
            (RingKind::Closes, Side::Source) => "closes",
            (RingKind::Opens, Side::Target) => "opens",
            _ => return,
        };
        let bounds = Rect::from_points(&self.line(&ring.sides[self.side]));
        // A smaller hole is marked only by its dashed boundary; the label appears when the user
        // zooms in.
        if bounds.size().max_elem() > MIN_LABELLED_HOLE {
            label_card(painter, bounds.center(), text, colours, false);
        }
    }

    /// Draws hatch lines at 45° over a piece that exists in only one design.
    fn hatch(&self, painter: &Painter, sheet: &MatchSheet, piece: usize, colour: Color32) {
        // The boundary loops are rotated by 45°, so that the hatch lines are horizontal.
        let rotate = |p: &DVec2| {
            let p = self.px(*p);
            DVec2::new(f64::from(p.x + p.y), f64::from(p.y - p.x))
        };
        let rings: Vec<Vec<DVec2>> = sheet
            .rings
            .iter()
            .filter(|ring| ring.piece == piece)
            .map(|ring| ring.sides[self.side].iter().map(rotate).collect())
            .collect();
        let Some(bounds) = Bounds::of(rings.iter().flatten().copied()) else {
            return;
        };
        // The mapping of (x, y) to (x + y, y − x) is a rotation that also scales by √2.
        let step = f64::from(HATCH_SPACING) * std::f64::consts::SQRT_2;
        // Lines outside the pane are skipped. If the user has zoomed in far, most lines are
        // outside.
        let visible = self.rect.expand(HATCH_SPACING);
        let mut y = (bounds.min.y / step).ceil() * step;
        let min_visible = f64::from(visible.top() - visible.right());
        y = y.max((min_visible / step).floor() * step);
        let max_y = bounds
            .max
            .y
            .min(f64::from(visible.bottom() - visible.left()));
        while y <= max_y {
            for [a, b] in inside_intervals(rings.iter().map(Vec::as_slice), y) {
                let unrotated = |x: f64| pos2(((x - y) / 2.0) as f32, ((x + y) / 2.0) as f32);
                painter.line_segment([unrotated(a), unrotated(b)], (1.0, colour));
            }
            y += step;
        }
    }

    fn parts(&self, painter: &Painter, state: &UiState, colours: &EditorColours) {
        let (sheet, editor) = (&state.sheet, &state.editor);
        let outline = |part: usize, width: f32| {
            for ring in self.parts_of(sheet).get(part).into_iter().flatten() {
                painter.add(Shape::closed_line(self.line(ring), (width, colours.accent)));
            }
        };
        if let Some((_, part)) = editor.part.filter(|(side, _)| *side == self.side) {
            outline(part, 3.0);
        }
        if let Some((_, part, _)) = editor.first_part.filter(|(side, ..)| *side == self.side) {
            outline(part, 5.0);
        }
        // A single piece needs no name, except while the user pairs parts.
        let is_plain = sheet.pieces.len() < 2 && editor.tool != EditorTool::Parts;
        if is_plain {
            return;
        }
        for (k, piece) in sheet.pieces.iter().enumerate() {
            let text = match (piece.fate, self.is_unmatched(piece)) {
                (PieceFate::Disappears, true) => format!("{} disappears", piece.name),
                (PieceFate::Appears, true) => format!("{} appears", piece.name),
                _ => piece.name.clone(),
            };
            let at = self.px(piece.label_at[self.side]) + self.name_offset(sheet, k);
            label_card(painter, at, &text, colours, piece.is_linked);
        }
    }

    /// Returns the offset of a piece's name from the default place inside the piece. The name of a
    /// small piece is drawn above the piece.
    fn name_offset(&self, sheet: &MatchSheet, piece: usize) -> Vec2 {
        /// Minimum length, in points, of the longer side of a piece's bounds at which the name is
        /// drawn inside the piece.
        const MIN_SIZE_FOR_NAME: f32 = 56.0;
        let rings = sheet.rings.iter().filter(|ring| ring.piece == piece);
        let points = rings.flat_map(|ring| self.line(&ring.sides[self.side]));
        let bounds = Rect::from_points(&points.collect::<Vec<_>>());
        if bounds.size().max_elem() < MIN_SIZE_FOR_NAME {
            vec2(0.0, -bounds.height() / 2.0 - 14.0)
        } else {
            Vec2::ZERO
        }
    }

    fn title(&self, painter: &Painter, state: &UiState, colours: &EditorColours) {
        let name = state
            .session
            .transition()
            .map(|t| t.designs()[self.side].name.clone())
            .unwrap_or_default();
        let role = ["Source", "Target"][self.side];
        let at = self.rect.left_top() + vec2(2.0 * GRID, BAR_HEIGHT + 2.0 * GRID);
        let text = format!("{role}  {name}");
        painter.text(at, Align2::LEFT_TOP, text, SMALL, colours.ink);
    }
}

/// Draws an unmatched boundary loop as a dashed line, or as a small circle if the loop is tiny on
/// the screen.
fn draw_unmatched_ring(painter: &Painter, mut points: Vec<Pos2>, colours: &EditorColours) {
    let Some(first) = points.first().copied() else {
        return;
    };
    if Rect::from_points(&points).size().max_elem() < 3.0 {
        painter.circle_stroke(first, 4.0, (1.5, colours.ink));
        return;
    }
    points.push(first);
    let stroke = (2.0, colours.ink);
    painter.extend(Shape::dashed_line(&points, stroke, 5.0, 4.0));
}

/// Draws a label on a card centred at `at`. The border of the card has the accent colour if the
/// user set the match by hand (`is_manual`).
pub fn label_card(
    painter: &Painter,
    at: Pos2,
    text: &str,
    colours: &EditorColours,
    is_manual: bool,
) {
    let galley = painter.layout_no_wrap(text.to_owned(), SMALL, colours.ink);
    let card = Align2::CENTER_CENTER.anchor_size(at, galley.size() + vec2(10.0, 4.0));
    let line = if is_manual {
        (2.0, colours.accent)
    } else {
        (1.0, colours.faint)
    };
    text_card(painter, card, galley, colours.ground, line);
}
