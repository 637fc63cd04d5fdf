//! Boundary loop that is examined for meetings with other boundary loops.

/// Closed boundary loop of a shape that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLoop {
    /// Vertex indices in order along the loop.
    pub vertices: Vec<u32>,
    /// Index of the loop's paint layer; loops of different layers may cross.
    pub layer: usize,
    /// First and last t at which the loop is drawn.
    pub visible_interval: [f64; 2],
}
