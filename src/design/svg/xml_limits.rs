//! Drawings whose text is a trap for the parser, refused before it is parsed.
//!
//! `roxmltree` limits how deep entities lie in each other, but not how often
//! a long one is written out; it compares the attributes of an element, and
//! the namespaces around one, each with each; and it makes room for all
//! nodes before it counts them. Here all of that is bounded from the text
//! alone, in a pass for each. Too much may be counted, what stands in
//! a comment for one, too little never.

use super::error::{MAX_NODES, SvgError};
use std::collections::{HashMap, HashSet};

/// Most bytes that entities may stand for. Drawings with a style in an entity write it
/// out for each shape.
const MAX_UNFOLDED: u64 = 64 << 20;

/// Most comparisons of names: some 20,000 attributes of one element, which
/// take a fraction of a second. Ten times as many take a hundred times as
/// long.
const MAX_COMPARISONS: u64 = 200_000_000;

/// How much one entity of others can stand for, in lengths of the longest:
/// the parser follows no more references from one.
const MAX_REFERENCES: u64 = 256;

/// Checks what the parser would do with a text.
pub(super) fn check_xml_text(text: &str) -> Result<(), SvgError> {
    // An element for each of the first, an attribute for each of the second.
    let most = text.matches('<').count().max(text.matches('=').count());
    if most > MAX_NODES as usize {
        return Err(SvgError::TooManyNodes);
    }
    check_attributes(text)?;
    check_namespaces(text)?;
    check_entities(text)
}

fn check_attributes(text: &str) -> Result<(), SvgError> {
    let mut comparisons = 0;
    let mut end = 0;
    // No value holds the sign that begins an element.
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

/// Each element that declares one takes over all that are around it.
fn check_namespaces(text: &str) -> Result<(), SvgError> {
    let mut declared = 0_u64;
    let mut prefixes = HashSet::new();
    for rest in text.split("xmlns").skip(1) {
        declared += 1;
        let end = rest.find(|c: char| c == '=' || c.is_whitespace());
        prefixes.insert(&rest[..end.unwrap_or(rest.len())]);
    }
    let around = prefixes.len() as u64;
    match declared.saturating_mul(around * around) / 2 > MAX_COMPARISONS {
        true => Err(SvgError::TooManyNamespaces(prefixes.len())),
        false => Ok(()),
    }
}

fn check_entities(text: &str) -> Result<(), SvgError> {
    let mut sizes: HashMap<&str, u64> = HashMap::new();
    let mut are_nested = false;
    let mut longest = 0;
    let mut end = 0;
    for (i, declaration) in text.split(DECLARED).enumerate() {
        if let (Some((name, value)), true) = (entity(declaration), i > 0) {
            // With elements in it, all other counts would be for nothing.
            let value = value.filter(|value| !value.contains('<'));
            let line = || line_of(text, end);
            let value = value.ok_or_else(|| SvgError::EntityOfElements(line()))?;
            are_nested |= references(value).next().is_some();
            let size = sizes.entry(name).or_default();
            *size = (*size).max(value.len() as u64);
            longest = longest.max(*size);
        }
        end += declaration.len() + DECLARED.len();
    }
    if sizes.is_empty() {
        return Ok(());
    }
    let (mut unfolded, mut named) = (0_u64, 0_u64);
    for size in references(text).filter_map(|name| sizes.get(name)) {
        // Of which others it consists need not be known: none is longer.
        unfolded = unfolded.saturating_add(match are_nested {
            true => MAX_REFERENCES * longest,
            false => *size,
        });
        named += if are_nested { MAX_REFERENCES } else { 1 };
    }
    // Each is looked for in the list of them all.
    let searched = named.saturating_mul(sizes.len() as u64);
    match unfolded > MAX_UNFOLDED || searched > MAX_COMPARISONS {
        true => Err(SvgError::TooMuchText),
        false => Ok(()),
    }
}

const DECLARED: &str = "<!ENTITY";

/// The name and the value of an entity from what follows its declaration's
/// beginning: `None` for the value if it does not end before the next begins.
fn entity(declaration: &str) -> Option<(&str, Option<&str>)> {
    let rest = declaration.trim_start();
    // One for the declarations alone, which the parser takes for any other.
    let rest = rest.strip_prefix('%').unwrap_or(rest).trim_start();
    let (name, rest) = rest.split_once(char::is_whitespace)?;
    let rest = rest.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let value = rest[1..].split_once(quote).map(|(value, _)| value);
    Some((name, value))
}

/// What stands between `&` and `;`, but for characters by their number.
fn references(text: &str) -> impl Iterator<Item = &str> {
    let named = text
        .split('&')
        .skip(1)
        .filter_map(|rest| rest.split_once(';'));
    named
        .map(|(name, _)| name)
        .filter(|name| !name.starts_with('#'))
}

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
    fn entities_as_programs_write_them_are_taken() {
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
    fn entities_that_unfold_without_end_are_refused() {
        let long = format!("<!ENTITY a \"{}\">", "x".repeat(50_000));
        let written =
            |head: &str, body: &str| matches!(drawing(head, body), Err(SvgError::TooMuchText));
        assert!(written(&long, &"&a;".repeat(20_000)));
        assert!(!written(&long, &"&a;".repeat(1_000)));
        let nested = format!("{long}<!ENTITY b \"{}\">", "&a;".repeat(250));
        assert!(written(&nested, &"&b;".repeat(10)));
        let many: String = (0..20_000)
            .map(|i| format!("<!ENTITY e{i} \"\">"))
            .collect();
        assert!(written(&many, &"&e19999;".repeat(20_000)));
        for head in [
            "<!ENTITY a \"<path d='M0 0'/>\">",
            "<!ENTITY a \"x\n<!ENTITY b 'y'>\">",
        ] {
            let error = drawing(head, "&a;").expect_err("elements");
            assert!(matches!(error, SvgError::EntityOfElements(2)), "{error}");
        }
    }

    #[test]
    fn attributes_and_namespaces_without_end_are_refused() {
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
