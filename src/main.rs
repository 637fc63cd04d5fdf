//! The program: parses the command line and hands over; nothing else.

use std::process::ExitCode;

use morphospace::cli::{self, Launch};

fn main() -> ExitCode {
    match cli::run(std::env::args_os()) {
        Launch::Done(code) => code,
        Launch::Window(request) => open_window(request),
    }
}

#[cfg(feature = "app")]
fn open_window(request: cli::WindowRequest) -> ExitCode {
    use morphospace::app::{AppOptions, run};
    use std::process::Termination;
    share_arenas();
    run(AppOptions {
        files: request.files,
        captures: request.captures,
        presents: request.present,
    })
    .report()
}

/// Lets threads share the arenas of glibc's allocator, one for each core instead of eight.
///
/// Each film is made by threads of its own, and an arena keeps what any of them took:
/// fifty minutes of switching projects went from 340 to 470 MB, and with as many arenas
/// as cores stay between 400 and 450.
#[cfg(all(feature = "app", target_os = "linux", target_env = "gnu"))]
#[expect(
    unsafe_code,
    reason = "a function of the C library; it takes two numbers"
)]
fn share_arenas() {
    let cores = std::thread::available_parallelism().map_or(2, usize::from);
    let arenas = libc::c_int::try_from(cores.max(2)).unwrap_or(2);
    // SAFETY: it changes a limit that arenas made from now on are counted against, and no
    // other thread runs yet.
    let is_set = unsafe { libc::mallopt(libc::M_ARENA_MAX, arenas) } == 1;
    debug_assert!(is_set, "glibc knows the limit");
}

#[cfg(all(feature = "app", not(all(target_os = "linux", target_env = "gnu"))))]
fn share_arenas() {}

#[cfg(not(feature = "app"))]
fn open_window(_: cli::WindowRequest) -> ExitCode {
    cli::without_window()
}
