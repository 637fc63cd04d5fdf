//! What to work on: a project, a bundled project, or two designs and more.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;

use crate::design::{DesignSource, Format};
use crate::project::{LoadedProject, Project, gallery};
use crate::space::DesignSpace;
use crate::transition::{Sequence, Transition};
use crate::work::progress::{Progress, ProgressSpan, beside, checkpoint};

use super::error::CliError;
use super::options::MethodArgs;

/// How much is done once the designs are read, as it is told.
const READ: f64 = 0.1;

#[derive(Clone, Debug, Args)]
pub(super) struct InputArgs {
    #[arg(value_name = "PROJECT | A B ...", num_args = 1.., required = true, help = help())]
    inputs: Vec<PathBuf>,
}

fn help() -> String {
    format!(
        "A project (.morph, or gallery:NAME), or designs, two or more in their order: files ({}), an element of a \
         drawing (drawing.svg#ID) or text (glyph:D, or glyph:D@FONT.ttf)",
        Format::listed(&Format::ALL)
    )
}

/// A project that is ready to be played.
#[derive(Debug)]
pub(super) struct OpenedProject {
    /// The project with the flags applied, and its designs.
    pub loaded: LoadedProject,
    /// What it shows.
    pub sequence: Sequence,
}

/// A project of two designs that is ready to be measured, and how long that took.
#[derive(Debug)]
pub(super) struct OpenedPair {
    /// The project with the flags applied, and its designs.
    pub loaded: LoadedProject,
    /// What it shows.
    pub transition: Transition,
    /// For reading and importing the designs.
    pub import_time: Duration,
    /// For building the transition.
    pub build_time: Duration,
}

impl OpenedPair {
    /// What it is called: a leg of a sequence by its designs.
    pub fn title(&self) -> String {
        match self.loaded.is_leg() {
            true => self.loaded.names_on_the_way().join(" to "),
            false => self.loaded.title(),
        }
    }
}

impl InputArgs {
    /// Two designs.
    pub fn pair(source: &Path, target: &Path) -> Self {
        let inputs = vec![source.to_owned(), target.to_owned()];
        Self { inputs }
    }

    /// Reads, imports, applies the flags and builds.
    pub fn open(
        &self,
        method: &MethodArgs,
        progress: &dyn Progress,
    ) -> Result<OpenedProject, CliError> {
        let mut loaded = self.load(method, progress)?;
        let building = ProgressSpan::new(progress, READ, 1.0);
        let sequence = method.build_all(&mut loaded, &building)?;
        Ok(OpenedProject { loaded, sequence })
    }

    /// Reads, imports and applies the flags; builds each leg apart, and hands it over.
    pub fn open_each(
        &self,
        method: &MethodArgs,
        progress: &dyn Progress,
        mut take: impl FnMut(OpenedPair) -> Result<(), CliError>,
    ) -> Result<(), CliError> {
        let start = Instant::now();
        let loaded = self.load(method, progress)?;
        // Laying the designs in one frame belongs to neither time.
        let import_time = start.elapsed();
        let building = ProgressSpan::new(progress, READ, 1.0);
        for mut leg in loaded.legs() {
            let start = Instant::now();
            let transition = method.build(&mut leg, &building)?;
            take(OpenedPair {
                loaded: leg,
                transition,
                import_time,
                build_time: start.elapsed(),
            })?;
        }
        Ok(())
    }

    /// Reads, imports and applies the flags; builds the space of all designs, and says how
    /// long that took.
    pub fn open_space(
        &self,
        method: &MethodArgs,
        progress: &dyn Progress,
    ) -> Result<(LoadedProject, DesignSpace, Duration), CliError> {
        let loaded = self.load(method, progress)?;
        let start = Instant::now();
        let building = ProgressSpan::new(progress, READ, 1.0);
        let space = loaded.built_space(None, &building);
        let space = space.map_err(CliError::no_film)?;
        Ok((loaded, space, start.elapsed()))
    }

    fn load(
        &self,
        method: &MethodArgs,
        progress: &dyn Progress,
    ) -> Result<LoadedProject, CliError> {
        checkpoint(progress, "reading", 0.0).map_err(CliError::failed)?;
        // A pipe that nobody writes to is read for ever: beside, so that a
        // cancel is answered.
        let inputs = self.clone();
        let document = beside(progress, move || inputs.document());
        let (mut project, folder) = document.map_err(CliError::failed)??;
        method.edit(&mut project)?;
        let loaded = beside(progress, move || LoadedProject::load(project, folder));
        let mut loaded = loaded
            .map_err(CliError::failed)?
            .map_err(CliError::failed)?;
        loaded.patient = method.patient;
        Ok(loaded)
    }

    /// The document, and what its paths are relative to: nothing if it is
    /// bundled.
    fn document(&self) -> Result<(Project, Option<PathBuf>), CliError> {
        let path = match self.inputs.as_slice() {
            [path] => path,
            many if many.iter().any(|path| Project::is_named(path)) => {
                return Err(CliError::Usage(format!(
                    "{} inputs are given: give one project alone, or designs",
                    many.len()
                )));
            }
            designs => return Ok((Project::of(designs), Some(PathBuf::new()))),
        };
        if let Some(name) = path.to_str().and_then(|path| path.strip_prefix("gallery:")) {
            let project = gallery::document(name).map_err(CliError::failed)?;
            return Ok((project, None));
        }
        if is_design(path) {
            let path = path.display();
            return Err(CliError::Usage(format!(
                "`{path}` is one design: give a second one, or a .morph project"
            )));
        }
        let project = Project::read(path).map_err(CliError::failed)?;
        // A file that could be read lies in a folder, so that this is never None.
        Ok((project, path.parent().map(Path::to_owned)))
    }
}

/// One of them alone is half a pair.
fn is_design(path: &Path) -> bool {
    match DesignSource::of(path) {
        DesignSource::File {
            path,
            element: None,
        } => Format::ALL.iter().any(|format| format.ends(&path)),
        _ => true,
    }
}
