//! The built program in a folder of its own, on a short leash.

use std::fs;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// What opening any file may take, in KiB.
const MOST_KIB: u64 = 1 << 20;

/// Five times as long as an answer may take: machines are busy.
const PATIENCE: Duration = Duration::from_secs(10);

/// A folder with one good design, `square.json`.
pub struct Folder(TempDir);

/// How the program ended and what it said.
#[derive(Debug)]
pub struct Answer {
    pub code: Option<i32>,
    pub data: String,
    pub words: String,
}

impl Folder {
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        folder.put("square.json", "[[0,0],[15,0],[15,15],[0,15]]");
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn put(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).expect("written");
    }

    /// Asks the program, within its bounds.
    pub fn ask(&self, arguments: &[&str]) -> Answer {
        Answer::of(waited(self.command(arguments), arguments, PATIENCE))
    }

    /// The same where it has work to do, which nobody has made fast here.
    pub fn ask_patiently(&self, arguments: &[&str]) -> Answer {
        Answer::of(waited(self.command(arguments), arguments, 9 * PATIENCE))
    }

    fn command(&self, arguments: &[&str]) -> Child {
        let program = env!("CARGO_BIN_EXE_morphospace");
        let mut command = match cfg!(unix) {
            // The shell sets the bound and becomes the program.
            true => {
                let mut shell = Command::new("sh");
                let bounded = format!("ulimit -v {MOST_KIB}; exec \"$0\" \"$@\"");
                shell.args(["-c", &bounded, program]);
                shell
            }
            false => Command::new(program),
        };
        command
            .args(arguments)
            .current_dir(self.0.path())
            // The bound is on addresses: arenas and stacks of many cores take
            // them up without a byte being used.
            .env("MALLOC_ARENA_MAX", "2")
            .env("RAYON_NUM_THREADS", "2")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command.spawn().expect("the program starts")
    }

    /// That `check` and `render` refuse a file in one line that begins with
    /// the file's name and says some words.
    #[track_caller]
    pub fn refused(&self, file: &str, said: &str) {
        self.refused_with(&[file, "square.json"], file, said);
    }

    /// The same for all of what is given to both.
    #[track_caller]
    pub fn refused_with(&self, given: &[&str], file: &str, said: &str) {
        let render = ["render", "--at", "0.5", "--size", "8x8", "--out", "x.png"];
        for command in [&["check", "--samples", "2"][..], &render] {
            let answer = self.ask(&[command, given].concat());
            answer.is_one_line();
            assert_eq!(answer.code, Some(1), "{file}: {answer:?}");
            assert_eq!(answer.data, "", "{file} wrote data");
            for part in [file, said] {
                assert!(answer.words.contains(part), "{part}: {}", answer.words);
            }
            assert!(!self.path("x.png").exists());
        }
    }
}

impl Answer {
    fn of(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self {
            code: output.status.code(),
            data: text(output.stdout),
            words: text(output.stderr),
        }
    }

    /// One line of words without anything that acts.
    #[track_caller]
    pub fn is_one_line(&self) {
        let line = self.words.strip_suffix('\n').unwrap_or("");
        assert!(!line.is_empty(), "{self:?}");
        assert_eq!(acting(line), None, "{line:?}");
        assert!(!line.contains("panicked"), "{line}");
        assert!(line.chars().count() < 1_100, "{line}");
    }
}

/// The first character that a terminal would act on.
pub fn acting(line: &str) -> Option<char> {
    let turns = |c| ('\u{202a}'..='\u{202e}').contains(&c);
    line.chars().find(|&c| c.is_control() || turns(c))
}

/// Waits no longer than that.
fn waited(mut child: Child, arguments: &[&str], patience: Duration) -> Output {
    let start = Instant::now();
    // What it says is less than a pipe holds, so that it can be read at the end.
    let ended = |child: &mut Child| -> Option<ExitStatus> { child.try_wait().expect("a child") };
    while ended(&mut child).is_none() {
        if start.elapsed() > patience {
            child.kill().expect("killed");
            panic!("no answer within {patience:?}: {arguments:?}");
        }
        sleep(Duration::from_millis(10));
    }
    child.wait_with_output().expect("read")
}
