//! Progress line on stderr, if stderr is a terminal, and signals: Ctrl-C, SIGTERM and a closed
//! terminal (SIGHUP) cancel the work; SIGXFSZ is blocked.

use std::fs;
use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crate::work::progress::Progress;

/// Whether a signal has cancelled the work.
static CANCELLED: AtomicBool = AtomicBool::new(false);

/// Exit code after Ctrl-C, by shell convention 128 + SIGINT.
const INTERRUPTED: i32 = 130;

/// Time within which cancelled work stops, as [`Progress`] requires. Signals within this time after
/// the first are ignored: when a terminal closes, both the system and the shell send one.
const CANCEL_TIME: Duration = Duration::from_millis(500);

/// Progress line on stderr that overwrites itself. Also cancels the work when a signal arrives.
#[derive(Debug)]
pub(super) struct Terminal {
    /// Line that is currently shown; `None` if stderr is not a terminal.
    current_line: Option<Mutex<String>>,
}

impl Terminal {
    /// Installs the signal handler. The first signal cancels the work, which then removes its
    /// temporary files; a later signal ends the program at once.
    pub fn new() -> Self {
        // If the program was started with `nohup`, the handler is not installed, because it would
        // cancel the work when the terminal closes. If such a program is killed, the next run
        // removes its temporary files.
        if !ignores_hangup() {
            let mut first_signal: Option<Instant> = None;
            let installed = ctrlc::set_handler(move || {
                CANCELLED.store(true, Ordering::Relaxed);
                if first_signal.get_or_insert_with(Instant::now).elapsed() > CANCEL_TIME {
                    std::process::exit(INTERRUPTED);
                }
            });
            // If the handler cannot be installed, a signal ends the program as usual.
            drop(installed);
        }
        Self {
            current_line: io::stderr().is_terminal().then(Mutex::default),
        }
    }

    /// Replaces the progress line; an empty line clears it.
    fn show(&self, line: String) {
        let Some(current_line) = &self.current_line else {
            return;
        };
        let Ok(mut current_line) = current_line.lock() else {
            return;
        };
        if *current_line != line {
            // A failed write is ignored: the work continues even if the terminal no longer exists.
            write!(io::stderr().lock(), "\r\x1b[K{line}").unwrap_or_default();
            *current_line = line;
        }
    }
}

/// Blocks SIGXFSZ, which kills a program that exceeds the file-size limit (`ulimit -f`). The write
/// then fails with an error that names the file.
///
/// Must be called before other threads start, because they inherit the blocked signal.
#[cfg(unix)]
pub(super) fn block_file_size_signal() {
    use nix::sys::signal::{SigSet, Signal};
    // If the signal cannot be blocked, it ends the program as usual.
    SigSet::from(Signal::SIGXFSZ)
        .thread_block()
        .unwrap_or_default();
}

/// Returns whether the program was started to outlive its terminal, as with `nohup`.
///
/// Only Linux provides this information; on other systems, returns `false`.
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
