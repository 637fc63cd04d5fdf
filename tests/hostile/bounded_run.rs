//! A temporary folder in which tests run the built program with limits on memory and time, and
//! assertions about its errors.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Limits within which the program runs.
struct RunLimits {
    /// Maximum address space, in KiB. About 250 MiB of it are reserved but not used, for the program
    /// itself, stacks and the allocator.
    kibibytes: u64,
    /// Maximum processor time.
    cpu: Duration,
    /// Maximum running time.
    time: Duration,
}

/// Limits for any file (resource limits: 1 GiB of used memory suffices for opening any file; the
/// time is five times the target of two seconds, since machines may be busy).
const ANY_FILE: RunLimits = RunLimits {
    kibibytes: 1280 << 10,
    cpu: Duration::from_secs(180),
    time: Duration::from_secs(10),
};

/// Limits for work that is slow without optimisation.
const LONG: RunLimits = RunLimits {
    time: Duration::from_secs(90),
    ..ANY_FILE
};

/// Limits for small files (resource limits: 500 MB of used memory, and three times the target of 5 s
/// of processor time, since the tests run with little optimisation).
const SMALL_FILE: RunLimits = RunLimits {
    kibibytes: 740 << 10,
    cpu: Duration::from_secs(15),
    time: Duration::from_secs(90),
};

/// A temporary folder in which the program runs; it contains a valid design, `square.json`.
pub struct BoundedFixture(TempDir);

/// Exit code and output of one run of the program; the code is `None` if a signal ended the run.
#[derive(Debug)]
pub struct ProgramOutput {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl BoundedFixture {
    pub fn new() -> Self {
        let fixture = Self(tempfile::tempdir().expect("a folder"));
        fixture.write("square.json", "[[0,0],[15,0],[15,15],[0,15]]");
        fixture
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).expect("written");
    }

    /// Runs the program within the limits for [`ANY_FILE`].
    pub fn run(&self, arguments: &[&str]) -> ProgramOutput {
        self.run_within(&ANY_FILE, arguments)
    }

    /// Runs the program within [`LONG`] limits.
    pub fn run_long(&self, arguments: &[&str]) -> ProgramOutput {
        self.run_within(&LONG, arguments)
    }

    /// Runs the program within the limits for a [`SMALL_FILE`].
    pub fn run_small(&self, arguments: &[&str]) -> ProgramOutput {
        self.run_within(&SMALL_FILE, arguments)
    }

    /// Runs the program; panics if it takes longer than the time limit.
    fn run_within(&self, limits: &RunLimits, arguments: &[&str]) -> ProgramOutput {
        ProgramOutput::new(wait(
            self.command(limits, arguments),
            arguments,
            limits.time,
        ))
    }

    fn command(&self, limits: &RunLimits, arguments: &[&str]) -> Child {
        let program = env!("CARGO_BIN_EXE_morphospace");
        let mut command = match cfg!(unix) {
            // The shell sets the limits and then replaces itself by the program.
            true => {
                let mut shell = Command::new("sh");
                let (kibibytes, seconds) = (limits.kibibytes, limits.cpu.as_secs());
                let limited =
                    format!("ulimit -v {kibibytes}; ulimit -t {seconds}; exec \"$0\" \"$@\"");
                shell.args(["-c", &limited, program]);
                shell
            }
            false => Command::new(program),
        };
        command
            .args(arguments)
            .current_dir(self.0.path())
            // The limit counts reserved addresses, and the arenas and stacks of many threads would
            // reserve addresses that they do not use.
            .env("MALLOC_ARENA_MAX", "2")
            .env("RAYON_NUM_THREADS", "2")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command.spawn().expect("the program starts")
    }

    /// Asserts that `check` and `render` refuse the pair of `file` and the square, with a one-line
    /// error that contains the name of the file and the reason.
    #[track_caller]
    pub fn assert_refused(&self, file: &str, reason: &str) {
        self.assert_inputs_refused(&[file, "square.json"], file, reason);
    }

    /// Asserts that `check` and `render` refuse the inputs, with a one-line error that contains the
    /// name `file` and the reason.
    #[track_caller]
    pub fn assert_inputs_refused(&self, inputs: &[&str], file: &str, reason: &str) {
        let render = ["render", "--at", "0.5", "--size", "8x8", "--out", "x.png"];
        for command in [&["check", "--samples", "2"][..], &render] {
            let output = self.run(&[command, inputs].concat());
            output.assert_one_line_error();
            assert_eq!(output.code, Some(1), "{file}: {output:?}");
            assert_eq!(output.stdout, "", "{file} wrote data");
            for part in [file, reason] {
                assert!(output.stderr.contains(part), "{part}: {}", output.stderr);
            }
            assert!(!self.path("x.png").exists());
        }
    }
}

impl ProgramOutput {
    fn new(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self {
            code: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// Asserts that stderr is one short line without control characters, and no panic message.
    #[track_caller]
    pub fn assert_one_line_error(&self) {
        let line = self.stderr.strip_suffix('\n').unwrap_or("");
        assert!(!line.is_empty(), "{self:?}");
        assert_eq!(terminal_control(line), None, "{line:?}");
        assert!(!line.contains("panicked"), "{line}");
        assert!(line.chars().count() < 1_100, "{line}");
    }
}

/// First character of `line` that would control a terminal or change the direction of the text;
/// `None` if there is none.
pub fn terminal_control(line: &str) -> Option<char> {
    let is_direction = |c| ('\u{202a}'..='\u{202e}').contains(&c);
    line.chars().find(|&c| c.is_control() || is_direction(c))
}

/// Waits for a process and returns its output. After the time limit it kills the process and
/// panics.
fn wait(mut child: Child, arguments: &[&str], limit: Duration) -> Output {
    let start = Instant::now();
    // The output fits into the buffer of a pipe, so it is read after the process has ended.
    let exit_status =
        |child: &mut Child| -> Option<ExitStatus> { child.try_wait().expect("a child") };
    while exit_status(&mut child).is_none() {
        if start.elapsed() > limit {
            child.kill().expect("killed");
            panic!("no exit within {limit:?}: {arguments:?}");
        }
        sleep(Duration::from_millis(10));
    }
    child.wait_with_output().expect("read")
}
