//! Data to stdout, words to stderr, and exit codes.

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use serde::Serialize;

use crate::one_line::{OneLine, is_hidden};

use super::error::CliError;

const FAILED: u8 = 1;
const WRONG_USE: u8 = 2;

/// Writes data to stdout.
pub(super) fn data(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout().lock();
    stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
        .map_err(CliError::Stdout)
}

/// A value as JSON for [`data`].
pub(super) fn json(value: &impl Serialize) -> Result<String, CliError> {
    // By way of a value, whose keys are in alphabetical order.
    let value = serde_json::to_value(value).map_err(CliError::failed)?;
    Ok(format!("{value:#}\n"))
}

/// Writes a line of words to stderr, whatever has come into them. Where even
/// that fails, nobody listens.
pub(super) fn words(line: &str) {
    writeln!(io::stderr().lock(), "{}", OneLine(line)).unwrap_or_default();
}

/// Tells how a command ended.
pub(super) fn exit_code(result: Result<(), CliError>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // A reader that had enough (`| head`) is no failure.
        Err(CliError::Stdout(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => {
            words(&format!("morphospace: {error}"));
            let is_usage = matches!(error, CliError::Usage(_));
            ExitCode::from(if is_usage { WRONG_USE } else { FAILED })
        }
    }
}

/// Shows help, version or what was wrong about the arguments.
pub(super) fn say_usage(error: &clap::Error, arguments: &[OsString]) -> ExitCode {
    if !error.use_stderr() {
        return exit_code(data(&error.render().to_string()));
    }
    // The parser quotes arguments as they are, and its colours are escape
    // sequences: beside others of the kind there can be none.
    let acts = |argument: &OsString| argument.to_string_lossy().contains(is_hidden);
    if arguments.iter().any(acts) {
        error.render().to_string().lines().for_each(words);
    } else {
        // In colours where stderr is a terminal and nobody forbids them.
        error.print().unwrap_or_default();
    }
    ExitCode::from(WRONG_USE)
}
