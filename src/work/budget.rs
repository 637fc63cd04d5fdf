//! Size limits above which a job needs confirmation before it starts.
//!
//! A job expected to take more than 10 seconds or 2 GiB fails with [`WorkloadTooLarge`] before it
//! starts, unless [`Progress::is_patient`]. All limits are listed here, each with the measurement
//! behind it, taken on two shared cores in a build whose dependencies were less optimised than in
//! a release.

use crate::work::progress::Progress;

/// Kind of input whose amount determines how long a job takes or how much memory it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WorkloadKind {
    /// Outline points of both designs together; they are matched and triangulated.
    Points,
    /// Outer outlines of both designs together; they are matched and triangulated.
    Pieces,
    /// Holes of both designs together; they are matched and triangulated.
    Holes,
    /// Outlines of a design space; each pair of them is matched.
    Designs,
    /// Bars of a truss whose outline is computed.
    Bars,
    /// Pairs of bars that cross without a node at the crossing, in a truss that is triangulated.
    CrossingBars,
    /// Grid cells of distance fields.
    Cells,
    /// Faces of a mesh whose motion is solved.
    Faces,
    /// Pixels of all blended pictures together.
    Pixels,
}

impl WorkloadKind {
    /// Returns the largest amount of this input with which a job starts without confirmation.
    #[must_use]
    pub const fn limit(self) -> usize {
        match self {
            // Matching a coastline with a square takes 2.5 s with 2,000 points and 4.0 s with 5,000
            // (`check coast.json square.json`).
            Self::Points => 12_000,
            // A draft transition takes 2.9 s with 300 outer outlines per design, 4.9 s with 600, 23
            // s with 2,000.
            Self::Pieces => 1_500,
            // A draft transition takes 1.3 s with 100 holes per design and 7.8 s with 200.
            Self::Holes => 300,
            // A draft map of 50 designs with 120 points each takes 14 s of processor time, one of 80
            // designs with 60 points 22 s.
            Self::Designs => 50,
            // 20,000 bars that each overlap 240 others take more than 15 s.
            Self::Bars => 5_000,
            // 200 nodes that are all joined to each other have 60 million crossings, which take 2
            // GB. Finding 4 million takes one second.
            Self::CrossingBars => 4_000_000,
            // 8192 × 8192 cells take more than 40 s; the limit is a seventh of them.
            Self::Cells => 3072 * 3072,
            // A transition between two sheets, on a mesh of two million faces, takes 1.8 GiB and
            // 4 s on one core. Until its motion is recorded, each frame takes 0.3 s.
            Self::Faces => 2_200_000,
            // A pixel prepared for blending takes 26 bytes; this many take 2 GiB.
            Self::Pixels => 82_000_000,
        }
    }

    /// Returns the plural noun for this input, for messages.
    const fn noun(self) -> &'static str {
        match self {
            Self::Points => "outline points",
            Self::Pieces => "parts",
            Self::Holes => "holes",
            Self::Designs => "designs on a map",
            Self::Bars => "bars",
            Self::CrossingBars => "bar crossings without a node",
            Self::Cells => "grid cells",
            Self::Faces => "triangles",
            Self::Pixels => "picture pixels",
        }
    }

    /// Returns what a user can do to reduce the amount.
    const fn remedy(self) -> &'static str {
        match self {
            Self::Points => "simplify the outlines, or blend distance fields",
            Self::Pieces => "remove small parts, or blend distance fields",
            Self::Holes => "remove small holes, or blend distance fields",
            Self::Designs => "use fewer designs, or blend distance fields",
            Self::Bars => "remove bars",
            Self::CrossingBars => "add nodes where bars cross, or remove bars",
            Self::Cells => "choose fewer cells",
            Self::Faces => "subdivide less, or use a coarser mesh",
            Self::Pixels => "use fewer or smaller pictures",
        }
    }

    /// Checks whether a job with `count` of this input may start.
    ///
    /// # Errors
    /// [`WorkloadTooLarge`] if the amount exceeds the limit, unless [`Progress::is_patient`].
    ///
    /// ```
    /// use morphospace::work::budget::WorkloadKind;
    /// use morphospace::work::progress::Silent;
    /// // Without a waiting user there is no limit.
    /// assert!(WorkloadKind::Bars.check(1_000_000, &Silent).is_ok());
    /// ```
    pub fn check(self, count: usize, progress: &dyn Progress) -> Result<(), WorkloadTooLarge> {
        if count > self.limit() && !progress.is_patient() {
            return Err(WorkloadTooLarge { kind: self, count });
        }
        Ok(())
    }
}

/// A job that is too large to start without confirmation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{count} {} may take more than 10 seconds or 2 GiB (the limit is {}); {}",
    .kind.noun(), .kind.limit(), .kind.remedy()
)]
pub struct WorkloadTooLarge {
    /// Kind of input that exceeds its limit.
    pub kind: WorkloadKind,
    /// Amount of that input; a lower bound if counting stopped early.
    pub count: usize,
}
