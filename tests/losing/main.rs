//! What a person made is never lost: the program is asked to end, killed, lied
//! to by encoders and put on full disks, and the earlier files stay.
#![cfg(unix)]

mod disks;
mod encoders;
mod endings;
mod tables;
#[path = "../cli/workshop.rs"]
#[expect(dead_code, reason = "other tests use the rest")]
mod workshop;

use std::fs;
use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use workshop::Workshop;

/// What lies in a folder with the workshop's own files.
fn with_own(names: &[&str]) -> Vec<String> {
    let own = ["a.obj", "a.svg", "b.obj", "b.svg"];
    let mut all: Vec<_> = own.iter().chain(names).map(ToString::to_string).collect();
    all.sort();
    all
}

/// Puts a program called ffmpeg into the folder `bin`.
fn fake_ffmpeg(shop: &Workshop, script: &str) {
    fs::create_dir_all(shop.path("bin")).expect("made");
    // By a process of its own: whatever this one starts meanwhile would hold it
    // open for writing, and then it cannot be run.
    let mut writer = Command::new("sh")
        .args(["-c", "cat > bin/ffmpeg && chmod +x bin/ffmpeg"])
        .current_dir(shop.path("."))
        .stdin(Stdio::piped())
        .spawn()
        .expect("a shell");
    // The last argument is the file, called so for ffmpeg.
    let text = format!("#!/bin/sh\nfor out; do :; done\nout=${{out#file:}}\n{script}\n");
    let mut stdin = writer.stdin.take().expect("a pipe");
    stdin.write_all(text.as_bytes()).expect("written");
    drop(stdin);
    assert!(writer.wait().expect("it ends").success());
}

/// A command that finds the fake ffmpeg before any other.
fn command_with_fake(shop: &Workshop, line: &str) -> Command {
    let mut command = shop.command(line);
    let path = format!("{}:/usr/bin:/bin", shop.path("bin").display());
    command.env("PATH", path);
    command
}

/// Waits until something is so, for longer than any machine takes.
fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}: never");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn send(signal: &str, process: u32) {
    let line = ["-s", signal, &process.to_string()];
    let sent = Command::new("kill")
        .args(line)
        .stderr(Stdio::null())
        .status();
    // One that has ended by itself gets none.
    sent.expect("kill runs");
}

/// Whether there is such a process; one that ended and was not waited for is
/// none.
fn is_alive(process: &str) -> bool {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    let state = stat.rsplit_once(") ").map(|(_, rest)| rest);
    state.is_some_and(|state| !state.starts_with('Z'))
}

/// Starts a command with its words kept.
fn started(command: Command) -> Child {
    let mut command = listening(&command);
    let command = command.stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().expect("the program starts")
}

/// The same command, that hears signals: whoever runs the tests may ignore some
/// (`nohup`, a shell's background), and what it starts inherits that. It ends
/// with its test: what a test that fails has started would go on for hours.
fn listening(command: &Command) -> Command {
    let words: &[&str] = if cfg!(target_os = "linux") {
        &[
            "setpriv",
            "--pdeathsig=KILL",
            "env",
            "--default-signal=HUP,INT,TERM",
        ]
    } else {
        &["env"]
    };
    let mut listening = Command::new(words[0]);
    listening
        .args(&words[1..])
        .arg(command.get_program())
        .args(command.get_args());
    if let Some(folder) = command.get_current_dir() {
        listening.current_dir(folder);
    }
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => listening.env(name, value),
            None => listening.env_remove(name),
        };
    }
    listening
}

/// The files on their way in the workshop's folder.
fn on_their_way(shop: &Workshop) -> Vec<String> {
    let mut names = shop.names(".");
    names.retain(|name| name.ends_with(".part"));
    names
}
