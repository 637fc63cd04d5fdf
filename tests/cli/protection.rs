//! Tests that no command loses a file: inputs are never written over, under whatever name;
//! existing projects are not replaced unasked; links stay links; and a limit on the size of files
//! is an error.

use std::fs;

use crate::cli_fixture::{CliFixture, stderr};

/// Runs a command that would write over the input `input`; asserts that it is refused with a
/// message that names the output and the input, and that the folder stays as it was.
fn assert_refused(cli: &CliFixture, line: &str, output: &str, input: &str) {
    let names = cli.file_names(".");
    let before = fs::read(cli.path(input)).expect("an input");
    let message = format!("writing `{output}` would replace the input `{input}`; choose another");
    cli.fails(2, line, &message);
    assert_eq!(fs::read(cli.path(input)).expect("read"), before, "{line}");
    assert_eq!(cli.file_names("."), names, "{line}");
}

#[test]
fn render_never_writes_over_its_inputs() {
    let cli = CliFixture::new();
    cli.succeeds("render a.svg b.svg --at 0 --size 60x40 --out photo-1.png");
    fs::copy(cli.path("photo-1.png"), cli.path("photo-2.png")).expect("copied");
    cli.write("ring.json", "[[0, 0], [20, 0], [20, 20], [0, 20]]");
    for (line, output) in [
        ("photo-1.png photo-2.png --at 0.5", "photo-2.png"),
        ("photo-1.png photo-2.png --at 0.5", "./photo-1.png"),
        ("photo-1.png photo-2.png --sheet 3", "photo-1.png"),
        ("photo-1.png photo-2.png --compare", "photo-1.png"),
        ("photo-1.png photo-2.png --map 2x2", "photo-1.png"),
        ("a.svg ring.json", "ring.json"),
        ("a.svg b.svg", "a.svg"),
        ("a.svg#x b.svg", "a.svg"),
    ] {
        let line = format!("render {line} --out {output}");
        assert_refused(&cli, &line, output, output.trim_start_matches("./"));
    }
    let frames = "render photo-1.png photo-2.png --method field --cells 40 --out photo-#.png";
    let line = format!("{frames} --frames 3");
    assert_refused(&cli, &line, "photo-1.png", "photo-1.png");
    // Frames with other numbers may be written next to the inputs.
    cli.succeeds(&format!(
        "{frames} --frames 5 --frames-range 3..5 --size 8x8"
    ));
    assert!(cli.path("photo-4.png").exists());
}

#[test]
fn render_never_writes_over_the_files_that_a_project_names() {
    let cli = CliFixture::new();
    fs::create_dir(cli.path("deep")).expect("made");
    fs::write(cli.path("light.svg"), epaint_default_fonts::UBUNTU_LIGHT).expect("written");
    cli.succeeds("new a.svg glyph:D@./light.svg --out deep/p.morph");
    for output in ["a.svg", "light.svg"] {
        let input = format!("deep/../{output}");
        assert_refused(
            &cli,
            &format!("render deep/p.morph --out {output}"),
            output,
            &input,
        );
    }
    // The format of a project is recognised by its content only if its name ends in .morph, so the
    // output must be a link.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("deep/p.morph", cli.path("x.svg")).expect("linked");
        assert_refused(
            &cli,
            "render deep/p.morph --out x.svg",
            "x.svg",
            "deep/p.morph",
        );
    }
}

#[cfg(unix)]
#[test]
fn inputs_are_recognised_by_links_to_them() {
    let cli = CliFixture::new();
    std::os::unix::fs::symlink("a.svg", cli.path("soft.svg")).expect("linked");
    fs::hard_link(cli.path("a.svg"), cli.path("hard.svg")).expect("linked");
    for output in ["soft.svg", "hard.svg"] {
        let line = format!("render a.svg b.svg --out {output}");
        assert_refused(&cli, &line, output, "a.svg");
    }
    assert_refused(
        &cli,
        "render soft.svg b.svg --out a.svg",
        "a.svg",
        "soft.svg",
    );
    fs::hard_link(cli.path("a.svg"), cli.path("x.morph")).expect("linked");
    assert_refused(
        &cli,
        "new a.svg b.svg --force --out x.morph",
        "x.morph",
        "a.svg",
    );
    cli.write("t.csv", "source,target\na.svg,b.svg\n");
    for output in ["t.csv", "./t.csv", "hard.svg"] {
        let input = if output == "hard.svg" {
            "a.svg"
        } else {
            "t.csv"
        };
        let line = format!("check --pairs t.csv --out {output}");
        assert_refused(&cli, &line, output, input);
    }
    let line = "check --pairs t.csv --out r.csv --sheet soft.svg";
    assert_refused(&cli, line, "soft.svg", "a.svg");
}

#[test]
fn a_catalogue_never_writes_over_the_designs() {
    let cli = CliFixture::new();
    fs::create_dir(cli.path("saved")).expect("made");
    fs::rename(cli.path("a.svg"), cli.path("saved/01-Half.svg")).expect("renamed");
    let designs = ["saved/01-Half.svg", "b.svg", "b.svg"]
        .map(|path| format!("[[designs]]\npath = \"{path}\"\n"));
    let map = "[[map.kept]]\nat = [0.0, 0.0]\nname = \"Half\"\n";
    let text = format!(
        "version = 2\nquality = \"draft\"\n{}[timing]\nto = 2.0\n{map}",
        designs.concat()
    );
    cli.write("p.morph", &text);
    let input = "saved/01-Half.svg";
    assert_refused(&cli, "catalogue p.morph --out saved", input, input);
    assert_eq!(cli.file_names("saved"), ["01-Half.svg"]);
}

#[test]
fn only_one_of_ten_concurrent_new_commands_writes_the_file() {
    let cli = CliFixture::new();
    for attempt in 0..5 {
        let line = format!("new a.svg b.svg --out p{attempt}.morph");
        let start = |_| {
            let mut command = cli.command(&line);
            command.stderr(std::process::Stdio::piped());
            command.spawn().expect("the program starts")
        };
        let children: Vec<_> = (0..10).map(start).collect();
        let outputs = children.into_iter().map(|child| child.wait_with_output());
        let outputs: Vec<_> = outputs.map(|output| output.expect("it ends")).collect();
        let (written, refused): (Vec<_>, Vec<_>) =
            outputs.iter().partition(|output| output.status.success());
        assert_eq!(written.len(), 1, "{outputs:?}");
        for output in refused {
            let message = format!("`p{attempt}.morph` already exists: choose another name, or add");
            assert_eq!(output.status.code(), Some(1));
            assert!(stderr(output).contains(&message), "{}", stderr(output));
        }
        cli.succeeds(&format!(
            "render p{attempt}.morph --at 0 --size 8x8 --out x.png"
        ));
    }
    assert_eq!(
        cli.file_names(".").len(),
        4 + 5 + 1,
        "no temporary file is left"
    );
}

#[cfg(unix)]
#[test]
fn output_through_a_link_keeps_the_link() {
    let cli = CliFixture::new();
    fs::create_dir(cli.path("disk")).expect("made");
    cli.write("disk/old.svg", "the earlier content");
    for (link, target) in [("old.svg", "disk/old.svg"), ("new.svg", "disk/new.svg")] {
        std::os::unix::fs::symlink(target, cli.path(link)).expect("linked");
        cli.succeeds(&format!("render a.svg b.svg --at 0 --out {link}"));
        assert!(cli.path(link).is_symlink(), "{link}");
        let text = fs::read_to_string(cli.path(target)).expect("an image");
        assert!(text.ends_with("</svg>\n"), "{text}");
    }
    std::os::unix::fs::symlink("disk/p.morph", cli.path("p.morph")).expect("linked");
    cli.succeeds("new a.svg b.svg --out p.morph");
    assert!(cli.path("p.morph").is_symlink() && cli.path("disk/p.morph").is_file());
    std::os::unix::fs::symlink("nowhere/x.svg", cli.path("lost.svg")).expect("linked");
    let reason = "it is a link to `nowhere/x.svg`, whose folder does not exist; choose another";
    cli.fails(1, "render a.svg b.svg --at 0 --out lost.svg", reason);
    assert_eq!(cli.file_names("disk"), ["new.svg", "old.svg", "p.morph"]);
}

#[test]
fn partial_tables_of_interrupted_runs_are_removed_by_a_finished_one() {
    let cli = CliFixture::new();
    cli.write("t.csv", "source,target\na.obj,b.obj\n");
    let check = "check --pairs t.csv --samples 3 --out r.csv";
    cli.succeeds(check);
    // A partial table has the rows of a report.
    let report = fs::read_to_string(cli.path("r.csv")).expect("a report");
    cli.write("r.partial.csv", &report);
    cli.write("r.partial-2.csv", "");
    cli.write("r.partial-3.csv", "my own table\n");
    let output = cli.run(check);
    let message = stderr(&output);
    for name in ["r.partial.csv", "r.partial-2.csv"] {
        let sentence = format!("removed `{name}`, left by an interrupted run");
        assert!(message.contains(&sentence), "{message}");
        assert!(!cli.path(name).exists(), "{name}");
    }
    assert!(cli.path("r.partial-3.csv").exists());
}

/// `ulimit -f` sends a signal that ends a program, unless the program blocks or ignores it.
#[cfg(unix)]
#[test]
fn a_limit_on_the_size_of_files_is_an_error() {
    let cli = CliFixture::new();
    for line in [
        "render a.obj b.obj --at 0.5 --size 640x480 --out x.png",
        "render a.obj b.obj --frames 9 --size 320x240 --out x.gif",
        "new a.svg b.svg --out x.morph",
    ] {
        let program = cli.command(line);
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", "trap - XFSZ; ulimit -f 0; exec \"$@\"", "sh"]);
        shell.arg(program.get_program()).args(program.get_args());
        let output = shell.current_dir(cli.path(".")).output().expect("a shell");
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{line}: {message}");
        assert!(
            message.contains("larger than the system allows"),
            "{message}"
        );
        assert_eq!(cli.file_names(".").len(), 4, "{line}: nothing is left");
    }
}
