//! Solid regions and bars that are carried by the vertices of a placement.

use super::{Coating, Hole, Swell};
use crate::geometry::{Crossing, DVec2, RingEdge, Side, count_crossings, crossings};
use crate::warp::Life;
use std::collections::BTreeSet;

/// What is drawn over the vertices of a placement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solid {
    /// Closed boundary walks of the filled faces, as vertex indices; empty
    /// for a truss, whose panels only carry its nodes.
    pub loops: Vec<Vec<u32>>,
    /// Bars, as pairs of vertex indices; empty for a mesh.
    pub bars: Vec<[u32; 2]>,
    /// Width of the bars, in units of the designs.
    pub bar_width: f64,
    /// Holes in the filled faces that one of the designs has alone.
    pub holes: Vec<Hole>,
    /// Parts that one of the designs has alone and that swell, each drawn in
    /// the stead of its walks.
    pub swells: Vec<Swell>,
    /// Parts that one of the designs has alone and that grow, which are not
    /// drawn while they are specks.
    pub specks: Vec<Speck>,
    /// How all that is painted; none where it has one colour.
    pub coating: Option<Coating>,
}

/// A part that grows from a speck, or shrinks to one.
#[derive(Clone, Debug, PartialEq)]
pub struct Speck {
    /// Its boundary walks, by their numbers.
    pub walks: Vec<usize>,
    /// The design that has it.
    pub side: Side,
    /// When it changes its size.
    pub life: Life,
}

impl Speck {
    fn is_gone(&self, t: f64) -> bool {
        self.life.share(t) == [1.0, 0.0][self.side]
    }
}

impl Solid {
    /// The boundary walks at `t`, when the vertices are at these places; then
    /// the parts that swell and the holes, those that are there.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn rings_at(&self, places: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let inked = self.inked_at(places, t).into_iter();
        inked.map(|(_, ring)| ring).collect()
    }

    /// The rings of [`Self::rings_at`], each with its coat; 0 where there is one
    /// colour.
    fn inked_at(&self, places: &[DVec2], t: f64) -> Vec<(usize, Vec<DVec2>)> {
        let coating = self.coating.as_ref();
        let of_walk = |walk: usize| coating.map_or(0, |coating| coating.of_walks[walk]);
        let of_hole = |hole: usize| coating.map_or(0, |coating| coating.of_holes[hole]);
        let swells = self.swelling(t).flat_map(|swell| {
            let coat = swell.walks().first().map_or(0, |&walk| of_walk(walk));
            let rings = self.swollen(swell, places, t).into_iter();
            rings.map(move |ring| (coat, ring))
        });
        let holes = self.holes.iter().enumerate();
        let holes = holes.filter_map(|(k, hole)| Some((of_hole(k), hole.at(places, t)?)));
        let walks = self.walks(t);
        let walks = walks.map(|walk| (of_walk(walk), self.walk_at(walk, places)));
        walks.chain(swells).chain(holes).collect()
    }

    /// The rings of each coat at `t`, the lowest coat first, and its number; of a
    /// solid of one colour all in one.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn coated_at(&self, places: &[DVec2], t: f64) -> Vec<(usize, Vec<Vec<DVec2>>)> {
        let Some(coating) = &self.coating else {
            return vec![(0, self.rings_at(places, t))];
        };
        let mut coats = vec![Vec::new(); coating.coats.len()];
        for (coat, ring) in self.inked_at(places, t) {
            coats[coat].push(ring);
        }
        let order = coating.order(t).into_iter();
        order
            .map(|coat| (coat, std::mem::take(&mut coats[coat])))
            .collect()
    }

    /// Where rings of [`Self::rings_at`] cross; those of two coats may.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn crossings_at(&self, places: &[DVec2], t: f64) -> Vec<Crossing> {
        let Some(coating) = &self.coating else {
            return crossings(&self.rings_at(places, t));
        };
        let rings = self.inked_at(places, t);
        let of_coat = |coat: usize| {
            let is_in_coat = |k: &usize| rings[*k].0 == coat;
            let members: Vec<usize> = (0..rings.len()).filter(is_in_coat).collect();
            let own: Vec<Vec<DVec2>> = members.iter().map(|&k| rings[k].1.clone()).collect();
            let mut found = crossings(&own);
            for edge in found.iter_mut().flat_map(|crossing| &mut crossing.edges) {
                edge.ring = members[edge.ring];
            }
            found
        };
        (0..coating.coats.len()).flat_map(of_coat).collect()
    }

    /// How often rings cross that are in one coat.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn count_crossings(&self, places: &[DVec2], t: f64) -> usize {
        let coats = self.coated_at(places, t);
        coats.iter().map(|(_, rings)| count_crossings(rings)).sum()
    }

    fn walk_at(&self, walk: usize, places: &[DVec2]) -> Vec<DVec2> {
        self.loops[walk]
            .iter()
            .map(|&v| places[v as usize])
            .collect()
    }

    /// The walks that are drawn as they are at `t`, by their numbers.
    fn walks(&self, t: f64) -> impl Iterator<Item = usize> {
        let swelling = self.swelling(t).flat_map(Swell::walks);
        let gone = self.specks.iter().filter(|speck| speck.is_gone(t));
        let otherwise: BTreeSet<usize> = gone
            .flat_map(|speck| &speck.walks)
            .chain(swelling)
            .copied()
            .collect();
        (0..self.loops.len()).filter(move |walk| !otherwise.contains(walk))
    }

    /// The parts that are not as they were drawn at `t`.
    fn swelling(&self, t: f64) -> impl Iterator<Item = &Swell> {
        self.swells.iter().filter(move |swell| swell.share(t) < 1.0)
    }

    /// A part as far as it has swollen.
    fn swollen(&self, swell: &Swell, places: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let first = swell.walks().first();
        let first = first.map(|&walk| self.walk_at(walk, places));
        swell.at(&first.unwrap_or_default(), t)
    }

    /// The corners of the face at an edge of [`Self::rings_at`], of a boundary
    /// walk its two ends; of what swells, whose edges have no faces, those of some
    /// edge of the part.
    pub(crate) fn corners_at(&self, edge: RingEdge, places: &[DVec2], t: f64) -> Option<Vec<u32>> {
        let RingEdge { ring, point } = edge;
        let ends = |walk: usize, point: usize| {
            let walk = &self.loops[walk];
            vec![walk[point], walk[(point + 1) % walk.len()]]
        };
        let walks: Vec<usize> = self.walks(t).collect();
        if let Some(&walk) = walks.get(ring) {
            return Some(ends(walk, point));
        }
        let mut ring = ring - walks.len();
        for swell in self.swelling(t) {
            let rings = self.swollen(swell, places, t).len();
            if ring < rings {
                return swell.walks().first().map(|&walk| ends(walk, 0));
            }
            ring -= rings;
        }
        let mut holes = self.holes.iter().filter(|hole| !hole.is_gone(t));
        Some(holes.nth(ring)?.face(point).to_vec())
    }

    /// How many of the rings that come and go are not there at `t`: points, to
    /// what counts rings.
    pub(crate) fn gone_at(&self, t: f64) -> usize {
        let parts = self.swells.iter().filter(|swell| swell.share(t) <= 0.0);
        let specks = self.specks.iter().filter(|speck| speck.is_gone(t));
        let walks: usize = parts
            .map(|swell| swell.walks().len())
            .chain(specks.map(|speck| speck.walks.len()))
            .sum();
        self.holes.iter().filter(|hole| hole.is_gone(t)).count() + walks
    }

    /// The bars at the given vertex places.
    ///
    /// # Panics
    /// Where a bar ends at a vertex that has no place.
    #[must_use]
    pub fn bars_at(&self, places: &[DVec2]) -> Vec<[DVec2; 2]> {
        let at = |bar: &[u32; 2]| bar.map(|v| places[v as usize]);
        self.bars.iter().map(at).collect()
    }
}
