//! The cascade (CSS Cascade 5): which declarations apply to an element, in which order.

use super::conditions::media_matches;
use super::selectors::{Selector, SelectorKey, SelectorMatcher, Specificity, parse};
use super::syntax::{Declaration, RuleList, StyleRule, read_declarations};
use super::tokens::without_comments;
use crate::design::svg::lost_features::LostFeatures;
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node};

/// Maximum number of comparisons of elements with parts of selectors (resource limit: about one
/// second).
const MAX_COMPARISONS: usize = 4_000_000;

/// Cost of collecting the declarations of a matching rule, in comparisons.
const COST_OF_MATCH: usize = 10;

/// Maximum number of declarations that apply to one element; the weakest ones beyond it are dropped
/// (resource limit).
const MAX_DECLARATIONS: usize = 1000;

/// Reads all style sheets of a document.
pub(in crate::design::svg) fn read_sheets(
    document: &Document,
    lost: &mut LostFeatures,
) -> RuleList {
    let mut list = RuleList::default();
    for node in document.descendants() {
        let is_css = |kind: &str| kind.trim().is_empty() || kind.trim() == "text/css";
        let is_sheet = node.tag_name().name() == "style"
            && node.attribute("type").is_none_or(is_css)
            && node.attribute("media").is_none_or(media_matches);
        if is_sheet {
            let texts = node.children().filter_map(|child| child.text());
            list.read_sheet(&texts.collect::<String>(), lost);
        }
    }
    list
}

/// Rules of a document, indexed by the elements that they may match.
pub(in crate::design::svg) struct StyleCascade<'s> {
    rules: &'s [StyleRule],
    /// Selectors with the indices of their rules.
    selectors: Vec<(Selector<'s>, usize)>,
    selectors_by_key: HashMap<SelectorKey, Vec<usize>>,
    matcher: SelectorMatcher,
}

/// Precedence of a declaration; a higher one wins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Precedence {
    important: bool,
    layer: usize,
    is_style_attribute: bool,
    specificity: Specificity,
}

impl Precedence {
    /// Precedence of a declaration in a rule or in a style attribute. The order of layers is
    /// reversed for important declarations.
    fn of(declaration: &Declaration, layer: usize) -> Self {
        Self {
            important: declaration.important,
            layer: match declaration.important {
                true => usize::MAX - layer,
                false => layer,
            },
            is_style_attribute: false,
            specificity: [0; 3],
        }
    }
}

impl<'s> StyleCascade<'s> {
    pub(in crate::design::svg) fn new(list: &'s RuleList) -> Self {
        let rules = list.rules.as_slice();
        let mut selectors: Vec<(Selector, usize)> = Vec::new();
        let mut selectors_by_key: HashMap<SelectorKey, Vec<usize>> = HashMap::new();
        for (index, rule) in rules.iter().enumerate() {
            for selector in parse(&rule.selectors).unwrap_or_default() {
                let same_key = selectors_by_key.entry(selector.key()).or_default();
                same_key.push(selectors.len());
                selectors.push((selector, index));
            }
        }
        Self {
            rules,
            selectors,
            selectors_by_key,
            matcher: SelectorMatcher::new(MAX_COMPARISONS),
        }
    }

    /// Returns whether matching the selectors took too long, so that elements lack declarations.
    pub(in crate::design::svg) fn is_exhausted(&self) -> bool {
        self.matcher.is_exhausted()
    }

    /// Returns the declarations of custom properties in all rules.
    pub(in crate::design::svg) fn custom_declarations(&self) -> impl Iterator<Item = &Declaration> {
        let declarations = self.rules.iter().flat_map(|rule| &rule.declarations);
        declarations.filter(|declaration| declaration.name.starts_with("--"))
    }

    /// Returns the declarations of rules and of the style attribute that apply to an element. The
    /// last one of a property wins.
    pub(in crate::design::svg) fn declarations(&self, element: Node) -> Vec<Declaration> {
        let style = without_comments(element.attribute("style").unwrap_or_default());
        let (own, _) = read_declarations(&style);
        let mut found: Vec<(Precedence, &Declaration)> = Vec::new();
        for (specificity, rule) in self.matching_rules(element) {
            let rule = &self.rules[rule];
            found.extend(rule.declarations.iter().map(|declaration| {
                let precedence = Precedence {
                    specificity,
                    ..Precedence::of(declaration, rule.layer)
                };
                (precedence, declaration)
            }));
        }
        found.extend(own.iter().map(|declaration| {
            let precedence = Precedence {
                is_style_attribute: true,
                ..Precedence::of(declaration, usize::MAX)
            };
            (precedence, declaration)
        }));
        // The sort is stable: of equal declarations, the later one wins.
        found.sort_by_key(|(precedence, _)| *precedence);
        let weakest = found.len().saturating_sub(MAX_DECLARATIONS);
        let strongest = found[weakest..].iter();
        strongest
            .map(|(_, declaration)| (*declaration).clone())
            .collect()
    }

    /// Returns the rules that match an element in the order of the document, each with the highest
    /// specificity of its matching selectors.
    fn matching_rules(&self, element: Node) -> Vec<(Specificity, usize)> {
        let classes = element.attribute("class").unwrap_or_default();
        let classes = classes
            .split_whitespace()
            .map(str::to_owned)
            .map(SelectorKey::Class);
        let id = element
            .attribute("id")
            .map(|id| SelectorKey::Id(id.to_owned()));
        let tag = SelectorKey::Tag(element.tag_name().name().to_owned());
        let keys = classes.chain(id).chain([tag, SelectorKey::Any]);
        let candidates = keys
            .filter_map(|key| self.selectors_by_key.get(&key))
            .flatten();
        let mut matching: HashMap<usize, Specificity> = HashMap::new();
        let candidates = candidates.take_while(|_| !self.is_exhausted());
        for &index in candidates {
            let (selector, rule) = &self.selectors[index];
            if self.matcher.matches(selector, element) {
                self.matcher.spend(COST_OF_MATCH);
                let highest = matching.entry(*rule).or_default();
                *highest = selector.specificity.max(*highest);
            }
        }
        let mut matching: Vec<_> = matching.into_iter().map(|(rule, s)| (s, rule)).collect();
        matching.sort_unstable_by_key(|(_, rule)| *rule);
        matching
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the winning value of a property of the element `e`.
    fn winner(sheet: &str, style: &str, name: &str) -> Option<String> {
        let text = format!(
            r#"<svg><style><![CDATA[{sheet}]]></style><g class="g"><rect id="e" class="a b" style="{style}"/></g></svg>"#
        );
        let document = Document::parse(&text).expect("well-formed");
        let list = read_sheets(&document, &mut LostFeatures::default());
        let cascade = StyleCascade::new(&list);
        let mut elements = document.descendants();
        let element = elements.find(|node| node.attribute("id") == Some("e"));
        let declarations = cascade.declarations(element.expect("an element"));
        let last = declarations.into_iter().rev().find(|d| d.name == name);
        last.map(|declaration| declaration.value)
    }

    #[test]
    fn the_most_important_and_specific_declaration_wins() {
        let cases = [
            ("rect{fill:a} .a{fill:b} *{fill:c}", "", "b"),
            (".a{fill:a} .b{fill:b}", "", "b"),
            (".b{fill:b} .a.b{fill:c} .a{fill:a}", "", "c"),
            ("#e{fill:a}", "fill:b", "b"),
            ("rect{fill:a!important} #e{fill:b}", "fill:c", "a"),
            ("rect{fill:a!important}", "fill:b!important", "b"),
            ("@layer x{#e{fill:a}} rect{fill:b}", "", "b"),
            (
                "@layer x{rect{fill:a!important}} #e{fill:b!important}",
                "",
                "a",
            ),
            (".g > rect, #none{fill:a} rect{fill:b}", "", "a"),
            (":where(#e){fill:a} rect{fill:b}", "", "b"),
            ("rect:foo, #e{fill:a} rect{fill:b}", "", "b"),
        ];
        for (sheet, style, expected) in cases {
            let found = winner(sheet, style, "fill");
            assert_eq!(found.as_deref(), Some(expected), "{sheet} / {style}");
        }
    }

    #[test]
    fn sheets_of_other_types_and_media_are_ignored() {
        let text = r#"<svg><style type="text/less">g{x:y}</style><style media="print">g{x:y}</style>
            <style type="text/css" media="screen">a{x:y}</style></svg>"#;
        let document = Document::parse(text).expect("well-formed");
        let list = read_sheets(&document, &mut LostFeatures::default());
        assert_eq!(list.rules.len(), 1);
    }
}
