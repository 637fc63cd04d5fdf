//! What is too much to begin without being asked twice.
//!
//! Work that takes longer than ten seconds, or more than two gibibytes, says so
//! before it begins, and goes on only for who is patient
//! ([`Progress::is_patient`]). All limits stand here, each with the measurement
//! that set it: on two cores that others used too, as well optimised as a
//! release but for its dependencies.

use crate::work::progress::Progress;

/// What there can be too much of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WorkloadKind {
    /// Points of both designs' outlines that are to be matched and
    /// triangulated.
    Points,
    /// Pieces of both designs that are to be matched and triangulated.
    Pieces,
    /// Holes of both designs that are to be matched and triangulated.
    Holes,
    /// Bars of a truss whose outline is wanted.
    Bars,
    /// Pairs of bars that cross without a node.
    CrossingBars,
    /// Cells of a grid of distances.
    Cells,
    /// Faces of a mesh that is to move.
    Faces,
    /// Pixels of all the pictures that are mixed.
    Pixels,
}

impl WorkloadKind {
    /// The most that is begun without being asked twice.
    #[must_use]
    pub const fn most(self) -> usize {
        match self {
            // A coastline of 2,000 points against a square took 2.5 s, one of
            // 5,000 took 4.0 s (`check coast.json square.json`).
            Self::Points => 12_000,
            // 300 pieces against 300 others are first seen after 2.9 s, 600
            // against 600 after 4.9 s, 2,000 against 2,000 after 23 s.
            Self::Pieces => 1_500,
            // 100 holes against 100 others are first seen after 1.3 s, 200 against
            // 200 after 7.8 s.
            Self::Holes => 300,
            // 20,000 bars that all overlap 240 others were not done after 15 s.
            Self::Bars => 5_000,
            // 200 nodes, each joined to each other, have 60 million, in two
            // gigabytes; 4 million are counted in a second.
            Self::CrossingBars => 4_000_000,
            // 8192 × 8192 cells took more than 40 s: a seventh of that.
            Self::Cells => 3072 * 3072,
            // Two sheets of two million took 1.8 GiB and 4 s of one processor, and
            // each frame until their film is there 0.3 s.
            Self::Faces => 2_200_000,
            // Decoded, as they are mixed, one takes 26 bytes: two gibibytes.
            Self::Pixels => 82_000_000,
        }
    }

    const fn words(self) -> &'static str {
        match self {
            Self::Points => "points of outlines",
            Self::Pieces => "outlines",
            Self::Holes => "holes",
            Self::Bars => "bars",
            Self::CrossingBars => "crossings of bars without a node",
            Self::Cells => "cells",
            Self::Faces => "faces",
            Self::Pixels => "pixels of pictures",
        }
    }

    const fn way_out(self) -> &'static str {
        match self {
            Self::Points => "simplify the outlines, or blend distance fields",
            Self::Pieces => "leave small parts out, or blend distance fields",
            Self::Holes => "leave small holes out, or blend distance fields",
            Self::Bars => "leave bars out",
            Self::CrossingBars => "put nodes where bars cross, or leave bars out",
            Self::Cells => "choose fewer cells",
            Self::Faces => "subdivide less, or use a coarser mesh",
            Self::Pixels => "use smaller pictures, or fewer",
        }
    }

    /// Whether so many may be begun.
    ///
    /// # Errors
    /// [`WorkloadTooLarge`] if there are more than the limit, unless who asked is
    /// patient.
    ///
    /// ```
    /// use morphospace::work::budget::Load;
    /// use morphospace::work::progress::Silent;
    /// // Nobody waits who listens to nothing.
    /// assert!(Load::Bars.allow(1_000_000, &Silent).is_ok());
    /// ```
    pub fn allow(self, count: usize, progress: &dyn Progress) -> Result<(), WorkloadTooLarge> {
        if count > self.most() && !progress.is_patient() {
            return Err(WorkloadTooLarge { load: self, count });
        }
        Ok(())
    }
}

/// More than is begun without being asked twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{count} {} take longer than ten seconds, or more than two gibibytes; up to {} do not: {}",
    .load.words(), .load.most(), .load.way_out()
)]
pub struct WorkloadTooLarge {
    /// What there is too much of.
    pub load: WorkloadKind,
    /// How much there is, or how much was counted before it was given up.
    pub count: usize,
}
