//! Tests of `check --structure` and of trusses at t: text, JSON, CSV and files, and the sentence for
//! each kind of broken truss.

use std::fs;

use serde_json::{Value, json};

use crate::cli_fixture::CliFixture;

/// A bracket of two bars; the tip is at the given place.
fn bracket(tip: [f64; 2]) -> Value {
    json!({
        "units": {"length": "m", "force": "kN"},
        "nodes": [[0, 0], [0, 3], tip], "bars": [[0, 2], [1, 2]], "areas": [0.002, 0.001],
        "materials": [{"name": "steel S235"}], "bar_materials": [0, 0],
        "supports": [{"node": 0, "fixed": [true, true]}, {"node": 1, "fixed": [true, true]}],
        "loads": [{"node": 2, "force": [0, -40]}],
    })
}

fn fixture() -> CliFixture {
    let cli = CliFixture::new();
    cli.write("low.json", &bracket([4.0, 0.0]).to_string());
    cli.write("high.json", &bracket([3.0, 2.0]).to_string());
    cli
}

#[test]
fn the_structure_is_printed_as_text_and_as_json() {
    let cli = fixture();
    let text = cli.succeeds("check low.json high.json --structure --at 0.5");
    for part in [
        "2 bars, 3 nodes",
        "stands at every t: proved on",
        "sound: no fault found (241 values of t)",
        "bars at t = 0.500",
        "a concept check",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let json = cli.succeeds("check low.json high.json --structure --at 0,1 --json");
    let report: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(report["samples"].as_array().map(Vec::len), Some(241));
    assert!(report["proof"]["fails_at"].is_null());
    // The strut of the low bracket carries 4/3 of the load, the tie 5/3.
    let forces = |table: usize, bar: usize| {
        report["tables"][table]["bars"][bar]["axial_n"]
            .as_f64()
            .expect("a force")
    };
    assert!((forces(0, 0) + 40e3 * 4.0 / 3.0).abs() < 1e-6);
    assert!((forces(0, 1) - 40e3 * 5.0 / 3.0).abs() < 1e-6);
    assert!(report["sized"][0]["mass"].as_f64() > Some(0.0));
}

#[test]
fn members_at_chosen_t_are_written_as_csv() {
    let cli = fixture();
    cli.succeeds("check low.json high.json --structure --at 0,0.5 --members members.csv");
    let table = fs::read_to_string(cli.path("members.csv")).expect("a table");
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows.len(), 5);
    assert!(rows[0].starts_with("t,bar,first_node,second_node,length_m,area_m2,axial_n"));
    assert!(rows[4].starts_with("0.5,1,1,2,"), "{}", rows[4]);
    cli.fails(
        2,
        "check low.json high.json --structure --at 0 --members low.json",
        "would replace the input",
    );
    cli.fails(
        2,
        "check low.json high.json --structure --members x.csv",
        "--at",
    );
}

#[test]
fn the_truss_at_t_opens_again_with_the_same_results() {
    let cli = fixture();
    cli.succeeds("render low.json high.json --at 0.4 --out between.json");
    let numbers = |designs: &str, t: f64| {
        let json = cli.succeeds(&format!("check {designs} --structure --at {t} --json"));
        let report: Value = serde_json::from_str(&json).expect("JSON");
        let bars = report["tables"][0]["bars"]
            .as_array()
            .expect("bars")
            .clone();
        let axial = bars
            .iter()
            .map(|bar| bar["axial_n"].as_f64().expect("a force"));
        axial.collect::<Vec<_>>()
    };
    let between = numbers("low.json high.json", 0.4);
    let again = numbers("between.json between.json", 0.0);
    for (a, b) in between.iter().zip(&again) {
        assert!((a - b).abs() < 1e-9 * a.abs(), "{a} {b}");
    }
    cli.fails(
        2,
        "render low.json high.json --at 0.4 --out low.json",
        "would replace the input",
    );
    cli.fails(
        1,
        "render a.svg b.svg --at 0.4 --out x.json",
        "has no bars; open a truss",
    );
    cli.fails(
        1,
        "check a.svg b.svg --structure",
        "has no bars; open a truss to analyse it",
    );
}

#[test]
fn a_mechanism_between_two_trusses_is_named() {
    let cli = CliFixture::new();
    for (name, height) in [("up.json", 1.0), ("down.json", -2.0)] {
        let mut file = bracket([1.0, height]);
        file["nodes"][1] = json!([3, 0]);
        cli.write(name, &file.to_string());
    }
    let text = cli.succeeds("check up.json down.json --structure");
    assert!(text.contains("moves most easily at node 2"), "{text}");
}

#[test]
#[expect(clippy::too_many_lines, reason = "a table of broken files")]
fn each_broken_truss_gets_a_sentence() {
    let cli = fixture();
    let broken = |key: &str, value: Value| {
        let mut file = bracket([4.0, 0.0]);
        file[key] = value;
        file.to_string()
    };
    for (text, code, message) in [
        (
            broken("areas", json!([1e-3, -1])),
            1,
            "area 1 has an invalid number; use finite numbers, zero or above",
        ),
        (
            broken("areas", json!([1e-3])),
            1,
            "\"areas\" has 1 entries for 2 bars",
        ),
        (
            broken("areas", json!([1e-15, 1.0])),
            1,
            "bar 1 is 1e15 times as stiff as bar 0",
        ),
        (
            broken("areas", json!([1e300, 1e300])),
            1,
            "the stiffness of bar 0 is outside the range of numbers",
        ),
        (
            broken("loads", json!([{"node": 7, "force": [0, 1]}])),
            1,
            "load 0 refers to node 7, but there are 3",
        ),
        (
            broken("units", json!({"length": "furlong", "force": "kN"})),
            1,
            "unknown variant `furlong`",
        ),
        (
            broken("fixity", json!(1.5)),
            1,
            "use numbers from 0 (pinned) to 1 (rigid)",
        ),
        (
            broken("supports", json!([{"node": 0, "fixed": [true]}])),
            1,
            "give 2 (x, y) or 3 (x, y, rotation)",
        ),
        (
            broken(
                "supports",
                json!([{"node": 0, "fixed": [true, true], "rolls_along": [1, 0]}]),
            ),
            1,
            "support 0 needs either \"fixed\" displacements or \"rolls_along\"",
        ),
        (
            broken("sections", json!([{"shape": "i"}])),
            1,
            "section 0 needs exactly one of",
        ),
        (
            broken(
                "load_cases",
                json!([{"name": "x", "line_loads": [{"bars": [9], "force": [0, 1]}]}]),
            ),
            1,
            "line load 0 refers to bar 9",
        ),
        (
            broken("loads", json!([{"node": 2, "force": [0, 1e300]}])),
            1,
            "a load is too large to compute with",
        ),
        (broken("areas", json!("NaN")), 1, "invalid type"),
    ] {
        cli.write("broken.json", &text);
        cli.fails(code, "check broken.json high.json --structure", message);
    }
}
