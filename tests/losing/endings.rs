//! Asked to end, or killed: at any time, by any signal.

use std::fs;
use std::time::Duration;

use crate::workshop::{Workshop, image, words};
use crate::{
    command_with_fake, fake_ffmpeg, is_alive, on_their_way, send, started, wait_until, with_own,
};

const EARLIER: &str = "what was there before";

/// All that ask a program to end, and let it tidy up.
const WISHES: [&str; 3] = ["INT", "TERM", "HUP"];

/// Longer than any test waits.
const ENDLESS: &str = "render a.obj b.obj --frames 100000 --size 320x240 --out";

#[test]
fn a_film_that_is_ended_leaves_the_earlier_one_and_nothing_else() {
    for name in ["film.gif", "film.apng"] {
        for wish in WISHES {
            let shop = Workshop::new();
            shop.put(name, EARLIER);
            let mut child = started(shop.command(&format!("{ENDLESS} {name}")));
            wait_until("a file on its way", || on_their_way(&shop).len() == 1);
            // A terminal that closes says so itself, and so does its shell.
            send(wish, child.id());
            send(wish, child.id());
            wait_until("the end", || child.try_wait().expect("a child").is_some());
            let output = child.wait_with_output().expect("its words");
            assert_eq!(output.status.code(), Some(1), "{wish}: {}", words(&output));
            assert!(words(&output).contains("cancelled"), "{}", words(&output));
            assert_eq!(shop.names("."), with_own(&[name]), "{wish}");
            assert_eq!(fs::read_to_string(shop.path(name)).expect("read"), EARLIER);
        }
    }
}

#[test]
fn an_encoder_does_not_outlive_the_wish_for_its_work() {
    // It begins a file, takes nothing and never ends.
    const HANGS: &str = "printf half > \"$out\"\necho $$ > pid\nexec sleep 1000";
    // The same after all frames: what waits then is the end.
    let at_end = format!("cat > /dev/null\n{HANGS}");
    for (script, frames) in [(HANGS, 100_000), (&at_end, 3)] {
        for wish in WISHES {
            let shop = Workshop::new();
            shop.put("film.mp4", EARLIER);
            fake_ffmpeg(&shop, script);
            let line =
                format!("render a.obj b.obj --frames {frames} --size 320x240 --out film.mp4");
            let mut child = started(command_with_fake(&shop, &line));
            let written = || fs::read_to_string(shop.path("pid")).unwrap_or_default();
            wait_until("ffmpeg's id", || written().ends_with('\n'));
            send(wish, child.id());
            wait_until("the end", || child.try_wait().expect("a child").is_some());
            assert!(!is_alive(written().trim()), "{wish}: ffmpeg goes on");
            let expected = with_own(&["bin", "film.mp4", "pid"]);
            assert_eq!(shop.names("."), expected, "{wish}");
            let kept = fs::read_to_string(shop.path("film.mp4")).expect("read");
            assert_eq!(kept, EARLIER);
        }
    }
}

/// A kind of output that is written at once, and how it ends when it is whole.
const QUICK: [(&str, &str); 4] = [
    (
        "render a.obj b.obj --at 0.5 --size 64x48 --out x.png",
        "IEND\u{fffd}B`\u{fffd}",
    ),
    ("render a.obj b.obj --sheet 9 --out x.svg", "</svg>\n"),
    ("new a.svg b.svg --force --out x.morph", "\n"),
    ("check --pairs pairs.csv --samples 3 --out x.csv", "\n"),
];

#[test]
fn what_is_written_at_once_is_there_whole_or_as_it_was() {
    for (line, end) in QUICK {
        let name = line.rsplit(' ').next().expect("a name");
        let shop = Workshop::new();
        shop.put("pairs.csv", "source,target\na.obj,b.obj\n");
        shop.put(name, EARLIER);
        for turn in 0..24 {
            let child = started(shop.command(line));
            // At different times, from before it listens to after it ended.
            std::thread::sleep(Duration::from_millis(3 * turn));
            send(WISHES[turn as usize % 3], child.id());
            let output = child.wait_with_output().expect("it ends");
            assert!(!words(&output).contains("panicked"), "{}", words(&output));
            assert_eq!(shop.names("."), with_own(&["pairs.csv", name]), "{line}");
            let there = fs::read(shop.path(name)).expect("read");
            let there = String::from_utf8_lossy(&there);
            assert!(there == EARLIER || there.ends_with(end), "{line}: {there}");
        }
    }
}

#[test]
fn frames_of_a_run_that_ended_half_way_are_whole() {
    for signal in ["TERM", "KILL"] {
        let shop = Workshop::new();
        let child = started(shop.command(&format!("{ENDLESS} f/#####.png")));
        let frames = || {
            let names = fs::read_dir(shop.path("f")).map(|_| shop.names("f"));
            let mut names = names.unwrap_or_default();
            names.retain(|name| !name.ends_with(".part"));
            names
        };
        wait_until("frames", || frames().len() > 20);
        send(signal, child.id());
        child.wait_with_output().expect("it ends");
        let frames = frames();
        for (number, name) in frames.iter().enumerate() {
            assert_eq!(
                *name,
                format!("{number:05}.png"),
                "{signal}: none is missing"
            );
            assert_eq!(image(&shop.path("f").join(name)).dimensions(), (320, 240));
        }
        if signal == "TERM" {
            assert_eq!(shop.names("f"), frames, "nothing else is there");
        }
    }
}

#[test]
fn a_killed_process_leaves_what_says_whose_it_is_and_the_next_one_tidies_up() {
    let shop = Workshop::new();
    shop.put("film.gif", EARLIER);
    shop.put(".someone.part", "not ours");
    let mut killed = Vec::new();
    for _ in 0..3 {
        let child = started(shop.command(&format!("{ENDLESS} film.gif")));
        let id = child.id();
        let own = format!(".film.gif.morphospace-{id}-0.part");
        wait_until("a file on its way", || on_their_way(&shop).contains(&own));
        killed.push((child, own));
    }
    assert_eq!(on_their_way(&shop).len(), 4, "those that run keep theirs");
    for (child, own) in killed {
        send("KILL", child.id());
        child.wait_with_output().expect("it ends");
        assert!(on_their_way(&shop).contains(&own), "{own} is left");
    }
    shop.done("render a.obj b.obj --at 0.5 --size 8x8 --out still.png");
    let expected = with_own(&[".someone.part", "film.gif", "still.png"]);
    assert_eq!(shop.names("."), expected);
    let kept = fs::read_to_string(shop.path("film.gif")).expect("read");
    assert_eq!(kept, EARLIER);
}

#[test]
fn killed_at_any_time_and_run_once_more_it_leaves_results_only() {
    for (line, end) in QUICK {
        let name = line.rsplit(' ').next().expect("a name");
        let shop = Workshop::new();
        shop.put("pairs.csv", "source,target\na.obj,b.obj\n");
        for turn in 0..20 {
            let child = started(shop.command(line));
            std::thread::sleep(Duration::from_millis(3 * turn));
            send("KILL", child.id());
            child.wait_with_output().expect("it ends");
            let there = fs::read(shop.path(name)).unwrap_or_default();
            let there = String::from_utf8_lossy(&there);
            assert!(there.is_empty() || there.ends_with(end), "{line}: {there}");
        }
        shop.done(line);
        let mut names = shop.names(".");
        // Rows that were done are a result, too.
        names.retain(|name| !name.starts_with("x.partial"));
        assert_eq!(names, with_own(&["pairs.csv", name]), "{line}");
    }
}

#[test]
fn a_run_that_is_to_outlive_its_terminal_does() {
    let shop = Workshop::new();
    let line = format!("{ENDLESS} film.gif");
    let program = shop.command(&line);
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]);
    shell.arg(program.get_program()).args(program.get_args());
    shell.current_dir(shop.path("."));
    let mut child = started(shell);
    wait_until("a file on its way", || on_their_way(&shop).len() == 1);
    send("HUP", child.id());
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("a child").is_none(), "it goes on");
    child.kill().expect("killed");
    child.wait().expect("it ends");
}
