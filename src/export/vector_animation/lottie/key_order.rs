//! Tests that the keys of a Lottie file come in the order that players expect.

use std::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};

use crate::colour::{
    Gradient, GradientGeometry, GradientSpread, GradientStop, Paint, Rgb, StrokeJoin, StrokeStyle,
};
use crate::export::drawing::DrawingItem;
use crate::export::outline::{OutlinePath, PathCommand};
use crate::export::vector_animation::VectorAnimation;
use crate::export::vector_animation::piece::{AnimationPiece, MovingShape};
use crate::export::vector_animation::shape::PosedShape;
use crate::export::vector_animation::timeline::FilmTimeline;
use crate::export::{FilmSpec, PixelSize};
use crate::geometry::{DAffine2, DVec2};

/// JSON value whose objects keep the order of their keys; numbers and texts are dropped.
#[derive(Debug)]
enum OrderedJson {
    Object(Vec<(String, OrderedJson)>),
    List(Vec<OrderedJson>),
    Plain,
}

impl<'de> Deserialize<'de> for OrderedJson {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AnyValue;
        impl<'de> Visitor<'de> for AnyValue {
            type Value = OrderedJson;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("JSON")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<OrderedJson, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(OrderedJson::Object(entries))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<OrderedJson, A::Error> {
                let mut values = Vec::new();
                while let Some(value) = list.next_element()? {
                    values.push(value);
                }
                Ok(OrderedJson::List(values))
            }

            fn visit_i64<E>(self, _: i64) -> Result<OrderedJson, E> {
                Ok(OrderedJson::Plain)
            }

            fn visit_u64<E>(self, _: u64) -> Result<OrderedJson, E> {
                Ok(OrderedJson::Plain)
            }

            fn visit_f64<E>(self, _: f64) -> Result<OrderedJson, E> {
                Ok(OrderedJson::Plain)
            }

            fn visit_bool<E>(self, _: bool) -> Result<OrderedJson, E> {
                Ok(OrderedJson::Plain)
            }

            fn visit_str<E>(self, _: &str) -> Result<OrderedJson, E> {
                Ok(OrderedJson::Plain)
            }
        }
        deserializer.deserialize_any(AnyValue)
    }
}

impl OrderedJson {
    /// Calls `visit` with the keys of each object in this value, with the key under which the
    /// object, or the list that contains it, is stored.
    fn visit_objects(&self, stored_as: &str, visit: &mut impl FnMut(&str, &[&str])) {
        match self {
            Self::Object(entries) => {
                let keys: Vec<&str> = entries.iter().map(|entry| entry.0.as_str()).collect();
                visit(stored_as, &keys);
                for (key, value) in entries {
                    value.visit_objects(key, visit);
                }
            }
            Self::List(values) => values
                .iter()
                .for_each(|value| value.visit_objects(stored_as, visit)),
            Self::Plain => {}
        }
    }
}

/// Returns an outline with a segment of each kind.
fn outline_at(x: f64) -> OutlinePath {
    let p = |a: f64, b: f64| DVec2::new(a + x, b);
    let commands = vec![
        PathCommand::Move(p(0.0, 0.0)),
        PathCommand::Line(p(9.0, 0.0)),
        PathCommand::Quad(p(9.0, 9.0), p(4.0, 9.0)),
        PathCommand::Cubic(p(3.0, 9.0), p(0.0, 5.0), p(0.0, 1.0)),
        PathCommand::Close,
    ];
    OutlinePath {
        commands,
        names: Vec::new(),
    }
}

/// Returns a drawing with an item of each kind. `x` moves and colours it.
fn items_at(x: f64) -> Vec<DrawingItem> {
    let outline = outline_at(x);
    let p = |a: f64, b: f64| DVec2::new(a + x, b);
    let colour = Rgb([x as u8, 20, 200]);
    let paint = Paint {
        colour,
        opacity: 0.5,
    };
    let fill = |gradient| DrawingItem::Fill {
        outline: outline.clone(),
        paint,
        gradient,
        label: Some("</script>".to_owned()),
    };
    let stops = [0.0, 1.0].map(|offset| GradientStop { offset, paint });
    let gradient = |geometry| Gradient {
        geometry,
        frame: DAffine2::from_scale_angle_translation(p(9.0, 9.0), 0.0, p(1.0, 2.0)),
        stops: stops.to_vec(),
        spread: GradientSpread::Pad,
    };
    let line = |join| DrawingItem::Stroke {
        outline: outline.clone(),
        line: StrokeStyle {
            paint,
            width: 2.0,
            join,
            is_below_fill: false,
        },
    };
    let radial = GradientGeometry::Radial {
        focus: DVec2::ZERO,
        inner: 0.0,
    };
    vec![
        fill(None),
        fill(Some(gradient(GradientGeometry::Linear))),
        fill(Some(gradient(radial))),
        line(StrokeJoin::Mitre(4.0)),
        line(StrokeJoin::Bevel),
        DrawingItem::Bars {
            segments: vec![[p(0.0, 0.0), p(5.0, 5.0)]],
            width_px: 2.0,
            colour,
        },
        DrawingItem::Discs {
            centres: vec![p(3.0, 3.0)],
            radius_px: 2.0,
            colour,
        },
    ]
}

/// Returns an animation with a shape of each kind, of which the colour and the points change.
fn every_kind_of_shape() -> VectorAnimation {
    let posed = |items: Vec<DrawingItem>| items.into_iter().filter_map(|i| PosedShape::of(&i));
    let moving = |(first, last): (PosedShape, PosedShape)| {
        let halves = first.points.iter().zip(&last.points);
        let (mean, slope) = halves
            .map(|(a, b)| (a.midpoint(*b), 0.5 * (*b - *a)))
            .unzip();
        MovingShape {
            terms: vec![mean, slope],
            appearances: vec![first.appearance.clone(), last.appearance],
            first,
        }
    };
    let shapes = posed(items_at(0.0)).zip(posed(items_at(100.0))).map(moving);
    let film = FilmSpec::evenly(0.0, 1.0, 10, 10.0).expect("a film");
    VectorAnimation {
        size: PixelSize::new(200, 20).expect("a legal size"),
        ground: Some(Rgb([1, 2, 3])),
        pieces: vec![AnimationPiece {
            from: 0.0,
            to: 1.0,
            shapes: shapes.collect(),
            is_continuation: false,
        }],
        timeline: FilmTimeline::of(&film),
        stops: Vec::new(),
    }
}

#[test]
fn the_type_is_the_first_key_of_each_shape() {
    let text = every_kind_of_shape().lottie("film");
    let json: OrderedJson = serde_json::from_str(&text).expect("JSON");
    let mut shapes = 0;
    json.visit_objects("", &mut |stored_as, keys| {
        let position = |key: &str| keys.iter().position(|k| *k == key);
        match stored_as {
            "shapes" | "it" => {
                shapes += 1;
                assert_eq!(keys[0], "ty", "{keys:?}");
            }
            "layers" => {
                let own = ["ks", "shapes", "refId", "sc"].map(position);
                let first = own.into_iter().flatten().min();
                assert!(position("ty") < first, "{keys:?}");
            }
            // The number of colour stops tells colours from opacities.
            "g" => assert_eq!(keys, ["p", "k"]),
            _ => {}
        }
    });
    // Seven groups with one path or ellipse, one paint and one transform each.
    assert_eq!(shapes, 7 * 4);
    assert!(!text.contains("</script>") && text.contains("\\u003c/script>"));
}

#[test]
fn each_kind_of_shape_has_the_type_of_the_format() {
    let text = every_kind_of_shape().lottie("film");
    let film: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let groups = film["assets"][0]["layers"][0]["shapes"]
        .as_array()
        .expect("shapes");
    let types: Vec<Vec<&str>> = (groups.iter())
        .map(|group| {
            let items = group["it"].as_array().expect("items").iter();
            items.filter_map(|item| item["ty"].as_str()).collect()
        })
        .collect();
    let expected = [
        ["el", "fl", "tr"],
        ["sh", "st", "tr"],
        ["sh", "st", "tr"],
        ["sh", "st", "tr"],
        ["sh", "gf", "tr"],
        ["sh", "gf", "tr"],
        ["sh", "fl", "tr"],
    ];
    assert_eq!(types, expected, "the topmost shape first");
    let layers = [0, 1].map(|k| film["layers"][k]["ty"].as_u64());
    assert_eq!(layers, [Some(0), Some(1)]);
    assert_eq!(film["assets"][0]["layers"][0]["ty"], 4);
}
