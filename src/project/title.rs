//! What designs are called together.

/// More names are no title: the first and the last are, and how many there are.
const MOST: usize = 3;

/// From the first to the last.
pub(crate) fn title_of(names: &[impl AsRef<str>]) -> String {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    match names.as_slice() {
        [first, .., last] if names.len() > MOST => {
            format!("{first} to {last}, {} designs", names.len())
        }
        few => few.join(" to "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_are_counted() {
        assert_eq!(title_of(&["a", "b"]), "a to b");
        assert_eq!(title_of(&["a", "b", "c"]), "a to b to c");
        assert_eq!(title_of(&["a", "b", "c", "d"]), "a to d, 4 designs");
    }
}
