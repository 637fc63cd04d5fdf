//! Entry point of the program: runs a subcommand, or opens the window.

#![forbid(unsafe_code)]

use std::process::ExitCode;

use morphospace::cli;
use morphospace::cli::LaunchOutcome;

fn main() -> ExitCode {
    match cli::run(std::env::args_os()) {
        LaunchOutcome::Done(code) => code,
        LaunchOutcome::Window(request) => open_window(request),
    }
}

#[cfg(feature = "app")]
fn open_window(request: cli::WindowRequest) -> ExitCode {
    use morphospace::app::{AppOptions, run};
    use std::process::Termination;
    let options = AppOptions {
        files: request.files,
        captures: request.captures,
        film_memory: request.film_memory,
        starts_talk: request.present,
    };
    match run(options) {
        Ok(exit) => exit.report(),
        Err(why) => cli::report_window_error(why),
    }
}

#[cfg(not(feature = "app"))]
fn open_window(_: cli::WindowRequest) -> ExitCode {
    cli::report_no_window_support()
}
