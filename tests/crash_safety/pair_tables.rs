//! `check --pairs` keeps the finished rows when it is interrupted or killed.

use std::fs;
use std::path::Path;

use crate::cli_fixture::{CliFixture, stderr};
use crate::{send, start, wait_until, with_default_signals, with_fixture_files};

/// Content that the report has before the program runs.
const EARLIER: &str = "the report of last week";

/// Number of pairs in the table, more than the program checks before it is interrupted.
const PAIRS: usize = 5_000;

/// Arguments of the program that check the table.
const CHECK_TABLE: &str =
    "check --pairs pairs.csv --samples 3 --json --out report.csv --sheet sheet.svg";

/// A fixture with a table of [`PAIRS`] equal pairs, and with an earlier report.
fn with_table() -> CliFixture {
    let cli = CliFixture::new();
    let rows: String = (0..PAIRS).map(|i| format!("{i},a.obj,b.obj\n")).collect();
    cli.write("pairs.csv", &format!("number,source,target\n{rows}"));
    cli.write("report.csv", EARLIER);
    cli
}

/// Reads the rows of a report; panics if a row has fewer or more fields than the header.
fn read_rows(path: &Path) -> Vec<csv::StringRecord> {
    let mut reader = csv::Reader::from_path(path).expect("a report");
    reader
        .records()
        .map(|row| row.expect("a whole row"))
        .collect()
}

fn line_count(path: &Path) -> usize {
    fs::read_to_string(path).unwrap_or_default().lines().count()
}

#[test]
fn an_interrupted_table_keeps_its_finished_rows() {
    for signal in ["INT", "TERM", "HUP"] {
        let cli = with_table();
        let partial = cli.path("report.partial.csv");
        let mut command = with_default_signals(&cli.command(CHECK_TABLE));
        command.stdout(fs::File::create(cli.path("summary.json")).expect("made"));
        command.stderr(std::process::Stdio::piped());
        let child = command.spawn().expect("the program starts");
        wait_until("finished rows", || line_count(&partial) > 20);
        send(signal, child.id());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        let rows = read_rows(&partial);
        let expected_message = format!(
            "{} of {PAIRS} rows are saved in `report.partial.csv`",
            rows.len()
        );
        assert!(
            stderr(&output).contains(&expected_message),
            "{expected_message}: {}",
            stderr(&output)
        );
        let status = rows
            .iter()
            .map(|row| (row[3].to_owned(), row[4].to_owned()));
        let expected = ("forward".to_owned(), "ok".to_owned());
        assert!(status.into_iter().all(|pair| pair == expected), "{signal}");
        let summary = fs::read_to_string(cli.path("summary.json")).expect("read");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        assert_eq!(summary["pairs"], PAIRS);
        assert_eq!(summary["failures"], 0);
        assert_eq!(summary["unfinished"], PAIRS - rows.len());
        // The incomplete report has another name, so the earlier report is unchanged.
        let content = fs::read_to_string(cli.path("report.csv")).expect("read");
        assert_eq!(content, EARLIER);
        let names = [
            "pairs.csv",
            "report.csv",
            "report.partial.csv",
            "summary.json",
        ];
        assert_eq!(cli.file_names("."), with_fixture_files(&names), "{signal}");
    }
}

#[test]
fn a_killed_table_keeps_its_finished_rows() {
    let cli = with_table();
    for name in ["report.partial.csv", "report.partial-2.csv"] {
        let child = start(cli.command(CHECK_TABLE));
        wait_until("finished rows", || line_count(&cli.path(name)) > 20);
        send("KILL", child.id());
        child.wait_with_output().expect("it ends");
        assert!(read_rows(&cli.path(name)).len() >= 20, "{name}");
    }
}

#[test]
fn a_finished_table_leaves_only_its_report_and_sheet() {
    let cli = with_table();
    cli.write("pairs.csv", "source,target\na.obj,b.obj\na.svg,none.svg\n");
    let output = cli.run(CHECK_TABLE);
    assert!(
        stderr(&output).contains("1 of 2 pairs failed"),
        "{}",
        stderr(&output)
    );
    assert_eq!(read_rows(&cli.path("report.csv")).len(), 2);
    let names = ["pairs.csv", "report.csv", "sheet.svg"];
    assert_eq!(cli.file_names("."), with_fixture_files(&names));
}

#[test]
#[expect(clippy::print_stderr, reason = "a skipped test is reported")]
fn a_terminal_shows_the_progress_of_a_table() {
    let cli = with_table();
    let rows = "a.obj,b.obj\n".repeat(40);
    cli.write("pairs.csv", &format!("source,target\n{rows}"));
    let program = cli.command("").get_program().to_owned();
    // The program `script` runs the command in a terminal and prints the terminal's output.
    let mut script = std::process::Command::new("script");
    let line = format!("'{}' {CHECK_TABLE}", program.display());
    script.args(["-qec", &line, "/dev/null"]);
    script.current_dir(cli.path("."));
    let Ok(output) = script.stdin(std::process::Stdio::null()).output() else {
        eprintln!("NOT TESTED: progress in a terminal, because `script` is not installed");
        return;
    };
    let shown = String::from_utf8_lossy(&output.stdout);
    for share in ["checking pairs   0 %", "checking pairs  50 %"] {
        assert!(shown.contains(share), "{share}: {shown:?}");
    }
    assert!(
        shown.contains("wrote report.csv and sheet.svg"),
        "{shown:?}"
    );
}

#[test]
fn an_interruption_before_the_first_row_leaves_no_report() {
    let cli = with_table();
    // The program is interrupted once it handles signals and most likely before the first pair is
    // finished.
    let child = start(cli.command(&format!("{CHECK_TABLE} --cells 4096 --method field")));
    wait_until("start of the work", || {
        cli.path("report.partial.csv").exists()
    });
    send("TERM", child.id());
    let output = child.wait_with_output().expect("it ends");
    let message = stderr(&output);
    let names = cli.file_names(".");
    match message.contains("before any of") {
        true => assert_eq!(names, with_fixture_files(&["pairs.csv", "report.csv"])),
        false => assert!(message.contains("rows are saved"), "{message}"),
    }
}
