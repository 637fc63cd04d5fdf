//! Names of files that every system takes.

/// A name that every file system takes: signs that mean something to one of them become `-`.
#[must_use]
pub fn safe(name: &str) -> String {
    let keep = |c: char| {
        if c.is_alphanumeric() || "-_. ,()+&".contains(c) {
            c
        } else {
            '-'
        }
    };
    // File systems take names of 255 bytes: 80 signs of three leave room for a number and an
    // ending.
    let kept: String = name.chars().take(80).map(keep).collect();
    // A dot in front hides a file on Unix; dots and blanks at the end are dropped on Windows.
    let trimmed = kept.trim_matches(|c| c == '.' || c == ' ');
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
        assert_eq!(safe("a/b\\c:d"), "a-b-c-d");
        assert_eq!(safe("a to d, 4 designs (2)"), "a to d, 4 designs (2)");
        assert_eq!(safe(".."), "untitled");
        assert_eq!(safe("  Brücke 2 "), "Brücke 2");
    }
}
