//! Data to stdout, words to stderr, and exit codes.

use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

use serde::Serialize;

use crate::io::sanitize::{SanitizedLine, is_hidden};

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

/// A value as JSON for [`data`], with nothing in it that acts on a terminal.
pub(super) fn json(value: &impl Serialize) -> Result<String, CliError> {
    // By way of a value, whose keys are in alphabetical order.
    let value = serde_json::to_value(value).map_err(CliError::failed)?;
    Ok(shown(&format!("{value:#}\n")))
}

/// JSON with all hidden characters escaped: it asks that of those below space
/// alone, and some terminals take others for the beginning of a command.
fn shown(json: &str) -> String {
    let mut shown = String::with_capacity(json.len());
    for c in json.chars() {
        // Within a text a line break is escaped already.
        if is_hidden(c) && c != '\n' {
            shown.extend(
                c.encode_utf16(&mut [0; 2])
                    .iter()
                    .map(|unit| format!("\\u{unit:04x}")),
            );
        } else {
            shown.push(c);
        }
    }
    shown
}

/// Writes a line of words to stderr, whatever has come into them. Where even
/// that fails, nobody listens.
pub(super) fn words(line: &str) {
    writeln!(io::stderr().lock(), "{}", SanitizedLine(line)).unwrap_or_default();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_holds_nothing_that_acts_on_a_terminal_and_reads_as_before() {
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
