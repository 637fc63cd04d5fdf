//! Splits style sheets into rules and declarations with the error recovery of CSS Syntax 3: a
//! malformed rule or declaration is dropped, the rest stays valid.

use super::conditions::{is_supported, media_matches};
use super::tokens::{find_outside_brackets, split_outside_brackets, without_comments};
use crate::design::svg::lost_features::LostFeatures;

/// Maximum depth of nested rules (resource limit: the reader recurses).
const MAX_NESTING: usize = 16;

/// Maximum number of rules after nested rules are expanded (resource limit: as many as a sheet of
/// some megabytes has).
const MAX_RULES: usize = 100_000;

/// Maximum length of a selector after nested rules are expanded, in bytes (resource limit: nested
/// lists of selectors multiply).
const MAX_SELECTOR: usize = 10_000;

/// Property with its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::design::svg) struct Declaration {
    /// Name in lower case; the names of custom properties keep their case.
    pub name: String,
    /// Value without surrounding white space and without `!important`.
    pub value: String,
    pub important: bool,
}

/// Declarations for all elements that a list of selectors matches.
#[derive(Debug)]
pub(in crate::design::svg) struct StyleRule {
    /// Selectors, separated by commas.
    pub selectors: String,
    pub declarations: Vec<Declaration>,
    /// Order of the cascade layer of the rule, counted from the first layer of the document;
    /// `usize::MAX` for rules outside of layers, which override all layers.
    pub layer: usize,
}

/// Rules of all style sheets of a document.
#[derive(Debug, Default)]
pub(in crate::design::svg) struct RuleList {
    /// Rules in the order of the document.
    pub rules: Vec<StyleRule>,
    /// Names of the cascade layers in the order of their first appearance.
    layers: Vec<String>,
}

impl RuleList {
    /// Adds the rules of one sheet.
    pub(super) fn read_sheet(&mut self, text: &str, lost: &mut LostFeatures) {
        let text = without_comments(text);
        let context = RuleContext {
            parent: None,
            layer: usize::MAX,
            depth: 0,
        };
        self.read_rules(&text, &context, lost);
    }

    /// Adds rules that are not inside a block of declarations.
    fn read_rules(&mut self, text: &str, context: &RuleContext, lost: &mut LostFeatures) {
        let mut rest = text;
        while let Some(item) = next_item(&mut rest) {
            match item {
                SheetItem::Block { prelude, body } => self.read_block(prelude, body, context, lost),
                SheetItem::Statement(text) => self.read_statement(text, lost),
            }
        }
    }

    /// Adds a rule that consists of a prelude (selectors, or an at-keyword with its condition) and
    /// a block.
    fn read_block(
        &mut self,
        prelude: &str,
        body: &str,
        context: &RuleContext,
        lost: &mut LostFeatures,
    ) {
        if context.depth > MAX_NESTING {
            return lost.ignore("style rules nested too deeply", "<style>");
        }
        let inner = RuleContext {
            depth: context.depth + 1,
            ..context.clone()
        };
        let Some(at_rule) = prelude.strip_prefix('@') else {
            return self.read_style_rule(prelude, body, &inner, lost);
        };
        let end = at_rule.find(|c: char| !(c.is_ascii_alphanumeric() || c == '-'));
        let (keyword, condition) = at_rule.split_at(end.unwrap_or(at_rule.len()));
        match keyword.to_ascii_lowercase().as_str() {
            "media" if !media_matches(condition) => {}
            "supports" if !is_supported(condition) => {}
            "media" | "supports" => self.read_conditional(body, &inner, lost),
            "layer" => {
                let layer = self.layer(condition.trim());
                self.read_conditional(body, &RuleContext { layer, ..inner }, lost);
            }
            // Animations are reported with the elements that use them; the others have no effect
            // on a picture.
            "keyframes" | "-webkit-keyframes" | "-moz-keyframes" | "page" | "counter-style" => {}
            "property" => self.read_property(condition.trim(), body),
            keyword => lost.ignore(&format!("@{keyword}"), "<style>"),
        }
    }

    /// Adds the content of a conditional rule: rules or, inside of a style rule, declarations.
    fn read_conditional(&mut self, body: &str, context: &RuleContext, lost: &mut LostFeatures) {
        match &context.parent {
            Some(_) => self.read_style_rule("&", body, context, lost),
            None => self.read_rules(body, context, lost),
        }
    }

    /// Adds a style rule and the rules nested in it.
    fn read_style_rule(
        &mut self,
        prelude: &str,
        body: &str,
        context: &RuleContext,
        lost: &mut LostFeatures,
    ) {
        let selectors = match &context.parent {
            Some(parent) => nested_selectors(prelude, parent),
            None => (prelude.len() <= MAX_SELECTOR).then(|| prelude.trim().to_owned()),
        };
        let selectors = selectors.filter(|_| self.rules.len() < MAX_RULES);
        let Some(selectors) = selectors else {
            return lost.ignore("style rules beyond the limit", "<style>");
        };
        let (declarations, nested) = read_declarations(body);
        self.rules.push(StyleRule {
            selectors: selectors.clone(),
            declarations,
            layer: context.layer,
        });
        let inner = RuleContext {
            parent: Some(selectors),
            ..context.clone()
        };
        for (prelude, body) in nested {
            self.read_block(prelude, body, &inner, lost);
        }
    }

    /// Handles an at-rule without a block.
    fn read_statement(&mut self, text: &str, lost: &mut LostFeatures) {
        if let Some(names) = text.strip_prefix("@layer") {
            for name in names.split(',') {
                self.layer(name.trim());
            }
        } else if text.starts_with("@import") {
            lost.ignore("@import", "<style>");
        }
    }

    /// Adds the initial value of a registered custom property as a rule for the root element with
    /// the lowest precedence.
    fn read_property(&mut self, name: &str, body: &str) {
        let (declarations, _) = read_declarations(body);
        let initial = declarations.into_iter().find(|d| d.name == "initial-value");
        if let Some(initial) = initial.filter(|_| name.starts_with("--")) {
            self.rules.push(StyleRule {
                selectors: ":where(:root)".to_owned(),
                declarations: vec![Declaration {
                    name: name.to_owned(),
                    ..initial
                }],
                layer: 0,
            });
        }
    }

    /// Returns the order of a layer, counted from 1; adds the layer if it is new. Layers without a
    /// name are all distinct.
    fn layer(&mut self, name: &str) -> usize {
        let known = self.layers.iter().position(|known| known == name);
        if let Some(index) = known.filter(|_| !name.is_empty()) {
            return index + 1;
        }
        self.layers.push(name.to_owned());
        self.layers.len()
    }
}

/// Surroundings of a rule.
#[derive(Clone)]
struct RuleContext {
    /// Selectors of the style rule that contains the rule, if any.
    parent: Option<String>,
    layer: usize,
    depth: usize,
}

/// Item of a style sheet.
enum SheetItem<'s> {
    Block { prelude: &'s str, body: &'s str },
    Statement(&'s str),
}

/// Removes the first item from a sheet and returns it.
fn next_item<'s>(rest: &mut &'s str) -> Option<SheetItem<'s>> {
    let text = rest.trim_start_matches(|c: char| c.is_whitespace() || c == '}');
    let text = ["<!--", "-->"].iter().fold(text, |text, mark| {
        text.trim_start_matches(mark).trim_start()
    });
    let ends = if text.starts_with('@') { "{;" } else { "{" };
    let end = find_outside_brackets(text, ends)?;
    let (prelude, after) = (text[..end].trim(), &text[end + 1..]);
    if text.as_bytes()[end] == b';' {
        *rest = after;
        return Some(SheetItem::Statement(prelude));
    }
    let close = find_outside_brackets(after, "}");
    let body = &after[..close.unwrap_or(after.len())];
    *rest = close.map_or("", |close| &after[close + 1..]);
    Some(SheetItem::Block { prelude, body })
}

/// Rule nested in another one: prelude and body.
type NestedRule<'s> = (&'s str, &'s str);

/// Splits a block into its declarations and the rules nested in it.
pub(in crate::design::svg) fn read_declarations(
    text: &str,
) -> (Vec<Declaration>, Vec<NestedRule<'_>>) {
    let (mut declarations, mut nested) = (Vec::new(), Vec::new());
    let mut rest = text;
    loop {
        rest = rest.trim_start_matches(|c: char| c.is_whitespace() || c == ';' || c == '}');
        if rest.is_empty() {
            return (declarations, nested);
        }
        // The value of a custom property may contain blocks.
        let ends = if rest.starts_with("--") { ";" } else { ";{" };
        let end = find_outside_brackets(rest, ends).unwrap_or(rest.len());
        if rest.as_bytes().get(end) == Some(&b'{') {
            let after = &rest[end + 1..];
            let close = find_outside_brackets(after, "}");
            nested.push((rest[..end].trim(), &after[..close.unwrap_or(after.len())]));
            rest = close.map_or("", |close| &after[close + 1..]);
            continue;
        }
        declarations.extend(declaration(&rest[..end]));
        rest = rest.get(end + 1..).unwrap_or_default();
    }
}

/// Parses one declaration; returns `None` if it is malformed.
fn declaration(text: &str) -> Option<Declaration> {
    let (name, value) = text.split_once(':')?;
    let name = name.trim();
    let is_name = !name.is_empty() && !name.contains(|c: char| c.is_whitespace() || c == '{');
    let (value, important) = without_importance(value.trim());
    is_name.then(|| Declaration {
        name: match name.starts_with("--") {
            true => name.to_owned(),
            false => name.to_ascii_lowercase(),
        },
        value: value.to_owned(),
        important,
    })
}

/// Removes a trailing `!important` from a value. Returns whether there was one.
fn without_importance(value: &str) -> (&str, bool) {
    let mark = value.rfind('!');
    let mark = mark.filter(|&mark| value[mark + 1..].trim().eq_ignore_ascii_case("important"));
    match mark {
        Some(mark) => (value[..mark].trim_end(), true),
        None => (value, false),
    }
}

/// Returns the selectors of a nested rule, in which `&` stands for the elements of the outer rule;
/// `None` if they exceed [`MAX_SELECTOR`].
fn nested_selectors(prelude: &str, parent: &str) -> Option<String> {
    let outer = format!(":is({parent})");
    let copies = 1 + prelude.matches(['&', ',']).count();
    if prelude.len() + copies.saturating_mul(outer.len() + 1) > MAX_SELECTOR {
        return None;
    }
    let complete = |selector: &str| match selector.contains('&') {
        true => selector.replace('&', &outer),
        false => format!("{outer} {selector}"),
    };
    let selectors = split_outside_brackets(prelude, ',');
    Some(selectors.map(complete).collect::<Vec<_>>().join(","))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rules(text: &str) -> Vec<StyleRule> {
        let mut list = RuleList::default();
        list.read_sheet(text, &mut LostFeatures::default());
        list.rules
    }

    fn declared(text: &str) -> Vec<(String, String, bool)> {
        let (declarations, _) = read_declarations(text);
        let triple = |d: Declaration| (d.name, d.value, d.important);
        declarations.into_iter().map(triple).collect()
    }

    #[test]
    fn malformed_declarations_are_dropped_and_the_others_stay() {
        let found =
            declared("FILL: Red; 5px; stroke :blue ! IMPORTANT;;--A:{x;y};d:path(\"M0;0\")");
        let expected = [
            ("fill", "Red", false),
            ("stroke", "blue", true),
            ("--A", "{x;y}", false),
            ("d", "path(\"M0;0\")", false),
        ];
        let expected = expected.map(|(name, value, i)| (name.to_owned(), value.to_owned(), i));
        assert_eq!(found, expected);
    }

    #[test]
    fn a_broken_rule_does_not_hide_the_next_one() {
        let found = rules("a{fill:url(data:x'y;z)} ? {x} /* } */ b{fill:red} c{fill:\"}\"");
        let selectors: Vec<_> = found.iter().map(|rule| rule.selectors.as_str()).collect();
        assert_eq!(selectors, ["a", "?", "b", "c"]);
        assert_eq!(found[0].declarations[0].value, "url(data:x'y;z)");
    }

    #[test]
    fn rules_for_screens_count_and_rules_for_print_do_not() {
        let kept = rules(
            "@media print{a{x:y}} @media screen and (min-width:9px){b{x:y}}
            @media (prefers-color-scheme:dark){c{x:y}} @media not print{d{x:y}} @supports (x:y){e{x:y}}",
        );
        let selectors: Vec<_> = kept.iter().map(|rule| rule.selectors.as_str()).collect();
        assert_eq!(selectors, ["b", "d", "e"]);
    }

    #[test]
    fn nested_rules_refer_to_their_outer_rule() {
        let found =
            rules("a, b { fill: red; &.c { fill: blue } > d { fill: green } stroke: none }");
        let selectors: Vec<_> = found.iter().map(|rule| rule.selectors.as_str()).collect();
        assert_eq!(selectors, ["a, b", ":is(a, b).c", ":is(a, b) > d"]);
        assert_eq!(found[0].declarations.len(), 2);
    }

    #[test]
    fn layers_are_ordered_by_their_first_appearance() {
        let found = rules("@layer late, early; @layer early{a{x:y}} @layer late{b{x:y}} c{x:y}");
        let layers: Vec<_> = found.iter().map(|rule| rule.layer).collect();
        assert_eq!(layers, [2, 1, usize::MAX]);
    }
}
