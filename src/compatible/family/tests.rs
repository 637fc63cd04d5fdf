//! Tests of mesh families of outlines and trusses: validity, shared corners, errors.

use super::*;
use crate::compatible::PolygonOptions;
use crate::correspondence::{MatchSettings, RegionMatch, match_regions};
use crate::geometry::{FillRule, Regions, orient2d};
use crate::work::progress::Silent;
use proptest::prelude::*;

/// Flower with the given number of petals, sampled at `corners` points. Its radius varies by
/// ±`depth` around 3. If `hole` is given, it is the radius of a round hole.
fn flower(corners: u32, petals: f64, depth: f64, hole: Option<f64>) -> Regions {
    let ring = |size: f64, depth: f64| -> Vec<DVec2> {
        let point = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(corners);
            DVec2::from_angle(angle) * (size + depth * (petals * angle).cos())
        };
        (0..corners).map(point).collect()
    };
    let outer = ring(3.0, depth);
    let rings: Vec<_> = [outer]
        .into_iter()
        .chain(hole.map(|size| ring(size, 0.0)))
        .collect();
    Regions::from_rings(&rings, FillRule::EvenOdd).expect("a flower")
}

/// Matches every design with the hub and triangulates them together.
fn family_of(designs: &[Regions], hub: usize) -> Result<CompatibleFamily, FamilyError> {
    let matches: Vec<Option<RegionMatch>> = designs
        .iter()
        .enumerate()
        .map(|(k, design)| {
            let matched =
                || match_regions(&designs[hub], design, &MatchSettings::default(), &Silent);
            (k != hub).then(|| matched().expect("a match"))
        })
        .collect();
    let matches: Vec<Option<&RegionMatch>> = matches.iter().map(Option::as_ref).collect();
    CompatibleFamily::from_outlines(hub, &matches, &PolygonOptions::default(), &Silent)
}

/// Checks that all faces are positive in all designs, that all corners of the designs are vertices,
/// and that the mesh has one boundary loop for each ring of a design.
fn assert_family(family: &CompatibleFamily, designs: &[Regions]) {
    for (places, design) in family.embeddings().iter().zip(designs) {
        for face in family.faces().iter() {
            let [a, b, c] = face.map(|v| places[v as usize]);
            assert!(orient2d(a, b, c) > 0.0);
        }
        for point in design.rings().flat_map(|ring| ring.points()) {
            assert!(places.contains(point), "a corner of a design is lost");
        }
        let loops = family.boundary_loops();
        assert_eq!(loops.len(), design.rings().count());
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn outlines_with_a_hole_are_a_family() {
    let designs = [
        flower(24, 3.0, 0.5, Some(1.0)),
        flower(31, 5.0, 0.4, Some(1.5)),
        flower(40, 2.0, 0.7, Some(0.6)),
    ];
    for hub in 0..3 {
        let family = family_of(&designs, hub).expect("a family");
        assert_family(&family, &designs);
        let [a, b] = [0, 1].map(|k| &designs[k]);
        let pair = match_regions(a, b, &MatchSettings::default(), &Silent).expect("a match");
        let pair = CompatibleMesh::from_outlines(&pair, &PolygonOptions::default(), &Silent);
        let max_count = 3 * pair.expect("a mesh").source().len();
        let count = family.embeddings()[0].len();
        assert!(
            count <= max_count,
            "{count} vertices; three pairs have {max_count}"
        );
    }
}

#[test]
fn an_unmatched_hole_is_an_error() {
    let designs = [
        flower(24, 3.0, 0.5, None),
        flower(31, 5.0, 0.4, None),
        flower(40, 2.0, 0.7, Some(0.6)),
    ];
    let error = family_of(&designs, 0).expect_err("a hole");
    assert_eq!(error, FamilyError::PartsDiffer { design: 2, of: 0 });
    let message = "design 3 does not have the same parts and holes as design 1";
    assert_eq!(error.to_string(), message);
}

#[test]
fn equal_designs_get_equal_vertices() {
    let one = flower(24, 3.0, 0.5, Some(1.0));
    let designs = [one.clone(), flower(31, 5.0, 0.4, Some(1.5)), one];
    let family = family_of(&designs, 1).expect("a family");
    let [first, _, third] = family.embeddings() else {
        panic!("three designs");
    };
    let corners = designs[0].rings().flat_map(|ring| ring.points());
    for corner in corners {
        let index_in = |places: &[DVec2]| places.iter().position(|p| p == corner);
        assert_eq!(index_in(first), index_in(third));
    }
}

#[test]
fn trusses_must_have_the_same_bars() {
    let truss = |height: f64, bars: &[[u32; 2]]| {
        let nodes = [(0.0, 0.0), (2.0, 0.0), (1.0, height)].map(DVec2::from);
        Truss::new(nodes.to_vec(), bars.to_vec()).expect("a truss")
    };
    let all = [[0, 1], [1, 2], [2, 0]];
    let [a, b, c] = [1.0, 2.0, 3.0].map(|height| truss(height, &all));
    let family = CompatibleFamily::from_trusses(&[&a, &b, &c], &Silent).expect("a family");
    assert_eq!((family.count(), family.faces().len()), (3, 1));
    let other = truss(2.0, &all[..2]);
    let error = CompatibleFamily::from_trusses(&[&a, &b, &other], &Silent).expect_err("a bar less");
    assert!(
        matches!(error, FamilyError::Incompatible { design: 2, .. }),
        "{error}"
    );
    assert_eq!(
        CompatibleFamily::from_trusses(&[&a], &Silent).err(),
        Some(FamilyError::TooFew(1))
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn flowers_are_a_family(
        shapes in prop::collection::vec((12u32..40, 2u32..6, 0.0..0.8f64), 3..6),
        hub in 0usize..3,
    ) {
        let flowers = shapes.iter().map(|&(n, petals, depth)| flower(n, f64::from(petals), depth, None));
        let designs: Vec<Regions> = flowers.collect();
        let family = family_of(&designs, hub).expect("a family");
        assert_family(&family, &designs);
    }
}
