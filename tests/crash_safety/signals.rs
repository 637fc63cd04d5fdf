//! Interrupting or killing the program at any time leaves earlier output files unchanged. An
//! interrupted program removes its temporary files itself; those of a killed one are removed by the
//! next run.

use std::fs;
use std::time::Duration;

use crate::cli_fixture::{CliFixture, read_image, stderr};
use crate::{
    command_with_fake, fake_ffmpeg, is_alive, partial_files, send, start, wait_until,
    with_fixture_files,
};

/// Content that an output file has before the program runs.
const EARLIER: &str = "the earlier content";

/// Signals that ask a program to end and that it can handle in order to clean up.
const END_SIGNALS: [&str; 3] = ["INT", "TERM", "HUP"];

/// Arguments that render a film for longer than any test waits; a test appends the file name.
const LONG_FILM: &str = "render a.obj b.obj --frames 100000 --size 320x240 --out";

#[test]
fn interrupting_a_film_leaves_only_the_earlier_one() {
    for name in ["film.gif", "film.apng"] {
        for signal in END_SIGNALS {
            let cli = CliFixture::new();
            cli.write(name, EARLIER);
            let mut child = start(cli.command(&format!("{LONG_FILM} {name}")));
            wait_until("temporary file", || partial_files(&cli).len() == 1);
            // When a terminal closes, the terminal and its shell each send the signal, so that the
            // program receives it twice.
            send(signal, child.id());
            send(signal, child.id());
            wait_until("exit", || child.try_wait().expect("a child").is_some());
            let output = child.wait_with_output().expect("its output");
            assert_eq!(
                output.status.code(),
                Some(1),
                "{signal}: {}",
                stderr(&output)
            );
            assert!(stderr(&output).contains("cancelled"), "{}", stderr(&output));
            assert_eq!(cli.file_names("."), with_fixture_files(&[name]), "{signal}");
            assert_eq!(fs::read_to_string(cli.path(name)).expect("read"), EARLIER);
        }
    }
}

#[test]
fn interrupting_the_program_ends_a_hanging_encoder() {
    // An encoder that writes part of a file, reads no frames and never ends.
    const HANGS: &str = "printf half > \"$out\"\necho $$ > pid\nexec sleep 1000";
    // An encoder that first reads all frames, so that the program waits for it to exit.
    let at_end = format!("cat > /dev/null\n{HANGS}");
    for (script, frames) in [(HANGS, 100_000), (&at_end, 3)] {
        for signal in END_SIGNALS {
            let cli = CliFixture::new();
            cli.write("film.mp4", EARLIER);
            fake_ffmpeg(&cli, script);
            let line =
                format!("render a.obj b.obj --frames {frames} --size 320x240 --out film.mp4");
            let mut child = start(command_with_fake(&cli, &line));
            let process_id = || fs::read_to_string(cli.path("pid")).unwrap_or_default();
            wait_until("process id of ffmpeg", || process_id().ends_with('\n'));
            send(signal, child.id());
            wait_until("exit", || child.try_wait().expect("a child").is_some());
            assert!(
                !is_alive(process_id().trim()),
                "{signal}: ffmpeg still runs"
            );
            let expected = with_fixture_files(&["bin", "film.mp4", "pid"]);
            assert_eq!(cli.file_names("."), expected, "{signal}");
            let content = fs::read_to_string(cli.path("film.mp4")).expect("read");
            assert_eq!(content, EARLIER);
        }
    }
}

/// Arguments of quick commands, each with the characters that end its complete output file.
const QUICK_COMMANDS: [(&str, &str); 4] = [
    (
        "render a.obj b.obj --at 0.5 --size 64x48 --out x.png",
        "IEND\u{fffd}B`\u{fffd}",
    ),
    ("render a.obj b.obj --sheet 9 --out x.svg", "</svg>\n"),
    ("new a.svg b.svg --force --out x.morph", "\n"),
    ("check --pairs pairs.csv --samples 3 --out x.csv", "\n"),
];

#[test]
fn an_interrupted_command_leaves_the_earlier_or_the_complete_file() {
    for (line, end) in QUICK_COMMANDS {
        let name = line.rsplit(' ').next().expect("a name");
        let cli = CliFixture::new();
        cli.write("pairs.csv", "source,target\na.obj,b.obj\n");
        cli.write(name, EARLIER);
        for attempt in 0..24 {
            let child = start(cli.command(line));
            // Each attempt waits longer. The first signals arrive before the program handles
            // signals, the last ones after it has ended.
            std::thread::sleep(Duration::from_millis(3 * attempt));
            send(END_SIGNALS[attempt as usize % 3], child.id());
            let output = child.wait_with_output().expect("it ends");
            assert!(!stderr(&output).contains("panicked"), "{}", stderr(&output));
            assert_eq!(
                cli.file_names("."),
                with_fixture_files(&["pairs.csv", name]),
                "{line}"
            );
            let content = fs::read(cli.path(name)).expect("read");
            let content = String::from_utf8_lossy(&content);
            assert!(
                content == EARLIER || content.ends_with(end),
                "{line}: {content}"
            );
        }
    }
}

#[test]
fn frames_of_an_interrupted_run_are_complete() {
    for signal in ["TERM", "KILL"] {
        let cli = CliFixture::new();
        let child = start(cli.command(&format!("{LONG_FILM} f/#####.png")));
        let frames = || {
            let names = fs::read_dir(cli.path("f")).map(|_| cli.file_names("f"));
            let mut names = names.unwrap_or_default();
            names.retain(|name| !name.ends_with(".part"));
            names
        };
        wait_until("frames", || frames().len() > 20);
        send(signal, child.id());
        child.wait_with_output().expect("it ends");
        let frames = frames();
        for (number, name) in frames.iter().enumerate() {
            assert_eq!(
                *name,
                format!("{number:05}.png"),
                "{signal}: no number is missing"
            );
            assert_eq!(
                read_image(&cli.path("f").join(name)).dimensions(),
                (320, 240)
            );
        }
        if signal == "TERM" {
            assert_eq!(cli.file_names("f"), frames, "no temporary file is left");
        }
    }
}

#[test]
fn temporary_files_of_killed_processes_are_removed_by_the_next_run() {
    let cli = CliFixture::new();
    cli.write("film.gif", EARLIER);
    cli.write(".someone.part", "not ours");
    let mut killed = Vec::new();
    for _ in 0..3 {
        let child = start(cli.command(&format!("{LONG_FILM} film.gif")));
        let id = child.id();
        let temporary = format!(".film.gif.morphospace-{id}-0.part");
        wait_until("temporary file", || {
            partial_files(&cli).contains(&temporary)
        });
        killed.push((child, temporary));
    }
    assert_eq!(
        partial_files(&cli).len(),
        4,
        "a start leaves the files of running processes alone"
    );
    for (child, temporary) in killed {
        send("KILL", child.id());
        child.wait_with_output().expect("it ends");
        assert!(
            partial_files(&cli).contains(&temporary),
            "{temporary} remains after a kill"
        );
    }
    cli.succeeds("render a.obj b.obj --at 0.5 --size 8x8 --out still.png");
    let expected = with_fixture_files(&[".someone.part", "film.gif", "still.png"]);
    assert_eq!(cli.file_names("."), expected);
    let content = fs::read_to_string(cli.path("film.gif")).expect("read");
    assert_eq!(content, EARLIER);
}

#[test]
fn a_rerun_after_kills_leaves_only_results() {
    for (line, end) in QUICK_COMMANDS {
        let name = line.rsplit(' ').next().expect("a name");
        let cli = CliFixture::new();
        cli.write("pairs.csv", "source,target\na.obj,b.obj\n");
        for attempt in 0..20 {
            let child = start(cli.command(line));
            std::thread::sleep(Duration::from_millis(3 * attempt));
            send("KILL", child.id());
            child.wait_with_output().expect("it ends");
            let content = fs::read(cli.path(name)).unwrap_or_default();
            let content = String::from_utf8_lossy(&content);
            assert!(
                content.is_empty() || content.ends_with(end),
                "{line}: {content}"
            );
        }
        cli.succeeds(line);
        let names = cli.file_names(".");
        assert_eq!(names, with_fixture_files(&["pairs.csv", name]), "{line}");
    }
}

#[test]
fn a_run_with_ignored_hangup_survives_its_terminal() {
    let cli = CliFixture::new();
    let line = format!("{LONG_FILM} film.gif");
    let program = cli.command(&line);
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]);
    shell.arg(program.get_program()).args(program.get_args());
    shell.current_dir(cli.path("."));
    let mut child = start(shell);
    wait_until("temporary file", || partial_files(&cli).len() == 1);
    send("HUP", child.id());
    std::thread::sleep(Duration::from_millis(300));
    assert!(
        child.try_wait().expect("a child").is_none(),
        "the program still runs"
    );
    child.kill().expect("killed");
    child.wait().expect("it ends");
}
