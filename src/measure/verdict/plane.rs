//! What goes wrong with warps of the plane: places that are seen twice, and
//! features that are missed.

use super::finding::{Finding, FindingCause, FindingKind, Remedy};
use crate::content::Content;
use crate::geometry::{Bounds, DVec2, twice_signed_area};
use crate::measure::film_report::even_steps;
use crate::transition::{Frame, Transition};
use crate::warp::{MissedFeatures, WarpKind};
use crate::work::progress::{Cancelled, Progress, checkpoint};

/// Folds over less than this share of the frame are not seen.
/// On a window of 1000 by 1000 a spot of some 22 pixels across.
const SEEN: f64 = 5e-4;

/// The worst of one kind so far, how bad it is, and the span of all.
type WorstFold = Option<(f64, Finding)>;

/// Keeps the worse of two, and the span of both.
fn keep(worst: &mut WorstFold, size: f64, mut finding: Finding) {
    if let Some((before, known)) = worst {
        known.span[1] = finding.t;
        finding.span = known.span;
        // The earlier of equals stays; its span was carried on already.
        if size <= *before {
            return;
        }
    }
    *worst = Some((size, finding));
}

pub(super) fn findings(
    transition: &Transition,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let is_solid = matches!(transition.content(), Content::Solid(_));
    if is_solid || transition.cell().warp() == WarpKind::None {
        return Ok(Vec::new());
    }
    let bounds = transition.bounds();
    let mut frame = transition.frame(0.0);
    let (mut folds, mut missed) = (WorstFold::None, WorstFold::None);
    for t in even_steps(steps) {
        checkpoint(progress, "looking for folds of the plane", t)?;
        frame.seek(t);
        let (share, place) = folded(&frame, &bounds);
        if share > SEEN {
            let finding = Finding {
                trouble: FindingKind::PlaneFolds { share },
                t,
                span: [t, t],
                place,
                cause: FindingCause::SeenTwice,
                remedy: Remedy::Lattices,
            };
            keep(&mut folds, share, finding);
        }
        if let Some(now) = transition.missed(t) {
            keep(&mut missed, now.by, of_missed(&now, t, bounds.diameter()));
        }
    }
    Ok([folds, missed]
        .into_iter()
        .flatten()
        .map(|(_, f)| f)
        .collect())
}

fn of_missed(missed: &MissedFeatures, t: f64, diameter: f64) -> Finding {
    let (cause, remedy) = if missed.unfolded {
        (FindingCause::OutOfReach, Remedy::LetFold)
    } else {
        (FindingCause::FeaturesMeet, Remedy::MovePins)
    };
    Finding {
        trouble: FindingKind::Missed {
            count: missed.count,
            by: missed.by / diameter,
        },
        t,
        span: [t, t],
        place: missed.place,
        cause,
        remedy,
    }
}

/// Whether something is drawn at `t` where the designs are looked at in these
/// places: of fields only what is inside.
fn is_seen(content: &Content, t: f64, looks: [DVec2; 2]) -> bool {
    let Content::Field(fields) = content else {
        return true;
    };
    let (pair, t) = fields.place(t);
    let pair = &fields.pairs()[pair];
    let [a, b] = [(pair.source(), looks[0]), (pair.target(), looks[1])].map(|(field, p)| {
        let at = pair.grid().lattice_from_plane(p);
        field.samples().bilinear(at.x, at.y)
    });
    pair.blend().value(a, b, t) >= pair.blend().level()
}

/// The share of the frame in which the plane is turned over, in the frame or
/// in either design, and the middle of the largest such face.
fn folded(frame: &Frame, bounds: &Bounds) -> (f64, DVec2) {
    let placement = frame.placement();
    let (mut sum, mut largest, mut place) = (0.0, 0.0, bounds.centre());
    for face in placement.faces.iter() {
        let corners = |points: &[DVec2]| face.map(|v| points[v as usize]);
        let middle = |points: &[DVec2]| corners(points).iter().sum::<DVec2>() / 3.0;
        let seen = corners(&placement.in_frame);
        let at = middle(&placement.in_frame);
        let shows = [&placement.in_source, &placement.in_target].map(|p| middle(p));
        if !bounds.contains(at) || !is_seen(frame.transition().content(), frame.t(), shows) {
            continue;
        }
        let area = |[a, b, c]: [DVec2; 3]| twice_signed_area(a, b, c);
        let own = area(seen);
        let looks = [&placement.in_source, &placement.in_target].map(|p| area(corners(p)));
        // What is seen the right way round is so in both designs.
        if own < 0.0 || looks.iter().any(|look| *look < 0.0) {
            sum += own.abs();
            if own.abs() > largest {
                (largest, place) = (own.abs(), at);
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

    /// Two pins that change places between four that stay, by a warp.
    fn crossed(warp: WarpKind, fold_free: bool) -> Verdict {
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
    fn pins_that_change_places_fold_the_plane() {
        let verdict = crossed(WarpKind::Scattered, false);
        let [finding] = verdict.findings.as_slice() else {
            panic!("{}", verdict.headline());
        };
        assert!(matches!(finding.trouble, FindingKind::PlaneFolds { share } if share > 0.01));
        assert_eq!(finding.remedy, Remedy::Lattices);
    }

    #[test]
    fn lattices_without_folds_miss_them_instead() {
        let verdict = crossed(WarpKind::Lattice, true);
        let [finding] = verdict.findings.as_slice() else {
            panic!("{}", verdict.headline());
        };
        assert!(matches!(finding.trouble, FindingKind::Missed { count: 2, by } if by > 0.001));
        assert_eq!(finding.remedy, Remedy::LetFold);
    }
}
