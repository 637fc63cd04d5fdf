//! Flags for the options of a project, shared by all subcommands that build transitions.
//!
//! Flags that are not given leave the project unchanged. The names of values are those in project
//! files; both come from the same tables.
//!
//! - `method`: method, warp and content, pins and lines
//! - `appearance`: import, distance fields, colours, timing and style

mod appearance;
mod method;

#[cfg(test)]
mod tests;

use clap::Args;

use crate::measure::build_best_method;
use crate::project::{LoadedProject, Project};
use crate::transition::{Sequence, Transition, TransitionMethod};
use crate::work::progress::{Progress, ProgressShares, ProgressSpan};

use super::error::CliError;
use appearance::{ColourArgs, FieldArgs, ImportArgs, StyleArgs, TimingArgs};
use method::{ArapArgs, CellArgs, PathArgs, PlacingArgs};

/// Flags that change a project.
#[derive(Debug, Args)]
pub(super) struct MethodArgs {
    /// Also run jobs expected to exceed 10 s or 2 GiB
    #[arg(long)]
    pub patient: bool,

    #[command(flatten)]
    placing: PlacingArgs,
    #[command(flatten)]
    cell: CellArgs,
    #[command(flatten)]
    arap: ArapArgs,
    #[command(flatten)]
    paths: PathArgs,
    #[command(flatten)]
    field: FieldArgs,
    #[command(flatten)]
    colours: ColourArgs,
    #[command(flatten)]
    import: ImportArgs,
    #[command(flatten)]
    timing: TimingArgs,
    #[command(flatten)]
    style: StyleArgs,
}

impl MethodArgs {
    /// Builds the transition of a project of two designs, or of one segment.
    ///
    /// With `--method auto`, builds and rates a transition with each method that
    /// [`build_best_method`] tries, and stores the best of these methods in the project.
    pub fn build(
        &self,
        loaded: &mut LoadedProject,
        progress: &dyn Progress,
    ) -> Result<Transition, CliError> {
        if !self.is_auto() {
            return loaded.build(progress).map_err(CliError::project_not_built);
        }
        let spec = loaded.spec().map_err(CliError::failed)?;
        let (transition, _) =
            build_best_method(&spec, progress).map_err(CliError::transition_not_built)?;
        loaded.project.warp = Some(transition.method().warp());
        loaded.project.content = Some(transition.method().content());
        Ok(transition)
    }

    /// Builds the transitions of all segments of a project.
    ///
    /// With `--method auto`, uses the method that is best for most segments.
    pub fn build_all(
        &self,
        loaded: &mut LoadedProject,
        progress: &dyn Progress,
    ) -> Result<Sequence, CliError> {
        if !(loaded.project.is_sequence() || loaded.project.follows_path()) {
            return Ok(self.build(loaded, progress)?.into());
        }
        if self.is_auto() {
            let best = best_for_most(loaded, &ProgressSpan::new(progress, 0.0, 0.5))?;
            loaded.project.warp = Some(best.warp());
            loaded.project.content = Some(best.content());
        }
        let segments = loaded.segments();
        let shares = ProgressShares::new(progress, segments.len());
        let transitions = segments.iter().enumerate().map(|(k, segment)| {
            segment
                .build(&shares.part(k))
                .map_err(CliError::project_not_built)
        });
        let built: Vec<_> = transitions.collect::<Result<_, CliError>>()?;
        let sequence = Sequence::new(built);
        let sequence = sequence.unwrap_or_else(|| unreachable!("a sequence has segments"));
        Ok(sequence.closed(loaded.project.ends_where_it_starts()))
    }

    /// Returns whether `--method auto` is given, with which the method is chosen by rating the
    /// resulting films.
    pub fn is_auto(&self) -> bool {
        self.placing.is_auto()
    }

    /// Applies the given flags to a project.
    pub fn edit(&self, project: &mut Project) -> Result<(), CliError> {
        self.placing.edit(project);
        // `placing` applies --method; `cell` applies --warp and --content. Their order does not
        // matter, because the parser rejects the combination.
        self.cell.edit(project)?;
        self.arap.edit(&mut project.options.arap);
        self.paths.edit(&mut project.options.paths);
        self.field.edit(&mut project.options.field);
        self.colours.edit(&mut project.options.colours);
        self.import.edit(project);
        self.timing.edit(&mut project.timing);
        self.style.edit(project);
        // A flag may be valid by itself but invalid in combination with the project.
        let timing = project.timing.check(&project.stops);
        timing.map_err(CliError::usage)?;
        project.options.colours.check().map_err(CliError::usage)?;
        project.options.matching.check().map_err(CliError::usage)?;
        project.options.coats.check().map_err(CliError::usage)?;
        project.options.arap.check().map_err(CliError::usage)
    }
}

/// Chooses the best method for each segment separately with [`build_best_method`], and returns the
/// method chosen most often. Of equally frequent methods, returns the one that occurs first.
fn best_for_most(
    loaded: &LoadedProject,
    progress: &dyn Progress,
) -> Result<TransitionMethod, CliError> {
    let segments = loaded.segments();
    let shares = ProgressShares::new(progress, segments.len());
    let mut counts: Vec<(TransitionMethod, usize)> = Vec::new();
    for (k, segment) in segments.iter().enumerate() {
        let spec = segment.spec().map_err(CliError::failed)?;
        let (transition, _) =
            build_best_method(&spec, &shares.part(k)).map_err(CliError::transition_not_built)?;
        let method = transition.method();
        match counts.iter_mut().find(|(counted, _)| *counted == method) {
            Some((_, count)) => *count += 1,
            None => counts.push((method, 1)),
        }
    }
    let best = counts.into_iter().rev().max_by_key(|(_, count)| *count);
    Ok(best.map_or(TransitionMethod::RIGID_PARTS, |(method, _)| method))
}
