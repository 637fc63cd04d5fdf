//! How closely a warp is recorded, and in how much memory.

/// How a film is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordingOptions {
    /// How far a vertex may be from where the warp has it, as a share of the
    /// diameter of all its places at the ends.
    pub tolerance: f64,
    /// How much memory the film may take, and what of it is recorded at a time, in bytes.
    pub most_bytes: usize,
}

impl Default for RecordingOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            most_bytes: 512 << 20,
        }
    }
}
