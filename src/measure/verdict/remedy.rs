//! What helps: options are tried, the rest is named.

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

/// Meshes with more faces than this are not built again to try an option: a
/// trial of so many takes about a quarter of a second.
const MOST_FACES: usize = 20_000;

/// What a person can do about a face, where no option helps: pins belong to
/// matched outlines, meshes and trusses have vertices.
pub(super) fn by_hand(scene: &CauseSearch<'_>, face: usize) -> Remedy {
    let mesh = scene.arap.mesh();
    let [source, target] = [mesh.source(), mesh.target()].map(|p| scene.centroid(face, p));
    Remedy::MoveVertices { source, target }
}

/// Tries options, and turns what is done to vertices into pins where the
/// designs are outlines.
pub(super) fn for_rigid_parts(
    transition: &Transition,
    arap: &Arap,
    solid: &SolidContent,
    glances: &[MomentCounts],
    found: &mut [Finding],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    if found.is_empty() {
        return Ok(());
    }
    let designs = transition.designs();
    let has_pins = designs
        .iter()
        .any(|d| matches!(d.form, DesignForm::Outline(_)));
    for finding in &mut *found {
        if has_pins {
            finding.remedy = pin(finding);
        }
    }
    // After the pins: naming them costs nothing.
    if arap.mesh().faces().len() > MOST_FACES {
        return Ok(());
    }
    let now = glances;
    let changes = changes(arap, found);
    let shares = ProgressShares::new(progress, changes.len());
    for (k, change) in changes.iter().enumerate() {
        let film = (transition, arap, solid);
        let Some(then) = tried(change, film, now.len(), &shares.part(k))? else {
            continue;
        };
        for finding in &mut *found {
            take_if_better(finding, change, now, &then);
        }
    }
    Ok(())
}

/// A pin where the match is uneven, or else where the trouble is.
fn pin(finding: &Finding) -> Remedy {
    match (&finding.cause, &finding.remedy) {
        (&FindingCause::UnevenMatch { source, target, .. }, _)
        | (_, &Remedy::MoveVertices { source, target }) => Remedy::Pin { source, target },
        (_, other) => other.clone(),
    }
}

/// The options that are worth a trial, the likeliest first.
fn changes(arap: &Arap, found: &[Finding]) -> Vec<SettingChange> {
    let options = arap.options();
    let mut changes = Vec::new();
    for finding in found {
        if let &FindingCause::FarTurn {
            part: Some(part),
            turn,
        } = &finding.cause
        {
            changes.push(the_other_way(arap, part, turn));
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

/// A whole turn less for a part, so that it turns the other way.
fn the_other_way(arap: &Arap, part: usize, turn: f64) -> SettingChange {
    let given = &arap.options().extra_turns;
    let each = |p: usize| match given.as_slice() {
        [all] => *all,
        each => each.get(p).copied().unwrap_or(0),
    };
    // Written out for each part: a single number would turn all of them.
    let mut turns: Vec<i32> = (0..arap.part_count()).map(each).collect();
    if let Some(own) = turns.get_mut(part) {
        *own -= if turn > 0.0 { 1 } else { -1 };
    }
    SettingChange::ExtraTurns(turns)
}

/// What is wrong with the change made; `None` where it cannot be made.
fn tried(
    change: &SettingChange,
    (transition, arap, solid): (&Transition, &Arap, &SolidContent),
    steps: usize,
    progress: &dyn Progress,
) -> Result<Option<Vec<MomentCounts>>, Cancelled> {
    let mut options = TransitionOptions {
        arap: arap.options().clone(),
        ..TransitionOptions::default()
    };
    change.apply(&mut options);
    match arap.rebuilt(&options.arap, progress) {
        Ok(other) => defect_scan::rigid_parts(transition, &other, solid, steps, progress).map(Some),
        Err(ArapError::Cancelled(cancelled)) => Err(cancelled),
        Err(_) => Ok(None),
    }
}

/// Takes a change that leaves less of the trouble, and no more of the other,
/// than what was found before.
fn take_if_better(
    finding: &mut Finding,
    change: &SettingChange,
    now: &[MomentCounts],
    then: &[MomentCounts],
) {
    let (own, other): (defect_scan::DefectCounts, defect_scan::DefectCounts) = match finding.trouble
    {
        FindingKind::Folds { .. } => (|g| g.folds, |g| g.crossings),
        _ => (|g| g.crossings, |g| g.folds),
    };
    let of = defect_scan::most(now, own);
    let best = match finding.remedy {
        Remedy::Change { left, .. } => left,
        _ => of,
    };
    let left = defect_scan::most(then, own);
    // Folds undone at the price of new crossings are no remedy.
    if left < best && defect_scan::most(then, other) <= defect_scan::most(now, other) {
        let change = change.clone();
        finding.remedy = Remedy::Change { change, left, of };
    }
}

/// Tries the other space.
pub(super) fn for_fields(
    transition: &Transition,
    pair: &FieldPair,
    steps: usize,
    found: &mut [Finding],
    progress: &dyn Progress,
) -> Result<(), Cancelled> {
    if found.is_empty() {
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
    let then = defect_scan::fields(&other, steps, progress)?;
    for finding in found {
        let (of, left) = match finding.trouble {
            FindingKind::Pieces { count, at_ends } => (
                count - at_ends,
                defect_scan::most(&then, |g| g.pieces).saturating_sub(at_ends),
            ),
            FindingKind::Holes { count, at_ends } => (
                count - at_ends,
                defect_scan::most(&then, |g| g.holes).saturating_sub(at_ends),
            ),
            _ => (1, usize::from(then.iter().any(|g| g.pieces == 0))),
        };
        if left < of {
            let change = SettingChange::Space(blend.space);
            finding.remedy = Remedy::Change { change, left, of };
        }
    }
    Ok(())
}
