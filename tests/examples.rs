//! The examples that need no window do what they say.

#[expect(dead_code, reason = "a test calls what `main` calls")]
#[path = "../examples/polygons_to_svg.rs"]
mod polygons_to_svg;
#[expect(dead_code, reason = "a test calls what `main` calls")]
#[path = "../examples/report.rs"]
mod report;

#[test]
fn two_lists_of_points_become_five_drawings() {
    let folder = tempfile::tempdir().expect("a folder");
    polygons_to_svg::write_svgs(folder.path()).expect("written");
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
fn a_report_has_what_was_measured() {
    let report = report::report("triangle-polar").expect("a report");
    assert_eq!(report["film"]["worst_folds"], 0);
    assert_eq!(report["film"]["samples"].as_array().map(Vec::len), Some(33));
    assert!(report["mesh"]["faces"].as_u64() > Some(0));
    assert!(report["verdict"].is_string());
}
