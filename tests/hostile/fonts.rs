//! Tests of small fonts whose letter would take practically forever to draw.

use crate::bounded_run::BoundedFixture;
use crate::endless_fonts::{nested_components, nested_subroutines};

#[test]
fn letters_that_refer_to_others_without_end_are_refused() {
    let fixture = BoundedFixture::new();
    for (name, font) in [
        ("components.ttf", nested_components(30)),
        ("subroutines.otf", nested_subroutines(9, 40)),
        ("many.otf", nested_subroutines(3, 2000)),
    ] {
        assert!(font.len() < 10_000, "{name}: {}", font.len());
        fixture.write(name, font);
        let inputs = [&format!("glyph:A@{name}"), "square.json"];
        fixture.assert_inputs_refused(&inputs, name, "takes too long to draw");
    }
}

#[test]
fn letters_that_refer_to_few_others_are_drawn() {
    let fixture = BoundedFixture::new();
    fixture.write("components.ttf", nested_components(3));
    let inputs = ["check", "glyph:A@components.ttf", "square.json"];
    let field = ["--method", "field", "--samples", "2"];
    let output = fixture.run_small(&[&inputs[..], &field].concat());
    assert_eq!(output.code, Some(0), "{output:?}");
}
