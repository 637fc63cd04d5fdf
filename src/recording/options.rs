//! The tolerance and the memory limit of a recording.

/// Options of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordingOptions {
    /// Largest distance between a vertex of the recording and of the warp, as a fraction of the
    /// diameter of all positions at both ends.
    pub tolerance: f64,
    /// Largest size of the coefficients in bytes (resource limit); also limits the memory for the
    /// interval that is being recorded.
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
