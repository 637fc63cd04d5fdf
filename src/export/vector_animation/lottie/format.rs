//! Objects of the Lottie format.
//!
//! Guarantees: the keys of each object are written in the order of the fields, which is that of
//! Bodymovin, with the type `ty` first in each shape. Players that parse a file in one pass
//! (rlottie, lottie-android) need to know the type of a shape before its other keys, and the number
//! of colour stops of a gradient before its colours; they skip a shape whose keys come in another
//! order.

use serde::Serialize;
use serde_json::Number;

use crate::io::escape::json_text;

/// A whole animation.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieDocument {
    pub v: &'static str,
    pub fr: f64,
    pub ip: usize,
    pub op: usize,
    pub w: u32,
    pub h: u32,
    pub nm: String,
    pub ddd: u8,
    pub assets: Vec<LottieComposition>,
    pub layers: Vec<LottieLayer>,
}

impl LottieDocument {
    /// Returns the text of the file.
    pub(super) fn text(&self) -> String {
        json_text(self)
    }
}

/// A composition that layers refer to (precomposition).
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieComposition {
    pub id: &'static str,
    pub nm: String,
    pub fr: f64,
    pub layers: Vec<LottieLayer>,
}

/// A layer. Its keys are `ddd`, `ind` and `ty`, then those of its content, then its period.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieLayer {
    pub ddd: u8,
    pub ind: usize,
    pub ty: u8,
    pub nm: String,
    pub sr: u8,
    pub ks: LottieTransform,
    #[serde(flatten)]
    pub content: LayerContent,
    pub ip: Number,
    pub op: Number,
    pub st: u8,
    pub bm: u8,
}

/// Content of a layer, which depends on its type `ty`.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(super) enum LayerContent {
    /// A composition (`ty` 0), with its time remapped.
    #[serde(rename_all = "camelCase")]
    Composition {
        ref_id: &'static str,
        tm: LottieProperty,
        w: u32,
        h: u32,
    },
    /// A rectangle in one colour (`ty` 1).
    Solid { sc: String, sw: u32, sh: u32 },
    /// Shapes, the topmost first (`ty` 4).
    Shapes { shapes: Vec<LottieShape> },
}

impl LayerContent {
    /// Returns the type of the layer.
    pub(super) fn layer_type(&self) -> u8 {
        match self {
            Self::Composition { .. } => 0,
            Self::Solid { .. } => 1,
            Self::Shapes { .. } => 4,
        }
    }
}

/// Transform of a layer or of a group of shapes.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieTransform {
    pub p: LottieProperty,
    pub a: LottieProperty,
    pub s: LottieProperty,
    pub r: LottieProperty,
    pub o: LottieProperty,
}

/// An element of a list of shapes. Its type is the first key.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "ty")]
pub(super) enum LottieShape {
    #[serde(rename = "gr")]
    Group {
        it: Vec<LottieShape>,
        #[serde(skip_serializing_if = "Option::is_none")]
        nm: Option<String>,
    },
    #[serde(rename = "sh")]
    Path { ks: LottieProperty },
    #[serde(rename = "el")]
    Ellipse {
        d: u8,
        p: LottieProperty,
        s: LottieProperty,
    },
    #[serde(rename = "fl")]
    Fill {
        c: LottieProperty,
        o: LottieProperty,
        r: u8,
    },
    #[serde(rename = "gf")]
    GradientFill {
        o: LottieProperty,
        r: u8,
        g: LottieColours,
        s: LottieProperty,
        e: LottieProperty,
        t: u8,
        #[serde(skip_serializing_if = "Option::is_none")]
        h: Option<LottieProperty>,
        #[serde(skip_serializing_if = "Option::is_none")]
        a: Option<LottieProperty>,
    },
    #[serde(rename = "st")]
    Stroke {
        c: LottieProperty,
        o: LottieProperty,
        w: LottieProperty,
        lc: u8,
        lj: u8,
        #[serde(skip_serializing_if = "Option::is_none")]
        ml: Option<f64>,
    },
    #[serde(rename = "tr")]
    Transform(LottieTransform),
}

/// Colour stops of a gradient.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieColours {
    /// Number of colour stops.
    pub p: usize,
    /// Offsets and colours, then offsets and opacities.
    pub k: LottieProperty,
}

/// A property: a constant value, or keyframes.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieProperty {
    /// 1 if the property has keyframes, otherwise 0.
    a: u8,
    k: PropertyContent,
}

#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
enum PropertyContent {
    Still(LottieValue),
    Moving(Vec<LottieKeyframe>),
}

impl LottieProperty {
    /// Returns a constant property.
    pub(super) fn still(value: LottieValue) -> Self {
        Self {
            a: 0,
            k: PropertyContent::Still(value),
        }
    }

    /// Returns a property with keyframes.
    pub(super) fn moving(keyframes: Vec<LottieKeyframe>) -> Self {
        Self {
            a: 1,
            k: PropertyContent::Moving(keyframes),
        }
    }
}

/// A keyframe. The last keyframe, and keyframes whose value lasts until the next one, have no
/// handles.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieKeyframe {
    #[serde(skip_serializing_if = "Option::is_none")]
    i: Option<LottieHandle>,
    #[serde(skip_serializing_if = "Option::is_none")]
    o: Option<LottieHandle>,
    /// 1 if the value lasts until the next keyframe, without interpolation.
    #[serde(skip_serializing_if = "Option::is_none")]
    h: Option<u8>,
    t: Number,
    s: LottieValue,
}

impl LottieKeyframe {
    /// Returns the keyframe at a time in frames. `handles` are the handles of the easing curve to
    /// the next keyframe: the one that leaves this keyframe, and the one that enters the next.
    pub(super) fn new(
        time: Number,
        value: LottieValue,
        handles: Option<[LottieHandle; 2]>,
    ) -> Self {
        let (out, into) = handles.map_or((None, None), |[out, into]| (Some(out), Some(into)));
        Self {
            i: into,
            o: out,
            h: None,
            t: time,
            s: value.listed(),
        }
    }

    /// Returns a keyframe whose value lasts until the next keyframe.
    pub(super) fn hold(time: Number, value: LottieValue) -> Self {
        Self {
            h: Some(1),
            ..Self::new(time, value, None)
        }
    }
}

/// Handle of an easing curve.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottieHandle {
    x: [Number; 1],
    y: [Number; 1],
}

impl LottieHandle {
    pub(super) fn new(x: Number, y: Number) -> Self {
        Self { x: [x], y: [y] }
    }
}

/// Value of a property.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub(super) enum LottieValue {
    Number(Number),
    Numbers(Vec<Number>),
    Path(LottiePath),
    /// A path in a keyframe, where the format has a list with one path.
    Paths([LottiePath; 1]),
}

impl LottieValue {
    /// Returns the value as a keyframe stores it: always as a list.
    fn listed(self) -> Self {
        match self {
            Self::Number(number) => Self::Numbers(vec![number]),
            Self::Path(path) => Self::Paths([path]),
            listed => listed,
        }
    }
}

/// A path: its vertices, and their handles relative to them.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LottiePath {
    pub i: Vec<[Number; 2]>,
    pub o: Vec<[Number; 2]>,
    pub v: Vec<[Number; 2]>,
    pub c: bool,
}

/// Rounds to the given number of decimals; whole numbers become integers.
pub(super) fn round_number(x: f64, decimals: i32) -> Number {
    let scale = 10f64.powi(decimals);
    let x = (x * scale).round() / scale;
    match Number::from_f64(x) {
        Some(number) if x.fract() != 0.0 || x.abs() >= 1e15 => number,
        // Recorded coordinates are finite, so nothing is lost here.
        _ => Number::from(x as i64),
    }
}
