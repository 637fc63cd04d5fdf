//! The built program in a folder of its own.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

pub const SOURCE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
pub const TARGET: &str = "v 0 0 0\nv 0 2 0\nv -2 2 0\nv -1 0.2 0\nf 1 2 3\nf 1 3 4\n";

/// A folder with two meshes and two drawings.
pub struct Workshop(TempDir);

impl Workshop {
    pub fn new() -> Self {
        let workshop = Self(tempfile::tempdir().expect("a folder"));
        let svg = |shape: &str| {
            format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"60\" height=\"40\">{shape}</svg>"
            )
        };
        workshop.put("a.obj", SOURCE);
        workshop.put("b.obj", TARGET);
        workshop.put(
            "a.svg",
            &svg("<rect x=\"5\" y=\"5\" width=\"20\" height=\"30\"/>"),
        );
        workshop.put("b.svg", &svg("<circle cx=\"40\" cy=\"20\" r=\"12\"/>"));
        workshop
    }

    pub fn put(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_morphospace"));
        command.current_dir(self.0.path());
        command.args(line.split_whitespace());
        command
    }

    pub fn run(&self, line: &str) -> Output {
        self.command(line).output().expect("the program starts")
    }

    /// Runs a command that must succeed, and returns its stdout.
    pub fn done(&self, line: &str) -> String {
        let output = self.run(line);
        assert_eq!(output.status.code(), Some(0), "{line}: {}", words(&output));
        String::from_utf8(output.stdout).expect("text")
    }

    /// Runs a command that must end with the code and say the words.
    pub fn fails(&self, code: i32, line: &str, said: &str) {
        let output = self.run(line);
        let words = words(&output);
        assert_eq!(output.status.code(), Some(code), "{line}: {words}");
        assert!(words.contains(said), "{line} said: {words}");
        assert!(!words.contains("panicked"), "{line}: {words}");
        assert!(output.stdout.is_empty(), "{line} wrote data");
    }

    pub fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).expect("listed");
        let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
        let mut names: Vec<_> = entries.map(|e| name(e.expect("an entry"))).collect();
        names.sort();
        names
    }
}

pub fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn image(path: &Path) -> image::RgbaImage {
    image::open(path).expect("a picture").into_rgba8()
}
