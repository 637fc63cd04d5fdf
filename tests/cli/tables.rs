//! Tables of pairs: a row each, whatever becomes of it.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use crate::workshop::{Workshop, image, words};

/// A report's rows by the names of its columns.
fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).expect("a report");
    let rows = reader.deserialize();
    rows.map(|row| row.expect("a row")).collect()
}

#[test]
fn a_table_of_pairs_gives_a_row_each() {
    let shop = Workshop::new();
    fs::create_dir(shop.path("sub")).expect("made");
    shop.put(
        "sub/pairs.csv",
        "\u{feff}kind,source,target\n\"a, \"\"b\"\"\",../a.obj,../b.obj\ndrawn,../a.svg,../b.svg\n",
    );
    let line = "check --pairs sub/pairs.csv --out report.csv --sheet sheet.png --samples 5";
    let summary = shop.done(&format!("{line} --both"));
    assert!(summary.starts_with("pairs  "), "{summary}");
    let found = rows(&shop.path("report.csv"));
    let directions: Vec<_> = found.iter().map(|row| row["direction"].as_str()).collect();
    assert_eq!(directions, ["forward", "backward", "forward", "backward"]);
    assert_eq!(found[1]["kind"], "a, \"b\"");
    for row in &found {
        let told = ["status", "samples", "method"].map(|column| row[column].as_str());
        assert_eq!(told, ["ok", "5", "arap"]);
        for column in ["build_s", "match_and_triangulate_s", "conformal_worst"] {
            assert!(
                row[column].parse::<f64>().expect("a number") > 0.0,
                "{column}"
            );
        }
    }
    let worst = |row: usize| found[row]["conformal_worst"].parse::<f64>();
    let [there, back] = [worst(0), worst(1)].map(|x| x.expect("a number"));
    assert!((there / back - 1.0).abs() < 1e-9, "{there} {back}");
    assert!(image(&shop.path("sheet.png")).width() > 600);
    assert_eq!(shop.names(".").len(), 7, "no temporary file is left");
}

#[test]
fn a_table_of_pictures_has_an_end() {
    let shop = Workshop::new();
    for (t, name) in [(0, "x.png"), (1, "y.png")] {
        shop.done(&format!(
            "render a.svg b.svg --at {t} --size 120x120 --out {name}"
        ));
    }
    let pairs = "x.png,y.png\ny.png,x.png\n".repeat(3);
    shop.put("pairs.csv", &format!("source,target\n{pairs}"));
    shop.done("check --pairs pairs.csv --out r.csv --samples 3");
    let found = rows(&shop.path("r.csv"));
    assert_eq!(found.len(), 6);
    assert!(found.iter().all(|row| row["status"] == "ok"), "{found:?}");
}

#[test]
fn a_table_of_fields_is_written_over_the_last_one() {
    let shop = Workshop::new();
    shop.put("pairs.csv", "source,target\na.svg,b.obj\n");
    shop.put("report.csv", "old");
    let line = "check --pairs pairs.csv --out report.csv --method field --cells 48 --samples 5";
    let json = shop.done(&format!("{line} --json"));
    let summary: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        (&summary["pairs"], &summary["failures"]),
        (&1.into(), &0.into())
    );
    let found = rows(&shop.path("report.csv"));
    let told = ["method", "faces", "grid_width_cells"].map(|column| found[0][column].as_str());
    assert_eq!(told, ["field", "", "48"]);
    assert_eq!(found[0]["pieces_excess"].parse::<usize>(), Ok(0));
}

#[test]
fn a_table_goes_on_past_failures() {
    let shop = Workshop::new();
    shop.put("bad.obj", "v 0 0 0\nf 1 2 3\n");
    shop.put(
        "pairs.csv",
        "source,target,kind\nnone.obj,a.obj,1\na.obj,bad.obj,2\na.obj,b.obj\n,b.obj,4\na.obj,.,5\na.obj,b.obj,6\n",
    );
    let output = shop.run("check --pairs pairs.csv --out r.csv --sheet s.svg --samples 3");
    let said = words(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("5 of 6 pairs failed, the first in line 2"),
        "{said}"
    );
    assert!(!said.contains("panicked"), "{said}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("failures"));
    let found = rows(&shop.path("r.csv"));
    let status: Vec<_> = found.iter().map(|row| row["status"].as_str()).collect();
    for (status, said) in status
        .iter()
        .zip(["none.obj", "bad.obj", "2 cells", "empty", ""])
    {
        assert!(status.contains(said) && *status != "ok", "{status}");
    }
    assert_eq!(status[5], "ok");
    assert_eq!(
        (found[0]["kind"].as_str(), found[2]["kind"].as_str()),
        ("1", "")
    );
    let svg = fs::read_to_string(shop.path("s.svg")).expect("a sheet");
    assert!(svg.contains("failed") && svg.contains("a to b"));
}

#[test]
fn hostile_tables_are_refused_in_words() {
    let shop = Workshop::new();
    let go = |name: &str| format!("check --pairs {name} --out out.csv");
    shop.fails(1, &go("missing.csv"), "missing.csv");
    shop.fails(1, &go("."), "choose a file in it");
    for (text, said) in [
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
        shop.put("t.csv", text);
        shop.fails(1, &go("t.csv"), said);
    }
    fs::write(shop.path("t.csv"), b"\xff\xfes\0o\0u\0").expect("written");
    shop.fails(1, &go("t.csv"), "UTF-8");
    fs::write(shop.path("t.csv"), b"source,target\n\xff.obj,a.obj\n").expect("written");
    let output = shop.run(&go("t.csv"));
    assert_eq!(output.status.code(), Some(1), "{}", words(&output));
    let report = fs::read(shop.path("out.csv")).expect("a report");
    assert!(
        report.windows(5).any(|w| w == b"\xff.obj"),
        "carried along as it is"
    );
}

#[test]
fn tables_are_used_rightly_or_not_at_all() {
    let shop = Workshop::new();
    shop.put("t.csv", "source,target\na.obj,b.obj\n");
    shop.fails(2, "check", "PROJECT");
    shop.fails(2, "check --pairs t.csv", "--out");
    shop.fails(2, "check a.obj b.obj --out x.csv", "--pairs");
    shop.fails(2, "check a.obj b.obj --both", "--pairs");
    shop.fails(2, "check a.obj b.obj --pairs t.csv --out x.csv", "--pairs");
    shop.fails(2, "check --pairs t.csv --out t.csv", "the table itself");
    shop.fails(2, "check --pairs t.csv --out ./t.csv", "the table itself");
    shop.fails(
        2,
        "check --pairs t.csv --out x.csv --sheet x.gif",
        ".png or .svg",
    );
    shop.fails(
        2,
        "check --pairs t.csv --out x.svg --sheet x.svg",
        "two names",
    );
    shop.fails(1, "check --pairs t.csv --out none/x.csv", "none/x.csv");
    shop.fails(
        1,
        "check --pairs t.csv --out x.csv --sheet none/x.png",
        "none/x.png",
    );
    assert_eq!(shop.names(".").len(), 5, "nothing was written");
}
