//! What to work on: a project, a bundled project, or two designs.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;

use crate::design::{Format, Source};
use crate::progress::Progress;
use crate::project::{LoadedProject, Project, gallery};
use crate::transition::Transition;

use super::error::CliError;
use super::options::MethodArgs;

#[derive(Debug, Args)]
pub(super) struct Inputs {
    #[arg(value_name = "PROJECT | A B", num_args = 1..=2, required = true, help = help())]
    inputs: Vec<PathBuf>,
}

fn help() -> String {
    format!(
        "A project (.morph, or gallery:NAME), or two designs: files ({}), an element of a \
         drawing (drawing.svg#ID) or text (glyph:D, or glyph:D@FONT.ttf)",
        Format::listed(&Format::ALL)
    )
}

/// A project that is ready to be played, and how long that took.
#[derive(Debug)]
pub(super) struct Opened {
    /// The project with the flags applied, and its designs.
    pub loaded: LoadedProject,
    /// What it shows.
    pub transition: Transition,
    /// For reading and importing the designs.
    pub import_time: Duration,
    /// For building the transition.
    pub build_time: Duration,
}

impl Inputs {
    /// Reads, imports, applies the flags and builds.
    pub fn open(&self, method: &MethodArgs, progress: &dyn Progress) -> Result<Opened, CliError> {
        let start = Instant::now();
        let loaded = self.load(method)?;
        Opened::build(loaded, start.elapsed(), progress)
    }

    fn load(&self, method: &MethodArgs) -> Result<LoadedProject, CliError> {
        match self.inputs.as_slice() {
            [source, target] => pair(source, target, method),
            [project] => match gallery_name(project) {
                Some(name) => bundled(name, method),
                None => from_file(project, method),
            },
            _ => Err(CliError::Usage("give a project or two designs".to_owned())),
        }
    }
}

impl Opened {
    /// Reads two designs, applies the flags and builds.
    pub fn pair(
        [source, target]: [&Path; 2],
        method: &MethodArgs,
        progress: &dyn Progress,
    ) -> Result<Self, CliError> {
        let start = Instant::now();
        let loaded = pair(source, target, method)?;
        Self::build(loaded, start.elapsed(), progress)
    }

    fn build(
        loaded: LoadedProject,
        import_time: Duration,
        progress: &dyn Progress,
    ) -> Result<Self, CliError> {
        let spec = loaded.spec().map_err(CliError::failed)?;
        let start = Instant::now();
        let transition = Transition::build(&spec, progress).map_err(CliError::failed)?;
        Ok(Opened {
            loaded,
            transition,
            import_time,
            build_time: start.elapsed(),
        })
    }
}

fn pair(source: &Path, target: &Path, method: &MethodArgs) -> Result<LoadedProject, CliError> {
    let project = edited(Project::pair(source, target), method)?;
    LoadedProject::load(project, PathBuf::new()).map_err(CliError::failed)
}

fn from_file(path: &Path, method: &MethodArgs) -> Result<LoadedProject, CliError> {
    if is_design(path) {
        let path = path.display();
        return Err(CliError::Usage(format!(
            "`{path}` is one design: give a second one, or a .morph project"
        )));
    }
    let project = Project::read(path).map_err(CliError::failed)?;
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    LoadedProject::load(edited(project, method)?, folder).map_err(CliError::failed)
}

/// One of them alone is half a pair.
fn is_design(path: &Path) -> bool {
    let Source::File {
        path,
        element: None,
    } = Source::of(path)
    else {
        return true;
    };
    Format::ALL.iter().any(|format| format.ends(&path))
}

fn bundled(name: &str, method: &MethodArgs) -> Result<LoadedProject, CliError> {
    let project = gallery::document(name).map_err(CliError::failed)?;
    gallery::load_document(edited(project, method)?).map_err(CliError::failed)
}

fn edited(mut project: Project, method: &MethodArgs) -> Result<Project, CliError> {
    method.edit(&mut project)?;
    Ok(project)
}

fn gallery_name(path: &Path) -> Option<&str> {
    path.to_str()?.strip_prefix("gallery:")
}
