//! Tests of opening, dropping, replacing, saving and closing files: the result on the stage,
//! questions about unsaved changes, and errors. Also changes of settings during a build, cancelling
//! a build, and settings outside the ranges of their sliders.

use std::path::Path;

use crate::headless_window::{HeadlessWindow, gallery_names};
use bevy::input::ButtonState;
use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{Entity, With};
use bevy::window::{FileDragAndDrop, WindowCloseRequested};
use morphospace::app::testing::{
    DialogPurpose, DroppedDesign, FileDialogRequest, Intent, Invitation, MapView, NoticeTopic,
    Notices, OnStage, StoredRecentFiles, UnsavedAnswer, UnsavedQuestion,
};
use morphospace::content::Content;
use morphospace::stage::{Blend, StageTransition};

#[test]
fn an_opened_project_is_on_the_stage_at_t() {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::Seek(0.25));
    let world = window.0.world_mut();
    let mut staged = world.query_filtered::<(&StageTransition, &Blend), With<OnStage>>();
    let (_, blend) = staged.single(world).expect("one entity on the stage");
    assert_eq!(blend.t, 0.25);
}

#[test]
fn every_gallery_project_opens() {
    let mut window = HeadlessWindow::new();
    for name in gallery_names()
        .into_iter()
        .filter(|name| !name.contains("stress"))
    {
        window.send(Intent::OpenGallery(name.clone()));
        window.wait();
        assert_eq!(window.session().gallery_name(), Some(name.as_str()));
        assert!(
            window.session().transition().is_some(),
            "{name}: {:?}",
            window.problems()
        );
    }
}

#[test]
fn two_designs_opened_together_play_at_once_and_projects_do_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, points: &str| {
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\"><path d=\"M{points}z\"/></svg>"
        );
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path
    };
    let [a, b] = [
        file("a.svg", "0,0 9,0 9,3 0,3"),
        file("b.svg", "0,0 3,0 3,9 0,9"),
    ];
    let mut window = HeadlessWindow::new();
    window.send(Intent::OpenAlone(a.clone()));
    window.wait();
    assert!(!window.playback().is_playing(), "there is nothing to see");
    window.send(Intent::Open(vec![a, b]));
    window.wait();
    assert!(window.playback().is_playing());
    window.send(Intent::TogglePlay);
    assert!(!window.playback().is_playing(), "a pause is not overridden");
    window.send(Intent::OpenGallery(gallery_names()[0].clone()));
    window.wait();
    assert!(!window.playback().is_playing());
}

#[test]
fn a_missing_project_is_reported_and_the_open_project_stays() {
    let mut window = HeadlessWindow::with_gallery();
    let title = window.session().title();
    window.send(Intent::Open(vec!["/nowhere/at-all.morph".into()]));
    window.wait();
    assert!(
        window.problems()[0].contains("at-all.morph"),
        "{:?}",
        window.problems()
    );
    assert_eq!(window.session().title(), title);
    assert!(window.session().transition().is_some());
}

#[test]
fn a_replacement_that_cannot_be_read_leaves_the_project_unchanged() {
    let mut window = HeadlessWindow::with_gallery();
    let before = window.session().project().cloned();
    window.send(Intent::ReplaceDesign(1, "/nowhere/at-all.svg".into()));
    window.wait();
    assert!(!window.problems().is_empty());
    assert_eq!(window.session().project().cloned(), before);
}

#[test]
fn closing_asks_about_unsaved_changes_until_they_are_discarded() {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    assert!(window.session().is_dirty());
    let request = WindowCloseRequested {
        window: Entity::PLACEHOLDER,
    };
    window.0.world_mut().write_message(request.clone());
    window.update();
    window.update();
    assert!(
        window
            .0
            .world()
            .resource::<UnsavedQuestion>()
            .text()
            .is_some()
    );
    assert!(window.0.should_exit().is_none());
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Cancel));
    assert!(
        window
            .0
            .world()
            .resource::<UnsavedQuestion>()
            .text()
            .is_none()
    );
    assert!(window.session().is_dirty());
    window.0.world_mut().write_message(request);
    window.update();
    window.update();
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Discard));
    window.update();
    assert!(window.0.should_exit().is_some());
}

#[test]
fn opening_another_project_asks_about_unsaved_changes() {
    let mut window = HeadlessWindow::with_gallery();
    let title = window.session().title();
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    let other = gallery_names().pop().expect("a gallery");
    window.send(Intent::OpenGallery(other));
    window.wait();
    assert_eq!(window.session().title(), title);
    assert!(
        window
            .0
            .world()
            .resource::<UnsavedQuestion>()
            .text()
            .is_some()
    );
}

#[test]
fn a_value_beyond_the_range_of_its_slider_is_not_changed() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = "version = 1\nwarp = \"arap\"\ncontent = \"solid\"\n".to_owned();
    for (name, x) in [("a.json", 0), ("b.json", 2)] {
        let polygon = format!("{{\"polygons\": [[[[0, 0], [4, 0], [{x}, 3]]]]}}");
        std::fs::write(folder.path().join(name), polygon).expect("room");
        document.push_str(&format!("[[designs]]\npath = \"{name}\"\n"));
    }
    document.push_str("[arap]\nsubdivisions = 5\n");
    let path = folder.path().join("fine.morph");
    std::fs::write(&path, document).expect("room");
    let mut window = HeadlessWindow::with_panels();
    window.send(Intent::Open(vec![path]));
    window.wait();
    (0..3).for_each(|_| window.update());
    let project = window.session().project().expect("a project");
    assert_eq!(project.options.arap.subdivisions, 5);
    assert!(!window.session().is_dirty());
}

#[test]
fn a_saved_project_is_opened_unchanged() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("saved.morph");
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::Seek(0.3));
    window.send(Intent::AddStop);
    window.send(Intent::SaveTo(path.clone()));
    assert!(!window.session().is_dirty());
    assert_eq!(window.session().path(), Some(Path::new(&path)));
    let stops = window.session().stops().to_vec();
    let mut reopened = HeadlessWindow::new();
    reopened.send(Intent::Open(vec![path]));
    reopened.wait();
    assert_eq!(reopened.problems(), Vec::<String>::new());
    assert_eq!(reopened.session().stops(), stops);
    assert!(reopened.session().transition().is_some());
}

#[test]
fn settings_changed_during_a_build_are_built_afterwards() {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::NextMethod);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.arap.subdivisions = 1;
    project.options.field.cells = 96;
    window.send(Intent::ReplaceSettings(Box::new(project.clone())));
    window.wait();
    window.wait();
    assert_eq!(window.session().project(), Some(&project));
    let transition = window.session().transition().expect("a transition");
    let shown = (
        Some(transition.method().warp()),
        Some(transition.method().content()),
    );
    assert_eq!(shown, (project.warp, project.content));
}

#[test]
fn parts_that_carry_fields_have_their_own_rotations() {
    let mut window = HeadlessWindow::new();
    window.send(Intent::OpenGallery("letters-carried".to_owned()));
    window.wait();
    let transition = window.session().transition().expect("a transition");
    assert!(matches!(transition.content(), Content::Field(_)));
    assert!(
        window.session().parts() > 0,
        "the panel lists the parts' rotations"
    );
}

#[test]
fn cancelling_a_build_restores_the_previous_settings() {
    let mut window = HeadlessWindow::with_gallery();
    let before = window.session().project().cloned();
    window.send(Intent::NextMethod);
    window.send(Intent::CancelWork);
    if window.session().work().is_none() {
        window.wait();
    }
    let after = window.session().project().cloned();
    let transition = window.session().transition().expect("a transition");
    let shown = (
        Some(transition.method().warp()),
        Some(transition.method().content()),
    );
    assert_eq!(
        after.as_ref().map(|p| (p.warp, p.content)),
        Some(shown),
        "stage and settings agree"
    );
    assert!(after == before || window.session().is_dirty());
}

/// Drops files on the window and waits until the builds that this starts have ended.
fn drop_files(window: &mut HeadlessWindow, paths: &[&Path]) {
    for path in paths {
        window
            .0
            .world_mut()
            .write_message(FileDragAndDrop::DroppedFile {
                window: Entity::PLACEHOLDER,
                path_buf: path.to_path_buf(),
            });
    }
    for _ in 0..20 {
        window.update();
    }
    window.wait();
}

/// Writes an SVG file with a square and returns the path of the file.
fn write_square(folder: &Path, name: &str, side: u32) -> std::path::PathBuf {
    let path = folder.join(name);
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><rect width="{side}" height="{side}"/></svg>"#
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

#[test]
fn two_dropped_files_become_a_pair_and_a_single_one_asks() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = write_square(folder.path(), "small.svg", 30);
    let large = write_square(folder.path(), "large.svg", 80);
    let mut window = HeadlessWindow::with_gallery();
    drop_files(&mut window, &[&small, &large]);
    assert_eq!(window.problems(), Vec::<String>::new());
    let names = |window: &HeadlessWindow| {
        let designs = window.session().transition().map(|t| t.designs().clone());
        designs.map(|[a, b]| [a.name.clone(), b.name.clone()])
    };
    assert_eq!(
        names(&window),
        Some(["small".to_owned(), "large".to_owned()])
    );
    drop_files(&mut window, &[&small]);
    assert_eq!(
        names(&window),
        Some(["small".to_owned(), "large".to_owned()]),
        "it asks before replacing a design"
    );
    window.send(Intent::ReplaceDesign(1, small));
    window.wait();
    assert_eq!(
        names(&window),
        Some(["small".to_owned(), "small".to_owned()])
    );
    assert!(window.session().is_dirty());
}

/// The single design about which the window asks; `None` if it does not ask.
fn undecided_design(window: &HeadlessWindow) -> Option<&Path> {
    window.0.world().resource::<DroppedDesign>().undecided()
}

#[test]
fn a_single_design_asks_for_the_second_whether_it_is_dropped_or_chosen_in_the_dialog() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = write_square(folder.path(), "small.svg", 30);
    let large = write_square(folder.path(), "large.svg", 80);
    let choose = |window: &mut HeadlessWindow, file: &Path| {
        window.send(Intent::AskOpen);
        window.send(Intent::AnswerDialog(vec![file.to_owned()]));
        (0..5).for_each(|_| window.update());
    };
    let is_chosen = |window: &mut HeadlessWindow| choose(window, &small);
    let is_dropped = |window: &mut HeadlessWindow| drop_files(window, &[&small]);
    let ways: [&dyn Fn(&mut HeadlessWindow); 2] = [&is_chosen, &is_dropped];
    for open in ways {
        for mut window in [HeadlessWindow::new(), HeadlessWindow::with_gallery()] {
            open(&mut window);
            assert_eq!(undecided_design(&window), Some(small.as_path()));
            window.send(Intent::Escape);
            assert_eq!(undecided_design(&window), None, "Esc cancels");
            open(&mut window);
            window.send(Intent::AskSecond(small.clone()));
            let dialog = window.0.world().resource::<FileDialogRequest>();
            assert_eq!(
                dialog.purpose(),
                Some(&DialogPurpose::Second(small.clone()))
            );
            assert_eq!(
                dialog.folder(),
                Some(folder.path()),
                "it starts next to the first"
            );
            assert_eq!(undecided_design(&window), None);
            window.send(Intent::AnswerDialog(vec![large.clone()]));
            (0..5).for_each(|_| window.update());
            window.wait();
            assert_eq!(window.session().names_along_path(), ["small", "large"]);
        }
    }
}

#[test]
fn a_project_dropped_with_other_files_is_refused() {
    let mut window = HeadlessWindow::with_gallery();
    let nowhere = Path::new("/nowhere/a.svg");
    drop_files(
        &mut window,
        &[nowhere, nowhere, Path::new("/nowhere/a.morph")],
    );
    assert_eq!(window.problems().len(), 1);
}

/// Presses a letter with Control.
fn press_with_control(window: &mut HeadlessWindow, code: KeyCode, key: &str) {
    window.hold(KeyCode::ControlLeft, Key::Control, |window| {
        window.type_char(code, key);
    });
    window.update();
}

#[test]
fn ctrl_n_closes_the_project_and_asks_about_unsaved_changes() {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::ToggleMap);
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    press_with_control(&mut window, KeyCode::KeyN, "n");
    let question = |window: &HeadlessWindow| {
        let question = window.0.world().resource::<UnsavedQuestion>();
        question.text().map(str::to_owned)
    };
    assert!(question(&window).is_some() && window.session().project().is_some());
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Discard));
    (0..3).for_each(|_| window.update());
    assert!(question(&window).is_none());
    assert!(window.session().project().is_none() && !window.session().can_undo());
    assert!(window.0.world().resource::<Invitation>().is_shown());
    assert!(!window.0.world().resource::<MapView>().is_shown);
    assert_eq!(window.t(), 0.0);
    let world = window.0.world_mut();
    let mut staged = world.query_filtered::<(), With<OnStage>>();
    assert_eq!(staged.iter(world).count(), 0, "the stage is empty");
    window.send(Intent::OpenGallery(gallery_names().remove(0)));
    window.wait();
    assert!(window.session().transition().is_some());
}

#[test]
fn ctrl_q_quits_and_asks_about_unsaved_changes() {
    let mut window = HeadlessWindow::with_gallery();
    window.send(Intent::Seek(0.123));
    window.send(Intent::AddStop);
    press_with_control(&mut window, KeyCode::KeyQ, "q");
    assert!(window.0.should_exit().is_none());
    window.send(Intent::AnswerUnsaved(UnsavedAnswer::Discard));
    window.update();
    assert!(window.0.should_exit().is_some());
    let mut unchanged = HeadlessWindow::with_gallery();
    unchanged.hold(KeyCode::ControlLeft, Key::Control, |window| {
        let q = Key::Character("q".into());
        window.key(ButtonState::Pressed, KeyCode::KeyQ, q, false);
        assert!(window.0.should_exit().is_some());
    });
}

#[test]
fn the_title_follows_the_designs() {
    let folder = tempfile::tempdir().expect("a folder");
    let small = write_square(folder.path(), "small.svg", 30);
    let large = write_square(folder.path(), "large.svg", 80);
    let mut window = HeadlessWindow::with_gallery();
    let given = window.session().title();
    window.send(Intent::ReplaceDesign(0, small));
    window.send(Intent::ReplaceDesign(1, large));
    window.wait();
    assert_eq!(window.session().title(), "small to large");
    assert_eq!(window.session().file_stem(), "small to large");
    window.send(Intent::Undo);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.session().title(), given);
}

#[test]
fn messages_about_a_project_disappear_with_it() {
    let mut window = HeadlessWindow::with_gallery();
    let mut notices = window.0.world_mut().resource_mut::<Notices>();
    notices.problem(NoticeTopic::Saving, "the project was not saved");
    notices.note("an import note");
    notices.confirm("Saved elsewhere");
    window.send(Intent::OpenGallery(gallery_names()[1].clone()));
    window.wait();
    let notices = window.0.world().resource::<Notices>().list();
    let texts: Vec<&str> = notices.iter().map(|notice| notice.text.as_str()).collect();
    assert!(!texts.contains(&"the project was not saved") && !texts.contains(&"an import note"));
    assert!(texts.contains(&"Saved elsewhere"), "{texts:?}");
}

#[test]
fn recent_files_list_a_pair_and_the_project_made_from_it_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let [a, b, c] = ["a.svg", "b.svg", "c.svg"].map(|name| write_square(folder.path(), name, 50));
    let listed = |window: &HeadlessWindow| -> Vec<String> {
        let recent = window.0.world().resource::<StoredRecentFiles>();
        recent.entries().iter().map(|entry| entry.title()).collect()
    };
    let mut window = HeadlessWindow::new();
    for files in [[&a, &b], [&b, &a], [&a, &c]] {
        window.send(Intent::Open(files.map(Clone::clone).into()));
        window.wait();
    }
    assert_eq!(listed(&window), ["a to c", "b to a"]);
    window.send(Intent::OpenAlone(c));
    window.wait();
    assert_eq!(listed(&window).len(), 2, "a single design is no film");
    window.send(Intent::Open(vec![a, b]));
    window.wait();
    window.send(Intent::SaveTo(folder.path().join("mine.morph")));
    window.update();
    assert_eq!(listed(&window), ["mine", "a to c"]);
}
