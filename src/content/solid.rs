//! Solid regions and bars that are carried by the vertices of a placement.

use super::{InkedLayer, PaintLayerStack, SwellingShape, TransientHole};
use crate::colour::Paint;
use crate::geometry::{DVec2, EdgeCrossing, RingEdge, Side, count_crossings, crossings};
use crate::warp::{PartClock, TimeWindow};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// What is drawn over the vertices of a placement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidContent {
    /// Closed boundary walks of the filled faces, as vertex indices; empty
    /// for a truss, whose panels only carry its nodes.
    pub loops: Vec<Vec<u32>>,
    /// Bars, as pairs of vertex indices; empty for a mesh.
    pub bars: Vec<[u32; 2]>,
    /// For each bar its paints in source and target; empty where bars have no
    /// colours of their own.
    pub bar_paints: Vec<[Option<Paint>; 2]>,
    /// Width of the bars, in units of the designs.
    pub bar_width: f64,
    /// Holes in the filled faces that one of the designs has alone.
    pub holes: Vec<TransientHole>,
    /// Parts that one of the designs has alone and that swell, each drawn in
    /// the stead of its walks.
    pub swells: Vec<SwellingShape>,
    /// Parts that one of the designs has alone and that grow, which are not
    /// drawn while they are specks.
    pub specks: Vec<SeedShape>,
    /// How all that is painted; none where it has one colour.
    pub coating: Option<PaintLayerStack>,
    /// When its parts make their way; none where all do as the whole.
    pub clocks: Option<BarClocks>,
}

/// The clocks of the parts of a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct BarClocks {
    /// What there is of clocks; the last is that of the whole.
    pub clocks: Vec<PartClock>,
    /// For each boundary walk its clock.
    pub of_walks: Vec<usize>,
    /// For each hole its clock.
    pub of_holes: Vec<usize>,
    /// For each vertex its clock.
    pub of_vertices: Vec<usize>,
}

impl BarClocks {
    fn of_vertex(&self, vertex: u32) -> usize {
        self.of_vertices[vertex as usize]
    }
}

/// A ring, and what it is painted with.
struct InkedRing {
    coat: usize,
    key: InkKey,
    points: Vec<DVec2>,
}

/// What tells rings of one coat apart: the number of their clock, and of those that fade
/// the design that has them alone.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct InkKey {
    clock: usize,
    fading: Option<Side>,
}

/// Bars that are painted alike.
#[derive(Clone, Debug, PartialEq)]
pub struct InkedBars {
    /// Their paints in source and target; none where they have no colour of their
    /// own.
    pub paints: [Option<Paint>; 2],
    /// Their indices.
    pub bars: Vec<usize>,
}

impl InkedBars {
    /// Of so many bars, with a paint each or none: in the order in which paints are
    /// first seen, which is the order in which they are drawn.
    #[must_use]
    pub fn all(count: usize, paints: &[[Option<Paint>; 2]]) -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        // Forces are shown by colours, which are as many as bars then.
        let mut known = HashMap::new();
        for bar in 0..count {
            let paints = paints.get(bar).copied().unwrap_or_default();
            let bits = |paint: Paint| (paint.colour, paint.opacity.to_bits());
            let at = *known
                .entry(paints.map(|end| end.map(bits)))
                .or_insert_with(|| {
                    let bars = Vec::new();
                    all.push(Self { paints, bars });
                    all.len() - 1
                });
            all[at].bars.push(bar);
        }
        all
    }
}

/// A part that grows from a speck, or shrinks to one.
#[derive(Clone, Debug, PartialEq)]
pub struct SeedShape {
    /// Its boundary walks, by their numbers.
    pub walks: Vec<usize>,
    /// When it changes its size.
    pub life: TimeWindow,
}

impl SolidContent {
    /// The boundary walks at `t`, when the vertices are at these places; then
    /// the parts that swell and the holes, those that are there.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn rings_at(&self, places: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let inked = self.inked_at(places, t).into_iter();
        inked.map(|ring| ring.points).collect()
    }

    /// The boundary walks of parts that both designs have.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    pub(crate) fn lasting_at(&self, places: &[DVec2]) -> Vec<Vec<DVec2>> {
        let specks = self.specks.iter().flat_map(|speck| &speck.walks);
        let swells = self.swells.iter().flat_map(SwellingShape::walks);
        let alone: BTreeSet<usize> = specks.chain(swells).copied().collect();
        let lasting = (0..self.loops.len()).filter(|walk| !alone.contains(walk));
        lasting.map(|walk| self.walk_at(walk, places)).collect()
    }

    /// The rings of [`Self::rings_at`], each with its coat and its clock.
    fn inked_at(&self, places: &[DVec2], t: f64) -> Vec<InkedRing> {
        let coating = self.coating.as_ref();
        let fading = coating.filter(|all| all.fades);
        let of_walk = |walk: usize, points: Vec<DVec2>| InkedRing {
            coat: coating.map_or(0, |all| all.of_walks[walk]),
            key: InkKey {
                clock: self.clocks.as_ref().map_or(0, |all| all.of_walks[walk]),
                fading: fading.and_then(|all| all.lone_walks[walk]),
            },
            points,
        };
        let walks = self.walks(t);
        let walks = walks.map(|walk| of_walk(walk, self.walk_at(walk, places)));
        let swells = self.swelling(t).flat_map(|swell| {
            let walk = swell.walks().first().copied().unwrap_or_default();
            let rings = self.swollen(swell, places, t).into_iter();
            rings.map(move |ring| of_walk(walk, ring))
        });
        // Parts that have holes of one design alone are in both.
        let of_hole = |(hole, points): (usize, Vec<DVec2>)| InkedRing {
            coat: coating.map_or(0, |all| all.of_holes[hole]),
            key: InkKey {
                clock: self.clocks.as_ref().map_or(0, |all| all.of_holes[hole]),
                fading: None,
            },
            points,
        };
        let holes = self.holes.iter().enumerate();
        let holes = holes.filter_map(|(k, hole)| Some((k, hole.at(places, self.hole_time(k, t))?)));
        walks.chain(swells).chain(holes.map(of_hole)).collect()
    }

    /// The time that a boundary walk shows at `t`.
    fn walk_time(&self, walk: usize, t: f64) -> f64 {
        let clocks = self.clocks.as_ref();
        clocks.map_or(t, |clocks| clocks.clocks[clocks.of_walks[walk]].at(t))
    }

    /// The time that a hole shows at `t`.
    fn hole_time(&self, hole: usize, t: f64) -> f64 {
        let clocks = self.clocks.as_ref();
        clocks.map_or(t, |clocks| clocks.clocks[clocks.of_holes[hole]].at(t))
    }

    /// The time at `t` of a part that has these walks.
    fn part_time(&self, walks: &[usize], t: f64) -> f64 {
        walks.first().map_or(t, |&walk| self.walk_time(walk, t))
    }

    /// The rings of each coat at `t`, the lowest coat first; of a solid of one
    /// colour all in one. Those of a coat that show several times, or fade, stand apart.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn coated_at(&self, places: &[DVec2], t: f64) -> Vec<InkedLayer> {
        let Some(coating) = &self.coating else {
            let rings = self.rings_at(places, t);
            return vec![InkedLayer {
                t,
                rings,
                ..InkedLayer::default()
            }];
        };
        let mut of_coats = vec![BTreeMap::<InkKey, Vec<Vec<DVec2>>>::new(); coating.coats.len()];
        for ring in self.inked_at(places, t) {
            let of_key = of_coats[ring.coat].entry(ring.key).or_default();
            of_key.push(ring.points);
        }
        let of_coat = |coat: usize| {
            let mut of_keys = std::mem::take(&mut of_coats[coat]);
            if self.clocks.is_none() && !coating.fades {
                // Every coat is there then, empty or not.
                of_keys.entry(InkKey::default()).or_default();
            }
            of_keys.into_iter().map(move |(key, rings)| {
                let clocks = self.clocks.as_ref();
                let shows = |v: u32| clocks.is_none_or(|all| all.of_vertex(v) == key.clock);
                let gradients = coating.coats[coat].shading.at(places, shows);
                let t = clocks.map_or(t, |all| all.clocks[key.clock].at(t));
                let inked = InkedLayer {
                    coat,
                    t,
                    rings,
                    ..InkedLayer::default()
                };
                coating.coats[coat].ink(inked, gradients, key.fading)
            })
        };
        coating.order(t).into_iter().flat_map(of_coat).collect()
    }

    /// Where rings of [`Self::rings_at`] cross; those of two coats may.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn crossings_at(&self, places: &[DVec2], t: f64) -> Vec<EdgeCrossing> {
        let Some(coating) = &self.coating else {
            return crossings(&self.rings_at(places, t));
        };
        let rings = self.inked_at(places, t);
        let of_coat = |coat: usize| {
            let is_in_coat = |k: &usize| rings[*k].coat == coat;
            let members: Vec<usize> = (0..rings.len()).filter(is_in_coat).collect();
            let own: Vec<Vec<DVec2>> = members.iter().map(|&k| rings[k].points.clone()).collect();
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
        let mut coats = vec![Vec::new(); self.coating.as_ref().map_or(1, |all| all.coats.len())];
        for ring in self.inked_at(places, t) {
            coats[ring.coat].push(ring.points);
        }
        coats.iter().map(|rings| count_crossings(rings)).sum()
    }

    fn walk_at(&self, walk: usize, places: &[DVec2]) -> Vec<DVec2> {
        self.loops[walk]
            .iter()
            .map(|&v| places[v as usize])
            .collect()
    }

    /// The walks that are drawn as they are at `t`, by their numbers.
    fn walks(&self, t: f64) -> impl Iterator<Item = usize> {
        let swelling = self.swelling(t).flat_map(SwellingShape::walks);
        let gone = self
            .specks
            .iter()
            .filter(move |speck| self.is_gone(speck, t));
        let otherwise: BTreeSet<usize> = gone
            .flat_map(|speck| &speck.walks)
            .chain(swelling)
            .copied()
            .collect();
        (0..self.loops.len()).filter(move |walk| !otherwise.contains(walk))
    }

    /// The parts that are not as they were drawn at `t`.
    fn swelling(&self, t: f64) -> impl Iterator<Item = &SwellingShape> {
        let swells = self.swells.iter();
        swells.filter(move |swell| swell.share(self.part_time(swell.walks(), t)) < 1.0)
    }

    fn is_gone(&self, speck: &SeedShape, t: f64) -> bool {
        speck.life.is_gone(self.part_time(&speck.walks, t))
    }

    /// A part as far as it has swollen.
    fn swollen(&self, swell: &SwellingShape, places: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let first = swell.walks().first();
        let first = first.map(|&walk| self.walk_at(walk, places));
        swell.at(&first.unwrap_or_default(), self.part_time(swell.walks(), t))
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
        let mut holes = self.holes_at(t).filter(|(_, is_gone)| !is_gone);
        Some(holes.nth(ring)?.0.face(point).to_vec())
    }

    /// How many of the rings that come and go are not there at `t`: points, to
    /// what counts rings.
    pub(crate) fn gone_at(&self, t: f64) -> usize {
        let swollen = |swell: &SwellingShape| swell.share(self.part_time(swell.walks(), t));
        let swells = self.swells.iter().filter(|swell| swollen(swell) <= 0.0);
        let specks = self.specks.iter().filter(|speck| self.is_gone(speck, t));
        let walks: usize = swells
            .map(|swell| swell.walks().len())
            .chain(specks.map(|speck| speck.walks.len()))
            .sum();
        self.holes_at(t).filter(|(_, is_gone)| *is_gone).count() + walks
    }

    /// All holes, and whether each is gone at `t`.
    fn holes_at(&self, t: f64) -> impl Iterator<Item = (&TransientHole, bool)> {
        let holes = self.holes.iter().enumerate();
        holes.map(move |(k, hole)| (hole, hole.is_gone(self.hole_time(k, t))))
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
