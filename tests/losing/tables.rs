//! The rows of a table that are done are kept, however the work ends.

use std::fs;
use std::path::Path;

use crate::workshop::{Workshop, words};
use crate::{listening, send, started, wait_until, with_own};

const EARLIER: &str = "the report of last week";

/// More than are done before it is ended.
const PAIRS: usize = 5_000;

const LINE: &str = "check --pairs pairs.csv --samples 3 --json --out report.csv --sheet sheet.svg";

fn shop() -> Workshop {
    let shop = Workshop::new();
    let rows: String = (0..PAIRS).map(|i| format!("{i},a.obj,b.obj\n")).collect();
    shop.put("pairs.csv", &format!("number,source,target\n{rows}"));
    shop.put("report.csv", EARLIER);
    shop
}

/// The rows of a report, each as long as its header.
fn rows(path: &Path) -> Vec<csv::StringRecord> {
    let mut reader = csv::Reader::from_path(path).expect("a report");
    reader
        .records()
        .map(|row| row.expect("a whole row"))
        .collect()
}

fn lines(path: &Path) -> usize {
    fs::read_to_string(path).unwrap_or_default().lines().count()
}

#[test]
fn a_table_that_is_ended_keeps_the_rows_that_are_done() {
    for wish in ["INT", "TERM", "HUP"] {
        let shop = shop();
        let partial = shop.path("report.partial.csv");
        let mut command = listening(&shop.command(LINE));
        command.stdout(fs::File::create(shop.path("summary.json")).expect("made"));
        command.stderr(std::process::Stdio::piped());
        let child = command.spawn().expect("the program starts");
        wait_until("rows", || lines(&partial) > 20);
        send(wish, child.id());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.code(), Some(1), "{}", words(&output));
        let rows = rows(&partial);
        let told = format!(
            "{} of {PAIRS} rows are kept in `report.partial.csv`",
            rows.len()
        );
        assert!(words(&output).contains(&told), "{told}: {}", words(&output));
        let status = rows
            .iter()
            .map(|row| (row[3].to_owned(), row[4].to_owned()));
        let expected = ("forward".to_owned(), "ok".to_owned());
        assert!(status.into_iter().all(|found| found == expected), "{wish}");
        let summary = fs::read_to_string(shop.path("summary.json")).expect("read");
        let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
        assert_eq!(summary["pairs"], PAIRS);
        assert_eq!(summary["failures"], 0);
        assert_eq!(summary["unfinished"], PAIRS - rows.len());
        // Nothing that is not whole takes the place of what is.
        let kept = fs::read_to_string(shop.path("report.csv")).expect("read");
        assert_eq!(kept, EARLIER);
        let names = [
            "pairs.csv",
            "report.csv",
            "report.partial.csv",
            "summary.json",
        ];
        assert_eq!(shop.names("."), with_own(&names), "{wish}");
    }
}

#[test]
fn a_table_that_is_killed_keeps_the_rows_that_are_done() {
    let shop = shop();
    for name in ["report.partial.csv", "report.partial-2.csv"] {
        let child = started(shop.command(LINE));
        wait_until("rows", || lines(&shop.path(name)) > 20);
        send("KILL", child.id());
        child.wait_with_output().expect("it ends");
        assert!(rows(&shop.path(name)).len() >= 20, "{name}");
    }
}

#[test]
fn a_table_that_comes_to_its_end_leaves_its_report_alone() {
    let shop = shop();
    shop.put("pairs.csv", "source,target\na.obj,b.obj\na.svg,none.svg\n");
    let output = shop.run(LINE);
    assert!(
        words(&output).contains("1 of 2 pairs failed"),
        "{}",
        words(&output)
    );
    assert_eq!(rows(&shop.path("report.csv")).len(), 2);
    let names = ["pairs.csv", "report.csv", "sheet.svg"];
    assert_eq!(shop.names("."), with_own(&names));
}

#[test]
#[expect(clippy::print_stderr, reason = "a test that cannot run says so")]
fn a_terminal_is_told_how_far_a_table_is() {
    let shop = shop();
    let rows = "a.obj,b.obj\n".repeat(40);
    shop.put("pairs.csv", &format!("source,target\n{rows}"));
    let program = shop.command("").get_program().to_owned();
    // Gives the command a terminal, and shows what that shows.
    let mut script = std::process::Command::new("script");
    let line = format!("'{}' {LINE}", program.display());
    script.args(["-qec", &line, "/dev/null"]);
    script.current_dir(shop.path("."));
    let Ok(output) = script.stdin(std::process::Stdio::null()).output() else {
        eprintln!("NOT TESTED: what a terminal shows, for there is no `script`");
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
fn an_end_before_the_first_row_leaves_nothing() {
    let shop = shop();
    // It is ended before any pair is done, and not before it listens.
    let child = started(shop.command(&format!("{LINE} --cells 4096 --method field")));
    wait_until("the work", || shop.path("report.partial.csv").exists());
    send("TERM", child.id());
    let output = child.wait_with_output().expect("it ends");
    let said = words(&output);
    let names = shop.names(".");
    match said.contains("before one of") {
        true => assert_eq!(names, with_own(&["pairs.csv", "report.csv"])),
        false => assert!(said.contains("rows are kept"), "{said}"),
    }
}
