//! The program ffmpeg at work: what it is told, what it says, how it ends.
//!
//! Guarantees: it does not outlive the wish for its work, even where it takes
//! nothing and says nothing.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::thread;
use std::time::Duration;

use super::super::size::PixelSize;
use crate::work::progress::Progress;

/// How often it is looked whether ffmpeg ended and whether it is still wanted: a
/// tenth of what a cancel may take.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// What the C library calls ENOSPC; ffmpeg says it in English everywhere.
const FULL: &str = "No space left on device";

/// How it ended.
pub(super) struct FfmpegOutcome {
    pub status: ExitStatus,
    pub words: FfmpegMessages,
}

/// What it said.
#[derive(Default)]
pub(super) struct FfmpegMessages {
    /// The last line that says anything.
    pub last: String,
    /// Whether any line says that the disk is full; the last one may not.
    pub tell_of_full_disk: bool,
}

/// It can be started.
pub(super) fn is_available() -> bool {
    let mut command = quiet();
    command.arg("-version").stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Encodes raw frames that it is fed, as planes of BT.709.
pub(super) fn encode_command(size: PixelSize, fps: f64, output: &Path) -> Command {
    // Said of what goes in and of what comes out, so that nothing is converted.
    let colours = "-color_range tv -colorspace bt709 -color_primaries bt709 -color_trc bt709";
    let input = format!("-f rawvideo -pix_fmt yuv420p -s {size} -r {fps} {colours} -i -");
    // `-y`: the temporary file is there already.
    // Flat drawings need no long search: of 300 frames in Full HD x264 took 3.6 s instead
    // of 5.6, and the file was smaller. Encoders that know no presets leave it unread.
    let speed = "-preset veryfast";
    let line =
        format!("-y {input} -an -pix_fmt yuv420p {colours} {speed} -movflags +faststart -f mp4");
    let mut command = quiet();
    command.args(line.split_whitespace()).arg(as_file(output));
    command
}

/// Decodes every frame of a file and keeps nothing.
pub(super) fn decode_command(file: &Path) -> Command {
    let mut command = quiet();
    command.args(["-xerror", "-i"]).arg(as_file(file));
    command.args(["-f", "null", "-"]);
    command
}

/// Runs it until it ends, by itself or because nobody wants its work any more.
/// `feed` gets its input, the end of which tells it that this was all.
///
/// # Errors
/// It cannot be started.
pub(super) fn run(
    mut command: Command,
    progress: &dyn Progress,
    feed: impl FnOnce(ChildStdin),
) -> io::Result<FfmpegOutcome> {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let (stdin, stderr) = (child.stdin.take(), child.stderr.take());
    // Heard while frames are fed: neither side may wait for a full pipe.
    let words = thread::spawn(|| stderr.map(heard).unwrap_or_default());
    let status = thread::scope(|scope| {
        // And watched: feeding waits for as long as it takes nothing.
        let watching = scope.spawn(|| end(&mut child, progress));
        stdin.map(feed);
        let broke_off = |_| Err(io::Error::other("nobody watched it"));
        watching.join().unwrap_or_else(broke_off)
    })?;
    Ok(FfmpegOutcome {
        status,
        words: match progress.is_cancelled() {
            // Whoever it started itself may hold its stderr open.
            true => FfmpegMessages::default(),
            false => words.join().unwrap_or_default(),
        },
    })
}

fn end(child: &mut Child, progress: &dyn Progress) -> io::Result<ExitStatus> {
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        // Told to end instead, it would take its time over what it has.
        if progress.is_cancelled() {
            child.kill()?;
            return child.wait();
        }
        thread::sleep(LOOK_EVERY);
    }
}

fn quiet() -> Command {
    let mut command = Command::new("ffmpeg");
    command.args(["-hide_banner", "-loglevel", "error"]);
    command
}

/// `file:` keeps a name with a colon or a leading dash a name.
fn as_file(path: &Path) -> OsString {
    let mut url = OsString::from("file:");
    url.push(path);
    url
}

/// Reads to the end, so that ffmpeg never waits for a reader, whatever it says.
fn heard(stderr: impl Read) -> FfmpegMessages {
    let mut words = FfmpegMessages::default();
    let lines = BufReader::new(stderr).split(b'\n').map_while(Result::ok);
    for line in lines {
        let line = String::from_utf8_lossy(&line);
        let line: String = line.chars().filter(|c| !c.is_control()).collect();
        words.tell_of_full_disk |= line.contains(FULL);
        // ffmpeg 6 and later end with this, and say why before it.
        if !line.trim().is_empty() && line.trim() != "Conversion failed!" {
            line.trim().clone_into(&mut words.last);
        }
    }
    words
}
