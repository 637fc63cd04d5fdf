//! When the connected parts of a film are.

use std::ops::Range;

/// The time of everything.
#[derive(Clone, Copy, Debug)]
pub(super) enum EvaluationTimes<'a> {
    /// One for all.
    Even(f64),
    /// One for each connected part.
    OfParts {
        parts: &'a [f64],
        /// The same for each vertex.
        vertices: &'a [f64],
    },
}

impl EvaluationTimes<'_> {
    /// The time of a connected part.
    pub(super) fn of_part(self, part: usize) -> f64 {
        match self {
            Self::Even(t) => t,
            Self::OfParts { parts, .. } => parts[part],
        }
    }

    /// The time of a vertex.
    pub(super) fn of_vertex(self, vertex: usize) -> f64 {
        match self {
            Self::Even(t) => t,
            Self::OfParts { vertices, .. } => vertices[vertex],
        }
    }
}

/// Times that say themselves for each part.
#[derive(Clone, Debug, Default)]
pub(super) struct PartTimeBuffer {
    parts: Vec<f64>,
    vertices: Vec<f64>,
}

impl PartTimeBuffer {
    /// Those of so many parts, whose vertices are in these ranges.
    pub(super) fn set(
        &mut self,
        count: usize,
        time: impl Fn(usize) -> f64,
        runs: impl Iterator<Item = (Range<usize>, usize)>,
    ) -> EvaluationTimes<'_> {
        self.parts.clear();
        self.parts.extend((0..count).map(time));
        for (run, part) in runs {
            self.vertices.resize(self.vertices.len().max(run.end), 0.0);
            self.vertices[run].fill(self.parts[part]);
        }
        EvaluationTimes::OfParts {
            parts: &self.parts,
            vertices: &self.vertices,
        }
    }
}
