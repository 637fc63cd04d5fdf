//! Map of all designs, which replaces the stage while it is open. On the left is the map with its
//! marker and path; on the right is the blend under the marker, with a legend of its weights.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use bevy_egui::egui::{
    Align2, Color32, FontId, Id, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, pos2, vec2,
};
use image::RgbaImage;

use crate::app::input::intent::Intent;
use crate::app::map::pictures::MapPictures;
use crate::app::map::thumbnails::MAP_HALF_SIDE;
use crate::app::ui::kit::icons;
use crate::app::ui::kit::texture::texture;
use crate::app::ui::kit::theme::{GRID, ThemePalette};
use crate::app::ui::stage::area::ink_on;
use crate::app::ui::ui_state::{Intents, UiState};
use crate::colour::Rgb;
use crate::geometry::DVec2;

/// Radius of the map's marker, in points.
const MARKER_RADIUS: f32 = 11.0;

/// Thickness of the ring around the marker that shows the weights, in points.
const RING_WIDTH: f32 = 4.0;

/// Maximum distance between the pointer and a design that it grabs, in points.
const GRAB_DISTANCE: f32 = 40.0;

/// Maximum length of the longer side of a picture that is uploaded, in pixels (resource limit: GPU
/// memory).
const MAX_IMAGE_PX: u32 = 2048;

/// State of a drag on the map.
#[derive(Clone, Default)]
struct MapDrag {
    /// Index of the design that the user moves; `None` if the drag moves no design.
    design: Option<usize>,
    /// Points of the line that the user draws as a path, in map coordinates.
    line: Vec<DVec2>,
}

/// Draws the map, the blend and the legend, and handles the pointer on the map. Returns the
/// rectangle of the blend.
pub fn show(root: &mut Ui, state: &UiState, stage: Rect, intents: &mut Intents) -> Rect {
    let half = vec2((stage.width() / 2.0).floor(), stage.height());
    let left = Rect::from_min_size(stage.min, half);
    let mut right = left.translate(vec2(half.x, 0.0));
    let background = state.session.style().ground;
    let [r, g, b] = background.0;
    root.painter()
        .rect_filled(stage, 0.0, Color32::from_rgb(r, g, b));
    let ink = ink_on(background);
    let Some(pictures) = state.map.pictures() else {
        map_status(root, state, stage, ink);
        return right;
    };
    let line = Stroke::new(1.0, ink.gamma_multiply(0.5));
    root.painter().vline(right.left(), right.y_range(), line);
    // The space below the blend is for the legend of the weights.
    let height = WeightLegend::height(root, pictures, right.width());
    let below = right.split_top_bottom_at_y(right.bottom() - height).1;
    right.max.y = below.top();
    let side = left.width().min(left.height());
    let square = Rect::from_center_size(left.center(), vec2(side, side));
    handle_drag(root, state, pictures, square, intents);
    draw(root, state, pictures, left, square, ink);
    if let Some(picture) = pictures.blend() {
        image(root, "the blend", picture, right, Color32::WHITE);
    }
    draw_legend(root, state, pictures, below, ink);
    right
}

fn map_status(ui: &Ui, state: &UiState, rect: Rect, ink: Color32) {
    let words = match state.map.problem() {
        Some(problem) => problem.to_string(),
        None if state.session.whole_project().is_none() => {
            "Open a project with several designs, or drop several files here.".to_owned()
        }
        None => "Laying out the map …".to_owned(),
    };
    let font = FontId::proportional(14.0);
    let galley = ui
        .painter()
        .layout(words, font, ink, rect.width() - 4.0 * GRID);
    let at = Align2::CENTER_CENTER.anchor_size(rect.center(), galley.size());
    ui.painter().galley(at.min, galley, ink);
}

/// Converts map coordinates to a position in the window; `square` is the rectangle of the map.
fn on_screen(square: Rect, place: DVec2) -> Pos2 {
    let fraction = (place / MAP_HALF_SIDE).as_vec2() * 0.5;
    let offset = vec2(fraction.x, -fraction.y) * square.width();
    square.center() + offset
}

/// Converts a position in the window to map coordinates; `square` is the rectangle of the map.
fn on_map(square: Rect, at: Pos2) -> DVec2 {
    let offset = (at - square.center()) / square.width() * 2.0;
    DVec2::new(f64::from(offset.x), f64::from(-offset.y)) * MAP_HALF_SIDE
}

/// Handles clicks and drags on the map, which move the marker, extend the path or, with Shift, move
/// a design.
fn handle_drag(
    root: &Ui,
    state: &UiState,
    pictures: &MapPictures,
    square: Rect,
    intents: &mut Intents,
) {
    let id = root.id().with("map");
    let response = root.interact(square, id, Sense::click_and_drag());
    let mut drag: MapDrag = root.data(|data| data.get_temp(id)).unwrap_or_default();
    let Some(at) = response.interact_pointer_pos() else {
        // Drawing may have ended during the drag, by Esc.
        if !drag.line.is_empty() && state.map.is_drawing_path {
            intents.push(Intent::ExtendPath(std::mem::take(&mut drag.line)));
        }
        root.data_mut(|data| data.insert_temp(id, MapDrag::default()));
        return;
    };
    let place = on_map(square, at);
    if response.drag_started() && root.input(|input| input.modifiers.shift) {
        let sites = pictures.map().sites().iter().enumerate();
        let distance_to = |site: DVec2| on_screen(square, site).distance(at);
        let nearest = sites.min_by(|a, b| distance_to(*a.1).total_cmp(&distance_to(*b.1)));
        let near = nearest.filter(|(_, site)| distance_to(**site) < GRAB_DISTANCE);
        drag.design = near.map(|(design, _)| design);
    }
    match drag.design {
        Some(design) => intents.push(Intent::MoveMapDesign(design, place)),
        // While the button is pressed, each new pointer position extends the line.
        None if state.map.is_drawing_path && drag.line.last() != Some(&place) => {
            drag.line.push(place)
        }
        None if state.map.is_drawing_path => {}
        None if place != state.map.marker() => intents.push(Intent::MoveMarker(place)),
        None => {}
    }
    root.data_mut(|data| data.insert_temp(id, drag));
}

fn draw(
    root: &Ui,
    state: &UiState,
    pictures: &MapPictures,
    left: Rect,
    square: Rect,
    ink: Color32,
) {
    let painter = root.painter_at(left);
    if let Some(contours) = pictures.contours().picture() {
        image(root, "contours", contours, square, Color32::WHITE);
    }
    if let Some(thumbnails) = pictures.thumbnails() {
        image(
            root,
            "blends",
            &thumbnails.blends,
            square,
            Color32::from_white_alpha(170),
        );
        image(root, "designs", &thumbnails.designs, square, Color32::WHITE);
    }
    let font = FontId::proportional(12.0);
    let below = square.width() * 0.072;
    for (site, design) in pictures
        .map()
        .sites()
        .iter()
        .zip(pictures.space().designs())
    {
        let at = on_screen(square, *site) + vec2(0.0, below);
        let at = at.min(left.max - vec2(0.0, 18.0));
        painter.text(at, Align2::CENTER_TOP, &design.name, font.clone(), ink);
    }
    draw_path(root, state, left, square, ink);
    draw_marker(root, state, pictures, left, square, ink);
}

/// Draws the path with its stops, the line that the user is drawing, and a star at each saved
/// blend.
fn draw_path(root: &Ui, state: &UiState, left: Rect, square: Rect, ink: Color32) {
    /// Number of straight lines that approximate each segment of the path's curve.
    const POINTS: usize = 48;
    let painter = root.painter_at(left);
    let stroke = Stroke::new(2.0, ink);
    let on = |place: DVec2| on_screen(square, place);
    if let Some(curve) = state.map.curve() {
        let count = POINTS * curve.segment_count();
        let points = (0..=count).map(|k| on(curve.at(k as f64 / POINTS as f64)));
        painter.add(Shape::line(points.collect(), stroke));
    }
    let drag: Option<MapDrag> = root.data(|data| data.get_temp(root.id().with("map")));
    if let Some(drag) = drag.filter(|drag| drag.line.len() > 1) {
        let points = drag.line.iter().map(|place| on(*place));
        painter.add(Shape::line(points.collect(), stroke));
    }
    let Some(project) = state.session.whole_project() else {
        return;
    };
    for saved in &project.map.kept {
        let place = Rect::from_center_size(on(saved.at), vec2(14.0, 14.0));
        icons::paint_icon(&painter, icons::STAR, place, ThemePalette::of(root).amber);
    }
    let path = &project.map.path;
    let first = path.places.iter().take(1).map(|place| place.at);
    let stops = path.stops().skip(1).map(|(_, stop)| stop.at);
    let [fill, font] = [contrast(ink), ink].map(|colour| (colour, FontId::proportional(11.0)));
    for (number, place) in first.chain(stops).enumerate() {
        let at = on(place);
        painter.circle(at, 9.0, fill.0, Stroke::new(1.5, ink));
        let words = format!("{}", number + 1);
        painter.text(at, Align2::CENTER_CENTER, words, font.1.clone(), font.0);
    }
}

/// Returns a fill colour on which the colour `ink` is readable.
fn contrast(ink: Color32) -> Color32 {
    match ink.r() > 127 {
        true => Color32::from_gray(24),
        false => Color32::WHITE,
    }
}

/// Draws the marker, and around it a ring whose arcs show the weights of the designs.
fn draw_marker(
    root: &Ui,
    state: &UiState,
    pictures: &MapPictures,
    left: Rect,
    square: Rect,
    ink: Color32,
) {
    let painter = root.painter_at(left);
    let at = on_screen(square, state.map.marker());
    painter.circle(at, MARKER_RADIUS, Color32::WHITE, Stroke::new(1.5, ink));
    let mut from = -FRAC_PI_2;
    for (design, &weight) in pictures.weights().iter().enumerate() {
        let sweep = weight.clamp(0.0, 1.0) as f32 * TAU;
        if sweep > 0.0 {
            let steps = (sweep * 12.0).ceil().max(1.0) as usize;
            let points = (0..=steps).map(|k| {
                let angle = from + sweep * k as f32 / steps as f32;
                at + vec2(angle.cos(), angle.sin()) * (MARKER_RADIUS + RING_WIDTH)
            });
            let stroke = Stroke::new(RING_WIDTH, colour_of(state, pictures, design));
            painter.add(Shape::line(points.collect(), stroke));
        }
        from += sweep;
    }
    painter.circle_filled(at, 2.5, ink);
}

/// Returns the colour of the design with the index `design`: the mean of its own colours or,
/// without any, its fill colour.
fn colour_of(state: &UiState, pictures: &MapPictures, design: usize) -> Color32 {
    let mut weights = vec![0.0; pictures.weights().len()];
    weights[design] = 1.0;
    let fill = || {
        let fraction = pictures.space().colour_fraction(&weights);
        state.session.style().fill_at(fraction)
    };
    let Rgb([r, g, b]) = pictures.own_colour(design).unwrap_or_else(fill);
    Color32::from_rgb(r, g, b)
}

/// Draws the legend: the designs of the blend, with their colours and weights.
fn draw_legend(root: &Ui, state: &UiState, pictures: &MapPictures, rect: Rect, ink: Color32) {
    let mut layout = WeightLegend::new(rect.width());
    for (design, words) in WeightLegend::labels(pictures, pictures.weights()) {
        let galley = root
            .painter()
            .layout_no_wrap(words, WeightLegend::font(), ink);
        let at = rect.min + layout.place(galley.size().x);
        let colour = colour_of(state, pictures, design);
        root.painter()
            .circle_filled(at + vec2(4.0, 7.0), 4.0, colour);
        root.painter()
            .galley(at + vec2(WeightLegend::DOT_WIDTH, 0.0), galley, ink);
    }
}

/// Layout of the legend: places labels from left to right in rows.
struct WeightLegend {
    width_limit: f32,
    next: Vec2,
}

impl WeightLegend {
    /// Height of a row of the legend, in points.
    const ROW_HEIGHT: f32 = 18.0;
    /// Width of the coloured dot of a label with the gap after it, in points.
    const DOT_WIDTH: f32 = 13.0;

    fn new(width: f32) -> Self {
        Self {
            width_limit: width - 4.0 * GRID,
            next: vec2(0.0, 0.5 * GRID),
        }
    }

    fn font() -> FontId {
        FontId::proportional(12.0)
    }

    /// Returns the index and the label of each design whose weight rounds to at least 1 % or at
    /// most −1 %.
    fn labels(pictures: &MapPictures, weights: &[f64]) -> Vec<(usize, String)> {
        let all = pictures.space().designs().iter().zip(weights).enumerate();
        let visible = all.filter(|(_, (_, weight))| weight.abs() >= 0.005);
        visible
            .map(|(k, (form, weight))| (k, format!("{} {:.0} %", form.name, weight * 100.0)))
            .collect()
    }

    /// Returns the height of a legend that lists every design with a weight of 100 %. This height
    /// is reserved, so that nothing moves when the weights change.
    fn height(root: &Ui, pictures: &MapPictures, width: f32) -> f32 {
        let mut layout = Self::new(width);
        for (_, words) in Self::labels(pictures, &vec![1.0; pictures.weights().len()]) {
            let ink = Color32::WHITE;
            let galley = root.painter().layout_no_wrap(words, Self::font(), ink);
            layout.place(galley.size().x);
        }
        layout.next.y + Self::ROW_HEIGHT + GRID
    }

    /// Returns the position of the next label, relative to the legend; the label is `width` points
    /// wide.
    fn place(&mut self, width: f32) -> Vec2 {
        let width = Self::DOT_WIDTH + width;
        if self.next.x + width > self.width_limit && self.next.x > 0.0 {
            self.next = vec2(0.0, self.next.y + Self::ROW_HEIGHT);
        }
        let at = self.next + vec2(2.0 * GRID, 0.0);
        self.next.x += width + 2.0 * GRID;
        at
    }
}

fn image(root: &Ui, name: &str, pixels: &Arc<RgbaImage>, rect: Rect, tint: Color32) {
    let texture = texture(root.ctx(), Id::new(("map", name)), pixels, MAX_IMAGE_PX);
    let full_uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    root.painter().image(texture.id(), rect, full_uv, tint);
}
