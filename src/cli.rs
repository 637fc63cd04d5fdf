//! The command line: parses the arguments and runs the subcommands, one file each.
//!
//! Data goes to stdout, messages go to stderr. The exit code is 0 for success, 1 for failure and 2
//! for wrong usage; a closed pipe at stdout ends the program silently with 0. Subcommands need no
//! graphics card and no display. The window is opened by `main`, not here.

mod catalogue;
mod check;
mod error;
mod gallery;
mod input_files;
mod inputs;
mod laboratory;
mod new;
mod options;
mod output;
mod render;
mod structure;
mod terminal;
mod value_parsers;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

use crate::design::DesignSource;

use error::CliError;

/// Examples shown at the end of `--help`.
const EXAMPLES: &str = "\
Examples:
  morphospace                                   the gallery, in a window
  morphospace a.svg b.svg                       a pair, in a window
  morphospace --present talk.morph              a talk, full screen
  morphospace render a.svg b.svg --out film.gif
  morphospace render bridge.morph --at 0.5 --out half.svg
  morphospace render gallery:letters --sheet 7 --out sheet.png
  morphospace render bridge.morph --out 'frames/f-####.png' --frames-range 0..60
  morphospace render a.svg b.svg c.svg d.svg --map 9x9 --out map.png
  morphospace catalogue bottles.morph --out saved
  morphospace check bridge.morph --json
  morphospace check girder.json arch.json --structure
  morphospace check --pairs pairs.csv --out report.csv --sheet sheet.png";

/// Explore the space between designs.
#[derive(Debug, Parser)]
#[command(
    name = "morphospace",
    version,
    args_conflicts_with_subcommands = true,
    after_help = EXAMPLES
)]
struct Cli {
    #[command(flatten)]
    window: WindowRequest,

    #[command(subcommand)]
    command: Option<CliCommand>,
}

#[derive(Debug, Subcommand)]
enum CliCommand {
    /// Write an image, a contact sheet, a map of blends, numbered images or an animation
    Render(Box<render::RenderArgs>),
    /// Measure the quality of a transition, of each pair in a table, or of blends of many designs
    Check(Box<check::CheckArgs>),
    /// Write a project file
    New(Box<new::NewArgs>),
    /// Write the blends that were saved on a project's map of designs, as SVG and DXF files
    Catalogue(Box<catalogue::CatalogueArgs>),
    /// List the bundled projects
    Gallery(gallery::GalleryArgs),
}

/// Arguments for opening the window: those of a command line without a subcommand.
#[derive(Args, Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowRequest {
    /// A project (.morph, or gallery:NAME), or two or more designs, to open in the window
    #[arg(value_name = "FILE", num_args = 0..)]
    pub files: Vec<PathBuf>,

    /// Folder in which the window saves images and films [default: the pictures folder]
    #[arg(long, value_name = "DIR")]
    pub captures: Option<PathBuf>,

    /// Maximum memory of a film that is computed in advance, in MiB; larger films are computed
    /// frame by frame while they play [default: 512]
    #[arg(long, value_name = "MIB")]
    pub film_memory: Option<usize>,

    /// Start a talk at once: full screen, only the drawing, from the first stop; Esc ends it
    #[arg(long, requires = "files")]
    pub present: bool,
}

/// How the program continues after the command line was processed.
#[derive(Debug)]
pub enum LaunchOutcome {
    /// Open the window.
    Window(WindowRequest),
    /// Exit with this code.
    Done(ExitCode),
}

/// Parses the command line (program name first) and runs the subcommand, if there is one.
///
/// Does not open the window: the caller does, if [`LaunchOutcome::Window`] is returned. On Unix,
/// blocks SIGXFSZ in this thread and all threads it starts, so that exceeding the file-size limit
/// (`ulimit -f`) is a write error and does not kill the program.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> LaunchOutcome {
    #[cfg(unix)]
    terminal::block_file_size_signal();
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    match Cli::try_parse_from(&arguments) {
        Ok(cli) => match cli.command {
            None if cli.window.files.len() > 2 && !cli.window.names_files() => {
                let error = unknown_command(&cli.window.files[0]);
                LaunchOutcome::Done(output::exit_code(Err(error)))
            }
            None => LaunchOutcome::Window(cli.window),
            Some(command) => LaunchOutcome::Done(output::exit_code(execute(&command))),
        },
        // `--help` and `--version` are returned as errors, too.
        Err(error) => LaunchOutcome::Done(output::print_usage(&error, &arguments)),
    }
}

impl WindowRequest {
    /// Returns whether the first argument looks like a design or a project. If not, it may be a
    /// misspelt subcommand.
    fn names_files(&self) -> bool {
        let first = self.files.first();
        first.is_some_and(|first| {
            let is_file = matches!(DesignSource::from_path(first), DesignSource::File { .. });
            !is_file || first.extension().is_some() || first.exists()
        })
    }
}

/// Creates the usage error for a first argument that is neither a subcommand nor a file.
fn unknown_command(first: &Path) -> CliError {
    CliError::Usage(format!(
        "`{}` is neither a subcommand nor a file; see `morphospace --help`",
        first.display()
    ))
}

fn execute(command: &CliCommand) -> Result<(), CliError> {
    match command {
        CliCommand::Render(args) => render::run(args),
        CliCommand::Check(args) => check::run(args),
        CliCommand::New(args) => new::run(args),
        CliCommand::Catalogue(args) => catalogue::run(args),
        CliCommand::Gallery(args) => gallery::run(args),
    }
}

/// Prints why the window could not be opened, and returns the exit code.
pub fn report_window_error(error: impl std::error::Error) -> ExitCode {
    output::exit_code(Err(CliError::failed(error)))
}

/// Prints that this build has no window, and returns the exit code.
pub fn report_no_window_support() -> ExitCode {
    output::exit_code(Err(CliError::Usage(
        "this build has no window: use a subcommand (see --help), or build it with `--features app`".to_owned(),
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_argument_definitions_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn check_takes_either_inputs_or_a_table() {
        let parse = |line: &str| Cli::try_parse_from(line.split(' '));
        for (line, missing) in [
            ("x check", "PROJECT"),
            ("x check --pairs t.csv", "--out"),
            ("x check --out r.csv", "--pairs"),
            ("x check a b --out r.csv", "--pairs"),
            ("x check a b --both", "--pairs"),
        ] {
            let error = parse(line).expect_err(line).to_string();
            assert!(error.contains(missing), "{line}: {error}");
        }
        assert!(parse("x check --pairs t.csv --out r.csv --samples 3").is_ok());
        let with_both = parse("x check a b --pairs t.csv --out r.csv").expect("parsed");
        let result = execute(&with_both.command.expect("a check"));
        assert!(matches!(result, Err(CliError::Usage(message)) if message.contains("--pairs")));
    }

    #[test]
    fn files_open_the_window() {
        let line = "morphospace a.svg b.svg --captures x --film-memory 64";
        let launch = run(line.split(' ').map(OsString::from));
        let LaunchOutcome::Window(request) = launch else {
            panic!("{launch:?}");
        };
        assert_eq!(request.files, ["a.svg", "b.svg"].map(PathBuf::from));
        assert_eq!(request.captures, Some("x".into()));
        assert_eq!(request.film_memory, Some(64));
    }
}
