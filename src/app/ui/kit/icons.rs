//! The window's icons, drawn from lines so that they are sharp at any scale factor.

use bevy_egui::egui::{Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

/// One icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// A triangle to the right.
    Play,
    /// A triangle to the left.
    PlayBackwards,
    /// Two bars.
    Pause,
    /// To the start of the pass.
    ToStart,
    /// To the end of the pass.
    ToEnd,
    /// Play to the next stop.
    NextStop,
    /// Play back to the stop before.
    PreviousStop,
    /// A flag: set a stop.
    AddStop,
    /// A folder.
    Open,
    /// An arrow into a tray.
    Save,
    /// A camera.
    Camera,
    /// A filled dot.
    Record,
    /// A moon.
    Moon,
    /// A sun.
    Sun,
    /// Four corners.
    Fit,
    /// A cross.
    Close,
    /// Two arrows.
    Swap,
    /// A tick.
    Tick,
    /// A triangle with a sign.
    Warning,
    /// A chevron down.
    More,
    /// An arrow that turns back.
    Undo,
    /// An arrow that turns forward.
    Redo,
    /// Two dots and a line between them: what belongs together.
    Match,
    /// Two panes.
    Twin,
    /// A curve over two axes.
    Plot,
}

/// Draws an icon into the middle of a rectangle, 16 points wide.
pub fn paint(painter: &Painter, icon: Icon, rect: Rect, colour: Color32) {
    let pen = Pen {
        painter,
        centre: rect.center(),
        colour,
    };
    match icon {
        Icon::Play => pen.triangle(0.5, 5.0),
        Icon::PlayBackwards => pen.triangle(-0.5, -5.0),
        Icon::Pause => pen.bars(&[-3.5, 3.5], 3.0, 5.5),
        Icon::ToStart => pen.skip(-1.0),
        Icon::ToEnd => pen.skip(1.0),
        Icon::NextStop => pen.slide(1.0),
        Icon::PreviousStop => pen.slide(-1.0),
        Icon::AddStop => pen.flag(),
        Icon::Open => pen.lines(FOLDER),
        Icon::Save => pen.lines(TRAY),
        Icon::Camera => pen.camera(),
        Icon::Record => pen.dot(vec2(0.0, 0.0), 4.5),
        Icon::Moon => pen.moon(),
        Icon::Sun => pen.sun(),
        Icon::Fit => pen.corners(),
        Icon::Close => pen.lines(&[&[(-4.0, -4.0), (4.0, 4.0)], &[(4.0, -4.0), (-4.0, 4.0)]]),
        Icon::Swap => pen.lines(SWAP),
        Icon::Tick => pen.lines(&[&[(-5.0, 0.5), (-1.5, 4.0), (5.0, -4.0)]]),
        Icon::Warning => pen.warning(),
        Icon::More => pen.lines(&[&[(-3.5, -1.5), (0.0, 2.0), (3.5, -1.5)]]),
        Icon::Undo => pen.turn(1.0),
        Icon::Redo => pen.turn(-1.0),
        Icon::Match => pen.pair(),
        Icon::Twin => pen.lines(PANES),
        Icon::Plot => pen.lines(&[
            &[(-6.0, -6.0), (-6.0, 6.0), (6.5, 6.0)],
            &[(-3.5, 2.5), (-0.5, -2.0), (2.0, 0.5), (6.0, -4.5)],
        ]),
    }
}

/// Lines through points, from the middle of the icon.
type Lines = &'static [&'static [(f32, f32)]];

const FOLDER: Lines = &[&[
    (-6.5, 5.0),
    (-6.5, -5.0),
    (-2.0, -5.0),
    (-0.5, -3.0),
    (6.5, -3.0),
    (6.5, 5.0),
    (-6.5, 5.0),
]];
const TRAY: Lines = &[
    &[(0.0, -6.5), (0.0, 2.0)],
    &[(-3.5, -1.5), (0.0, 2.0), (3.5, -1.5)],
    &[(-6.5, 2.0), (-6.5, 6.0), (6.5, 6.0), (6.5, 2.0)],
];
const SWAP: Lines = &[
    &[(-6.0, -3.0), (6.0, -3.0)],
    &[(3.0, -6.0), (6.0, -3.0), (3.0, 0.0)],
    &[(6.0, 3.5), (-6.0, 3.5)],
    &[(-3.0, 0.5), (-6.0, 3.5), (-3.0, 6.5)],
];
const PANES: Lines = &[
    &[
        (-7.0, -5.0),
        (7.0, -5.0),
        (7.0, 5.0),
        (-7.0, 5.0),
        (-7.0, -5.0),
    ],
    &[(0.0, -5.0), (0.0, 5.0)],
];

struct Pen<'a> {
    painter: &'a Painter,
    centre: Pos2,
    colour: Color32,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> Pos2 {
        self.centre + vec2(x, y)
    }

    fn stroke(&self) -> Stroke {
        Stroke::new(1.5, self.colour)
    }

    fn lines(&self, lines: &[&[(f32, f32)]]) {
        for line in lines {
            let points = line.iter().map(|(x, y)| self.at(*x, *y)).collect();
            self.painter.add(Shape::line(points, self.stroke()));
        }
    }

    fn filled(&self, points: &[(f32, f32)]) {
        let points = points.iter().map(|(x, y)| self.at(*x, *y)).collect();
        self.painter
            .add(Shape::convex_polygon(points, self.colour, Stroke::NONE));
    }

    fn dot(&self, offset: Vec2, radius: f32) {
        self.painter
            .circle_filled(self.centre + offset, radius, self.colour);
    }

    fn triangle(&self, x: f32, reach: f32) {
        self.filled(&[
            (x - 0.8 * reach, -5.5),
            (x + reach, 0.0),
            (x - 0.8 * reach, 5.5),
        ]);
    }

    fn bars(&self, xs: &[f32], width: f32, half_height: f32) {
        for x in xs {
            let size = vec2(width, 2.0 * half_height);
            self.painter.rect_filled(
                Rect::from_center_size(self.at(*x, 0.0), size),
                1.0,
                self.colour,
            );
        }
    }

    fn skip(&self, side: f32) {
        self.triangle(-side, 4.0 * side);
        self.bars(&[5.0 * side], 2.0, 5.0);
    }

    fn slide(&self, side: f32) {
        self.lines(&[&[(-2.5 * side, -4.5), (2.0 * side, 0.0), (-2.5 * side, 4.5)]]);
        self.painter
            .circle_filled(self.at(5.5 * side, 0.0), 1.8, self.colour);
    }

    fn flag(&self) {
        self.lines(&[&[(-3.5, 6.5), (-3.5, -6.0)]]);
        self.filled(&[(-3.5, -6.0), (5.5, -2.5), (-3.5, 1.0)]);
    }

    fn camera(&self) {
        self.lines(&[&[
            (-7.0, 5.0),
            (-7.0, -3.0),
            (-3.5, -3.0),
            (-2.0, -5.5),
            (2.0, -5.5),
            (3.5, -3.0),
            (7.0, -3.0),
            (7.0, 5.0),
            (-7.0, 5.0),
        ]]);
        self.painter
            .circle_stroke(self.at(0.0, 0.8), 2.6, self.stroke());
    }

    fn moon(&self) {
        let arc = |radius: f32, centre: f32, from: f32, to: f32| {
            (0..=16u8).map(move |i| {
                let angle = from + (to - from) * f32::from(i) / 16.0;
                (centre + radius * angle.cos(), radius * angle.sin())
            })
        };
        let outer = arc(6.0, 0.0, 0.9, 5.38);
        let inner = arc(5.2, 3.4, 4.05, 2.23);
        let points: Vec<(f32, f32)> = outer.chain(inner).collect();
        let closed: Vec<(f32, f32)> = points.iter().chain(points.first()).copied().collect();
        self.lines(&[&closed]);
    }

    fn sun(&self) {
        self.painter.circle_stroke(self.centre, 3.0, self.stroke());
        for i in 0..8u8 {
            let ray = Vec2::angled(f32::from(i) * std::f32::consts::FRAC_PI_4);
            let ends = [self.centre + 5.0 * ray, self.centre + 7.0 * ray];
            self.painter.line_segment(ends, self.stroke());
        }
    }

    fn corners(&self) {
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            self.lines(&[&[(6.0 * x, 2.5 * y), (6.0 * x, 6.0 * y), (2.5 * x, 6.0 * y)]]);
        }
    }

    /// `side` is 1 for the arrow to the left.
    fn turn(&self, side: f32) {
        let arc: Vec<(f32, f32)> = (0..=12u8)
            .map(|i| {
                let angle =
                    -std::f32::consts::FRAC_PI_2 + f32::from(i) * std::f32::consts::PI / 12.0;
                (side * (1.5 + 4.0 * angle.cos()), 1.0 + 4.0 * angle.sin())
            })
            .collect();
        let shaft = [(side * -5.5, -3.0), (side * 1.5, -3.0)];
        let whole: Vec<(f32, f32)> = shaft.into_iter().chain(arc).collect();
        self.lines(&[
            &whole,
            &[(side * 1.5, 5.0), (side * -2.0, 5.0)],
            &[(side * -2.5, -6.0), (side * -5.5, -3.0), (side * -2.5, 0.0)],
        ]);
    }

    fn pair(&self) {
        self.lines(&[&[(-3.2, 2.4), (3.2, -2.4)]]);
        for (x, y) in [(-5.0, 3.6), (5.0, -3.6)] {
            self.painter
                .circle_stroke(self.at(x, y), 2.4, self.stroke());
        }
    }

    fn warning(&self) {
        self.lines(&[
            &[(0.0, -6.0), (6.8, 5.5), (-6.8, 5.5), (0.0, -6.0)],
            &[(0.0, -2.0), (0.0, 1.6)],
        ]);
        self.painter
            .circle_filled(pos2(self.centre.x, self.centre.y + 3.8), 0.9, self.colour);
    }
}
