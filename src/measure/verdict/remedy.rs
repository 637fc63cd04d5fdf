//! Finds remedies for defects: changed options are tested on the same film, edits are only
//! suggested.

use super::cause::CauseSearch;
use super::defect_scan;
use super::defect_scan::MomentCounts;
use super::finding::{Finding, FindingCause, FindingKind, Remedy, SettingChange};
use crate::content::{BlendSpace, FieldPair, SolidContent};
use crate::design::DesignForm;
use crate::transition::{Transition, TransitionOptions};
use crate::warp::homotopy::Homotopy;
use crate::warp::{Arap, ArapError};
use crate::work::progress::{Cancelled, Progress, ProgressShares};

/// Maximum number of faces of a mesh on which changed options are tested (resource limit: one test
/// of this size takes about a quarter of a second).
const MAX_TESTED_FACES: usize = 20_000;

/// Returns the suggestion to move the vertices near a face, for defects that no option removes.
pub(super) fn move_vertices_at(search: &CauseSearch<'_>, face: usize) -> Remedy {
    let mesh = search.arap.mesh();
    let [source, target] = [mesh.source(), mesh.target()].map(|p| search.centroid(face, p));
    Remedy::MoveVertices { source, target }
}

/// Updates the remedies of all findings: suggests pins instead of vertex edits if a design is an
/// outline, and tests changed options.
pub(super) fn try_rigid_part_options(
    transition: &Transition,
    arap: &Arap,
    solid: &SolidContent,
    moments: &[MomentCounts],
    findings: &mut [Finding],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    if findings.is_empty() {
        return Ok(());
    }
    let designs = transition.designs();
    let has_pins = designs
        .iter()
        .any(|d| matches!(d.form, DesignForm::Outline(_)));
    for finding in &mut *findings {
        if has_pins {
            finding.remedy = with_pin(finding);
        }
    }
    // Pins are suggested for meshes of any size, because that costs nothing.
    if arap.mesh().faces().len() > MAX_TESTED_FACES {
        return Ok(());
    }
    let before = moments;
    let changes = changes(arap, findings);
    let shares = ProgressShares::new(progress, changes.len());
    for (k, change) in changes.iter().enumerate() {
        let (steps, share) = (before.len(), shares.part(k));
        let Some(after) = scan_with(change, transition, arap, solid, steps, &share)? else {
            continue;
        };
        for finding in &mut *findings {
            adopt_if_better(finding, change, before, &after);
        }
    }
    Ok(())
}

/// Returns the remedy of a finding, with a pin at the same place instead of vertex edits. If the
/// cause is an uneven match, always returns a pin at the boundary point where the stretch was
/// measured.
fn with_pin(finding: &Finding) -> Remedy {
    match (&finding.cause, &finding.remedy) {
        (&FindingCause::UnevenMatch { source, target, .. }, _)
        | (_, &Remedy::MoveVertices { source, target }) => Remedy::Pin { source, target },
        (_, other) => other.clone(),
    }
}

/// Returns the changes of options to test, the most promising first.
fn changes(arap: &Arap, findings: &[Finding]) -> Vec<SettingChange> {
    let options = arap.options();
    let mut changes = Vec::new();
    for finding in findings {
        if let &FindingCause::FarTurn {
            part: Some(part),
            turn,
        } = &finding.cause
        {
            changes.push(turn_other_way(arap, part, turn));
        }
    }
    for homotopy in [Homotopy::Polar, Homotopy::Exponential] {
        if options.homotopy != homotopy {
            changes.push(SettingChange::Homotopy(homotopy));
        }
    }
    if !options.symmetric {
        changes.push(SettingChange::Symmetric);
    }
    changes
}

/// Returns the setting change that gives a part one full turn more or less, so that the part
/// rotates in the other direction. `turn` is its current rotation.
fn turn_other_way(arap: &Arap, part: usize, turn: f64) -> SettingChange {
    let current_turns = &arap.options().extra_turns;
    let each = |p: usize| match current_turns.as_slice() {
        [all] => *all,
        each => each.get(p).copied().unwrap_or(0),
    };
    // The list has one number per part, because a single number would apply to all parts.
    let mut turns: Vec<i32> = (0..arap.part_count()).map(each).collect();
    if let Some(part_turns) = turns.get_mut(part) {
        *part_turns -= if turn > 0.0 { 1 } else { -1 };
    }
    SettingChange::ExtraTurns(turns)
}

/// Counts the defects of the film with a changed option; returns `None` if the film cannot be built
/// with it.
fn scan_with(
    change: &SettingChange,
    transition: &Transition,
    arap: &Arap,
    solid: &SolidContent,
    steps: usize,
    progress: &dyn Progress,
) -> Result<Option<Vec<MomentCounts>>, Cancelled> {
    let mut options = TransitionOptions {
        arap: arap.options().clone(),
        ..TransitionOptions::default()
    };
    change.apply(&mut options);
    match arap.rebuilt(&options.arap, progress) {
        Ok(rebuilt) => {
            defect_scan::scan_rigid_parts(transition, &rebuilt, solid, steps, progress).map(Some)
        }
        Err(ArapError::Cancelled(cancelled)) => Err(cancelled),
        Err(_) => Ok(None),
    }
}

/// Adopts a change as the remedy of a finding of folds or crossings, on two conditions: it leaves
/// fewer defects of the finding's kind than the film has with the best change so far (or without
/// any change), and no more defects of the other kind than the film has without the change.
fn adopt_if_better(
    finding: &mut Finding,
    change: &SettingChange,
    before: &[MomentCounts],
    after: &[MomentCounts],
) {
    let (same_kind, other_kind): (defect_scan::DefectCounts, defect_scan::DefectCounts) =
        match finding.trouble {
            FindingKind::Folds { .. } => (|g| g.folds, |g| g.crossings),
            _ => (|g| g.crossings, |g| g.folds),
        };
    let of = defect_scan::max_count(before, same_kind);
    let best = match finding.remedy {
        Remedy::Change { left, .. } => left,
        _ => of,
    };
    let left = defect_scan::max_count(after, same_kind);
    // Removing folds at the cost of new crossings is not a remedy.
    if left < best
        && defect_scan::max_count(after, other_kind) <= defect_scan::max_count(before, other_kind)
    {
        let change = change.clone();
        finding.remedy = Remedy::Change { change, left, of };
    }
}

/// Tests whether fewer defects are left if distances are blended instead of their logarithms, or
/// the reverse. If so, makes this change the remedy.
pub(super) fn try_other_blend_space(
    transition: &Transition,
    pair: &FieldPair,
    steps: usize,
    findings: &mut [Finding],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    if findings.is_empty() {
        return Ok(());
    }
    let mut blend = *pair.blend();
    blend.space = match blend.space {
        BlendSpace::Log => BlendSpace::Real,
        BlendSpace::Real => BlendSpace::Log,
    };
    let Ok(Some(other)) = transition.with_blend(blend) else {
        return Ok(());
    };
    let after = defect_scan::scan_fields(&other, steps, progress)?;
    for finding in findings {
        let (of, left) = match finding.trouble {
            FindingKind::Pieces { count, at_ends } => (
                count - at_ends,
                defect_scan::max_count(&after, |g| g.pieces).saturating_sub(at_ends),
            ),
            FindingKind::Holes { count, at_ends } => (
                count - at_ends,
                defect_scan::max_count(&after, |g| g.holes).saturating_sub(at_ends),
            ),
            _ => (1, usize::from(after.iter().any(|g| g.pieces == 0))),
        };
        if left < of {
            let change = SettingChange::Space(blend.space);
            finding.remedy = Remedy::Change { change, left, of };
        }
    }
    Ok(())
}
