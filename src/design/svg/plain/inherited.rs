//! Style and attributes that an element of a plain drawing takes over from its surroundings.

use crate::design::svg::css::math::LengthContext;
use crate::design::svg::css::variables::Variables;
use crate::geometry::DVec2;
use std::collections::BTreeMap;
use std::rc::Rc;
use usvg::roxmltree::Node;

/// Font size of browsers for text without one, in user units.
const DEFAULT_FONT_SIZE: f64 = 16.0;

/// Size of the page of a drawing that gives none (CSS 2, section 10.3.2).
const DEFAULT_PAGE: DVec2 = DVec2::new(300.0, 150.0);

/// Values that an element inherits from its surroundings.
#[derive(Clone)]
pub(super) struct InheritedStyle {
    pub variables: Variables,
    pub lengths: LengthContext,
    /// Value of `color`.
    pub colour: String,
    /// Value of `text-transform`.
    pub text_transform: String,
    pub is_in_clip_path: bool,
    pub is_in_text: bool,
    /// Number of the copy (`use`) that the element belongs to; 0 outside of copies.
    pub copy: u32,
}

impl InheritedStyle {
    /// Returns the values outside of the root element.
    pub fn initial(root: Node) -> Self {
        let page = page_size(root);
        Self {
            variables: Rc::new(BTreeMap::new()),
            lengths: LengthContext {
                font_size: DEFAULT_FONT_SIZE,
                root_font_size: DEFAULT_FONT_SIZE,
                viewport: page,
                page,
            },
            colour: "black".to_owned(),
            text_transform: String::new(),
            is_in_clip_path: false,
            is_in_text: false,
            copy: 0,
        }
    }
}

/// Returns the size of the page of a drawing: that of its view box, or its width and height.
fn page_size(root: Node) -> DVec2 {
    let length = |name| {
        let text = root.attribute(name).unwrap_or_default();
        let number = text.trim().trim_end_matches("px").parse::<f64>().ok();
        number.filter(|number| *number > 0.0 && number.is_finite())
    };
    view_box_size(root).unwrap_or(DVec2::new(
        length("width").unwrap_or(DEFAULT_PAGE.x),
        length("height").unwrap_or(DEFAULT_PAGE.y),
    ))
}

/// Returns the width and height of the view box of an element.
pub(super) fn view_box_size(node: Node) -> Option<DVec2> {
    let numbers = node.attribute("viewBox")?;
    let numbers = numbers
        .split([' ', ',', '\n', '\t', '\r'])
        .filter(|part| !part.is_empty());
    let numbers: Vec<f64> = numbers.filter_map(|part| part.parse().ok()).collect();
    match numbers.as_slice() {
        &[_, _, w, h] if w > 0.0 && h > 0.0 && (w + h).is_finite() => Some(DVec2::new(w, h)),
        _ => None,
    }
}

/// Attributes that replace those of an element in a copy.
#[derive(Default)]
pub(super) struct Overrides {
    /// Name under which the element is written, if not its own.
    pub tag: Option<&'static str>,
    /// Attributes with their values; empty values remove the attribute.
    pub attributes: Vec<(&'static str, String)>,
}

impl Overrides {
    pub fn get(&self, name: &str) -> Option<&str> {
        let mut attributes = self.attributes.iter();
        let found = attributes.find(|(known, _)| *known == name);
        found.map(|(_, value)| value.as_str())
    }
}
