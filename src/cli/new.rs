//! `morphospace new A B ... --out x.morph`: a project of two designs or more.

use std::path::{Component, Path, PathBuf};

use clap::Args;

use crate::design::DesignSource;
use crate::project::{LoadedProject, Project};
use crate::transition::TransitionSpec;

use super::error::CliError;
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;

#[derive(Debug, Args)]
pub(super) struct NewArgs {
    /// The design at t = 0
    #[arg(value_name = "A")]
    source: PathBuf,

    /// The design at t = 1
    #[arg(value_name = "B")]
    target: PathBuf,

    /// Further designs, each at the next whole t
    #[arg(value_name = "...")]
    more: Vec<PathBuf>,

    /// The project to write; designs are named relative to its folder
    #[arg(long, value_name = "PATH.morph")]
    out: PathBuf,

    /// Write over a project that is there already
    #[arg(long)]
    force: bool,

    /// Look for the film now and keep it with the project, which then opens at
    /// once and plays the same film everywhere
    #[arg(long)]
    film: bool,

    #[command(flatten)]
    method: MethodArgs,
}

pub(super) fn run(args: &NewArgs) -> Result<(), CliError> {
    if !Project::is_named(&args.out) {
        let path = args.out.display();
        return Err(CliError::Usage(format!(
            "`{path}` is no project: end --out in .morph"
        )));
    }
    if args.out.exists() && !args.force {
        let path = args.out.display();
        return Err(CliError::Failed(format!(
            "`{path}` is there already: choose another name, or add --force to write over it"
        )));
    }
    write(args)
}

fn write(args: &NewArgs) -> Result<(), CliError> {
    let folder = folder_of(&args.out);
    let designs = [&args.source, &args.target].into_iter().chain(&args.more);
    let designs = designs.map(|path| named_from(path, folder));
    let mut project = Project::of(designs.collect::<Result<Vec<_>, _>>()?);
    args.method.edit(&mut project)?;
    // A project that cannot be opened is of no use; say so now.
    let loaded = LoadedProject::load(project, Some(folder.to_owned()));
    let mut loaded = loaded.map_err(CliError::failed)?;
    loaded.patient = args.method.patient;
    for leg in loaded.legs() {
        let spec = leg.spec().map_err(CliError::failed)?;
        let available = TransitionSpec::available(spec.cell, &spec.source, &spec.target);
        available.map_err(CliError::failed)?;
    }
    // From here on a signal waits: it would leave a half-written file.
    let terminal = Terminal::new();
    if args.film || args.method.is_auto() {
        let sequence = args.method.build_all(&mut loaded, &terminal)?;
        for (k, leg) in sequence.legs().iter().enumerate().filter(|_| args.film) {
            let found = leg.found().unwrap_or_default();
            loaded.project.keep_found(k, found);
        }
    }
    let saved = loaded.project.save_atomically(&args.out);
    saved.map_err(CliError::failed)?;
    output::words(&format!("wrote {}", args.out.display()));
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        // A bare name has an empty parent, which is no folder to the system.
        _ => Path::new("."),
    }
}

/// A design as a project in a folder names it.
fn named_from(path: &Path, folder: &Path) -> Result<PathBuf, CliError> {
    let source = DesignSource::of(path);
    let Some(file) = source.file() else {
        return Ok(source.to_path());
    };
    let file = relative(file, folder)?;
    Ok(source.at(|_| file).to_path())
}

/// The way to a file from a folder; absolute where they share no root.
fn relative(path: &Path, folder: &Path) -> Result<PathBuf, CliError> {
    // Without links and dots, or `..` would lead elsewhere than it seems to.
    let [path, folder] = [absolute(path)?, absolute(folder)?];
    let shared = path.components().zip(folder.components());
    let shared = shared.take_while(|(a, b)| a == b).count();
    // Two drives of Windows.
    if shared == 0 {
        return Ok(path);
    }
    let up = folder
        .components()
        .skip(shared)
        .map(|_| Component::ParentDir);
    Ok(up.chain(path.components().skip(shared)).collect())
}

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
    fn paths_lead_from_the_project_to_the_design() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |path: &str| folder.path().join(path);
        fs::create_dir_all(at("a/b")).expect("made");
        fs::create_dir_all(at("c")).expect("made");
        fs::write(at("a/x.svg"), b"").expect("written");
        let way = |from: &str| relative(&at("a/x.svg"), &at(from)).expect("a way");
        assert_eq!(way("a"), Path::new("x.svg"));
        assert_eq!(way("a/b"), Path::new("../x.svg"));
        assert_eq!(way("c"), Path::new("../a/x.svg"));
        assert!(relative(&at("missing.svg"), &at("a")).is_err());
        let written = format!("{}#stalk", at("a/x.svg").display());
        let named = |written: &str| named_from(written.as_ref(), &at("c")).expect("a name");
        assert_eq!(named(&written), Path::new("../a/x.svg#stalk"));
        assert_eq!(named("glyph:%40"), Path::new("glyph:%40"));
    }
}
