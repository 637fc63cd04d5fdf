//! Tests of outputs that cannot be written: the disk is full or read-only, the file would exceed
//! the size limit, the permission is missing, or the path is that of a folder, a device or a pipe.
//!
//! In each case the program prints a one-line message that says how to solve the problem, and
//! leaves the earlier file unchanged. A full stdout is reported in the same way; a closed stdout is
//! ignored.

use std::fs;
use std::process::{Command, Output, Stdio};

use crate::cli_fixture::{CliFixture, read_image, stderr};
use crate::with_fixture_files;

/// Content that the output file has before the program runs.
const EARLIER: &str = "the earlier content";

/// Arguments of a command for each kind of output; the last word is the name of the output file.
const COMMANDS: [&str; 8] = [
    "render a.obj b.obj --at 0.5 --size 640x480 --out x.png",
    "render a.obj b.obj --sheet 60 --out x.svg",
    "render a.obj b.obj --sheet 9 --out x.png",
    "render a.obj b.obj --frames 60 --size 320x240 --out x.gif",
    "render a.obj b.obj --frames 60 --size 320x240 --out x.apng",
    "new a.svg b.svg --force --out x.morph",
    "check --pairs pairs.csv --samples 3 --out x.csv",
    "check --pairs pairs.csv --samples 3 --out r.csv --sheet x.png",
];

fn output_name(line: &str) -> &str {
    line.rsplit(' ').next().expect("a name")
}

/// A fixture with a table of pairs, and with an earlier output file called `name`.
fn with_earlier_file(name: &str) -> CliFixture {
    let cli = CliFixture::new();
    cli.write("pairs.csv", "source,target\na.obj,b.obj\n");
    cli.write(name, EARLIER);
    cli
}

/// Runs the shell script `script`, in which `"$@"` stands for the program with the arguments in
/// `line`.
fn in_shell(cli: &CliFixture, script: &str, line: &str) -> Output {
    let program = cli.command(line);
    let mut shell = Command::new("sh");
    shell.args(["-c", script, "sh"]);
    shell.arg(program.get_program()).args(program.get_args());
    shell.current_dir(cli.path(".")).stdin(Stdio::null());
    shell.output().expect("a shell")
}

/// Asserts that the program failed with a one-line message that contains `text` and the file name
/// `name`.
fn assert_one_line_error(output: &Output, text: &str, name: &str) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(
        message.contains(text) && message.contains(name),
        "{message}"
    );
    assert!(
        !message.contains("morphospace-"),
        "a temporary name: {message}"
    );
}

#[test]
fn a_file_size_limit_leaves_the_earlier_file() {
    for line in COMMANDS {
        let name = output_name(line);
        // The maximum file size is 0 in the first run and one block in the second.
        for blocks in [0, 1] {
            let cli = with_earlier_file(name);
            let limit = format!("ulimit -f {blocks}; exec \"$@\"");
            let output = in_shell(&cli, &limit, line);
            // The output may fit into one block, as a small project does.
            if blocks > 0 && output.status.success() {
                continue;
            }
            let name = if line.contains("r.csv") {
                "r.csv"
            } else {
                name
            };
            assert_one_line_error(&output, "larger than the system allows", name);
            let content = fs::read_to_string(cli.path(output_name(line))).expect("read");
            assert_eq!(content, EARLIER, "{line}");
            let left = with_fixture_files(&["pairs.csv", output_name(line)]);
            assert_eq!(cli.file_names("."), left, "{line}");
        }
    }
}

/// Runs the program on a temporary RAM disk of the given size, mounted with `mode` (`rw` or `ro`).
///
/// The disk disappears after the command, so the shell prints the content of the output file and
/// then the names of all files to stdout. Returns `None` if the system does not allow users to
/// mount disks.
fn on_disk(cli: &CliFixture, kilobytes: u32, mode: &str, line: &str) -> Option<Output> {
    let name = output_name(line);
    fs::create_dir_all(cli.path("disk")).expect("made");
    let script = format!(
        "mount -t tmpfs -o size={kilobytes}k tmpfs disk || exit 77\n\
         cp *.* disk && cd disk\n\
         mount -o remount,{mode} . || exit 77\n\
         \"$@\"\ncode=$?\ncat {name}\nls -A\nexit $code"
    );
    let output = in_shell(
        cli,
        &format!("unshare -rm sh -c '{script}' sh \"$@\""),
        line,
    );
    if !matches!(output.status.code(), Some(0..=2)) {
        report_skipped(&output);
        return None;
    }
    Some(output)
}

/// Prints that a test was skipped, and why.
#[expect(clippy::print_stderr, reason = "a skipped test is reported")]
fn report_skipped(output: &Output) {
    let message = stderr(output);
    eprintln!(
        "NOT TESTED: full and read-only disks, because the system allows no user mounts: {message}"
    );
}

#[test]
fn a_full_disk_is_reported_and_leaves_the_earlier_file() {
    // If ffmpeg is installed, it is tested too: the program must recognise ffmpeg's message about a
    // full disk.
    let ffmpeg = Command::new("ffmpeg").arg("-version").output();
    let film = "render a.obj b.obj --frames 60 --size 320x240 --out x.mp4";
    for line in COMMANDS.into_iter().chain(ffmpeg.map(|_| film)) {
        let name = output_name(line);
        let cli = with_earlier_file(name);
        // The inputs and the earlier file take 24 kB, since each occupies a page of 4 kB. So the
        // free space is none, one page or two pages.
        for kilobytes in [24, 28, 32] {
            let Some(output) = on_disk(&cli, kilobytes, "rw", line) else {
                return;
            };
            if output.status.success() {
                continue;
            }
            // No file name is expected, because the file that did not fit may also be a partial
            // report or a sheet.
            assert_one_line_error(&output, "the disk is full; free some space", "");
            let disk = String::from_utf8_lossy(&output.stdout);
            assert!(disk.starts_with(EARLIER), "{line}: {disk}");
            assert!(!disk.contains(".part\n"), "{line}: {disk}");
        }
    }
}

#[test]
fn a_read_only_disk_is_reported() {
    for line in COMMANDS {
        let cli = with_earlier_file(output_name(line));
        let Some(output) = on_disk(&cli, 999, "ro", line) else {
            return;
        };
        assert_one_line_error(&output, "the disk is read-only; choose a folder", ".");
    }
}

#[test]
fn a_folder_without_write_permission_is_reported() {
    use std::os::unix::fs::PermissionsExt;
    for line in COMMANDS {
        let name = output_name(line);
        let cli = with_earlier_file(name);
        fs::create_dir(cli.path("read-only")).expect("made");
        fs::copy(cli.path(name), cli.path("read-only").join(name)).expect("copied");
        let set_mode = |mode| {
            let mode = fs::Permissions::from_mode(mode);
            fs::set_permissions(cli.path("read-only"), mode).expect("set");
        };
        set_mode(0o555);
        let line = line.replace(&format!(" {name}"), &format!(" read-only/{name}"));
        let line = line.replace(" r.csv", " read-only/r.csv");
        // Root may write anywhere, so the program runs as an unmapped user in a new namespace.
        let output = in_shell(&cli, "exec unshare -U \"$@\"", &line);
        set_mode(0o755);
        if stderr(&output).starts_with("unshare") {
            return report_skipped(&output);
        }
        assert_one_line_error(&output, "permission to write there; choose", "read-only/");
        assert_eq!(cli.file_names("read-only"), [name], "{line}");
        let content = fs::read_to_string(cli.path("read-only").join(name)).expect("read");
        assert_eq!(content, EARLIER, "{line}");
    }
}

#[test]
fn frames_written_before_a_disk_is_full_are_complete() {
    let cli = with_earlier_file("x.txt");
    let line = "render a.obj b.obj --frames 400 --size 320x240 --out f/####.png --ground #aabbcc";
    let script = "mount -t tmpfs -o size=400k tmpfs disk || exit 77\n\
        cp *.obj disk && cd disk\n\"$@\"\ncode=$?\ncp -r f ../saved; ls -A f; exit $code";
    fs::create_dir(cli.path("disk")).expect("made");
    let output = in_shell(
        &cli,
        &format!("unshare -rm sh -c '{script}' sh \"$@\""),
        line,
    );
    if output.status.code() == Some(77) {
        return report_skipped(&output);
    }
    assert_one_line_error(&output, "the disk is full", "f/0");
    let names = cli.file_names("saved");
    assert!(names.len() > 3, "{names:?}");
    for (number, name) in names.iter().enumerate() {
        assert_eq!(*name, format!("{number:04}.png"));
        assert_eq!(
            read_image(&cli.path("saved").join(name)).dimensions(),
            (320, 240)
        );
    }
}

#[test]
fn folders_devices_and_pipes_are_not_replaced() {
    let cli = with_earlier_file("x");
    fs::create_dir(cli.path("folder.png")).expect("made");
    let status = Command::new("mkfifo").arg(cli.path("pipe.svg")).status();
    assert!(status.expect("mkfifo runs").success());
    let before = cli.file_names(".");
    for (out, text) in [
        ("--at 0 --out folder.png/none/x.png", "does not exist"),
        ("--at 0 --out a.obj/x.png", "not a folder"),
        ("--at 0 --out pipe.svg", "a device or a pipe"),
    ] {
        let output = cli.run(&format!("render a.obj b.obj --size 8x8 {out}"));
        assert_one_line_error(&output, text, output_name(out));
    }
    let line = "check --pairs pairs.csv --samples 3 --out /dev/full";
    assert_one_line_error(&cli.run(line), "it is not a file", "/dev/full");
    assert_eq!(cli.file_names("."), before);
}

#[test]
fn a_full_stdout_is_reported_in_one_line_and_a_closed_one_is_ignored() {
    let cli = with_earlier_file("x");
    for line in [
        "check a.obj b.obj --samples 3",
        "check a.obj b.obj --samples 3 --json",
        "check --pairs pairs.csv --samples 3 --out x.csv",
        "gallery",
        "gallery --json",
        "--help",
        "--version",
    ] {
        let output = in_shell(&cli, "exec \"$@\" > /dev/full", line);
        assert_one_line_error(&output, "stdout", "space");
        let output = in_shell(&cli, "\"$@\" | head -0", line);
        assert!(output.status.success(), "{line}: {}", stderr(&output));
        let message = stderr(&output);
        assert!(!message.contains("panicked"), "{line}: {message}");
    }
    // A command succeeds even if its messages cannot be written.
    let output = in_shell(&cli, "exec \"$@\" 2> /dev/full", "gallery");
    assert!(output.status.success());
}
