//! Measures of a design space: blends of each pair of designs (an edge of the space), the blend of
//! all designs with equal weights (its centre), and blends spread over the whole space.

use super::blend_report::{BlendReport, BlendSampler};
use crate::space::{DesignSpace, weight_sample};
use crate::work::progress::{Cancelled, Progress, checkpoint};
use serde::Serialize;

/// Number of evenly spaced blends that are measured between each pair of designs (heuristic).
const BLENDS_PER_EDGE: usize = 9;

/// Measures of a design space.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpaceReport {
    /// Names of the designs.
    pub designs: Vec<String>,
    /// Number of vertices of the common mesh; `None` without one.
    pub vertices: Option<usize>,
    /// Number of faces of the common mesh; `None` without one.
    pub faces: Option<usize>,
    /// Notes of the space, each as a sentence.
    pub notes: Vec<String>,
    /// Measures of the blends of each pair of designs, one report per pair.
    pub edges: Vec<EdgeReport>,
    /// Measures of the blend of all designs with equal weights.
    pub middle: BlendReport,
    /// Summary of the measures of blends spread over the whole space.
    pub all_over: BlendStatistics,
}

/// Measures of the blends between two designs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EdgeReport {
    /// Indices of the two designs, from 0.
    pub designs: [usize; 2],
    /// Dissimilarity of the two designs; see [`DesignDistances`](crate::space::DesignDistances).
    pub unlike: f64,
    /// Worst value of each measure over nine evenly spaced blends of the two designs.
    pub worst: BlendReport,
}

/// Summary of blends spread over a whole space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlendStatistics {
    /// Number of blends measured.
    pub blends: usize,
    /// Number of blends with folds.
    pub folded: usize,
    /// Number of blends whose outlines cross.
    pub crossed: usize,
    /// Worst value of each measure over all blends.
    pub worst: BlendReport,
}

/// Measures blends of each pair of designs, the blend of all with equal weights, and `blends`
/// blends spread over the whole space.
///
/// The weights of the blends spread over the space are deterministic: they depend only on the
/// number of designs.
///
/// # Errors
/// [`Cancelled`] if the work was cancelled.
pub fn space_report(
    space: &DesignSpace,
    blends: usize,
    progress: &dyn Progress,
) -> Result<SpaceReport, Cancelled> {
    let count = space.designs().len();
    let mut sampler = BlendSampler::of(space);
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
    let pairs: Vec<[usize; 2]> = pairs.collect();
    let total = (pairs.len() * BLENDS_PER_EDGE + blends) as f64;
    let mut edges = Vec::new();
    for [a, b] in pairs {
        checkpoint(
            progress,
            "measuring",
            (edges.len() * BLENDS_PER_EDGE) as f64 / total,
        )?;
        let mut worst = BlendReport::default();
        for k in 1..=BLENDS_PER_EDGE {
            let t = k as f64 / (BLENDS_PER_EDGE + 1) as f64;
            let mut weights = vec![0.0; count];
            (weights[a], weights[b]) = (1.0 - t, t);
            worst = worst.worse_of_both(sampler.measure(&weights).quality);
        }
        edges.push(EdgeReport {
            designs: [a, b],
            unlike: space.distances().between(a, b),
            worst,
        });
    }
    let middle = sampler.measure(&vec![1.0 / count as f64; count]).quality;
    let mut all_over = BlendStatistics {
        blends,
        folded: 0,
        crossed: 0,
        worst: BlendReport::default(),
    };
    for k in 0..blends {
        let done = edges.len() * BLENDS_PER_EDGE + k;
        checkpoint(progress, "measuring", done as f64 / total)?;
        let quality = sampler.measure(&weight_sample(k, count)).quality;
        all_over.folded += usize::from(quality.folds > 0);
        all_over.crossed += usize::from(quality.crossings > 0);
        all_over.worst = all_over.worst.worse_of_both(quality);
    }
    let family = space.family();
    Ok(SpaceReport {
        designs: space.designs().iter().map(|d| d.name.clone()).collect(),
        vertices: family.map(|family| family.embeddings()[0].len()),
        faces: family.map(|family| family.faces().len()),
        notes: space.notes().iter().map(ToString::to_string).collect(),
        edges,
        middle,
        all_over,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Design;
    use crate::space::SpaceSpec;
    use crate::work::progress::Silent;
    use std::sync::Arc;

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn rectangles_have_no_defects() {
        let rectangle = |w: f64, h: f64| {
            let ring = [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]];
            Arc::new(Design::from_rings("rectangle", [ring]).expect("a design"))
        };
        let designs = vec![
            rectangle(1.0, 1.0),
            rectangle(3.0, 1.0),
            rectangle(1.0, 2.0),
        ];
        let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let report = space_report(&space, 20, &Silent).expect("measured");
        assert_eq!((report.edges.len(), report.all_over.folded), (3, 0));
        let worst = report.all_over.worst;
        assert_eq!((worst.folds, worst.crossings), (0, 0));
        assert!(worst.area_off < 0.5 && worst.conformal_p95.expect("a mesh") < 3.0);
    }
}
