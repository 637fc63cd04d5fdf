//! Tests of parts that are paired by their names, in drawings without colours.

use super::*;

fn built(source: &Arc<Design>, target: &Arc<Design>) -> Transition {
    let spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
    Transition::build(&spec, &Silent).unwrap()
}

/// A map of named squares without colours.
fn named_map(squares: &[(&str, f64, f64, f64)]) -> Arc<Design> {
    let features = squares.iter().map(|&(name, x, y, size)| {
        let (right, top) = (x + size, y + size);
        format!(
            "{{\"type\": \"Feature\", \"properties\": {{\"name\": \"{name}\"}}, \"geometry\": \
             {{\"type\": \"Polygon\", \"coordinates\": \
             [[[{x},{y}],[{right},{y}],[{right},{top}],[{x},{top}],[{x},{y}]]]}}}}"
        )
    });
    let features = features.collect::<Vec<_>>().join(",");
    design(&format!(
        "{{\"type\": \"FeatureCollection\", \"features\": [{features}]}}"
    ))
}

/// For each visible layer of a frame: the centre of its box, the lowest layer first.
fn layer_centres(transition: &Transition, t: f64) -> Vec<DVec2> {
    let figure = transition.frame(t).figure();
    let layers = figure.layers.iter();
    let points = layers.map(|layer| figure.rings[layer.rings.clone()].concat());
    let bounds = points.filter_map(crate::geometry::Bounds::of);
    bounds.map(|bounds| bounds.centre()).collect()
}

#[test]
fn parts_with_equal_names_are_paired_without_colours_in_every_content() {
    let block = [
        ("Zone 1", 0.0, 0.0, 10.0),
        ("Zone 2", 10.0, 0.0, 10.0),
        ("Zone 3", 0.0, 10.0, 10.0),
    ];
    let tiles = [
        ("Zone 3", 40.0, 0.0, 6.0),
        ("Zone 1", 40.0, 20.0, 6.0),
        ("Zone 2", 0.0, 20.0, 6.0),
    ];
    let (source, target) = (named_map(&block), named_map(&tiles));
    let solid = (WarpKind::Arap, ContentKind::Solid);
    let paths = (WarpKind::Paths, ContentKind::Solid);
    let fields = (WarpKind::None, ContentKind::Field);
    for (warp, content) in [solid, paths, fields] {
        let mut spec = TransitionSpec::new(Arc::clone(&source), Arc::clone(&target));
        spec.method = TransitionMethod::new(warp, content).unwrap();
        spec.options.field.cells = 128;
        // The layers keep their order almost to the end.
        spec.options.coats.reorder_at = 1.0;
        let transition = Transition::build(&spec, &Silent).unwrap();
        let ends = [0.0, 0.999].map(|t| layer_centres(&transition, t));
        for (_, x, y, size) in block {
            let k = ends[0]
                .iter()
                .position(|p| p.distance(DVec2::new(x, y) + 0.5 * size) < 0.5);
            let k = k.unwrap_or_else(|| panic!("{warp} {content}: {ends:?}"));
            let name = block.iter().find(|b| (b.1, b.2) == (x, y)).unwrap().0;
            let tile = tiles.iter().find(|tile| tile.0 == name).unwrap();
            let expected = DVec2::new(tile.1, tile.2) + 0.5 * tile.3;
            assert!(ends[1][k].distance(expected) < 0.5, "{name}: {ends:?}");
        }
        let figure = transition.frame(0.5).figure();
        assert_eq!(figure.layers.len(), 3, "{warp} {content}");
        assert!(figure.layers.iter().all(|layer| layer.paints == [None; 2]));
    }
}

#[test]
fn a_named_part_without_a_namesake_left_takes_no_other_part() {
    // The second islet of Dorn has no partner: the tile Elm belongs to Elm.
    let map = [
        ("Dorn", 0.0, 0.0, 10.0),
        ("Dorn", 60.0, 60.0, 10.0),
        ("Elm", 30.0, 0.0, 10.0),
    ];
    let tiles = [
        ("Dorn", 0.0, 0.0, 10.0),
        ("Elm", 30.0, 0.0, 10.0),
        ("Elm", 60.0, 60.0, 10.0),
    ];
    let transition = built(&named_map(&map), &named_map(&tiles));
    let pieces = &transition.matched().unwrap().pieces;
    let matched = pieces.iter().filter(|piece| piece.is_matched()).count();
    assert_eq!((matched, pieces.len()), (2, 4));
}

#[test]
fn designs_without_colours_or_common_names_are_matched_as_a_whole() {
    let source = named_map(&[("A", 0.0, 0.0, 10.0), ("B", 10.0, 0.0, 10.0)]);
    let target = named_map(&[("C", 0.0, 0.0, 10.0), ("D", 10.0, 0.0, 10.0)]);
    let transition = built(&source, &target);
    let figure = transition.frame(0.5).figure();
    assert_eq!((figure.layers.len(), figure.rings.len()), (0, 1));
}
