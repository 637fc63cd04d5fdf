//! Finds the defects of solids (folded faces and crossing boundaries) and their causes.

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

/// Finds the folds and crossings of a solid, and tests remedies if it consists of rigid parts.
pub(super) fn solid_findings(
    transition: &Transition,
    solid: &SolidContent,
    moments: &[MomentCounts],
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let Some(arap) = transition.arap() else {
        let findings = match transition.compatible() {
            Some(mesh) => path_findings(transition, mesh, solid, moments),
            None => boundary_crossings(transition, solid, moments)
                .into_iter()
                .collect(),
        };
        return Ok(findings);
    };
    let mut findings = Vec::new();
    if let Some((t, span)) = defect_scan::worst_moment(moments, |g| g.folds, 0) {
        let search = CauseSearch::new(transition, arap, solid, t);
        findings.extend(fold_finding(&search, t, span));
    }
    if let Some((t, span)) = defect_scan::worst_moment(moments, |g| g.crossings, 0) {
        let search = CauseSearch::new(transition, arap, solid, t);
        findings.extend(crossing_finding(&search, t, span));
    }
    remedy::try_rigid_part_options(transition, arap, solid, moments, &mut findings, progress)?;
    Ok(findings)
}

/// Finds crossings of boundaries whose inside has no mesh.
fn boundary_crossings(
    transition: &Transition,
    solid: &SolidContent,
    moments: &[MomentCounts],
) -> Option<Finding> {
    let (t, span) = defect_scan::worst_moment(moments, |g| g.crossings, 0)?;
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

/// Finds folds and crossings of a film that follows a path through the blends of many designs.
fn path_findings(
    transition: &Transition,
    mesh: &CompatibleMesh,
    solid: &SolidContent,
    moments: &[MomentCounts],
) -> Vec<Finding> {
    let finding = |(t, span), place, trouble| Finding {
        trouble,
        t,
        span,
        place,
        cause: FindingCause::Unclear,
        remedy: Remedy::AnotherWay,
    };
    let folds = defect_scan::worst_moment(moments, |g| g.folds, 0).and_then(|moment| {
        let frame = transition.frame(moment.0);
        let places = &frame.placement().in_frame;
        let faces: Vec<usize> = defect_scan::folded_faces(mesh.faces(), places).collect();
        let corners = mesh.faces()[*faces.first()?].map(|v| places[v as usize]);
        let middle = corners.iter().sum::<DVec2>() / 3.0;
        Some(finding(moment, middle, FindingKind::Folds { faces }))
    });
    let crossings = defect_scan::worst_moment(moments, |g| g.crossings, 0).and_then(|moment| {
        let frame = transition.frame(moment.0);
        let crossings = solid.crossings_at(&frame.placement().in_frame, moment.0);
        let place = crossings.first()?.place;
        Some(finding(moment, place, FindingKind::Crossings { crossings }))
    });
    folds.into_iter().chain(crossings).collect()
}

/// Creates the finding for the folds at `t`. Place and cause are those of the worst face.
fn fold_finding(search: &CauseSearch<'_>, t: f64, span: [f64; 2]) -> Option<Finding> {
    let faces: Vec<usize> =
        defect_scan::folded_faces(search.arap.mesh().faces(), &search.places).collect();
    let by_det = |a: &&usize, b: &&usize| search.det(**a).total_cmp(&search.det(**b));
    let worst = *faces.iter().min_by(by_det)?;
    // Causes that an option can fix come first, then those that a pin can fix, and last those
    // that only describe the place.
    let cause = cause::straight_paths(search, worst, t)
        .or_else(|| cause::large_rotation_of_part(search, worst))
        .or_else(|| cause::uneven_match(search, worst))
        .or_else(|| cause::differing_neighbours(search, &faces))
        .or_else(|| cause::large_rotation(search, worst));
    Some(Finding {
        place: search.centroid(worst, &search.places),
        trouble: FindingKind::Folds { faces },
        t,
        span,
        cause: cause.unwrap_or(FindingCause::Unclear),
        remedy: remedy::move_vertices_at(search, worst),
    })
}

/// Creates the finding for the crossings at `t`. Place and cause are those of the first crossing.
fn crossing_finding(search: &CauseSearch<'_>, t: f64, span: [f64; 2]) -> Option<Finding> {
    let crossings = search.solid.crossings_at(&search.places, t);
    let first = *crossings.first()?;
    let faces: Vec<usize> = first
        .edges
        .iter()
        .filter_map(|&e| search.face_at(e))
        .collect();
    let &[a, b] = faces.as_slice() else {
        return None;
    };
    let cause = cause::straight_paths(search, a, t)
        .or_else(|| cause::straight_paths(search, b, t))
        .or_else(|| cause::large_rotation_of_part(search, a))
        .or_else(|| cause::large_rotation_of_part(search, b))
        .or_else(|| {
            let is_near = cause::are_near_each_other(search, &first);
            is_near.then(|| cause::uneven_match(search, a)).flatten()
        });
    let places_meet = || FindingCause::PlacesMeet {
        turns: [a, b].map(|f| search.angles[f]),
        source: [a, b].map(|f| search.centroid(f, search.arap.mesh().source())),
    };
    Some(Finding {
        place: first.place,
        trouble: FindingKind::Crossings { crossings },
        t,
        span,
        cause: cause.unwrap_or_else(places_meet),
        remedy: remedy::move_vertices_at(search, a),
    })
}
