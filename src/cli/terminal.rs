//! Progress on stderr where that is a terminal, and Ctrl-C as a cancel.

use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::progress::Progress;

static CANCELLED: AtomicBool = AtomicBool::new(false);

/// What a shell reports for a program that Ctrl-C ended.
const INTERRUPTED: i32 = 130;

/// A line on the terminal that is written over and over.
#[derive(Debug)]
pub(super) struct Terminal {
    shown: Option<Mutex<String>>,
}

impl Terminal {
    /// Listens to Ctrl-C from now on: the first is a cancel, after which
    /// temporary files are removed; the second ends the program at once.
    pub fn new() -> Self {
        let listening = ctrlc::set_handler(|| {
            if CANCELLED.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
        });
        // Without a handler Ctrl-C ends the program, as it does any other.
        drop(listening);
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
