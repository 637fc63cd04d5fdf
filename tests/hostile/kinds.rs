//! Paths that lead to no file, or to one without end.

use std::fs::File;

use morphospace::design::MAX_FILE_BYTES;

use crate::child::Folder;

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused_before_it_is_read() {
    let folder = Folder::new();
    let made = std::process::Command::new("mkfifo")
        .arg(folder.path("pipe.svg"))
        .status();
    assert!(made.expect("mkfifo").success());
    for font in ["font.ttf", "link.morph"] {
        std::os::unix::fs::symlink("/dev/zero", folder.path(font)).expect("linked");
    }
    for file in ["/dev/zero", "/dev/urandom", "pipe.svg", "glyph:A@font.ttf"] {
        folder.refused(file, "a device or a pipe and no file");
        let design = format!("[[designs]]\npath = \"{file}\"\n");
        folder.put("p.morph", format!("version = 1\n{design}{design}"));
        folder.refused_with(&["p.morph"], file, "a device or a pipe and no file");
    }
    folder.refused_with(
        &["link.morph"],
        "link.morph",
        "a device or a pipe and no file",
    );
    let answer = folder.ask(&["check", "--pairs", "/dev/zero", "--out", "x.csv"]);
    answer.is_one_line();
    assert!(answer.words.contains("and no file"), "{answer:?}");
}

#[test]
fn folders_and_files_without_end_are_refused() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("folder.svg")).expect("made");
    folder.refused("folder.svg", "choose a file in it");
    folder.refused_with(&["."], ".", "choose a file in it");
    for file in ["large.json", "large.morph"] {
        let large = File::create(folder.path(file)).expect("made");
        // Holes take no room on the disk.
        large.set_len(1 << 40).expect("grown");
    }
    let said = format!("more than the {} MiB", MAX_FILE_BYTES >> 20);
    folder.refused("large.json", &said);
    folder.refused_with(&["large.morph"], "large.morph", &said);
}
