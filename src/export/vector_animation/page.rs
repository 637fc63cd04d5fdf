//! A motion as a page that plays it: one HTML file that asks for nothing else.
//!
//! The page holds the series of the points themselves, in whole steps of
//! [`STEP_PX`], and sums them for whatever t is shown; each number is told by its
//! difference from that of the point before. Its script is `player.html` beside
//! this file.

use std::collections::HashMap;
use std::io::Read;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::read::DeflateEncoder;
use serde_json::{Value, json};

use crate::colour::{GradientSpread, StrokeJoin};
use crate::geometry::DVec2;

use super::super::svg::XmlEscaped;
use super::animation::VectorAnimation;
use super::chebyshev::truncate_series;
use super::piece::MovingShape;
use super::shape::{PathVerb, ShapeForm};
use super::simplify::simplify;

/// Steps in which the coefficients are told, in pixels: of 16 terms each half a step
/// off, a point is a twelfth of a pixel off on average.
const STEP_PX: f64 = 1.0 / 24.0;

/// The same of what does not move within its piece, which no other terms add to: the
/// first of them with which the film is not large. `cantilevers-carried`, 121 frames of
/// a contour with ten holes, needs the last but one.
const STILL_PX: [f64; 4] = [1.0 / 16.0, 1.0 / 12.0, 1.0 / 10.0, 1.0 / 8.0];

/// How far from its line a point that does not move may be to be left out of a large
/// film, in pixels.
const MISSED_PX: f64 = 0.08;

/// What is large, in letters.
const LARGE: usize = 285_000;

/// What the terms that are left out may sum up to, in pixels.
const LEFT_OUT_PX: f64 = 0.05;

/// The page around the film.
const PLAYER: &str = include_str!("player.html");

pub(super) fn html_page(motion: &VectorAnimation, title: &str) -> String {
    let mut film = packed(motion, title, STILL_PX[0]);
    if film.len() > LARGE {
        let mut motion = motion.clone();
        simplify(&mut motion.pieces, MISSED_PX);
        for still_px in STILL_PX {
            if film.len() > LARGE {
                film = packed(&motion, title, still_px);
            }
        }
    }
    let title = XmlEscaped(title).to_string();
    let parts = PLAYER.split("{{").map(|part| match part.split_once("}}") {
        Some(("title", rest)) => title.clone() + rest,
        Some(("film", rest)) => film.clone() + rest,
        _ => part.to_owned(),
    });
    parts.collect()
}

/// The film as text: its description, a line's end, and the series in bytes, deflated
/// (RFC 1951) and in base 64.
fn packed(motion: &VectorAnimation, title: &str, still_px: f64) -> String {
    let mut series = Vec::new();
    let mut bytes = film(motion, title, (still_px, &mut series))
        .to_string()
        .into_bytes();
    bytes.push(b'\n');
    bytes.append(&mut series);
    let mut packed = Vec::new();
    let mut packer = DeflateEncoder::new(bytes.as_slice(), Compression::best());
    // Reading from memory into memory does not fail.
    match packer.read_to_end(&mut packed) {
        Ok(_) => BASE64_STANDARD.encode(packed),
        Err(_) => String::new(),
    }
}

/// What a film is, but for the series, which are added to some bytes.
fn film(motion: &VectorAnimation, title: &str, (still_px, bytes): (f64, &mut Vec<u8>)) -> Value {
    let mut forms = FormTable::default();
    let pieces: Vec<Value> = (motion.pieces.iter())
        .map(|piece| {
            let shapes = piece.shapes.iter();
            let shapes = shapes.map(|shape| {
                let count = push_terms(shape, still_px, bytes);
                json!([forms.number(shape), count, looks(shape)])
            });
            json!([piece.from, piece.to, shapes.collect::<Vec<_>>()])
        })
        .collect();
    let course = &motion.course;
    let [from, to] = motion.ends();
    json!({
        "title": title, "size": [motion.size.width(), motion.size.height()],
        "ground": motion.ground.map(|ground| ground.to_string()),
        "ends": [from, to], "fps": course.fps, "frames": course.frames(),
        "repeats": course.repeats, "knots": course.knots(), "stops": motion.stops,
        "steps": [STEP_PX, still_px], "forms": forms.all, "pieces": pieces,
    })
}

/// What stays of shapes, each told once.
#[derive(Default)]
struct FormTable {
    all: Vec<Value>,
    numbers: HashMap<String, usize>,
}

impl FormTable {
    fn number(&mut self, shape: &MovingShape) -> usize {
        let form = told(&shape.first.form, shape.first.points.len());
        *self.numbers.entry(form.to_string()).or_insert_with(|| {
            self.all.push(form);
            self.all.len() - 1
        })
    }
}

fn told(form: &ShapeForm, points: usize) -> Value {
    match form {
        ShapeForm::Fill { verbs, label, ramp } => {
            let mut told = json!({"kind": "fill", "path": runs(verbs), "points": points});
            if let Some(label) = label {
                told["label"] = json!(label);
            }
            if let Some(ramp) = ramp {
                let spread = match ramp.spread {
                    GradientSpread::Pad => "pad",
                    GradientSpread::Reflect => "reflect",
                    GradientSpread::Repeat => "repeat",
                };
                told["ramp"] = json!([ramp.is_round, ramp.stops, spread]);
            }
            told
        }
        ShapeForm::Line { verbs, join } => {
            let join = match join {
                StrokeJoin::Mitre(limit) => json!(["miter", limit]),
                StrokeJoin::Round => json!(["round", 4]),
                StrokeJoin::Bevel => json!(["bevel", 4]),
            };
            json!({"kind": "line", "path": runs(verbs), "points": points, "join": join})
        }
        ShapeForm::Bars => json!({"kind": "bars", "path": "M1L1", "points": points}),
        ShapeForm::Discs => json!({"kind": "discs", "path": "M1Z1", "points": points}),
    }
}

/// Steps with how many of a kind follow each other.
fn runs(verbs: &[PathVerb]) -> String {
    let letter = |verb: PathVerb| match verb {
        PathVerb::Move => 'M',
        PathVerb::Line => 'L',
        PathVerb::Quad => 'Q',
        PathVerb::Cubic => 'C',
        PathVerb::Close => 'Z',
    };
    let runs = verbs.chunk_by(|a, b| a == b);
    runs.map(|run| format!("{}{}", letter(run[0]), run.len()))
        .collect()
}

fn looks(shape: &MovingShape) -> Vec<Vec<Value>> {
    let number = |&x: &f64| {
        let x = (x * 1e3).round() / 1e3;
        if x.fract() == 0.0 {
            json!(x as i64)
        } else {
            json!(x)
        }
    };
    let look = |look: &Vec<f64>| look.iter().map(number).collect();
    shape.looks.iter().map(look).collect()
}

/// Adds the series of a shape; returns how many terms there are.
fn push_terms(shape: &MovingShape, still_px: f64, bytes: &mut Vec<u8>) -> usize {
    let mut terms = shape.terms.clone();
    truncate_series(&mut terms, LEFT_OUT_PX);
    let step = if terms.len() == 1 { still_px } else { STEP_PX };
    for term in &terms {
        let mut before = [0; 2];
        for p in term {
            let DVec2 { x, y } = *p / step;
            let at = [x, y].map(|x| x.round() as i64);
            for (at, before) in at.into_iter().zip(before) {
                push_number(at.saturating_sub(before), bytes);
            }
            before = at;
        }
    }
    terms.len()
}

/// A number in as few bytes as it needs, seven bits in each, the sign in the lowest.
fn push_number(number: i64, bytes: &mut Vec<u8>) {
    let mut rest = ((number << 1) ^ (number >> 63)) as u64;
    while rest >= 1 << 7 {
        bytes.push((rest & 0x7f) as u8 | 0x80);
        rest >>= 7;
    }
    bytes.push(rest as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_take_as_few_bytes_as_they_need() {
        let written = |number| {
            let mut bytes = Vec::new();
            push_number(number, &mut bytes);
            bytes
        };
        assert_eq!(html_page(0), [0]);
        assert_eq!(html_page(-1), [1]);
        assert_eq!(html_page(63), [126]);
        assert_eq!(html_page(64), [0x80, 1]);
        assert_eq!(html_page(-8193), [0x81, 0x80, 1]);
    }

    #[test]
    fn runs_of_steps_are_counted() {
        let verbs = [
            PathVerb::Move,
            PathVerb::Line,
            PathVerb::Line,
            PathVerb::Close,
            PathVerb::Move,
        ];
        assert_eq!(runs(&verbs), "M1L2Z1M1");
    }
}
