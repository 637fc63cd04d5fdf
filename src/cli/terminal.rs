//! Progress on stderr where that is a terminal, and a cancel where the program
//! is asked to end: by Ctrl-C, by SIGTERM or by a terminal that is closed
//! (SIGHUP).

use std::fs;
use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::work::progress::Progress;

static CANCELLED: AtomicBool = AtomicBool::new(false);

/// What a shell reports for a program that Ctrl-C ended.
const INTERRUPTED: i32 = 130;

/// How long a cancel may take. A second wish within it is the first one told
/// twice: a terminal that closes tells its programs itself, and so does its
/// shell.
const ANSWER_TIME: Duration = Duration::from_millis(500);

/// A line on the terminal that is written over and over.
#[derive(Debug)]
pub(super) struct Terminal {
    shown: Option<Mutex<String>>,
}

impl Terminal {
    /// Listens from now on: the first wish is a cancel, after which temporary
    /// files are removed; one that comes later ends the program at once.
    pub fn new() -> Self {
        // `nohup` is to outlive its terminal, and a handler would undo that. What
        // such a program leaves when it is killed, the next one takes away.
        if !ignores_hangup() {
            let mut asked: Option<Instant> = None;
            let listening = ctrlc::set_handler(move || {
                CANCELLED.store(true, Ordering::Relaxed);
                if asked.get_or_insert_with(Instant::now).elapsed() > ANSWER_TIME {
                    std::process::exit(INTERRUPTED);
                }
            });
            // Without a handler a signal ends the program, as it does any other.
            drop(listening);
        }
        Self {
            shown: io::stderr().is_terminal().then(Mutex::default),
        }
    }

    fn show(&self, line: String) {
        let Some(shown) = &self.shown else { return };
        let Ok(mut shown) = shown.lock() else { return };
        if *shown != line {
            // A terminal that went away is no reason to stop working.
            write!(io::stderr().lock(), "\r\x1b[K{line}").unwrap_or_default();
            *shown = line;
        }
    }
}

/// Whether whoever started the program wants it to outlive its terminal; only
/// Linux tells.
fn ignores_hangup() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    // SIGHUP is signal 1, the lowest bit.
    mask.is_some_and(|mask| mask & 1 == 1)
}

impl Drop for Terminal {
    fn drop(&mut self) {
        self.show(String::new());
    }
}

impl Progress for Terminal {
    fn report(&self, stage: &'static str, fraction: f64) {
        self.show(format!("{stage} {:3.0} %", 100.0 * fraction));
    }

    fn is_cancelled(&self) -> bool {
        CANCELLED.load(Ordering::Relaxed)
    }
}
