//! File names that are valid on every common file system.

/// Maximum length of a name in bytes (limit of file systems: 255 bytes, of which 15 are left for a
/// number and an extension).
const MAX_BYTES: usize = 240;

/// Maximum number of characters of a name (resource limit: [`MAX_BYTES`] in scripts with three bytes
/// per letter).
const MAX_LETTERS: usize = 80;

/// Returns `name` with every character except letters, digits and `-_. ,()+&` replaced by `-`, and
/// without dots and spaces at both ends.
///
/// The result has at most [`MAX_LETTERS`] and [`MAX_BYTES`]. An empty result becomes `untitled`.
#[must_use]
pub fn safe_file_name(name: &str) -> String {
    let replace = |c: char| {
        if c.is_alphanumeric() || "-_. ,()+&".contains(c) {
            c
        } else {
            '-'
        }
    };
    let mut replaced: String = name.chars().take(MAX_LETTERS).map(replace).collect();
    replaced.truncate(replaced.floor_char_boundary(MAX_BYTES));
    // A leading dot hides a file on Unix. Windows drops trailing dots and spaces.
    let trimmed = replaced.trim_matches(|c| c == '.' || c == ' ');
    if trimmed.is_empty() {
        "untitled".to_owned()
    } else {
        trimmed.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe() {
        assert_eq!(safe_file_name("a/b\\c:d"), "a-b-c-d");
        assert_eq!(
            safe_file_name("a to d, 4 designs (2)"),
            "a to d, 4 designs (2)"
        );
        assert_eq!(safe_file_name(".."), "untitled");
        assert_eq!(safe_file_name("  Brücke 2 "), "Brücke 2");
    }

    #[test]
    fn names_of_four_byte_letters_fit_into_a_file_name() {
        let name = safe_file_name(&"\u{10400}".repeat(100));
        assert_eq!(name, "\u{10400}".repeat(60));
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(format!("{name}-2.svg"));
        std::fs::write(path, "").expect("written");
    }
}
