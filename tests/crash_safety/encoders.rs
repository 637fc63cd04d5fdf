//! Tests of failures of the video encoder, simulated by a fake ffmpeg. An encoder that fails,
//! falsely reports success or writes an invalid film leaves the earlier film unchanged, and the
//! error quotes the encoder's message. A complete film replaces the earlier one.
//!
//! Encoders that hang are tested in `signals`.

use std::fs;

use crate::cli_fixture::{CliFixture, stderr};
use crate::{command_with_fake, fake_ffmpeg, with_fixture_files};

/// Content that the film file has before the program runs.
const EARLIER: &[u8] = b"an earlier good film";

/// Arguments of the program that encode a film of four frames.
const FILM: &str = "render a.obj b.obj --frames 4 --play once --size 64x48 --out film.mp4";

/// Start of a shell script that decodes a film: it lists one frame for each line of the file.
const DECODES: &str = "case \"$*\" in *framecrc*) cat \"$out\"; exit 0;; esac\n";

/// Content of a film file with the given number of frames, for [`DECODES`].
fn film_file(frames: usize) -> Vec<u8> {
    format!("#codec\n{}", "frame\n".repeat(frames)).into_bytes()
}

/// Runs the program with a shell script as its ffmpeg; returns the error message of the program.
///
/// Asserts that the program fails with a one-line message and leaves the earlier film unchanged.
fn error_with_encoder(script: &str) -> String {
    let cli = CliFixture::new();
    fs::write(cli.path("film.mp4"), EARLIER).expect("written");
    for (name, frames) in [("whole", 4), ("fewer", 2)] {
        fs::write(cli.path(name), film_file(frames)).expect("written");
    }
    fake_ffmpeg(&cli, script);
    let output = command_with_fake(&cli, FILM).output().expect("it starts");
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{script}: {message}");
    assert_eq!(message.lines().count(), 1, "{script}: {message}");
    assert!(message.contains("film.mp4"), "{script}: {message}");
    assert!(!message.contains(".part"), "{script}: {message}");
    let content = fs::read(cli.path("film.mp4")).expect("read");
    assert_eq!(content, EARLIER, "{script}");
    let expected = with_fixture_files(&["bin", "fewer", "film.mp4", "whole"]);
    assert_eq!(cli.file_names("."), expected, "{script}");
    message
}

#[test]
fn an_incomplete_film_is_rejected_even_if_the_encoder_reports_success() {
    for (script, reason) in [
        ("cat > /dev/null", "0 of 4 frames"),
        ("exit 0", "0 of 4 frames"),
        ("cat > /dev/null; rm \"$out\"", "was not written completely"),
        ("cat > /dev/null; cat fewer > \"$out\"", "2 of 4 frames"),
        (
            "cat > /dev/null; echo 'moov atom not written' >&2",
            "ffmpeg said: moov atom not written",
        ),
    ] {
        let message = error_with_encoder(&format!("{DECODES}{script}"));
        assert!(
            message.contains("was not written completely"),
            "{script}: {message}"
        );
        assert!(message.contains(reason), "{script}: {message}");
    }
}

#[test]
fn a_film_that_cannot_be_decoded_is_rejected() {
    let script = "case \"$*\" in *framecrc*) echo 'no picture' >&2; exit 1;; esac\n\
        cat > /dev/null; cat whole > \"$out\"";
    let message = error_with_encoder(script);
    assert!(message.contains("no picture"), "{message}");
}

#[test]
fn a_full_disk_is_reported_whatever_the_exit_status_of_the_encoder() {
    let full = "echo 'av_interleaved_write_frame(): No space left on device' >&2";
    for end in ["exit 0", "exit 1", "echo 'Conversion failed!' >&2; exit 1"] {
        let message = error_with_encoder(&format!("cat > /dev/null; {full}; {end}"));
        assert!(message.contains("the disk is full"), "{message}");
    }
}

#[test]
fn messages_of_the_encoder_are_quoted_with_the_file_name_of_the_user() {
    let message = error_with_encoder("echo \"$out: Invalid argument\" >&2; exit 1");
    assert!(
        message.contains(": film.mp4: Invalid argument;"),
        "{message}"
    );
    let message = error_with_encoder("printf '\\033[31mred\\n' >&2; kill -9 $$");
    assert!(
        message.contains("red") && !message.contains('\u{1b}'),
        "{message}"
    );
    let message = error_with_encoder("exit 3");
    assert!(message.contains("exit status: 3"), "{message}");
}

#[test]
fn a_complete_film_replaces_the_earlier_one() {
    let cli = CliFixture::new();
    fs::write(cli.path("film.mp4"), EARLIER).expect("written");
    fs::write(cli.path("whole"), film_file(4)).expect("written");
    // This encoder exits with success although it writes to stderr.
    let script = "cat > /dev/null; cat whole > \"$out\"; echo 'deprecated' >&2";
    fake_ffmpeg(&cli, &format!("{DECODES}{script}"));
    let output = command_with_fake(&cli, FILM).output().expect("it starts");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(fs::read(cli.path("film.mp4")).expect("read"), film_file(4));
    assert_eq!(
        cli.file_names("."),
        with_fixture_files(&["bin", "film.mp4", "whole"])
    );
}
