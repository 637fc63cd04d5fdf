//! Refuses XML text that would exhaust the parser, before it is parsed.
//!
//! `roxmltree` limits the nesting of entities but not how often a long one is expanded; it compares
//! the attributes of an element, and the namespaces in scope, pair by pair; and it allocates memory
//! for all nodes before it counts them. This module bounds all of these costs from the raw text, in
//! one pass each. Its estimates may be too high (comments are counted, too) but never too low.

use super::error::{MAX_NODES, SvgError};
use std::collections::{HashMap, HashSet};

/// Maximum number of bytes that all entity references expand into (resource limit: ample for
/// drawings that store a style in an entity and use it for each shape).
pub(super) const MAX_EXPANDED: u64 = 64 << 20;

/// Maximum number of comparisons of names, separately for attributes, namespaces and entities
/// (resource limit: they take a fraction of a second, and 20,000 attributes of one element are
/// allowed).
const MAX_COMPARISONS: u64 = 200_000_000;

/// Maximum number of references that the parser follows within one entity (defined by
/// `roxmltree`).
const MAX_REFERENCES: u64 = 256;

/// Checks the number of nodes, attributes, namespaces and entities of a text.
pub(super) fn check_xml_text(text: &str) -> Result<(), SvgError> {
    // Each element has a "<", each attribute a "=".
    let max_nodes = text.matches('<').count().max(text.matches('=').count());
    if max_nodes > MAX_NODES as usize {
        return Err(SvgError::TooManyNodes);
    }
    check_attributes(text)?;
    check_namespaces(text)?;
    check_entities(text)
}

/// Returns an error if comparing the attributes of each element pair by pair would take too long.
fn check_attributes(text: &str) -> Result<(), SvgError> {
    let mut comparisons = 0;
    let mut end = 0;
    // Attribute values cannot contain "<", so each substring holds at most one element.
    for element in text.split('<') {
        let is_quoted = |rest: &&str| rest.trim_start().starts_with(['"', '\'']);
        let attributes = element.split('=').skip(1).filter(is_quoted).count() as u64;
        comparisons += attributes * attributes / 2;
        if comparisons > MAX_COMPARISONS {
            let line = line_of(text, end);
            return Err(SvgError::TooManyAttributes { line, attributes });
        }
        end += element.len() + 1;
    }
    Ok(())
}

/// Returns an error if comparing namespaces would take too long: an element that declares a
/// namespace copies all namespaces in scope.
fn check_namespaces(text: &str) -> Result<(), SvgError> {
    let mut declared = 0_u64;
    let mut prefixes = HashSet::new();
    for rest in text.split("xmlns").skip(1) {
        declared += 1;
        let end = rest.find(|c: char| c == '=' || c.is_whitespace());
        prefixes.insert(&rest[..end.unwrap_or(rest.len())]);
    }
    let in_scope = prefixes.len() as u64;
    match declared.saturating_mul(in_scope * in_scope) / 2 > MAX_COMPARISONS {
        true => Err(SvgError::TooManyNamespaces(prefixes.len())),
        false => Ok(()),
    }
}

/// Returns an error if entities would expand into too much text, or searching for their names would
/// take too long.
fn check_entities(text: &str) -> Result<(), SvgError> {
    let mut sizes: HashMap<&str, u64> = HashMap::new();
    let mut are_nested = false;
    let mut longest = 0;
    let mut end = 0;
    for (i, declaration) in text.split(DECLARATION).enumerate() {
        if let (Some((name, value)), true) = (entity(declaration), i > 0) {
            // Entities must not contain elements, which would invalidate all other counts.
            let value = value.filter(|value| !value.contains('<'));
            let line = || line_of(text, end);
            let value = value.ok_or_else(|| SvgError::EntityOfElements(line()))?;
            are_nested |= references(value).next().is_some();
            let size = sizes.entry(name).or_default();
            *size = (*size).max(value.len() as u64);
            longest = longest.max(*size);
        }
        end += declaration.len() + DECLARATION.len();
    }
    if sizes.is_empty() {
        return Ok(());
    }
    let (mut expanded, mut reference_count) = (0_u64, 0_u64);
    for size in references(text).filter_map(|name| sizes.get(name)) {
        // If entities are nested, each reference is assumed to expand into the longest entity
        // `MAX_REFERENCES` times.
        expanded = expanded.saturating_add(match are_nested {
            true => MAX_REFERENCES * longest,
            false => *size,
        });
        reference_count += if are_nested { MAX_REFERENCES } else { 1 };
    }
    // The parser searches the list of all entities for each reference.
    let comparisons = reference_count.saturating_mul(sizes.len() as u64);
    match expanded > MAX_EXPANDED || comparisons > MAX_COMPARISONS {
        true => Err(SvgError::TooMuchText),
        false => Ok(()),
    }
}

/// Text with which an entity declaration starts.
pub(super) const DECLARATION: &str = "<!ENTITY";

/// Parses name and value of an entity from the text after [`DECLARATION`]. The value is `None` if
/// it does not end before the next declaration.
pub(super) fn entity(declaration: &str) -> Option<(&str, Option<&str>)> {
    let rest = declaration.trim_start();
    // The parser treats parameter entities ("%") like other entities.
    let rest = rest.strip_prefix('%').unwrap_or(rest).trim_start();
    let (name, rest) = rest.split_once(char::is_whitespace)?;
    let rest = rest.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let value = rest[1..].split_once(quote).map(|(value, _)| value);
    Some((name, value))
}

/// Returns the names in all entity references (between `&` and `;`), without numeric character
/// references.
fn references(text: &str) -> impl Iterator<Item = &str> {
    let between = text
        .split('&')
        .skip(1)
        .filter_map(|rest| rest.split_once(';'));
    between
        .map(|(name, _)| name)
        .filter(|name| !name.starts_with('#'))
}

/// Returns the line, counted from 1, of a byte offset.
fn line_of(text: &str, byte: usize) -> usize {
    1 + text.as_bytes()[..byte.min(text.len())]
        .iter()
        .filter(|&&b| b == b'\n')
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawing(head: &str, body: &str) -> Result<(), SvgError> {
        check_xml_text(&format!(
            "<!DOCTYPE svg [\n{head}\n]>\n<svg xmlns=\"http://www.w3.org/2000/svg\">{body}</svg>"
        ))
    }

    #[test]
    fn entities_of_drawing_programs_are_accepted() {
        let head = "<!ENTITY ns_svg \"http://www.w3.org/2000/svg\">\n\
            <!ENTITY st0 \"fill-rule:nonzero;clip-rule:nonzero;stroke:#000000;\">";
        let shapes = "<path style=\"&st0;\" d=\"M0 0\"/>".repeat(20_000);
        drawing(
            head,
            &format!("<g xmlns:svg=\"&ns_svg;\">{shapes}&amp;&#65;</g>"),
        )
        .expect("harmless");
        drawing("<!ENTITY a \"x\"><!ENTITY b '&a;&a;'>", "&b;").expect("harmless");
        drawing("<!ENTITY % a \"x\"><!ENTITY b SYSTEM \"b.xml\">", "&a;").expect("harmless");
    }

    #[test]
    fn exponential_entities_are_refused() {
        let long = format!("<!ENTITY a \"{}\">", "x".repeat(50_000));
        let is_refused =
            |head: &str, body: &str| matches!(drawing(head, body), Err(SvgError::TooMuchText));
        assert!(is_refused(&long, &"&a;".repeat(20_000)));
        assert!(!is_refused(&long, &"&a;".repeat(1_000)));
        let nested = format!("{long}<!ENTITY b \"{}\">", "&a;".repeat(250));
        assert!(is_refused(&nested, &"&b;".repeat(10)));
        let many: String = (0..20_000)
            .map(|i| format!("<!ENTITY e{i} \"\">"))
            .collect();
        assert!(is_refused(&many, &"&e19999;".repeat(20_000)));
        for head in [
            "<!ENTITY a \"<path d='M0 0'/>\">",
            "<!ENTITY a \"x\n<!ENTITY b 'y'>\">",
        ] {
            let error = drawing(head, "&a;").expect_err("elements");
            assert!(matches!(error, SvgError::EntityOfElements(2)), "{error}");
        }
    }

    #[test]
    fn excessive_attributes_and_namespaces_are_refused() {
        let attributes = |n: usize| (0..n).map(|i| format!("a{i} = \"\"\n")).collect::<String>();
        let element = |n: usize| drawing("", &format!("\n<g {}/>", attributes(n)));
        element(10_000).expect("few");
        let error = element(30_000).expect_err("many");
        assert!(
            matches!(
                error,
                SvgError::TooManyAttributes {
                    line: 5,
                    attributes: 30_000
                }
            ),
            "{error}"
        );
        let names: String = (0..1_000)
            .map(|i| format!("<g xmlns:a{i}=\"b\">"))
            .collect();
        assert!(matches!(
            drawing("", &names),
            Err(SvgError::TooManyNamespaces(1_001))
        ));
        let alike = "<use xmlns:xlink=\"http://www.w3.org/1999/xlink\"/>".repeat(10_000);
        drawing("", &alike).expect("a name or two, over and over");
        assert!(matches!(
            drawing("", &"<".repeat(2_000_001)),
            Err(SvgError::TooManyNodes)
        ));
    }
}
