//! Tests of the truss format and its validation.

use super::*;

const FULL: &str = r#"{
    "nodes": [[0, 0], [1, 0], [0, 1]],
    "bars": [[0, 1], [1, 2], [2, 0]],
    "supports": [{ "node": 0, "fixed": [true, true] }],
    "loads": [{ "node": 2, "force": [0, -1] }],
    "areas": [0.01, 0.01, 0.02],
    "materials": [{ "name": "steel", "youngs_modulus": 2.1e11, "density": 7850 }],
    "bar_materials": [0, 0, 0]
}"#;

fn error(from: &str, to: &str) -> String {
    assert!(FULL.contains(from), "{from}");
    let text = FULL.replace(from, to);
    Truss::from_json(&text).expect_err(to).to_string()
}

#[test]
fn a_full_file_is_parsed_and_rotated() {
    let truss = Truss::from_json(FULL).expect("valid");
    assert_eq!(truss.bars().len(), 3);
    assert_eq!(truss.parts().materials[0].density, Some(7850.0));
    let turned = truss.transformed(&Similarity {
        rotation: std::f64::consts::FRAC_PI_2,
        scale: 3.0,
        offset: DVec2::ONE,
        ..Similarity::IDENTITY
    });
    assert!((turned.nodes()[1] - DVec2::new(1.0, 4.0)).length() < 1e-12);
    let force = turned.placement().linear() * turned.parts().loads[0].force / 3.0;
    assert!((force - DVec2::X).length() < 1e-12);
}

#[test]
fn each_fault_is_reported() {
    assert!(error("[2, 0]]", "[2, 9]]").starts_with("bar 2 refers to node 9, but there are 3"));
    assert!(error("[2, 0]]", "[2, 2]]").starts_with("bar 2 joins nodes 2 and 2"));
    assert!(error("[2, 0]]", "[1, 0]]").starts_with("bars 0 and 2 join"));
    assert!(error("[0, 1]],", "[0, 1], [5, 5]],").starts_with("node 3 belongs to no bar"));
    assert!(error("\"node\": 0", "\"node\": 3").starts_with("support 0 refers to node 3"));
    assert!(error("\"node\": 2", "\"node\": 7").starts_with("load 0 refers to node 7"));
    assert!(error("0.02]", "-0.02]").starts_with("area 2"));
    assert!(error(", 0.02]", "]").contains("2 entries for 3 bars"));
    assert!(error("[0, 0, 0]", "[0, 1, 0]").starts_with("the material of bar 1 refers"));
    assert!(error("7850", "0").starts_with("material 0"));
    assert!(error("\"areas\"", "\"area\"").starts_with("line 6, column"));
    assert!(error("[[0, 0],", "[[0, 1e999],").starts_with("line 2, column"));
    assert!(error("[[0, 0],", "[[0, NaN],").starts_with("line 2, column"));
    assert!(error("[[0, 1], [1, 2], [2, 0]]", "[]").contains("no bars"));
}

#[test]
fn a_bar_between_coincident_nodes_is_refused() {
    let error = Truss::new(vec![DVec2::ONE; 2], vec![[0, 1]]).expect_err("no length");
    assert_eq!(
        error,
        TrussInputError::NoLength {
            bar: 0,
            nodes: [0, 1]
        }
    );
}
