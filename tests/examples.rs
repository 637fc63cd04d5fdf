//! Tests the examples that need no window: their output, and the copy of one of them in the README.

#[path = "../examples/polygons_to_svg.rs"]
mod polygons_to_svg;
#[expect(dead_code, reason = "the test calls the functions that `main` calls")]
#[path = "../examples/report.rs"]
mod report;

#[test]
fn two_lists_of_points_give_five_drawings() {
    let folder = tempfile::tempdir().expect("a folder");
    std::env::set_current_dir(folder.path()).expect("a folder to write to");
    polygons_to_svg::main().expect("written");
    let svg = |i: usize| {
        let path = folder.path().join(format!("between-{i}.svg"));
        std::fs::read_to_string(path).expect("a drawing")
    };
    let all: Vec<String> = (0..5).map(svg).collect();
    for (i, svg) in all.iter().enumerate() {
        assert!(svg.contains("<path fill="), "{svg}");
        assert!(!all[..i].contains(svg), "{i} equals an earlier drawing");
    }
}

#[test]
fn the_readme_shows_the_example_of_at_most_twenty_lines() {
    let example = include_str!("../examples/polygons_to_svg.rs");
    let (_, program) = example.split_once("\n\n").expect("a head");
    assert!(program.lines().count() <= 20);
    assert!(
        include_str!("../README.md").contains(&program.replace("pub(crate) fn main", "fn main"))
    );
}

#[test]
fn the_report_example_contains_the_measures() {
    let report = report::report("triangle-polar").expect("a report");
    assert_eq!(report["film"]["worst_folds"], 0);
    assert_eq!(report["film"]["samples"].as_array().map(Vec::len), Some(33));
    assert!(report["mesh"]["faces"].as_u64() > Some(0));
    assert!(report["verdict"].is_string());
}
