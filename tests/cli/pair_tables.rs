//! Tests of `check --pairs`: the report has a row for each pair of the table, also if the pair
//! fails; with `--both` it has two rows, one for each direction. Invalid tables are refused.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use crate::cli_fixture::{CliFixture, read_image, stderr};

/// Reads the rows of a report; each maps column names to values.
fn read_report(path: &Path) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).expect("a report");
    let rows = reader.deserialize();
    rows.map(|row| row.expect("a row")).collect()
}

#[test]
fn each_pair_has_a_row_in_each_direction() {
    let cli = CliFixture::new();
    fs::create_dir(cli.path("sub")).expect("made");
    cli.write(
        "sub/pairs.csv",
        "\u{feff}kind,source,target\n\"a, \"\"b\"\"\",../a.obj,../b.obj\ndrawn,../a.svg,../b.svg\n",
    );
    let line = "check --pairs sub/pairs.csv --out report.csv --sheet sheet.png --samples 5";
    let summary = cli.succeeds(&format!("{line} --both"));
    assert!(summary.starts_with("pairs  "), "{summary}");
    let report = read_report(&cli.path("report.csv"));
    let directions: Vec<_> = report.iter().map(|row| row["direction"].as_str()).collect();
    assert_eq!(directions, ["forward", "backward", "forward", "backward"]);
    assert_eq!(report[1]["kind"], "a, \"b\"");
    for row in &report {
        let values = ["status", "samples", "method"].map(|column| row[column].as_str());
        assert_eq!(values, ["ok", "5", "arap"]);
        for column in ["build_s", "match_and_triangulate_s", "conformal_worst"] {
            assert!(
                row[column].parse::<f64>().expect("a number") > 0.0,
                "{column}"
            );
        }
    }
    let worst = |row: usize| report[row]["conformal_worst"].parse::<f64>();
    let [forward, backward] = [worst(0), worst(1)].map(|x| x.expect("a number"));
    assert!(
        (forward / backward - 1.0).abs() < 1e-9,
        "{forward} {backward}"
    );
    assert!(read_image(&cli.path("sheet.png")).width() > 600);
    assert_eq!(cli.file_names(".").len(), 7, "no temporary file is left");
}

#[test]
fn a_table_of_bitmap_images_is_checked_to_its_end() {
    let cli = CliFixture::new();
    for (t, name) in [(0, "x.png"), (1, "y.png")] {
        cli.succeeds(&format!(
            "render a.svg b.svg --at {t} --size 120x120 --out {name}"
        ));
    }
    let pairs = "x.png,y.png\ny.png,x.png\n".repeat(3);
    cli.write("pairs.csv", &format!("source,target\n{pairs}"));
    cli.succeeds("check --pairs pairs.csv --out r.csv --samples 3 --quality draft");
    let report = read_report(&cli.path("r.csv"));
    assert_eq!(report.len(), 6);
    assert!(report.iter().all(|row| row["status"] == "ok"), "{report:?}");
}

#[test]
fn a_report_of_field_blends_replaces_the_previous_file() {
    let cli = CliFixture::new();
    cli.write("pairs.csv", "source,target\na.svg,b.obj\n");
    cli.write("report.csv", "old");
    let line = "check --pairs pairs.csv --out report.csv --method field --cells 48 --samples 5";
    let json = cli.succeeds(&format!("{line} --json"));
    let summary: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        (&summary["pairs"], &summary["failures"]),
        (&1.into(), &0.into())
    );
    let report = read_report(&cli.path("report.csv"));
    let values = ["method", "faces", "grid_width_cells"].map(|column| report[0][column].as_str());
    assert_eq!(values, ["field", "", "48"]);
    assert_eq!(report[0]["pieces_excess"].parse::<usize>(), Ok(0));
}

#[test]
fn failed_pairs_do_not_stop_a_table() {
    let cli = CliFixture::new();
    cli.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
    cli.write(
        "pairs.csv",
        "source,target,kind\nnone.obj,a.obj,1\na.obj,bad.obj,2\na.obj,b.obj\n,b.obj,4\na.obj,.,5\na.obj,b.obj,6\n",
    );
    let output = cli.run("check --pairs pairs.csv --out r.csv --sheet s.svg --samples 3");
    let messages = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{messages}");
    assert!(
        messages.contains("5 of 6 pairs failed, the first in line 2"),
        "{messages}"
    );
    assert!(!messages.contains("panicked"), "{messages}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("failures"));
    let report = read_report(&cli.path("r.csv"));
    let statuses: Vec<_> = report.iter().map(|row| row["status"].as_str()).collect();
    for (status, reason) in statuses
        .iter()
        .zip(["none.obj", "bad.obj", "2 cells", "empty", ""])
    {
        assert!(status.contains(reason) && *status != "ok", "{status}");
    }
    assert_eq!(statuses[5], "ok");
    assert_eq!(
        (report[0]["kind"].as_str(), report[2]["kind"].as_str()),
        ("1", "")
    );
    let svg = fs::read_to_string(cli.path("s.svg")).expect("a sheet");
    assert!(svg.contains("failed") && svg.contains("a to b"));
}

#[test]
fn invalid_tables_are_refused_with_a_reason() {
    let cli = CliFixture::new();
    let check = |name: &str| format!("check --pairs {name} --out out.csv");
    cli.fails(1, &check("missing.csv"), "missing.csv");
    cli.fails(1, &check("."), "choose a file in it");
    for (text, reason) in [
        ("", "empty"),
        ("source,target\n", "no pairs"),
        ("source,kind\na,b\n", "no column `target`"),
        ("source;target\na;b\n", "separate columns by commas"),
        (
            "source,target,target\na,b,c\n",
            "two columns are called `target`",
        ),
        ("source,target,faces\na,b,c\n", "`faces`"),
        ("\"source,target\na,b\n", "no column"),
    ] {
        cli.write("t.csv", text);
        cli.fails(1, &check("t.csv"), reason);
    }
    fs::write(cli.path("t.csv"), b"\xff\xfes\0o\0u\0").expect("written");
    cli.fails(1, &check("t.csv"), "UTF-8");
    fs::write(cli.path("t.csv"), b"source,target\n\xff.obj,a.obj\n").expect("written");
    let output = cli.run(&check("t.csv"));
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    let report = fs::read(cli.path("out.csv")).expect("a report");
    assert!(
        report.windows(5).any(|w| w == b"\xff.obj"),
        "a name that is not UTF-8 is copied unchanged"
    );
}

#[test]
fn wrong_use_of_tables_exits_with_code_two() {
    let cli = CliFixture::new();
    cli.write("t.csv", "source,target\na.obj,b.obj\n");
    cli.fails(2, "check", "PROJECT");
    cli.fails(2, "check --pairs t.csv", "--out");
    cli.fails(2, "check a.obj b.obj --out x.csv", "--pairs");
    cli.fails(2, "check a.obj b.obj --both", "--pairs");
    cli.fails(2, "check a.obj b.obj --pairs t.csv --out x.csv", "--pairs");
    cli.fails(2, "check --pairs t.csv --out t.csv", "replace the input");
    cli.fails(2, "check --pairs t.csv --out ./t.csv", "replace the input");
    cli.fails(
        2,
        "check --pairs t.csv --out x.csv --sheet x.gif",
        ".png or .svg",
    );
    cli.fails(
        2,
        "check --pairs t.csv --out x.svg --sheet ./x.svg",
        "two names",
    );
    cli.fails(1, "check --pairs t.csv --out none/x.csv", "none/x.csv");
    cli.fails(
        1,
        "check --pairs t.csv --out x.csv --sheet none/x.png",
        "none/x.png",
    );
    assert_eq!(cli.file_names(".").len(), 5, "nothing was written");
}
