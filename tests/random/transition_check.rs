//! Checks the transition between two polygons. Its faces must be positive in both designs, its
//! vertices finite, and its areas at t = 0 and t = 1 those of the designs. Folds and crossings in
//! between are allowed, and are counted.

use super::Rings;
use morphospace::geometry::orient2d;
use morphospace::measure::film_report;
use morphospace::work::progress::Silent;
use morphospace::{Design, Transition};

/// Counts of defects that a valid transition may have.
#[derive(Clone, Copy, Debug, Default)]
pub struct FilmDefects {
    /// Number of folded faces in the sampled frame that has most of them.
    pub folds: usize,
    /// Number of boundary crossings in the sampled frame that has most of them.
    pub crossings: usize,
}

/// Number of frames, evenly spaced from t = 0 to t = 1, that are checked.
const SAMPLES: usize = 17;

/// Maximum relative deviation of the area at t = 0 or t = 1 from the area of the design (tolerance:
/// a closed hole leaves a tiny ring).
const END_TOLERANCE: f64 = 1e-4;

/// Builds the transition by rigid parts from `source` to `target` and checks it; returns its
/// defects.
///
/// If one of the designs is invalid, for example because its rings have no area, nothing is checked
/// and the result has no defects.
///
/// # Errors
/// A description, if the transition between two valid designs cannot be built, a face is not
/// positively oriented in both designs, a vertex is not finite, or the area at t = 0 or 1 is not
/// that of the design.
pub fn check_transition(source: Rings, target: Rings) -> Result<FilmDefects, String> {
    let source = Design::from_rings("source", source);
    let target = Design::from_rings("target", target);
    let (Ok(source), Ok(target)) = (source, target) else {
        return Ok(FilmDefects::default());
    };
    let transition = Transition::between(source, target).map_err(|e| e.to_string())?;
    check_film(&transition)
}

/// Checks a transition by rigid parts; returns its defects.
///
/// # Errors
/// A description, if a face is not positively oriented in both designs, a vertex is not finite, or
/// the area at t = 0 or 1 is not that of the design.
pub fn check_film(transition: &Transition) -> Result<FilmDefects, String> {
    let areas = transition
        .designs()
        .each_ref()
        .map(|design| design.outline(0.0).map_or(0.0, |outline| outline.area()));
    check_positive_faces(transition)?;
    check_finite_vertices(transition)?;
    let report = film_report(transition, SAMPLES, &Silent).map_err(|e| e.to_string())?;
    for (i, area) in [(0, areas[0]), (SAMPLES - 1, areas[1])] {
        let deviation = (report.samples[i].area / area - 1.0).abs();
        // A comparison with NaN is false, so NaN is tested separately.
        if deviation.is_nan() || deviation > END_TOLERANCE {
            return Err(format!("frame {i}: the area is off by {deviation}"));
        }
    }
    Ok(FilmDefects {
        folds: report.worst_folds.unwrap_or(0),
        crossings: report.worst_crossings.unwrap_or(0),
    })
}

/// Checks that every face is positively oriented in both designs.
fn check_positive_faces(transition: &Transition) -> Result<(), String> {
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

/// Checks that every vertex is finite in every sampled frame.
fn check_finite_vertices(transition: &Transition) -> Result<(), String> {
    let mut frame = transition.frame(0.0);
    for i in 0..SAMPLES {
        frame.seek(i as f64 / (SAMPLES - 1) as f64);
        if !frame.placement().in_frame.iter().all(|p| p.is_finite()) {
            return Err(format!("frame {i}: a point that is not finite"));
        }
    }
    Ok(())
}
