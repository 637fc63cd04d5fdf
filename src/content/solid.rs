//! Solid regions and bars that are carried by the vertices of a placement.

use super::Hole;
use crate::geometry::{DVec2, RingEdge};

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
}

impl Solid {
    /// The boundary walks at `t`, when the vertices are at these places; then
    /// the holes that are there.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn rings_at(&self, places: &[DVec2], t: f64) -> Vec<Vec<DVec2>> {
        let at = |walk: &Vec<u32>| walk.iter().map(|&v| places[v as usize]).collect();
        let holes = self.holes.iter().filter_map(|hole| hole.at(places, t));
        self.loops.iter().map(at).chain(holes).collect()
    }

    /// The corners of the face at an edge of [`Self::rings_at`], of a boundary
    /// walk its two ends.
    pub(crate) fn corners_at(&self, edge: RingEdge, t: f64) -> Option<Vec<u32>> {
        let RingEdge { ring, point } = edge;
        if let Some(walk) = self.loops.get(ring) {
            return Some(vec![walk[point], walk[(point + 1) % walk.len()]]);
        }
        let mut holes = self.holes.iter().filter(|hole| !hole.is_gone(t));
        let hole = holes.nth(ring - self.loops.len())?;
        Some(hole.face(point).to_vec())
    }

    /// How many of the holes that come and go are not there at `t`: points, to
    /// what counts rings.
    pub(crate) fn gone_at(&self, t: f64) -> usize {
        self.holes.iter().filter(|hole| hole.is_gone(t)).count()
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
