//! Boundary loops to be examined for meetings.

/// A closed boundary loop of a drawn shape.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLoop {
    /// Vertex indices in order along the loop.
    pub vertices: Vec<u32>,
    /// Paint layer; loops on different layers may cross.
    pub layer: usize,
    /// First and last t at which the loop is drawn.
    pub visible_interval: [f64; 2],
}
