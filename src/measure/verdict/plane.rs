//! Finds the defects of warps of the plane: folds, and pins or lines that the warp misses.

use super::finding::{Finding, FindingCause, FindingKind, Remedy};
use crate::content::Content;
use crate::geometry::{Bounds, DVec2, twice_signed_area};
use crate::measure::film_report::evenly_spaced_times;
use crate::transition::{Frame, Transition};
use crate::warp::{MissedFeatures, WarpKind};
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// Folds that cover less than this fraction of the frame are ignored. If the frame is drawn with
/// 1000 by 1000 pixels, this is a square 22 pixels wide (heuristic).
const MIN_FOLD_FRACTION: f64 = 5e-4;

/// Worst finding of one kind so far, with its size. Its `span` covers all findings of that kind so
/// far.
type WorstFold = Option<(f64, Finding)>;

/// Keeps the larger of the worst finding so far and a new one, and joins their spans.
fn keep_worst(worst: &mut WorstFold, size: f64, mut finding: Finding) {
    if let Some((largest_size, largest)) = worst {
        largest.span[1] = finding.t;
        finding.span = largest.span;
        // If the new finding is not larger, the earlier one stays; its span has just been extended.
        if size <= *largest_size {
            return;
        }
    }
    *worst = Some((size, finding));
}

/// Finds folds of a warp of the plane and features (pins and lines) that it misses. Returns an
/// empty list for other warps.
pub(super) fn plane_findings(
    transition: &Transition,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let is_solid = matches!(transition.content(), Content::Solid(_));
    if is_solid || transition.method().warp() == WarpKind::None {
        return Ok(Vec::new());
    }
    let bounds = transition.bounds();
    let mut frame = transition.frame(0.0);
    let (mut folds, mut missed) = (WorstFold::None, WorstFold::None);
    for t in evenly_spaced_times(steps) {
        checkpoint(progress, "looking for folds of the plane", t)?;
        frame.seek(t);
        let (share, place) = folded_fraction(&frame, &bounds);
        if share > MIN_FOLD_FRACTION {
            let finding = Finding {
                trouble: FindingKind::PlaneFolds { share },
                t,
                span: [t, t],
                place,
                cause: FindingCause::SeenTwice,
                remedy: Remedy::Lattices,
            };
            keep_worst(&mut folds, share, finding);
        }
        if let Some(missed_now) = transition.missed_features(t) {
            keep_worst(
                &mut missed,
                missed_now.distance,
                missed_finding(&missed_now, t, bounds.diameter()),
            );
        }
    }
    Ok([folds, missed]
        .into_iter()
        .flatten()
        .map(|(_, f)| f)
        .collect())
}

/// Creates the finding for features that are missed at `t`; `diameter` is that of the frame.
fn missed_finding(missed: &MissedFeatures, t: f64, diameter: f64) -> Finding {
    let (cause, remedy) = if missed.fold_free {
        (FindingCause::OutOfReach, Remedy::LetFold)
    } else {
        (FindingCause::FeaturesMeet, Remedy::MovePins)
    };
    Finding {
        trouble: FindingKind::Missed {
            count: missed.count,
            by: missed.distance / diameter,
        },
        t,
        span: [t, t],
        place: missed.place,
        cause,
        remedy,
    }
}

/// Returns whether a point of the frame is painted at `t`, where `samples` are the points of source
/// and target that the warp brings to that point. A distance field paints only its inside, a
/// picture everything.
fn is_visible(content: &Content, t: f64, samples: [DVec2; 2]) -> bool {
    let Content::Field(fields) = content else {
        return true;
    };
    let (pair, t) = fields.pair_at(t);
    let pair = &fields.pairs()[pair];
    let [a, b] = [(pair.source(), samples[0]), (pair.target(), samples[1])].map(|(field, p)| {
        let at = pair.grid().lattice_from_plane(p);
        field.samples().bilinear(at.x, at.y)
    });
    pair.blend().value(a, b, t) >= pair.blend().level()
}

/// Returns the fraction of the frame covered by visible faces that are folded in the frame or in
/// either design, and the centre of the largest such face.
fn folded_fraction(frame: &Frame, bounds: &Bounds) -> (f64, DVec2) {
    let placement = frame.placement();
    let (mut sum, mut largest, mut place) = (0.0, 0.0, bounds.centre());
    for face in placement.faces.iter() {
        let corners = |points: &[DVec2]| face.map(|v| points[v as usize]);
        let centroid = |points: &[DVec2]| corners(points).iter().sum::<DVec2>() / 3.0;
        let centre = centroid(&placement.in_frame);
        let samples = [&placement.in_source, &placement.in_target].map(|p| centroid(p));
        if !bounds.contains(centre) || !is_visible(frame.transition().content(), frame.t(), samples)
        {
            continue;
        }
        let area = |[a, b, c]: [DVec2; 3]| twice_signed_area(a, b, c);
        let in_frame = area(corners(&placement.in_frame));
        let in_designs = [&placement.in_source, &placement.in_target].map(|p| area(corners(p)));
        // A face that is not folded has positive area in the frame and in both designs.
        if in_frame < 0.0 || in_designs.iter().any(|area| *area < 0.0) {
            sum += in_frame.abs();
            if in_frame.abs() > largest {
                (largest, place) = (in_frame.abs(), centre);
            }
        }
    }
    let size = bounds.size();
    (0.5 * sum / (size.x * size.y).max(f64::MIN_POSITIVE), place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::PointPair;
    use crate::measure::Verdict;
    use crate::project::gallery;
    use crate::work::progress::Silent;

    /// Checks a transition in which two pins exchange their positions, between four pins that stay
    /// in place.
    fn verdict_with_exchanged_pins(warp: WarpKind, fold_free: bool) -> Verdict {
        let mut loaded = gallery::load("portraits-points").expect("a project");
        let pair = |from: (f64, f64), to: (f64, f64)| PointPair {
            source: DVec2::from(from),
            target: DVec2::from(to),
        };
        let corners = [(20.0, 20.0), (340.0, 20.0), (340.0, 440.0), (20.0, 440.0)];
        let (left, right) = ((120.0, 250.0), (260.0, 250.0));
        loaded.project.warp = Some(warp);
        loaded.project.options.lattice.fold_free = fold_free;
        let pins = &mut loaded.project.options.matching.pins;
        *pins = vec![pair(left, right), pair(right, left)];
        pins.extend(corners.map(|corner| pair(corner, corner)));
        loaded.project.options.matching.lines.clear();
        let spec = loaded.spec().expect("a specification");
        let transition = Transition::build(&spec, &Silent).expect("a transition");
        Verdict::of(&transition, 9, &Silent).expect("not cancelled")
    }

    #[test]
    fn pins_that_exchange_positions_fold_the_plane() {
        let verdict = verdict_with_exchanged_pins(WarpKind::Scattered, false);
        let [finding] = verdict.findings.as_slice() else {
            panic!("{}", verdict.headline());
        };
        assert!(matches!(finding.trouble, FindingKind::PlaneFolds { share } if share > 0.01));
        assert_eq!(finding.remedy, Remedy::Lattices);
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn fold_free_lattices_miss_the_pins_instead() {
        let verdict = verdict_with_exchanged_pins(WarpKind::Lattice, true);
        let [finding] = verdict.findings.as_slice() else {
            panic!("{}", verdict.headline());
        };
        assert!(matches!(finding.trouble, FindingKind::Missed { count: 2, by } if by > 0.001));
        assert_eq!(finding.remedy, Remedy::LetFold);
    }
}
