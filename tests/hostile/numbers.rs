//! Coordinates that nobody can reckon with, in every kind of file, and those
//! that only look so.

use crate::child::Folder;

const RANGE: &str = "has a coordinate that is no number from -1e18 to 1e18";
const SMALL: &str = "less than the least size of 1e-18";

#[test]
fn numbers_out_of_range_are_refused_wherever_they_stand() {
    let folder = Folder::new();
    let triangle = |x: &str| format!("v 0 0 0\nv {x} 0 0\nv 0 {x} 0\nf 1 2 3\n");
    let truss = |x: &str| format!("{{\"nodes\": [[0, 0], [{x}, 0]], \"bars\": [[0, 1]]}}");
    let line = |x: &str| {
        format!(
            "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n{x}\n0\nENDSEC\n0\nEOF\n"
        )
    };
    for (file, text, said) in [
        ("a.obj", triangle("1e200"), RANGE),
        ("b.obj", triangle("1e-200"), SMALL),
        ("c.json", "[[0,0],[1e152,0],[0,1e152]]".to_owned(), RANGE),
        ("d.json", "[[0,0],[1e-152,0],[0,1e-152]]".to_owned(), SMALL),
        ("e.json", truss("-1e19"), RANGE),
        ("f.json", truss("5e-324"), SMALL),
        ("g.dxf", line("1e60"), "line 14: there is no number"),
        (
            "h.json",
            "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[1,0],[0,1e308]]]}".to_owned(),
            RANGE,
        ),
    ] {
        folder.put(file, text);
        folder.refused(file, said);
    }
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">\
        <path transform=\"scale(1e30)\" d=\"M0 0H9e8V9Z\"/></svg>";
    folder.put("i.svg", svg);
    folder.refused("i.svg", "i.svg");
}

#[test]
fn numbers_out_of_range_are_refused_in_projects() {
    let folder = Folder::new();
    let designs = "[[designs]]\npath = \"square.json\"\n".repeat(2);
    for (file, end, said) in [
        (
            "pin.morph",
            "[[match.pins]]\nsource = [1e19, 0]\ntarget = [0, 0]\n",
            "pin 1 has",
        ),
        (
            "nan.morph",
            "[[match.pins]]\nsource = [nan, 0]\ntarget = [0, 0]\n",
            "pin 1 has",
        ),
        (
            "cut.morph",
            "[[match.cuts]]\nside = \"source\"\nouter = [0, 0]\nhole = [0, -inf]\n",
            "cut 1 has",
        ),
        (
            "offset.morph",
            "[designs.placement]\noffset = [1e300, 0]\n",
            "laid down",
        ),
        (
            "large.morph",
            "[designs.placement]\nscale = 1e300\n",
            "laid down",
        ),
        (
            "small.morph",
            "[designs.placement]\nscale = 1e-300\n",
            "least size",
        ),
        (
            "away.morph",
            "[designs.placement]\noffset = [1e16, 0]\n",
            "too coarse",
        ),
        ("stop.morph", "[[stops]]\nt = inf\n", "stop 1"),
    ] {
        folder.put(file, format!("version = 1\n{designs}{end}"));
        folder.refused_with(&[file], "", said);
    }
}

#[test]
fn far_away_is_no_obstacle_to_what_is_large_enough() {
    let folder = Folder::new();
    let kite = |size: &str| {
        let at = |x: &str, y: &str| format!("[1000000000000{x}, {y}]");
        let [a, b, c] = ["000", size, "999"];
        format!(
            "[{}, {}, {}, {}]",
            at(a, "0"),
            at(b, "100"),
            at(c, "2000"),
            at(a, "500")
        )
    };
    folder.put("a.json", kite("700"));
    folder.put("b.json", kite("800"));
    for method in ["arap", "field"] {
        let away = [
            "check",
            "a.json",
            "b.json",
            "--samples",
            "2",
            "--method",
            method,
        ];
        let answer = folder.ask(&away);
        assert_eq!(answer.code, Some(0), "{answer:?}");
    }
    folder.put("c.json", "[[1e15, 0], [1000000000000004, 0], [1e15, 4]]");
    folder.refused("c.json", "move the design to the origin");
}
