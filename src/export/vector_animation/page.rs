//! Writes a vector animation as a self-contained HTML page with a player.
//!
//! The page contains the Chebyshev coefficients of all points, rounded to integer multiples of
//! [`STEP_PX`] or, for shapes that do not move, of a step from [`STILL_PX`]. Each coefficient is
//! stored as its difference from the coefficient of the previous point. The player, `player.html`
//! next to this file, evaluates the series for the t shown.

use std::collections::HashMap;
use std::io::Read;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::read::DeflateEncoder;
use serde_json::{Value, json};

use crate::colour::{GradientSpread, StrokeJoin};
use crate::geometry::DVec2;
use crate::io::escape::{XmlEscaped, json_text};

use super::animation::VectorAnimation;
use super::chebyshev::truncate_series;
use super::piece::MovingShape;
use super::shape::{PathVerb, ShapeForm};
use super::simplify::simplify;

/// Step to which the coefficients of moving shapes are rounded, in pixels (tolerance: rounding 16
/// coefficients by up to half a step displaces a point by less than a twentieth of a pixel on
/// average).
const STEP_PX: f64 = 1.0 / 24.0;

/// Steps to which the points of a shape are rounded if it does not move within its animation piece,
/// in pixels, the finest first. The first step with which the page is small enough is used, or else
/// the last one (heuristic).
const STILL_PX: [f64; 4] = [1.0 / 16.0, 1.0 / 12.0, 1.0 / 10.0, 1.0 / 8.0];

/// Maximum distance of a removed point from the line that replaces it, in pixels, for static shapes
/// of films whose page would be too large (heuristic: twice the ordinary tolerance).
const LARGE_FILM_TOLERANCE_PX: f64 = 0.08;

/// Length of the packed film, in characters, above which precision is reduced (resource limit:
/// keeps the page including the player below 300 kB).
const MAX_FILM_CHARS: usize = 285_000;

/// Maximum displacement of a point by dropping the last terms of its series, in pixels (tolerance:
/// a quarter of [`VectorAnimation::TOLERANCE_PX`]).
const TRUNCATION_PX: f64 = 0.05;

/// HTML template with the placeholders `{{title}}` and `{{film}}`.
const PLAYER: &str = include_str!("player.html");

/// Returns the page with the given title.
pub(super) fn html_page(animation: &VectorAnimation, title: &str) -> String {
    let mut film = pack(animation, title, STILL_PX[0]);
    if film.len() > MAX_FILM_CHARS {
        let mut animation = animation.clone();
        simplify(&mut animation.pieces, LARGE_FILM_TOLERANCE_PX);
        for still_px in STILL_PX {
            if film.len() > MAX_FILM_CHARS {
                film = pack(&animation, title, still_px);
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

/// Packs a film as text: a line of JSON, followed by the Chebyshev coefficients of all shapes in
/// binary form. Both are compressed with deflate (RFC 1951) and encoded in base64.
fn pack(animation: &VectorAnimation, title: &str, still_px: f64) -> String {
    let mut series = Vec::new();
    let mut bytes = json_text(&film(animation, title, still_px, &mut series)).into_bytes();
    bytes.push(b'\n');
    bytes.append(&mut series);
    let mut packed = Vec::new();
    let mut packer = DeflateEncoder::new(bytes.as_slice(), Compression::best());
    // In-memory compression does not fail.
    match packer.read_to_end(&mut packed) {
        Ok(_) => BASE64_STANDARD.encode(packed),
        Err(_) => String::new(),
    }
}

/// Returns the JSON description of the film. The Chebyshev coefficients of all shapes are not part
/// of it; they are appended to `bytes`.
fn film(animation: &VectorAnimation, title: &str, still_px: f64, bytes: &mut Vec<u8>) -> Value {
    let mut forms = FormTable::default();
    let pieces: Vec<Value> = (animation.pieces.iter())
        .map(|piece| {
            let shapes = piece.shapes.iter();
            let shapes = shapes.map(|shape| {
                let count = push_terms(shape, still_px, bytes);
                json!([forms.number(shape), count, looks(shape)])
            });
            json!([piece.from, piece.to, shapes.collect::<Vec<_>>()])
        })
        .collect();
    let timeline = &animation.timeline;
    let [from, to] = animation.time_range();
    json!({
        "title": title, "size": [animation.size.width(), animation.size.height()],
        "ground": animation.ground.map(|ground| ground.to_string()),
        "ends": [from, to], "fps": timeline.fps, "frames": timeline.frames(),
        "repeats": timeline.repeats, "knots": timeline.linear_knots(), "stops": animation.stops,
        "steps": [STEP_PX, still_px], "forms": forms.all, "pieces": pieces,
    })
}

/// Table of the constant data of all shapes; equal data is stored once.
#[derive(Default)]
struct FormTable {
    all: Vec<Value>,
    /// For the JSON text of each entry: the index of the entry in `all`.
    numbers: HashMap<String, usize>,
}

impl FormTable {
    /// Returns the index of a shape's constant data in the table. Adds the data if they are not in
    /// the table yet.
    fn number(&mut self, shape: &MovingShape) -> usize {
        let form = form_json(&shape.first.form, shape.first.points.len());
        *self.numbers.entry(form.to_string()).or_insert_with(|| {
            self.all.push(form);
            self.all.len() - 1
        })
    }
}

/// Returns the constant data of a shape as JSON.
fn form_json(form: &ShapeForm, points: usize) -> Value {
    match form {
        ShapeForm::Fill { verbs, label, ramp } => {
            let mut fill = json!({"kind": "fill", "path": runs(verbs), "points": points});
            if let Some(label) = label {
                fill["label"] = json!(label);
            }
            if let Some(ramp) = ramp {
                let spread = match ramp.spread {
                    GradientSpread::Pad => "pad",
                    GradientSpread::Reflect => "reflect",
                    GradientSpread::Repeat => "repeat",
                };
                fill["ramp"] = json!([ramp.is_radial, ramp.stops, spread]);
            }
            fill
        }
        ShapeForm::Stroke { verbs, join } => {
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

/// Returns the run-length encoding of path commands, such as `M1L2Z1`.
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

/// Returns the samples of a shape's appearance (colour, width and gradient numbers), rounded to
/// three decimals.
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
    shape.appearances.iter().map(look).collect()
}

/// Appends the Chebyshev coefficients of a shape's points to `bytes`, and returns the number of
/// coefficients of each point.
fn push_terms(shape: &MovingShape, still_px: f64, bytes: &mut Vec<u8>) -> usize {
    let mut terms = shape.terms.clone();
    truncate_series(&mut terms, TRUNCATION_PX);
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

/// Appends an integer as a variable-length number (zigzag, seven bits per byte, the sign in the
/// lowest bit).
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
        assert_eq!(written(0), [0]);
        assert_eq!(written(-1), [1]);
        assert_eq!(written(63), [126]);
        assert_eq!(written(64), [0x80, 1]);
        assert_eq!(written(-8193), [0x81, 0x80, 1]);
    }

    #[test]
    fn path_commands_are_run_length_encoded() {
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
