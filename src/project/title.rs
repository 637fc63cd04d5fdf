//! Default title of a project, from the names of its designs.

/// Maximum number of names listed in a title; with more, only the first, the last and the number
/// of designs are given (heuristic).
const MAX_NAMES: usize = 3;

/// Joins names as in "a to b" or "a to f, 6 designs".
pub(crate) fn title_of(names: &[impl AsRef<str>]) -> String {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    match names.as_slice() {
        [first, .., last] if names.len() > MAX_NAMES => {
            format!("{first} to {last}, {} designs", names.len())
        }
        few => few.join(" to "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_names_are_abbreviated() {
        assert_eq!(title_of(&["a", "b"]), "a to b");
        assert_eq!(title_of(&["a", "b", "c"]), "a to b to c");
        assert_eq!(title_of(&["a", "b", "c", "d"]), "a to d, 4 designs");
    }
}
