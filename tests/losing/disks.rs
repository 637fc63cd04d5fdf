//! Disks that are full or can only be read, files that may not grow, and
//! readers that had enough: one line, a way out, and the earlier file stays.

use std::fs;
use std::process::{Command, Output, Stdio};

use crate::with_own;
use crate::workshop::{Workshop, image, words};

const EARLIER: &str = "what was there before";

/// Every kind of output; its file is the last word.
const KINDS: [&str; 8] = [
    "render a.obj b.obj --at 0.5 --size 640x480 --out x.png",
    "render a.obj b.obj --sheet 60 --out x.svg",
    "render a.obj b.obj --sheet 9 --out x.png",
    "render a.obj b.obj --frames 60 --size 320x240 --out x.gif",
    "render a.obj b.obj --frames 60 --size 320x240 --out x.apng",
    "new a.svg b.svg --force --out x.morph",
    "check --pairs pairs.csv --samples 3 --out x.csv",
    "check --pairs pairs.csv --samples 3 --out r.csv --sheet x.png",
];

fn file_of(line: &str) -> &str {
    line.rsplit(' ').next().expect("a name")
}

/// A shop where every kind can be made.
fn shop_with(name: &str) -> Workshop {
    let shop = Workshop::new();
    shop.put("pairs.csv", "source,target\na.obj,b.obj\n");
    shop.put(name, EARLIER);
    shop
}

/// A command run by a shell that says something first; the command is `"$@"`.
fn in_shell(shop: &Workshop, script: &str, line: &str) -> Output {
    let program = shop.command(line);
    let mut shell = Command::new("sh");
    shell.args(["-c", script, "sh"]);
    shell.arg(program.get_program()).args(program.get_args());
    shell.current_dir(shop.path(".")).stdin(Stdio::null());
    shell.output().expect("a shell")
}

fn is_one_line(output: &Output, told: &str, name: &str) {
    let said = words(output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains(told) && said.contains(name), "{said}");
    assert!(!said.contains("morphospace-"), "a temporary name: {said}");
}

#[test]
fn a_file_that_may_not_grow_leaves_the_earlier_one() {
    for line in KINDS {
        let name = file_of(line);
        // No byte, and some.
        for blocks in [0, 1] {
            let shop = shop_with(name);
            let limit = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
            let output = in_shell(&shop, &limit, line);
            // A small project fits.
            if blocks > 0 && output.status.success() {
                continue;
            }
            let name = if line.contains("r.csv") {
                "r.csv"
            } else {
                name
            };
            is_one_line(&output, "larger than the system allows", name);
            let kept = fs::read_to_string(shop.path(file_of(line))).expect("read");
            assert_eq!(kept, EARLIER, "{line}");
            let left = with_own(&["pairs.csv", file_of(line)]);
            assert_eq!(shop.names("."), left, "{line}");
        }
    }
}

/// Runs a command in a folder on a disk of its own, of so many kilobytes. The
/// disk is nobody else's and gone afterwards, so that what is on it at the end
/// comes as data: the earlier file, then all names. None where the system lets
/// nobody have a disk.
fn on_disk(shop: &Workshop, kilobytes: u32, mode: &str, line: &str) -> Option<Output> {
    let name = file_of(line);
    fs::create_dir_all(shop.path("disk")).expect("made");
    let script = format!(
        "mount -t tmpfs -o size={kilobytes}k tmpfs disk || exit 77\n\
         cp *.* disk && cd disk\n\
         mount -o remount,{mode} . || exit 77\n\
         \"$@\"\ncode=$?\ncat {name}\nls -A\nexit $code"
    );
    let output = in_shell(
        shop,
        &format!("unshare -rm sh -c '{script}' sh \"$@\""),
        line,
    );
    if !matches!(output.status.code(), Some(0..=2)) {
        not_tested(&output);
        return None;
    }
    Some(output)
}

#[expect(clippy::print_stderr, reason = "a test that cannot run says so")]
fn not_tested(output: &Output) {
    let said = words(output);
    eprintln!("NOT TESTED: full and shut disks, for the system gives nobody one: {said}");
}

#[test]
fn a_full_disk_says_so_and_leaves_the_earlier_file() {
    // The real one, where there is one: what it says of it is its own.
    let ffmpeg = Command::new("ffmpeg").arg("-version").output();
    let film = "render a.obj b.obj --frames 60 --size 320x240 --out x.mp4";
    for line in KINDS.into_iter().chain(ffmpeg.map(|_| film)) {
        let name = file_of(line);
        let shop = shop_with(name);
        // The designs and the earlier file take a page each; so would the new one.
        for kilobytes in [24, 28, 32] {
            let Some(output) = on_disk(&shop, kilobytes, "rw", line) else {
                return;
            };
            if output.status.success() {
                continue;
            }
            // A report has its rows and its sheet beside it.
            is_one_line(&output, "the disk is full; make room on it", "");
            let there = String::from_utf8_lossy(&output.stdout);
            assert!(there.starts_with(EARLIER), "{line}: {there}");
            assert!(!there.contains(".part\n"), "{line}: {there}");
        }
    }
}

#[test]
fn a_disk_that_can_only_be_read_says_so() {
    for line in KINDS {
        let shop = shop_with(file_of(line));
        let Some(output) = on_disk(&shop, 999, "ro", line) else {
            return;
        };
        is_one_line(&output, "can only be read; choose a folder", ".");
    }
}

#[test]
fn a_folder_that_may_not_be_written_to_says_so() {
    use std::os::unix::fs::PermissionsExt;
    for line in KINDS {
        let name = file_of(line);
        let shop = shop_with(name);
        fs::create_dir(shop.path("shut")).expect("made");
        fs::copy(shop.path(name), shop.path("shut").join(name)).expect("copied");
        let set = |mode| {
            let mode = fs::Permissions::from_mode(mode);
            fs::set_permissions(shop.path("shut"), mode).expect("set");
        };
        set(0o555);
        let line = line.replace(&format!(" {name}"), &format!(" shut/{name}"));
        let line = line.replace(" r.csv", " shut/r.csv");
        // Root may write anywhere, but not from a user namespace of its own.
        let output = in_shell(&shop, "exec unshare -U \"$@\"", &line);
        set(0o755);
        if words(&output).starts_with("unshare") {
            return not_tested(&output);
        }
        is_one_line(&output, "does not let you write there; choose", "shut/");
        assert_eq!(shop.names("shut"), [name], "{line}");
        let kept = fs::read_to_string(shop.path("shut").join(name)).expect("read");
        assert_eq!(kept, EARLIER, "{line}");
    }
}

#[test]
fn numbered_frames_on_a_full_disk_are_whole_as_far_as_they_came() {
    let shop = shop_with("x.txt");
    let line = "render a.obj b.obj --frames 400 --size 320x240 --out f/####.png --ground #aabbcc";
    let script = "mount -t tmpfs -o size=400k tmpfs disk || exit 77\n\
        cp *.obj disk && cd disk\n\"$@\"\ncode=$?\ncp -r f ../kept; ls -A f; exit $code";
    fs::create_dir(shop.path("disk")).expect("made");
    let output = in_shell(
        &shop,
        &format!("unshare -rm sh -c '{script}' sh \"$@\""),
        line,
    );
    if output.status.code() == Some(77) {
        return not_tested(&output);
    }
    is_one_line(&output, "the disk is full", "f/0");
    let names = shop.names("kept");
    assert!(names.len() > 3, "{names:?}");
    for (number, name) in names.iter().enumerate() {
        assert_eq!(*name, format!("{number:04}.png"));
        assert_eq!(
            image(&shop.path("kept").join(name)).dimensions(),
            (320, 240)
        );
    }
}

#[test]
fn a_folder_a_device_and_a_pipe_are_not_replaced() {
    let shop = shop_with("x");
    fs::create_dir(shop.path("folder.png")).expect("made");
    let made = Command::new("mkfifo").arg(shop.path("pipe.svg")).status();
    assert!(made.expect("mkfifo runs").success());
    let before = shop.names(".");
    for (out, told) in [
        ("--at 0 --out folder.png/none/x.png", "does not exist"),
        ("--at 0 --out a.obj/x.png", "no folder"),
        ("--at 0 --out pipe.svg", "a device or a pipe"),
    ] {
        let output = shop.run(&format!("render a.obj b.obj --size 8x8 {out}"));
        is_one_line(&output, told, file_of(out));
    }
    let line = "check --pairs pairs.csv --samples 3 --out /dev/full";
    is_one_line(&shop.run(line), "it is no file", "/dev/full");
    assert_eq!(shop.names("."), before);
}

#[test]
fn data_that_cannot_be_written_is_a_failure_in_one_line() {
    let shop = shop_with("x");
    for line in [
        "check a.obj b.obj --samples 3",
        "check a.obj b.obj --samples 3 --json",
        "check --pairs pairs.csv --samples 3 --out x.csv",
        "gallery",
        "gallery --json",
        "--help",
        "--version",
    ] {
        let output = in_shell(&shop, "exec \"$@\" > /dev/full", line);
        is_one_line(&output, "stdout", "space");
        let output = in_shell(&shop, "\"$@\" | head -0", line);
        assert!(output.status.success(), "{line}: {}", words(&output));
        let said = words(&output);
        assert!(!said.contains("panicked"), "{line}: {said}");
    }
    // Nobody hears it, and that is no reason to fail.
    let deaf = in_shell(&shop, "exec \"$@\" 2> /dev/full", "gallery");
    assert!(deaf.status.success());
}
