//! Tests of project files: parsing, errors, writing, round trips, and loading of designs.
#![expect(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::colour::Rgb;
use crate::geometry::{DVec2, Similarity};
use crate::transition::{DesignFit, NamedEasing, PlayMode, TransitionStop};
use crate::warp::{ArapPath, FaceWeights, VertexPath, WarpKind};
use proptest::prelude::*;
use std::path::Path;

/// A project with only the required keys.
const MINIMAL: &str = "version = 1\n[[designs]]\npath = 'a.svg'\n[[designs]]\npath = 'b.svg'\n";

/// Returns the line named by the error for an invalid project.
fn line_of(text: &str) -> usize {
    match Project::parse(text) {
        Err(ProjectError::Syntax { line, .. } | ProjectError::NewerVersion { line, .. }) => line,
        other => panic!("expected an error with a line: {other:?}"),
    }
}

#[test]
fn errors_name_the_line_of_an_unknown_key_or_value() {
    for (text, line) in [
        (MINIMAL.replace("version", "colour = 3\nversion"), 1),
        (format!("{MINIMAL}[arap]\nhomotopi = 'polar'\n"), 7),
        (format!("{MINIMAL}[paths]\ncurse = 'straight'\n"), 7),
        (format!("{MINIMAL}[field]\n\n\nmetric = 'manhattan'\n"), 9),
        (format!("{MINIMAL}[field.blend]\nespilon = 1\n"), 7),
        (format!("{MINIMAL}[style]\nsource = 'blue'\n"), 7),
        (format!("{MINIMAL}[designs.placement]\nskale = 1\n"), 7),
        (format!("{MINIMAL}[match]\nstretsh = 1\n"), 7),
        (
            MINIMAL.replace("version", "\ntravel = 'by train'\nversion"),
            2,
        ),
        (MINIMAL.replace("version", "bar-width = 'x'\nversion"), 1),
        (format!("{MINIMAL}[plane]\n"), 6),
        ("version = \n".to_owned(), 1),
    ] {
        assert_eq!(line_of(&text), line, "{text}");
    }
}

#[test]
fn the_error_for_an_unknown_key_lists_all_keys() {
    let text = MINIMAL.replace("version", "\"bar\\nwidth\" = 3\nversion");
    let error = Project::parse(&text).unwrap_err().to_string();
    for part in [
        "line 1: ",
        r#""bar\nwidth""#,
        "fit",
        "bar-width",
        "match",
        "lattice",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
}

#[test]
fn options_are_written_at_the_top_level() {
    let mut project = Project::parse(MINIMAL).unwrap();
    let keys = |project: &Project| -> Vec<String> {
        let table: toml::Table = project.to_toml().unwrap().parse().unwrap();
        table.keys().cloned().collect()
    };
    let required = [
        "arap",
        "bar-width",
        "designs",
        "field",
        "style",
        "timing",
        "version",
    ];
    assert_eq!(keys(&project), required, "defaults are left out");
    project.options.travel = crate::warp::FeatureTravel::Whole;
    project.options.matching.stretch = Some(0.5);
    project.options.lattice.fold_free = !project.options.lattice.fold_free;
    for key in ["travel", "match", "lattice"] {
        assert!(keys(&project).iter().any(|k| k == key), "{key}");
    }
    let text = project.to_toml().unwrap();
    assert_eq!(Project::parse(&text).unwrap(), project);
}

#[test]
fn a_newer_version_is_reported_before_its_unknown_keys() {
    let text = format!(
        "# from the future\n{}",
        MINIMAL.replace("= 1", "= 3\nhyper = true")
    );
    assert_eq!(line_of(&text), 2);
    let error = Project::parse(&text).unwrap_err().to_string();
    assert!(
        error.contains("version 3") && error.contains("update"),
        "{error}"
    );
}

#[test]
fn only_projects_of_three_or_more_designs_have_segment_settings() {
    let three = format!("{MINIMAL}[[designs]]\npath = 'c.svg'\n");
    let project = Project::parse(&three).unwrap();
    assert_eq!(project.segment_count(), 2);
    assert!(project.to_toml().unwrap().starts_with("version = 2\n"));
    // Match settings at the top level belong to the first segment.
    let matched = Project::parse(&format!("{three}[match]\nkeep-up = true\n")).unwrap();
    assert!(matched.segment(0).options.matching.keep_up);
    assert!(!matched.segment(1).options.matching.keep_up);
    let legs = "[[legs]]\n[[legs]]\n[legs.match]\nkeep-up = true\n";
    let with_legs = Project::parse(&format!("{three}{legs}")).unwrap();
    assert!(with_legs.segment(1).options.matching.keep_up);
    assert_eq!(
        Project::parse(&with_legs.to_toml().unwrap()).unwrap(),
        with_legs
    );
    let pair = Project::parse(MINIMAL).unwrap();
    assert!(pair.to_toml().unwrap().starts_with("version = 1\n"));
    for (text, word) in [
        (format!("{three}{legs}[[legs]]\n"), "[[legs]]"),
        (format!("{MINIMAL}[[legs]]\n"), "a pair"),
        (
            format!("{three}{legs}[match]\nkeep-up = true\n"),
            "first of these",
        ),
        (format!("{three}[[legs]]\n[legs.mach]\n"), "mach"),
        (
            format!("{MINIMAL}[[stops]]\nt = 0.5\nhold-secs = -1\n"),
            "pause of 0 or more",
        ),
    ] {
        let error = Project::parse(&text).unwrap_err().to_string();
        assert!(error.contains(word), "{word}: {error}");
    }
}

#[test]
fn invalid_values_are_errors() {
    for (edit, word) in [
        ("version = 0", "no version 0"),
        ("version = 1\n[timing]\nduration-secs = 0", "duration"),
        ("version = 1\n[timing]\nfrom = 1", "two different"),
        ("version = 1\n[field.blend]\nepsilon = 0", "epsilon"),
    ] {
        let (head, tables) = edit.split_once('\n').unwrap_or((edit, ""));
        let text = format!("{}{tables}\n", MINIMAL.replace("version = 1", head));
        let error = Project::parse(&text).unwrap_err().to_string();
        assert!(
            error.to_lowercase().contains(word) || word == "epsilon",
            "{error}"
        );
    }
    let one_design = "version = 1\n[[designs]]\npath = 'a.svg'\n";
    assert!(matches!(
        Project::parse(one_design),
        Err(ProjectError::TooFewDesigns(1))
    ));
    let zero_scale = format!("{MINIMAL}[designs.placement]\nscale = 0\n");
    assert!(matches!(
        Project::parse(&zero_scale),
        Err(ProjectError::Placement(_))
    ));
}

#[test]
fn errors_name_a_missing_or_binary_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.morph");
    let error = Project::read(&path).unwrap_err().to_string();
    assert!(error.contains("x.morph"), "{error}");
    std::fs::write(&path, [0xff, 0xfe, 0x00]).unwrap();
    let error = Project::read(&path).unwrap_err().to_string();
    assert!(error.contains("not a text file"), "{error}");
    std::fs::write(&path, "").unwrap();
    let error = Project::read(&path).unwrap_err().to_string();
    assert!(error.contains("version"), "{error}");
}

#[test]
fn a_failed_save_leaves_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.morph");
    let project = Project::parse(MINIMAL).unwrap();
    project.save_atomically(&path).unwrap();
    let before = std::fs::read(&path).unwrap();
    let unwritable = folder.path().join("missing").join("x.morph");
    assert!(project.save_atomically(&unwritable).is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    let entries: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    assert_eq!(entries.len(), 1, "no temporary file stays behind");
}

#[test]
fn every_bundled_project_loads_and_round_trips() {
    let entries = gallery::list().unwrap();
    for entry in &entries {
        assert!(
            !entry.title.is_empty() && !entry.description.is_empty(),
            "{}",
            entry.name
        );
        let loaded = gallery::load(&entry.name).unwrap();
        let text = loaded.project.to_toml().unwrap();
        assert_eq!(Project::parse(&text).unwrap(), loaded.project);
        match loaded.project.follows_path() {
            true => drop(loaded.space_spec().unwrap()),
            false => drop(loaded.spec().unwrap()),
        }
    }
    let error = gallery::load("nothing").unwrap_err().to_string();
    assert!(error.contains("nothing"), "{error}");
}

#[test]
fn only_projects_of_pictures_are_blended_as_pictures() {
    let space = |last: &str| {
        let designs = ["portrait-ada.png", "portrait-max.png", last];
        let designs = designs.map(|path| format!("[[designs]]\npath = '{path}'\n"));
        let project = Project::parse(&format!("version = 2\n{}", designs.concat())).unwrap();
        LoadedProject::load(project, None)
            .unwrap()
            .space_spec()
            .unwrap()
    };
    let pictures = Some(crate::content::ContentKind::Colours);
    assert_eq!(space("portrait-noor.png").content, pictures);
    // With a drawing among them, the pictures are blended as silhouettes.
    assert_eq!(space("shape-heart.svg").content, None);
}

#[test]
fn relative_paths_are_relative_to_the_project_file() {
    let folder = tempfile::tempdir().unwrap();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    std::fs::write(folder.path().join("sub/a.obj"), triangle).unwrap();
    std::fs::write(folder.path().join("b.obj"), triangle).unwrap();
    let mut project = Project::from_pair("sub/a.obj", "b.obj");
    project.designs[0].name = "first".to_owned();
    let path = folder.path().join("x.morph");
    project.save_atomically(&path).unwrap();
    let loaded = LoadedProject::open(&path).unwrap();
    assert_eq!(loaded.designs[0].name, "first");
    assert_eq!(loaded.method().unwrap().warp(), WarpKind::Arap);
    assert_eq!(loaded.title(), "a to b");
    std::fs::remove_file(folder.path().join("b.obj")).unwrap();
    let error = LoadedProject::open(&path).unwrap_err().to_string();
    assert!(error.contains("b.obj"), "{error}");
    assert!(LoadedProject::open_pair(Path::new("/nowhere/x"), &path).is_err());
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), -1e6f64..1e6, Just(0.1 + 0.2), Just(1e-300)]
}

proptest! {
    #[test]
    fn a_round_trip_loses_nothing(
        numbers in prop::collection::vec(any_number(), 6),
        positive in prop::collection::vec(1e-6f64..1e6, 4),
        turns in prop::collection::vec(-9i32..9, 0..4),
        names in prop::collection::vec("\\PC{0,12}", 4),
        index in 0usize..4, flag in any::<bool>(), colour in any::<[u8; 3]>(),
    ) {
        let mut project = Project::from_pair("a b/ä.png", "..\\c'\"\n.svg");
        project.title = names[0].clone();
        project.description = names[1].clone();
        project.fit = [DesignFit::AsDrawn, DesignFit::Centred, DesignFit::SameArea, DesignFit::Centred][index];
        project.warp = flag.then_some(WarpKind::Arap);
        project.options.bar_width = positive[0];
        project.designs[0].name = names[2].clone();
        project.designs[0].import.threshold = flag.then_some(7);
        project.designs[1].placement = Similarity {
            offset: DVec2::new(numbers[0], numbers[1]),
            scale: positive[1],
            rotation: numbers[2],
            mirror: flag,
        };
        project.options.arap.extra_turns = turns;
        project.options.arap.weights = if flag { FaceWeights::PerFace(positive.clone()) } else { FaceWeights::Uniform };
        project.options.arap.path = if flag { ArapPath::Anchor(3) } else { ArapPath::Centroid };
        project.options.paths.course = if flag { VertexPath::Straight } else { VertexPath::Intrinsic };
        project.timing.duration_secs = positive[2];
        project.timing.easing = NamedEasing::ALL[index].into();
        project.timing.play = [PlayMode::Once, PlayMode::Loop, PlayMode::PingPong, PlayMode::Once][index];
        project.options.field.blend.epsilon = positive[3];
        project.options.field.blend.threshold = numbers[3];
        project.style.ground = Rgb(colour);
        // Pauses at stops need version 2.
        project.version = FORMAT_VERSION;
        project.stops = vec![
            TransitionStop {
                hold_secs: positive[1],
                duration_secs: flag.then_some(positive[0]),
                note: names[3].clone(),
                easing: Some("0.25,0,0.5,1".parse().expect("a curve")),
                ..TransitionStop::at(numbers[4]).with_name(&names[3])
            },
            TransitionStop::at(numbers[5]),
        ];
        let text = project.to_toml().expect("can be written");
        prop_assert_eq!(Project::parse(&text).expect(&text), project);
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,200}", cut in 0usize..80) {
        prop_assert!(Project::parse(&text).is_err());
        let end = MINIMAL.char_indices().map(|(i, _)| i).nth(cut).unwrap_or(MINIMAL.len());
        Project::parse(&MINIMAL[..end]).map(|_| ()).unwrap_or_default();
    }
}

#[test]
fn text_needs_no_file_in_a_bundled_project() {
    let project = Project::from_pair("glyph:D", "glyph:form");
    assert_eq!(project.title, "D to form");
    let loaded = LoadedProject::load(project, None).unwrap();
    assert_eq!(loaded.designs[1].name, "form");
    let missing = Project::from_pair("glyph:D", "glyph:S@nowhere.ttf");
    assert!(LoadedProject::load(missing, None).is_err());
}

#[test]
fn fonts_are_found_relative_to_the_project_file() {
    let folder = tempfile::tempdir().unwrap();
    let font = epaint_default_fonts::UBUNTU_LIGHT;
    std::fs::write(folder.path().join("light.ttf"), font).unwrap();
    std::fs::write(
        folder.path().join("glyph:D"),
        "v 0 0\nv 1 0\nv 0 1\nf 1 2 3",
    )
    .unwrap();
    let project = Project::from_pair("glyph:D@light.ttf", "./glyph:D");
    let loaded = LoadedProject::load(project, Some(folder.path().to_owned())).unwrap();
    let [thin, file] = [0, 1].map(|k| loaded.designs[k].outline(0.0).unwrap().area());
    assert!(thin > 10_000.0 && file == 0.5, "{thin} {file}");
}

#[cfg(unix)]
#[test]
fn designs_with_non_utf8_names_are_saved_and_opened() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let name = |bytes: &[u8]| Path::new(std::ffi::OsStr::from_bytes(bytes)).to_owned();
    let names = [
        name(b"caf\xe9 50%.json"),
        name("file:\u{e9}%20.json".as_bytes()),
    ];
    for name in &names {
        std::fs::write(folder.path().join(name), "[[0,0],[4,0],[4,3],[0,3]]").unwrap();
    }
    let project = Project::from_paths(names);
    let path = folder.path().join(name(b"\xff.morph"));
    project.save_atomically(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(
        text.contains(r#"path = "file:caf%E9 50%25.json""#),
        "{text}"
    );
    assert!(
        text.contains("path = \"file:\u{e9}%20.json\""),
        "only as needed"
    );
    let loaded = LoadedProject::open(&path).unwrap();
    assert_eq!(loaded.project, project);
    assert_eq!(loaded.designs.len(), 2);
}
