//! Contact sheet of a map of designs: a grid of blends, in which the designs themselves are
//! labelled with their names.
//!
//! Guarantees: all cells have the same scale; each design is shown exactly, in the cell nearest to
//! its site (its position on the map); cells well outside the convex hull of the sites are empty.

use super::contact_sheet::SheetLayout;
use super::drawing::Drawing;
use super::labels::text_colour_on;
use super::size::PixelSize;
use super::view::PlaneView;
use crate::colour::Rgb;
use crate::geometry::DVec2;
use crate::io::sanitize::SanitizedName;
use crate::space::{DesignSpace, WeightMap};
use crate::transition::TransitionStyle;

/// Draws the blends at `columns` × `rows` places of a map into one sheet.
///
/// # Panics
/// If the map does not have one site per design of the space.
pub fn map_sheet(
    space: &DesignSpace,
    map: &WeightMap,
    style: &TransitionStyle,
    [columns, rows]: [usize; 2],
    size: Option<PixelSize>,
    ground: Option<Rgb>,
) -> Drawing {
    let bounds = space.bounds();
    let layout = SheetLayout::grid([columns, rows], bounds, size);
    let mut drawing = Drawing::new(layout.size, ground);
    let ink = text_colour_on(ground);
    let mut frame = space.frame();
    let mut weights = vec![0.0; space.designs().len()];
    for (index, place) in map
        .grid(layout.columns, layout.rows)
        .into_iter()
        .enumerate()
    {
        let Some(place) = place else {
            continue;
        };
        let (corner, inner, base) = layout.cell(index);
        map.weights(place, &mut weights);
        frame.seek(&weights);
        let view = PlaneView::fit_cell(bounds, layout.size, corner, inner);
        drawing.push_blend(&frame, style, &view);
        if let Some(name) = name_at(space, map, place) {
            drawing.push_label_within(&name, base, layout.label_room(inner), ink);
        }
    }
    drawing
}

/// Returns the name of the design whose site is exactly at `place`, if any.
fn name_at(space: &DesignSpace, map: &WeightMap, place: DVec2) -> Option<String> {
    let design = map.sites().iter().position(|site| *site == place)?;
    Some(SanitizedName(&space.designs()[design].name).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::export::DrawingItem;
    use crate::space::{MapLayout, SpaceSpec};
    use crate::work::progress::Silent;
    use std::sync::Arc;

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn designs_are_named_and_cells_outside_their_hull_are_empty() {
        let tent = |name: &str, h: f64| {
            let ring = [[0.0, 0.0], [2.0, 0.0], [1.0, h]];
            Arc::new(Design::from_rings(name, [ring]).expect("a design"))
        };
        let designs = vec![tent("low", 1.0), tent("high", 2.0), tent("tower", 4.0)];
        let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let map = WeightMap::new(&MapLayout::Polygon.sites(space.distances())).expect("sites");
        let style = TransitionStyle::default();
        let drawing = map_sheet(&space, &map, &style, [5, 5], None, None);
        let labels = drawing.items.iter().filter_map(|item| match item {
            DrawingItem::Fill { label, .. } => label.clone(),
            _ => None,
        });
        let mut labels: Vec<String> = labels.collect();
        labels.sort();
        assert_eq!(labels, ["high", "low", "tower"]);
        let figures = drawing.items.len() - labels.len();
        assert!((9..25).contains(&figures), "{figures}");
    }
}
