//! Matches selectors (Selectors 4) against the elements of a drawing. The selectors are parsed by
//! `raffia`.

use raffia::ast::{
    AttributeSelector, AttributeSelectorMatcherKind, AttributeSelectorValue, CombinatorKind,
    ComplexSelector, ComplexSelectorChild, CompoundSelector, InterpolableIdent, InterpolableStr,
    LanguageRange, Nth, NthIndex, PseudoClassSelector, PseudoClassSelectorArgKind,
    RelativeSelectorList, SelectorList, SimpleSelector, TypeSelector,
};
use raffia::{Parser, Syntax};
use std::cell::Cell;
use usvg::roxmltree::Node;

/// Maximum depth of brackets in a list of selectors (resource limit: the parser recurses).
const MAX_BRACKETS: usize = 32;

/// Precedence of a selector: numbers of ids, of classes and the like, and of element names.
pub(super) type Specificity = [u32; 3];

/// One selector of a rule.
#[derive(Debug)]
pub(super) struct Selector<'s> {
    parts: ComplexSelector<'s>,
    pub specificity: Specificity,
}

/// Parses a list of selectors. Returns `None` if one of them is invalid; CSS then drops the rule.
pub(super) fn parse(text: &str) -> Option<Vec<Selector<'_>>> {
    if bracket_depth(text) > MAX_BRACKETS {
        return None;
    }
    // The parser stops where a list ends. The block shows that nothing invalid follows.
    let list: SelectorList = Parser::new(text, Syntax::Css).parse().ok()?;
    if !text[list.span.end.min(text.len())..].trim().is_empty() {
        return None;
    }
    let selectors = list.selectors.into_iter().map(|parts| {
        let starts_well = matches!(
            parts.children.first(),
            Some(ComplexSelectorChild::CompoundSelector(_))
        );
        let is_valid = starts_well
            && compounds(&parts).all(|(_, compound)| compound.children.iter().all(is_known));
        is_valid.then(|| Selector {
            specificity: specificity(&parts),
            parts,
        })
    });
    selectors.collect()
}

/// Returns the largest number of brackets that are open at the same time.
fn bracket_depth(text: &str) -> usize {
    let depths = text.bytes().scan(0_usize, |depth, byte| {
        match byte {
            b'(' | b'[' | b'{' => *depth += 1,
            b')' | b']' | b'}' => *depth = depth.saturating_sub(1),
            _ => {}
        }
        Some(*depth)
    });
    depths.max().unwrap_or(0)
}

/// Pseudo-classes without argument that may match an element of a still picture.
const STRUCTURAL: [&str; 8] = [
    "root",
    "scope",
    "empty",
    "first-child",
    "last-child",
    "only-child",
    "first-of-type",
    "last-of-type",
];

/// Other pseudo-classes without argument.
const STATES: [&str; 14] = [
    "only-of-type",
    "link",
    "any-link",
    "visited",
    "hover",
    "active",
    "focus",
    "focus-within",
    "focus-visible",
    "target",
    "defined",
    "enabled",
    "disabled",
    "checked",
];

/// Returns whether a simple selector is valid. A list with an unknown pseudo-class is invalid.
fn is_known(simple: &SimpleSelector) -> bool {
    match simple {
        SimpleSelector::PseudoClass(pseudo) => {
            let name = ident(&pseudo.name).to_ascii_lowercase();
            match &pseudo.arg {
                None => STRUCTURAL.contains(&&*name) || STATES.contains(&&*name),
                Some(arg) => matches!(
                    arg.kind,
                    PseudoClassSelectorArgKind::SelectorList(_)
                        | PseudoClassSelectorArgKind::RelativeSelectorList(_)
                        | PseudoClassSelectorArgKind::Nth(_)
                        | PseudoClassSelectorArgKind::LanguageRangeList(_)
                        | PseudoClassSelectorArgKind::CompoundSelectorList(_)
                ),
            }
        }
        SimpleSelector::SassPlaceholder(_) | SimpleSelector::Nesting(_) => false,
        _ => true,
    }
}

/// Returns the indices and compound selectors of a selector, from left to right.
fn compounds<'c, 's>(
    selector: &'c ComplexSelector<'s>,
) -> impl DoubleEndedIterator<Item = (usize, &'c CompoundSelector<'s>)> {
    let children = selector.children.iter().enumerate();
    children.filter_map(|(i, child)| match child {
        ComplexSelectorChild::CompoundSelector(compound) => Some((i, compound)),
        ComplexSelectorChild::Combinator(_) => None,
    })
}

fn ident<'i>(ident: &'i InterpolableIdent) -> &'i str {
    match ident {
        InterpolableIdent::Literal(ident) => &ident.name,
        InterpolableIdent::SassInterpolated(_) | InterpolableIdent::LessInterpolated(_) => "",
    }
}

/// Returns the specificity of a selector (Selectors 4, section 15).
fn specificity(selector: &ComplexSelector) -> Specificity {
    let simple = compounds(selector).flat_map(|(_, compound)| &compound.children);
    simple.map(simple_specificity).fold([0; 3], add)
}

fn add(a: Specificity, b: Specificity) -> Specificity {
    std::array::from_fn(|i| a[i].saturating_add(b[i]))
}

fn simple_specificity(simple: &SimpleSelector) -> Specificity {
    match simple {
        SimpleSelector::Id(_) => [1, 0, 0],
        SimpleSelector::Class(_) | SimpleSelector::Attribute(_) => [0, 1, 0],
        SimpleSelector::Type(TypeSelector::TagName(_)) | SimpleSelector::PseudoElement(_) => {
            [0, 0, 1]
        }
        SimpleSelector::PseudoClass(pseudo) => pseudo_specificity(pseudo),
        _ => [0; 3],
    }
}

fn pseudo_specificity(pseudo: &PseudoClassSelector) -> Specificity {
    let highest = |list: &[ComplexSelector]| list.iter().map(specificity).max().unwrap_or([0; 3]);
    match pseudo.arg.as_ref().map(|arg| &arg.kind) {
        Some(PseudoClassSelectorArgKind::SelectorList(_))
            if ident(&pseudo.name).eq_ignore_ascii_case("where") =>
        {
            [0; 3]
        }
        Some(PseudoClassSelectorArgKind::SelectorList(list)) => highest(&list.selectors),
        Some(PseudoClassSelectorArgKind::RelativeSelectorList(list)) => {
            let inner = list.selectors.iter();
            let inner = inner.map(|relative| specificity(&relative.complex_selector));
            inner.max().unwrap_or([0; 3])
        }
        Some(PseudoClassSelectorArgKind::Nth(nth)) => {
            let of = nth.matcher.as_ref().and_then(|of| of.selector.as_ref());
            add(
                [0, 1, 0],
                of.map_or([0; 3], |list| highest(&list.selectors)),
            )
        }
        _ => [0, 1, 0],
    }
}

/// Key by which the selectors that may match an element are looked up.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum SelectorKey {
    Id(String),
    Class(String),
    Tag(String),
    Any,
}

impl Selector<'_> {
    /// Returns a key that every matching element has.
    pub(super) fn key(&self) -> SelectorKey {
        let last = compounds(&self.parts).next_back();
        let simple = last.map(|(_, compound)| compound.children.as_slice());
        let keys = simple
            .unwrap_or_default()
            .iter()
            .map(|simple| match simple {
                SimpleSelector::Id(id) => SelectorKey::Id(ident(&id.name).to_owned()),
                SimpleSelector::Class(class) => SelectorKey::Class(ident(&class.name).to_owned()),
                SimpleSelector::Type(TypeSelector::TagName(tag)) => {
                    SelectorKey::Tag(ident(&tag.name.name).to_owned())
                }
                _ => SelectorKey::Any,
            });
        keys.min().unwrap_or(SelectorKey::Any)
    }
}

/// Matcher with a limit on the number of comparisons. When the limit is reached, nothing matches
/// any more.
#[derive(Debug)]
pub(super) struct SelectorMatcher {
    remaining: Cell<usize>,
}

impl SelectorMatcher {
    /// Creates a matcher that compares at most `limit` elements with parts of selectors.
    pub(super) fn new(limit: usize) -> Self {
        Self {
            remaining: Cell::new(limit),
        }
    }

    /// Returns whether the limit was reached.
    pub(super) fn is_exhausted(&self) -> bool {
        self.remaining.get() == 0
    }

    /// Counts work that takes as long as some comparisons.
    pub(super) fn spend(&self, comparisons: usize) {
        let remaining = self.remaining.get();
        self.remaining.set(remaining.saturating_sub(comparisons));
    }

    /// Returns whether a selector matches an element.
    pub(super) fn matches(&self, selector: &Selector, element: Node) -> bool {
        self.matches_complex(&selector.parts, element)
    }

    fn matches_complex(&self, selector: &ComplexSelector, element: Node) -> bool {
        let last = compounds(selector).next_back();
        last.is_some_and(|(i, _)| self.matches_up_to(&selector.children[..=i], element, None))
    }

    fn matches_any(&self, list: &SelectorList, element: Node) -> bool {
        let mut selectors = list.selectors.iter();
        selectors.any(|selector| self.matches_complex(selector, element))
    }

    /// Returns whether the last compound of `parts` matches the element and the parts before it
    /// match its surroundings. In a relative selector, the first compound is related to `anchor`.
    fn matches_up_to(
        &self,
        parts: &[ComplexSelectorChild],
        element: Node,
        anchor: Option<(&CombinatorKind, Node)>,
    ) -> bool {
        let Some((ComplexSelectorChild::CompoundSelector(compound), before)) = parts.split_last()
        else {
            return false;
        };
        if !self.matches_compound(compound, element) {
            return false;
        }
        match before.split_last() {
            None => anchor.is_none_or(|(kind, anchor)| {
                related(kind, element).any(|related| related == anchor)
            }),
            Some((ComplexSelectorChild::Combinator(combinator), before)) => {
                let mut candidates = related(&combinator.kind, element);
                candidates.any(|other| self.matches_up_to(before, other, anchor))
            }
            Some(_) => false,
        }
    }

    fn matches_compound(&self, compound: &CompoundSelector, element: Node) -> bool {
        let may_compare = !self.is_exhausted();
        self.spend(1);
        let mut parts = compound.children.iter();
        may_compare && parts.all(|simple| self.matches_simple(simple, element))
    }

    fn matches_simple(&self, simple: &SimpleSelector, element: Node) -> bool {
        match simple {
            SimpleSelector::Id(id) => element.attribute("id") == Some(ident(&id.name)),
            SimpleSelector::Class(class) => {
                let classes = element.attribute("class").unwrap_or_default();
                let mut classes = classes.split_whitespace();
                classes.any(|name| name == ident(&class.name))
            }
            SimpleSelector::Type(TypeSelector::Universal(_)) => true,
            SimpleSelector::Type(TypeSelector::TagName(tag)) => {
                element.tag_name().name() == ident(&tag.name.name)
            }
            SimpleSelector::Attribute(attribute) => attribute_matches(attribute, element),
            SimpleSelector::PseudoClass(pseudo) => self.matches_pseudo(pseudo, element),
            _ => false,
        }
    }

    fn matches_pseudo(&self, pseudo: &PseudoClassSelector, element: Node) -> bool {
        let name = ident(&pseudo.name).to_ascii_lowercase();
        match pseudo.arg.as_ref().map(|arg| &arg.kind) {
            None => matches_state(&name, element),
            Some(PseudoClassSelectorArgKind::SelectorList(list)) => {
                self.matches_any(list, element) != (name == "not")
            }
            Some(PseudoClassSelectorArgKind::CompoundSelectorList(list)) => {
                let mut list = list.selectors.iter();
                list.any(|compound| self.matches_compound(compound, element))
            }
            Some(PseudoClassSelectorArgKind::RelativeSelectorList(list)) => self.has(list, element),
            Some(PseudoClassSelectorArgKind::Nth(nth)) => self.matches_nth(&name, nth, element),
            Some(PseudoClassSelectorArgKind::LanguageRangeList(list)) => {
                let mut nodes = element.ancestors();
                let language = nodes.find_map(|node| {
                    let mut attributes = node.attributes();
                    attributes.find(|a| a.name() == "lang").map(|a| a.value())
                });
                let is_in = |range: &LanguageRange| match range {
                    LanguageRange::Ident(range) => is_dashed_prefix(ident(range), language),
                    LanguageRange::Str(range) => is_dashed_prefix(string(range), language),
                };
                list.ranges.iter().any(is_in)
            }
            Some(_) => false,
        }
    }

    /// Returns whether a descendant or later sibling of the element matches a relative selector.
    fn has(&self, list: &RelativeSelectorList, element: Node) -> bool {
        list.selectors.iter().any(|relative| {
            let kind = relative.combinator.as_ref();
            let kind = kind.map_or(&CombinatorKind::Descendant, |combinator| &combinator.kind);
            let top = match kind {
                CombinatorKind::Child | CombinatorKind::Descendant => element,
                _ => element.parent().unwrap_or(element),
            };
            let parts = &relative.complex_selector.children;
            let mut candidates = top.descendants().filter(Node::is_element);
            candidates.any(|other| {
                !self.is_exhausted() && self.matches_up_to(parts, other, Some((kind, element)))
            })
        })
    }

    /// Returns whether the position of the element among its siblings is one of `nth`.
    fn matches_nth(&self, name: &str, nth: &Nth, element: Node) -> bool {
        let of = nth.matcher.as_ref().and_then(|of| of.selector.as_ref());
        let counts = |sibling: &Node| match of {
            Some(list) => self.matches_any(list, *sibling),
            None => !name.contains("of-type") || sibling.tag_name() == element.tag_name(),
        };
        if !counts(&element) {
            return false;
        }
        let step = |node: &Node<'_, '_>| match name.contains("last") {
            true => node.next_sibling_element().map(|node| node.id()),
            false => node.prev_sibling_element().map(|node| node.id()),
        };
        let document = element.document();
        let next = |node: &Node<'_, '_>| step(node).and_then(|id| document.get_node(id));
        let before = std::iter::successors(next(&element), |node| next(node));
        let before = before.inspect(|_| self.spend(1));
        let position = 1 + before
            .take_while(|_| !self.is_exhausted())
            .filter(counts)
            .count();
        let (a, b) = match &nth.index {
            NthIndex::Odd(_) => (2, 1),
            NthIndex::Even(_) => (2, 0),
            NthIndex::Integer(number) => (0, number.value as i64),
            NthIndex::AnPlusB(index) => (i64::from(index.a), i64::from(index.b)),
        };
        let offset = (position as i64).saturating_sub(b);
        match a {
            0 => offset == 0,
            a => offset % a == 0 && offset / a >= 0,
        }
    }
}

/// Returns the elements to which a combinator relates an element on its right side.
fn related<'d, 'a>(
    kind: &CombinatorKind,
    element: Node<'d, 'a>,
) -> Box<dyn Iterator<Item = Node<'d, 'a>> + 'd>
where
    'a: 'd,
{
    let parents = move || std::iter::successors(element.parent_element(), Node::parent_element);
    let siblings =
        move || std::iter::successors(element.prev_sibling_element(), Node::prev_sibling_element);
    match kind {
        CombinatorKind::Descendant => Box::new(parents()),
        CombinatorKind::Child => Box::new(parents().take(1)),
        CombinatorKind::NextSibling => Box::new(siblings().take(1)),
        CombinatorKind::LaterSibling => Box::new(siblings()),
        CombinatorKind::Column => Box::new(std::iter::empty()),
    }
}

/// Returns whether a pseudo-class without argument matches an element. In a still picture, no
/// element has the focus or the pointer over it.
fn matches_state(name: &str, element: Node) -> bool {
    let same_type = |node: &Node| node.tag_name() == element.tag_name();
    let before =
        || std::iter::successors(element.prev_sibling_element(), Node::prev_sibling_element);
    let after =
        || std::iter::successors(element.next_sibling_element(), Node::next_sibling_element);
    match name {
        "root" | "scope" => element.parent_element().is_none(),
        "empty" => element
            .children()
            .all(|node| node.is_comment() || node.is_pi()),
        "first-child" => before().next().is_none(),
        "last-child" => after().next().is_none(),
        "only-child" => before().chain(after()).next().is_none(),
        "first-of-type" => !before().any(|node| same_type(&node)),
        "last-of-type" => !after().any(|node| same_type(&node)),
        "only-of-type" => !before().chain(after()).any(|node| same_type(&node)),
        "link" | "any-link" => {
            let mut attributes = element.attributes();
            element.tag_name().name() == "a" && attributes.any(|a| a.name() == "href")
        }
        "defined" => true,
        _ => false,
    }
}

fn string<'s>(text: &'s InterpolableStr) -> &'s str {
    match text {
        InterpolableStr::Literal(text) => &text.value,
        InterpolableStr::SassInterpolated(_) | InterpolableStr::LessInterpolated(_) => "",
    }
}

/// Returns whether a language equals `range` or begins with it and a hyphen.
fn is_dashed_prefix(range: &str, language: Option<&str>) -> bool {
    language.is_some_and(|language| {
        let head = language.get(..range.len()).unwrap_or_default();
        let rest = &language[head.len()..];
        head.eq_ignore_ascii_case(range) && (rest.is_empty() || rest.starts_with('-'))
    })
}

fn attribute_matches(selector: &AttributeSelector, element: Node) -> bool {
    let name = ident(&selector.name.name);
    let mut attributes = element.attributes();
    let Some(found) = attributes.find(|attribute| attribute.name() == name) else {
        return false;
    };
    let Some(matcher) = &selector.matcher else {
        return true;
    };
    let expected = match &selector.value {
        Some(AttributeSelectorValue::Ident(value)) => ident(value),
        Some(AttributeSelectorValue::Str(value)) => string(value),
        _ => return false,
    };
    let flag = selector.modifier.as_ref();
    let ignores_case = flag.is_some_and(|flag| ident(&flag.ident).eq_ignore_ascii_case("i"));
    let fold = |text: &str| match ignores_case {
        true => text.to_ascii_lowercase(),
        false => text.to_owned(),
    };
    let (value, expected) = (fold(found.value()), fold(expected));
    let is_part = !expected.is_empty();
    match matcher.kind {
        AttributeSelectorMatcherKind::Exact => value == expected,
        AttributeSelectorMatcherKind::MatchWord => {
            value.split_whitespace().any(|word| word == expected)
        }
        AttributeSelectorMatcherKind::ExactOrPrefixThenHyphen => {
            is_dashed_prefix(&expected, Some(&value))
        }
        AttributeSelectorMatcherKind::Prefix => is_part && value.starts_with(&expected),
        AttributeSelectorMatcherKind::Suffix => is_part && value.ends_with(&expected),
        AttributeSelectorMatcherKind::Substring => is_part && value.contains(&expected),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use usvg::roxmltree::Document;

    /// Returns the ids of the elements that a list of selectors matches.
    fn matched(selectors: &str) -> Vec<String> {
        let text = r#"<svg id="s" xml:lang="de-AT"><g id="g" class="a b"><rect id="r" data-kind="Wall-1"/>
            <path id="p" class="b"/><path id="q"/></g><a href="u" id="l"><path id="t" fill=""/></a></svg>"#;
        let document = Document::parse(text).expect("well-formed");
        let Some(list) = parse(selectors) else {
            return vec!["invalid".to_owned()];
        };
        let matcher = SelectorMatcher::new(1_000_000);
        let elements = document.descendants().filter(Node::is_element);
        let elements = elements.filter(|&node| list.iter().any(|s| matcher.matches(s, node)));
        let ids = elements.filter_map(|node| node.attribute("id"));
        ids.map(str::to_owned).collect()
    }

    #[test]
    fn selectors_match_as_the_specification_says() {
        let cases = [
            ("*", "s g r p q l t"),
            ("path", "p q t"),
            ("g > path.b, #t", "p t"),
            ("svg path", "p q t"),
            ("rect + path", "p"),
            ("rect ~ path", "p q"),
            (".a.b", "g"),
            (":not(g, path)", "s r l"),
            (":is(g, a) > :first-child", "r t"),
            (":where(path):last-child", "q t"),
            (":nth-child(2n+1)", "s g r q t"),
            (":nth-child(even)", "p l"),
            (":nth-last-of-type(1)", "s g r q l t"),
            (":nth-child(1 of path)", "p t"),
            ("g:has(> .b)", "g"),
            (":has(+ path)", "r p"),
            ("[data-kind^=wall i]", "r"),
            ("[data-kind|=Wall]", "r"),
            ("[class~=b]", "g p"),
            ("[class*='']", ""),
            (":root > :empty", ""),
            (":any-link", "l"),
            (":lang(de)", "s g r p q l t"),
            (":hover, path::before", ""),
            (":unknown, path", "invalid"),
            ("path)", "invalid"),
            ("> path", "invalid"),
        ];
        for (selectors, expected) in cases {
            assert_eq!(matched(selectors).join(" "), expected, "{selectors}");
        }
    }

    #[test]
    fn specificity_counts_ids_classes_and_names() {
        let of = |text: &str| parse(text).expect("valid")[0].specificity;
        assert_eq!(of("#a .b[c] d:hover"), [1, 3, 1]);
        assert_eq!(of(":is(#a, b) :where(#c)"), [1, 0, 0]);
        assert_eq!(of(":nth-child(2 of .a)"), [0, 2, 0]);
    }

    #[test]
    fn hostile_selectors_end() {
        assert!(parse(&":not(".repeat(1000)).is_none());
        let deep = "<g>".repeat(60) + &"</g>".repeat(60);
        let document = Document::parse(&deep).expect("well-formed");
        let text = "g ".repeat(30) + "x > g";
        let list = parse(&text).expect("valid");
        let matcher = SelectorMatcher::new(10_000);
        let elements = document.descendants().filter(Node::is_element);
        assert!(
            !elements
                .into_iter()
                .any(|node| matcher.matches(&list[0], node))
        );
    }
}
