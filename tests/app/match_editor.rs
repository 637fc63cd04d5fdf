//! Tests of the match editor: pins, cuts, part pairs and part times set by pointer and keys, and
//! the views of its panes.

use std::path::Path;

use crate::headless_window::HeadlessWindow;
use bevy::input::keyboard::{Key, KeyCode};
use bevy::prelude::{ButtonInput, MouseButton, Mut, Vec2};
use morphospace::app::testing::{
    EditorAction, EditorHandle, EditorPane, EditorPointer, EditorTool, Intent, PaneView, PieceFate,
};
use morphospace::content::Content;
use morphospace::correspondence::MatchSettings;
use morphospace::geometry::{DVec2, Side};
use morphospace::project::Project;
use morphospace::transition::{EasingFunction, PaintRule, PartTime};

/// Writes an SVG file with the path data `d`; returns the path of the file.
fn write_outline(folder: &Path, name: &str, d: &str) -> std::path::PathBuf {
    let path = folder.join(name);
    let svg = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><path d="{d}"/></svg>"#
    );
    std::fs::write(&path, svg).expect("a file");
    path
}

/// SVG path data of an L.
const L: &str = "M10 10 H40 V60 H90 V90 H10 Z";
/// SVG path data of an L that is narrower and taller than [`L`].
const TALL_L: &str = "M10 5 H30 V70 H80 V95 H10 Z";
/// SVG path data of two separate squares.
const TWO_SQUARES: &str = "M10 10 H40 V40 H10 Z M60 60 H90 V90 H60 Z";

/// A window with a transition between two outlines and an open match editor.
fn with_outlines(folder: &Path, source: &str, target: &str) -> HeadlessWindow {
    let source = write_outline(folder, "source.svg", source);
    let target = write_outline(folder, "target.svg", target);
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(vec![source, target]));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    window.type_char(KeyCode::KeyE, "e");
    assert!(window.editor().is_open);
    assert!(!window.sheet().rings.is_empty());
    window
}

/// A pointer over one of the two designs, at a position in the plane of the design.
fn pointer_at(side: Side, x: f64, y: f64) -> EditorPointer {
    EditorPointer {
        side,
        position: DVec2::new(x, y),
        pick_radius: 3.0,
        ignores_snapping: false,
    }
}

/// Performs an action of the pointer at a point of a design, given in the common frame.
fn act_at(
    window: &mut HeadlessWindow,
    action: fn(EditorPointer) -> EditorAction,
    side: Side,
    p: DVec2,
) {
    window.act(action(pointer_at(side, p.x, p.y)));
}

/// The mouse buttons, as the window sees them.
fn mouse_buttons(window: &mut HeadlessWindow) -> Mut<'_, ButtonInput<MouseButton>> {
    window.0.world_mut().resource_mut()
}

/// The corner of the design on `side` that is nearest to the point `near`.
fn corner(window: &HeadlessWindow, side: Side, near: DVec2) -> DVec2 {
    let sides = window.sheet().sides.as_ref().expect("outlines");
    let corners = sides[side].corners.iter().copied();
    corners
        .min_by(|a, b| a.distance(near).total_cmp(&b.distance(near)))
        .expect("a corner")
}

#[test]
fn meshes_and_trusses_have_no_match_to_edit() {
    let mut window = HeadlessWindow::with_gallery();
    if !window.session().has_match_editor() {
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
fn a_click_on_a_boundary_pins_it_to_its_match() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let at = corner(&window, Side::Source, DVec2::new(100.0, 0.0));
    let partner = window
        .sheet()
        .matched_point(Side::Source, at)
        .expect("a partner");
    // A click on a handle selects the handle; only a click away from handles sets a pin.
    let away_from_handles = at + DVec2::new(-12.0, 0.0);
    let on = window
        .sheet()
        .nearest_boundary_point(Side::Source, away_from_handles)
        .expect("a boundary");
    let mut pointer = pointer_at(Side::Source, on.point.x, on.point.y);
    pointer.pick_radius = 1.0;
    window.act(EditorAction::Click(pointer));
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    assert_eq!(window.editor().selected, Some(EditorHandle::Pin(0)));
    let pin = window.sheet().pins[0];
    assert!(pin.source.distance(on.point) < 1e-9);
    assert!(partner.is_finite() && pin.target.is_finite());
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
    let labelled_points = |window: &HeadlessWindow| -> Vec<(usize, DVec2)> {
        let sheet = window.sheet();
        let sources = sheet.features.iter().map(|pair| pair.source);
        sheet.letters.iter().copied().zip(sources).collect()
    };
    let before = labelled_points(&window);
    let pinned = before[0].1;
    act_at(&mut window, EditorAction::Press, Side::Source, pinned);
    let moved_pointer = pointer_at(Side::Source, pinned.x + 4.0, pinned.y);
    window.act(EditorAction::Drag(moved_pointer, Vec2::new(3.0, 0.0)));
    window.act(EditorAction::Release);
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    let after = labelled_points(&window);
    let unmoved: Vec<_> = after
        .iter()
        .filter(|(_, p)| before.iter().any(|(_, q)| p.distance(*q) < 0.5))
        .collect();
    // At least the five other corners of the L are still labelled. Labelled points between
    // corners may move when the match changes.
    assert!(unmoved.len() >= 5, "{before:?} {after:?}");
    for (letter, p) in unmoved {
        let nearest = before
            .iter()
            .min_by(|(_, a), (_, b)| p.distance(*a).total_cmp(&p.distance(*b)));
        let nearest = nearest.map(|(letter, _)| letter);
        assert_eq!(nearest, Some(letter), "{p} of {before:?} {after:?}");
    }
}

#[test]
fn a_dragged_point_becomes_a_pin_that_snaps_to_a_corner() {
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
    let start = pointer_at(Side::Target, from.target.x, from.target.y);
    let step = Vec2::new(3.0, 0.0);
    let before = window.session().project().cloned();
    mouse_buttons(&mut window).press(MouseButton::Left);
    window.act(EditorAction::Press(start));
    let halfway = from.target.lerp(to, 0.5);
    window.act(EditorAction::Drag(
        pointer_at(Side::Target, halfway.x, halfway.y),
        step,
    ));
    let near = to + DVec2::new(1.0, 1.0);
    window.act(EditorAction::Drag(
        pointer_at(Side::Target, near.x, near.y),
        step,
    ));
    window.act(EditorAction::Release);
    mouse_buttons(&mut window).release(MouseButton::Left);
    window.wait();
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
    assert!(window.sheet().pins[0].target.distance(to) < 1e-9, "snapped");
    assert!(window.session().problem().is_none());
    let pin = window.sheet().pins[0];
    let honoured = window.sheet().matched_point(Side::Source, pin.source);
    assert!(honoured.is_some_and(|p| p.distance(pin.target) < 1e-6));
    window.send(Intent::Undo);
    assert_eq!(
        window.session().project().cloned(),
        before,
        "a drag is one undo step"
    );
    window.wait();
}

#[test]
fn crossing_pins_are_reported_and_the_old_transition_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let points = window.sheet().features.clone();
    let [a, b, c] = [points[0], points[1], points[2]];
    let mut project = window.session().project().cloned().expect("a project");
    let placements = window.sheet().frame_from_design;
    let pin = |source: DVec2, target: DVec2| morphospace::correspondence::PointPair {
        source: placements[0].inverse().apply(source),
        target: placements[1].inverse().apply(target),
    };
    project.options.matching.pins = vec![
        pin(a.source, a.target),
        pin(b.source, c.target),
        pin(c.source, b.target),
    ];
    let content_before = window
        .session()
        .transition()
        .map(|t| std::ptr::from_ref(t.content()));
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
    let problem = window.session().problem().map(ToString::to_string);
    assert!(
        problem.as_ref().is_some_and(|p| p.contains("pins")),
        "{problem:?}"
    );
    assert!(
        window.problems().is_empty(),
        "the editor shows the problem itself"
    );
    let content_after = window
        .session()
        .transition()
        .map(|t| std::ptr::from_ref(t.content()));
    assert_eq!(content_before, content_after);
    window.send(Intent::Undo);
    window.wait();
    assert!(window.session().problem().is_none());
}

#[test]
fn delete_and_backspace_remove_the_selected_pin() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    for (code, key) in [
        (KeyCode::Delete, Key::Delete),
        (KeyCode::Backspace, Key::Backspace),
    ] {
        let from = window.sheet().features[0];
        let pointer = pointer_at(Side::Source, from.source.x, from.source.y);
        window.act(EditorAction::Press(pointer));
        window.act(EditorAction::Drag(pointer, Vec2::new(1.0, 0.0)));
        window.act(EditorAction::Release);
        assert_eq!(window.matching().pins.len(), 1);
        window.send(Intent::Faster);
        let speed = window.playback().speed();
        window.press(code, key);
        assert!(window.matching().pins.is_empty());
        assert_eq!(
            window.playback().speed(),
            speed,
            "the key does not also change the speed"
        );
    }
    window.wait();
}

#[test]
fn two_clicks_pair_parts_and_remove_unpairs_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), TWO_SQUARES, TWO_SQUARES);
    let centre = |window: &HeadlessWindow, side: Side, part: usize| {
        let sides = window.sheet().sides.as_ref().expect("outlines");
        let ring = &sides[side].parts[part][0];
        ring.iter().sum::<DVec2>() / ring.len() as f64
    };
    let source = centre(&window, Side::Source, 0);
    let target = centre(&window, Side::Target, 1);
    let other = centre(&window, Side::Target, 0);
    act_at(&mut window, EditorAction::Click, Side::Source, source);
    // A click inside a part switches to the part tool, since no other tool acts there.
    assert_eq!(window.editor().tool, EditorTool::Parts);
    assert!(window.editor().first_part.is_some());
    act_at(&mut window, EditorAction::Click, Side::Target, target);
    window.wait();
    assert_eq!(window.matching().links.len(), 1);
    assert!(window.sheet().pieces.iter().any(|piece| piece.is_linked));
    // A part has at most one partner: the new pair replaces the old one.
    act_at(&mut window, EditorAction::Click, Side::Target, other);
    act_at(&mut window, EditorAction::Click, Side::Source, source);
    window.wait();
    assert_eq!(window.matching().links.len(), 1);
    act_at(&mut window, EditorAction::Remove, Side::Source, source);
    assert!(window.matching().links.is_empty());
    // A click on a part and then on empty space of the other design leaves the part without a
    // partner, so that it disappears during the film.
    window.wait();
    act_at(&mut window, EditorAction::Click, Side::Source, source);
    window.act(EditorAction::Click(pointer_at(
        Side::Target,
        5000.0,
        5000.0,
    )));
    window.wait();
    assert_eq!(window.matching().lone.len(), 1);
    let disappears = |window: &HeadlessWindow| {
        let mut pieces = window.sheet().pieces.iter();
        pieces.any(|piece| piece.fate == PieceFate::Disappears && piece.is_linked)
    };
    assert!(disappears(&window));
    // The boundary of an unmatched part cannot be pinned; a click there selects the part.
    let corner = window.sheet().sides.as_ref().expect("outlines")[Side::Source].parts[0][0][0];
    window.act(EditorAction::SelectTool(EditorTool::Pins));
    act_at(&mut window, EditorAction::Click, Side::Source, corner);
    assert_eq!(window.editor().tool, EditorTool::Parts);
    assert!(window.editor().first_part.is_some() && window.editor().refusal.is_none());
    act_at(&mut window, EditorAction::Remove, Side::Source, source);
    window.wait();
    assert!(window.matching().lone.is_empty() && !disappears(&window));
    window.wait();
    assert!(window.session().problem().is_none());
}

#[test]
fn a_click_on_painted_parts_selects_the_visible_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawing = |name: &str, discs: &str| {
        let path = folder.path().join(name);
        let background = r#"<rect width="100" height="100" fill="navy"/>"#;
        let svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">{background}{discs}</svg>"#
        );
        std::fs::write(&path, svg).expect("a file");
        path
    };
    let disc =
        |x: u32, y: u32, fill: &str| format!(r#"<circle cx="{x}" cy="{y}" r="12" fill="{fill}"/>"#);
    let discs = disc(25, 25, "gold") + &disc(75, 75, "teal");
    let files = vec![drawing("a.svg", &discs), drawing("b.svg", &discs)];
    let mut window = HeadlessWindow::new();
    window.send(Intent::Open(files));
    window.wait();
    window.type_char(KeyCode::KeyE, "e");
    window.act(EditorAction::SelectTool(EditorTool::Parts));
    assert_eq!(window.sheet().pieces.len(), 3);
    // The label of each part lies where no other part covers it.
    for piece in 0..3 {
        let at = window.sheet().pieces[piece].label_at[0];
        let part = window.sheet().part_at(Side::Source, at, 0.0);
        assert_eq!(part, window.sheet().pieces[piece].parts[0], "{piece}");
    }
    // Pair the gold disc of the source with the teal one of the target, then teal with gold.
    let [gold, teal] = [1, 2].map(|part| {
        let mut pieces = window.sheet().pieces.iter();
        let of_disc = pieces.find(|piece| piece.parts[0] == Some(part));
        of_disc.expect("a disc").label_at[0]
    });
    for [from, to] in [[gold, teal], [teal, gold]] {
        act_at(&mut window, EditorAction::Click, Side::Source, from);
        act_at(&mut window, EditorAction::Click, Side::Target, to);
        window.wait();
    }
    assert_eq!(window.matching().links.len(), 2);
    let linked_pieces = window.sheet().pieces.iter().filter(|piece| piece.is_linked);
    let linked: Vec<_> = linked_pieces.map(|piece| piece.parts).collect();
    assert_eq!(linked.len(), 2, "{linked:?}");
    assert!(linked.contains(&[Some(1), Some(2)]) && linked.contains(&[Some(2), Some(1)]));
    // If all shapes are painted in one colour, the background and the discs are one part.
    let mut project = window.session().project().cloned().expect("a project");
    project.options.paint = PaintRule::One;
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
    assert_eq!(window.problems(), Vec::<String>::new());
    assert_eq!(window.sheet().pieces.len(), 1);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.sheet().pieces.len(), 3);
}

#[test]
fn the_time_of_a_part_is_applied_saved_and_undone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), TWO_SQUARES, TWO_SQUARES);
    let placement = window.sheet().frame_from_design[0];
    let at = placement
        .inverse()
        .apply(window.sheet().pieces[0].label_at[0]);
    let late = PartTime {
        side: Side::Source,
        at,
        from: 0.5,
        to: 1.0,
        easing: EasingFunction::default(),
    };
    let delayed_loops = |window: &HeadlessWindow| {
        let transition = window.session().transition().expect("a film").clone();
        let Content::Solid(solid) = transition.content() else {
            panic!("rigid parts");
        };
        solid
            .part_clocks
            .as_ref()
            .map(|clocks| clocks.of_loops.iter().filter(|k| **k == 0).count())
    };
    assert_eq!(delayed_loops(&window), None);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.parts = vec![late];
    window.send(Intent::ReplaceSettings(Box::new(project.clone())));
    window.wait();
    assert_eq!(delayed_loops(&window), Some(1));
    let parsed = Project::parse(&project.to_toml().expect("text")).expect("a document");
    assert_eq!(parsed.options.parts, [late]);
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(delayed_loops(&window), None);
}

#[test]
fn dragging_an_automatic_cut_makes_it_a_requested_one() {
    const RING: &str = "M10 10 H90 V90 H10 Z M35 35 V65 H65 V35 Z";
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), RING, L);
    let mut project = window.session().project().cloned().expect("a project");
    project.options.matching.holes = morphospace::correspondence::HoleRule::Cut;
    window.send(Intent::ReplaceSettings(Box::new(project)));
    window.wait();
    assert!(window.session().problem().is_none());
    assert_eq!(window.sheet().cuts.len(), 1);
    let automatic = window.sheet().cuts[0];
    assert_eq!(automatic.requested_index, None);
    let at = automatic.cut.outer;
    act_at(&mut window, EditorAction::Press, Side::Source, at);
    let to = at + DVec2::new(2.0, 2.0);
    window.act(EditorAction::Drag(
        pointer_at(Side::Source, to.x, to.y),
        Vec2::ONE,
    ));
    window.act(EditorAction::Release);
    window.wait();
    assert_eq!(window.matching().cuts.len(), 1);
    assert_eq!(window.sheet().cuts[0].requested_index, Some(0));
    assert!(window.session().problem().is_none());
    window.act(EditorAction::Clear);
    window.wait();
    assert_eq!(window.sheet().cuts[0].requested_index, None);
}

#[test]
fn replacing_a_design_removes_its_pins() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let from = window.sheet().features[0];
    let pointer = pointer_at(Side::Source, from.source.x, from.source.y);
    window.act(EditorAction::Press(pointer));
    window.act(EditorAction::Drag(pointer, Vec2::new(1.0, 0.0)));
    window.act(EditorAction::Release);
    window.wait();
    let other = write_outline(folder.path(), "other.svg", TWO_SQUARES);
    window.send(Intent::ReplaceDesign(1, other));
    window.wait();
    assert!(window.matching().pins.is_empty());
    window.send(Intent::Undo);
    window.wait();
    assert_eq!(window.matching().pins.len(), 1);
}

#[test]
fn the_editor_zooms_at_the_pointer_and_fits_the_view() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = with_outlines(folder.path(), L, TALL_L);
    let at = Vec2::new(40.0, -30.0);
    let (pane, factor) = (EditorPane::Design(Side::Source), 2.0);
    window.act(EditorAction::Zoom { pane, at, factor });
    // Zooming keeps the point under the pointer in place. Before, with pan 0 and zoom 1, that point
    // was at `at`; now it is at pan + zoom · at, which must be the same.
    let view = window.editor().panes.view(pane);
    assert_eq!(view.zoom, 2.0);
    assert!((view.pan + 2.0 * at - at).length() < 1e-4);
    window.send(Intent::FitView);
    assert_eq!(window.editor().panes.view(pane), PaneView::default());
}
