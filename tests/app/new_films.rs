//! Tests of films made from new designs: text, icons without colours, and pictures with two possible
//! silhouettes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::{Rgba, RgbaImage};
use morphospace::app::testing::{Intent, PictureReadings};
use morphospace::colour::Rgb;
use morphospace::design::PictureReading;
use morphospace::transition::TransitionStyle;

use crate::headless_window::HeadlessWindow;

fn opened(files: Vec<PathBuf>) -> HeadlessWindow {
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(files));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    window
}

#[test]
fn text_is_a_design_and_is_saved_with_the_project() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = opened(vec!["glyph:Hello".into(), "glyph:you".into()]);
    assert_eq!(window.session().names_along_path(), ["Hello", "you"]);
    assert_eq!(window.session().title(), "Hello to you");
    let path = folder.path().join("text.morph");
    window.send(Intent::SaveTo(path.clone()));
    let reopened = opened(vec![path]);
    assert_eq!(reopened.session().names_along_path(), ["Hello", "you"]);
}

/// Writes an icon whose file contains `attributes` on its only shape.
fn icon(folder: &Path, name: &str, attributes: &str) -> PathBuf {
    let path = folder.join(name);
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 24 24'>\
         <path {attributes} d='M2 2h20v20h-20z'/></svg>"
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

#[test]
fn icons_without_colours_are_black_unless_another_style_is_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let black = Rgb([0; 3]);
    let files = vec![
        icon(folder.path(), "a.svg", ""),
        icon(folder.path(), "b.svg", "fill='currentColor'"),
    ];
    let mut window = opened(files);
    let colours = |window: &HeadlessWindow| {
        let style = window.session().style();
        [style.source, style.target]
    };
    assert_eq!(colours(&window), [black; 2]);
    assert!(!window.session().is_dirty());
    assert_eq!(window.session().drawn_colours(), Some([black; 2]));
    let plain = TransitionStyle::default();
    let mut project = window.session().project().cloned().expect("a project");
    (project.style.source, project.style.target) = (plain.source, plain.target);
    window.send(Intent::ReplaceSettings(Box::new(project)));
    let path = folder.path().join("styled.morph");
    window.send(Intent::SaveTo(path.clone()));
    let reopened = opened(vec![path]);
    assert_eq!(colours(&reopened), [plain.source, plain.target]);
    // A drawing with colours and a text have no such colour.
    let text = opened(vec!["glyph:D".into(), icon(folder.path(), "c.svg", "")]);
    assert_eq!(colours(&text), [plain.source, plain.target]);
}

#[test]
fn a_picture_with_two_silhouettes_offers_both() {
    let folder = tempfile::tempdir().expect("a folder");
    // A blue tile with transparent corners and a white disc.
    let tile = RgbaImage::from_fn(80, 80, |x, y| {
        let [x, y] = [x, y].map(|k| f64::from(k) - 39.5);
        match x.hypot(y) {
            radius if radius < 20.0 => Rgba([255; 4]),
            radius if radius < 50.0 => Rgba([30, 60, 200, 255]),
            _ => Rgba([0; 4]),
        }
    });
    let path = folder.path().join("tile.png");
    tile.save(&path).expect("a file");
    let mut window = opened(vec![path, "glyph:D".into()]);
    let choices = |window: &mut HeadlessWindow| {
        for _ in 0..2000 {
            let readings = window.0.world().resource::<PictureReadings>();
            let design = Arc::clone(&window.session().all_designs()[0]);
            if !readings.is_busy() {
                return readings.choices(&design).to_vec();
            }
            std::thread::sleep(std::time::Duration::from_millis(2));
            window.update();
        }
        panic!("the silhouettes are not traced in time");
    };
    let offered = choices(&mut window);
    let kinds: Vec<PictureReading> = offered.iter().map(|choice| choice.reading).collect();
    assert_eq!(kinds, [PictureReading::Brightness, PictureReading::Opacity]);
    assert_ne!(
        offered[0].image, offered[1].image,
        "each has its own picture"
    );
    let area = |window: &HeadlessWindow| {
        let outline = window.session().all_designs()[0]
            .outline(0.0)
            .expect("an outline");
        outline.area()
    };
    let disc = area(&window);
    let mut project = window.session().project().cloned().expect("a project");
    project.designs[0].import.reading = PictureReading::Opacity;
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
    assert!(area(&window) > 3.0 * disc, "the whole tile");
    // Both are still offered, in the same order.
    let again: Vec<PictureReading> = choices(&mut window).iter().map(|of| of.reading).collect();
    assert_eq!(again, kinds);
}
