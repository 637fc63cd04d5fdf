//! Tests of the import of files of every format. Valid files are read whatever their extension,
//! byte-order mark or line ends. Truncated, damaged, hostile and random files give a typed error
//! that names the file and the place in it, never a panic. Also tests of the ranges of the import
//! options.

use image::{DynamicImage, GrayImage, ImageFormat, Luma};
use morphospace::design::{
    Design, DesignForm, DesignSource, DxfError, ImportError, ImportOptions, ImportProblem,
    JsonError, ObjError, ObjFault, PolygonsImportError, ReadError, SilhouetteError, SvgError,
    TrussInputError, UnknownFormat, import, import_file,
};
use proptest::prelude::*;
use std::io::Cursor;
use std::path::Path;

/// OBJ text of a square that consists of two triangles.
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

/// SVG text of a drawing with curves, a style sheet and a transformed copy of a path.
const SVG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20"><style>.a{fill:#123}</style><defs><path id="p" d="M1 1 C 5 1 9 5 9 9 Q 4 12 1 1 A 3 2 30 0 1 4 4 Z"/></defs><use class="a" href="#p" transform="rotate(20)"/></svg>"##;

/// JSON text of a truss with three bars that form a triangle.
const TRUSS: &str = r#"{"nodes": [[0, 0], [1, 0], [0, 1]], "bars": [[0, 1], [1, 2], [2, 0]]}"#;

/// JSON text of a square with a hole, as lists of points.
const RINGS: &str = "[[[0,0],[4,0],[4,4],[0,4],[0,0]],[[1,1],[3,1],[3,3],[1,3]]]";

/// GeoJSON text of a feature collection with two polygons.
const GEOJSON: &str = r#"{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"a": 1}, "geometry": {"type": "MultiPolygon", "coordinates": [[[[0,0],[4,0],[0,3]]], [[[5,0,9],[6,0],[5,1.5e0]]]]}}, {"type": "Feature", "geometry": null}]}"#;

/// DXF text of a drawing with every supported kind of curve.
fn dxf() -> String {
    let block = "0 BLOCK 2 B 10 1 20 1 0 CIRCLE 8 0 10 1 20 1 40 2 0 ENDBLK";
    let entities = "0 LINE 8 0 10 0 20 0 11 9 21 0 0 ARC 8 0 10 4.5 20 0 40 4.5 50 0 51 180
        0 LWPOLYLINE 8 0 90 3 70 1 10 20 20 0 42 0.5 10 30 20 0 10 30 20 9
        0 POLYLINE 8 0 70 1 0 VERTEX 8 0 10 40 20 0 42 -1 0 VERTEX 8 0 10 45 20 0 0 VERTEX 8 0 10 45 20 5 0 SEQEND
        0 ELLIPSE 8 0 10 60 20 0 11 5 21 1 40 0.4 41 0 42 6.2831853
        0 SPLINE 8 0 70 8 71 2 40 0 40 0 40 0 40 1 40 1 40 1 41 1 41 0.7 41 1 10 82 20 0 10 82 20 2 10 80 20 2
        0 LINE 8 0 10 80 20 2 11 82 21 0 0 INSERT 8 0 2 B 10 90 20 0 41 2 50 30 70 2 71 2 44 20 45 20";
    let section = |name: &str, pairs: &str| {
        let pairs: Vec<_> = pairs.split_whitespace().collect();
        format!("0\nSECTION\n2\n{name}\n{}\n0\nENDSEC\n", pairs.join("\n"))
    };
    section("BLOCKS", block) + &section("ENTITIES", entities) + "0\nEOF\n"
}

fn read(bytes: &[u8]) -> Result<Design, ImportError> {
    import("given", bytes, &ImportOptions::default())
}

/// Imports bytes that must be refused and returns the problem. Asserts that the error message is
/// one line that begins with the name of the file.
fn problem(bytes: &[u8]) -> ImportProblem {
    let error = read(bytes).expect_err("bad input");
    let message = error.to_string();
    assert!(message.starts_with("given: "), "{message}");
    assert!(!message.contains('\n'), "{message}");
    error.problem
}

/// Bytes of a grey image of a disc, in the given format.
fn picture(format: ImageFormat) -> Vec<u8> {
    let disc = GrayImage::from_fn(24, 20, |x, y| {
        let distance = (f64::from(x) - 11.0).hypot(f64::from(y) - 9.0);
        Luma([(distance * 25.0) as u8])
    });
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::from(disc)
        .write_to(&mut bytes, format)
        .expect("encodes");
    bytes.into_inner()
}

/// Bitmap formats that can be imported.
const IMAGE_FORMATS: [ImageFormat; 4] = [
    ImageFormat::Png,
    ImageFormat::Jpeg,
    ImageFormat::Bmp,
    ImageFormat::WebP,
];

/// Bytes of a valid file of each format.
fn valid_files() -> Vec<Vec<u8>> {
    let dxf = dxf();
    let texts = [OBJ, SVG, TRUSS, RINGS, GEOJSON, &dxf].map(|text| text.as_bytes().to_vec());
    IMAGE_FORMATS
        .map(picture)
        .into_iter()
        .chain(texts)
        .collect()
}

#[test]
fn all_valid_files_are_read() {
    for bytes in valid_files() {
        let design = read(&bytes).expect("good");
        assert!(design.outline(0.05).expect("area").area() > 0.0);
    }
}

#[test]
fn missing_files_folders_and_empty_files_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = ImportOptions::default();
    let missing = folder.path().join("nowhere.png");
    let error = import_file(&missing, &options).expect_err("missing");
    assert!(matches!(
        error.problem,
        ImportProblem::Read(ReadError::Missing)
    ));
    assert!(
        error
            .to_string()
            .contains("nowhere.png: the file does not exist")
    );
    let error = import_file(folder.path(), &options).expect_err("a folder");
    assert!(matches!(
        error.problem,
        ImportProblem::Read(ReadError::Folder)
    ));
    let empty = folder.path().join("empty.svg");
    std::fs::write(&empty, "").expect("written");
    let error = import_file(&empty, &options).expect_err("empty");
    assert!(matches!(error.problem, ImportProblem::Empty));
    assert!(import_file(Path::new(""), &options).is_err());
}

#[test]
fn a_file_with_a_wrong_extension_is_read_by_its_content() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in [
        ("leaf.obj", picture(ImageFormat::Png)),
        ("leaf.png", SVG.as_bytes().to_vec()),
        ("leaf.json", OBJ.as_bytes().to_vec()),
        ("leaf", TRUSS.as_bytes().to_vec()),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).expect("written");
        let design = import_file(&path, &ImportOptions::default()).expect("good content");
        assert_eq!(design.name, "leaf");
    }
}

#[test]
fn a_byte_order_mark_and_crlf_line_ends_are_accepted() {
    for text in [OBJ, SVG, TRUSS] {
        let text = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        read(text.as_bytes()).expect("good");
    }
    let declarations = "\u{feff}<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE svg PUBLIC \
                \"-//W3C//DTD SVG 1.1//EN\" \"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\">\n";
    read(format!("{declarations}{SVG}").as_bytes()).expect("good");
}

#[test]
fn truncated_pictures_are_refused() {
    for format in IMAGE_FORMATS {
        let bytes = picture(format);
        for length in [bytes.len() * 2 / 3, bytes.len() / 2, 40] {
            assert!(
                matches!(
                    problem(&bytes[..length]),
                    ImportProblem::Picture(
                        SilhouetteError::Truncated | SilhouetteError::Damaged(_)
                    )
                ),
                "{format:?} {length}"
            );
        }
    }
}

#[test]
fn truncated_texts_are_refused() {
    // Truncated JSON is reported as an invalid polygon file with a line number, even if the
    // complete file is a truss.
    assert!(matches!(
        problem(&TRUSS.as_bytes()[..40]),
        ImportProblem::Polygons(PolygonsImportError::Json(JsonError { line: 1, .. }))
    ));
    assert!(matches!(
        problem(&SVG.as_bytes()[..90]),
        ImportProblem::Svg(SvgError::Xml(_))
    ));
    assert!(matches!(
        problem(&OBJ.as_bytes()[..OBJ.len() - 4]),
        ImportProblem::Obj(ObjError::Line {
            line: 6,
            fault: ObjFault::TooFewCorners(2)
        })
    ));
}

/// Bytes of a PNG file whose header declares the given size, but which has no pixels.
fn png_claiming(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    drop(encoder.write_header().expect("a header"));
    bytes
}

#[test]
fn an_image_with_a_huge_declared_size_is_refused() {
    for (width, height) in [(100_000, 100_000), (u32::MAX >> 1, 1), (8192, 6145)] {
        let problem_found = problem(&png_claiming(width, height));
        let message = problem_found.to_string();
        assert!(
            message.contains(&format!("{width} × {height} pixels")),
            "{message}"
        );
        assert!(matches!(
            problem_found,
            ImportProblem::Picture(SilhouetteError::TooManyPixels { .. })
        ));
    }
    // The largest accepted size passes the check of the header; the missing pixels are an error.
    assert!(matches!(
        problem(&png_claiming(8192, 6144)),
        ImportProblem::Picture(SilhouetteError::Damaged(_))
    ));
}

#[test]
fn an_empty_mask_is_refused() {
    let clear = DynamicImage::new_rgba8(8, 8);
    let grey = DynamicImage::new_luma8(8, 8);
    for blank in [clear, grey] {
        let mut bytes = Cursor::new(Vec::new());
        blank
            .write_to(&mut bytes, ImageFormat::Png)
            .expect("encodes");
        assert!(matches!(
            problem(&bytes.into_inner()),
            ImportProblem::Picture(SilhouetteError::Empty { .. } | SilhouetteError::OneTone)
        ));
    }
}

#[test]
fn errors_in_meshes_and_trusses_are_located() {
    let nan = OBJ.replace("v 1 1 0", "v NaN 1 0");
    assert!(matches!(
        problem(nan.as_bytes()),
        ImportProblem::Obj(ObjError::Line {
            line: 3,
            fault: ObjFault::CoordinateRange(3)
        })
    ));
    let outside = OBJ.replace("f 1 3 4", "f 1 3 5");
    assert!(matches!(
        problem(outside.as_bytes()),
        ImportProblem::Obj(ObjError::Line {
            line: 6,
            fault: ObjFault::OutOfRange {
                face: 2,
                named: 5,
                vertices: 4
            }
        })
    ));
    let dangling = TRUSS.replace("[2, 0]", "[2, 3]");
    let error = read(dangling.as_bytes()).expect_err("a bar to a missing node");
    assert_eq!(
        error.to_string(),
        "given: bar 2 refers to node 3, but there are 3, counted from 0; correct the number"
    );
    let deep = format!("{{\"nodes\": {}", "[".repeat(100_000));
    assert!(matches!(
        problem(deep.as_bytes()),
        ImportProblem::Polygons(PolygonsImportError::Json(JsonError { line: 1, .. }))
    ));
    let closed = format!("{{\"nodes\": {}{}}}", "[".repeat(1000), "]".repeat(1000));
    assert!(matches!(
        problem(closed.as_bytes()),
        ImportProblem::Truss(TrussInputError::Json(JsonError { line: 1, .. }))
    ));
}

#[test]
fn exponentially_nested_use_elements_are_refused() {
    let mut body = String::from(r#"<g id="g0"><rect width="1" height="1"/></g>"#);
    for level in 1..40 {
        let copy = format!(r##"<use href="#g{}"/>"##, level - 1).repeat(8);
        body += &format!(r#"<g id="g{level}">{copy}</g>"#);
    }
    let text = format!(r#"<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>"#);
    assert!(matches!(
        problem(text.as_bytes()),
        ImportProblem::Svg(SvgError::TooManyElements { .. })
    ));
}

#[test]
fn unknown_formats_are_refused_with_a_reason() {
    assert!(matches!(
        problem(b"GIF89a....."),
        ImportProblem::UnknownFormat(UnknownFormat::Other { .. })
    ));
    assert!(matches!(
        problem(b"\x1f\x8b\x08\0"),
        ImportProblem::UnknownFormat(UnknownFormat::Other { .. })
    ));
    assert!(matches!(
        problem(b"hello"),
        ImportProblem::UnknownFormat(UnknownFormat::Unknown)
    ));
    assert!(matches!(
        problem(b"<p>hello</p>"),
        ImportProblem::UnknownFormat(UnknownFormat::XmlWithoutSvg)
    ));
}

#[test]
fn options_out_of_range_are_refused() {
    for tolerance in [-1.0, 0.2, f64::NAN, f64::INFINITY] {
        let options = ImportOptions {
            tolerance,
            ..ImportOptions::default()
        };
        let error = import("given", OBJ.as_bytes(), &options).expect_err("out of range");
        assert!(matches!(error.problem, ImportProblem::Options(_)));
    }
    let exact = ImportOptions {
        tolerance: 0.0,
        ..ImportOptions::default()
    };
    assert!(matches!(
        import("given", SVG.as_bytes(), &exact).expect("read").form,
        DesignForm::Outline(_)
    ));
}

#[test]
fn options_survive_serialization_and_unknown_keys_are_refused() {
    let options = ImportOptions {
        threshold: Some(7),
        specks_px: 3,
        ..ImportOptions::default()
    };
    let text = toml::to_string(&options).expect("text");
    assert!(text.contains("specks-px = 3"));
    assert_eq!(
        toml::from_str::<ImportOptions>(&text).expect("read"),
        options
    );
    assert_eq!(
        toml::from_str::<ImportOptions>("").expect("read"),
        ImportOptions::default()
    );
    assert!(toml::from_str::<ImportOptions>("speck = 3").is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes_never_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        drop(read(&bytes));
    }

    #[test]
    fn random_text_never_panics(text in "[\\[\\]{}<>/ vf0-9.eE+-]{0,80}", prefix in 0usize..6) {
        let prefix = ["", "{\"nodes\":", "<svg ", "v 0 0\nf ", "[[", "{\"rings\":[["][prefix];
        drop(read(format!("{prefix}{text}").as_bytes()));
    }

    #[test]
    fn mutated_files_never_panic(
        which in 0usize..10,
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in any::<prop::sample::Index>(),
        is_truncated in any::<bool>(),
    ) {
        let mut bytes = valid_files().swap_remove(which);
        for (place, byte) in edits {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if is_truncated {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(design) = read(&bytes) {
            // Computing the outline of an accepted design may fail, but must not panic.
            drop(design.outline(0.1));
        }
    }

    /// The rings have random and extreme coordinates and are often self-crossing or degenerate.
    #[test]
    fn polygons_of_extreme_numbers_never_panic(
        rings in proptest::collection::vec(
            proptest::collection::vec((random_or_extreme_number(), random_or_extreme_number()), 0..12), 0..4),
    ) {
        let rings: Vec<Vec<[f64; 2]>> = rings
            .into_iter()
            .map(|ring| ring.into_iter().map(|(x, y)| [x, y]).collect())
            .collect();
        if let Ok(design) = read(serde_json::to_string(&rings).expect("text").as_bytes()) {
            prop_assert!(design.outline(0.0).expect("area").area() > 0.0);
        }
    }

    #[test]
    fn dxf_drawings_of_extreme_numbers_never_panic(
        pairs in proptest::collection::vec((0usize..DXF_CODES.len(), random_or_extreme_number()), 0..40),
        kinds in proptest::collection::vec(0usize..DXF_ENTITIES.len(), 1..6),
    ) {
        let mut text = String::from("0\nSECTION\n2\nENTITIES\n");
        let pairs_per_entity = pairs.len() / kinds.len() + 1;
        for (kind, pairs) in kinds.iter().zip(pairs.chunks(pairs_per_entity)) {
            text += &format!("0\n{}\n8\n0\n", DXF_ENTITIES[*kind]);
            for (code, number) in pairs {
                text += &format!("{}\n{number}\n", DXF_CODES[*code]);
            }
        }
        drop(read((text + "0\nENDSEC\n0\nEOF\n").as_bytes()));
    }

    #[test]
    fn any_text_is_converted_to_outlines_or_refused(text in ".{0,12}") {
        let source = DesignSource::Text { text, font: None };
        drop(source.import(&ImportOptions::default()));
    }

    #[test]
    fn a_parsed_path_survives_writing_and_parsing(path in "(glyph:)?[a-z%@#./4]{0,16}") {
        let no_file = |_: &Path| false;
        let source = DesignSource::parse(path.as_ref(), no_file);
        prop_assert_eq!(DesignSource::parse(&source.to_path(), no_file), source);
    }

    #[test]
    fn broken_fonts_never_panic(
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..60),
        near_the_start in any::<bool>(),
        cut in any::<prop::sample::Index>(),
        is_truncated in any::<bool>(),
    ) {
        let mut bytes = epaint_default_fonts::UBUNTU_LIGHT.to_vec();
        let edited_length = if near_the_start { 2000 } else { bytes.len() };
        for (place, byte) in edits {
            bytes[place.index(edited_length)] = byte;
        }
        if is_truncated {
            bytes.truncate(cut.index(bytes.len()));
        }
        let source = DesignSource::Text { text: "Dfi 8".into(), font: Some("a.ttf".into()) };
        drop(source.import_bytes(&bytes, &ImportOptions::default()));
    }

    #[test]
    fn strokes_of_extreme_numbers_never_panic(
        numbers in proptest::collection::vec(random_or_extreme_number(), 8),
    ) {
        let n = |i: usize| numbers[i];
        let text = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20"><path id="p" d="M{} {} L{} {} Q{} 3 4 5" stroke="red" stroke-width="{}" stroke-dasharray="{} {}" stroke-linejoin="round"/></svg>"#,
            n(0), n(1), n(2), n(3), n(4), n(5), n(6), n(7)
        );
        let options = ImportOptions { strokes: true, ..ImportOptions::default() };
        drop(import("given", text.as_bytes(), &options));
    }
}

/// Kinds of DXF entities that the importer knows.
const DXF_ENTITIES: [&str; 8] = [
    "LINE",
    "ARC",
    "CIRCLE",
    "ELLIPSE",
    "LWPOLYLINE",
    "SPLINE",
    "VERTEX",
    "POLYLINE",
];
/// DXF group codes whose numbers the importer reads.
const DXF_CODES: [i32; 20] = [
    10, 20, 30, 11, 21, 31, 38, 40, 41, 42, 50, 51, 70, 71, 72, 73, 74, 210, 220, 230,
];

/// Strategy for numbers that are mostly small and sometimes extreme.
fn random_or_extreme_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => (-4i32..5).prop_map(f64::from),
        3 => -10.0..10.0,
        1 => prop::sample::select(vec![
            0.0, -0.0, 1e-300, 1e-30, -1e-9, 1e9, 1e30, -1e59, 1e61, 1e300, 360.0, 2147483648.0,
        ]),
    ]
}

#[test]
fn deep_and_hostile_polygons_are_refused() {
    for text in [
        "[".repeat(1_000_000),
        format!("{{\"type\": {}", "{\"type\":".repeat(1_000_000)),
        "{\"type\":\"GeometryCollection\",\"geometries\":[".repeat(10_000),
    ] {
        assert!(matches!(
            problem(text.as_bytes()),
            ImportProblem::Polygons(
                PolygonsImportError::Json { .. } | PolygonsImportError::TooManyObjects
            )
        ));
    }
    let error = read(b"{\"rings\": [[[0,0],[1,0],[\"x\",1]]]}").expect_err("no number");
    assert_eq!(
        error.to_string(),
        "given: $.rings[0][2] is a string; give two numbers for a point"
    );
}

#[test]
fn truncated_and_endless_dxf_drawings_are_refused() {
    let whole = dxf();
    assert!(matches!(
        problem(&whole.as_bytes()[..whole.len() / 2]),
        ImportProblem::Dxf(DxfError::Truncated { .. } | DxfError::Code { .. })
    ));
    let many = format!("0\nSECTION\n2\nENTITIES\n{}", "0\nLINE\n".repeat(2_000_000));
    assert!(matches!(
        problem(many.as_bytes()),
        ImportProblem::Dxf(DxfError::TooMany)
    ));
}

#[test]
fn an_element_can_be_selected_in_svg_files_only() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = ImportOptions::default();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("a.svg"), SVG.replace("<use ", "<use id=\"u\" ")).expect("written");
    std::fs::write(at("a.obj"), OBJ).expect("written");
    std::fs::write(at("b.svg#u"), OBJ).expect("written");
    let design = import_file(&at("a.svg#u"), &options).expect("an element");
    assert_eq!(design.name, "u");
    let error = import_file(&at("a.obj#u"), &options).expect_err("no drawing");
    assert!(matches!(error.problem, ImportProblem::NoElements { .. }));
    assert!(
        error
            .to_string()
            .contains("a.obj#u: elements can be selected by id")
    );
    // If a file called `b.svg#u` exists, this path means that file.
    assert!(import_file(&at("b.svg#u"), &options).is_ok());
    let error = import_file(&at("c.svg#u"), &options).expect_err("no file");
    assert!(matches!(
        error.problem,
        ImportProblem::Read(ReadError::Missing)
    ));
}
