//! The examples that need no window do what they say.

#[path = "../examples/polygons_to_svg.rs"]
mod polygons_to_svg;
#[expect(dead_code, reason = "a test calls what `main` calls")]
#[path = "../examples/report.rs"]
mod report;

#[test]
fn two_lists_of_points_become_five_drawings() {
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
        assert!(!all[..i].contains(svg), "{i} is as one before");
    }
}

#[test]
fn the_readme_shows_the_program_of_twenty_lines() {
    let example = include_str!("../examples/polygons_to_svg.rs");
    let (_, program) = example.split_once("\n\n").expect("a head");
    assert!(program.lines().count() <= 20);
    assert!(
        include_str!("../README.md").contains(&program.replace("pub(crate) fn main", "fn main"))
    );
}

#[test]
fn a_report_has_what_was_measured() {
    let report = report::report("triangle-polar").expect("a report");
    assert_eq!(report["film"]["worst_folds"], 0);
    assert_eq!(report["film"]["samples"].as_array().map(Vec::len), Some(33));
    assert!(report["mesh"]["faces"].as_u64() > Some(0));
    assert!(report["verdict"].is_string());
}
