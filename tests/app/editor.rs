//! The match editor under the hand.

use std::path::Path;

use crate::window::Window;
use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{ButtonInput, MouseButton, Vec2};
use morphospace::app::{
    EditorAction, EditorHandle, EditorPane, EditorPointer, EditorTool, Intent, PaneView, PieceFate,
};
use morphospace::content::Content;
use morphospace::correspondence::MatchSettings;
use morphospace::geometry::{DVec2, Side};
use morphospace::project::Project;
use morphospace::transition::{EasingFunction, PaintRule, PartTime};

/// An L and the same L stretched, as outlines; and two squares beside each other.
fn write_outline(folder: &Path, name: &str, d: &str) -> std::path::PathBuf {
    let path = folder.join(name);
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><path d="{d}"/></svg>"#
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

const L: &str = "M10 10 H40 V60 H90 V90 H10 Z";
const TALL_L: &str = "M10 5 H30 V70 H80 V95 H10 Z";
const TWO: &str = "M10 10 H40 V40 H10 Z M60 60 H90 V90 H60 Z";

fn with_outlines(folder: &Path, source: &str, target: &str) -> Window {
    let source = write_outline(folder, "source.svg", source);
    let target = write_outline(folder, "target.svg", target);
    let mut window = Window::new();
    window.send(Intent::Open(vec![source, target]));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    window.type_char(KeyCode::KeyE, "e");
    assert!(window.editor().is_open);
    assert!(!window.sheet().rings.is_empty());
    window
}

fn touch(side: Side, x: f64, y: f64) -> EditorPointer {
    EditorPointer {
        side,
        at: DVec2::new(x, y),
        reach: 3.0,
        is_free: false,
    }
}

/// The corner of the source's part that lies nearest to a point of the file.
fn corner(window: &Window, side: Side, near: DVec2) -> DVec2 {
    let sides = window.sheet().sides.as_ref().expect("outlines");
    let corners = sides[side].corners.iter().copied();
    corners
        .min_by(|a, b| a.distance(near).total_cmp(&b.distance(near)))
        .expect("a corner")
}

#[test]
fn meshes_and_trusses_have_no_match_to_edit() {
    let mut window = Window::with_gallery();
    if !window.session().can_match() {
        window.type_char(KeyCode::KeyE, "e");
        assert!(!window.editor().is_open);
    }
}

#[test]
fn the_match_editor_opens_and_escape_leaves_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let shown = window.sheet().features.len();
    assert!((4..=16).contains(&shown), "{shown}");
    window.press(KeyCode::Escape, Key::Escape);
    assert!(!window.editor().is_open);
    assert!(window.preferences().panels);
}

#[test]
fn a_click_on_a_boundary_pins_it_where_it_is_matched() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let at = corner(&window, Side::Source, DVec2::new(100.0, 0.0));
    let place = window.sheet().partner(Side::Source, at).expect("a partner");
    // All features are handles: away from them a click sets a pin.
    let beside = at + DVec2::new(-12.0, 0.0);
    let on = window
        .sheet()
        .on_boundary(Side::Source, beside)
        .expect("a boundary");
    let mut hand = touch(Side::Source, on.point.x, on.point.y);
    hand.reach = 1.0;
    window.act(EditorAction::Click(hand));
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    assert_eq!(window.editor().selected, Some(EditorHandle::Pin(0)));
    let pin = window.sheet().pins[0];
    assert!(pin.source.distance(on.point) < 1e-9);
    assert!(place.is_finite() && pin.target.is_finite());
    assert!(window.session().problem().is_none());
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.matching(), MatchSettings::default());
    assert!(window.sheet().pins.is_empty());
}

#[test]
fn points_keep_their_letters_when_one_is_pinned() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let called = |window: &Window| -> Vec<(usize, DVec2)> {
        let sheet = window.sheet();
        let sources = sheet.features.iter().map(|pair| pair.source);
        sheet.letters.iter().copied().zip(sources).collect()
    };
    let before = called(&window);
    let pinned = before[0].1;
    window.act(EditorAction::Press(touch(Side::Source, pinned.x, pinned.y)));
    let beside = touch(Side::Source, pinned.x + 4.0, pinned.y);
    window.act(EditorAction::Drag(beside, Vec2::new(3.0, 0.0)));
    window.act(EditorAction::Release);
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    let after = called(&window);
    let stayed: Vec<_> = after
        .iter()
        .filter(|(_, p)| before.iter().any(|(_, q)| p.distance(*q) < 0.5))
        .collect();
    // The five corners beside the pin; between them places move with the length of
    // the outline.
    assert!(stayed.len() >= 5, "{before:?} {after:?}");
    for (letter, p) in stayed {
        let nearest = before
            .iter()
            .min_by(|(_, a), (_, b)| p.distance(*a).total_cmp(&p.distance(*b)));
        let nearest = nearest.map(|(letter, _)| letter);
        assert_eq!(nearest, Some(letter), "{p} of {before:?} {after:?}");
    }
}

#[test]
fn a_point_that_is_dragged_becomes_a_pin_that_snaps_and_is_honoured() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let from = window.sheet().features[0];
    let neighbour = |side: Side, p: DVec2| {
        let sides = window.sheet().sides.as_ref().expect("outlines");
        let others = sides[side].corners.iter().copied();
        others
            .filter(|corner| corner.distance(p) > 5.0)
            .min_by(|a, b| a.distance(p).total_cmp(&b.distance(p)))
            .expect("another corner")
    };
    let to = neighbour(Side::Target, from.target);
    let start = touch(Side::Target, from.target.x, from.target.y);
    let step = Vec2::new(3.0, 0.0);
    let before = window.session().project().cloned();
    let mut buttons = window
        .0
        .world_mut()
        .resource_mut::<ButtonInput<MouseButton>>();
    buttons.press(MouseButton::Left);
    window.act(EditorAction::Press(start));
    let halfway = from.target.lerp(to, 0.5);
    window.act(EditorAction::Drag(
        touch(Side::Target, halfway.x, halfway.y),
        step,
    ));
    let near = to + DVec2::new(1.0, 1.0);
    window.act(EditorAction::Drag(
        touch(Side::Target, near.x, near.y),
        step,
    ));
    window.act(EditorAction::Release);
    let mut buttons = window
        .0
        .world_mut()
        .resource_mut::<ButtonInput<MouseButton>>();
    buttons.release(MouseButton::Left);
    window.wait();
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    assert!(window.sheet().pins[0].target.distance(to) < 1e-9, "snapped");
    assert!(window.session().problem().is_none());
    let pin = window.sheet().pins[0];
    let honoured = window.sheet().partner(Side::Source, pin.source);
    assert!(honoured.is_some_and(|p| p.distance(pin.target) < 1e-6));
    window.send(Intent::Undo);
    assert_eq!(window.session().project().cloned(), before, "one step");
    window.wait();
}

#[test]
fn pins_that_cross_are_said_and_the_old_transition_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let places = window.sheet().features.clone();
    let [a, b, c] = [places[0], places[1], places[2]];
    let mut project = window.session().project().cloned().expect("a project");
    let by = window.sheet().by;
    let own = |source: DVec2, target: DVec2| morphospace::correspondence::PointPair {
        source: by[0].inverse().apply(source),
        target: by[1].inverse().apply(target),
    };
    project.options.matching.pins = vec![
        own(a.source, a.target),
        own(b.source, c.target),
        own(c.source, b.target),
    ];
    let stage = window
        .session()
        .transition()
        .map(|t| std::ptr::from_ref(t.content()));
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    let problem = window.session().problem().map(ToString::to_string);
    assert!(
        problem.as_ref().is_some_and(|p| p.contains("pins")),
        "{problem:?}"
    );
    assert!(window.problems().is_empty(), "the editor says it");
    let now = window
        .session()
        .transition()
        .map(|t| std::ptr::from_ref(t.content()));
    assert_eq!(stage, now);
    window.send(Intent::Undo);
    window.wait();
    assert!(window.session().problem().is_none());
}

#[test]
fn delete_and_backspace_take_the_chosen_pin_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    for (code, key) in [
        (KeyCode::Delete, Key::Delete),
        (KeyCode::Backspace, Key::Backspace),
    ] {
        let from = window.sheet().features[0];
        let hand = touch(Side::Source, from.source.x, from.source.y);
        window.act(EditorAction::Press(hand));
        window.act(EditorAction::Drag(hand, Vec2::new(1.0, 0.0)));
        window.act(EditorAction::Release);
        assert_eq!(window.matching().pins.len(), 1);
        window.send(Intent::Faster);
        let speed = window.playback().speed();
        window.press(code, key);
        assert!(window.matching().pins.is_empty());
        assert_eq!(window.playback().speed(), speed, "the key means this only");
    }
    window.wait();
}

#[test]
fn parts_are_paired_by_two_clicks_and_freed_by_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), TWO, TWO);
    let inside = |window: &Window, side: Side, part: usize| {
        let sides = window.sheet().sides.as_ref().expect("outlines");
        let ring = &sides[side].parts[part][0];
        ring.iter().sum::<DVec2>() / ring.len() as f64
    };
    let source = inside(&window, Side::Source, 0);
    let target = inside(&window, Side::Target, 1);
    let other = inside(&window, Side::Target, 0);
    window.act(EditorAction::Click(touch(Side::Source, source.x, source.y)));
    // Nobody has to ask for parts first: within one there is nothing else to click.
    assert_eq!(window.editor().tool, EditorTool::Parts);
    assert!(window.editor().first_part.is_some());
    window.act(EditorAction::Click(touch(Side::Target, target.x, target.y)));
    window.wait();
    assert_eq!(window.matching().links.len(), 1);
    assert!(window.sheet().pieces.iter().any(|piece| piece.is_linked));
    // A part has one partner: the new pair replaces the old one.
    window.act(EditorAction::Click(touch(Side::Target, other.x, other.y)));
    window.act(EditorAction::Click(touch(Side::Source, source.x, source.y)));
    window.wait();
    assert_eq!(window.matching().links.len(), 1);
    window.act(EditorAction::Remove(touch(
        Side::Source,
        source.x,
        source.y,
    )));
    assert!(window.matching().links.is_empty());
    // Two clicks more, the second beside all parts, and it has no partner.
    window.wait();
    window.act(EditorAction::Click(touch(Side::Source, source.x, source.y)));
    window.act(EditorAction::Click(touch(Side::Target, 5000.0, 5000.0)));
    window.wait();
    assert_eq!(window.matching().lone.len(), 1);
    let dies = |window: &Window| {
        let mut pieces = window.sheet().pieces.iter();
        pieces.any(|piece| piece.fate == PieceFate::Dies && piece.is_linked)
    };
    assert!(dies(&window));
    // Its boundary cannot be pinned: there, too, it is taken to be paired.
    let corner = window.sheet().sides.as_ref().expect("outlines")[Side::Source].parts[0][0][0];
    window.act(EditorAction::Tool(EditorTool::Pins));
    window.act(EditorAction::Click(touch(Side::Source, corner.x, corner.y)));
    assert_eq!(window.editor().tool, EditorTool::Parts);
    assert!(window.editor().first_part.is_some() && window.editor().refusal.is_none());
    window.act(EditorAction::Remove(touch(
        Side::Source,
        source.x,
        source.y,
    )));
    window.wait();
    assert!(window.matching().lone.is_empty() && !dies(&window));
    window.wait();
    assert!(window.session().problem().is_none());
}

#[test]
fn of_painted_parts_the_hand_takes_the_one_that_is_seen() {
    let folder = tempfile::tempdir().expect("a folder");
    let written = |name: &str, discs: &str| {
        let path = folder.path().join(name);
        let ground = r#"<rect width="100" height="100" fill="navy"/>"#;
        let svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">{ground}{discs}</svg>"#
        );
        std::fs::write(&path, svg).expect("a file");
        path
    };
    let disc =
        |x: u32, y: u32, fill: &str| format!(r#"<circle cx="{x}" cy="{y}" r="12" fill="{fill}"/>"#);
    let discs = disc(25, 25, "gold") + &disc(75, 75, "teal");
    let files = vec![written("a.svg", &discs), written("b.svg", &discs)];
    let mut window = Window::new();
    window.send(Intent::Open(files));
    window.wait();
    window.type_char(KeyCode::KeyE, "e");
    window.act(EditorAction::Tool(EditorTool::Parts));
    assert_eq!(window.sheet().pieces.len(), 3);
    // Each is named where it is seen.
    for piece in 0..3 {
        let at = window.sheet().pieces[piece].at[0];
        let part = window.sheet().part(Side::Source, at, 0.0);
        assert_eq!(part, window.sheet().pieces[piece].parts[0], "{piece}");
    }
    // Two pairs upon one ground are two links: the gold with the teal and the other way.
    let [gold, teal] = [1, 2].map(|part| {
        let mut pieces = window.sheet().pieces.iter();
        let own = pieces.find(|piece| piece.parts[0] == Some(part));
        own.expect("a disc").at[0]
    });
    for [from, to] in [[gold, teal], [teal, gold]] {
        window.act(EditorAction::Click(touch(Side::Source, from.x, from.y)));
        window.act(EditorAction::Click(touch(Side::Target, to.x, to.y)));
        window.wait();
    }
    assert_eq!(window.matching().links.len(), 2);
    let linked = window.sheet().pieces.iter().filter(|piece| piece.is_linked);
    let linked: Vec<_> = linked.map(|piece| piece.parts).collect();
    assert_eq!(linked.len(), 2, "{linked:?}");
    assert!(linked.contains(&[Some(1), Some(2)]) && linked.contains(&[Some(2), Some(1)]));
    // In one colour there is one part, also before its film is there.
    let mut project = window.session().project().cloned().expect("a project");
    project.options.paint = PaintRule::One;
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    assert_eq!(window.sheet().pieces.len(), 1);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.sheet().pieces.len(), 3);
}

#[test]
fn a_part_is_given_its_own_time_and_keeps_it_with_the_project() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), TWO, TWO);
    let by = window.sheet().by[0];
    let at = by.inverse().apply(window.sheet().pieces[0].at[0]);
    let late = PartTime {
        side: Side::Source,
        at,
        from: 0.5,
        to: 1.0,
        easing: EasingFunction::default(),
    };
    let waiting = |window: &Window| {
        let transition = window.session().transition().expect("a film").clone();
        let Content::Solid(solid) = transition.content() else {
            panic!("rigid parts");
        };
        solid
            .clocks
            .as_ref()
            .map(|clocks| clocks.of_walks.iter().filter(|k| **k == 0).count())
    };
    assert_eq!(waiting(&window), None);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.parts = vec![late];
    window.send(Intent::Edit(Box::new(project.clone())));
    window.wait();
    assert_eq!(waiting(&window), Some(1));
    let again = Project::parse(&project.to_toml().expect("text")).expect("a document");
    assert_eq!(again.options.parts, [late]);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(waiting(&window), None);
}

#[test]
fn a_cut_that_is_dragged_is_asked_for() {
    const RING: &str = "M10 10 H90 V90 H10 Z M35 35 V65 H65 V35 Z";
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), RING, L);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.matching.holes = morphospace::correspondence::HoleRule::Cut;
    window.send(Intent::Edit(Box::new(project)));
    window.wait();
    assert!(window.session().problem().is_none());
    assert_eq!(window.sheet().cuts.len(), 1);
    let found = window.sheet().cuts[0];
    assert_eq!(found.asked, None);
    let at = found.cut.outer;
    window.act(EditorAction::Press(touch(Side::Source, at.x, at.y)));
    let to = at + DVec2::new(2.0, 2.0);
    window.act(EditorAction::Drag(
        touch(Side::Source, to.x, to.y),
        Vec2::ONE,
    ));
    window.act(EditorAction::Release);
    window.wait();
    assert_eq!(window.matching().cuts.len(), 1);
    assert_eq!(window.sheet().cuts[0].asked, Some(0));
    assert!(window.session().problem().is_none());
    window.act(EditorAction::Clear);
    window.wait();
    assert_eq!(window.sheet().cuts[0].asked, None);
}

#[test]
fn another_design_forgets_the_points_of_the_old_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let from = window.sheet().features[0];
    let hand = touch(Side::Source, from.source.x, from.source.y);
    window.act(EditorAction::Press(hand));
    window.act(EditorAction::Drag(hand, Vec2::new(1.0, 0.0)));
    window.act(EditorAction::Release);
    window.wait();
    let other = write_outline(folder.path(), "other.svg", TWO);
    window.send(Intent::ReplaceDesign(1, other));
    window.wait();
    assert!(window.matching().pins.is_empty());
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
}

#[test]
fn the_editor_zooms_to_the_pointer_and_fits_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let at = Vec2::new(40.0, -30.0);
    let (pane, factor) = (EditorPane::Design(Side::Source), 2.0);
    window.act(EditorAction::Zoom { pane, at, factor });
    // What was under the pointer lies there still: at = pan + zoom * p, before and after.
    let view = window.editor().panes.view(pane);
    assert_eq!(view.zoom, 2.0);
    assert!((view.pan + 2.0 * at - at).length() < 1e-4);
    window.send(Intent::FitView);
    assert_eq!(window.editor().panes.view(pane), PaneView::default());
}
