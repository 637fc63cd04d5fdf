//! The command line: a file for each subcommand.
//!
//! Guarantees: stdout carries data and stderr words; the exit code is 0 for
//! done, 1 for failed and 2 for wrong use; a reader that closes the pipe ends
//! the program quietly. No subcommand needs a graphics card or a display; the
//! window alone does, and is opened by `main`, not here.

mod catalogue;
mod check;
mod error;
mod gallery;
mod inputs;
mod laboratory;
mod new;
mod options;
mod output;
mod render;
mod terminal;
mod value_parsers;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

use crate::design::DesignSource;

use error::CliError;

const EXAMPLES: &str = "\
Examples:
  morphospace                                   the gallery, in a window
  morphospace a.svg b.svg                       a pair, in a window
  morphospace --present talk.morph              a talk, on the whole screen
  morphospace render a.svg b.svg --out film.gif
  morphospace render bridge.morph --at 0.5 --out half.svg
  morphospace render gallery:letters --sheet 7 --out sheet.png
  morphospace render bridge.morph --out 'frames/f-####.png' --frames-range 0..60
  morphospace render a.svg b.svg c.svg d.svg --map 9x9 --out map.png
  morphospace catalogue bottles.morph --out kept
  morphospace check bridge.morph --json
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
    /// Write a picture, a contact sheet, numbered pictures or a film
    Render(Box<render::RenderArgs>),
    /// Measure a transition: mesh, film, and the time that each stage takes
    Check(Box<check::CheckArgs>),
    /// Write a new project of two designs or more
    New(Box<new::NewArgs>),
    /// Write the places of a project's map that are kept: outlines, a sheet, a table of measures
    Catalogue(Box<catalogue::CatalogueArgs>),
    /// List the bundled projects
    Gallery(gallery::GalleryArgs),
}

/// What the window is to open with.
#[derive(Args, Clone, Debug, Default, PartialEq, Eq)]
pub struct WindowRequest {
    /// A project (.morph, or gallery:NAME), or two designs or more; opened in the window
    #[arg(value_name = "FILE", num_args = 0..)]
    pub files: Vec<PathBuf>,

    /// Folder for pictures taken in the window [default: the pictures folder]
    #[arg(long, value_name = "DIR")]
    pub captures: Option<PathBuf>,

    /// Memory that a film may take, in MiB; frames of a larger one are solved [default: 512]
    #[arg(long, value_name = "MIB")]
    pub film_memory: Option<usize>,

    /// Begin a talk at once: whole screen, nothing but the drawing, from the first stop; Esc ends it
    #[arg(long, requires = "files")]
    pub present: bool,
}

/// What is left to do once the command line is dealt with.
#[derive(Debug)]
pub enum LaunchOutcome {
    /// Open the window.
    Window(WindowRequest),
    /// Nothing: end with this code.
    Done(ExitCode),
}

/// Parses the command line (program name first) and does what it says, apart
/// from opening the window.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> LaunchOutcome {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    match Cli::try_parse_from(&arguments) {
        Ok(cli) => match cli.command {
            None if cli.window.files.len() > 2 && !cli.window.is_of_files() => {
                LaunchOutcome::Done(output::exit_code(Err(no_command(&cli.window.files[0]))))
            }
            None => LaunchOutcome::Window(cli.window),
            Some(command) => LaunchOutcome::Done(output::exit_code(execute(&command))),
        },
        // Help and version come this way, too.
        Err(error) => LaunchOutcome::Done(output::say_usage(&error, &arguments)),
    }
}

impl WindowRequest {
    /// Whether the first word looks like a file, or else may be meant for a subcommand.
    fn is_of_files(&self) -> bool {
        let first = self.files.first();
        first.is_some_and(|first| {
            let is_file = matches!(DesignSource::of(first), DesignSource::File { .. });
            !is_file || first.extension().is_some() || first.exists()
        })
    }
}

/// Why so many words are no designs.
fn no_command(first: &Path) -> CliError {
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

/// Says why there is no window; the exit code of that.
pub fn no_window(why: impl std::error::Error) -> ExitCode {
    output::exit_code(Err(CliError::failed(why)))
}

/// Says that this program was built without its window; the exit code of that.
pub fn without_window() -> ExitCode {
    output::exit_code(Err(CliError::Usage(
        "this build has no window: use `render`, `check`, `new` or `gallery` (see --help), or build it with `--features app`".to_owned(),
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_check_is_of_inputs_or_of_a_table() {
        let parsed = |line: &str| Cli::try_parse_from(line.split(' '));
        for (line, missing) in [
            ("x check", "PROJECT"),
            ("x check --pairs t.csv", "--out"),
            ("x check --out r.csv", "--pairs"),
            ("x check a b --out r.csv", "--pairs"),
            ("x check a b --both", "--pairs"),
        ] {
            let error = parsed(line).expect_err(line).to_string();
            assert!(error.contains(missing), "{line}: {error}");
        }
        assert!(parsed("x check --pairs t.csv --out r.csv --samples 3").is_ok());
        let both = parsed("x check a b --pairs t.csv --out r.csv").expect("parsed");
        let refused = execute(&both.command.expect("a check"));
        assert!(matches!(refused, Err(CliError::Usage(said)) if said.contains("--pairs")));
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
