//! What is found in rigid parts and in boundaries.

use super::cause;
use super::cause::CauseSearch;
use super::defect_scan;
use super::defect_scan::MomentCounts;
use super::finding::{Finding, FindingCause, FindingKind, Remedy};
use super::remedy;
use crate::compatible::CompatibleMesh;
use crate::content::SolidContent;
use crate::geometry::DVec2;
use crate::transition::Transition;
use crate::work::progress::{Cancelled, Progress};

pub(super) fn findings(
    transition: &Transition,
    solid: &SolidContent,
    glances: &[MomentCounts],
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let Some(arap) = transition.arap() else {
        let found = match transition.compatible() {
            Some(mesh) => of_blends(transition, mesh, solid, glances),
            None => of_boundaries(transition, solid, glances)
                .into_iter()
                .collect(),
        };
        return Ok(found);
    };
    let mut found = Vec::new();
    if let Some((t, span)) = defect_scan::worst(glances, |g| g.folds, 0) {
        let scene = CauseSearch::new(transition, arap, solid, t);
        found.extend(of_folds(&scene, t, span));
    }
    if let Some((t, span)) = defect_scan::worst(glances, |g| g.crossings, 0) {
        let scene = CauseSearch::new(transition, arap, solid, t);
        found.extend(of_crossings(&scene, t, span));
    }
    remedy::for_rigid_parts(transition, arap, solid, glances, &mut found, progress)?;
    Ok(found)
}

/// Crossings of a boundary that has nothing inside.
fn of_boundaries(
    transition: &Transition,
    solid: &SolidContent,
    glances: &[MomentCounts],
) -> Option<Finding> {
    let (t, span) = defect_scan::worst(glances, |g| g.crossings, 0)?;
    let frame = transition.frame(t);
    let crossings = solid.crossings_at(&frame.placement().in_frame, t);
    Some(Finding {
        place: crossings.first()?.place,
        trouble: FindingKind::Crossings { crossings },
        t,
        span,
        cause: FindingCause::NothingInside,
        remedy: Remedy::RigidParts,
    })
}

/// What is found on the way through the blends of many designs.
fn of_blends(
    transition: &Transition,
    mesh: &CompatibleMesh,
    solid: &SolidContent,
    glances: &[MomentCounts],
) -> Vec<Finding> {
    let finding = |(t, span), place, trouble| Finding {
        trouble,
        t,
        span,
        place,
        cause: FindingCause::Unclear,
        remedy: Remedy::AnotherWay,
    };
    let folds = defect_scan::worst(glances, |g| g.folds, 0).and_then(|at| {
        let frame = transition.frame(at.0);
        let places = &frame.placement().in_frame;
        let faces: Vec<usize> = defect_scan::folded(mesh.faces(), places).collect();
        let corners = mesh.faces()[*faces.first()?].map(|v| places[v as usize]);
        let middle = corners.iter().sum::<DVec2>() / 3.0;
        Some(finding(at, middle, FindingKind::Folds { faces }))
    });
    let crossings = defect_scan::worst(glances, |g| g.crossings, 0).and_then(|at| {
        let frame = transition.frame(at.0);
        let crossings = solid.crossings_at(&frame.placement().in_frame, at.0);
        let place = crossings.first()?.place;
        Some(finding(at, place, FindingKind::Crossings { crossings }))
    });
    folds.into_iter().chain(crossings).collect()
}

fn of_folds(scene: &CauseSearch<'_>, t: f64, span: [f64; 2]) -> Option<Finding> {
    let faces: Vec<usize> = defect_scan::folded(scene.arap.mesh().faces(), &scene.places).collect();
    let by_det = |a: &&usize, b: &&usize| scene.det(**a).total_cmp(&scene.det(**b));
    let worst = *faces.iter().min_by(by_det)?;
    // What an option can change comes first, then what a pin can, and last what
    // only tells where to look.
    let cause = cause::straight_paths(scene, worst, t)
        .or_else(|| cause::far_turn_of_part(scene, worst))
        .or_else(|| cause::uneven_match(scene, worst))
        .or_else(|| cause::unlike_neighbours(scene, &faces))
        .or_else(|| cause::far_turn(scene, worst));
    Some(Finding {
        place: scene.centroid(worst, &scene.places),
        trouble: FindingKind::Folds { faces },
        t,
        span,
        cause: cause.unwrap_or(FindingCause::Unclear),
        remedy: remedy::by_hand(scene, worst),
    })
}

fn of_crossings(scene: &CauseSearch<'_>, t: f64, span: [f64; 2]) -> Option<Finding> {
    let found = scene.solid.crossings_at(&scene.places, t);
    let first = *found.first()?;
    let faces: Vec<usize> = first
        .edges
        .iter()
        .filter_map(|&e| scene.face_at(e))
        .collect();
    let &[a, b] = faces.as_slice() else {
        return None;
    };
    let cause = cause::straight_paths(scene, a, t)
        .or_else(|| cause::straight_paths(scene, b, t))
        .or_else(|| cause::far_turn_of_part(scene, a))
        .or_else(|| cause::far_turn_of_part(scene, b))
        .or_else(|| {
            let near = cause::near_each_other(scene, &first);
            near.then(|| cause::uneven_match(scene, a)).flatten()
        });
    let meet = || FindingCause::PlacesMeet {
        turns: [a, b].map(|f| scene.angles[f]),
        source: [a, b].map(|f| scene.centroid(f, scene.arap.mesh().source())),
    };
    Some(Finding {
        place: first.place,
        trouble: FindingKind::Crossings { crossings: found },
        t,
        span,
        cause: cause.unwrap_or_else(meet),
        remedy: remedy::by_hand(scene, a),
    })
}
