//! Times at which the connected parts are evaluated.

use std::ops::Range;

/// Evaluation times of all parts and vertices at one transition time t.
#[derive(Clone, Copy, Debug)]
pub(super) enum EvaluationTimes<'a> {
    /// One time for all parts.
    Uniform(f64),
    /// A separate time for each connected part.
    PerPart {
        /// Time of each part.
        parts: &'a [f64],
        /// For each vertex, the time of its part.
        vertices: &'a [f64],
    },
}

impl EvaluationTimes<'_> {
    /// Returns the time at which a connected part is evaluated.
    pub(super) fn of_part(self, part: usize) -> f64 {
        match self {
            Self::Uniform(t) => t,
            Self::PerPart { parts, .. } => parts[part],
        }
    }

    /// Returns the time at which a vertex is evaluated.
    pub(super) fn of_vertex(self, vertex: usize) -> f64 {
        match self {
            Self::Uniform(t) => t,
            Self::PerPart { vertices, .. } => vertices[vertex],
        }
    }
}

/// Reusable memory for [`EvaluationTimes::PerPart`].
#[derive(Clone, Debug, Default)]
pub(super) struct PartTimeBuffer {
    parts: Vec<f64>,
    vertices: Vec<f64>,
}

impl PartTimeBuffer {
    /// Stores a separate time for each of `count` parts and returns these times.
    ///
    /// `time` returns the time of a part. `runs` yields ranges of vertices, each with its part;
    /// together they cover every vertex.
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
        EvaluationTimes::PerPart {
            parts: &self.parts,
            vertices: &self.vertices,
        }
    }
}
