//! A film between two polygons, and what no film may do.

use super::Rings;
use morphospace::geometry::orient2d;
use morphospace::measure::film;
use morphospace::work::progress::Silent;
use morphospace::{Design, Transition};

/// What a valid film may still do, to be counted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// Faces that fold at the worst of the samples.
    pub folds: usize,
    /// Crossings of the boundary at the worst of the samples.
    pub crossings: usize,
}

/// How many frames are looked at.
const SAMPLES: usize = 17;

/// How far the area of an end may be off, as a fraction: holes that close
/// keep a ring too small to see.
const END: f64 = 1e-4;

/// Builds the film of rigid parts and looks at it. Rings that enclose nothing
/// are no designs; that is told by the library and nothing is seen.
///
/// # Errors
/// In words: no film although both designs are valid, a face that is not
/// positive at an end, a point that is not finite, an end that is not the
/// design.
pub fn seen(source: Rings, target: Rings) -> Result<Seen, String> {
    let source = Design::of_rings("source", source);
    let target = Design::of_rings("target", target);
    let (Ok(source), Ok(target)) = (source, target) else {
        return Ok(Seen::default());
    };
    let areas = [&source, &target].map(|d| d.outline(0.0).map_or(0.0, |o| o.area()));
    let transition = Transition::between(source, target).map_err(|e| e.to_string())?;
    positive(&transition)?;
    finite(&transition)?;
    let report = film(&transition, SAMPLES, &Silent).map_err(|e| e.to_string())?;
    for (i, area) in [(0, areas[0]), (SAMPLES - 1, areas[1])] {
        let off = (report.samples[i].area / area - 1.0).abs();
        // Not a number is no small one.
        if off.is_nan() || off > END {
            return Err(format!("frame {i}: the area is off by {off}"));
        }
    }
    Ok(Seen {
        folds: report.worst_folds.unwrap_or(0),
        crossings: report.worst_crossings.unwrap_or(0),
    })
}

fn positive(transition: &Transition) -> Result<(), String> {
    let mesh = transition.compatible().ok_or("no mesh")?;
    for points in [mesh.source(), mesh.target()] {
        let is_positive = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| points[v as usize]);
            orient2d(a, b, c) > 0.0
        };
        if !mesh.faces().iter().all(is_positive) {
            return Err("a face is not positive".to_owned());
        }
    }
    Ok(())
}

fn finite(transition: &Transition) -> Result<(), String> {
    let mut frame = transition.frame(0.0);
    for i in 0..SAMPLES {
        frame.seek(i as f64 / (SAMPLES - 1) as f64);
        if !frame.placement().in_frame.iter().all(|p| p.is_finite()) {
            return Err(format!("frame {i}: a point that is not finite"));
        }
    }
    Ok(())
}
