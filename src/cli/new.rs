//! `morphospace new A B ... --out x.morph`: writes a project file for two or more designs.

use std::path::{Component, Path, PathBuf};

use clap::Args;

use crate::design::DesignSource;
use crate::project::{LoadedProject, Project, ProjectError};
use crate::transition::TransitionSpec;

use super::error::CliError;
use super::input_files::InputFiles;
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// Design at t = 0
    #[arg(value_name = "A")]
    source: PathBuf,

    /// Design at t = 1
    #[arg(value_name = "B")]
    target: PathBuf,

    /// More designs, one at each further whole t
    #[arg(value_name = "...")]
    more: Vec<PathBuf>,

    /// Project file to write; paths of designs are stored relative to its folder
    #[arg(long, value_name = "PATH.morph")]
    out: PathBuf,

    /// Overwrite an existing project
    #[arg(long)]
    force: bool,

    /// Also solve the match and store it in the project, which then opens at once
    /// and plays the same film everywhere
    #[arg(long)]
    film: bool,

    #[command(flatten)]
    method: MethodArgs,
}

pub(super) fn run(args: &NewArgs) -> Result<(), CliError> {
    if !Project::has_document_extension(&args.out) {
        let path = args.out.display();
        return Err(CliError::Usage(format!(
            "`{path}` is not a project: end --out in .morph"
        )));
    }
    if args.out.exists() && !args.force {
        return Err(not_saved(ProjectError::AlreadyExists(args.out.clone())));
    }
    write(args)
}

fn write(args: &NewArgs) -> Result<(), CliError> {
    let folder = folder_of(&args.out);
    let designs = [&args.source, &args.target].into_iter().chain(&args.more);
    let paths = designs.clone().map(PathBuf::as_path);
    let inputs = InputFiles::default().with_designs(Path::new(""), paths);
    inputs.check_outputs([&args.out])?;
    let designs = designs.map(|path| stored_path(path, folder));
    let mut project = Project::from_paths(designs.collect::<Result<Vec<_>, _>>()?);
    args.method.edit(&mut project)?;
    // The designs are read and checked first, so that no unusable project is written.
    let loaded = LoadedProject::load(project, Some(folder.to_owned()));
    let mut loaded = loaded.map_err(CliError::failed)?;
    loaded.patient = args.method.patient;
    loaded.adopt_drawn_colours();
    for segment in loaded.segments() {
        let spec = segment.spec().map_err(CliError::failed)?;
        let available = TransitionSpec::available(spec.method, &spec.source, &spec.target);
        available.map_err(CliError::failed)?;
    }
    // From here on, a signal cancels the work instead of ending the program, so that it cannot
    // interrupt the writing of the file.
    let terminal = Terminal::new();
    if args.film || args.method.is_auto() {
        let sequence = args.method.build_all(&mut loaded, &terminal)?;
        for (k, segment) in sequence.segments().iter().enumerate().filter(|_| args.film) {
            let cached = segment.cached_match().unwrap_or_default();
            loaded.project.cache_match(k, cached);
        }
    }
    let saved = match args.force {
        true => loaded.project.save_atomically(&args.out).map(drop),
        // Another process may have written the file while the designs were read.
        false => loaded.project.save_new(&args.out),
    };
    saved.map_err(not_saved)?;
    output::message(&format!("wrote {}", args.out.display()));
    Ok(())
}

/// Creates the error for a project that was not saved; for an existing file, suggests `--force`.
fn not_saved(error: ProjectError) -> CliError {
    match error {
        ProjectError::AlreadyExists(_) => {
            CliError::Failed(format!("{error}, or add --force to overwrite it"))
        }
        error => CliError::failed(error),
    }
}

/// Returns the folder that contains `path`.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        // The parent of a bare file name is the empty path, which is not a valid folder.
        _ => Path::new("."),
    }
}

/// Returns the path of a design as a project in `folder` stores it.
fn stored_path(path: &Path, folder: &Path) -> Result<PathBuf, CliError> {
    let source = DesignSource::from_path(path);
    let Some(file) = source.file() else {
        return Ok(source.to_path());
    };
    let file = relative(file, folder)?;
    Ok(source.map_file(|_| file).to_path())
}

/// Returns the path of a file relative to a folder; absolute if they have no common root.
fn relative(path: &Path, folder: &Path) -> Result<PathBuf, CliError> {
    // Both paths are made canonical, because `..` after a symbolic link would lead to another
    // folder.
    let [path, folder] = [absolute(path)?, absolute(folder)?];
    let shared = path.components().zip(folder.components());
    let shared = shared.take_while(|(a, b)| a == b).count();
    // Files on different drives of Windows have no common root.
    if shared == 0 {
        return Ok(path);
    }
    let up = folder
        .components()
        .skip(shared)
        .map(|_| Component::ParentDir);
    Ok(up.chain(path.components().skip(shared)).collect())
}

/// Returns the absolute path of an existing file, with symbolic links resolved.
fn absolute(path: &Path) -> Result<PathBuf, CliError> {
    path.canonicalize().map_err(|error| {
        let path = path.display();
        CliError::Failed(format!("`{path}`: {error}; check the name"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn paths_are_stored_relative_to_the_project() {
        let folder = tempfile::tempdir().expect("a folder");
        let path_in = |path: &str| folder.path().join(path);
        fs::create_dir_all(path_in("a/b")).expect("created");
        fs::create_dir_all(path_in("c")).expect("created");
        fs::write(path_in("a/x.svg"), b"").expect("written");
        let from = |folder: &str| relative(&path_in("a/x.svg"), &path_in(folder)).expect("a path");
        assert_eq!(from("a"), Path::new("x.svg"));
        assert_eq!(from("a/b"), Path::new("../x.svg"));
        assert_eq!(from("c"), Path::new("../a/x.svg"));
        assert!(relative(&path_in("missing.svg"), &path_in("a")).is_err());
        let element = format!("{}#stalk", path_in("a/x.svg").display());
        let stored = |path: &str| stored_path(path.as_ref(), &path_in("c")).expect("a path");
        assert_eq!(stored(&element), Path::new("../a/x.svg#stalk"));
        assert_eq!(stored("glyph:%40"), Path::new("glyph:%40"));
    }
}
