//! A temporary folder with small designs, in which tests run the built program.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// OBJ text of a unit square.
pub const SOURCE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
/// OBJ text of a mesh with the same two faces as [`SOURCE`]; its vertices are those of the square,
/// rotated by 90°, enlarged and distorted.
pub const TARGET: &str = "v 0 0 0\nv 0 2 0\nv -2 2 0\nv -1 0.2 0\nf 1 2 3\nf 1 3 4\n";

/// A temporary folder with two meshes and two drawings, in which the program runs.
pub struct CliFixture(TempDir);

impl CliFixture {
    pub fn new() -> Self {
        let fixture = Self(tempfile::tempdir().expect("a folder"));
        let svg = |shape: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\">{shape}</svg>"
            )
        };
        fixture.write("a.obj", SOURCE);
        fixture.write("b.obj", TARGET);
        fixture.write(
            "a.svg",
            &svg("<rect x=\"5\" y=\"5\" width=\"20\" height=\"30\"/>"),
        );
        fixture.write("b.svg", &svg("<circle cx=\"40\" cy=\"20\" r=\"12\"/>"));
        fixture
    }

    /// Writes a text file into the folder.
    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Returns a command that runs the program in the folder; its arguments are the words of
    /// `line`.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_morphospace"));
        command.current_dir(self.0.path());
        command.args(line.split_whitespace());
        command
    }

    pub fn run(&self, line: &str) -> Output {
        self.command(line).output().expect("the program starts")
    }

    /// Runs the program, asserts that it succeeds, and returns its stdout.
    pub fn succeeds(&self, line: &str) -> String {
        let output = self.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", stderr(&output));
        String::from_utf8(output.stdout).expect("text")
    }

    /// Runs the program and asserts that it exits with `code`, that its stderr contains `text`, and
    /// that its stdout is empty.
    pub fn fails(&self, code: i32, line: &str, text: &str) {
        let output = self.run(line);
        let messages = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{line}: {messages}");
        assert!(messages.contains(text), "{line} printed: {messages}");
        assert!(!messages.contains("panicked"), "{line}: {messages}");
        assert!(output.stdout.is_empty(), "{line} wrote data");
    }

    /// Sorted names of the files and folders in a subfolder; `.` is the folder itself.
    pub fn file_names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).expect("listed");
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<_> = entries.map(|e| name(e.expect("an entry"))).collect();
        names.sort();
        names
    }
}

/// Text that the program wrote to its standard error stream.
pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn read_image(path: &Path) -> image::RgbaImage {
    image::open(path).expect("an image").into_rgba8()
}
