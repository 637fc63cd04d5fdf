//! Filled regions and bars that move with the vertices of a placement: the content *solid*.
//!
//! Regions are boundary loops over mesh vertices. Parts and holes that exist in only one design are
//! drawn in other ways: parts swell from thin lines or grow from a seed shape (a tiny copy of
//! themselves), holes shrink. Rings may overlap; they should be filled together by the non-zero
//! rule.

use super::{InkedLayer, PaintLayerStack, SwellingShape, TransientHole};
use crate::colour::Paint;
use crate::geometry::{DVec2, EdgeCrossing, RingEdge, Side, count_crossings, crossings};
use crate::warp::{PartClock, TimeWindow};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Filled regions and bars over the vertices of a placement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolidContent {
    /// Closed boundary loops of the filled faces, as vertex indices; empty for a truss, whose
    /// panels are not filled.
    pub loops: Vec<Vec<u32>>,
    /// Bars, as pairs of vertex indices; empty for a mesh.
    pub bars: Vec<[u32; 2]>,
    /// For each bar, its paints in source and target; empty if the bars have no paints.
    pub bar_paints: Vec<[Option<Paint>; 2]>,
    /// Width of all bars, in units of the designs.
    pub bar_width: f64,
    /// Holes that exist in only one design.
    pub holes: Vec<TransientHole>,
    /// Parts that exist in only one design and swell from thin lines. Until a part has its full
    /// thickness, it is drawn instead of its boundary loops.
    pub swelling_shapes: Vec<SwellingShape>,
    /// Parts that exist in only one design and grow from a seed shape. A part is not drawn while it
    /// is absent.
    pub seed_shapes: Vec<SeedShape>,
    /// Paint layers; `None` if everything has a single colour.
    pub paint_layers: Option<PaintLayerStack>,
    /// Clocks of parts with their own timing; `None` if all parts follow the t of the transition.
    pub part_clocks: Option<SolidClocks>,
}

/// Assigns a clock to each part of a solid. A clock converts the t of the transition to the part's
/// own t.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidClocks {
    /// All clocks. The last one belongs to the transition as a whole.
    pub clocks: Vec<PartClock>,
    /// For each boundary loop, the index in `clocks` of its part's clock.
    pub of_loops: Vec<usize>,
    /// For each hole, the index in `clocks` of its part's clock.
    pub of_holes: Vec<usize>,
    /// For each vertex, the index in `clocks` of its part's clock.
    pub of_vertices: Vec<usize>,
}

impl SolidClocks {
    /// Index in `clocks` of the clock of a vertex's part.
    fn of_vertex(&self, vertex: u32) -> usize {
        self.of_vertices[vertex as usize]
    }
}

/// Ring with its paint layer and the key of its group within that layer.
struct PaintedRing {
    layer: usize,
    key: InkKey,
    points: Vec<DVec2>,
}

/// Key of a group of rings: rings of a paint layer with equal keys have equal paints at every t.
/// The key consists of the index of the rings' clock and, if their parts fade, the only design that
/// has these parts.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct InkKey {
    clock: usize,
    fading: Option<Side>,
}

/// Group of bars with the same paints.
#[derive(Clone, Debug, PartialEq)]
pub struct InkedBars {
    /// Paints in source and target; `None` if the bars have no paint.
    pub paints: [Option<Paint>; 2],
    /// Indices of the bars in the group.
    pub bars: Vec<usize>,
}

impl InkedBars {
    /// Groups the bars `0..count` by their paints. The groups are in the order in which their
    /// paints first occur, which is the drawing order. Bars without an entry in `paints` have no
    /// paint.
    #[must_use]
    pub fn grouped_by_paint(count: usize, paints: &[[Option<Paint>; 2]]) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        // The hash map keeps the time linear: when colours show forces, there may be as many paints
        // as bars.
        let mut group_of_paints = HashMap::new();
        for bar in 0..count {
            let paints = paints.get(bar).copied().unwrap_or_default();
            let paint_bits = |paint: Paint| (paint.colour, paint.opacity.to_bits());
            let group = *group_of_paints
                .entry(paints.map(|end| end.map(paint_bits)))
                .or_insert_with(|| {
                    let bars = Vec::new();
                    groups.push(Self { paints, bars });
                    groups.len() - 1
                });
            groups[group].bars.push(bar);
        }
        groups
    }
}

/// Part that exists in only one design and grows from, or shrinks to, a seed shape (a tiny copy of
/// itself).
#[derive(Clone, Debug, PartialEq)]
pub struct SeedShape {
    /// Indices of the part's boundary loops.
    pub loop_indices: Vec<usize>,
    /// Time window in which the part's size changes.
    pub window: TimeWindow,
}

impl SolidContent {
    /// Returns the rings that are drawn at `t`: first the boundary loops, then the rings of
    /// swelling parts, then the holes. `places` contains the vertex positions at `t`.
    ///
    /// # Panics
    /// Panics if a loop uses a vertex that has no position.
    #[must_use]
    pub fn rings_at(&self, places: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let inked = self.painted_rings_at(places, t).into_iter();
        inked.map(|ring| ring.points).collect()
    }

    /// Returns the boundary loops of the parts that both designs have, for the vertex positions
    /// `places`.
    ///
    /// # Panics
    /// Panics if a loop uses a vertex that has no position.
    pub(crate) fn shared_loops_at(&self, places: &[DVec2]) -> Vec<Vec<DVec2>> {
        let seed_shapes = self
            .seed_shapes
            .iter()
            .flat_map(|shape| &shape.loop_indices);
        let swells = self
            .swelling_shapes
            .iter()
            .flat_map(SwellingShape::loop_indices);
        let transient: BTreeSet<usize> = seed_shapes.chain(swells).copied().collect();
        let shared = (0..self.loops.len()).filter(|loop_index| !transient.contains(loop_index));
        shared
            .map(|loop_index| self.loop_at(loop_index, places))
            .collect()
    }

    /// Returns the rings of [`Self::rings_at`], each with its paint layer and the key of its group.
    fn painted_rings_at(&self, places: &[DVec2], t: f64) -> Vec<PaintedRing> {
        let stack = self.paint_layers.as_ref();
        let fading = stack.filter(|all| all.fades_unmatched);
        let loop_ring = |loop_index: usize, points: Vec<DVec2>| PaintedRing {
            layer: stack.map_or(0, |all| all.of_loops[loop_index]),
            key: InkKey {
                clock: self
                    .part_clocks
                    .as_ref()
                    .map_or(0, |all| all.of_loops[loop_index]),
                fading: fading.and_then(|all| all.unmatched_loops[loop_index]),
            },
            points,
        };
        let loops = self
            .unchanged_loops(t)
            .map(|loop_index| loop_ring(loop_index, self.loop_at(loop_index, places)));
        let swells = self.swelling(t).flat_map(|swell| {
            let loop_index = swell.loop_indices().first().copied().unwrap_or_default();
            let rings = self.swollen_rings(swell, places, t).into_iter();
            rings.map(move |ring| loop_ring(loop_index, ring))
        });
        // A transient hole belongs to a part that exists in both designs. Such parts do not fade.
        let hole_ring = |(hole, points): (usize, Vec<DVec2>)| PaintedRing {
            layer: stack.map_or(0, |all| all.of_holes[hole]),
            key: InkKey {
                clock: self
                    .part_clocks
                    .as_ref()
                    .map_or(0, |all| all.of_holes[hole]),
                fading: None,
            },
            points,
        };
        let holes = self
            .holes
            .iter()
            .enumerate()
            .filter_map(|(k, hole)| Some((k, hole.ring_at(places, self.hole_time(k, t))?)));
        loops.chain(swells).chain(holes.map(hole_ring)).collect()
    }

    /// Converts the transition's `t` to the time of a part, by the part's clock. The part is that
    /// of the boundary loop with this index.
    fn loop_time(&self, loop_index: usize, t: f64) -> f64 {
        let clocks = self.part_clocks.as_ref();
        clocks.map_or(t, |clocks| {
            clocks.clocks[clocks.of_loops[loop_index]].part_time(t)
        })
    }

    /// Converts the transition's `t` to the time of the part that has the hole, by the part's
    /// clock.
    fn hole_time(&self, hole: usize, t: f64) -> f64 {
        let clocks = self.part_clocks.as_ref();
        clocks.map_or(t, |clocks| {
            clocks.clocks[clocks.of_holes[hole]].part_time(t)
        })
    }

    /// Converts the transition's `t` to the time of the part with the given boundary loops, by the
    /// part's clock.
    fn part_time(&self, loops: &[usize], t: f64) -> f64 {
        loops
            .first()
            .map_or(t, |&loop_index| self.loop_time(loop_index, t))
    }

    /// Returns the rings that are drawn at `t` as groups in drawing order, the lowest paint layer
    /// first. All rings of a group have the same paint at `t`. A layer has several groups if its
    /// parts differ in their clocks, or in whether they fade in or out, because their paints then
    /// differ. A solid in a single colour has one group. `places` contains the vertex positions at
    /// `t`.
    ///
    /// # Panics
    /// Panics if a loop uses a vertex that has no position.
    #[must_use]
    pub fn layers_at(&self, places: &[DVec2], t: f64) -> Vec<InkedLayer> {
        let Some(stack) = &self.paint_layers else {
            let rings = self.rings_at(places, t);
            return vec![InkedLayer {
                t,
                rings,
                ..InkedLayer::default()
            }];
        };
        let mut groups_by_layer =
            vec![BTreeMap::<InkKey, Vec<Vec<DVec2>>>::new(); stack.layers.len()];
        for ring in self.painted_rings_at(places, t) {
            let group = groups_by_layer[ring.layer].entry(ring.key).or_default();
            group.push(ring.points);
        }
        let layer_groups = |layer: usize| {
            let mut groups = std::mem::take(&mut groups_by_layer[layer]);
            if self.part_clocks.is_none() && !stack.fades_unmatched {
                // Without clocks and fading, callers expect exactly one group for each layer, even
                // an empty one.
                groups.entry(InkKey::default()).or_default();
            }
            groups.into_iter().map(move |(key, rings)| {
                let clocks = self.part_clocks.as_ref();
                let is_on_clock = |v: u32| clocks.is_none_or(|all| all.of_vertex(v) == key.clock);
                let gradients = stack.layers[layer]
                    .shading
                    .gradients_at(places, is_on_clock);
                let t = clocks.map_or(t, |all| all.clocks[key.clock].part_time(t));
                let inked = InkedLayer {
                    layer,
                    t,
                    rings,
                    ..InkedLayer::default()
                };
                stack.layers[layer].ink(inked, gradients, key.fading)
            })
        };
        stack
            .draw_order(t)
            .into_iter()
            .flat_map(layer_groups)
            .collect()
    }

    /// Returns the crossings between rings of the same paint layer; the indices of rings are those
    /// in [`Self::rings_at`]. Rings of different layers may overlap.
    ///
    /// # Panics
    /// Panics if a loop uses a vertex that has no position.
    #[must_use]
    pub fn crossings_at(&self, places: &[DVec2], t: f64) -> Vec<EdgeCrossing> {
        let Some(stack) = &self.paint_layers else {
            return crossings(&self.rings_at(places, t));
        };
        let rings = self.painted_rings_at(places, t);
        let layer_crossings = |layer: usize| {
            let is_in_layer = |k: &usize| rings[*k].layer == layer;
            let members: Vec<usize> = (0..rings.len()).filter(is_in_layer).collect();
            let member_rings: Vec<Vec<DVec2>> =
                members.iter().map(|&k| rings[k].points.clone()).collect();
            let mut crossings_in_layer = crossings(&member_rings);
            for edge in crossings_in_layer
                .iter_mut()
                .flat_map(|crossing| &mut crossing.edges)
            {
                edge.ring = members[edge.ring];
            }
            crossings_in_layer
        };
        (0..stack.layers.len()).flat_map(layer_crossings).collect()
    }

    /// Counts the crossings between rings of the same paint layer at `t`.
    ///
    /// # Panics
    /// Panics if a loop uses a vertex that has no position.
    #[must_use]
    pub fn count_crossings(&self, places: &[DVec2], t: f64) -> usize {
        let mut rings_by_layer =
            vec![Vec::new(); self.paint_layers.as_ref().map_or(1, |all| all.layers.len())];
        for ring in self.painted_rings_at(places, t) {
            rings_by_layer[ring.layer].push(ring.points);
        }
        rings_by_layer
            .iter()
            .map(|rings| count_crossings(rings))
            .sum()
    }

    /// Positions of a boundary loop's vertices.
    fn loop_at(&self, loop_index: usize, places: &[DVec2]) -> Vec<DVec2> {
        self.loops[loop_index]
            .iter()
            .map(|&v| places[v as usize])
            .collect()
    }

    /// Indices of the boundary loops that are drawn at `t` as they are: neither absent nor replaced
    /// by a swelling part.
    fn unchanged_loops(&self, t: f64) -> impl Iterator<Item = usize> {
        let swelling = self.swelling(t).flat_map(SwellingShape::loop_indices);
        let absent = self
            .seed_shapes
            .iter()
            .filter(move |shape| self.is_absent(shape, t));
        let replaced: BTreeSet<usize> = absent
            .flat_map(|shape| &shape.loop_indices)
            .chain(swelling)
            .copied()
            .collect();
        (0..self.loops.len()).filter(move |loop_index| !replaced.contains(loop_index))
    }

    /// Swelling parts that have not reached their full thickness at `t`.
    fn swelling(&self, t: f64) -> impl Iterator<Item = &SwellingShape> {
        let swells = self.swelling_shapes.iter();
        swells.filter(move |swell| {
            swell.thickness_fraction(self.part_time(swell.loop_indices(), t)) < 1.0
        })
    }

    /// Returns whether a part that grows from a seed shape is absent at `t`.
    fn is_absent(&self, shape: &SeedShape, t: f64) -> bool {
        shape
            .window
            .is_absent(self.part_time(&shape.loop_indices, t))
    }

    /// Rings of a swelling part at `t`; empty while the part is absent.
    fn swollen_rings(&self, swell: &SwellingShape, places: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let first = swell.loop_indices().first();
        let first = first.map(|&loop_index| self.loop_at(loop_index, places));
        swell.rings_at(
            &first.unwrap_or_default(),
            self.part_time(swell.loop_indices(), t),
        )
    }

    /// Returns the vertices with which an edge of [`Self::rings_at`] moves: for an edge of a
    /// boundary loop its two ends, for an edge of a hole the corners of the face on which the
    /// edge's first point lies. `None` if the edge has no such vertices.
    ///
    /// An edge of a swelling part lies in no face. The vertices of the first edge of the part's
    /// outer boundary loop are returned instead.
    pub(crate) fn face_vertices_at(
        &self,
        edge: RingEdge,
        places: &[DVec2],
        t: f64,
    ) -> Option<Vec<u32>> {
        let RingEdge { ring, point } = edge;
        let ends = |loop_index: usize, point: usize| {
            let vertices = &self.loops[loop_index];
            vec![vertices[point], vertices[(point + 1) % vertices.len()]]
        };
        let loops: Vec<usize> = self.unchanged_loops(t).collect();
        if let Some(&loop_index) = loops.get(ring) {
            return Some(ends(loop_index, point));
        }
        let mut ring = ring - loops.len();
        for swell in self.swelling(t) {
            let rings = self.swollen_rings(swell, places, t).len();
            if ring < rings {
                return swell
                    .loop_indices()
                    .first()
                    .map(|&loop_index| ends(loop_index, 0));
            }
            ring -= rings;
        }
        let mut holes = self.holes_at(t).filter(|(_, is_absent)| !is_absent);
        Some(holes.nth(ring)?.0.host_face(point).to_vec())
    }

    /// Returns the number of rings that are absent at `t`: boundary loops of parts that exist in
    /// only one design, and holes that exist in only one design.
    pub(crate) fn absent_ring_count(&self, t: f64) -> usize {
        let thickness = |swell: &SwellingShape| {
            swell.thickness_fraction(self.part_time(swell.loop_indices(), t))
        };
        let swells = self
            .swelling_shapes
            .iter()
            .filter(|swell| thickness(swell) <= 0.0);
        let seed_shapes = self
            .seed_shapes
            .iter()
            .filter(|shape| self.is_absent(shape, t));
        let transient_loops: usize = swells
            .map(|swell| swell.loop_indices().len())
            .chain(seed_shapes.map(|shape| shape.loop_indices.len()))
            .sum();
        self.holes_at(t).filter(|(_, is_absent)| *is_absent).count() + transient_loops
    }

    /// All holes, each with whether it is absent at `t`.
    fn holes_at(&self, t: f64) -> impl Iterator<Item = (&TransientHole, bool)> {
        let holes = self.holes.iter().enumerate();
        holes.map(move |(k, hole)| (hole, hole.is_absent(self.hole_time(k, t))))
    }

    /// Returns the two end points of every bar, for the vertex positions `places`.
    ///
    /// # Panics
    /// Panics if a bar ends at a vertex that has no position.
    #[must_use]
    pub fn bars_at(&self, places: &[DVec2]) -> Vec<[DVec2; 2]> {
        let ends = |bar: &[u32; 2]| bar.map(|v| places[v as usize]);
        self.bars.iter().map(ends).collect()
    }
}
