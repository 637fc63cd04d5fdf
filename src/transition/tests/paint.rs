//! Tests of transitions of drawings in their own colours.

use super::*;
use crate::colour::{Paint, Rgb};
use crate::content::Content;

const RED: Rgb = Rgb([255, 0, 0]);
const BLUE: Rgb = Rgb([0, 0, 255]);

fn drawing(body: &str) -> Arc<Design> {
    design(&format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>"
    ))
}

fn square(x: f64, y: f64, size: f64, fill: Rgb) -> String {
    format!("<rect x='{x}' y='{y}' width='{size}' height='{size}' fill='{fill}'/>")
}

fn transition(source: &Arc<Design>, target: &Arc<Design>) -> Transition {
    let spec = TransitionSpec::new(Arc::clone(source), Arc::clone(target));
    Transition::build(&spec, &Silent).unwrap()
}

fn transition_of(source: &str, target: &str) -> Transition {
    transition(&drawing(source), &drawing(target))
}

/// Returns paint and area of the visible layers at `t`, the lowest first.
fn visible_layers(transition: &Transition, t: f64) -> Vec<(Paint, f64)> {
    let figure = transition.frame(t).figure();
    let style = TransitionStyle::default();
    let layers = figure.layers.iter().map(|layer| {
        let rings = &figure.rings[layer.rings.clone()];
        (style.paint_at(layer.paints, t), area(rings))
    });
    layers.filter(|(_, area)| *area > 1e-3).collect()
}

fn assert_same(found: &[(Paint, f64)], expected: &[(Paint, f64)]) {
    let paints =
        |visible_layers: &[(Paint, f64)]| visible_layers.iter().map(|s| s.0).collect::<Vec<_>>();
    assert_eq!(paints(found), paints(expected));
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found.1 - expected.1).abs() < 1e-3,
            "{found:?} {expected:?}"
        );
    }
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn the_ends_are_the_drawings_and_exchanging_them_reverses_the_motion() {
    let a = drawing(&format!(
        "{}{}<circle cx='50' cy='50' r='9' fill='#abcdef' fill-opacity='0.5'/>",
        square(10.0, 10.0, 80.0, BLUE),
        square(20.0, 20.0, 30.0, RED)
    ));
    let b = drawing(&format!(
        "<circle cx='50' cy='50' r='45' fill='teal'/>{}",
        square(60.0, 60.0, 20.0, RED)
    ));
    let (there, back) = (transition(&a, &b), transition(&b, &a));
    for (design, t) in [(&a, 0.0), (&b, 1.0)] {
        let layers = design.paint_layers.iter();
        let expected = layers.map(|layer| (layer.paint.unwrap(), layer.regions.area()));
        assert_same(&visible_layers(&there, t), &expected.collect::<Vec<_>>());
    }
    for k in 0..=8 {
        let t = f64::from(k) / 8.0;
        // At t = ½, each direction already shows the stacking order of its own target, so the two
        // differ.
        if k != 4 {
            assert_same(&visible_layers(&there, t), &visible_layers(&back, 1.0 - t));
        }
    }
}

#[test]
fn paint_outweighs_position_when_parts_are_paired() {
    let frame = "<path d='M0 0h2v2h-2zM98 98h2v2h-2z' fill='black'/>";
    let pair = |left: Rgb, right: Rgb| {
        let [left, right] = [(40.0, left), (52.0, right)].map(|(x, c)| square(x, 45.0, 8.0, c));
        drawing(&format!("{frame}{left}{right}"))
    };
    let crossed = transition(&pair(RED, BLUE), &pair(BLUE, RED));
    let Content::Solid(solid) = crossed.content() else {
        panic!("a film of solids");
    };
    for layer in &solid.paint_layers.as_ref().unwrap().layers {
        assert_eq!(layer.paints[0], layer.paints[1]);
    }
    // Parts on different layers may cross.
    let frame = crossed.frame(0.4);
    let places = &frame.placement().in_frame;
    assert!(count_crossings(&frame.figure().rings) > 0);
    assert_eq!(solid.count_crossings(places, 0.4), 0);
    assert!(solid.crossings_at(places, 0.4).is_empty());
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn equal_names_pair_parts() {
    let named = |x: f64, y: f64, fill: Rgb, id: &str| {
        square(x, y, 10.0, fill).replace("<rect", &format!("<rect id='{id}'"))
    };
    let a = named(0.0, 0.0, RED, "cat") + &named(90.0, 90.0, BLUE, "dog");
    let b = named(0.0, 0.0, RED, "dog") + &named(90.0, 90.0, BLUE, "cat");
    let transition = transition_of(&a, &b);
    let pieces = &transition.matched().unwrap().pieces;
    let moved = |k: usize| pieces[k].rings[0].source[0].distance(pieces[k].rings[0].target[0]);
    assert!((0..2).all(|k| moved(k) > 50.0));
    // Automatic names with numbers do not pair parts.
    let counted = |body: &str| body.replace("cat", "path7").replace("dog", "rect3");
    let transition = transition_of(&counted(&a), &counted(&b));
    let pieces = &transition.matched().unwrap().pieces;
    assert_eq!(pieces[0].rings[0].source, pieces[0].rings[0].target);
}

#[test]
fn the_stacking_order_changes_in_the_middle() {
    let over = |below: Rgb, above: Rgb| {
        let sizes = [(RED, 40.0), (BLUE, 30.0)];
        let size = |fill: Rgb| sizes.iter().find(|s| s.0 == fill).unwrap().1;
        let one = |fill: Rgb| square(50.0 - size(fill) / 2.0, 20.0, size(fill), fill);
        drawing(&(one(below) + &one(above)))
    };
    let transition = transition(&over(RED, BLUE), &over(BLUE, RED));
    let order = |t: f64| {
        let visible_layers = visible_layers(&transition, t).into_iter();
        visible_layers
            .map(|(paint, _)| paint.colour)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        (order(0.0), order(0.49)),
        (vec![RED, BLUE], vec![RED, BLUE])
    );
    assert_eq!((order(0.5), order(1.0)), (vec![BLUE, RED], vec![BLUE, RED]));
}

#[test]
fn boundary_paths_show_drawings_in_their_own_colours() {
    let (red, blue) = (
        square(10.0, 10.0, 40.0, RED),
        square(20.0, 20.0, 15.0, BLUE),
    );
    let moved = square(50.0, 50.0, 15.0, BLUE);
    let (a, b) = (
        drawing(&format!("{red}{blue}")),
        drawing(&format!("{red}{moved}")),
    );
    let mut spec = TransitionSpec::new(a, b);
    spec.method = TransitionMethod::new(WarpKind::Paths, ContentKind::Solid).unwrap();
    let transition = Transition::build(&spec, &Silent).unwrap();
    for t in [0.0, 0.5, 1.0] {
        assert_same(
            &visible_layers(&transition, t),
            &[(RED.into(), 1600.0), (BLUE.into(), 225.0)],
        );
    }
    spec.options.paint = PaintRule::One;
    let plain = Transition::build(&spec, &Silent).unwrap();
    assert!(plain.frame(0.5).figure().layers.is_empty());
}

#[test]
fn bars_keep_their_colours() {
    let truss = |colours: &str, bars: &str| {
        let nodes = "[[0, 0], [4, 0], [0, 3]]";
        let text = format!("{{\"nodes\": {nodes}, \"bars\": {bars}, \"colours\": {colours}}}");
        design(&text)
    };
    let source = truss(
        "[\"#ff0000\", \"#ff0000\", \"#0000ff\"]",
        "[[0, 1], [1, 2], [2, 0]]",
    );
    // The same bars as in the source, in another order and direction.
    let target = truss(
        "[\"#0000ff\", \"#0000ff\", \"#ff0000\"]",
        "[[0, 2], [2, 1], [1, 0]]",
    );
    let mut spec = TransitionSpec::new(source, target);
    let transition = Transition::build(&spec, &Silent).unwrap();
    let (red, blue) = (Some(RED.into()), Some(BLUE.into()));
    let expected = [[red, red], [red, blue], [blue, blue]];
    assert_eq!(transition.frame(0.3).figure().bar_paints, expected);
    spec.options.paint = PaintRule::One;
    let plain = Transition::build(&spec, &Silent).unwrap();
    assert!(plain.frame(0.3).figure().bar_paints.is_empty());
}

#[test]
fn unmatched_parts_fade_on_request() {
    let both = square(10.0, 10.0, 30.0, BLUE);
    let transition = transition_of(&both, &format!("{both}{}", square(60.0, 60.0, 20.0, RED)));
    let fading = PaintLayerOptions {
        fade: true,
        ..PaintLayerOptions::default()
    };
    let faded = transition.with_paint_layers(&fading);
    let opacity = |transition: &Transition, t: f64| {
        let visible_layers = visible_layers(transition, t);
        let red = visible_layers.iter().find(|(paint, _)| paint.colour == RED);
        red.map(|(paint, _)| paint.opacity)
    };
    for t in [0.8, 0.9, 1.0] {
        assert_eq!(opacity(&transition, t), Some(1.0));
        assert!((opacity(&faded, t).unwrap() - t).abs() < 1e-9, "{t}");
    }
    let back = faded.with_paint_layers(&PaintLayerOptions::default());
    assert_eq!(back.frame(0.9).figure(), transition.frame(0.9).figure());
}

#[test]
fn the_stacking_order_changes_when_requested() {
    let (red, blue) = (
        square(10.0, 10.0, 40.0, RED),
        square(30.0, 30.0, 40.0, BLUE),
    );
    let transition = transition_of(&format!("{red}{blue}"), &format!("{blue}{red}"));
    let late = PaintLayerOptions {
        reorder_at: 0.8,
        ..PaintLayerOptions::default()
    };
    let late = transition.with_paint_layers(&late);
    let lowest = |transition: &Transition, t: f64| visible_layers(transition, t)[0].0.colour;
    assert_eq!([0.4, 0.6].map(|t| lowest(&transition, t)), [RED, BLUE]);
    assert_eq!([0.6, 0.9].map(|t| lowest(&late, t)), [RED, BLUE]);
    let never = PaintLayerOptions {
        reorder_at: f64::NAN,
        ..PaintLayerOptions::default()
    };
    assert!(never.check().is_err());
}

#[test]
fn unmatched_layers_keep_their_stacking_position() {
    let face = square(10.0, 10.0, 80.0, BLUE);
    let eye = "<circle id='eye' cx='30' cy='30' r='8' fill='white'/>";
    let hat = square(20.0, 0.0, 50.0, RED);
    let a = drawing(&face);
    let b = drawing(&format!("{face}{eye}{hat}"));
    let transition = transition(&a, &b);
    let colours = |t: f64| {
        let visible_layers = visible_layers(&transition, t).into_iter();
        visible_layers
            .map(|(paint, _)| paint.colour)
            .collect::<Vec<_>>()
    };
    assert_eq!(colours(0.0), [BLUE]);
    assert_eq!(colours(0.99), [BLUE, Rgb([255; 3]), RED]);
    // The eye appears in front of the face, in its final position.
    let eye = transition.frame(0.99).figure().rings[1].clone();
    assert!(eye.iter().all(|p| p.distance(DVec2::new(30.0, 70.0)) < 9.0));
}

#[test]
fn a_drawing_without_colours_takes_those_of_the_style() {
    let (plain, painted) = (
        svg("M10 10h80v80h-80z"),
        drawing(&square(20.0, 20.0, 40.0, RED)),
    );
    let mixed = transition(&plain, &painted);
    let style = TransitionStyle::default();
    assert_eq!(visible_layers(&mixed, 0.0)[0].0, style.source.into());
    assert_eq!(visible_layers(&mixed, 1.0)[0].0, RED.into());
    let of = |rule: PaintRule| {
        let mut spec = TransitionSpec::new(Arc::clone(&plain), Arc::clone(&painted));
        spec.options.paint = rule;
        Transition::build(&spec, &Silent).unwrap()
    };
    assert!(of(PaintRule::One).frame(0.5).figure().layers.is_empty());
    assert_eq!(transition(&plain, &plain).frame(0.5).figure().layers, []);
}

#[test]
#[ignore = "slow; run by scripts/test"]
fn each_paint_has_its_own_field() {
    let a = drawing(&format!(
        "{}{}",
        square(10.0, 10.0, 80.0, BLUE),
        square(20.0, 20.0, 30.0, RED)
    ));
    let b = drawing(&format!(
        "{}<circle cx='70' cy='70' r='10' fill='lime'/>",
        square(20.0, 20.0, 70.0, BLUE)
    ));
    let transition = |warp: WarpKind, rule: PaintRule| {
        let mut spec = TransitionSpec::new(Arc::clone(&a), Arc::clone(&b));
        spec.method = TransitionMethod::new(warp, ContentKind::Field).unwrap();
        spec.options.paint = rule;
        Transition::build(&spec, &Silent).unwrap()
    };
    for warp in [WarpKind::None, WarpKind::Arap] {
        let own = transition(warp, PaintRule::Own);
        for (design, t) in [(&a, 0.0), (&b, 1.0)] {
            let layers = design.paint_layers.iter();
            let expected = layers.map(|layer| (layer.paint.unwrap(), layer.regions.area()));
            let expected: Vec<(Paint, f64)> = expected.collect();
            let found = visible_layers(&own, t);
            assert_eq!(found.len(), expected.len(), "{warp:?} {t}");
            for (found, expected) in found.iter().zip(&expected) {
                assert_eq!(found.0, expected.0);
                assert!(
                    (found.1 / expected.1 - 1.0).abs() < 0.01,
                    "{found:?} {expected:?}"
                );
            }
        }
        // Red and lime turn into each other instead of overlapping.
        assert_eq!(visible_layers(&own, 0.1).len(), 2);
        let one = transition(warp, PaintRule::One);
        assert!(one.frame(0.5).figure().layers.is_empty());
    }
}

const BLACK: Rgb = Rgb([17, 17, 17]);
const YELLOW: Rgb = Rgb([255, 209, 102]);

/// A black cross, as a path.
const CROSS: &str = "<path d='M44 25h12v19h19v12h-19v19h-12v-19h-19v-12h19z' fill='#111'/>";

#[test]
fn a_lone_part_is_paired_with_the_part_of_its_colour() {
    let on_tile = drawing(&format!("{}{CROSS}", square(5.0, 5.0, 90.0, YELLOW)));
    let disc = drawing("<circle cx='50' cy='50' r='33' fill='#111'/>");
    for (source, target, at) in [(&on_tile, &disc, 0.3), (&disc, &on_tile, 0.7)] {
        let transition = transition(source, target);
        for t in [0.0, at, 0.5, 1.0] {
            let layers = visible_layers(&transition, t);
            let black: Vec<_> = layers.iter().filter(|(p, _)| *p == BLACK.into()).collect();
            assert_eq!(black.len(), 1, "{layers:?}");
            assert!(black[0].1 > 1000.0, "{layers:?}");
            let others = layers.iter().filter(|(p, _)| *p != BLACK.into());
            assert!(
                others.clone().all(|(p, _)| *p == YELLOW.into()),
                "{layers:?}"
            );
        }
        let tile = |t: f64| visible_layers(&transition, t).len() - 1;
        assert_eq!(tile(0.0) + tile(1.0), 1);
    }
}

#[test]
fn all_parts_of_one_colour_are_paired_with_the_parts_of_that_colour() {
    let sign = format!("{}{CROSS}", square(5.0, 5.0, 90.0, YELLOW));
    let lines = square(30.0, 20.0, 20.0, BLACK) + &square(30.0, 60.0, 20.0, BLACK);
    let transition = transition_of(&sign, &lines);
    for t in [0.2, 0.4, 0.6, 0.8] {
        let layers = visible_layers(&transition, t);
        let is_own = |paint: Paint| paint == BLACK.into() || paint == YELLOW.into();
        assert!(layers.iter().all(|(paint, _)| is_own(*paint)), "{layers:?}");
    }
}

#[test]
fn a_lone_part_of_another_colour_is_paired_by_its_shape() {
    let tile = square(5.0, 5.0, 90.0, Rgb([0, 128, 0]));
    let sign = format!("{tile}{}", square(40.0, 40.0, 8.0, YELLOW));
    // Red is as far from green as from yellow.
    let transition = transition_of(&sign, &square(10.0, 10.0, 80.0, RED));
    let half = visible_layers(&transition, 0.5);
    let largest = half.iter().map(|(_, area)| *area).fold(0.0, f64::max);
    assert!((6400.0..8100.0).contains(&largest), "{half:?}");
}
