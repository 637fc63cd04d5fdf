//! Improves the correspondence and the mesh together: the boundary vertices slide along the
//! outlines of both designs, inner vertices follow, and the mesh adapts. This reduces the
//! distortion between the designs.
//!
//! A vertex that slides past a corner of an outline leaves the corner without a vertex. The caller
//! therefore rebuilds the rings, including their corners, from the returned places.
//!
//! Guaranteed: pinned vertices stay in place; exchanging the designs exchanges the places, bit by
//! bit. Not guaranteed: that places stay in order around corners; that the distortion reaches a
//! minimum.

use super::boundary_rings::BoundaryRings;
use super::face_cost;
use super::mesh_energy::{MeshEnergy, SlidingVertex};
use super::options::PolygonOptions;
use super::pair_mesh::PairMesh;
use super::quality::refit;
use super::two_designs::precedes;
use crate::compatible::CompatibleMesh;
use crate::correspondence::PieceMatch;
use crate::geometry::Side;
use crate::numerics::{Cholesky, CholeskyWorkspace, SymmetricMatrix};
use crate::work::progress::Progress;

/// Weight of the area-change term in the face cost (heuristic). Without the term, faces that keep
/// their angles could shrink whole limbs to a point.
const AREA: f64 = 0.45;

/// Number added to the diagonal entry of each unknown in the stiffness matrix, as a fraction of the
/// summed absolute stiffness of the springs that act on this unknown (tolerance: keeps the matrix
/// positive definite where springs of positive and negative stiffness cancel).
const REGULARISATION: f64 = 1e-6;

/// Maximum number of descent steps in a round of [`slide_outlines`]. After each round edges are
/// flipped and costly faces are split (heuristic).
const STEPS: usize = 20;
/// Number of rounds of descent and mesh adaptation in [`slide_outlines`] (heuristic).
const ROUNDS: usize = 4;

/// Returns new positions of the vertices along the outlines (fractions of the whole outline): for
/// each ring of the piece, a list of pairs `[source, target]`. With these positions the distortion
/// between the designs is less than in `mesh`. `None` if no vertex can slide, if rounding makes the
/// mesh invalid, or on a cancel.
pub(crate) fn slide_outlines(
    piece: &PieceMatch,
    mesh: &CompatibleMesh,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Option<Vec<Vec<[f64; 2]>>> {
    let rings = Side::BOTH.map(|side| {
        let rings = piece.rings.iter().map(|r| [&r.source, &r.target][side]);
        BoundaryRings::of(&rings.collect::<Vec<_>>())
    });
    // The designs are processed in a fixed order, so that exchanging `source` and `target` only
    // exchanges them in the result.
    let sides = if precedes(&rings[0], &rings[1]) {
        Side::BOTH
    } else {
        [Side::Target, Side::Source]
    };
    let (mut pair, scales) = equal_area_pair(mesh, rings[0].points.len(), sides);
    let mut sliding = sliders(piece, sides);
    if sliding.is_empty() {
        return None;
    }
    for _ in 0..ROUNDS {
        let energy = MeshEnergy::new(&pair, &sliding, scales, AREA);
        let mut proxy = QuadraticProxy::of(&energy, &pair, &sliding, progress)?;
        let (points, slides) = energy.minimise(STEPS, |forces| proxy.solve(forces), progress);
        if !pair.move_to(points) {
            return None;
        }
        for (slider, by) in sliding.iter_mut().zip(slides) {
            slider.slide(by);
        }
        refit(&mut pair, options, progress).ok()?;
    }
    Some(places(piece, sides, &sliding))
}

/// Returns one sliding vertex for each vertex of the matched rings, except for pinned vertices.
fn sliders(piece: &PieceMatch, sides: [Side; 2]) -> Vec<SlidingVertex<'_>> {
    let mut ring_start = 0;
    let mut all = Vec::new();
    for ring in &piece.rings {
        if let Some(course) = &ring.course {
            let free = (0..course.places().len()).filter(|&k| !course.is_pinned(k));
            all.extend(free.map(|k| SlidingVertex {
                vertex: (ring_start + k) as u32,
                curves: sides.map(|side| &course.curves()[side]),
                places: sides.map(|side| course.places()[k][side]),
            }));
        }
        ring_start += ring.source.len();
    }
    all
}

/// Returns the positions `[source, target]` of all vertices along the outlines after the slides:
/// one list for each ring, empty for a ring without matched curves.
fn places(piece: &PieceMatch, sides: [Side; 2], sliders: &[SlidingVertex]) -> Vec<Vec<[f64; 2]>> {
    let mut ring_start = 0;
    let mut sliders = sliders.iter().peekable();
    let rings = piece.rings.iter().map(|ring| {
        let mut places = ring
            .course
            .as_ref()
            .map_or(Vec::new(), |c| c.places().to_vec());
        for (k, places) in places.iter_mut().enumerate() {
            if let Some(slider) = sliders.next_if(|s| s.vertex as usize == ring_start + k) {
                // `sides` is its own inverse, so this restores the order source, target.
                *places = sides.map(|side| slider.places[side]);
            }
        }
        ring_start += ring.source.len();
        places
    });
    rings.collect()
}

/// Returns the piece's mesh with its designs in the order `sides`, and the scale factor of each
/// design. Both designs are scaled to equal area, so that uniform growth does not count as
/// distortion.
fn equal_area_pair(mesh: &CompatibleMesh, fixed: usize, sides: [Side; 2]) -> (PairMesh, [f64; 2]) {
    let points = [mesh.source(), mesh.target()];
    let scales = sides.map(|side| {
        let corners = |face: &[u32; 3]| face.map(|v| points[side][v as usize]);
        let doubled = mesh
            .faces()
            .iter()
            .map(|face| face_cost::twice_area(corners(face)));
        doubled.sum::<f64>().sqrt().recip()
    });
    let placed = |d: usize| points[sides[d]].iter().map(|&p| p * scales[d]).collect();
    let pair = PairMesh::new(fixed, [placed(0), placed(1)], mesh.faces().to_vec());
    (pair, scales)
}

/// Network of springs that approximates the cost at fixed areas. Each design has springs between
/// its vertices. A sliding vertex has a single unknown, which moves it in both designs.
struct QuadraticProxy {
    factor: Cholesky,
    workspace: CholeskyWorkspace,
}

impl QuadraticProxy {
    /// Assembles and factors the stiffness matrix of the springs; `None` if it is not positive
    /// definite, or on a cancel.
    fn of(
        energy: &MeshEnergy,
        mesh: &PairMesh,
        sliders: &[SlidingVertex],
        progress: &dyn Progress,
    ) -> Option<Self> {
        let n = energy.inner.len();
        let mut inner_of = vec![None; mesh.points[0].len()];
        let mut slider_of = inner_of.clone();
        for (i, &v) in energy.inner.iter().enumerate() {
            inner_of[v as usize] = Some(i);
        }
        for (i, slider) in sliders.iter().enumerate() {
            slider_of[slider.vertex as usize] = Some(i);
        }
        // For a vertex, a design and an axis: the index of the unknown that moves the vertex along
        // the axis, and the derivative of its coordinate with respect to this unknown. `None` if
        // the vertex is fixed.
        let unknown_of = |v: u32, d: usize, axis: usize| -> Option<(u32, f64)> {
            if let Some(i) = inner_of[v as usize] {
                return Some((((2 * d + axis) * n + i) as u32, 1.0));
            }
            let i = slider_of[v as usize]?;
            Some(((4 * n + i) as u32, energy.velocity(i, 0.0, d)[axis]))
        };
        let unknowns = energy.unknown_count();
        // The capacity is 36 entries for each face (two designs × two axes × three edges × three
        // entries) and one for each unknown.
        let mut matrix = SymmetricMatrix::zero(unknowns, 36 * energy.faces.len() + unknowns);
        // The initial value is positive, so that an unknown without springs gets a positive
        // diagonal entry.
        let mut stiffness_of = vec![f64::MIN_POSITIVE; unknowns];
        for &(face, weight) in &energy.faces {
            let [p, q] = mesh.corners(face);
            for (d, stiffness) in face_cost::stiffness(p, q).iter().enumerate() {
                for k in 0..3 {
                    let spring = weight * stiffness[k];
                    let ends = [face[(k + 1) % 3], face[(k + 2) % 3]];
                    for axis in 0..2 {
                        let ends = ends.map(|v| unknown_of(v, d, axis));
                        for (i, by) in ends.into_iter().flatten() {
                            matrix.add(i, i, spring * by * by);
                            stiffness_of[i as usize] += (spring * by * by).abs();
                        }
                        if let [Some((i, by)), Some((j, other))] = ends {
                            matrix.add(i, j, -spring * by * other);
                        }
                    }
                }
            }
        }
        for (i, stiffness_of) in stiffness_of.into_iter().enumerate() {
            matrix.add(i as u32, i as u32, REGULARISATION * stiffness_of);
        }
        let factor = Cholesky::factor_cancellable(&matrix, progress).ok()?.ok()?;
        let workspace = factor.workspace(1);
        Some(Self { factor, workspace })
    }

    /// Replaces `forces`, the right-hand side of a linear system with the stiffness matrix, by the
    /// solution of the system.
    fn solve(&mut self, forces: &mut [f64]) {
        self.factor.solve_in_place(forces, &mut self.workspace);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::{MatchSettings, PointPair, match_regions};
    use crate::geometry::{DVec2, FillRule, Regions};
    use crate::work::progress::Silent;

    fn region(points: &[(f64, f64)]) -> Regions {
        let ring = points.iter().copied().map(DVec2::from).collect();
        Regions::from_rings(&[ring], FillRule::EvenOdd).expect("a region")
    }

    fn block() -> Regions {
        region(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 4.0)])
    }

    fn key() -> Regions {
        let points = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (9.0, 1.0)];
        region(
            &[
                &points[..],
                &[(9.0, 2.0), (3.0, 2.0), (3.0, 3.5), (0.0, 4.0)],
            ]
            .concat(),
        )
    }

    fn piece(designs: [&Regions; 2], pins: Vec<PointPair>) -> PieceMatch {
        let settings = MatchSettings {
            pins,
            ..MatchSettings::default()
        };
        let matched = match_regions(designs[0], designs[1], &settings, &Silent);
        matched.expect("a match").pieces.remove(0)
    }

    fn mesh(piece: &PieceMatch) -> CompatibleMesh {
        crate::compatible::mesh_of_piece(piece, &PolygonOptions::default(), &Silent)
            .expect("a mesh")
    }

    fn slid(piece: &PieceMatch) -> PieceMatch {
        let places =
            super::slide_outlines(piece, &mesh(piece), &PolygonOptions::default(), &Silent);
        piece.with_ring_places(&places.expect("something slides"))
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn sliding_reduces_distortion_and_keeps_the_outlines() {
        let before = piece([&block(), &key()], vec![]);
        let after = slid(&before);
        let [worse, better] = [&before, &after].map(|piece| mesh(piece).distortion(0.1));
        assert!(better < 0.9 * worse, "{worse} to {better}");
        for design in [
            (&block(), &after.rings[0].source),
            (&key(), &after.rings[0].target),
        ] {
            let (regions, ring) = design;
            let mut points = regions.rings().flat_map(|ring| ring.points());
            assert!(points.all(|p| ring.contains(p)));
        }
    }

    #[test]
    fn pins_stay_where_they_are() {
        let pin = PointPair {
            source: DVec2::new(2.0, 0.0),
            target: DVec2::new(3.0, 0.5),
        };
        let after = slid(&piece([&block(), &key()], vec![pin]));
        let ring = &after.rings[0];
        let mut pairs = ring.source.iter().zip(&ring.target);
        let is_pin =
            |(p, q): (&DVec2, &DVec2)| p.distance(pin.source) + q.distance(pin.target) < 1e-12;
        assert!(pairs.any(is_pin));
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn exchanged_designs_slide_to_the_same_places() {
        let pieces = [[&block(), &key()], [&key(), &block()]].map(|designs| piece(designs, vec![]));
        let max_distance = |[there, back]: [&PieceMatch; 2]| {
            let [there, back] = [there, back].map(|piece| &piece.rings[0]);
            let there = there.source.iter().zip(&there.target);
            let back = back.target.iter().zip(&back.source);
            let distances = there
                .zip(back)
                .map(|((p, q), (a, b))| a.distance(*p) + b.distance(*q));
            distances.fold(0.0, f64::max)
        };
        assert_eq!(max_distance(pieces.each_ref()), 0.0);
        let slid = pieces.each_ref().map(slid);
        assert_eq!(max_distance(slid.each_ref()), 0.0);
    }
}
