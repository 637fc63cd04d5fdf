//! The bundled projects are what the gallery says of them.

use morphospace::geometry::DVec2;
use morphospace::project::{LoadedProject, gallery};
use morphospace::recording::RecordingOptions;
use morphospace::transition::{Sequence, Transition, VectorFigure};
use morphospace::work::progress::Silent;

fn build(name: &str) -> Transition {
    let loaded = gallery::load(name).expect(name);
    loaded.legs()[0].build(&Silent).expect(name)
}

fn at(name: &str, t: f64) -> VectorFigure {
    build(name).frame(t).figure()
}

fn signed_area(ring: &[DVec2]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b) / 2.0)
        .sum()
}

/// Pieces and holes of a figure; specks of less than a cell do not count.
fn pieces_and_holes(figure: &VectorFigure) -> (usize, usize) {
    let areas: Vec<f64> = figure.rings.iter().map(|ring| signed_area(ring)).collect();
    let largest = areas.iter().copied().fold(0.0, f64::max);
    let speck = largest * 1e-4;
    (
        areas.iter().filter(|&&a| a > speck).count(),
        areas.iter().filter(|&&a| a < -speck).count(),
    )
}

#[test]
fn every_project_has_a_title_and_a_sentence_and_opens_from_its_folder() {
    let entries = gallery::list().expect("the list");
    assert_eq!(entries.len(), 36);
    for entry in entries {
        assert!(!entry.title.is_empty(), "{}", entry.name);
        assert!(entry.description.ends_with('.'), "{}", entry.name);
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/gallery");
        let opened = LoadedProject::open(&folder.join(format!("{}.morph", entry.name)));
        let bundled = gallery::load(&entry.name).expect("bundled");
        let opened = opened.expect("opened");
        assert_eq!(opened.project, bundled.project);
        assert_eq!(opened.designs, bundled.designs);
    }
}

#[test]
fn every_project_draws_something_at_every_t() {
    for entry in gallery::list().expect("the list") {
        let transition = build(&entry.name);
        let mut frame = transition.frame(0.0);
        for t in [0.0, 0.25, 0.5, 1.0] {
            frame.seek(t);
            let figure = frame.figure();
            let drawn = figure.rings.len() + figure.bars.len();
            assert!(drawn > 0, "{} at {t}", entry.name);
        }
    }
}

#[test]
fn a_way_through_many_designs_leads_back() {
    let loaded = gallery::load("letters-in-turn").expect("bundled");
    let legs = loaded.legs();
    assert_eq!(legs.len(), 5);
    let built = legs.iter().map(|leg| leg.build(&Silent));
    let built: Vec<Transition> = built.collect::<Result<_, _>>().expect("built");
    let sequence = Sequence::new(built).expect("legs").leading_back(true);
    let mut frame = sequence.frame(0.0);
    let area = |figure: &VectorFigure| -> f64 { figure.rings.iter().map(|r| signed_area(r)).sum() };
    let first = area(&frame.now().figure());
    frame.seek(5.0);
    assert!((area(&frame.now().figure()) - first).abs() < 1e-9 * first);
}

#[test]
fn silhouettes_of_one_topology_keep_it() {
    for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
        assert_eq!(
            pieces_and_holes(&at("bridges", t)),
            (1, 4),
            "bridges at {t}"
        );
        assert_eq!(
            pieces_and_holes(&at("vessels", t)),
            (1, 1),
            "vessels at {t}"
        );
    }
}

#[test]
fn cantilevers_tear() {
    assert_eq!(pieces_and_holes(&at("cantilevers", 0.0)), (1, 9));
    assert_eq!(pieces_and_holes(&at("cantilevers", 1.0)), (1, 9));
    assert!(pieces_and_holes(&at("cantilevers", 0.5)).0 > 5);
}

#[test]
fn letters_are_a_ring_and_a_stroke() {
    assert_eq!(pieces_and_holes(&at("letters", 0.0)), (1, 1));
    assert_eq!(pieces_and_holes(&at("letters", 1.0)), (1, 0));
}

#[test]
fn trusses_have_the_bars_that_are_promised() {
    for (name, bars) in [("bracket-to-davit", 35), ("girder-to-arch", 61)] {
        assert_eq!(at(name, 0.5).bars.len(), bars, "{name}");
    }
}

#[test]
fn the_stress_scene_is_as_large_as_its_title_says() {
    let transition = build("rotor");
    assert_eq!(transition.frame(0.5).placement().in_frame.len(), 99_025);
}

#[test]
fn a_lamp_shrinks_on_straight_paths_and_keeps_its_length_on_intrinsic_ones() {
    let perimeter = |name: &str, t: f64| -> f64 {
        let ring = &at(name, t).rings[0];
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a.distance(*b)).sum()
    };
    let whole = perimeter("polygons-straight", 0.0);
    assert!(perimeter("polygons-straight", 0.5) < 0.8 * whole);
    assert!((perimeter("polygons-intrinsic", 0.5) / whole - 1.0).abs() < 0.05);
}

#[test]
fn films_of_rigid_parts_are_recorded_in_few_solves() {
    let mut recorded = 0;
    for entry in gallery::list().expect("the list") {
        let loaded = gallery::load(&entry.name).expect("a project");
        for leg in loaded.legs() {
            let transition = leg.build(&Silent).expect(&entry.name);
            if transition.arap().is_none() {
                continue;
            }
            let film = transition.record(&RecordingOptions::default(), &Silent);
            let film = film.expect(&entry.name);
            let most = match entry.name.as_str() {
                // Its coil turns three times.
                "fern" => 32,
                // The last letter of a word stands still until halfway.
                "day-to-night" => 32,
                _ => 16,
            };
            let solves = film.solves();
            assert!(solves <= most, "{}: {solves}", entry.name);
            recorded += 1;
        }
    }
    assert!(recorded > 20, "{recorded} films");
}
