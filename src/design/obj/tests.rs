//! Tests of the OBJ importer: vertex order, fans, and errors of vertices and faces.

use super::*;

#[test]
fn vertex_order_is_preserved_and_quads_become_fans() {
    let text = "# c\nmtllib x.mtl\no a\nv 0 0 5\nv 1 0 5 # right\nv 1 1 5\nv 0 1 5\n\
                vt 0 0\nvn 0 0 1\ng b\nusemtl m\nf 2/1/1 3//1 \\\n 4 1/1\n";
    let mesh = read(text).expect("valid");
    assert_eq!(mesh.positions()[1], DVec2::X);
    assert_eq!(mesh.faces(), [[1, 2, 3], [1, 3, 0]]);
    let relative = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n").expect("valid");
    assert_eq!(relative.faces(), [[0, 1, 2]]);
}

fn read(text: &str) -> Result<TriangleMesh, ObjError> {
    super::read(text).map(|(mesh, _)| mesh)
}

#[test]
fn lines_that_are_ignored_are_reported() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
    let words = |more: &str| -> Vec<String> {
        let (_, notes) = super::read(&format!("{square}{more}")).expect("valid");
        notes.iter().map(ToString::to_string).collect()
    };
    let harmless = "mtllib a.mtl\no a\ng b\ns off\nvt 0 0\nvn 0 0 1\n# l 1 2\n";
    assert_eq!(words(harmless), [""; 0]);
    for (more, note) in [
        (
            "l 1 2 3\nl 3 4\n",
            "2 objects of type l (line) were ignored",
        ),
        ("p 1\n", "1 object of type p (point) was ignored"),
        (
            "usemtl red\n",
            "1 object of type usemtl (material) was ignored",
        ),
        ("F 1 2 3\n", "1 object of type F was ignored"),
    ] {
        assert_eq!(words(more), [note]);
    }
    let many: String = (0..100).map(|k| format!("x{k}\n")).collect();
    assert_eq!(words(&many).len(), MAX_KINDS + 1);
}

fn error(text: &str) -> ObjError {
    read(text).expect_err("bad")
}

fn fault(text: &str, expected_line: usize) -> ObjFault {
    match error(text) {
        ObjError::Line { line, fault } if line == expected_line => fault,
        other => panic!("{other}"),
    }
}

#[test]
fn a_bad_vertex_line_is_reported() {
    assert_eq!(fault("v 1\n", 1), ObjFault::Vertex(1));
    for bad in ["NaN", "inf", "-inf", "1e999", "1.1e18"] {
        let text = format!("v 0 0 0\nv {bad} 0 0\n");
        assert_eq!(fault(&text, 2), ObjFault::CoordinateRange(2));
    }
    assert!(matches!(
        fault("v 0 0 0\nv 1 0 0.1\n", 2),
        ObjFault::NotFlat { vertex: 2, .. }
    ));
    assert_eq!(
        error("v 1\n").to_string(),
        "line 1: vertex 1 needs the numbers x y z; correct the line"
    );
}

#[test]
fn a_bad_face_is_reported() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let face = |face: &str| fault(&format!("{triangle}f {face}\n"), 4);
    for (words, named) in [("1 2 4", 4), ("1 2 0", 0), ("1 2 -4", -4)] {
        assert_eq!(
            face(words),
            ObjFault::OutOfRange {
                face: 1,
                named,
                vertices: 3
            }
        );
    }
    for huge in ["1 2 9223372036854775807", "1 2 -9223372036854775808"] {
        assert!(matches!(face(huge), ObjFault::OutOfRange { .. }));
    }
    assert_eq!(face("1 2 2"), ObjFault::Repeated { face: 1, vertex: 2 });
    assert_eq!(face("1 x 2"), ObjFault::Face(1, "x".to_owned()));
    assert_eq!(face("1 2"), ObjFault::TooFewCorners(1));
    assert_eq!(
        error(&format!("{triangle}v 5 5 0\nf 1 2 3\n")),
        ObjError::Unused(4)
    );
    assert_eq!(
        error(triangle),
        ObjError::NoMesh {
            vertices: 3,
            faces: 0
        }
    );
    assert!(matches!(
        error("v 0 0\nv 1 0\nv 1 1\nv 0 1\nf 1 2 3\nf 1 4 3\nf 1 3 2\n"),
        ObjError::Mesh(_)
    ));
}

#[test]
fn a_concave_face_is_divided_into_triangles_inside_it() {
    // A U of area 7 whose first vertex does not see all others, in both orientations.
    let vertices = "v 0 0\nv 3 0\nv 3 3\nv 2 3\nv 2 1\nv 1 1\nv 1 3\nv 0 3\n";
    for (face, sign) in [("4 5 6 7 8 1 2 3", 1.0), ("3 2 1 8 7 6 5 4", -1.0)] {
        let mesh = read(&format!("{vertices}f {face}\n")).expect("valid");
        let areas = mesh.faces().iter().map(|triangle| {
            let [a, b, c] = triangle.map(|v| mesh.positions()[v as usize]);
            0.5 * (b - a).perp_dot(c - a) * sign
        });
        let areas: Vec<f64> = areas.collect();
        assert_eq!(areas.len(), 6);
        assert!(areas.iter().all(|area| *area > 0.0), "{areas:?}");
        assert!((areas.iter().sum::<f64>() - 7.0).abs() < 1e-12);
        assert_eq!(mesh.boundary_loops().len(), 1);
    }
}

#[test]
fn errors_count_the_faces_of_the_file() {
    // The first face has five vertices, so triangle 4 belongs to face 2.
    let vertices = "v 0 0\nv 2 0\nv 3 1\nv 1 3\nv 0 2\nv 3 3\n";
    let opposed = error(&format!("{vertices}f 1 2 3 4 5\nf 3 4 6\n"));
    assert_eq!(
        opposed.to_string(),
        "faces 1 and 2 are wound in opposite directions; reverse the vertices of one"
    );
    let crossed = "v 0 0\nv 2 0\nv 0 2\nv 2 2\nf 1 2 4\nf 1 2 3 4\n";
    assert_eq!(fault(crossed, 6), ObjFault::NotSimple(2));
}
