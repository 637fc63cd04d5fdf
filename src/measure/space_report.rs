//! Quality of a space of many designs: of its edges, its middle, and of blends all over it.

use super::blend_report::{BlendReport, BlendSampler};
use crate::space::{DesignSpace, spread};
use crate::work::progress::{Cancelled, Progress, checkpoint};
use serde::Serialize;

/// Blends along an edge that are looked at.
const ON_EDGE: usize = 9;

/// A space, measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpaceReport {
    /// The names of the designs.
    pub designs: Vec<String>,
    /// Vertices of the common mesh; none of fields.
    pub vertices: Option<usize>,
    /// Faces of the common mesh; none of fields.
    pub faces: Option<usize>,
    /// What was done otherwise than asked.
    pub notes: Vec<String>,
    /// Between each two designs the worst of nine blends.
    pub edges: Vec<EdgeReport>,
    /// All designs in equal parts.
    pub middle: BlendReport,
    /// Blends all over the space.
    pub all_over: BlendStatistics,
}

/// Between two designs, the worst of some blends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EdgeReport {
    /// The two designs, counted from 0.
    pub designs: [usize; 2],
    /// How unlike they are.
    pub unlike: f64,
    /// The worst, measure by measure.
    pub worst: BlendReport,
}

/// Blends all over a space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlendStatistics {
    /// How many blends were looked at.
    pub blends: usize,
    /// How many of them fold.
    pub folded: usize,
    /// How many of them cross themselves.
    pub crossed: usize,
    /// The worst, measure by measure.
    pub worst: BlendReport,
}

/// Measures a space at so many weights besides its edges and its middle: the same for the
/// same number of designs.
///
/// # Errors
/// [`Cancelled`] if nobody wants the result any more.
pub fn space(
    space: &DesignSpace,
    blends: usize,
    progress: &dyn Progress,
) -> Result<SpaceReport, Cancelled> {
    let count = space.designs().len();
    let mut sampler = BlendSampler::of(space);
    let two = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
    let two: Vec<[usize; 2]> = two.collect();
    let whole = (two.len() * ON_EDGE + blends) as f64;
    let mut edges = Vec::new();
    for [a, b] in two {
        checkpoint(
            progress,
            "measuring",
            (edges.len() * ON_EDGE) as f64 / whole,
        )?;
        let mut worst = BlendReport::default();
        for k in 1..=ON_EDGE {
            let t = k as f64 / (ON_EDGE + 1) as f64;
            let mut weights = vec![0.0; count];
            (weights[a], weights[b]) = (1.0 - t, t);
            worst = worst.or_worse(sampler.at(&weights).quality);
        }
        edges.push(EdgeReport {
            designs: [a, b],
            unlike: space.likeness().between(a, b),
            worst,
        });
    }
    let middle = sampler.at(&vec![1.0 / count as f64; count]).quality;
    let mut all_over = BlendStatistics {
        blends,
        folded: 0,
        crossed: 0,
        worst: BlendReport::default(),
    };
    for k in 0..blends {
        let done = edges.len() * ON_EDGE + k;
        checkpoint(progress, "measuring", done as f64 / whole)?;
        let found = sampler.at(&spread(k, count)).quality;
        all_over.folded += usize::from(found.folds > 0);
        all_over.crossed += usize::from(found.crossings > 0);
        all_over.worst = all_over.worst.or_worse(found);
    }
    let family = space.family();
    Ok(SpaceReport {
        designs: space.designs().iter().map(|d| d.name.clone()).collect(),
        vertices: family.map(|family| family.places()[0].len()),
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
    fn rectangles_are_no_trouble() {
        let rectangle = |w: f64, h: f64| {
            let ring = [[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]];
            Arc::new(Design::of_rings("rectangle", [ring]).expect("a design"))
        };
        let designs = vec![
            rectangle(1.0, 1.0),
            rectangle(3.0, 1.0),
            rectangle(1.0, 2.0),
        ];
        let made = DesignSpace::build(&SpaceSpec::new(designs), &Silent).expect("a space");
        let report = space(&made, 20, &Silent).expect("measured");
        assert_eq!((report.edges.len(), report.all_over.folded), (3, 0));
        let worst = report.all_over.worst;
        assert_eq!((worst.folds, worst.crossings), (0, 0));
        assert!(worst.area_off < 0.5 && worst.conformal_p95.expect("a mesh") < 3.0);
    }
}
