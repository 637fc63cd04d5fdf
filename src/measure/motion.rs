//! Travel and acceleration of the vertices, relative to the rigid motion of the whole shape.

use crate::geometry::{DMat2, DVec2};
use serde::Serialize;

/// Travel and acceleration of the vertices, after removing the rigid motion of the whole shape.
/// Lengths are in design diameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct MotionReport {
    /// Mean length of the paths of all vertices.
    pub mean_travel: f64,
    /// Length of the longest path of a vertex.
    pub max_travel: f64,
    /// Largest acceleration of a vertex: the second derivative of its position with respect to t,
    /// computed from second differences.
    pub max_acceleration: f64,
}

/// Measures the paths of the vertices from their positions at evenly spaced t, `step` apart.
/// Returns `None` for fewer than three samples.
pub(super) fn motion_report(
    samples: &[Vec<DVec2>],
    step: f64,
    diameter: f64,
) -> Option<MotionReport> {
    let first = samples.first()?;
    if samples.len() < 3 || first.is_empty() || diameter <= 0.0 {
        return None;
    }
    let aligned: Vec<Vec<DVec2>> = samples
        .iter()
        .map(|sample| without_rigid(sample, first))
        .collect();
    let mut travel = vec![0.0; first.len()];
    for pair in aligned.windows(2) {
        for (sum, (a, b)) in travel.iter_mut().zip(pair[0].iter().zip(&pair[1])) {
            *sum += a.distance(*b) / diameter;
        }
    }
    let second_differences = aligned.windows(3).flat_map(|three| {
        let [a, b, c] = [&three[0], &three[1], &three[2]];
        (0..a.len()).map(move |i| (a[i] - 2.0 * b[i] + c[i]).length())
    });
    Some(MotionReport {
        mean_travel: travel.iter().sum::<f64>() / travel.len() as f64,
        max_travel: travel.iter().copied().fold(0.0, f64::max),
        max_acceleration: second_differences.fold(0.0, f64::max) / (step * step * diameter),
    })
}

/// Returns the points after the rigid motion that brings them closest to `onto` in the
/// least-squares sense.
fn without_rigid(points: &[DVec2], onto: &[DVec2]) -> Vec<DVec2> {
    let mean = |all: &[DVec2]| all.iter().sum::<DVec2>() / all.len() as f64;
    let (c, d) = (mean(points), mean(onto));
    let (mut sin, mut cos) = (0.0, 0.0);
    for (&p, &q) in points.iter().zip(onto) {
        sin += (p - c).perp_dot(q - d);
        cos += (p - c).dot(q - d);
    }
    let turn = DMat2::from_angle(sin.atan2(cos));
    points.iter().map(|&p| turn * (p - c) + d).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_motion_is_no_travel() {
        let points = [DVec2::ZERO, DVec2::new(2.0, 0.0), DVec2::new(1.0, 3.0)];
        let at = |t: f64| -> Vec<DVec2> {
            let turn = DMat2::from_angle(5.0 * t);
            points
                .iter()
                .map(|&p| turn * p + DVec2::new(7.0 * t, t))
                .collect()
        };
        let samples: Vec<_> = (0..9).map(|i| at(f64::from(i) / 8.0)).collect();
        let report = motion_report(&samples, 0.125, 3.0).expect("samples");
        assert!(
            report.max_travel < 1e-12 && report.max_acceleration < 1e-10,
            "{report:?}"
        );
    }

    #[test]
    fn a_single_moving_vertex_is_measured() {
        let samples: Vec<Vec<DVec2>> = (0..5)
            .map(|i| {
                let mut points: Vec<_> =
                    (0..100).map(|k| DVec2::from_angle(f64::from(k))).collect();
                points.push(DVec2::new(f64::from(i), 0.0));
                points
            })
            .collect();
        let report = motion_report(&samples, 0.25, 2.0).expect("samples");
        assert!((report.max_travel - 2.0).abs() < 0.1, "{report:?}");
    }
}
