//! Tests of designs whose proof has no natural end: rounding hides whether edges cross.

use crate::bounded_run::BoundedFixture;

/// Three rings through irregular points of the unit square at a distance from the origin, which
/// cross themselves and each other. Far away, their coordinates are rounded coarsely.
fn irregular_rings(distance: f64) -> String {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let point = |k: u32| {
        let [x, y] = [GOLDEN, 7.0 * GOLDEN * GOLDEN].map(|step| (f64::from(k + 1) * step).fract());
        format!("[{},{}]", distance + x, distance + y)
    };
    let ring = |points: std::ops::Range<u32>| {
        let points: Vec<String> = points.map(point).collect();
        format!("[{}]", points.join(","))
    };
    format!("[{},{},{}]", ring(0..8), ring(8..12), ring(12..17))
}

#[test]
fn proofs_of_crossing_designs_and_of_distant_ones_end() {
    let fixture = BoundedFixture::new();
    fixture.write(
        "stars.json",
        "[[[2,0],[1,4],[2,1],[2,3],[3,1]],[[4,3],[0,2],[4,1]],[[0,4],[3,3],[4,2],[1,2]]]",
    );
    fixture.write("irregular.json", irregular_rings(0.0));
    fixture.write("distant.json", irregular_rings(1e9));
    fixture.write("near.json", "[[0,0],[1,0],[1.25,1],[0,1]]");
    fixture.write(
        "far.json",
        "[[1e9,1e9],[1000000001,1e9],[1000000001.25,1000000001],[1e9,1000000001]]",
    );
    for inputs in [
        ["stars.json", "irregular.json"],
        ["stars.json", "distant.json"],
        ["near.json", "far.json"],
        ["far.json", "square.json"],
    ] {
        let check = [
            "check",
            inputs[0],
            inputs[1],
            "--quality",
            "draft",
            "--samples",
            "3",
            "--prove",
        ];
        let output = fixture.run_small(&check);
        assert_eq!(output.code, Some(0), "{output:?}");
        assert!(output.stdout.contains("proof"), "{output:?}");
    }
}
