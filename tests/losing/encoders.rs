//! Encoders that lie, fail or hang: what was there before stays, bit by bit.
//! (Those that hang are ended in `endings`.)

use std::fs;

use crate::workshop::{Workshop, words};
use crate::{command_with_fake, fake_ffmpeg, with_own};

const EARLIER: &[u8] = b"an earlier good film";

const FILM: &str = "render a.obj b.obj --frames 4 --play once --size 64x48 --out film.mp4";

/// An MP4 with nothing but what tells how many frames there are, and bytes for
/// them.
fn film(frames: u32) -> Vec<u8> {
    let boxed = |kind: &[u8], content: &[u8]| {
        let size = content.len() as u32 + 8;
        [&size.to_be_bytes(), kind, content].concat()
    };
    let table: Vec<u8> = [0, 100, frames].map(u32::to_be_bytes).concat();
    let way = ["stsz", "stbl", "minf", "mdia", "trak", "moov"];
    let track = way
        .iter()
        .fold(table, |inside, kind| boxed(kind.as_bytes(), &inside));
    let media = boxed(b"mdat", &vec![1; 100 * frames as usize]);
    [boxed(b"ftyp", b"isom"), track, media].concat()
}

/// What the program says of a film by an ffmpeg that is this script, where its
/// film is no good.
fn said_of(script: &str) -> String {
    let shop = Workshop::new();
    fs::write(shop.path("film.mp4"), EARLIER).expect("written");
    for (name, bytes) in [
        ("whole", film(4)),
        ("fewer", film(2)),
        ("cut", film(4)[..300].to_vec()),
    ] {
        fs::write(shop.path(name), bytes).expect("written");
    }
    fake_ffmpeg(&shop, script);
    let output = command_with_fake(&shop, FILM).output().expect("it starts");
    let said = words(&output);
    assert_eq!(output.status.code(), Some(1), "{script}: {said}");
    assert_eq!(said.lines().count(), 1, "{script}: {said}");
    assert!(said.contains("film.mp4"), "{script}: {said}");
    assert!(!said.contains(".part"), "{script}: {said}");
    let kept = fs::read(shop.path("film.mp4")).expect("read");
    assert_eq!(kept, EARLIER, "{script}");
    let expected = with_own(&["bin", "cut", "fewer", "film.mp4", "whole"]);
    assert_eq!(shop.names("."), expected, "{script}");
    said
}

#[test]
fn an_encoder_that_says_that_all_is_well_is_not_believed() {
    for (script, told) in [
        ("cat > /dev/null", "no part `moov`"),
        ("exit 0", "no part `moov`"),
        ("cat > /dev/null; rm \"$out\"", "did not come out whole"),
        ("cat > /dev/null; cat fewer > \"$out\"", "2 of 4 frames"),
        ("cat > /dev/null; cat cut > \"$out\"", "`mdat` is cut off"),
        (
            "cat > /dev/null; echo 'moov atom not written' >&2",
            "ffmpeg said: moov atom not written",
        ),
    ] {
        let said = said_of(script);
        assert!(said.contains("did not come out whole"), "{script}: {said}");
        assert!(said.contains(told), "{script}: {said}");
    }
}

#[test]
fn a_film_that_cannot_be_decoded_is_not_taken() {
    let script = "case \"$*\" in *null*) echo 'no picture' >&2; exit 1;; esac\n\
        cat > /dev/null; cat whole > \"$out\"";
    let said = said_of(script);
    assert!(said.contains("no picture"), "{said}");
}

#[test]
fn a_full_disk_is_told_whatever_the_encoder_makes_of_it() {
    let full = "echo 'av_interleaved_write_frame(): No space left on device' >&2";
    for end in ["exit 0", "exit 1", "echo 'Conversion failed!' >&2; exit 1"] {
        let said = said_of(&format!("cat > /dev/null; {full}; {end}"));
        assert!(said.contains("the disk is full"), "{said}");
    }
}

#[test]
fn an_encoder_that_fails_is_quoted_with_the_name_that_the_user_gave() {
    let said = said_of("echo \"$out: Invalid argument\" >&2; exit 1");
    assert!(said.contains(": film.mp4: Invalid argument;"), "{said}");
    let said = said_of("printf '\\033[31mred\\n' >&2; kill -9 $$");
    assert!(said.contains("red") && !said.contains('\u{1b}'), "{said}");
    let said = said_of("exit 3");
    assert!(said.contains("exit status: 3"), "{said}");
}

#[test]
fn an_encoder_that_tells_the_truth_is_believed() {
    let shop = Workshop::new();
    fs::write(shop.path("film.mp4"), EARLIER).expect("written");
    fs::write(shop.path("whole"), film(4)).expect("written");
    // A warning is no failure.
    let script = "case \"$*\" in *null*) exit 0;; esac\n\
        cat > /dev/null; cat whole > \"$out\"; echo 'deprecated' >&2";
    fake_ffmpeg(&shop, script);
    let output = command_with_fake(&shop, FILM).output().expect("it starts");
    assert_eq!(output.status.code(), Some(0), "{}", words(&output));
    assert_eq!(fs::read(shop.path("film.mp4")).expect("read"), film(4));
    assert_eq!(shop.names("."), with_own(&["bin", "film.mp4", "whole"]));
}
