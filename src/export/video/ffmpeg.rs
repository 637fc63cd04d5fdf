//! Runs ffmpeg: builds its command lines, collects its error messages, and waits until it ends.
//!
//! Guarantees: ffmpeg is killed when the export is cancelled, even if it neither reads its input
//! nor writes any output.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::thread;
use std::time::Duration;

use super::super::size::PixelSize;
use super::encoder::VideoEncoder;
use crate::work::progress::Progress;

/// Interval between two checks whether ffmpeg has ended or the export is cancelled (resource limit:
/// a tenth of the time that a cancellation may take).
const POLL_INTERVAL: Duration = Duration::from_millis(50);

/// Message of the C library for ENOSPC; ffmpeg prints it untranslated.
const DISK_FULL: &str = "No space left on device";

/// Exit status, messages and output of a finished ffmpeg.
pub(super) struct FfmpegOutcome {
    pub status: ExitStatus,
    pub messages: FfmpegMessages,
    /// Number of frames that ffmpeg listed on its standard output.
    pub frames: usize,
}

/// Messages of ffmpeg on its standard error.
#[derive(Default)]
pub(super) struct FfmpegMessages {
    /// Last line that gives a reason for a failure: the last non-blank line, except for
    /// `Conversion failed!`. Empty if there is none.
    pub last: String,
    /// Whether any line, not only the last, reports a full disk.
    pub report_full_disk: bool,
}

/// Returns whether ffmpeg can be started.
pub(super) fn is_available() -> bool {
    let mut command = quiet();
    command.arg("-version").stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Returns the command that encodes raw BT.709 YUV frames from standard input.
pub(super) fn encode_command(
    encoder: VideoEncoder,
    size: PixelSize,
    fps: f64,
    output: &Path,
) -> Command {
    let (pixels, options) = (encoder.pixels.ffmpeg_name(), encoder.options);
    // The colours are stated for input and output alike, so that ffmpeg does not convert them.
    let colours = "-color_range tv -colorspace bt709 -color_primaries bt709 -color_trc bt709";
    let input = format!("-f rawvideo -pix_fmt {pixels} -s {size} -r {fps} {colours} -i -");
    // `-y` overwrites the temporary file, which already exists.
    let line = format!("-y {input} -an -pix_fmt {pixels} {colours} {options}");
    let mut command = quiet();
    command.args(line.split_whitespace()).arg(file_url(output));
    command
}

/// Returns the command that decodes every frame of a file and lists the frames, one on each line,
/// on standard output.
pub(super) fn decode_command(file: &Path) -> Command {
    let mut command = quiet();
    command.args(["-xerror", "-i"]).arg(file_url(file));
    command.args(["-map", "0:v:0", "-f", "framecrc", "-"]);
    command
}

/// Runs a command until it ends or the export is cancelled. `feed` receives its standard input;
/// dropping it marks the end of the input.
///
/// # Errors
/// If the command cannot be started, or waiting for it fails.
pub(super) fn run(
    mut command: Command,
    progress: &dyn Progress,
    feed: impl FnOnce(ChildStdin),
) -> io::Result<FfmpegOutcome> {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let (stdin, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
    // Output is read while frames are fed, so that neither process waits for a full pipe.
    let words = thread::spawn(|| stderr.map(collect_messages).unwrap_or_default());
    let frames = thread::spawn(|| stdout.map(count_frames).unwrap_or_default());
    let status = thread::scope(|scope| {
        // Cancellation is watched on another thread, because feeding blocks while ffmpeg takes no
        // input.
        let watcher = scope.spawn(|| wait_or_kill(&mut child, progress));
        stdin.map(feed);
        let panicked = |_| Err(io::Error::other("the thread that watches ffmpeg failed"));
        watcher.join().unwrap_or_else(panicked)
    })?;
    // After a cancellation, the output is not needed. Waiting for it could block, because a child
    // process of ffmpeg may still hold its stderr open.
    let (messages, frames) = match progress.is_cancelled() {
        true => Default::default(),
        false => (
            words.join().unwrap_or_default(),
            frames.join().unwrap_or_default(),
        ),
    };
    Ok(FfmpegOutcome {
        status,
        messages,
        frames,
    })
}

/// Waits for the process to end, or kills it on cancellation.
fn wait_or_kill(child: &mut Child, progress: &dyn Progress) -> io::Result<ExitStatus> {
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        // ffmpeg is killed instead of asked to terminate, because it would first finish encoding
        // its input.
        if progress.is_cancelled() {
            child.kill()?;
            return child.wait();
        }
        thread::sleep(POLL_INTERVAL);
    }
}

/// Returns the command `ffmpeg` with the options to print errors only.
fn quiet() -> Command {
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error"]);
    command
}

/// Returns the path with the `file:` protocol, so that a colon or a leading dash has no special
/// meaning.
fn file_url(path: &Path) -> OsString {
    let mut url = OsString::from("file:");
    url.push(path);
    url
}

/// Counts the frames that ffmpeg lists: the lines that are no comments.
fn count_frames(stdout: impl Read) -> usize {
    let lines = BufReader::new(stdout).split(b'\n').map_while(Result::ok);
    lines
        .filter(|line| !line.is_empty() && !line.starts_with(b"#"))
        .count()
}

/// Reads all messages to the end, so that ffmpeg never blocks on its output. Control characters are
/// removed.
fn collect_messages(stderr: impl Read) -> FfmpegMessages {
    let mut words = FfmpegMessages::default();
    let lines = BufReader::new(stderr).split(b'\n').map_while(Result::ok);
    for line in lines {
        let line = String::from_utf8_lossy(&line);
        let line: String = line.chars().filter(|c| !c.is_control()).collect();
        words.report_full_disk |= line.contains(DISK_FULL);
        // ffmpeg 6 and later end with this uninformative line after the actual reason.
        if !line.trim().is_empty() && line.trim() != "Conversion failed!" {
            line.trim().clone_into(&mut words.last);
        }
    }
    words
}
