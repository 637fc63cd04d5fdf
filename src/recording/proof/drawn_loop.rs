//! What is drawn.

/// A closed boundary of what is drawn, as vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnLoop {
    /// The vertices, one after the other.
    pub vertices: Vec<u32>,
    /// Walks on different levels may pass over each other.
    pub level: usize,
    /// It is drawn from and until then.
    pub drawn: [f64; 2],
}
