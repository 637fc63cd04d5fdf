//! The filled area of meshes and trusses.

use super::truss::Truss;
use crate::geometry::{DVec2, FillRule, Regions, RegionsError};
use crate::mesh::TriangleMesh;
use std::f64::consts::PI;

/// Sides of the half circle at either end of a bar. A chord of 1/16 of a half
/// circle stays within 0.5 % of the radius.
const CAP_SIDES: u32 = 16;

/// The boundary loops of the mesh, overlaps united.
pub(super) fn of_mesh(mesh: &TriangleMesh) -> Result<Regions, RegionsError> {
    let at = |&v: &u32| mesh.positions()[v as usize];
    let rings: Vec<Vec<DVec2>> = mesh
        .boundary_loops()
        .iter()
        .map(|walk| walk.iter().map(at).collect())
        .collect();
    Regions::from_rings(&rings, FillRule::NonZero)
}

/// The bars as strokes with round ends, united.
pub(super) fn of_truss(truss: &Truss, bar_width: f64) -> Result<Regions, RegionsError> {
    if !(bar_width.is_finite() && bar_width > 0.0) {
        return Err(RegionsError::Empty);
    }
    let capsules: Vec<Vec<DVec2>> = truss
        .segments()
        .map(|[a, b]| capsule(a, b, 0.5 * bar_width))
        .collect();
    Regions::from_rings(&capsules, FillRule::NonZero)
}

/// All points within `radius` of the segment, counter-clockwise.
fn capsule(a: DVec2, b: DVec2, radius: f64) -> Vec<DVec2> {
    let along = (b - a).to_angle();
    let cap = move |centre: DVec2, from: f64| {
        (0..=CAP_SIDES).map(move |k| {
            centre + radius * DVec2::from_angle(from + PI * f64::from(k) / f64::from(CAP_SIDES))
        })
    };
    cap(b, along - 0.5 * PI)
        .chain(cap(a, along + 0.5 * PI))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thick_triangle_has_a_hole() {
        let nodes = vec![DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 3.0)];
        let truss = Truss::new(nodes, vec![[0, 1], [1, 2], [2, 0]]).expect("valid");
        let regions = of_truss(&truss, 0.2).expect("area");
        assert_eq!(regions.len(), 1);
        assert_eq!(regions.rings().count(), 2);
        // Outer offset: area + perimeter r + π r²; inner: similar, inradius 1 less r.
        let expected = 6.0 + 12.0 * 0.1 + PI * 0.01 - 6.0 * 0.9 * 0.9;
        assert!(
            (regions.area() - expected).abs() < 1e-3,
            "{}",
            regions.area()
        );
    }

    #[test]
    fn bars_without_width_enclose_nothing() {
        let truss = Truss::new(vec![DVec2::ZERO, DVec2::X], vec![[0, 1]]).expect("valid");
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(of_truss(&truss, width), Err(RegionsError::Empty));
        }
    }

    #[test]
    fn a_mesh_outline_leaves_inner_edges_and_mirrored_faces_out() {
        let square = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        for faces in [[[0, 1, 2], [0, 2, 3]], [[0, 2, 1], [0, 3, 2]]] {
            let mesh = TriangleMesh::new(square.clone(), faces.to_vec()).expect("valid");
            let regions = of_mesh(&mesh).expect("area");
            assert_eq!(regions.rings().count(), 1);
            assert!((regions.area() - 1.0).abs() < 1e-9);
        }
    }
}
