//! Refuses drawings that would expand into too many elements, before they are expanded.
//!
//! `usvg` copies the targets of `use`, patterns, clip paths and masks, so a file of a few hundred
//! bytes can expand into 10^10 elements. This module counts the elements, including all copies, in
//! one pass over the graph of references. The pass visits every element once and copies nothing.
//!
//! The count is an upper bound: a target that `usvg` caches is nevertheless counted once per
//! reference, and a marker once per corner of all shapes that inherit it. Filters are not counted,
//! because they are not drawn.

use super::css::cascade::StyleCascade;
use super::css::syntax::read_declarations;
use super::css::variables::has_references;
use super::error::{MAX_DEPTH, MAX_ELEMENTS, SvgError};
use std::collections::{HashMap, HashSet};
use usvg::roxmltree::{Document, Node, NodeId};

/// Maximum estimated time for laying out all text, in microseconds (resource limit: 2 s).
const MAX_TEXT: u64 = 2_000_000;

/// References, as pairs of an element and its target, that make an element refer to itself.
pub(super) type BrokenReferences = HashSet<(NodeId, NodeId)>;

/// Result of [`check_expansion`].
pub(super) struct ExpansionReport {
    /// Whether the text of the drawing is short enough to be laid out.
    pub has_short_text: bool,
    /// References without which the elements of the drawing form a tree.
    pub broken: BrokenReferences,
}

/// Checks the expanded size and depth of a drawing. `ids` holds the first element with each id.
pub(super) fn check_expansion<'d, 'a>(
    document: &'d Document<'a>,
    ids: &HashMap<&'d str, Node<'d, 'a>>,
    cascade: &StyleCascade,
) -> Result<ExpansionReport, SvgError> {
    let mut counter = ExpansionCounter {
        document,
        ids,
        references: ElementReferences::new(document, cascade),
        sizes: HashMap::new(),
        broken: HashSet::new(),
        longest_font_list: longest_font_list(document),
    };
    let size = counter.expanded_size(document.root_element(), 0)?;
    Ok(ExpansionReport {
        has_short_text: size.text <= MAX_TEXT,
        broken: counter.broken,
    })
}

/// Returns the length in bytes of the longest list of fonts in the drawing. `usvg` parses this list
/// for every span of text.
fn longest_font_list(document: &Document) -> u64 {
    let elements = document.descendants();
    let attributes = elements.clone().flat_map(|node| node.attributes());
    let sheets = elements.filter(|node| node.tag_name().name() == "style");
    let declarations = sheets
        .flat_map(|node| node.children())
        .filter_map(|node| node.text());
    let named = attributes
        .filter(|a| a.name().starts_with("font"))
        .map(|a| a.value());
    let styles = document
        .descendants()
        .filter_map(|node| node.attribute("style"));
    let declared = declarations.chain(styles);
    let declared = declared.flat_map(|text| text.split([';', '{', '}']));
    let declared = declared.filter(|text| text.trim_start().starts_with("font"));
    named.chain(declared).map(str::len).max().unwrap_or(0) as u64
}

/// Finds the references of elements to others: those in attributes and those in style sheets.
struct ElementReferences<'c, 's> {
    cascade: &'c StyleCascade<'s>,
    /// Ids in the values of custom properties, which any element with variables may refer to.
    variable: Vec<String>,
}

/// Kind of a reference.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ReferenceKind {
    /// The target is drawn once.
    Once,
    /// The target is drawn at each corner of the shapes in the element.
    Marker,
}

impl<'c, 's> ElementReferences<'c, 's> {
    fn new(document: &Document, cascade: &'c StyleCascade<'s>) -> Self {
        let styles = document
            .descendants()
            .filter_map(|node| node.attribute("style"));
        let styles = styles.flat_map(|style| read_declarations(style).0);
        let custom = styles.chain(cascade.custom_declarations().cloned());
        let custom = custom.filter(|declaration| declaration.name.starts_with("--"));
        Self {
            cascade,
            variable: custom
                .flat_map(|d| urls(&d.value).map(str::to_owned).collect::<Vec<_>>())
                .collect(),
        }
    }

    /// Returns the ids that an element refers to.
    fn of(&self, node: Node) -> Vec<(ReferenceKind, String)> {
        let kind = |name: &str| match name.starts_with("marker") {
            true => ReferenceKind::Marker,
            false => ReferenceKind::Once,
        };
        let mut found = Vec::new();
        // The `href` of a link or an image makes no copies.
        let copies_href = matches!(
            node.tag_name().name(),
            "use" | "pattern" | "mask" | "clipPath" | "linearGradient" | "radialGradient"
        );
        for attribute in node.attributes() {
            let value = attribute.value();
            let is_href = copies_href && attribute.name() == "href";
            let direct = is_href.then(|| value.trim().strip_prefix('#')).flatten();
            let named = direct.into_iter().chain(urls(value));
            found.extend(named.map(|id| (kind(attribute.name()), id.to_owned())));
        }
        for declaration in self.cascade.declarations(node) {
            let named = urls(&declaration.value).map(|id| (kind(&declaration.name), id.to_owned()));
            found.extend(named);
            if has_references(&declaration.value) && !declaration.name.starts_with("--") {
                let variable = self.variable.iter();
                found.extend(variable.map(|id| (kind(&declaration.name), id.clone())));
            }
        }
        // An element refers to each target once, by an attribute or by style.
        found.sort_by(|(a, first), (b, second)| {
            first
                .cmp(second)
                .then((*b == ReferenceKind::Marker).cmp(&(*a == ReferenceKind::Marker)))
        });
        found.dedup_by(|(_, a), (_, b)| a == b);
        found
    }
}

/// Returns the ids in all `url(#…)` of a value.
fn urls(value: &str) -> impl Iterator<Item = &str> {
    let starts = value.match_indices('(').filter(|(at, _)| {
        value.as_bytes()[..*at]
            .last_chunk::<3>()
            .is_some_and(|name| name.eq_ignore_ascii_case(b"url"))
    });
    starts.filter_map(|(at, _)| {
        let inner = value[at + 1..].split(')').next()?;
        inner.trim().trim_matches(['"', '\'']).strip_prefix('#')
    })
}

/// Size of an element after expansion.
#[derive(Clone, Copy)]
struct ExpandedSize {
    /// Number of elements, including copies and the element itself.
    elements: u64,
    /// Number of nesting levels, including copies and the level of the element itself.
    levels: u32,
    /// Estimated time for laying out the text of the element, in microseconds.
    text: u64,
    /// Upper bound of the number of corners of all shapes, at which markers are drawn.
    corners: u64,
}

/// Counter of expanded sizes; computes the size of each element only once.
struct ExpansionCounter<'c, 's, 'd, 'a> {
    document: &'d Document<'a>,
    /// First element with each id.
    ids: &'c HashMap<&'d str, Node<'d, 'a>>,
    references: ElementReferences<'c, 's>,
    /// Sizes computed so far; `None` for elements in progress.
    sizes: HashMap<NodeId, Option<ExpandedSize>>,
    broken: BrokenReferences,
    /// Length in bytes of the longest list of fonts in the drawing.
    longest_font_list: u64,
}

impl<'d, 'a> ExpansionCounter<'_, '_, 'd, 'a> {
    /// Returns the expanded size of an element with its children and the targets of its references.
    /// Recurses at most [`MAX_DEPTH`] levels. The element must not be in progress.
    fn expanded_size(&mut self, node: Node<'d, 'a>, depth: u32) -> Result<ExpandedSize, SvgError> {
        let document = self.document;
        let line = || document.text_pos_at(node.range().start).row;
        match self.sizes.get(&node.id()) {
            Some(&Some(size)) if depth + size.levels <= MAX_DEPTH => return Ok(size),
            None if depth <= MAX_DEPTH => {}
            _ => return Err(SvgError::TooDeep(line())),
        }
        self.sizes.insert(node.id(), None);
        let mut size = ExpandedSize {
            // Gradients draw nothing; they are visited because they may refer to each other.
            elements: match node.tag_name().name() {
                "linearGradient" | "radialGradient" | "stop" => 0,
                _ => 1,
            },
            levels: 1,
            text: match node.tag_name().name() {
                "text" => self.cost_of_text(node),
                _ => 0,
            },
            corners: corners(node),
        };
        for child in node.children().filter(Node::is_element) {
            let inner = self.expanded_size(child, depth + 1)?;
            size.add(inner, 1);
        }
        for (kind, id) in self.references.of(node) {
            let Some(target) = self.expanded_target(&id) else {
                continue;
            };
            // Reaching an element again while it is in progress means a circular reference.
            if self.sizes.get(&target.id()).is_some_and(Option::is_none) {
                self.broken.insert((node.id(), target.id()));
                continue;
            }
            let inner = self.expanded_size(target, depth + 1)?;
            let corners = size.corners;
            size.add(
                inner,
                if kind == ReferenceKind::Marker {
                    corners
                } else {
                    1
                },
            );
        }
        if size.elements > MAX_ELEMENTS {
            return Err(SvgError::TooManyElements(line()));
        }
        self.sizes.insert(node.id(), Some(size));
        Ok(size)
    }

    /// Estimates the time, in microseconds, for laying out a text element: `usvg` shapes the whole
    /// text once per span and searches all letters for each letter.
    fn cost_of_text(&self, text: Node) -> u64 {
        let nodes = || text.descendants();
        let letters: usize = nodes().filter_map(|node| node.text()).map(str::len).sum();
        let (letters, spans) = (letters as u64, nodes().count() as u64);
        let shaped = letters.saturating_mul(spans + letters / 1000);
        shaped.saturating_add(spans.saturating_mul(self.longest_font_list) / 10)
    }

    /// Returns the element with an id, unless it is of a type that is never expanded.
    fn expanded_target(&self, id: &str) -> Option<Node<'d, 'a>> {
        let to = *self.ids.get(id)?;
        // Filters are not drawn.
        (to.tag_name().name() != "filter").then_some(to)
    }
}

impl ExpandedSize {
    /// Adds `count` copies of a part.
    fn add(&mut self, part: Self, count: u64) {
        let many = |n: u64| n.saturating_mul(count);
        self.elements = self.elements.saturating_add(many(part.elements));
        self.levels = self.levels.max(part.levels + 1);
        self.text = self.text.saturating_add(many(part.text));
        self.corners = self.corners.saturating_add(many(part.corners));
    }
}

/// Returns an upper bound of the number of corners of one shape: half of the numbers in its
/// coordinates.
fn corners(node: Node) -> u64 {
    let numbers = |name| {
        let text = node.attribute(name).unwrap_or_default().as_bytes();
        let starts = text
            .windows(2)
            .filter(|w| !w[0].is_ascii_digit() && w[1].is_ascii_digit());
        starts.count() as u64
    };
    match node.tag_name().name() {
        "path" => 2 + numbers("d"),
        "polygon" | "polyline" => 2 + numbers("points") / 2,
        "rect" | "circle" | "ellipse" | "line" => 9,
        _ => 0,
    }
}
