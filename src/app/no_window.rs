//! Reports a missing display, window library or graphics driver as an error instead of a panic.
//!
//! Bevy panics in these cases and offers no check beforehand: a process may connect to a window
//! system only once, and probing for a graphics card takes as long as starting. So exactly these
//! panics are caught and turned into [`NoWindowError`]; all others propagate.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind, set_hook, take_hook};

/// Reason why the window cannot be opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoWindowError {
    /// No window system (X11, Wayland) answers.
    #[error(
        "no display was found to open a window on (Linux: set DISPLAY or WAYLAND_DISPLAY); \
         `morphospace render`, `check`, `new` and `gallery` work without one"
    )]
    Display,
    /// The libraries through which programs reach the window system are not installed.
    #[error(
        "the system libraries that open windows are missing (Debian, Ubuntu: `scripts/run` installs \
         them); `morphospace render`, `check`, `new` and `gallery` work without them"
    )]
    Libraries,
    /// No graphics card and no software renderer.
    #[error(
        "no graphics driver was found to draw the window; install that of your card, or a software \
         renderer (Debian, Ubuntu: mesa-vulkan-drivers); `morphospace render`, `check`, `new` and \
         `gallery` work without one"
    )]
    Graphics,
}

/// Messages of panics in Bevy 0.19: how each begins, a text that it contains, and the error that
/// replaces the panic. The first entry that fits counts.
const PANICS: [(&str, &str, NoWindowError); 3] = [
    (
        "Failed to build event loop",
        "LibraryOpenError",
        NoWindowError::Libraries,
    ),
    ("Failed to build event loop", "", NoWindowError::Display),
    ("Unable to find a GPU", "", NoWindowError::Graphics),
];

impl NoWindowError {
    /// Error for one of the panics in [`PANICS`]; `None` for any other panic.
    fn of(panic: &dyn Any) -> Option<Self> {
        let text = match panic.downcast_ref::<String>() {
            Some(text) => text.as_str(),
            None => panic.downcast_ref::<&str>()?,
        };
        let fits = |(begin, inside, _): &&(&str, &str, Self)| {
            text.starts_with(begin) && text.contains(inside)
        };
        PANICS.iter().find(fits).map(|(_, _, why)| *why)
    }
}

/// Runs `program` and turns a panic about a missing display, library or driver into an error.
///
/// # Errors
/// [`NoWindowError`] for the panics in [`PANICS`]; all others propagate.
pub(super) fn catch_no_window<T>(program: impl FnOnce() -> T) -> Result<T, NoWindowError> {
    let default_hook = take_hook();
    set_hook(Box::new(move |panic| {
        if NoWindowError::of(panic.payload()).is_none() {
            default_hook(panic);
        }
    }));
    catch_unwind(AssertUnwindSafe(program)).map_err(|panic| match NoWindowError::of(&*panic) {
        Some(why) => why,
        None => resume_unwind(panic),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_panics_become_errors_and_others_propagate() {
        assert_eq!(catch_no_window(|| 7), Ok(7));
        let detail = "no DISPLAY";
        let display = catch_no_window(|| panic!("Failed to build event loop: {detail}"));
        assert_eq!(display, Err::<(), _>(NoWindowError::Display));
        let detail = "Os(OsError { error: XNotSupported(LibraryOpenError(OpenError)) })";
        let libraries = catch_no_window(|| panic!("Failed to build event loop: {detail}"));
        assert_eq!(libraries, Err::<(), _>(NoWindowError::Libraries));
        let graphics = catch_no_window(|| panic!("Unable to find a GPU! Make sure"));
        assert_eq!(graphics, Err::<(), _>(NoWindowError::Graphics));
        let other = catch_unwind(|| catch_no_window(|| panic!("another")));
        assert!(other.is_err());
    }
}
