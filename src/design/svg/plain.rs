//! Rewrites a drawing with plain attributes, in the subset of SVG that `usvg` draws as browsers do.
//!
//! Style sheets, style attributes, variables, CSS transforms and geometry properties become
//! attributes; copies (`use`) are expanded, so that every drawn element keeps its identity; symbols
//! become nested drawings. Ids are replaced by the numbers of the elements in the source document
//! (see [`plain_id`]). Everything that the result lacks is reported.

mod attributes;
mod clip_shapes;
mod copies;
mod element_style;
mod inherited;
mod kinds;

use super::css::cascade::StyleCascade;
use super::error::{MAX_ELEMENTS, SvgError};
use super::expansion_limits::BrokenReferences;
use super::lost_features::{LostFeatures, element_label};
use crate::geometry::Bounds;
pub(super) use attributes::href;
use element_style::ElementStyle;
use inherited::{InheritedStyle, Overrides};
use kinds::ElementKind;
use std::collections::{HashMap, HashSet};
use std::rc::Rc;
use usvg::roxmltree::{Document, Node, NodeId};

/// Maximum length of the rewritten drawing, in bytes (resource limit: some 500 bytes for each of
/// the largest number of elements).
const MAX_TEXT: usize = 100_000_000;

/// Treatment of unsupported elements for which a `switch` offers other content.
const FALLBACK: &str = "replaced by the other content of its <switch>";

/// Drawing with plain attributes.
pub(super) struct PlainDrawing {
    /// XML text.
    pub text: String,
    /// Elements whose strokes keep their width when the drawing is scaled.
    pub non_scaling: HashSet<NodeId>,
    /// Colour of the page in the notation of plain attributes, if the root element has one.
    pub background: Option<String>,
    /// Whether the transform of an element refers to its own box, which is not known yet.
    pub lacks_boxes: bool,
}

/// Boxes of elements in their own coordinates, which some transforms and clip paths refer to.
pub(super) type ElementBoxes = HashMap<NodeId, ElementBox>;

/// Bounding boxes of an element.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementBox {
    pub fill: Bounds,
    /// Box that includes the stroke.
    pub stroke: Bounds,
}

/// Sources from which a drawing is rewritten.
pub(super) struct PlainSources<'s, 'c, 'd, 'a> {
    pub document: &'d Document<'a>,
    /// First element with each id.
    pub ids: &'s HashMap<&'d str, Node<'d, 'a>>,
    pub cascade: &'s StyleCascade<'c>,
    /// References that make an element refer to itself.
    pub broken: &'s BrokenReferences,
    /// Boxes measured so far.
    pub boxes: &'s ElementBoxes,
}

/// Rewrites a drawing.
///
/// # Errors
/// Returns an error if copies expand into too many elements or the style sheet takes too long.
pub(super) fn plain_drawing(
    sources: &PlainSources,
    lost: &mut LostFeatures,
) -> Result<PlainDrawing, SvgError> {
    let mut writer = PlainWriter {
        sources,
        lost,
        drawing: PlainDrawing {
            text: String::new(),
            non_scaling: HashSet::new(),
            background: None,
            lacks_boxes: false,
        },
        definitions: String::new(),
        copies: HashMap::new(),
        open_copies: Vec::new(),
        elements: 0,
        cached_styles: HashMap::new(),
    };
    let root = sources.document.root_element();
    writer.element(root, &InheritedStyle::initial(root), &Overrides::default())?;
    if sources.cascade.is_exhausted() {
        return Err(SvgError::TooMuchStyle(writer.elements as usize));
    }
    Ok(writer.drawing)
}

/// Returns the id of a copy of an element in the plain drawing. The original is copy 0.
fn plain_id(element: NodeId, copy: u32) -> String {
    match copy {
        0 => format!("n{}", element.get()),
        copy => format!("n{}-{copy}", element.get()),
    }
}

/// Returns the element of the source document that an id of the plain drawing belongs to.
pub(super) fn source_element(id: &str) -> Option<NodeId> {
    let number = id.strip_prefix('n')?;
    let number = number.split('-').next()?;
    number.parse().ok().map(NodeId::new)
}

/// Writer of a plain drawing.
struct PlainWriter<'p, 'c, 'd, 'a> {
    sources: &'p PlainSources<'p, 'c, 'd, 'a>,
    lost: &'p mut LostFeatures,
    drawing: PlainDrawing,
    /// Elements that the drawing refers to and the source does not have.
    definitions: String,
    /// Number of copies written of each element.
    copies: HashMap<NodeId, u32>,
    /// Copies in progress.
    open_copies: Vec<NodeId>,
    /// Number of elements written.
    elements: u64,
    cached_styles: HashMap<NodeId, Rc<[super::css::syntax::Declaration]>>,
}

impl<'d, 'a> PlainWriter<'_, '_, 'd, 'a> {
    /// Writes an element with its content.
    fn element(
        &mut self,
        node: Node<'d, 'a>,
        inherited: &InheritedStyle,
        overrides: &Overrides,
    ) -> Result<(), SvgError> {
        let name = node.tag_name().name();
        match ElementKind::of(node) {
            ElementKind::Drawn => {}
            ElementKind::Copy if inherited.is_in_clip_path => {}
            ElementKind::Copy => return self.copy(node, inherited),
            ElementKind::Invisible => return Ok(()),
            ElementKind::Animation => {
                // The element that is animated carries the note.
                let target = node.parent_element().unwrap_or(node);
                self.lost.ignore("animation", &element_label(target));
                return Ok(());
            }
            ElementKind::Unsupported => {
                match kinds::has_fallback(node) {
                    true => self.lost.replace(name, FALLBACK, &element_label(node)),
                    false => self.lost.ignore(name, &element_label(node)),
                }
                return Ok(());
            }
        }
        self.count(node)?;
        let tag = overrides
            .tag
            .unwrap_or(if name == "a" && !inherited.is_in_text {
                "g"
            } else {
                name
            });
        let style = self.style(node, inherited, overrides);
        let is_root = node.parent_element().is_none();
        self.open_tag(node, tag, &style, inherited, overrides);
        let content = style.inherited_by_content(node, tag, inherited, overrides);
        self.content(node, &content)?;
        if is_root && !self.definitions.is_empty() {
            let definitions = std::mem::take(&mut self.definitions);
            self.drawing.text += &format!("<defs>{definitions}</defs>");
        }
        self.close_tag(tag);
        Ok(())
    }

    /// Writes the children of an element.
    fn content(&mut self, node: Node<'d, 'a>, inherited: &InheritedStyle) -> Result<(), SvgError> {
        for child in node.children() {
            if child.is_element() {
                self.element(child, inherited, &Overrides::default())?;
            } else if let (true, Some(text)) =
                (inherited.is_in_text && child.is_text(), child.text())
            {
                let text = transformed_text(text, &inherited.text_transform);
                push_escaped(&mut self.drawing.text, &text);
            }
        }
        Ok(())
    }

    /// Counts an element against the limits.
    fn count(&mut self, node: Node) -> Result<(), SvgError> {
        self.elements += 1;
        match self.elements > MAX_ELEMENTS || self.drawing.text.len() > MAX_TEXT {
            true => {
                let position = node.document().text_pos_at(node.range().start);
                Err(SvgError::TooManyElements(position.row))
            }
            false => Ok(()),
        }
    }

    fn close_tag(&mut self, tag: &str) {
        self.drawing.text += &format!("</{tag}>");
    }

    /// Computes the values of the properties of an element.
    fn style(
        &mut self,
        node: Node,
        inherited: &InheritedStyle,
        overrides: &Overrides,
    ) -> ElementStyle {
        let declarations = self.declarations(node);
        ElementStyle::of(&declarations, node, inherited, overrides, self.lost)
    }

    /// Returns the declarations that apply to an element, in ascending precedence.
    fn declarations(&mut self, node: Node) -> Rc<[super::css::syntax::Declaration]> {
        let cascade = self.sources.cascade;
        let cached = self.cached_styles.entry(node.id());
        Rc::clone(cached.or_insert_with(|| cascade.declarations(node).into()))
    }
}

/// Applies `text-transform` to a text.
fn transformed_text(text: &str, transform: &str) -> String {
    match transform {
        "uppercase" => text.to_uppercase(),
        "lowercase" => text.to_lowercase(),
        "capitalize" => {
            let mut is_start = true;
            let capital = |c: char| {
                let upper = std::mem::replace(&mut is_start, c.is_whitespace());
                match upper {
                    true => c.to_uppercase().collect::<String>(),
                    false => c.to_string(),
                }
            };
            text.chars().map(capital).collect()
        }
        _ => text.to_owned(),
    }
}

/// Appends a text to an XML document.
fn push_escaped(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' => out.push_str("&#10;"),
            '\r' => out.push_str("&#13;"),
            '\t' => out.push_str("&#9;"),
            c => out.push(c),
        }
    }
}
