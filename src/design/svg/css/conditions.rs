//! Conditions of style sheets: `@supports` and media queries.

use super::properties::property;
use super::tokens::components;

/// Maximum depth of nested conditions (resource limit: the reader recurses).
const MAX_DEPTH: usize = 16;

/// Returns whether a condition of `@supports` holds: whether the properties in it are known. Tests
/// of selectors hold.
pub(super) fn is_supported(condition: &str) -> bool {
    evaluated(condition, 0).unwrap_or(false)
}

/// Evaluates a condition of `@supports`; `None` if it is nested too deeply.
fn evaluated(condition: &str, depth: usize) -> Option<bool> {
    if depth > MAX_DEPTH {
        return None;
    }
    let condition = condition.trim();
    let lower = condition.to_ascii_lowercase();
    let negated = lower.strip_prefix("not");
    if negated.is_some_and(|rest| rest.starts_with([' ', '('])) {
        return evaluated(&condition[3..], depth + 1).map(|holds| !holds);
    }
    let words = components(condition);
    let joint = words.get(1).map(|joint| joint.to_ascii_lowercase());
    if let Some(joint @ ("and" | "or")) = joint.as_deref() {
        let parts = words.iter().step_by(2);
        let parts: Option<Vec<bool>> = parts.map(|part| evaluated(part, depth + 1)).collect();
        return parts.map(|parts| match joint {
            "and" => parts.into_iter().all(|holds| holds),
            _ => parts.into_iter().any(|holds| holds),
        });
    }
    let inner = condition.strip_prefix('(');
    let Some(inner) = inner.and_then(|rest| rest.strip_suffix(')')) else {
        return Some(lower.starts_with("selector("));
    };
    match inner.split_once(':') {
        Some((name, _)) if !name.contains('(') => {
            let name = name.trim().to_ascii_lowercase();
            Some(name.starts_with("--") || property(&name).is_some())
        }
        _ => evaluated(inner, depth + 1),
    }
}

/// Returns whether a list of media queries describes a still picture on a light screen. Sizes are
/// not compared: a drawing has no window.
pub(super) fn media_matches(queries: &str) -> bool {
    let matches = |query: &str| {
        let query = query.trim().to_ascii_lowercase();
        let (query, expected) = match query.strip_prefix("not ") {
            Some(query) => (query.to_owned(), false),
            None => (query, true),
        };
        let parts = query.split(" and ");
        let mut parts = parts.map(|part| part.trim().trim_start_matches("only ").to_owned());
        parts.all(|part| media_part_matches(&part)) == expected
    };
    queries.trim().is_empty() || queries.split(',').any(matches)
}

/// Returns whether one part of a media query, in lower case, describes a still picture on a light
/// screen.
fn media_part_matches(part: &str) -> bool {
    let feature = part.trim_matches(['(', ')']).split_once(':');
    match feature.map(|(name, value)| (name.trim(), value.trim())) {
        Some(("prefers-color-scheme", value)) => value == "light",
        Some(("prefers-reduced-motion", value)) => value == "no-preference",
        Some(("hover" | "any-hover", value)) => value == "hover",
        Some(_) => true,
        None => part.starts_with('(') || matches!(part, "all" | "screen" | ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions_hold_if_their_properties_are_known() {
        for (condition, expected) in [
            ("(fill: red)", true),
            ("(display: grid) and (not (no-such: x))", true),
            ("(no-such: x) or (fill: red)", true),
            ("(fill: red) and (no-such: x)", false),
            ("not (fill: red)", false),
            ("not ((no-such: x))", true),
            ("selector(:has(a))", true),
            ("", false),
            (&"(".repeat(100_000), false),
            (&"not ".repeat(100_000), false),
        ] {
            assert_eq!(is_supported(condition), expected, "{condition:.40}");
        }
    }
}
