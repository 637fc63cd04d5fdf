//! Prepares two designs for matching: the outlines of all parts of all paint layers, with their
//! appearance.

use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::correspondence::{PartAppearance, PartAppearances};
use crate::design::PaintLayer;
use crate::geometry::Regions;

/// Two designs prepared for matching.
pub(super) struct DrawingPair {
    /// Outlines of all parts of all paint layers.
    pub outlines: [Regions; 2],
    /// Appearance of each part; empty if neither design is shown in its own paint.
    pub appearances: PartAppearances,
    /// Ink of each paint layer, the lowest first; empty for designs without paint.
    pub inks: [Vec<LayerInk>; 2],
}

/// Paint, gradient and stroke of a paint layer.
#[derive(Clone, Default)]
pub(super) struct LayerInk {
    pub paint: Option<Paint>,
    pub gradient: Option<Gradient>,
    pub line: Option<StrokeStyle>,
}

impl DrawingPair {
    /// Combines the paint layers of each design, the lowest first; `None` if a design has no
    /// layers.
    pub(super) fn of(layers: [Vec<PaintLayer>; 2]) -> Option<Self> {
        let [source, target] = &layers;
        let outlines = [stacked_outlines(source)?, stacked_outlines(target)?];
        let ink = |layer: &PaintLayer| LayerInk {
            paint: layer.paint,
            gradient: layer.gradient.clone(),
            line: layer.line,
        };
        Some(Self {
            outlines,
            appearances: PartAppearances(layers.each_ref().map(|layers| part_appearances(layers))),
            inks: layers.map(|layers| layers.iter().map(ink).collect()),
        })
    }

    /// Creates a pair without appearances, for designs that are shown in one colour.
    pub(super) fn in_one_colour(outlines: [Regions; 2]) -> Self {
        Self {
            outlines,
            appearances: PartAppearances::default(),
            inks: Default::default(),
        }
    }
}

/// Returns the outlines of all layers as one list of parts, the lowest layer first.
fn stacked_outlines(layers: &[PaintLayer]) -> Option<Regions> {
    Regions::stacked(layers.iter().map(|layer| layer.regions.clone()))
}

/// Returns the appearance of each part, in the order of [`stacked_outlines`].
fn part_appearances(layers: &[PaintLayer]) -> Vec<PartAppearance> {
    let top_index = layers.len().saturating_sub(1).max(1) as f64;
    let layers = layers.iter().enumerate();
    let looks = layers.flat_map(|(k, layer)| {
        let look = PartAppearance {
            paint_layer: k,
            height: k as f64 / top_index,
            paint: layer.paint,
            is_lined: layer.line.is_some(),
            name: author_name(&layer.name),
            is_text: layer.is_text,
        };
        std::iter::repeat_n(look, layer.regions.len())
    });
    looks.collect()
}

/// Names that drawing programs assign automatically; they say nothing about what is drawn.
const AUTOMATIC_NAMES: [&str; 12] = [
    "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "shape", "vector", "layer",
    "group", "g",
];

/// Returns `name` if the author chose it, otherwise an empty string. A name counts as automatic if
/// it contains a digit or is one of [`AUTOMATIC_NAMES`]; such names have no meaning in another
/// drawing.
fn author_name(name: &str) -> String {
    let is_counted = name.contains(|c: char| c.is_ascii_digit());
    let is_kind = AUTOMATIC_NAMES.contains(&name.to_ascii_lowercase().as_str());
    let given = if is_counted || is_kind { "" } else { name };
    given.to_owned()
}
