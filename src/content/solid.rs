//! Solid regions and bars that are carried by the vertices of a placement.

use crate::geometry::DVec2;

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
}

impl Solid {
    /// The boundary walks at the given vertex places.
    ///
    /// # Panics
    /// Where a walk goes by a vertex that has no place.
    #[must_use]
    pub fn rings_at(&self, places: &[DVec2]) -> Vec<Vec<DVec2>> {
        let at = |walk: &Vec<u32>| walk.iter().map(|&v| places[v as usize]).collect();
        self.loops.iter().map(at).collect()
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
