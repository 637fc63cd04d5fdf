//! Input arguments of the subcommands: a project, a bundled project, or two or more designs.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::Args;

use crate::design::{DesignSource, Format};
use crate::project::{LoadedProject, Project, gallery};
use crate::space::DesignSpace;
use crate::transition::{Sequence, Transition};
use crate::work::progress::{Progress, ProgressSpan, checkpoint, run_cancellable};

use super::error::CliError;
use super::input_files::InputFiles;
use super::options::MethodArgs;

/// Progress reported once the designs are read, in [0, 1] (heuristic).
const READ_FRACTION: f64 = 0.1;

#[derive(Clone, Debug, Args)]
pub(super) struct InputArgs {
    #[arg(value_name = "PROJECT | A B ...", num_args = 1.., required = true, help = help())]
    inputs: Vec<PathBuf>,
}

/// Returns the help text of the input arguments, with the file extensions of all formats.
fn help() -> String {
    format!(
        "A project (.morph, or gallery:NAME), or two or more designs in order: files ({}), elements \
         of a drawing (drawing.svg#ID) or text (glyph:D, or glyph:D@FONT.ttf)",
        Format::or_list_of_names(&Format::ALL)
    )
}

/// A project with the flags applied, whose designs have not been read yet.
#[derive(Debug)]
pub(super) struct InputProject<'a> {
    /// The project with the flags applied.
    pub project: Project,
    /// The files that the command reads: the project, its designs and their fonts.
    pub files: InputFiles,
    /// Folder to which the paths of the designs are relative; `None` for a bundled project.
    folder: Option<PathBuf>,
    /// Whether the inputs are designs instead of a project.
    are_designs: bool,
    method: &'a MethodArgs,
    /// Time at which reading the inputs began.
    start: Instant,
}

/// A project with its designs and built transitions.
#[derive(Debug)]
pub(super) struct OpenedProject {
    /// The project with the flags applied, and its designs.
    pub loaded: LoadedProject,
    /// The built transitions of all segments.
    pub sequence: Sequence,
}

/// One segment of a film with its built transition, and the times that import and build took.
#[derive(Debug)]
pub(super) struct OpenedPair {
    /// The segment with the flags applied, and its designs.
    pub loaded: LoadedProject,
    /// The built transition.
    pub transition: Transition,
    /// Measured time for reading the project and importing all designs of the film; the same for
    /// each segment.
    pub import_time: Duration,
    /// Measured time for aligning the designs of this segment and building its transition.
    pub build_time: Duration,
}

impl OpenedPair {
    /// Returns the title of the project; for a segment of a longer film, the names of its two
    /// designs.
    pub fn title(&self) -> String {
        match self.loaded.is_segment() {
            true => self.loaded.stop_names().join(" to "),
            false => self.loaded.title(),
        }
    }
}

impl InputArgs {
    /// Creates the inputs for two designs.
    pub fn pair(source: &Path, target: &Path) -> Self {
        let inputs = vec![source.to_owned(), target.to_owned()];
        Self { inputs }
    }

    /// Reads the project without its designs, and applies the flags.
    pub fn read<'a>(
        &self,
        method: &'a MethodArgs,
        progress: &dyn Progress,
    ) -> Result<InputProject<'a>, CliError> {
        let start = Instant::now();
        checkpoint(progress, "reading", 0.0).map_err(CliError::failed)?;
        // Reading a pipe may block forever, so the input is read on another thread, which allows
        // cancellation.
        let inputs = self.clone();
        let document = run_cancellable(progress, move || inputs.document());
        let (mut project, folder) = document.map_err(CliError::failed)??;
        method.edit(&mut project)?;
        let are_designs = self.inputs.len() > 1;
        let mut files = InputFiles::default();
        if let ([path], Some(_)) = (self.inputs.as_slice(), &folder) {
            files = files.with_file(path);
        }
        if let Some(folder) = &folder {
            let designs = project.designs.iter().map(|entry| entry.path.as_path());
            files = files.with_designs(folder, designs);
        }
        Ok(InputProject {
            project,
            files,
            folder,
            are_designs,
            method,
            start,
        })
    }

    /// Returns the project and the folder to which its paths are relative; no folder for a bundled
    /// project.
    fn document(&self) -> Result<(Project, Option<PathBuf>), CliError> {
        let path = match self.inputs.as_slice() {
            [path] => path,
            many if many
                .iter()
                .any(|path| Project::has_document_extension(path)) =>
            {
                return Err(CliError::Usage(format!(
                    "{} inputs include a project: give a single project, or two or more designs",
                    many.len()
                )));
            }
            designs => return Ok((Project::from_paths(designs), Some(PathBuf::new()))),
        };
        if let Some(name) = path.to_str().and_then(|path| path.strip_prefix("gallery:")) {
            let project = gallery::document(name).map_err(CliError::failed)?;
            return Ok((project, None));
        }
        if is_design(path) {
            let path = path.display();
            return Err(CliError::Usage(format!(
                "`{path}` is a single design: add a second one, or give a .morph project"
            )));
        }
        let project = Project::read(path).map_err(CliError::failed)?;
        // A file that could be read has a parent folder, so this is never `None`.
        Ok((project, path.parent().map(Path::to_owned)))
    }
}

impl InputProject<'_> {
    /// Reads the designs and builds all segments.
    pub fn open(self, progress: &dyn Progress) -> Result<OpenedProject, CliError> {
        let method = self.method;
        let mut loaded = self.load(progress)?;
        let building = ProgressSpan::new(progress, READ_FRACTION, 1.0);
        let sequence = method.build_all(&mut loaded, &building)?;
        Ok(OpenedProject { loaded, sequence })
    }

    /// Reads the designs, and passes each segment to `take` once it is built.
    pub fn open_each(
        self,
        progress: &dyn Progress,
        mut take: impl FnMut(OpenedPair) -> Result<(), CliError>,
    ) -> Result<(), CliError> {
        let (method, start) = (self.method, self.start);
        let loaded = self.load(progress)?;
        // Aligning the designs in common coordinates counts as part of the build time.
        let import_time = start.elapsed();
        let building = ProgressSpan::new(progress, READ_FRACTION, 1.0);
        for mut segment in loaded.segments() {
            let start = Instant::now();
            let transition = method.build(&mut segment, &building)?;
            take(OpenedPair {
                loaded: segment,
                transition,
                import_time,
                build_time: start.elapsed(),
            })?;
        }
        Ok(())
    }

    /// Reads the designs, and builds the space of all of them.
    ///
    /// Also returns the time that building the space took.
    pub fn open_space(
        self,
        progress: &dyn Progress,
    ) -> Result<(LoadedProject, DesignSpace, Duration), CliError> {
        let loaded = self.load(progress)?;
        let start = Instant::now();
        let building = ProgressSpan::new(progress, READ_FRACTION, 1.0);
        let space = loaded.build_space(None, &building);
        let space = space.map_err(CliError::project_not_built)?;
        Ok((loaded, space, start.elapsed()))
    }

    /// Reads the designs.
    fn load(self, progress: &dyn Progress) -> Result<LoadedProject, CliError> {
        let Self {
            project, folder, ..
        } = self;
        let loaded = run_cancellable(progress, move || LoadedProject::load(project, folder));
        let mut loaded = loaded
            .map_err(CliError::failed)?
            .map_err(CliError::failed)?;
        loaded.patient = self.method.patient;
        if self.are_designs {
            loaded.adopt_drawn_colours();
        }
        Ok(loaded)
    }
}

/// Returns whether a path refers to a design, not to a project.
fn is_design(path: &Path) -> bool {
    match DesignSource::from_path(path) {
        DesignSource::File {
            path,
            element: None,
        } => Format::ALL
            .iter()
            .any(|format| format.matches_extension(&path)),
        _ => true,
    }
}
