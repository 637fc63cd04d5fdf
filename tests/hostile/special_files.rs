//! Tests that paths to devices, pipes, folders and files that are too large are refused.

use std::fs::File;

use morphospace::design::MAX_FILE_BYTES;

use crate::bounded_run::BoundedFixture;

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_refused_before_they_are_read() {
    let fixture = BoundedFixture::new();
    let status = std::process::Command::new("mkfifo")
        .arg(fixture.path("pipe.svg"))
        .status();
    assert!(status.expect("mkfifo").success());
    for font in ["font.ttf", "link.morph"] {
        std::os::unix::fs::symlink("/dev/zero", fixture.path(font)).expect("linked");
    }
    for file in ["/dev/zero", "/dev/urandom", "pipe.svg", "glyph:A@font.ttf"] {
        fixture.assert_refused(file, "a device or a pipe, not a file");
        let design = format!("[[designs]]\npath = \"{file}\"\n");
        fixture.write("p.morph", format!("version = 1\n{design}{design}"));
        fixture.assert_inputs_refused(&["p.morph"], file, "a device or a pipe, not a file");
    }
    fixture.assert_inputs_refused(
        &["link.morph"],
        "link.morph",
        "a device or a pipe, not a file",
    );
    let output = fixture.run(&["check", "--pairs", "/dev/zero", "--out", "x.csv"]);
    output.assert_one_line_error();
    assert!(
        output.stderr.contains("a device or a pipe, not a file"),
        "{output:?}"
    );
}

#[test]
fn folders_and_huge_files_are_refused() {
    let fixture = BoundedFixture::new();
    std::fs::create_dir(fixture.path("folder.svg")).expect("made");
    fixture.assert_refused("folder.svg", "choose a file in it");
    fixture.assert_inputs_refused(&["."], ".", "choose a file in it");
    for file in ["large.json", "large.morph"] {
        let large = File::create(fixture.path(file)).expect("made");
        // The file is sparse, so its 1 TiB takes no space on the disk.
        large.set_len(1 << 40).expect("grown");
    }
    let reason = format!("larger than the limit of {} MiB", MAX_FILE_BYTES >> 20);
    fixture.assert_refused("large.json", &reason);
    fixture.assert_inputs_refused(&["large.morph"], "large.morph", &reason);
}
