//! Drawings that would unfold without end, refused before they are unfolded.
//!
//! `usvg` copies what `use`, patterns, clip paths and masks refer to, and so a
//! file of a few hundred bytes can stand for 10^10 elements. Here the elements
//! are counted with all their copies, by one pass over the graph of references
//! that visits every element once; nothing is copied.
//!
//! The count is an upper bound: what `usvg` keeps in a cache is counted as
//! often as it is referred to. Markers and filters are not counted, for they
//! are switched off by [`STYLE`].

use super::error::{MAX_DEPTH, MAX_ELEMENTS, SvgError};
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node};

/// Goes before the drawing's own style and, being important, over it. Markers
/// and filters do not change what is filled, but could unfold without end.
pub(super) const STYLE: &str = "* { marker: none !important; filter: none !important }";

/// Most tests of a style rule on an element. The 20,000 rules
/// on as many elements of a test would be eight times as many.
const MAX_STYLE_TESTS: usize = 50_000_000;

/// Most that laying out all text may take, in steps of a microsecond.
const MAX_TEXT: u64 = 2_000_000;

/// Checks the unfolded size and depth, references in a circle, and the cost
/// of the style sheet; says whether the text is short enough to be laid out.
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
        font: longest_font(document),
    };
    let size = counter.unfold(document.root_element(), 0)?;
    Ok(size.text <= MAX_TEXT)
}

/// How long the longest text is that names fonts: it is read for every span.
fn longest_font(document: &Document) -> u64 {
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

/// Which ids the style sheet makes elements refer to.
struct StyleReferences<'d> {
    rules: usize,
    /// The selector's last name (a class, an element, an id) and the id.
    references: HashMap<&'d str, Vec<&'d str>>,
}

impl<'d> StyleReferences<'d> {
    fn of(document: &'d Document) -> Self {
        let mut sheet = Self {
            rules: 1, // STYLE
            references: HashMap::new(),
        };
        let styles = document
            .descendants()
            .filter(|n| n.tag_name().name() == "style");
        for text in styles.flat_map(|n| n.children()).filter_map(|n| n.text()) {
            // One for each brace and each comma: a bound, as declarations have commas, too.
            sheet.rules += text.matches(['{', ',']).count();
            sheet.read(text);
        }
        sheet
    }

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

    /// Ids that the sheet makes `node` refer to.
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

/// The name at the end of a selector such as `g > path.thin`; `*` where there
/// is none that could be looked up.
fn last_name(selector: &str) -> &str {
    let selector = selector.trim();
    if selector.contains([':', '\\']) {
        return "*"; // a pseudo-class or an escape: taken to hit everything
    }
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == '-' || !c.is_ascii();
    let start = selector.rfind(|c| !is_part(c)).map_or(0, |i| i + 1);
    match &selector[start..] {
        "" => "*",
        name => name,
    }
}

/// The ids in `url(#id)`.
fn urls(text: &str) -> impl Iterator<Item = &str> {
    text.split("url(").skip(1).filter_map(|rest| {
        let id = rest.split(')').next()?;
        id.trim_matches(|c: char| c.is_whitespace() || c == '"' || c == '\'')
            .strip_prefix('#')
    })
}

#[derive(Clone, Copy)]
struct ExpandedSize {
    elements: u64,
    /// Levels below and including this one.
    levels: u32,
    /// What its text costs, in steps of about a microsecond.
    text: u64,
}

struct ExpansionCounter<'d, 'a> {
    document: &'d Document<'a>,
    ids: HashMap<&'d str, Node<'d, 'a>>,
    sheet: StyleReferences<'d>,
    /// `None` for elements that are being counted.
    sizes: HashMap<usvg::roxmltree::NodeId, Option<ExpandedSize>>,
    /// How long the longest text is that names fonts, in bytes.
    font: u64,
}

impl<'d, 'a> ExpansionCounter<'d, 'a> {
    /// Size of an element with all that it holds and refers to. Recurses at
    /// most [`MAX_DEPTH`] levels.
    fn unfold(&mut self, node: Node<'d, 'a>, depth: u32) -> Result<ExpandedSize, SvgError> {
        let document = self.document;
        let at = || document.text_pos_at(node.range().start).row;
        match self.sizes.get(&node.id()) {
            Some(None) => return Err(SvgError::Circular(at())),
            Some(Some(size)) if depth + size.levels > MAX_DEPTH => {
                return Err(SvgError::TooDeep(at()));
            }
            Some(&Some(size)) => return Ok(size),
            None if depth > MAX_DEPTH => return Err(SvgError::TooDeep(at())),
            None => {}
        }
        // Whoever comes here again before it is counted comes from within it.
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
            let inner = self.unfold(part, depth + 1)?;
            size.elements = size.elements.saturating_add(inner.elements);
            size.levels = size.levels.max(inner.levels + 1);
            size.text = size.text.saturating_add(inner.text);
        }
        if size.elements > MAX_ELEMENTS {
            return Err(SvgError::TooManyElements(at()));
        }
        self.sizes.insert(node.id(), Some(size));
        Ok(size)
    }

    /// What laying out a text takes: every span is the whole text shaped anew, and
    /// each of its letters is looked for among all.
    fn cost_of_text(&self, text: Node) -> u64 {
        let nodes = || text.descendants();
        let letters: usize = nodes().filter_map(|node| node.text()).map(str::len).sum();
        let (letters, spans) = (letters as u64, nodes().count() as u64);
        let shaped = letters.saturating_mul(spans + letters / 1000);
        shaped.saturating_add(spans.saturating_mul(self.font) / 10)
    }

    /// The elements that an element holds and refers to.
    fn parts(&self, node: Node<'d, 'a>) -> Vec<Node<'d, 'a>> {
        let mut parts: Vec<_> = node.children().filter(Node::is_element).collect();
        // A link, or an image, refers to something and copies nothing.
        let unfolds_href = matches!(
            node.tag_name().name(),
            "use" | "pattern" | "mask" | "clipPath"
        );
        for attribute in node.attributes() {
            let value = attribute.value();
            let is_href = unfolds_href && attribute.name() == "href";
            let direct = is_href.then(|| value.trim().strip_prefix('#')).flatten();
            let named = direct.into_iter().chain(urls(value));
            parts.extend(named.filter_map(|id| self.reference(id)));
        }
        let styled = self.sheet.of_node(node);
        parts.extend(styled.filter_map(|id| self.reference(id)));
        parts
    }

    /// What `id` stands for, unless it is never unfolded.
    fn reference(&self, id: &str) -> Option<Node<'d, 'a>> {
        let to = *self.ids.get(id)?;
        // Without elements that are drawn, or switched off by the style.
        let flat = ["linearGradient", "radialGradient", "marker", "filter"];
        (!flat.contains(&to.tag_name().name())).then_some(to)
    }
}
