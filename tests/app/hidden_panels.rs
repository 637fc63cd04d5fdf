//! Tests of hidden panels: only the drawing is left, notices wait until the panels are shown again,
//! and the help and questions to the user still appear.

use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{IntoScheduleConfigs, PostUpdate, Query, ResMut, Resource};
use bevy_egui::egui::Shape;
use bevy_egui::{EguiFullOutput, EguiPostUpdateSet};
use morphospace::app::testing::{
    Comparison, Intent, NoticeTopic, Notices, StageMeasures, UnsavedAnswer, UnsavedQuestion,
};

use crate::headless_window::HeadlessWindow;

/// Record of the texts and shapes that egui drew in the last frame.
#[derive(Resource, Default)]
pub struct Overlay {
    texts: Vec<String>,
    /// Number of shapes, including texts.
    pub shape_count: usize,
}

fn record_overlay(outputs: Query<&EguiFullOutput>, mut overlay: ResMut<Overlay>) {
    *overlay = Overlay::default();
    for output in outputs.iter().filter_map(|output| output.0.as_ref()) {
        for clipped in &output.shapes {
            overlay.add(&clipped.shape);
        }
    }
}

impl Overlay {
    fn add(&mut self, shape: &Shape) {
        match shape {
            Shape::Noop => {}
            Shape::Vec(shapes) => shapes.iter().for_each(|shape| self.add(shape)),
            Shape::Text(text) => {
                self.shape_count += 1;
                self.texts.push(text.galley.text().to_owned());
            }
            _ => self.shape_count += 1,
        }
    }

    pub fn has_text(&self, part: &str) -> bool {
        self.texts.iter().any(|text| text.contains(part))
    }
}

/// A window with panels that stores an [`Overlay`] after each frame.
pub fn with_overlay_record() -> HeadlessWindow {
    let mut window = HeadlessWindow::with_panels();
    let record_overlay = record_overlay
        .after(EguiPostUpdateSet::EndPass)
        .before(EguiPostUpdateSet::ProcessOutput);
    window.0.init_resource::<Overlay>();
    window.0.add_systems(PostUpdate, record_overlay);
    window.update();
    window
}

/// Updates until the last input has taken effect, and returns the overlay of the last frame.
pub fn overlay(window: &mut HeadlessWindow) -> &Overlay {
    // A key takes effect in the next frame, and egui hides a new area in the frame in which it
    // measures its size.
    for _ in 0..3 {
        window.update();
    }
    window.0.world().resource()
}

/// Shows the frame times, the comparison, a problem and a confirmation.
fn show_all_messages(window: &mut HeadlessWindow) {
    window.press(KeyCode::F3, Key::F3);
    window.type_char(KeyCode::KeyV, "v");
    let is_ready = |window: &HeadlessWindow| {
        let world = window.0.world();
        world.resource::<StageMeasures>().measures().is_some()
            && world.resource::<Comparison>().transition().is_some()
    };
    while !is_ready(window) {
        std::thread::sleep(std::time::Duration::from_millis(1));
        window.update();
    }
    let mut notices = window.0.world_mut().resource_mut::<Notices>();
    notices.problem(NoticeTopic::Film, "a problem");
    notices.confirm("a confirmation");
}

#[test]
fn hidden_panels_leave_only_the_drawing() {
    let mut window = with_overlay_record();
    show_all_messages(&mut window);
    let shown = overlay(&mut window);
    let expected = ["a problem", "a confirmation", "Total", "Straight lines"];
    for text in expected {
        assert!(shown.has_text(text), "{text}: {:?}", shown.texts);
    }
    window.type_char(KeyCode::KeyH, "h");
    let shown = overlay(&mut window);
    assert_eq!((shown.shape_count, &shown.texts), (0, &Vec::new()));
}

#[test]
fn notices_wait_until_the_panels_are_shown_again() {
    let mut window = with_overlay_record();
    window.type_char(KeyCode::KeyH, "h");
    show_all_messages(&mut window);
    // These frames take 20 s, longer than a confirmation is shown.
    for _ in 0..1000 {
        window.update();
    }
    assert_eq!(overlay(&mut window).shape_count, 0);
    window.type_char(KeyCode::KeyH, "h");
    let shown = overlay(&mut window);
    assert!(shown.has_text("a problem") && shown.has_text("a confirmation"));
}

#[test]
fn help_and_questions_appear_with_hidden_panels() {
    let mut window = with_overlay_record();
    window.type_char(KeyCode::KeyH, "h");
    window.press(KeyCode::F1, Key::F1);
    assert!(overlay(&mut window).has_text("Play or pause"));
    window.press(KeyCode::Escape, Key::Escape);
    assert_eq!(overlay(&mut window).shape_count, 0);
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    window.send(Intent::Close);
    assert!(overlay(&mut window).has_text("Unsaved changes"));
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Cancel));
    assert!(
        window
            .0
            .world()
            .resource::<UnsavedQuestion>()
            .text()
            .is_none()
    );
    assert_eq!(overlay(&mut window).shape_count, 0);
}

#[test]
fn opening_a_single_design_asks_for_the_second_or_for_its_place_in_the_film() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("more.json");
    std::fs::write(&path, "[[0,0],[4,0],[4,3],[0,3]]").expect("a file");
    let mut window = with_overlay_record();
    let before = window
        .session()
        .whole_project()
        .map(|whole| whole.designs.len());
    window.send(Intent::Open(vec![path.clone()]));
    let shown = overlay(&mut window);
    for text in ["One design chosen", "Choose second …", "Add at end"] {
        assert!(shown.has_text(text), "{text}: {:?}", shown.texts);
    }
    window.send(Intent::InsertDesigns(9, vec![path]));
    window.wait();
    assert!(!overlay(&mut window).has_text("One design chosen"));
    let after = window
        .session()
        .whole_project()
        .map(|whole| whole.designs.len());
    assert_eq!((before, after), (Some(2), Some(3)));
}
