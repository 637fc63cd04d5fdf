//! Default title of a project, from the names of its designs.

/// Maximum number of names listed in a title. With more designs, the title gives only the first
/// name, the last name and the number of designs (heuristic).
const MAX_NAMES: usize = 3;

/// Returns a title made from the names of the designs: "a to b" or "a to f, 6 designs".
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
