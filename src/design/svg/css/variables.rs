//! Custom properties and their substitution into values (CSS Custom Properties 1).

use super::tokens::find_outside_brackets;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Maximum length of a value after substitution, in bytes (resource limit: variables that repeat
/// other variables grow exponentially).
const MAX_VALUE: usize = 100_000;

/// Maximum number of variables that refer to each other in a chain (resource limit: the resolver
/// recurses).
const MAX_CHAIN: usize = 64;

/// Custom properties of an element with their computed values.
pub(in crate::design::svg) type Variables = Rc<BTreeMap<String, String>>;

/// Computes the custom properties of an element from its declarations, the winning one for each
/// name, and those of its parent.
pub(in crate::design::svg) fn computed_variables(
    declared: &BTreeMap<&str, &str>,
    parent: &Variables,
) -> Variables {
    if declared.is_empty() {
        return Rc::clone(parent);
    }
    let mut resolver = VariableResolver {
        declared,
        parent,
        resolved: BTreeMap::new(),
    };
    for name in declared.keys() {
        resolver.value(name, 0);
    }
    let mut all = BTreeMap::clone(parent);
    for (name, value) in resolver.resolved {
        match value {
            Some(value) => all.insert(name, value),
            None => all.remove(&name),
        };
    }
    Rc::new(all)
}

/// Resolver of the variables of one element.
struct VariableResolver<'v> {
    declared: &'v BTreeMap<&'v str, &'v str>,
    parent: &'v Variables,
    /// Values computed so far; `None` for invalid values, and for values in progress, so that
    /// circular references are invalid.
    resolved: BTreeMap<String, Option<String>>,
}

impl VariableResolver<'_> {
    fn value(&mut self, name: &str, depth: usize) -> Option<String> {
        if let Some(known) = self.resolved.get(name) {
            return known.clone();
        }
        let inherited = self.parent.get(name).cloned();
        let value = match self.declared.get(name) {
            None | Some(&("inherit" | "unset" | "revert")) => return inherited,
            Some(&"initial") => None,
            Some(_) if depth > MAX_CHAIN => None,
            Some(declared) => {
                self.resolved.insert(name.to_owned(), None);
                substitute(declared, &mut |name| self.value(name, depth + 1))
            }
        };
        self.resolved.insert(name.to_owned(), value.clone());
        value
    }
}

/// Returns whether a value refers to a variable.
pub(in crate::design::svg) fn has_references(value: &str) -> bool {
    let lower = value.to_ascii_lowercase();
    lower.contains("var(") || lower.contains("env(")
}

/// Replaces all `var(…)` and `env(…)` of a value. Returns `None` if a variable has neither a value
/// nor a fallback, or the result is too long.
pub(in crate::design::svg) fn substitute(
    value: &str,
    variable: &mut dyn FnMut(&str) -> Option<String>,
) -> Option<String> {
    substitute_nested(value, variable, 0)
}

fn substitute_nested(
    value: &str,
    variable: &mut dyn FnMut(&str) -> Option<String>,
    depth: usize,
) -> Option<String> {
    if depth > MAX_CHAIN {
        return None;
    }
    let mut replaced = String::new();
    let mut rest = value;
    while let Some((at, keyword)) = next_reference(rest) {
        replaced.push_str(&rest[..at]);
        let inner = &rest[at + 4..];
        let end = find_outside_brackets(inner, ")").unwrap_or(inner.len());
        let arguments = &inner[..end];
        rest = inner.get(end + 1..).unwrap_or_default();
        let comma = find_outside_brackets(arguments, ",");
        let name = arguments[..comma.unwrap_or(arguments.len())].trim();
        // No environment variable of browsers has a value in a picture.
        let known = (keyword == "var(").then(|| variable(name)).flatten();
        match (known, comma) {
            (Some(known), _) => replaced.push_str(known.trim()),
            (None, Some(comma)) => {
                let fallback = arguments[comma + 1..].trim();
                replaced.push_str(&substitute_nested(fallback, variable, depth + 1)?);
            }
            (None, None) => return None,
        }
        if replaced.len() > MAX_VALUE {
            return None;
        }
    }
    replaced.push_str(rest);
    Some(replaced)
}

/// Returns the position of the first reference to a variable, and its keyword.
fn next_reference(text: &str) -> Option<(usize, &'static str)> {
    let bytes = text.as_bytes();
    let at = |keyword: &'static str| {
        let is_here = |window: &[u8]| window.eq_ignore_ascii_case(keyword.as_bytes());
        let is_name = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
        let mut starts = (0..bytes.len().saturating_sub(3)).filter(|&i| is_here(&bytes[i..i + 4]));
        starts
            .find(|&i| i == 0 || !is_name(bytes[i - 1]))
            .map(|i| (i, keyword))
    };
    at("var(").into_iter().chain(at("env(")).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn computed(declared: &[(&str, &str)], parent: &[(&str, &str)]) -> String {
        let declared = declared.iter().copied().collect();
        let owned = |&(name, value): &(&str, &str)| (name.to_owned(), value.to_owned());
        let parent = Rc::new(parent.iter().map(owned).collect());
        let all = computed_variables(&declared, &parent);
        let pairs = all.iter().map(|(name, value)| format!("{name}:{value}"));
        pairs.collect::<Vec<_>>().join(";")
    }

    #[test]
    fn variables_refer_to_each_other_and_to_inherited_ones() {
        let declared = [
            ("--a", "var(--b) 1"),
            ("--b", "VAR(--c, 2)"),
            ("--d", "var(--p)"),
        ];
        let all = computed(&declared, &[("--p", "7"), ("--b", "old")]);
        assert_eq!(all, "--a:2 1;--b:2;--d:7;--p:7");
    }

    #[test]
    fn circular_and_missing_references_are_invalid() {
        let declared = [
            ("--a", "var(--b)"),
            ("--b", "var(--a)"),
            ("--c", "var(--none)"),
        ];
        assert_eq!(computed(&declared, &[("--c", "1")]), "");
        let fallback = [
            ("--a", "var(--none, rgb(1, 2, 3))"),
            ("--b", "var(--none,)"),
        ];
        assert_eq!(computed(&fallback, &[]), "--a:rgb(1, 2, 3);--b:");
    }

    #[test]
    fn exponential_values_are_invalid() {
        let names: Vec<_> = (0..30).map(|i| format!("--v{i}")).collect();
        let values: Vec<_> = (0..30)
            .map(|i| match i {
                0 => "x".repeat(10),
                i => format!("var(--v{0}) var(--v{0})", i - 1),
            })
            .collect();
        let declared: Vec<_> = names
            .iter()
            .map(|n| &**n)
            .zip(values.iter().map(|v| &**v))
            .collect();
        assert!(computed(&declared, &[]).len() < 3 * MAX_VALUE);
    }
}
