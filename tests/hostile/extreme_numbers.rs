//! Tests of numbers outside the supported range: coordinates in every file format, and settings in
//! project files. They are refused; a design far from the origin is accepted if it is large enough
//! for the precision of its coordinates.

use crate::bounded_run::BoundedFixture;

/// Part of the error message for a coordinate that is too large.
const TOO_LARGE: &str = "has a coordinate that is not a number between -1e18 and 1e18";

/// Part of the error message for a design that is too small.
const TOO_SMALL: &str = "less than the minimum of 1e-18";

#[test]
fn coordinates_out_of_range_are_refused_in_every_format() {
    let fixture = BoundedFixture::new();
    let triangle = |x: &str| format!("v 0 0 0\nv {x} 0 0\nv 0 {x} 0\nf 1 2 3\n");
    let truss = |x: &str| format!("{{\"nodes\": [[0, 0], [{x}, 0]], \"bars\": [[0, 1]]}}");
    let circle = |x: &str| {
        format!(
            "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n{x}\n0\nENDSEC\n0\nEOF\n"
        )
    };
    for (file, text, reason) in [
        ("a.obj", triangle("1e200"), TOO_LARGE),
        ("b.obj", triangle("1e-200"), TOO_SMALL),
        (
            "c.json",
            "[[0,0],[1e152,0],[0,1e152]]".to_owned(),
            TOO_LARGE,
        ),
        (
            "d.json",
            "[[0,0],[1e-152,0],[0,1e-152]]".to_owned(),
            TOO_SMALL,
        ),
        ("e.json", truss("-1e19"), TOO_LARGE),
        ("f.json", truss("5e-324"), TOO_SMALL),
        (
            "g.dxf",
            circle("1e60"),
            "1 CIRCLE left out: a value is not a number from -1e18 to 1e18 (line 14",
        ),
        (
            "h.json",
            "{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[1,0],[0,1e308]]]}".to_owned(),
            TOO_LARGE,
        ),
    ] {
        fixture.write(file, text);
        fixture.assert_refused(file, reason);
    }
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\">\
        <path transform=\"scale(1e30)\" d=\"M0 0H9e8V9Z\"/></svg>";
    fixture.write("i.svg", svg);
    fixture.assert_refused("i.svg", "i.svg");
}

#[test]
fn numbers_out_of_range_are_refused_in_projects() {
    let fixture = BoundedFixture::new();
    let designs = "[[designs]]\npath = \"square.json\"\n".repeat(2);
    for (file, settings, reason) in [
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
            "after placement",
        ),
        (
            "large.morph",
            "[designs.placement]\nscale = 1e300\n",
            "after placement",
        ),
        (
            "small.morph",
            "[designs.placement]\nscale = 1e-300\n",
            "less than the minimum",
        ),
        (
            "away.morph",
            "[designs.placement]\noffset = [1e16, 0]\n",
            "too coarse",
        ),
        ("stop.morph", "[[stops]]\nt = inf\n", "stop 1"),
    ] {
        fixture.write(file, format!("version = 1\n{designs}{settings}"));
        fixture.assert_inputs_refused(&[file], "", reason);
    }
}

#[test]
fn a_design_far_from_the_origin_is_accepted_if_it_is_large_enough() {
    let fixture = BoundedFixture::new();
    let kite = |size: &str| {
        let point = |x: &str, y: &str| format!("[1000000000000{x}, {y}]");
        let [a, b, c] = ["000", size, "999"];
        format!(
            "[{}, {}, {}, {}]",
            point(a, "0"),
            point(b, "100"),
            point(c, "2000"),
            point(a, "500")
        )
    };
    fixture.write("a.json", kite("700"));
    fixture.write("b.json", kite("800"));
    for method in ["arap", "field"] {
        let arguments = [
            "check",
            "a.json",
            "b.json",
            "--samples",
            "2",
            "--method",
            method,
        ];
        let output = fixture.run(&arguments);
        assert_eq!(output.code, Some(0), "{output:?}");
    }
    fixture.write("c.json", "[[1e15, 0], [1000000000000004, 0], [1e15, 4]]");
    fixture.assert_refused("c.json", "move it to the origin");
}
