//! Completes a path typed into the file dialog.

use std::path::{Path, PathBuf};

use crate::design::DesignSource;

/// Maximum number of completions (heuristic: as many as fit next to the file list).
const MAX_COMPLETIONS: usize = 6;

/// Full path for a path typed relative to `folder`; `~` stands for the user's home folder.
#[must_use]
pub fn expand_path(typed: &str, folder: &Path) -> PathBuf {
    let typed = typed.trim();
    let below_home = typed
        .strip_prefix("~/")
        .or_else(|| (typed == "~").then_some(""));
    match below_home.and_then(|below| Some(dirs::home_dir()?.join(below))) {
        Some(path) => path,
        None => folder.join(typed),
    }
}

/// Path of the design or project that was typed: a file, an element of a drawing as in
/// `leaf.svg#stalk`, or text as in `glyph:D`. `None` if its file does not exist.
#[must_use]
pub fn typed_source(typed: &str, folder: &Path) -> Option<PathBuf> {
    let typed = typed.trim();
    let source = match DesignSource::parse(typed.as_ref(), |_| false) {
        DesignSource::Text { .. } => DesignSource::in_folder(folder, typed.as_ref()),
        DesignSource::File { .. } => DesignSource::from_path(&expand_path(typed, folder)),
    };
    let exists = source.file().is_none_or(Path::is_file);
    exists.then(|| source.to_path())
}

/// Folders, and files with one of the `extensions`, whose names start with the last component
/// typed: folders first, sorted by name, at most [`MAX_COMPLETIONS`]. Hidden entries appear only if
/// a dot was typed.
#[must_use]
pub fn completions(typed: &str, folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let path = expand_path(typed, folder);
    let is_folder = typed.is_empty() || typed.ends_with(['/', std::path::MAIN_SEPARATOR]);
    let (folder_to_list, prefix) = if is_folder {
        (path.as_path(), String::new())
    } else {
        let name = path.file_name().unwrap_or_default();
        let prefix = name.to_string_lossy().to_lowercase();
        (path.parent().unwrap_or(folder), prefix)
    };
    let Ok(entries) = std::fs::read_dir(folder_to_list) else {
        return Vec::new();
    };
    let mut matches: Vec<(bool, String, PathBuf)> = entries
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let name = path.file_name()?.to_string_lossy().to_lowercase();
            let has_prefix =
                name.starts_with(&prefix) && (prefix.starts_with('.') || !name.starts_with('.'));
            let is_file = !path.is_dir();
            let extension = path
                .extension()
                .unwrap_or_default()
                .to_string_lossy()
                .to_lowercase();
            let is_readable = !is_file || extensions.contains(&extension.as_str());
            (has_prefix && is_readable).then_some((is_file, name, path))
        })
        .collect();
    matches.sort();
    matches.truncate(MAX_COMPLETIONS);
    matches.into_iter().map(|(_, _, path)| path).collect()
}

/// The path as text for the input field; folders end with a separator.
#[must_use]
pub fn text(path: &Path) -> String {
    let separator = if path.is_dir() {
        std::path::MAIN_SEPARATOR_STR
    } else {
        ""
    };
    format!("{}{separator}", path.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_complete_to_entries_of_the_folder() {
        let temporary = tempfile::tempdir().expect("a folder");
        let folder = temporary.path();
        std::fs::create_dir(folder.join("Drawings")).expect("a folder");
        for name in ["drum.svg", "Drum.txt", ".dress.svg", "cat.png"] {
            std::fs::write(folder.join(name), "").expect("a file");
        }
        let names = |typed: &str| -> Vec<String> {
            let completions = completions(typed, folder, &["svg", "png"]);
            let relative = completions
                .iter()
                .filter_map(|path| path.strip_prefix(folder).ok());
            relative.map(|path| path.display().to_string()).collect()
        };
        assert_eq!(names("dr"), ["Drawings", "drum.svg"]);
        assert_eq!(names(""), ["Drawings", "cat.png", "drum.svg"]);
        assert_eq!(names(".d"), [".dress.svg"]);
        assert_eq!(names("nowhere/x"), Vec::<String>::new());
        let inside = text(&folder.join("Drawings"));
        assert!(completions(&inside, folder, &["svg"]).is_empty());
        assert_eq!(expand_path("cat.png", folder), folder.join("cat.png"));
    }

    #[test]
    fn files_elements_and_text_can_be_typed() {
        let temporary = tempfile::tempdir().expect("a folder");
        let folder = temporary.path();
        for name in ["drum.svg", "light.ttf"] {
            std::fs::write(folder.join(name), "").expect("a file");
        }
        let typed = |typed: &str| typed_source(typed, folder);
        assert_eq!(typed("drum.svg"), Some(folder.join("drum.svg")));
        assert_eq!(typed("drum.svg#rim"), Some(folder.join("drum.svg#rim")));
        assert_eq!(typed("drumm.svg"), None);
        assert_eq!(typed(" glyph:Hello you"), Some("glyph:Hello you".into()));
        let font = folder.join("light.ttf");
        let in_font = format!("glyph:D@{}", font.display());
        assert_eq!(typed("glyph:D@light.ttf"), Some(in_font.into()));
        assert_eq!(typed("glyph:D@bold.ttf"), None);
    }
}
