//! Expands entities that contain elements, so that the limits on elements apply to the expanded
//! text.
//!
//! Entities without elements are left to the XML parser. If one has elements, the document type is
//! removed and all references to its entities are replaced.

use super::error::SvgError;
use super::xml_limits::{DECLARATION, MAX_EXPANDED, entity};
use std::borrow::Cow;
use std::collections::HashMap;

/// Maximum number of entities that refer to each other in a chain (resource limit: the expansion
/// recurses).
const MAX_CHAIN: usize = 16;

/// Returns the text with its entities expanded if one of them contains elements.
pub(super) fn with_expanded_elements(text: &str) -> Result<Cow<'_, str>, SvgError> {
    let Some((head, document_type, body)) = split_document_type(text) else {
        return Ok(Cow::Borrowed(text));
    };
    let declarations = document_type.split(DECLARATION).skip(1).filter_map(entity);
    let mut values: HashMap<&str, &str> = HashMap::new();
    for (name, value) in declarations {
        if let Some(value) = value {
            values.entry(name).or_insert(value); // the first declaration counts
        }
    }
    if !values.values().any(|value| value.contains('<')) {
        return Ok(Cow::Borrowed(text));
    }
    let mut expansion = EntityExpansion {
        values: &values,
        out: head.to_owned(),
        spent: 0,
    };
    // Lines keep their numbers.
    let lines = document_type.matches('\n').count();
    expansion.out.push_str(&"\n".repeat(lines));
    expansion.expand(body, None, 0)?;
    Ok(Cow::Owned(expansion.out))
}

/// Splits a text into the part before its document type, the document type, and the rest.
fn split_document_type(text: &str) -> Option<(&str, &str, &str)> {
    let start = text.find("<!DOCTYPE")?;
    let subset = text[start..].find('[')? + start;
    let mut end = subset + 1;
    loop {
        let rest = &text[end..];
        let next = rest.find(['"', '\'', ']', '<'])?;
        let found = &rest[next..];
        end += next
            + match found.as_bytes()[0] {
                b']' => break end += next + 1,
                b'<' if found.starts_with("<!--") => found.find("-->")? + 3,
                b'<' => 1,
                quote => found[1..].find(char::from(quote))? + 2,
            };
    }
    let close = text[end..].find('>')? + end + 1;
    Some((&text[..start], &text[start..close], &text[close..]))
}

/// Expansion of entities, with the text written so far.
struct EntityExpansion<'e> {
    values: &'e HashMap<&'e str, &'e str>,
    out: String,
    /// Number of bytes written and of steps taken, since empty entities take time, too.
    spent: u64,
}

impl EntityExpansion<'_> {
    /// Appends a text with all references expanded. `quote` is the quotation mark of the attribute
    /// value that the text belongs to, if any.
    fn expand(&mut self, text: &str, quote: Option<char>, depth: usize) -> Result<(), SvgError> {
        let (mut rest, mut quote, is_value) = (text, quote, quote.is_some());
        let mut is_in_tag = is_value;
        while let Some(at) = rest.find(['<', '>', '&', '"', '\'']) {
            let (before, found) = rest.split_at(at);
            self.push(before)?;
            let mark = found.chars().next().unwrap_or_default();
            let mut length = 1;
            match mark {
                '&' => {
                    rest = self.reference(found, quote, depth)?;
                    continue;
                }
                '<' if quote.is_none() => {
                    length = opaque_length(found).unwrap_or(1);
                    is_in_tag = length == 1;
                }
                '>' if quote.is_none() => is_in_tag = false,
                '"' | '\'' if is_value && quote == Some(mark) => {
                    // The value of the entity is data, not the end of the attribute.
                    self.push(if mark == '"' { "&quot;" } else { "&apos;" })?;
                    rest = &found[1..];
                    continue;
                }
                '"' | '\'' if is_in_tag && quote == Some(mark) => quote = None,
                '"' | '\'' if is_in_tag && quote.is_none() => quote = Some(mark),
                _ => {}
            }
            self.push(&found[..length])?;
            rest = &found[length..];
        }
        self.push(rest)
    }

    /// Expands the reference at the start of a text; returns the text after it.
    fn reference<'t>(
        &mut self,
        text: &'t str,
        quote: Option<char>,
        depth: usize,
    ) -> Result<&'t str, SvgError> {
        let name = text[1..]
            .split(|c: char| c == ';' || c.is_whitespace())
            .next();
        let name = name.unwrap_or_default();
        let Some(value) = self.values.get(name) else {
            self.push("&")?;
            return Ok(&text[1..]);
        };
        if depth == MAX_CHAIN {
            return Err(SvgError::TooMuchText);
        }
        self.expand(value, quote, depth + 1)?;
        let after = &text[1 + name.len()..];
        Ok(after.strip_prefix(';').unwrap_or(after))
    }

    fn push(&mut self, text: &str) -> Result<(), SvgError> {
        self.out.push_str(text);
        self.spent += text.len() as u64 + 1;
        match self.spent > MAX_EXPANDED {
            true => Err(SvgError::TooMuchText),
            false => Ok(()),
        }
    }
}

/// Returns the length of a comment, a CDATA section or a processing instruction at the start of a
/// text, in which references are not expanded.
fn opaque_length(text: &str) -> Option<usize> {
    let ends = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
    let (start, end) = ends
        .into_iter()
        .find(|(start, _)| text.starts_with(start))?;
    let inner = text[start.len()..].find(end)?;
    Some(start.len() + inner + end.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expanded(subset: &str, body: &str) -> String {
        let text = format!("<?xml version='1.0'?><!DOCTYPE svg [{subset}]><svg>{body}</svg>");
        let found = with_expanded_elements(&text).expect("small");
        let (_, svg) = found.split_once("<svg>").expect("an element");
        svg.trim_end_matches("</svg>").to_owned()
    }

    #[test]
    fn references_become_elements() {
        let shape = "<!ENTITY s '<rect/>'><!-- ]> ' --><!ENTITY t \"&s;<g a='&q;'/>\"><!ENTITY q 'it&#39;s'>";
        assert_eq!(
            expanded(shape, "&s;&lt;&t;"),
            "<rect/>&lt;<rect/><g a='it&#39;s'/>"
        );
        assert_eq!(
            expanded(shape, "<!-- &s; --><![CDATA[&s;]]>"),
            "<!-- &s; --><![CDATA[&s;]]>"
        );
        assert_eq!(expanded(shape, "&unknown;"), "&unknown;");
        let quotes = "<!ENTITY s '<rect/>'><!ENTITY f '\"Arial\"'>";
        assert_eq!(
            expanded(quotes, "<t f=\"&f;\"/>"),
            "<t f=\"&quot;Arial&quot;\"/>"
        );
    }

    #[test]
    fn text_without_such_entities_stays_as_it_is() {
        for text in [
            "<svg/>",
            "<!DOCTYPE svg><svg/>",
            "<!DOCTYPE svg [<!ENTITY a 'b'>]><svg/>",
        ] {
            let found = with_expanded_elements(text).expect("small");
            assert!(matches!(found, Cow::Borrowed(same) if same == text));
        }
    }

    #[test]
    fn exponential_and_circular_entities_are_refused() {
        let refused = |subset: &str| {
            let text = format!("<!DOCTYPE svg [{subset}]><svg>&a0;</svg>");
            matches!(with_expanded_elements(&text), Err(SvgError::TooMuchText))
        };
        assert!(refused("<!ENTITY a0 '<g/>&a0;'>"));
        let levels =
            (0..9).map(|i| format!("<!ENTITY a{i} '{}'>", format!("&a{};", i + 1).repeat(20)));
        let levels: String = levels.collect();
        for last in ["<!ENTITY a9 '<g/>'>", "<!ENTITY a9 ''><!ENTITY b '<g/>'>"] {
            assert!(refused(&format!("{levels}{last}")), "{last}");
        }
    }
}
