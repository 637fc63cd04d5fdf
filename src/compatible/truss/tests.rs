//! Tests of the common triangulation of trusses: panels, bridges, crossed bars, errors, and
//! optimality against brute force.

use super::*;
use crate::geometry::orient2d;
use crate::work::progress::Silent;

/// Truss from node coordinates and bars.
fn truss(nodes: &[(f64, f64)], bars: &[[u32; 2]]) -> Truss {
    let nodes = nodes.iter().map(|&p| p.into()).collect();
    Truss::new(nodes, bars.to_vec()).expect("a truss")
}

/// Returns whether all faces are positive in the given truss.
fn positive(faces: &[[u32; 3]], truss: &Truss) -> bool {
    faces.iter().all(|f| {
        let [a, b, c] = f.map(|node| truss.nodes()[node as usize]);
        orient2d(a, b, c) > 0.0
    })
}

/// [`super::triangulate_panels`] without progress reports.
fn panels(source: &Truss, target: &Truss) -> Result<PanelMesh, TrussError> {
    super::triangulate_panels(source, target, &Silent)
}

/// Checks that both orders of the designs give the same valid result, in which every node belongs
/// to a face or a bar; returns it.
fn both_ways(source: &Truss, target: &Truss) -> PanelMesh {
    let mesh = panels(source, target).expect("panels");
    assert!(positive(&mesh.0, source) && positive(&mesh.0, target));
    assert_eq!(panels(target, source), Ok(mesh.clone()));
    for node in 0..source.nodes().len() as u32 {
        let in_face = mesh.0.iter().any(|face| face.contains(&node));
        assert!(
            in_face || mesh.1.iter().any(|bar| bar.contains(&node)),
            "{node}"
        );
    }
    mesh
}

const SQUARE: [(f64, f64); 4] = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
const SQUARE_BARS: [[u32; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];

#[test]
fn triangles_bridges_and_dangling_bars_are_distinguished() {
    // Two triangles joined by a bridge. A dangling bar lies inside the first triangle.
    let nodes = [
        (0.0, 0.0),
        (4.0, 0.0),
        (0.0, 4.0),
        (1.0, 1.0),
        (6.0, 0.0),
        (8.0, 0.0),
        (7.0, 2.0),
    ];
    let bars = [
        [0, 1],
        [1, 2],
        [2, 0],
        [0, 3],
        [1, 4],
        [4, 5],
        [5, 6],
        [6, 4],
    ];
    let t = truss(&nodes, &bars);
    let (faces, elements) = both_ways(&t, &t);
    assert_eq!(faces, [[0, 1, 2], [4, 5, 6]]);
    assert_eq!(elements, [[0, 3], [1, 4]]);
}

#[test]
fn a_mechanism_square_gets_the_diagonal_that_is_good_in_both() {
    let sheared = [(0.0, 0.0), (1.0, 0.0), (1.8, 0.6), (0.8, 0.6)];
    let (faces, elements) = both_ways(
        &truss(&SQUARE, &SQUARE_BARS),
        &truss(&sheared, &SQUARE_BARS),
    );
    assert_eq!(faces.len(), 2);
    assert!(faces.iter().all(|f| f.contains(&1) && f.contains(&3)));
    assert!(elements.is_empty());
}

#[test]
fn a_concave_panel_takes_diagonals_valid_in_both() {
    // The source is concave at node 3 and the target is convex: only the diagonal 1–3 is valid in
    // both.
    let dart = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.2, 0.8)];
    let (faces, _) = both_ways(&truss(&dart, &SQUARE_BARS), &truss(&SQUARE, &SQUARE_BARS));
    assert!(faces.iter().all(|f| f.contains(&1) && f.contains(&3)));
    // The two designs are concave at neighbouring nodes: no diagonal is valid in both.
    let other = [(0.0, 0.0), (2.0, 0.0), (0.8, 0.6), (0.0, 2.0)];
    assert_eq!(
        panels(&truss(&dart, &SQUARE_BARS), &truss(&other, &SQUARE_BARS)),
        Err(TrussError::NoTriangulation(vec![0, 1, 2, 3]))
    );
}

#[test]
fn nodes_with_other_numbers_are_matched_by_bars_and_positions() {
    // A braced ladder. Its graph has 2^6 symmetries: any two nodes above each other can be
    // exchanged. The target is bent upwards and numbers its nodes differently.
    let place = |k: usize| (k as f64 / 2.0).floor();
    let flat: Vec<(f64, f64)> = (0..10).map(|k| (place(k), (k % 2) as f64)).collect();
    let bent = flat
        .iter()
        .map(|&(x, y)| (1.1 * x, y + x * (4.0 - x) / 2.0));
    let bent: Vec<(f64, f64)> = bent.collect();
    let rungs = (0..5).map(|k| [2 * k, 2 * k + 1]);
    let braces = (0..4).flat_map(|k| {
        let [a, b, c, d] = [2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3];
        [[a, c], [b, d], [a, d], [b, c]]
    });
    let bars: Vec<[u32; 2]> = rungs.chain(braces).collect();
    let number = |node: u32| (7 * node + 3) % 10;
    let mut shuffled = vec![(0.0, 0.0); 10];
    for (node, &p) in bent.iter().enumerate() {
        shuffled[number(node as u32) as usize] = p;
    }
    let renamed: Vec<[u32; 2]> = bars.iter().map(|bar| bar.map(number)).collect();
    let (source, target) = (truss(&flat, &bars), truss(&shuffled, &renamed));
    assert!(matches!(
        panels(&source, &target),
        Err(TrussError::BarsDiffer { .. })
    ));
    let order = corresponding_nodes(&source, &target).expect("the same truss");
    assert_eq!(order, (0..10).map(number).collect::<Vec<u32>>());
    let sorted = target.with_nodes_in_order(&order).expect("each node once");
    assert_eq!(check_same_bars(&source, &sorted), Ok(()));
    assert_eq!(sorted.nodes(), truss(&bent, &bars).nodes());
    // With one bar moved, it is another truss.
    let mut other = renamed;
    other[0] = [number(0), number(9)];
    assert_eq!(
        corresponding_nodes(&source, &truss(&shuffled, &other)),
        None
    );
}

#[test]
fn outer_pockets_stay_open() {
    // Outline of a U, made of seven unit squares. The gap between its arms must get no faces.
    let nodes = [
        (0.0, 0.0),
        (3.0, 0.0),
        (3.0, 3.0),
        (2.0, 3.0),
        (2.0, 1.0),
        (1.0, 1.0),
        (1.0, 3.0),
        (0.0, 3.0),
    ];
    let bars = [
        [0, 1],
        [1, 2],
        [2, 3],
        [3, 4],
        [4, 5],
        [5, 6],
        [6, 7],
        [7, 0],
    ];
    let t = truss(&nodes, &bars);
    let (faces, _) = both_ways(&t, &t);
    let corners = |face: &[u32; 3]| face.map(|node| t.nodes()[node as usize]);
    let area: f64 = faces.iter().map(|f| signed_area(&corners(f))).sum();
    assert_eq!(area, 7.0);
}

#[test]
fn crossed_braces_keep_one_and_carry_the_other() {
    let bars = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]];
    let (faces, elements) = both_ways(&truss(&SQUARE, &bars), &truss(&SQUARE, &bars));
    assert_eq!(faces, [[0, 1, 2], [0, 2, 3]]);
    assert!(elements.is_empty());
    // In the dart (a concave quadrilateral) the bar 0–2 lies outside. Both crossing bars are
    // removed, and the triangulation uses the diagonal 1–3.
    let dart = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.2, 0.8)];
    let (faces, elements) = both_ways(&truss(&SQUARE, &bars), &truss(&dart, &bars));
    assert!(faces.iter().all(|f| f.contains(&1) && f.contains(&3)));
    assert!(elements.is_empty());
}

#[test]
fn crossing_bars_between_panels_become_elements() {
    let nodes = [
        (0.0, 0.0),
        (0.0, 1.0),
        (-1.0, 0.5),
        (2.0, 0.0),
        (2.0, 1.0),
        (3.0, 0.5),
    ];
    let bars = [
        [0, 1],
        [1, 2],
        [2, 0],
        [3, 4],
        [4, 5],
        [5, 3],
        [0, 4],
        [1, 3],
    ];
    let t = truss(&nodes, &bars);
    let (faces, elements) = both_ways(&t, &t);
    assert_eq!(faces.len(), 2);
    assert_eq!(elements, [[0, 4], [1, 3]]);
}

#[test]
fn a_panel_attached_to_another_at_one_node_is_a_panel_of_its_own() {
    let nodes = [
        (0.0, 0.0),
        (9.0, 0.0),
        (9.0, 9.0),
        (0.0, 9.0),
        (4.0, 2.0),
        (2.0, 4.0),
    ];
    let bars = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [4, 5], [5, 0]];
    let t = truss(&nodes, &bars);
    let (faces, elements) = both_ways(&t, &t);
    assert_eq!(faces.len(), 3);
    assert!(faces.contains(&[0, 4, 5]));
    assert!(elements.is_empty());
}

#[test]
fn differences_and_reversed_panels_are_named_in_the_error() {
    let square = truss(&SQUARE, &SQUARE_BARS);
    let more = truss(
        &[SQUARE.as_slice(), &[(2.0, 2.0)]].concat(),
        &[SQUARE_BARS.as_slice(), &[[2, 4]]].concat(),
    );
    assert_eq!(panels(&square, &more), Err(TrussError::NodeCounts([4, 5])));
    let braced = truss(&SQUARE, &[SQUARE_BARS.as_slice(), &[[0, 2]]].concat());
    let error = panels(&square, &braced).expect_err("another bar");
    assert_eq!(
        error,
        TrussError::BarsDiffer {
            nodes: [0, 2],
            only_in: crate::geometry::Side::Target
        }
    );
    assert!(error.to_string().contains("only in the target"));
    let reordered = truss(&SQUARE, &[[0, 3], [3, 2], [2, 1], [1, 0]]);
    assert!(panels(&square, &reordered).is_ok());
    let mirror = SQUARE.map(|(x, y)| (-x, y));
    assert_eq!(
        panels(&square, &truss(&mirror, &SQUARE_BARS)),
        Err(TrussError::Mirrored)
    );
    // Nodes 2, 3 and 4 form a triangle on the upper side of the square. In the target, node 4 lies
    // below this side, so the triangle is turned over.
    let house = |y| {
        let nodes = [SQUARE.as_slice(), &[(0.5, y)]].concat();
        truss(
            &nodes,
            &[SQUARE_BARS.as_slice(), &[[2, 4], [3, 4]]].concat(),
        )
    };
    let error = panels(&house(2.0), &house(0.5)).expect_err("turned over");
    assert_eq!(error, TrussError::Flipped(vec![2, 4, 3]));
}

/// Oracle: tries every triangulation of a small polygon and returns the largest possible sine of
/// the smallest angle.
fn best_by_brute_force(cycle: &[u32], pair: SourceTarget<&[DVec2]>) -> Option<f64> {
    if cycle.len() < 3 {
        return Some(f64::INFINITY);
    }
    let last = cycle.len() - 1;
    (1..last)
        .filter_map(|k| {
            let sines = sines([cycle[0], cycle[k], cycle[last]], pair)?;
            let left = best_by_brute_force(&cycle[..=k], pair)?;
            let right = best_by_brute_force(&cycle[k..], pair)?;
            Some(sines.min(left).min(right))
        })
        .max_by(f64::total_cmp)
}

/// Smallest sine of a face's angles over both designs; `None` unless the face is positive in both.
fn sines(face: [u32; 3], pair: SourceTarget<&[DVec2]>) -> Option<f64> {
    let mut least = f64::INFINITY;
    for nodes in [pair.source, pair.target] {
        let [a, b, c] = face.map(|node| nodes[node as usize]);
        for (p, q, r) in [(a, b, c), (b, c, a), (c, a, b)] {
            if orient2d(p, q, r) <= 0.0 {
                return None;
            }
            let angle = (q - p).angle_to(r - p);
            least = least.min(angle);
        }
    }
    Some(least.sin())
}

proptest::proptest! {
    #[test]
    fn the_program_finds_the_best_triangulation(
        radii in proptest::collection::vec((0.2f64..1.0, 0.2f64..1.0), 3..9),
    ) {
        let count = radii.len();
        let around = |pick: fn(&(f64, f64)) -> f64| -> Vec<DVec2> {
            radii.iter().enumerate().map(|(k, r)| {
                pick(r) * DVec2::from_angle(std::f64::consts::TAU * k as f64 / count as f64)
            }).collect()
        };
        let (source, target) = (around(|r| r.0), around(|r| r.1));
        let pair = SourceTarget { source: &source[..], target: &target[..] };
        let cycle: Vec<u32> = (0..count as u32).collect();
        let found = panel_triangulation::triangulate_panel(&cycle, &pair.to_array(), &Silent).expect("not cancelled");
        let found = found.map(|faces| {
            faces.iter().map(|&f| sines(f, pair).unwrap_or(-1.0)).fold(f64::INFINITY, f64::min)
        });
        match (found, best_by_brute_force(&cycle, pair)) {
            (Some(a), Some(b)) => proptest::prop_assert!((a - b).abs() < 1e-9, "{a} {b}"),
            (a, b) => proptest::prop_assert_eq!(a.is_some(), b.is_some()),
        }
    }
}
