//! Styles of entities: layer, colour, opacity, line weight and line type, their inheritance from
//! layers (BYLAYER) and block references (BYBLOCK, layer 0), and the table of layers.

use super::colours::{BLACK, from_index, from_rgb_bits};
use super::encoding::decode;
use super::error::EntityFault;
use super::record::DxfRecord;
use crate::colour::{Paint, Rgb};
use std::collections::HashMap;
use std::rc::Rc;

/// Attribute of an entity: inherited or explicit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Inheritable<T> {
    /// The value of the layer ("BYLAYER").
    #[default]
    OfLayer,
    /// The value of the enclosing block reference ("BYBLOCK").
    OfBlock,
    /// An explicit value.
    Own(T),
}

impl<T: Clone> Inheritable<T> {
    /// Returns the value, given that of the layer and that of the enclosing block reference.
    fn resolved(&self, of_layer: &T, of_block: &T) -> T {
        match self {
            Self::OfLayer => of_layer.clone(),
            Self::OfBlock => of_block.clone(),
            Self::Own(value) => value.clone(),
        }
    }
}

/// Style of an entity as written in the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct EntityStyle {
    /// Name of the layer.
    pub layer: Rc<[u8]>,
    pub colour: Inheritable<Rgb>,
    pub opacity: Inheritable<f64>,
    /// Line weight in millimetres.
    pub weight: Inheritable<f64>,
    /// Name of the line type, in capitals.
    pub line_type: Inheritable<Rc<[u8]>>,
    /// Whether the entity itself is marked as invisible.
    pub is_invisible: bool,
}

/// Style of an entity after inheritance.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ResolvedStyle {
    /// Name of the layer.
    pub layer: Rc<str>,
    pub paint: Paint,
    /// Line weight in millimetres.
    pub weight: f64,
    /// Name of the line type, in capitals.
    pub line_type: Rc<[u8]>,
    /// Whether the entity is visible: its layer is on and thawed, and it is not marked as
    /// invisible.
    pub is_visible: bool,
    /// Whether the layer is frozen. A block reference on a frozen layer hides its whole block; one
    /// on a layer that is off hides only the block's entities that inherit the layer.
    pub is_frozen: bool,
    /// Whether the entity itself is marked as invisible.
    pub is_invisible: bool,
}

/// Line weight "default" in millimetres (AutoCAD's default of the variable LWDEFAULT).
pub(super) const DEFAULT_WEIGHT: f64 = 0.25;

/// Name of DXF's special layer. An entity on this layer, if it belongs to a block, gets the layer
/// of the block reference.
const OF_BLOCK: &[u8] = b"0";

/// Name of the line type without dashes.
const CONTINUOUS: &[u8] = b"CONTINUOUS";

impl EntityStyle {
    /// Reads the style of an entity. Unreadable values count as missing: the style never makes an
    /// entity unusable.
    pub fn of(record: &DxfRecord) -> Self {
        let integer = |code: i32| record.first(code).and_then(|pair| pair.integer().ok());
        let colour = match (integer(420), integer(62)) {
            (Some(bits), _) => Inheritable::Own(from_rgb_bits(bits)),
            (None, Some(0)) => Inheritable::OfBlock,
            (None, None | Some(256)) => Inheritable::OfLayer,
            (None, Some(number)) => Inheritable::Own(from_index(number)),
        };
        let line_type = record.text(6).to_ascii_uppercase();
        Self {
            layer: match record.text(8) {
                b"" => OF_BLOCK.into(), // entities without a layer are on layer 0
                name => name.into(),
            },
            colour,
            opacity: integer(440).map_or(Inheritable::OfLayer, opacity),
            weight: integer(370).map_or(Inheritable::OfLayer, weight),
            line_type: match &*line_type {
                b"" | b"BYLAYER" => Inheritable::OfLayer,
                b"BYBLOCK" => Inheritable::OfBlock,
                name => Inheritable::Own(name.into()),
            },
            is_invisible: integer(60).is_some_and(|flag| flag != 0),
        }
    }
}

impl EntityStyle {
    /// Returns the style of an attribute that belongs to a block reference: like the entities of
    /// the block, it inherits the layer of the reference on layer 0, and its other attributes where
    /// it says so.
    pub fn of_attribute(self, reference: &Self) -> Self {
        fn inherited<T: Clone>(own: Inheritable<T>, outer: &Inheritable<T>) -> Inheritable<T> {
            match own {
                Inheritable::OfBlock => outer.clone(),
                own => own,
            }
        }
        Self {
            layer: match *self.layer == *OF_BLOCK {
                true => Rc::clone(&reference.layer),
                false => self.layer,
            },
            colour: inherited(self.colour, &reference.colour),
            opacity: inherited(self.opacity, &reference.opacity),
            weight: inherited(self.weight, &reference.weight),
            line_type: inherited(self.line_type, &reference.line_type),
            is_invisible: self.is_invisible,
        }
    }
}

/// Converts a transparency value (group code 440). Its highest byte says whether its lowest byte
/// is an opacity.
fn opacity(bits: i64) -> Inheritable<f64> {
    match (bits >> 24) & 0xff {
        0 => Inheritable::OfLayer,
        1 => Inheritable::OfBlock,
        _ => Inheritable::Own((bits & 0xff) as f64 / 255.0),
    }
}

/// Converts a line weight in hundredths of a millimetre (group code 370).
fn weight(number: i64) -> Inheritable<f64> {
    match number {
        -1 => Inheritable::OfLayer,
        -2 => Inheritable::OfBlock,
        0.. => Inheritable::Own(number.min(MAX_WEIGHT) as f64 / 100.0),
        _ => Inheritable::Own(DEFAULT_WEIGHT),
    }
}

/// Largest line weight in hundredths of a millimetre (DXF Reference).
const MAX_WEIGHT: i64 = 211;

/// Layer of a drawing.
#[derive(Clone, Debug)]
struct DxfLayer {
    name: Rc<str>,
    paint: Paint,
    weight: f64,
    line_type: Rc<[u8]>,
    is_off: bool,
    is_frozen: bool,
}

/// Layers of a drawing. Names of layers are not case-sensitive.
#[derive(Default)]
pub(super) struct LayerTable {
    layers: HashMap<Vec<u8>, DxfLayer>,
}

/// Returns the key of a name that is not case-sensitive.
pub(super) fn name_key(name: &[u8]) -> Vec<u8> {
    name.to_ascii_uppercase()
}

impl LayerTable {
    /// Adds the layer of a record.
    pub fn add(&mut self, record: &DxfRecord) -> Result<(), EntityFault> {
        let number = record.integer_or(62, 7)?;
        let exact = record.first(420).map(|pair| pair.integer()).transpose()?;
        let line_type = record.text(6).to_ascii_uppercase();
        let layer = DxfLayer {
            name: decode(record.text(2)).into(),
            paint: Paint {
                colour: exact.map_or_else(|| from_index(number), from_rgb_bits),
                opacity: layer_opacity(record),
            },
            weight: match weight(record.integer_or(370, -3)?) {
                Inheritable::Own(weight) => weight,
                _ => DEFAULT_WEIGHT,
            },
            line_type: match line_type.is_empty() {
                true => CONTINUOUS.into(),
                false => line_type.into(),
            },
            // A negative colour number means that the layer is off.
            is_off: number < 0,
            is_frozen: record.integer(70)? & 1 != 0,
        };
        self.layers.insert(name_key(record.text(2)), layer);
        Ok(())
    }

    /// Returns the layer with the given name; one that the file does not define is visible and
    /// black.
    fn get(&mut self, name: &[u8]) -> &DxfLayer {
        let undefined = || DxfLayer {
            name: decode(name).into(),
            paint: BLACK.into(),
            weight: DEFAULT_WEIGHT,
            line_type: CONTINUOUS.into(),
            is_off: false,
            is_frozen: false,
        };
        self.layers.entry(name_key(name)).or_insert_with(undefined)
    }

    /// Resolves the style of an entity. `outer` is the style of the enclosing block reference, or
    /// `None` for an entity outside of blocks.
    pub fn resolve(&mut self, style: &EntityStyle, outer: Option<&ResolvedStyle>) -> ResolvedStyle {
        let inherits_layer = *style.layer == *OF_BLOCK;
        let own = self.get(&style.layer).clone();
        let layer = match outer {
            Some(outer) if inherits_layer => self.get(outer.layer.as_bytes()).clone(),
            _ => own,
        };
        let none = ResolvedStyle {
            layer: Rc::clone(&layer.name),
            paint: BLACK.into(),
            weight: DEFAULT_WEIGHT,
            line_type: CONTINUOUS.into(),
            is_visible: true,
            is_frozen: false,
            is_invisible: false,
        };
        let outer = outer.unwrap_or(&none);
        let of_block = &outer.paint;
        ResolvedStyle {
            paint: Paint {
                colour: (style.colour).resolved(&layer.paint.colour, &of_block.colour),
                opacity: (style.opacity).resolved(&layer.paint.opacity, &of_block.opacity),
            },
            weight: style.weight.resolved(&layer.weight, &outer.weight),
            line_type: style.line_type.resolved(&layer.line_type, &outer.line_type),
            is_visible: !(layer.is_off || layer.is_frozen || style.is_invisible),
            is_frozen: layer.is_frozen,
            is_invisible: style.is_invisible,
            layer: layer.name,
        }
    }
}

/// Attributes of a style that show in the drawing, comparable bit by bit.
pub(super) type StyleKey = (Rc<str>, [u8; 3], u64, u64, Rc<[u8]>);

impl ResolvedStyle {
    /// Returns the key of the style.
    pub fn key(&self) -> StyleKey {
        let bits = |number: f64| number.to_bits();
        (
            Rc::clone(&self.layer),
            self.paint.colour.0,
            bits(self.paint.opacity),
            bits(self.weight),
            Rc::clone(&self.line_type),
        )
    }

    /// Returns whether lines of this style have dashes or symbols.
    pub fn is_dashed(&self) -> bool {
        *self.line_type != *CONTINUOUS
    }
}

/// Returns the opacity of a layer, which is stored as extended data of the application
/// `AcCmTransparency`.
fn layer_opacity(record: &DxfRecord) -> f64 {
    let mut pairs = record.pairs.iter();
    let is_start = |text: &[u8]| text.eq_ignore_ascii_case(b"AcCmTransparency");
    let _start = pairs.find(|pair| pair.code == 1001 && is_start(pair.text()));
    let value = pairs.find(|pair| pair.code == 1071);
    match value.and_then(|pair| pair.integer().ok()).map(opacity) {
        Some(Inheritable::Own(value)) => value,
        _ => 1.0,
    }
}
