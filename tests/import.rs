//! Bad input of every kind: a typed error that names the file, the place and
//! the way out, and never a panic.

use image::{DynamicImage, GrayImage, ImageFormat, Luma};
use morphospace::design::{
    Design, Form, ImportError, ImportOptions, ObjError, PictureError, Problem, SvgError,
    TrussInputError, UnknownFormat, import, import_file,
};
use proptest::prelude::*;
use std::io::Cursor;
use std::path::Path;

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const SVG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20"><style>.a{fill:#123}</style><defs><path id="p" d="M1 1 C 5 1 9 5 9 9 Q 4 12 1 1 A 3 2 30 0 1 4 4 Z"/></defs><use class="a" href="#p" transform="rotate(20)"/></svg>"##;
const TRUSS: &str = r#"{"nodes": [[0, 0], [1, 0], [0, 1]], "bars": [[0, 1], [1, 2], [2, 0]]}"#;

fn read(bytes: &[u8]) -> Result<Design, ImportError> {
    import("given", bytes, &ImportOptions::default())
}

fn problem(bytes: &[u8]) -> Problem {
    let error = read(bytes).expect_err("bad input");
    let message = error.to_string();
    assert!(message.starts_with("given: "), "{message}");
    assert!(!message.contains('\n'), "{message}");
    error.problem
}

fn picture(format: ImageFormat) -> Vec<u8> {
    let disc = GrayImage::from_fn(24, 20, |x, y| {
        let far = (f64::from(x) - 11.0).hypot(f64::from(y) - 9.0);
        Luma([(far * 25.0) as u8])
    });
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::from(disc)
        .write_to(&mut bytes, format)
        .expect("encodes");
    bytes.into_inner()
}

const PICTURES: [ImageFormat; 4] = [
    ImageFormat::Png,
    ImageFormat::Jpeg,
    ImageFormat::Bmp,
    ImageFormat::WebP,
];

/// Every kind of file, all good.
fn good_files() -> Vec<Vec<u8>> {
    let texts = [OBJ, SVG, TRUSS].map(|text| text.as_bytes().to_vec());
    PICTURES.map(picture).into_iter().chain(texts).collect()
}

#[test]
fn all_good_files_are_read() {
    for bytes in good_files() {
        let design = read(&bytes).expect("good");
        assert!(design.outline(0.05).expect("area").area() > 0.0);
    }
}

#[test]
fn a_missing_file_a_folder_and_an_empty_file_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = ImportOptions::default();
    let missing = folder.path().join("nowhere.png");
    let error = import_file(&missing, &options).expect_err("missing");
    assert!(matches!(error.problem, Problem::Missing));
    assert!(
        error
            .to_string()
            .contains("nowhere.png: there is no such file")
    );
    let error = import_file(folder.path(), &options).expect_err("a folder");
    assert!(matches!(error.problem, Problem::Folder));
    let empty = folder.path().join("empty.svg");
    std::fs::write(&empty, "").expect("written");
    let error = import_file(&empty, &options).expect_err("empty");
    assert!(matches!(error.problem, Problem::Empty));
    assert!(import_file(Path::new(""), &options).is_err());
}

#[test]
fn a_mislabelled_file_works_and_names_the_design() {
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
fn a_byte_order_mark_and_crlf_are_no_obstacle() {
    for text in [OBJ, SVG, TRUSS] {
        let text = format!("\u{feff}{}", text.replace('\n', "\r\n"));
        read(text.as_bytes()).expect("good");
    }
    let bomb = "\u{feff}<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE svg PUBLIC \
                \"-//W3C//DTD SVG 1.1//EN\" \"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\">\n";
    read(format!("{bomb}{SVG}").as_bytes()).expect("good");
}

#[test]
fn truncated_pictures_are_refused() {
    for format in PICTURES {
        let bytes = picture(format);
        for keep in [bytes.len() * 2 / 3, bytes.len() / 2, 40] {
            assert!(
                matches!(
                    problem(&bytes[..keep]),
                    Problem::Picture(PictureError::Truncated | PictureError::Damaged(_))
                ),
                "{format:?} {keep}"
            );
        }
    }
}

#[test]
fn truncated_texts_are_refused() {
    assert!(matches!(
        problem(&TRUSS.as_bytes()[..40]),
        Problem::Truss(_)
    ));
    assert!(matches!(
        problem(&SVG.as_bytes()[..90]),
        Problem::Svg(SvgError::Xml(_))
    ));
    assert!(matches!(
        problem(&OBJ.as_bytes()[..OBJ.len() - 4]),
        Problem::Obj(ObjError::TooFewCorners { line: 6, face: 2 })
    ));
}

/// A PNG with a true checksum whose header claims a size.
fn png_claiming(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    drop(encoder.write_header().expect("a header"));
    bytes
}

#[test]
fn a_picture_that_claims_to_be_huge_is_refused_by_its_size() {
    for (width, height) in [(100_000, 100_000), (u32::MAX >> 1, 1), (8193, 8192)] {
        let found = problem(&png_claiming(width, height));
        let message = found.to_string();
        assert!(
            message.contains(&format!("{width} × {height} pixels")),
            "{message}"
        );
        assert!(matches!(
            found,
            Problem::Picture(PictureError::TooManyPixels { .. })
        ));
    }
    // The largest that is read gets as far as its missing pixels.
    assert!(matches!(
        problem(&png_claiming(8192, 8192)),
        Problem::Picture(PictureError::Damaged(_))
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
            Problem::Picture(PictureError::Empty { .. } | PictureError::OneTone)
        ));
    }
}

#[test]
fn hostile_meshes_and_trusses_are_named() {
    let nan = OBJ.replace("v 1 1 0", "v NaN 1 0");
    assert!(matches!(
        problem(nan.as_bytes()),
        Problem::Obj(ObjError::NotFinite { line: 3, vertex: 3 })
    ));
    let outside = OBJ.replace("f 1 3 4", "f 1 3 5");
    assert!(matches!(
        problem(outside.as_bytes()),
        Problem::Obj(ObjError::OutOfRange {
            line: 6,
            face: 2,
            named: 5,
            vertices: 4
        })
    ));
    let nowhere = TRUSS.replace("[2, 0]", "[2, 3]");
    let error = read(nowhere.as_bytes()).expect_err("a bar to nowhere");
    assert_eq!(
        error.to_string(),
        "given: bar 2 names node 3, but there are 3, counted from 0; correct the number"
    );
    let deep = format!("{{\"nodes\": {}", "[".repeat(100_000));
    assert!(matches!(
        problem(deep.as_bytes()),
        Problem::Truss(TrussInputError::Json { line: 1, .. })
    ));
}

#[test]
fn nested_use_is_refused() {
    let mut body = String::from(r#"<g id="g0"><rect width="1" height="1"/></g>"#);
    for level in 1..40 {
        let copy = format!(r##"<use href="#g{}"/>"##, level - 1).repeat(8);
        body += &format!(r#"<g id="g{level}">{copy}</g>"#);
    }
    let text = format!(r#"<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>"#);
    assert!(matches!(
        problem(text.as_bytes()),
        Problem::Svg(SvgError::TooManyElements { .. })
    ));
}

#[test]
fn other_formats_and_noise_are_refused_in_words() {
    assert!(matches!(
        problem(b"GIF89a....."),
        Problem::Unknown(UnknownFormat::Other { .. })
    ));
    assert!(matches!(
        problem(b"\x1f\x8b\x08\0"),
        Problem::Unknown(UnknownFormat::Other { .. })
    ));
    assert!(matches!(
        problem(b"hello"),
        Problem::Unknown(UnknownFormat::Unknown)
    ));
    assert!(matches!(
        problem(b"<p>hello</p>"),
        Problem::Unknown(UnknownFormat::XmlWithoutSvg)
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
        assert!(matches!(error.problem, Problem::Options(_)));
    }
    let exact = ImportOptions {
        tolerance: 0.0,
        ..ImportOptions::default()
    };
    assert!(matches!(
        import("given", SVG.as_bytes(), &exact).expect("read").form,
        Form::Outline(_)
    ));
}

#[test]
fn options_go_through_text_and_unknown_ones_are_refused() {
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
    fn random_text_never_panics(text in "[\\[\\]{}<>/ vf0-9.eE+-]{0,80}", prefix in 0usize..4) {
        let prefix = ["", "{\"nodes\":", "<svg ", "v 0 0\nf "][prefix];
        drop(read(format!("{prefix}{text}").as_bytes()));
    }

    #[test]
    fn mutated_files_never_panic(
        which in 0usize..7,
        edits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in any::<prop::sample::Index>(),
        cuts in any::<bool>(),
    ) {
        let mut bytes = good_files().swap_remove(which);
        for (place, byte) in edits {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        if cuts {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(design) = read(&bytes) {
            // What was let in can be drawn, or says that it has no area.
            drop(design.outline(0.1));
        }
    }
}
