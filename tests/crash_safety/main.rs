//! Earlier output files survive signals, kills, failing encoders and full disks.
//!
//! Each test runs the built program and then checks that a previous file is unchanged, or that
//! a complete new one has replaced it, and that no temporary file is left.
#![cfg(unix)]

#[path = "../cli/cli_fixture.rs"]
#[expect(dead_code, reason = "the command-line tests use the rest")]
mod cli_fixture;
mod disks;
mod encoders;
mod pair_tables;
mod signals;

use std::fs;
use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use cli_fixture::CliFixture;

/// Sorted list of the given file names and those of the fixture's own files.
fn with_fixture_files(names: &[&str]) -> Vec<String> {
    let fixture_files = ["a.obj", "a.svg", "b.obj", "b.svg"];
    let mut all: Vec<_> = fixture_files
        .iter()
        .chain(names)
        .map(ToString::to_string)
        .collect();
    all.sort();
    all
}

/// Installs a shell script as `bin/ffmpeg` in the fixture's folder. In the script, `$out` is the
/// output file.
fn fake_ffmpeg(cli: &CliFixture, script: &str) {
    fs::create_dir_all(cli.path("bin")).expect("made");
    // A child process writes the file. If this process wrote it, processes that other tests start
    // at the same time would inherit the open file, and a file open for writing cannot be executed.
    let mut writer = Command::new("sh")
        .args(["-c", "cat > bin/ffmpeg && chmod +x bin/ffmpeg"])
        .current_dir(cli.path("."))
        .stdin(Stdio::piped())
        .spawn()
        .expect("a shell");
    // The film, which ffmpeg encodes or decodes, is the argument with the prefix `file:`.
    let find = "for word; do case $word in file:*) out=${word#file:};; esac; done";
    let text = format!("#!/bin/sh\n{find}\n{script}\n");
    let mut stdin = writer.stdin.take().expect("a pipe");
    stdin.write_all(text.as_bytes()).expect("written");
    drop(stdin);
    assert!(writer.wait().expect("it ends").success());
}

/// Returns a command for the program that runs the fake ffmpeg instead of an installed one.
fn command_with_fake(cli: &CliFixture, line: &str) -> Command {
    let mut command = cli.command(line);
    let path = format!("{}:/usr/bin:/bin", cli.path("bin").display());
    command.env("PATH", path);
    command
}

/// Waits until `has_happened` returns true. After a minute, panics with `event`, the name of the
/// event.
fn wait_until(event: &str, mut has_happened: impl FnMut() -> bool) {
    let start = Instant::now();
    while !has_happened() {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "no {event} within a minute"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Sends a signal to the process with the id `process`, if it still runs.
fn send(signal: &str, process: u32) {
    let line = ["-s", signal, &process.to_string()];
    let sent = Command::new("kill")
        .args(line)
        .stderr(Stdio::null())
        .status();
    // `kill` fails if the process has already ended, which is not an error here.
    sent.expect("kill runs");
}

/// Whether the process with this id runs; zombies do not count.
fn is_alive(process: &str) -> bool {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let state = stat.rsplit_once(") ").map(|(_, rest)| rest);
    state.is_some_and(|state| !state.starts_with('Z'))
}

/// Starts a command without stdout and with a captured stderr.
fn start(command: Command) -> Child {
    let mut command = with_default_signals(&command);
    let command = command.stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().expect("the program starts")
}

/// Returns the same command with default signal handling; on Linux, the process is killed when the
/// test ends.
///
/// If the tests run under `nohup` or as a background job, child processes inherit ignored signals,
/// and the program would not react to them. Without the kill, a failed test would leave a program
/// running for hours.
fn with_default_signals(command: &Command) -> Command {
    let wrapper: &[&str] = if cfg!(target_os = "linux") {
        &[
            "setpriv",
            "--pdeathsig=KILL",
            "env",
            "--default-signal=HUP,INT,TERM",
        ]
    } else {
        &["env"]
    };
    let mut wrapped = Command::new(wrapper[0]);
    wrapped
        .args(&wrapper[1..])
        .arg(command.get_program())
        .args(command.get_args());
    if let Some(folder) = command.get_current_dir() {
        wrapped.current_dir(folder);
    }
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => wrapped.env(name, value),
            None => wrapped.env_remove(name),
        };
    }
    wrapped
}

/// Names of the program's temporary files in the fixture's folder.
fn partial_files(cli: &CliFixture) -> Vec<String> {
    let mut names = cli.file_names(".");
    names.retain(|name| name.ends_with(".part"));
    names
}
