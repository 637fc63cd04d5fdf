//! Edges of outlines as elements of their own.
//!
//! Neighbours along an outline that are sheared differently want its edges in
//! directions that do not fit together, and what is smooth in both designs is
//! jagged between them. So each edge of an outline is an element too, with
//! the energy ½ k |Δv − e(t)|²: its vector e turns evenly, on the branch of the
//! rotation of its face, and is as long as `lengths` says. The angle between two edges
//! that are as they should be then goes evenly from the one in the source to the one in
//! the target, and the sum of the sizes of all of them is never more than
//! what lies between the designs.
//!
//! k goes with 1/length, so that the sum over an outline is an integral along
//! it, whatever it is divided into; and with the diameter of the part, so that
//! a part does not depend on its size. It is the mean of both designs': the way
//! back is the way.

use super::assembly::{ElementMap, FaceMap, LocalMaps};
use super::options::ArapOptions;
use super::straight_sides::OutlineConstraints;
use super::time_window::TimeWindow;
use crate::compatible::CompatibleMesh;
use crate::geometry::{Bounds, DVec2};

/// The stiffness of an edge as long as the diameter of its part. Turning beyond the ends,
/// of 60 pairs of outlines in the worst tenth and of 200 of letters in the median, is 0.156
/// and 0.028 with a third of this, 0.070 and 0.017 with this, 0.060 and 0.015 with a third
/// more; vertices are accelerated by a twentieth more from each to the next.
const STIFFNESS: f64 = 0.12;

/// The most of an edge: rounding of the shortest is not what holds the film.
const MOST: f64 = 1e4;

impl LocalMaps {
    /// With the edges of drawn outlines as elements, where those are held.
    pub(super) fn rimmed(
        mut self,
        mesh: &CompatibleMesh,
        lives: &[Option<TimeWindow>],
        (options, outlined): (&ArapOptions, OutlineConstraints),
    ) -> Self {
        if outlined.of(options.homotopy) == OutlineConstraints::Yes {
            let edges = edges(mesh, &self.faces, lives, options.symmetric);
            self.elements.extend(edges);
        }
        self
    }
}

/// The edges of all outlines, but those of parts that come and go.
fn edges(
    mesh: &CompatibleMesh,
    faces: &[FaceMap],
    lives: &[Option<TimeWindow>],
    symmetric: bool,
) -> Vec<ElementMap> {
    let connectivity = mesh.connectivity();
    let parts = mesh.components();
    let diameters = diameters(mesh, &parts);
    let mut edges = Vec::new();
    for (face, &corners) in mesh.faces().iter().enumerate() {
        let part = parts[corners[0] as usize] as usize;
        if lives.get(part).is_some_and(Option::is_some) {
            continue;
        }
        let outer = (0..3).filter(|&k| connectivity.neighbour(face, k).is_none());
        edges.extend(outer.map(|k| {
            let ends = [corners[k], corners[(k + 1) % 3]];
            edge(mesh, ends, &faces[face], (diameters[part], symmetric))
        }));
    }
    edges
}

fn edge(
    mesh: &CompatibleMesh,
    ends: [u32; 2],
    face: &FaceMap,
    (diameters, symmetric): ([f64; 2], bool),
) -> ElementMap {
    let [p, q] = [mesh.source(), mesh.target()].map(|at| {
        let [a, b] = ends.map(|v| at[v as usize]);
        b - a
    });
    let stretched: DVec2 = face.map.stretch * p;
    let [source, target] = [(p, diameters[0]), (q, diameters[1])]
        .map(|(edge, diameter)| (STIFFNESS * diameter / edge.length()).min(MOST));
    ElementMap {
        ends,
        vector: p,
        angle: face.map.angle + p.perp_dot(stretched).atan2(p.dot(stretched)),
        stretch: (q.length_squared() / p.length_squared()).sqrt(),
        stiffness: match symmetric {
            true => 0.5 * (source + target),
            false => source,
        },
    }
}

/// Of each part, in source and target.
fn diameters(mesh: &CompatibleMesh, parts: &[u32]) -> Vec<[f64; 2]> {
    let count = parts.iter().max().map_or(0, |&last| last as usize + 1);
    let mut bounds = vec![[None; 2]; count];
    for (v, &part) in parts.iter().enumerate() {
        let places = [mesh.source()[v], mesh.target()[v]];
        for (bounds, place) in bounds[part as usize].iter_mut().zip(places) {
            let point = Bounds::at(place);
            *bounds = Some(bounds.map_or(point, |all: Bounds| all.union(&point)));
        }
    }
    let diameter = |of: Option<Bounds>| of.map_or(0.0, |bounds| bounds.diameter());
    let each = bounds.into_iter();
    each.map(|sides| sides.map(diameter)).collect()
}

#[cfg(test)]
mod tests {
    use crate::compatible::CompatibleMesh;
    use crate::geometry::{DVec2, max_overshoot, orient2d, total_turning};
    use crate::warp::{Arap, ArapOptions, Warp};
    use crate::work::progress::Silent;
    use std::f64::consts::TAU;

    /// A plate with so many points along its outline, straight below and wavy on top,
    /// and one that is wavy below, each on a ring of points within.
    fn waves(points: u32) -> CompatibleMesh {
        let at = |k: u32, wavy: f64| {
            let angle = f64::from(k % points) * TAU / f64::from(points);
            let place = DVec2::from_angle(angle);
            place * (1.0 + 0.2 * (9.0 * angle).sin() * (wavy * place.y).max(0.0))
        };
        let of = |wavy: f64| {
            let ring = |size: f64| (0..points).map(move |k| at(k, wavy) * size);
            ring(0.8).chain(ring(1.0)).chain([DVec2::ZERO]).collect()
        };
        let faces = (0..points).flat_map(|k| {
            let next = (k + 1) % points;
            let [a, b, c, d] = [k, next, k + points, next + points];
            [[2 * points, a, b], [a, c, d], [a, d, b]]
        });
        CompatibleMesh::new(faces.collect(), of(1.0), of(-1.0), vec![]).expect("a mesh")
    }

    fn drawn(mesh: &CompatibleMesh, subdivisions: u32) -> Arap {
        let options = ArapOptions {
            subdivisions,
            ..ArapOptions::default()
        };
        Arap::of_outlines(mesh, &options, &[], &Silent).expect("a film")
    }

    fn places(film: &Arap, t: f64) -> Vec<DVec2> {
        let mut placer = film.placer();
        placer.place(t);
        placer.placement().in_frame.clone()
    }

    fn excess(film: &Arap) -> f64 {
        let outlines = film.mesh().boundary_loops();
        let turned = (0..=16).map(|k| {
            let t = f64::from(k) / 16.0;
            let places = places(film, t);
            let ring = |ring: &Vec<u32>| ring.iter().map(|&v| places[v as usize]).collect();
            let rings: Vec<Vec<DVec2>> = outlines.iter().map(ring).collect();
            [t, total_turning(&rings, 2.4)]
        });
        max_overshoot(&turned.collect::<Vec<_>>())
    }

    #[test]
    fn what_is_round_in_both_designs_is_rounder_between_them_than_faces_alone_have_it() {
        // Every third point slides along the circle: all faces are sheared.
        let mesh = waves(90);
        let round = |slid: f64| -> Vec<DVec2> {
            let at = |k: u32| {
                let by = if k.is_multiple_of(3) { slid } else { 0.0 };
                DVec2::from_angle((f64::from(k) + by) * TAU / 90.0)
            };
            let inner = (0..90).map(|k| at(k) * 0.95);
            let inner: Vec<DVec2> = inner.collect();
            let outer = (0..90).map(at);
            inner
                .into_iter()
                .chain(outer)
                .chain([DVec2::ZERO])
                .collect()
        };
        let still = round(0.0)[..90].to_vec();
        let slid = round(0.8)[90..].to_vec();
        let target = [still, slid].concat();
        let mesh = CompatibleMesh::new(mesh.faces().to_vec(), round(0.0), target, vec![]);
        let mesh = mesh.expect("a mesh");
        let plain = Arap::build(&mesh, &ArapOptions::default(), &Silent).expect("a film");
        let [held, plain] = [&drawn(&mesh, 0), &plain].map(excess);
        assert!(held < 0.5 * plain, "{held} {plain}");
    }

    #[test]
    fn the_designs_are_met_and_the_way_back_is_the_way() {
        let mesh = waves(60);
        let film = drawn(&mesh, 0);
        let back = film.swapped(&Silent).expect("a film");
        assert_eq!(places(&film, 0.0), mesh.source());
        assert_eq!(places(&film, 1.0), mesh.target());
        for t in [-0.2, 0.1, 0.5, 0.9] {
            let [there, back] = [places(&film, t), places(&back, 1.0 - t)];
            for (p, q) in there.iter().zip(&back) {
                assert!(p.distance(*q) < 1e-12, "{p} {q} at {t}");
            }
            let is_positive = |face: &[u32; 3]| {
                let [a, b, c] = face.map(|v| there[v as usize]);
                orient2d(a, b, c) > 0.0
            };
            assert!(mesh.faces().iter().all(is_positive) || !(0.0..=1.0).contains(&t));
        }
    }

    #[test]
    fn a_film_does_not_depend_on_size_nor_much_on_how_edges_are_divided() {
        let mesh = waves(60);
        let film = drawn(&mesh, 0);
        let large = |at: &[DVec2]| at.iter().map(|&p| p * 1000.0).collect();
        let scaled = CompatibleMesh::new(
            mesh.faces().to_vec(),
            large(mesh.source()),
            large(mesh.target()),
            vec![],
        );
        let [here, scaled, divided] =
            [&film, &drawn(&scaled.expect("a mesh"), 0), &drawn(&mesh, 2)]
                .map(|film| places(film, 0.4));
        for (v, p) in here.iter().enumerate() {
            assert!(p.distance(scaled[v] / 1000.0) < 1e-9);
            // A fiftieth of a wave.
            assert!(p.distance(divided[v]) < 4e-3, "{p} {}", divided[v]);
        }
    }
}
