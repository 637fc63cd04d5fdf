//! Every option of a method as a flag, shared by `render`, `check` and `new`.
//!
//! A flag that is not given leaves the project as it is. Names of choices are
//! those of the project file, read from the same tables.
//!
//! - `moving`: the method, its cell, the warps
//! - `showing`: how designs are read, contents, the film and its look

mod appearance;
mod method;

#[cfg(test)]
mod tests;

use clap::Args;

use crate::measure::auto;
use crate::project::{LoadedProject, Project};
use crate::transition::{Sequence, Transition, TransitionMethod};
use crate::work::progress::{Progress, ProgressShares, ProgressSpan};

use super::error::CliError;
use appearance::{ColourArgs, FieldArgs, ImportArgs, StyleArgs, TimingArgs};
use method::{ArapArgs, CellArgs, PathArgs, PlacingArgs};

/// Flags that change a project.
#[derive(Debug, Args)]
pub(super) struct MethodArgs {
    /// Begin what takes longer than ten seconds, or more than two gibibytes, too
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
    /// Builds what a project asks for; of several methods the one whose film is
    /// the least trouble, which the project then asks for.
    pub fn build(
        &self,
        loaded: &mut LoadedProject,
        progress: &dyn Progress,
    ) -> Result<Transition, CliError> {
        if !self.is_auto() {
            return loaded.build(progress).map_err(CliError::no_film);
        }
        let spec = loaded.spec().map_err(CliError::failed)?;
        let (transition, _) = auto(&spec, progress).map_err(CliError::not_built)?;
        loaded.project.warp = Some(transition.cell().warp());
        loaded.project.content = Some(transition.cell().content());
        Ok(transition)
    }

    /// As [`Self::build`], each leg of a sequence; of several methods that which most legs
    /// are the least trouble by.
    pub fn build_all(
        &self,
        loaded: &mut LoadedProject,
        progress: &dyn Progress,
    ) -> Result<Sequence, CliError> {
        if !(loaded.project.is_sequence() || loaded.project.follows_path()) {
            return Ok(self.build(loaded, progress)?.into());
        }
        if self.is_auto() {
            let best = most_often(loaded, &ProgressSpan::new(progress, 0.0, 0.5))?;
            loaded.project.warp = Some(best.warp());
            loaded.project.content = Some(best.content());
        }
        let legs = loaded.legs();
        let shares = ProgressShares::new(progress, legs.len());
        let built = legs.iter().enumerate();
        let built = built.map(|(k, leg)| leg.build(&shares.part(k)).map_err(CliError::no_film));
        let built: Vec<_> = built.collect::<Result<_, CliError>>()?;
        let sequence = Sequence::new(built);
        let sequence = sequence.unwrap_or_else(|| unreachable!("a sequence has legs"));
        Ok(sequence.leading_back(loaded.project.leads_back()))
    }

    /// Whether the films decide on the method.
    pub fn is_auto(&self) -> bool {
        self.placing.is_auto()
    }

    /// Changes what the flags name and leaves the rest.
    pub fn edit(&self, project: &mut Project) -> Result<(), CliError> {
        self.placing.edit(project);
        // After the method: the parser lets nobody give both.
        self.cell.edit(project)?;
        self.arap.edit(&mut project.options.arap);
        self.paths.edit(&mut project.options.paths);
        self.field.edit(&mut project.options.field);
        self.colours.edit(&mut project.options.colours);
        self.import.edit(project);
        self.timing.edit(&mut project.timing);
        self.style.edit(project);
        // A flag may be right by itself and wrong with what the project says.
        let timing = project.timing.check(&project.stops);
        timing.map_err(CliError::usage)?;
        project.options.colours.check().map_err(CliError::usage)?;
        project.options.matching.check().map_err(CliError::usage)?;
        project.options.coats.check().map_err(CliError::usage)?;
        project.options.arap.check().map_err(CliError::usage)
    }
}

/// The cell by which most legs have the film with the least trouble, each for itself; of
/// two the first that was found.
fn most_often(
    loaded: &LoadedProject,
    progress: &dyn Progress,
) -> Result<TransitionMethod, CliError> {
    let legs = loaded.legs();
    let shares = ProgressShares::new(progress, legs.len());
    let mut counts: Vec<(TransitionMethod, usize)> = Vec::new();
    for (k, leg) in legs.iter().enumerate() {
        let spec = leg.spec().map_err(CliError::failed)?;
        let (transition, _) = auto(&spec, &shares.part(k)).map_err(CliError::not_built)?;
        let cell = transition.cell();
        match counts.iter_mut().find(|(known, _)| *known == cell) {
            Some((_, count)) => *count += 1,
            None => counts.push((cell, 1)),
        }
    }
    let best = counts.into_iter().rev().max_by_key(|(_, count)| *count);
    Ok(best.map_or(TransitionMethod::RIGID_PARTS, |(cell, _)| cell))
}
