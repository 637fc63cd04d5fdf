//! A film as an MP4, by the ffmpeg on the path, which is fed raw frames.
//!
//! Guarantees: H.264-friendly 4:2:0 colour at even sizes, in the BT.709 colours
//! that players assume; every frame of the film at its rate; no file unless
//! ffmpeg ended well. Which encoder and how small is ffmpeg's affair.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::JoinHandle;

use crate::atomic_file::AtomicFile;
use crate::progress::{Cancelled, Progress};

use super::camera::{Camera, DRAWING};
use super::error::ExportError;
use super::film::Film;
use super::raster::{rasterise, samples};
use super::size::PixelSize;

/// Writes the film; the camera's size must be even on both sides
/// ([`PixelSize::to_even`]), or ffmpeg refuses it.
///
/// # Errors
/// [`ExportError`] where the ground is transparent, there is no ffmpeg, it
/// fails, or nobody wants the film any more.
pub fn write_mp4(
    camera: &Camera,
    film: &Film,
    path: &Path,
    progress: &dyn Progress,
) -> Result<(), ExportError> {
    if camera.ground.is_none() {
        return Err(ExportError::Mp4Transparent);
    }
    // The folder is tried before ffmpeg is.
    let file = AtomicFile::create(path).map_err(ExportError::write(path))?;
    let mut ffmpeg = Ffmpeg::start(camera.view.size(), film.fps(), file.temporary_path())?;
    let fed = camera.shoot_runs(
        &film.runs(),
        DRAWING,
        progress,
        |drawing| Ok(samples(&rasterise(&drawing), true)),
        |run, bytes| {
            // ffmpeg knows a rate and no holds: a run goes in frame by frame.
            let feed = |_| ffmpeg.stdin.write_all(&bytes);
            (0..run.count)
                .try_for_each(feed)
                .map_err(ExportError::write(path))
        },
    );
    // Told to end instead, it would take its time over what it has.
    if progress.is_cancelled() {
        ffmpeg.kill();
        return Err(Cancelled.into());
    }
    // A broken pipe is ffmpeg's end, and its last words say more.
    ffmpeg.finish(path).and(fed)?;
    file.commit().map_err(ExportError::write(path))
}

/// A running ffmpeg.
struct Ffmpeg {
    child: Child,
    stdin: ChildStdin,
    last_line: JoinHandle<String>,
}

impl Ffmpeg {
    fn start(size: PixelSize, fps: f64, output: &Path) -> Result<Self, ExportError> {
        let mut child = Command::new("ffmpeg")
            .args(arguments(size, fps).split_whitespace())
            .arg(as_file(output))
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|error| not_started(error, output))?;
        match (child.stdin.take(), child.stderr.take()) {
            (Some(stdin), Some(stderr)) => Ok(Self {
                child,
                stdin,
                // Read while frames are fed: neither side may wait for a full
                // pipe.
                last_line: std::thread::spawn(|| last_line(stderr)),
            }),
            _ => Err(ExportError::NoFfmpeg),
        }
    }

    /// Tells ffmpeg that this was all and waits for it.
    fn finish(mut self, path: &Path) -> Result<(), ExportError> {
        drop(self.stdin);
        let status = self.child.wait().map_err(ExportError::write(path))?;
        let last_line = self.last_line.join().unwrap_or_default();
        if status.success() {
            return Ok(());
        }
        Err(ExportError::Ffmpeg {
            path: path.to_owned(),
            last_line: if last_line.is_empty() {
                status.to_string()
            } else {
                last_line
            },
        })
    }

    /// Stops it, without interest in how it ends.
    fn kill(mut self) {
        drop(self.stdin);
        if self.child.kill().is_ok() {
            // Unwaited for, it would stay in the system's table of processes.
            drop(self.child.wait());
        }
    }
}

fn not_started(error: io::Error, output: &Path) -> ExportError {
    match error.kind() {
        io::ErrorKind::NotFound => ExportError::NoFfmpeg,
        _ => ExportError::Ffmpeg {
            path: output.to_owned(),
            last_line: error.to_string(),
        },
    }
}

fn arguments(size: PixelSize, fps: f64) -> String {
    let input = format!("-f rawvideo -pix_fmt rgb24 -s {size} -r {fps} -i -");
    let colours = "-vf scale=out_color_matrix=bt709:out_range=tv,format=yuv420p \
                   -colorspace bt709 -color_primaries bt709 -color_trc bt709";
    // `-y`: the temporary file is there already.
    format!("-hide_banner -loglevel error -y {input} -an {colours} -movflags +faststart -f mp4")
}

/// `file:` keeps a name with a colon or a leading dash a name.
fn as_file(path: &Path) -> OsString {
    let mut url = OsString::from("file:");
    url.push(path);
    url
}

/// Reads to the end, so that ffmpeg never waits for a reader, and keeps the
/// last line that says anything.
fn last_line(stderr: impl Read) -> String {
    let lines = BufReader::new(stderr).lines().map_while(Result::ok);
    let last = lines.filter(|line| !line.trim().is_empty()).last();
    last.unwrap_or_default().trim().to_owned()
}
