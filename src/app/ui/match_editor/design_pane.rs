//! One half of the match editor: a design, filled, with its boundary and its parts.

use bevy_egui::egui::epaint::Vertex;
use bevy_egui::egui::{Align2, Color32, Id, Mesh, Painter, Pos2, Rect, Shape, Vec2, pos2, vec2};

use crate::app::editing::panes::PaneView;
use crate::app::editing::polyline::spans;
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

/// How near the pointer must come, in points: the disc of a pin and its rim.
const REACH: f32 = 9.0;

/// Longest side of a picture behind the points, in pixels.
const LONGEST_PX: u32 = 1024;

/// Distance of the lines of a hatching, in points: wide enough for the fill to be seen between
/// them.
const HATCH: f32 = 8.0;

/// How large a hole is, in points, that has room for a word about it.
const HOLE_WORD: f32 = 32.0;

/// Where one design lies in the window.
#[derive(Clone, Debug)]
pub struct DesignPane {
    /// Which design.
    pub side: Side,
    /// The half of the stage.
    pub rect: Rect,
    /// The part of it that the design is fitted into.
    room: Rect,
    centre: DVec2,
    px_per_unit: f64,
    pan: Vec2,
}

impl DesignPane {
    /// Fits a box into `room`, and moves and enlarges it as it is looked at.
    pub fn new(side: Side, rect: Rect, room: Rect, bounds: Bounds, view: PaneView) -> Self {
        // A level line has no height, and nothing can be fitted into that.
        let size = bounds.size().max(DVec2::splat(f64::MIN_POSITIVE));
        let fitted = (f64::from(room.width().max(1.0)) / size.x)
            .min(f64::from(room.height().max(1.0)) / size.y);
        Self {
            side,
            rect,
            room,
            centre: bounds.centre(),
            px_per_unit: fitted * f64::from(view.zoom),
            pan: vec2(view.pan.x, view.pan.y),
        }
    }

    /// The middle of what the design is fitted into, from the middle of the half.
    pub fn room_offset(&self) -> Vec2 {
        self.room.center() - self.rect.center()
    }

    /// The other half.
    pub fn across(&self) -> Rect {
        let by = match self.side {
            Side::Source => self.rect.width(),
            Side::Target => -self.rect.width(),
        };
        self.rect.translate(vec2(by, 0.0))
    }

    /// Where a point of the frame is drawn.
    pub fn px(&self, p: DVec2) -> Pos2 {
        let from_centre = (p - self.centre) * self.px_per_unit;
        // y is up in the frame and down on the screen.
        let offset = vec2(from_centre.x as f32, -from_centre.y as f32);
        self.room.center() + self.pan + offset
    }

    /// What the hand points to.
    pub fn touch(&self, at: Pos2, is_free: bool) -> EditorPointer {
        let offset = at - self.room.center() - self.pan;
        let offset = DVec2::new(f64::from(offset.x), -f64::from(offset.y));
        EditorPointer {
            side: self.side,
            at: self.centre + offset / self.px_per_unit,
            reach: f64::from(REACH) / self.px_per_unit,
            is_free,
        }
    }

    /// Draws within this half only.
    pub fn clip(&self, painter: &Painter) -> Painter {
        painter.with_clip_rect(self.rect.intersect(painter.clip_rect()))
    }

    /// Draws the design and its match.
    pub fn draw(&self, stage: &Painter, scene: &UiState, inks: &EditorColours) {
        let painter = self.clip(stage);
        let sheet = &scene.sheet;
        self.picture(&painter, sheet);
        if sheet.in_colours() {
            // A picture is what is seen, and its outline only what was found in it.
            return self.title(&painter, scene, inks);
        }
        self.fill(&painter, scene, inks);
        for (k, piece) in sheet.pieces.iter().enumerate() {
            if self.is_alone(piece) {
                self.hatch(&painter, sheet, k, inks.faint);
            }
        }
        self.boundaries(&painter, sheet, inks);
        self.parts(&painter, scene, inks);
        self.title(&painter, scene, inks);
    }

    /// The picture that the design came as, where pictures are what is seen.
    fn picture(&self, painter: &Painter, sheet: &MatchSheet) {
        let sides = sheet.sides.as_ref().filter(|_| sheet.in_colours());
        let Some(picture) = sides.and_then(|sides| sides[self.side].picture.as_ref()) else {
            return;
        };
        let id = Id::new(("backdrop", self.side.index()));
        let texture = texture(painter.ctx(), id, picture.pixels(), LONGEST_PX);
        let (width, height) = picture.pixels().dimensions();
        let corner = |x: f64, y: f64| {
            let own = DVec2::new(x * f64::from(width), y * f64::from(height));
            self.px(picture.place().apply(own))
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

    fn is_alone(&self, piece: &SheetPiece) -> bool {
        match piece.fate {
            PieceFate::Paired => false,
            PieceFate::Dies => self.side == Side::Source,
            PieceFate::Born => self.side == Side::Target,
        }
    }

    fn fill(&self, painter: &Painter, scene: &UiState, inks: &EditorColours) {
        let compatible = scene.session.transition().and_then(|t| t.compatible());
        let Some(mesh) = compatible.filter(|_| !scene.sheet.rings.is_empty()) else {
            return;
        };
        let points = match self.side {
            Side::Source => mesh.source(),
            Side::Target => mesh.target(),
        };
        let points: Vec<Pos2> = points.iter().map(|p| self.px(*p)).collect();
        let colour = inks.fills[self.side];
        let mut filled = Mesh::default();
        for p in &points {
            filled.colored_vertex(*p, colour);
        }
        for [a, b, c] in mesh.faces().iter() {
            filled.add_triangle(*a, *b, *c);
        }
        painter.add(Shape::mesh(filled));
        if scene.editor.triangles {
            let stroke = (0.75, inks.faint);
            for face in mesh.faces().iter() {
                for k in 0..3 {
                    let (a, b) = (face[k], face[(k + 1) % 3]);
                    // Two faces share an edge and run along it in opposite directions: once is
                    // enough.
                    if a < b {
                        painter.line_segment([points[a as usize], points[b as usize]], stroke);
                    }
                }
            }
        }
    }

    fn boundaries(&self, painter: &Painter, sheet: &MatchSheet, inks: &EditorColours) {
        if sheet.rings.is_empty() {
            for ring in self.parts_of(sheet).iter().flatten() {
                let stroke = (2.0, inks.faint);
                painter.add(Shape::closed_line(self.line(ring), stroke));
            }
        }
        for (k, ring) in sheet.rings.iter().enumerate() {
            let piece = sheet.pieces.get(ring.piece);
            let is_alone = piece.is_some_and(|piece| piece.fate != PieceFate::Paired);
            let points = self.line(&ring.sides[self.side]);
            if ring.kind == RingKind::Matched && !is_alone {
                boundary_stripe::stripe(painter, &points, &ring.places, k, inks.is_light);
            } else {
                unmatched(painter, points, inks);
                if !is_alone {
                    self.hole_word(painter, ring, inks);
                }
            }
        }
    }

    /// The parts of the design, each an outline and its holes.
    fn parts_of<'a>(&self, sheet: &'a MatchSheet) -> &'a [Vec<Vec<DVec2>>] {
        let sides = sheet.sides.as_ref();
        sides.map_or(&[], |sides| &sides[self.side].parts)
    }

    fn line(&self, points: &[DVec2]) -> Vec<Pos2> {
        points.iter().map(|p| self.px(*p)).collect()
    }

    /// What becomes of a hole, where it is one.
    fn hole_word(&self, painter: &Painter, ring: &SheetRing, inks: &EditorColours) {
        let word = match (ring.kind, self.side) {
            (RingKind::Closes, Side::Source) => "closes",
            (RingKind::Opens, Side::Target) => "opens",
            _ => return,
        };
        let bounds = Rect::from_points(&self.line(&ring.sides[self.side]));
        // The word would hide what is smaller: its dashes tell as much, and it is there as
        // soon as one zooms in.
        if bounds.size().max_elem() > HOLE_WORD {
            label_card(painter, bounds.center(), word, inks, false);
        }
    }

    /// Lines across a piece that has no partner.
    fn hatch(&self, painter: &Painter, sheet: &MatchSheet, piece: usize, colour: Color32) {
        // Turned by an eighth, so that the lines run level.
        let turned = |p: &DVec2| {
            let p = self.px(*p);
            DVec2::new(f64::from(p.x + p.y), f64::from(p.y - p.x))
        };
        let rings: Vec<Vec<DVec2>> = sheet
            .rings
            .iter()
            .filter(|ring| ring.piece == piece)
            .map(|ring| ring.sides[self.side].iter().map(turned).collect())
            .collect();
        let Some(bounds) = Bounds::of(rings.iter().flatten().copied()) else {
            return;
        };
        // Turning stretches by the root of two as well: x + y and y - x have no halves.
        let step = f64::from(HATCH) * std::f64::consts::SQRT_2;
        // Zoomed in a hundred times, most of the lines would lie outside.
        let visible = self.rect.expand(HATCH);
        let mut y = (bounds.min.y / step).ceil() * step;
        let least = f64::from(visible.top() - visible.right());
        y = y.max((least / step).floor() * step);
        let most = bounds
            .max
            .y
            .min(f64::from(visible.bottom() - visible.left()));
        while y <= most {
            for [a, b] in spans(rings.iter().map(Vec::as_slice), y) {
                let back = |x: f64| pos2(((x - y) / 2.0) as f32, ((x + y) / 2.0) as f32);
                painter.line_segment([back(a), back(b)], (1.0, colour));
            }
            y += step;
        }
    }

    fn parts(&self, painter: &Painter, scene: &UiState, inks: &EditorColours) {
        let (sheet, editor) = (&scene.sheet, &scene.editor);
        let outline = |part: usize, width: f32| {
            for ring in self.parts_of(sheet).get(part).into_iter().flatten() {
                painter.add(Shape::closed_line(self.line(ring), (width, inks.accent)));
            }
        };
        if let Some((_, part)) = editor.part.filter(|(side, _)| *side == self.side) {
            outline(part, 3.0);
        }
        if let Some((_, part, _)) = editor.first_part.filter(|(side, ..)| *side == self.side) {
            outline(part, 5.0);
        }
        // One part needs no name.
        let is_plain = sheet.pieces.len() < 2 && editor.tool != EditorTool::Parts;
        if is_plain {
            return;
        }
        for (k, piece) in sheet.pieces.iter().enumerate() {
            let word = match (piece.fate, self.is_alone(piece)) {
                (PieceFate::Dies, true) => format!("{} dies", piece.name),
                (PieceFate::Born, true) => format!("{} is born", piece.name),
                _ => piece.name.clone(),
            };
            let at = self.px(piece.at[self.side]) + self.beside(sheet, k);
            label_card(painter, at, &word, inks, piece.is_linked);
        }
    }

    /// How far from its place a name stands: above what it would cover.
    fn beside(&self, sheet: &MatchSheet, piece: usize) -> Vec2 {
        const ROOMY: f32 = 56.0;
        let rings = sheet.rings.iter().filter(|ring| ring.piece == piece);
        let points = rings.flat_map(|ring| self.line(&ring.sides[self.side]));
        let bounds = Rect::from_points(&points.collect::<Vec<_>>());
        if bounds.size().max_elem() < ROOMY {
            vec2(0.0, -bounds.height() / 2.0 - 14.0)
        } else {
            Vec2::ZERO
        }
    }

    fn title(&self, painter: &Painter, scene: &UiState, inks: &EditorColours) {
        let name = scene
            .session
            .transition()
            .map(|t| t.designs()[self.side].name.clone())
            .unwrap_or_default();
        let role = ["Source", "Target"][self.side];
        let at = self.rect.left_top() + vec2(2.0 * GRID, BAR_HEIGHT + 2.0 * GRID);
        let words = format!("{role}  {name}");
        painter.text(at, Align2::LEFT_TOP, words, SMALL, inks.ink);
    }
}

/// A boundary without a partner: broken, or a dot where it is a point.
fn unmatched(painter: &Painter, mut points: Vec<Pos2>, inks: &EditorColours) {
    let Some(first) = points.first().copied() else {
        return;
    };
    if Rect::from_points(&points).size().max_elem() < 3.0 {
        painter.circle_stroke(first, 4.0, (1.5, inks.ink));
        return;
    }
    points.push(first);
    let stroke = (2.0, inks.ink);
    painter.extend(Shape::dashed_line(&points, stroke, 5.0, 4.0));
}

/// A word on a card; framed where it was said by hand.
pub fn label_card(painter: &Painter, at: Pos2, word: &str, inks: &EditorColours, is_said: bool) {
    let galley = painter.layout_no_wrap(word.to_owned(), SMALL, inks.ink);
    let card = Align2::CENTER_CENTER.anchor_size(at, galley.size() + vec2(10.0, 4.0));
    let line = if is_said {
        (2.0, inks.accent)
    } else {
        (1.0, inks.faint)
    };
    text_card(painter, card, galley, inks.ground, line);
}
