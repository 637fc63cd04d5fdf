//! Paint layers: the coloured regions of a design, stacked from bottom to top. If a file gives no
//! order, regions are stacked by containment.

use crate::colour::{Gradient, Paint, StrokeStyle};
use crate::geometry::{Bounds, Region, Regions, Similarity};
use std::collections::BTreeMap;

/// Regions filled with one paint.
///
/// Regions of one layer do not overlap each other. Each layer covers the layers before it.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintLayer {
    /// Area that is filled with the paint.
    pub regions: Regions,
    /// Colour and opacity of the fill, or `None` if the file gives these regions no colour.
    pub paint: Option<Paint>,
    /// Gradient of the fill, if any; `paint` is then the mean of the gradient.
    pub gradient: Option<Gradient>,
    /// Stroke along the outlines of all regions, if any; drawn over the fill.
    pub line: Option<StrokeStyle>,
    /// Name of the shape in the file; empty if unnamed or merged from several shapes.
    pub name: String,
    /// Whether the regions are letters of a text element.
    pub is_text: bool,
}

impl PaintLayer {
    /// Returns the layer transformed by a similarity, including gradient and line width.
    pub(super) fn transformed(&self, by: &Similarity) -> Self {
        Self {
            regions: self.regions.transformed(by),
            paint: self.paint,
            gradient: self
                .gradient
                .as_ref()
                .map(|gradient| gradient.transformed(by.affine())),
            line: self.line.map(|line| StrokeStyle {
                width: by.scale * line.width,
                ..line
            }),
            name: self.name.clone(),
            is_text: self.is_text,
        }
    }
}

/// All regions that a file fills with one paint, without a stacking order.
pub(super) struct PaintGroup {
    /// Area that is filled with the paint.
    pub regions: Regions,
    /// Colour and opacity, or `None` if the file gives no colour.
    pub paint: Option<Paint>,
    /// Name of the paint layers that are made from the group.
    pub name: String,
}

/// Stacks regions without an order into paint layers, so that no region hides a region inside it.
///
/// The height of a region in the stack is its nesting depth: 0 if no region of another group
/// contains it, otherwise one more than the height of the highest region of another group that
/// contains it. At equal height, the layer with the smaller area is on top. Returns no layers if no
/// group has a colour.
pub(super) fn stack_by_containment(groups: &[PaintGroup]) -> Vec<PaintLayer> {
    if groups.iter().all(|group| group.paint.is_none()) {
        return Vec::new();
    }
    let mut pieces_by_layer: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
    for StackedPiece {
        group,
        number,
        height,
    } in pieces_with_heights(groups)
    {
        let numbers = pieces_by_layer.entry((height, group)).or_default();
        numbers.push(number);
    }
    let layer = |((height, group), numbers): ((usize, usize), Vec<usize>)| {
        let group = &groups[group];
        let layer = PaintLayer {
            regions: group.regions.subset(&numbers)?,
            paint: group.paint,
            gradient: None,
            line: None,
            name: group.name.clone(),
            is_text: false,
        };
        Some((height, layer))
    };
    let mut layers: Vec<(usize, PaintLayer)> =
        pieces_by_layer.into_iter().filter_map(layer).collect();
    layers.sort_by(|(a, first), (b, second)| {
        let by_area = || second.regions.area().total_cmp(&first.regions.area());
        a.cmp(b).then_with(by_area)
    });
    layers.into_iter().map(|(_, layer)| layer).collect()
}

/// Region with its height in the stack of paint layers. It belongs to a [`PaintGroup`], which holds
/// all regions of a file that have the same paint.
struct StackedPiece {
    /// Index of the region's group in the list of groups.
    group: usize,
    /// Index of the region within its group.
    number: usize,
    /// Nesting depth of the region in regions of other groups; 0 at the bottom.
    height: usize,
}

/// Maximum number of regions that are tested for nesting, pair by pair; if there are more, all get
/// height 0 (resource limit).
const MAX_COMPARED: usize = 20_000;

/// Returns all regions of all groups with their heights, largest area first.
fn pieces_with_heights(groups: &[PaintGroup]) -> Vec<StackedPiece> {
    let pieces_of = |(group, of): (usize, &'_ PaintGroup)| -> Vec<(usize, usize)> {
        (0..of.regions.len())
            .map(|number| (group, number))
            .collect()
    };
    let numbers: Vec<(usize, usize)> = groups.iter().enumerate().flat_map(pieces_of).collect();
    let regions = groups.iter().flat_map(|group| group.regions.iter());
    let mut pieces: Vec<(Bounds, f64, &Region, (usize, usize))> = regions
        .zip(numbers)
        .map(|(region, number)| (region.outer.bounds(), region.area(), region, number))
        .collect();
    pieces.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut heights = vec![0; pieces.len()];
    if pieces.len() <= MAX_COMPARED {
        // Only larger regions, which come earlier, can contain a region.
        for inner in 0..pieces.len() {
            let (bounds, _, region, (group, _)) = pieces[inner];
            let hosts = pieces[..inner].iter().zip(&heights).filter(|(host, _)| {
                host.3.0 != group && host.0.union(&bounds) == host.0 && is_within(region, host.2)
            });
            heights[inner] = hosts.map(|(_, height)| height + 1).max().unwrap_or(0);
        }
    }
    let numbered = pieces.iter().zip(heights);
    let placed = numbered.map(|(&(.., (group, number)), height)| StackedPiece {
        group,
        number,
        height,
    });
    placed.collect()
}

/// Returns whether most of the outline of `inner` lies in `outer`, judged from about 16 points of
/// that outline.
fn is_within(inner: &Region, outer: &Region) -> bool {
    let points = inner.outer.points();
    let sample = points.iter().step_by(points.len().div_ceil(16).max(1));
    let (count, inside) = sample.fold((0, 0), |(count, inside), &p| {
        (count + 1, inside + usize::from(outer.contains(p)))
    });
    2 * inside > count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::Rgb;
    use crate::geometry::{DVec2, FillRule};

    fn group(name: &str, squares: &[[f64; 3]]) -> PaintGroup {
        let square = |&[x, y, side]: &[f64; 3]| {
            let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
            corners.map(|(a, b)| DVec2::new(x + a, y + b)).to_vec()
        };
        let rings: Vec<Vec<DVec2>> = squares.iter().map(square).collect();
        PaintGroup {
            regions: Regions::from_rings(&rings, FillRule::NonZero).expect("squares"),
            paint: Some(Rgb([1, 2, 3]).into()),
            name: name.to_owned(),
        }
    }

    #[test]
    fn a_nested_dot_stays_visible_when_its_colour_is_large_elsewhere() {
        // A small dot lies on a large square of the other colour: a white highlight on a black
        // pupil, and a black dot on a white wall.
        let groups = [
            group("black", &[[0.0, 0.0, 10.0], [60.0, 0.0, 2.0]]),
            group("white", &[[4.0, 4.0, 1.0], [50.0, -20.0, 40.0]]),
        ];
        let layers = stack_by_containment(&groups);
        let found: Vec<(&str, usize)> = layers
            .iter()
            .map(|layer| (layer.name.as_str(), layer.regions.len()))
            .collect();
        assert_eq!(
            found,
            [("white", 1), ("black", 1), ("black", 1), ("white", 1)]
        );
    }
}
