//! Output of the subcommands: data to stdout, messages to stderr, and exit codes.

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use serde::Serialize;

use crate::io::escape::escaped_json;
use crate::io::sanitize::{SanitizedLine, is_hidden};

use super::error::CliError;

/// Exit code if the work failed.
const FAILED: u8 = 1;

/// Exit code for wrong arguments.
const WRONG_USAGE: u8 = 2;

/// Writes data to stdout.
pub(super) fn write_data(text: &str) -> Result<(), CliError> {
    let mut stdout = io::stdout().lock();
    stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush())
        .map_err(CliError::Stdout)
}

/// Returns a value as indented JSON without characters that control a terminal.
pub(super) fn json(value: &impl Serialize) -> Result<String, CliError> {
    // Converting to a `Value` sorts the keys alphabetically.
    let value = serde_json::to_value(value).map_err(CliError::failed)?;
    Ok(escaped_json(&format!("{value:#}\n")))
}

/// Writes a sanitised message to stderr. A failure to write it is ignored.
pub(super) fn message(line: &str) {
    writeln!(io::stderr().lock(), "{}", SanitizedLine(line)).unwrap_or_default();
}

/// Returns the exit code of a command, and prints the error if there is one.
pub(super) fn exit_code(result: Result<(), CliError>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // A reader that closes the pipe early (`| head`) is not a failure.
        Err(CliError::Stdout(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => {
            message(&format!("morphospace: {error}"));
            let is_usage = matches!(error, CliError::Usage(_));
            ExitCode::from(if is_usage { WRONG_USAGE } else { FAILED })
        }
    }
}

/// Prints help, version or the argument error, and returns the exit code.
pub(super) fn print_usage(error: &clap::Error, arguments: &[OsString]) -> ExitCode {
    if !error.use_stderr() {
        return exit_code(write_data(&error.render().to_string()));
    }
    // clap quotes arguments unescaped and uses escape sequences for colours. If an argument has
    // hidden characters, the message is printed without colours so that it can be sanitised.
    let has_hidden = |argument: &OsString| argument.to_string_lossy().contains(is_hidden);
    if arguments.iter().any(has_hidden) {
        error.render().to_string().lines().for_each(message);
    } else {
        // The message is coloured if stderr is a terminal and colours are not disabled.
        error.print().unwrap_or_default();
    }
    ExitCode::from(WRONG_USAGE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_has_no_hidden_characters_and_parses_back_unchanged() {
        let name = "a\u{9b}2J\u{1b}[0m\u{202e}\n\u{7f}é";
        let text = json(&serde_json::json!({ "name": name })).expect("a value");
        assert!(
            !text.trim_end().contains(|c| is_hidden(c) && c != '\n'),
            "{text:?}"
        );
        let back: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(back["name"], name);
    }
}
