//! What an audience sees: with the panels hidden, the drawing and nothing else.

use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{IntoScheduleConfigs, PostUpdate, Query, ResMut, Resource};
use bevy_egui::egui::Shape;
use bevy_egui::{EguiFullOutput, EguiPostUpdateSet};
use morphospace::app::{
    Comparison, Intent, NoticeTopic, Notices, StageMeasures, UnsavedAnswer, UnsavedQuestion,
};

use crate::window::Window;

/// What was drawn over the stage in the last frame: words, and how many shapes there are in all.
#[derive(Resource, Default)]
struct Drawn {
    words: Vec<String>,
    shapes: usize,
}

fn note(outputs: Query<&EguiFullOutput>, mut drawn: ResMut<Drawn>) {
    *drawn = Drawn::default();
    for output in outputs.iter().filter_map(|output| output.0.as_ref()) {
        for clipped in &output.shapes {
            drawn.add(&clipped.shape);
        }
    }
}

impl Drawn {
    fn add(&mut self, shape: &Shape) {
        match shape {
            Shape::Noop => {}
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| self.add(shape)),
            Shape::Text(text) => {
                self.shapes += 1;
                self.words.push(text.galley.text().to_owned());
            }
            _ => self.shapes += 1,
        }
    }

    fn says(&self, part: &str) -> bool {
        self.words.iter().any(|words| words.contains(part))
    }
}

fn watched() -> Window {
    let mut window = Window::with_panels();
    let note = note
        .after(EguiPostUpdateSet::EndPass)
        .before(EguiPostUpdateSet::ProcessOutput);
    window.0.init_resource::<Drawn>();
    window.0.add_systems(PostUpdate, note);
    window.update();
    window
}

fn drawn(window: &mut Window) -> &Drawn {
    // What a key asks for is seen in the next frame; a card is measured in its first.
    for _ in 0..3 {
        window.update();
    }
    window.0.world().resource()
}

/// Everything that the program may have to say at once.
fn worry(window: &mut Window) {
    window.press(KeyCode::F3, Key::F3);
    window.type_char(KeyCode::KeyV, "v");
    let done = |window: &Window| {
        let world = window.0.world();
        world.resource::<StageMeasures>().measures().is_some()
            && world.resource::<Comparison>().transition().is_some()
    };
    while !done(window) {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.update();
    }
    let mut notices = window.0.world_mut().resource_mut::<Notices>();
    notices.problem(NoticeTopic::Film, "a problem");
    notices.done("a confirmation");
}

#[test]
fn with_the_panels_hidden_nothing_but_the_drawing_is_there() {
    let mut window = watched();
    worry(&mut window);
    let seen = drawn(&mut window);
    let told = [
        "a problem",
        "a confirmation",
        "Whole frame",
        "Straight lines",
    ];
    for words in told {
        assert!(seen.says(words), "{words}: {:?}", seen.words);
    }
    window.type_char(KeyCode::KeyH, "h");
    let seen = drawn(&mut window);
    assert_eq!((seen.shapes, &seen.words), (0, &Vec::new()));
}

#[test]
fn what_was_to_be_told_is_told_when_the_panels_are_back() {
    let mut window = watched();
    window.type_char(KeyCode::KeyH, "h");
    worry(&mut window);
    // Longer than a confirmation stays.
    for _ in 0..1000 {
        window.update();
    }
    assert_eq!(drawn(&mut window).shapes, 0);
    window.type_char(KeyCode::KeyH, "h");
    let seen = drawn(&mut window);
    assert!(seen.says("a problem") && seen.says("a confirmation"));
}

#[test]
fn what_is_asked_for_is_shown_to_whoever_asked() {
    let mut window = watched();
    window.type_char(KeyCode::KeyH, "h");
    window.press(KeyCode::F1, Key::F1);
    assert!(drawn(&mut window).says("Play or pause"));
    window.press(KeyCode::Escape, Key::Escape);
    assert_eq!(drawn(&mut window).shapes, 0);
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    window.send(Intent::Close);
    assert!(drawn(&mut window).says("Unsaved changes"));
    window.send(Intent::Answer(UnsavedAnswer::Stay));
    assert!(
        window
            .0
            .world()
            .resource::<UnsavedQuestion>()
            .text()
            .is_none()
    );
    assert_eq!(drawn(&mut window).shapes, 0);
}

#[test]
fn a_further_design_is_asked_about() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("more.json");
    std::fs::write(&path, "[[0,0],[4,0],[4,3],[0,3]]").expect("a file");
    let mut window = watched();
    let before = window.session().whole().map(|whole| whole.designs.len());
    window.send(Intent::Open(vec![path.clone()]));
    let seen = drawn(&mut window);
    for words in ["One design", "Add at the end", "Use as target"] {
        assert!(seen.says(words), "{words}: {:?}", seen.words);
    }
    window.send(Intent::InsertDesigns(9, vec![path]));
    window.wait();
    assert!(!drawn(&mut window).says("One design"));
    let after = window.session().whole().map(|whole| whole.designs.len());
    assert_eq!((before, after), (Some(2), Some(3)));
}
