//! Tolerance and memory limit of a recording.

/// Options of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordingOptions {
    /// Maximum distance between a vertex in the recording and the same vertex in the warp, as a
    /// fraction of the diameter of the bounding box of all moving vertices at t = 0 and t = 1.
    pub tolerance: f64,
    /// Maximum size of the recording in bytes (resource limit). The memory that is used while an
    /// interval is recorded counts too.
    pub max_bytes: usize,
}

impl Default for RecordingOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            max_bytes: 512 << 20,
        }
    }
}
