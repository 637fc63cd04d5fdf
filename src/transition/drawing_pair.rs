//! Designs as they are matched: all parts of all coats, and how they look.

use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::correspondence::{PartLook, PartLooks};
use crate::design::PaintLayer;
use crate::geometry::Regions;

/// Two designs as they are matched.
pub(super) struct DrawingPair {
    /// All parts, of all coats.
    pub outlines: [Regions; 2],
    /// Empty where neither design is shown in its own paint.
    pub looks: PartLooks,
    /// The inks of each coat, the lowest first; none of such designs.
    pub inks: [Vec<LayerInk>; 2],
}

/// Paint, gradient and line of a coat.
#[derive(Clone, Default)]
pub(super) struct LayerInk {
    pub paint: Option<Paint>,
    pub gradient: Option<Gradient>,
    pub line: Option<StrokeStyle>,
}

impl DrawingPair {
    /// Of coats of paint, the lowest first; `None` of a design without any.
    pub(super) fn of(coats: [Vec<PaintLayer>; 2]) -> Option<Self> {
        let [source, target] = &coats;
        let outlines = [stacked(source)?, stacked(target)?];
        let ink = |coat: &PaintLayer| LayerInk {
            paint: coat.paint,
            gradient: coat.gradient.clone(),
            line: coat.line,
        };
        Some(Self {
            outlines,
            looks: PartLooks(coats.each_ref().map(|coats| looks_of(coats))),
            inks: coats.map(|coats| coats.iter().map(ink).collect()),
        })
    }

    /// Of the outlines of designs that are shown in one colour.
    pub(super) fn plain(outlines: [Regions; 2]) -> Self {
        Self {
            outlines,
            looks: PartLooks::default(),
            inks: Default::default(),
        }
    }
}

fn stacked(coats: &[PaintLayer]) -> Option<Regions> {
    Regions::stacked(coats.iter().map(|coat| coat.regions.clone()))
}

fn looks_of(coats: &[PaintLayer]) -> Vec<PartLook> {
    let top = coats.len().saturating_sub(1).max(1) as f64;
    let coats = coats.iter().enumerate();
    let looks = coats.flat_map(|(k, coat)| {
        let look = PartLook {
            coat: k,
            height: k as f64 / top,
            paint: coat.paint,
            is_lined: coat.line.is_some(),
            name: given_name(&coat.name),
            is_text: coat.is_text,
        };
        std::iter::repeat_n(look, coat.regions.len())
    });
    looks.collect()
}

/// What drawing programs call things by themselves.
const KINDS: [&str; 12] = [
    "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "shape", "vector", "layer",
    "group", "g",
];

/// A name that somebody gave; nothing of one that a program counted, which says
/// as little of another drawing's.
fn given_name(name: &str) -> String {
    let is_counted = name.contains(|c: char| c.is_ascii_digit());
    let is_kind = KINDS.contains(&name.to_ascii_lowercase().as_str());
    let given = if is_counted || is_kind { "" } else { name };
    given.to_owned()
}
