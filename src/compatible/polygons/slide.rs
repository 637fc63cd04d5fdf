//! Correspondence and map improved together: the vertices of both outlines
//! slide along them while the inner ones follow and the mesh is changed with
//! them, so that the map between the designs distorts less.
//!
//! What slides over a corner cuts it off; the rings are made anew at the
//! places found, corners and all.
//!
//! Guaranteed: pinned vertices stay; the designs exchanged give the same
//! places exchanged, bit by bit. Not guaranteed: that the places are in order
//! around corners, or a minimum.

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

/// What the change of area costs against the fourth power of the conformal distortion:
/// without it a map without distortion would crowd whole limbs into a point. Of 60 pairs of
/// outlines of one class the 95th percentile of conformal distortion is 1.84 in the median
/// with 1, 1.77 with this; of 200 of letters, area up and down is 0.026 and 0.045 in the
/// worst tenth.
const AREA: f64 = 0.45;

/// Share of its own stiffness that holds each unknown: as for springs.
const HELD: f64 = 1e-6;

/// Steps of all that moves before the mesh is changed, and how often that is
/// done.
const STEPS: usize = 20;
const ROUNDS: usize = 4;

/// For each ring of a piece the places of its vertices, as
/// `Course::places`, by which the map distorts less than by those that it
/// has in this mesh of it; none where nothing slides.
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
    let sides = if precedes(&rings[0], &rings[1]) {
        Side::BOTH
    } else {
        [Side::Target, Side::Source]
    };
    let (mut pair, scales) = of_one_area(mesh, rings[0].points.len(), sides);
    let mut sliders = sliders(piece, sides);
    if sliders.is_empty() {
        return None;
    }
    for _ in 0..ROUNDS {
        let motion = MeshEnergy::new(&pair, &sliders, scales, AREA);
        let mut proxy = QuadraticProxy::of(&motion, &pair, &sliders, progress)?;
        let (at, slid) = motion.minimised(STEPS, |forces| proxy.solve(forces), progress);
        if !pair.move_to(at) {
            return None;
        }
        for (slider, by) in sliders.iter_mut().zip(slid) {
            slider.slide(by);
        }
        refit(&mut pair, options, progress).ok()?;
    }
    Some(places(piece, sides, &sliders))
}

/// A slider for each vertex on a matched ring that nobody pinned.
fn sliders(piece: &PieceMatch, sides: [Side; 2]) -> Vec<SlidingVertex<'_>> {
    let mut first = 0;
    let mut all = Vec::new();
    for ring in &piece.rings {
        if let Some(course) = &ring.course {
            let free = (0..course.places().len()).filter(|&k| !course.is_pinned(k));
            all.extend(free.map(|k| SlidingVertex {
                vertex: (first + k) as u32,
                curves: sides.map(|side| &course.curves()[side]),
                places: sides.map(|side| course.places()[k][side]),
            }));
        }
        first += ring.source.len();
    }
    all
}

/// The places of all vertices, ring by ring, once the sliders slid.
fn places(piece: &PieceMatch, sides: [Side; 2], sliders: &[SlidingVertex]) -> Vec<Vec<[f64; 2]>> {
    let mut first = 0;
    let mut sliders = sliders.iter().peekable();
    let rings = piece.rings.iter().map(|ring| {
        let mut places = ring
            .course
            .as_ref()
            .map_or(Vec::new(), |c| c.places().to_vec());
        for (k, places) in places.iter_mut().enumerate() {
            if let Some(slider) = sliders.next_if(|s| s.vertex as usize == first + k) {
                // Exchanged twice is as it was.
                *places = sides.map(|side| slider.places[side]);
            }
        }
        first += ring.source.len();
        places
    });
    rings.collect()
}

/// The piece's mesh, sides in this order, with both designs of one area: what
/// grows as a whole is not distorted. With how many times as large each is.
fn of_one_area(mesh: &CompatibleMesh, fixed: usize, sides: [Side; 2]) -> (PairMesh, [f64; 2]) {
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

/// The curvature of the cost where areas are kept, over all unknowns: springs
/// between vertices, of which those on the outlines have one way to go in both
/// designs.
struct QuadraticProxy {
    factor: Cholesky,
    workspace: CholeskyWorkspace,
}

impl QuadraticProxy {
    /// None where the springs do not hold, or on a cancel.
    fn of(
        motion: &MeshEnergy,
        mesh: &PairMesh,
        sliders: &[SlidingVertex],
        progress: &dyn Progress,
    ) -> Option<Self> {
        let n = motion.inner.len();
        let mut inner_of = vec![None; mesh.points[0].len()];
        let mut slider_of = inner_of.clone();
        for (i, &v) in motion.inner.iter().enumerate() {
            inner_of[v as usize] = Some(i);
        }
        for (i, slider) in sliders.iter().enumerate() {
            slider_of[slider.vertex as usize] = Some(i);
        }
        // What moves a vertex along an axis: an unknown, and how much.
        let moved = |v: u32, d: usize, axis: usize| -> Option<(u32, f64)> {
            if let Some(i) = inner_of[v as usize] {
                return Some((((2 * d + axis) * n + i) as u32, 1.0));
            }
            let i = slider_of[v as usize]?;
            Some(((4 * n + i) as u32, motion.velocity(i, 0.0, d)[axis]))
        };
        let unknowns = motion.unknowns();
        // Two designs, two axes, three edges, three entries each.
        let mut matrix = SymmetricMatrix::zero(unknowns, 36 * motion.faces.len() + unknowns);
        let mut own = vec![f64::MIN_POSITIVE; unknowns];
        for &(face, weight) in &motion.faces {
            let [p, q] = mesh.corners(face);
            for (d, stiffness) in face_cost::stiffness(p, q).iter().enumerate() {
                for k in 0..3 {
                    let spring = weight * stiffness[k];
                    let ends = [face[(k + 1) % 3], face[(k + 2) % 3]];
                    for axis in 0..2 {
                        let ends = ends.map(|v| moved(v, d, axis));
                        for (i, by) in ends.into_iter().flatten() {
                            matrix.add(i, i, spring * by * by);
                            own[i as usize] += (spring * by * by).abs();
                        }
                        if let [Some((i, by)), Some((j, other))] = ends {
                            matrix.add(i, j, -spring * by * other);
                        }
                    }
                }
            }
        }
        for (i, own) in own.into_iter().enumerate() {
            matrix.add(i as u32, i as u32, HELD * own);
        }
        let factor = Cholesky::factor_if_wanted(&matrix, progress).ok()?.ok()?;
        let workspace = factor.workspace(1);
        Some(Self { factor, workspace })
    }

    /// Forces become displacements.
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
        let wanted = MatchSettings {
            pins,
            ..MatchSettings::default()
        };
        let matched = match_regions(designs[0], designs[1], &wanted, &Silent);
        matched.expect("a match").pieces.remove(0)
    }

    fn mesh(piece: &PieceMatch) -> CompatibleMesh {
        crate::compatible::mesh_of_piece(piece, &PolygonOptions::default(), &Silent)
            .expect("a mesh")
    }

    fn slid(piece: &PieceMatch) -> PieceMatch {
        let places =
            super::slide_outlines(piece, &mesh(piece), &PolygonOptions::default(), &Silent);
        piece.moved(&places.expect("something slides"))
    }

    #[test]
    fn what_slid_distorts_less_and_keeps_the_outlines() {
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
    fn the_designs_exchanged_slide_to_the_same_places() {
        let pieces = [[&block(), &key()], [&key(), &block()]].map(|designs| piece(designs, vec![]));
        let apart = |[there, back]: [&PieceMatch; 2]| {
            let [there, back] = [there, back].map(|piece| &piece.rings[0]);
            let there = there.source.iter().zip(&there.target);
            let back = back.target.iter().zip(&back.source);
            let apart = there
                .zip(back)
                .map(|((p, q), (a, b))| a.distance(*p) + b.distance(*q));
            apart.fold(0.0, f64::max)
        };
        assert_eq!(apart(pieces.each_ref()), 0.0);
        let slid = pieces.each_ref().map(slid);
        assert_eq!(apart(slid.each_ref()), 0.0);
    }
}
