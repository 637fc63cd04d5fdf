//! File names that are valid on every common file system.

/// Returns `name` with every character except letters, digits and `-_. ,()+&` replaced by `-`, and
/// without dots and spaces at both ends.
///
/// The result has at most 80 characters. An empty result becomes `untitled`.
#[must_use]
pub fn safe_file_name(name: &str) -> String {
    let replace = |c: char| {
        if c.is_alphanumeric() || "-_. ,()+&".contains(c) {
            c
        } else {
            '-'
        }
    };
    // File systems allow names of 255 bytes. 80 characters take at most 240 bytes (for all but the
    // rarest scripts), which leaves room for a number and an extension.
    let replaced: String = name.chars().take(80).map(replace).collect();
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
}
