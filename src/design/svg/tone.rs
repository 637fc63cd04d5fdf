//! The one paint of what is filled with several: of gradients and patterns the
//! mean.

use crate::colour::{Paint, Rgb};
use usvg::{Color, Group, Node, Opacity, Pattern, Stop};

/// A paint, and whether it is the mean of several.
pub(super) struct Tone {
    pub paint: Paint,
    pub is_mean: bool,
}

/// What a fill or a stroke is painted with; none where nothing is seen of it.
pub(super) fn flat(paint: &usvg::Paint, opacity: Opacity) -> Option<Tone> {
    let (mean, is_mean) = match paint {
        usvg::Paint::Color(colour) => (rgb(*colour).into(), false),
        usvg::Paint::LinearGradient(gradient) => (mean_of(gradient.stops()), true),
        usvg::Paint::RadialGradient(gradient) => (mean_of(gradient.stops()), true),
        usvg::Paint::Pattern(pattern) => (of_pattern(pattern)?, true),
    };
    let opacity = mean.opacity * f64::from(opacity.get());
    let paint = Paint { opacity, ..mean };
    (opacity > 0.0).then_some(Tone { paint, is_mean })
}

fn rgb(colour: Color) -> Rgb {
    Rgb([colour.red, colour.green, colour.blue])
}

/// The mean along a gradient, from its beginning to its end.
fn mean_of(stops: &[Stop]) -> Paint {
    let paint = |stop: &Stop| Paint {
        colour: rgb(stop.color()),
        opacity: stop.opacity().get().into(),
    };
    let place = |stop: &Stop| f64::from(stop.offset().get());
    // The ends go on as they are.
    let [Some(first), Some(last)] = [stops.first(), stops.last()] else {
        return Rgb([0; 3]).into();
    };
    let ends = [
        (paint(first), place(first)),
        (paint(last), 1.0 - place(last)),
    ];
    let between = stops.windows(2).map(|pair| {
        let [a, b] = [&pair[0], &pair[1]];
        (paint(a).mixed(paint(b), 0.5), place(b) - place(a))
    });
    mean(ends.into_iter().chain(between))
}

/// The mean of what is filled in a pattern, one shape as much as another.
fn of_pattern(pattern: &Pattern) -> Option<Paint> {
    let mut found = Vec::new();
    fills(pattern.root(), &mut found);
    let paints = found.into_iter().map(|paint| (paint, 1.0));
    Some(mean(paints)).filter(|paint| paint.opacity > 0.0)
}

fn fills(group: &Group, found: &mut Vec<Paint>) {
    for node in group.children() {
        match node {
            Node::Group(inner) => fills(inner, found),
            Node::Path(path) => {
                let fill = path.fill().and_then(|fill| match fill.paint() {
                    // A pattern in a pattern could go on without end.
                    usvg::Paint::Pattern(_) => None,
                    paint => flat(paint, fill.opacity()),
                });
                found.extend(fill.map(|tone| tone.paint));
            }
            Node::Image(_) | Node::Text(_) => {}
        }
    }
}

/// The mean of paints by their weights.
fn mean(paints: impl Iterator<Item = (Paint, f64)>) -> Paint {
    let none = Paint {
        colour: Rgb([0; 3]),
        opacity: 0.0,
    };
    let (mean, _) = paints.fold((none, 0.0), |(mean, total), (paint, weight)| {
        let sum = total + weight;
        let share = if sum > 0.0 { weight / sum } else { 0.0 };
        (mean.mixed(paint, share), sum)
    });
    mean
}
