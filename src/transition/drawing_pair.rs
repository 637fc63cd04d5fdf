//! Prepares two designs for matching: the outlines of all parts of all paint layers, with their
//! appearance.

use super::note::TransitionNote;
use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::correspondence::{PartAppearance, PartAppearances};
use crate::design::{Design, PaintLayer};
use crate::geometry::Regions;
use std::sync::Arc;

/// Two designs prepared for matching.
pub(super) struct DrawingPair {
    /// Outlines of all parts of all paint layers.
    pub outlines: [Regions; 2],
    /// Appearance of each part; empty if neither design is shown in its own paint.
    pub appearances: PartAppearances,
    /// Ink of each paint layer, the lowest first; empty for designs without paint.
    pub inks: [Vec<LayerInk>; 2],
    /// Whether parts are not paired by their names, because there are too many of them.
    pub are_names_ignored: bool,
}

/// Paint, gradient and stroke of a paint layer.
#[derive(Clone, Default)]
pub(super) struct LayerInk {
    pub paint: Option<Paint>,
    pub gradient: Option<Gradient>,
    pub line: Option<StrokeStyle>,
    /// Name of the layer in its file; empty if it has none.
    pub name: Arc<str>,
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
            name: layer.name.as_str().into(),
        };
        Some(Self {
            outlines,
            appearances: PartAppearances(layers.each_ref().map(|layers| part_appearances(layers))),
            inks: layers.map(|layers| layers.iter().map(ink).collect()),
            are_names_ignored: false,
        })
    }

    /// Returns the note on what could not be taken into account.
    pub(super) fn note(&self) -> Option<TransitionNote> {
        self.are_names_ignored
            .then_some(TransitionNote::NamesIgnored)
    }

    /// Creates a pair without appearances, for designs that are shown in one colour.
    pub(super) fn in_one_colour(outlines: [Regions; 2]) -> Self {
        Self {
            outlines,
            appearances: PartAppearances::default(),
            inks: Default::default(),
            are_names_ignored: false,
        }
    }
}

/// Returns whether two designs are matched layer by layer: if either has colours, or if parts of
/// both have the same names. Otherwise the layers make no difference, and the united outlines are
/// matched.
pub(super) fn need_layers(designs: [&Design; 2]) -> bool {
    designs.into_iter().any(Design::is_painted) || {
        let looks = PartAppearances(designs.map(|design| part_appearances(&design.paint_layers)));
        !looks.common_names().is_empty()
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

/// Names of elements and layers that drawing programs assign automatically; they say nothing about
/// what is drawn.
const AUTOMATIC_NAMES: [&str; 12] = [
    "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "shape", "vector", "layer",
    "group", "g",
];

/// Words that drawing programs make automatic names of by adding a number.
const NUMBERED_NAMES: [&str; 25] = [
    "artboard",
    "clippath",
    "combinedshape",
    "compoundpath",
    "curve",
    "element",
    "fill",
    "flowroot",
    "frame",
    "image",
    "mask",
    "object",
    "oval",
    "page",
    "rectangle",
    "star",
    "stroke",
    "subtract",
    "svg",
    "svgid",
    "symbol",
    "text",
    "union",
    "use",
    "xmlid",
];

/// Returns `name` if the author chose it, otherwise an empty string. A name counts as automatic if
/// its letters are one of [`AUTOMATIC_NAMES`], as in `path12` or `Layer 1`, if it is one of
/// [`NUMBERED_NAMES`] with a number, as in `SVGID_3_`, or if it is `0`, the name of the default
/// layer of DXF files.
fn author_name(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphabetic());
    let word = letters.collect::<String>().to_lowercase();
    let is_numbered = name.contains(|c: char| c.is_ascii_digit());
    let is_automatic = name == "0"
        || AUTOMATIC_NAMES.contains(&word.as_str())
        || (is_numbered && NUMBERED_NAMES.contains(&word.as_str()));
    let given = if is_automatic { "" } else { name };
    given.to_owned()
}
