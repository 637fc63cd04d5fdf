//! Refuses drawings that would expand into too many elements, before they are expanded.
//!
//! `usvg` copies the targets of `use`, patterns, clip paths and masks, so a file of a few hundred
//! bytes can expand into 10^10 elements. This module counts the elements, including all copies, in
//! one pass over the graph of references. The pass visits every element once and copies nothing.
//!
//! The count is an upper bound: a target that `usvg` caches is nevertheless counted once per
//! reference. Markers and filters are not counted, because [`STYLE`] disables them.

use super::error::{MAX_DEPTH, MAX_ELEMENTS, SvgError};
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node};

/// Style sheet that disables markers and filters in every drawing. They do not change the
/// filled area, but could expand exponentially.
pub(super) const STYLE: &str = "* { marker: none !important; filter: none !important }";

/// Maximum product of the number of style rules and the number of elements (resource limit: every
/// rule is tested against every element).
const MAX_STYLE_TESTS: usize = 50_000_000;

/// Maximum estimated time for laying out all text, in microseconds (resource limit: 2 s).
const MAX_TEXT: u64 = 2_000_000;

/// Checks the expanded size and depth, circular references and the cost of the style sheet. Returns
/// whether the text of the drawing is short enough to be laid out.
pub(super) fn check_expansion(document: &Document) -> Result<bool, SvgError> {
    let sheet = StyleReferences::of(document);
    let elements = document.descendants().filter(Node::is_element).count();
    if sheet.rules.saturating_mul(elements) > MAX_STYLE_TESTS {
        return Err(SvgError::TooMuchStyle(elements));
    }
    let mut ids = HashMap::new();
    for node in document.descendants() {
        if let Some(id) = node.attribute("id") {
            ids.entry(id).or_insert(node);
        }
    }
    let mut counter = ExpansionCounter {
        document,
        ids,
        sheet,
        sizes: HashMap::new(),
        longest_font_list: longest_font_list(document),
    };
    let size = counter.expanded_size(document.root_element(), 0)?;
    Ok(size.text <= MAX_TEXT)
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

/// References to ids (`url(#id)`) that style sheets add to elements.
struct StyleReferences<'d> {
    /// Upper bound of the number of rules in all style sheets.
    rules: usize,
    /// Maps the last name of a selector (a class, an element or an id) to the ids that are referred
    /// to by the rules with this selector.
    references: HashMap<&'d str, Vec<&'d str>>,
}

impl<'d> StyleReferences<'d> {
    /// Reads all style sheets of a document.
    fn of(document: &'d Document) -> Self {
        let mut sheet = Self {
            rules: 1, // the one in STYLE
            references: HashMap::new(),
        };
        let styles = document
            .descendants()
            .filter(|n| n.tag_name().name() == "style");
        for text in styles.flat_map(|n| n.children()).filter_map(|n| n.text()) {
            // This count is an upper bound, because declarations also contain commas.
            sheet.rules += text.matches(['{', ',']).count();
            sheet.read(text);
        }
        sheet
    }

    /// Adds the ids to which the rules of one style sheet refer.
    fn read(&mut self, text: &'d str) {
        for rule in text.split('}') {
            let Some((selectors, body)) = rule.rsplit_once('{') else {
                continue;
            };
            let ids: Vec<&str> = urls(body).collect();
            if ids.is_empty() {
                continue;
            }
            for selector in selectors.split(',') {
                let name = last_name(selector);
                self.references.entry(name).or_default().extend(&ids);
            }
        }
    }

    /// Returns the ids that style sheets make an element refer to.
    fn of_node<'s>(&'s self, node: Node<'s, '_>) -> impl Iterator<Item = &'d str> + 's {
        let classes = node.attribute("class").unwrap_or_default();
        classes
            .split_whitespace()
            .chain([node.tag_name().name(), "*"])
            .chain(node.attribute("id"))
            .filter_map(|name| self.references.get(name))
            .flatten()
            .copied()
    }
}

/// Returns the last name of a selector (`thin` for `g > path.thin`), or `*` if the selector is too
/// complex to look up.
fn last_name(selector: &str) -> &str {
    let selector = selector.trim();
    if selector.contains([':', '\\']) {
        return "*"; // pseudo-classes and escapes are assumed to match every element
    }
    let is_name_char = |c: char| c.is_alphanumeric() || c == '_' || c == '-' || !c.is_ascii();
    let start = selector.rfind(|c| !is_name_char(c)).map_or(0, |i| i + 1);
    match &selector[start..] {
        "" => "*",
        name => name,
    }
}

/// Returns the ids in all `url(#id)` of a text.
fn urls(text: &str) -> impl Iterator<Item = &str> {
    text.split("url(").skip(1).filter_map(|rest| {
        let id = rest.split(')').next()?;
        id.trim_matches(|c: char| c.is_whitespace() || c == '"' || c == '\'')
            .strip_prefix('#')
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
}

/// Counter of expanded sizes; computes the size of each element only once.
struct ExpansionCounter<'d, 'a> {
    document: &'d Document<'a>,
    /// First element with each id.
    ids: HashMap<&'d str, Node<'d, 'a>>,
    sheet: StyleReferences<'d>,
    /// Sizes computed so far; `None` for elements in progress.
    sizes: HashMap<usvg::roxmltree::NodeId, Option<ExpandedSize>>,
    /// Length in bytes of the longest list of fonts in the drawing.
    longest_font_list: u64,
}

impl<'d, 'a> ExpansionCounter<'d, 'a> {
    /// Returns the expanded size of an element with its children and the targets of its references.
    /// Recurses at most [`MAX_DEPTH`] levels.
    fn expanded_size(&mut self, node: Node<'d, 'a>, depth: u32) -> Result<ExpandedSize, SvgError> {
        let document = self.document;
        let line = || document.text_pos_at(node.range().start).row;
        match self.sizes.get(&node.id()) {
            Some(None) => return Err(SvgError::Circular(line())),
            Some(Some(size)) if depth + size.levels > MAX_DEPTH => {
                return Err(SvgError::TooDeep(line()));
            }
            Some(&Some(size)) => return Ok(size),
            None if depth > MAX_DEPTH => return Err(SvgError::TooDeep(line())),
            None => {}
        }
        // Reaching an element again while it is in progress means a circular reference.
        self.sizes.insert(node.id(), None);
        let mut size = ExpandedSize {
            elements: 1,
            levels: 1,
            text: match node.tag_name().name() {
                "text" => self.cost_of_text(node),
                _ => 0,
            },
        };
        for part in self.parts(node) {
            let inner = self.expanded_size(part, depth + 1)?;
            size.elements = size.elements.saturating_add(inner.elements);
            size.levels = size.levels.max(inner.levels + 1);
            size.text = size.text.saturating_add(inner.text);
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

    /// Returns the child elements and the targets of all references of an element.
    fn parts(&self, node: Node<'d, 'a>) -> Vec<Node<'d, 'a>> {
        let mut parts: Vec<_> = node.children().filter(Node::is_element).collect();
        // The `href` of a link or an image makes no copies.
        let copies_href = matches!(
            node.tag_name().name(),
            "use" | "pattern" | "mask" | "clipPath"
        );
        for attribute in node.attributes() {
            let value = attribute.value();
            let is_href = copies_href && attribute.name() == "href";
            let direct = is_href.then(|| value.trim().strip_prefix('#')).flatten();
            let named = direct.into_iter().chain(urls(value));
            parts.extend(named.filter_map(|id| self.reference(id)));
        }
        let styled = self.sheet.of_node(node);
        parts.extend(styled.filter_map(|id| self.reference(id)));
        parts
    }

    /// Returns the element with an id, unless it is of a type that is never expanded.
    fn reference(&self, id: &str) -> Option<Node<'d, 'a>> {
        let to = *self.ids.get(id)?;
        // Gradients contain no drawn elements; markers and filters are disabled by STYLE.
        let unexpanded = ["linearGradient", "radialGradient", "marker", "filter"];
        (!unexpanded.contains(&to.tag_name().name())).then_some(to)
    }
}
