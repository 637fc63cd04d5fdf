//! A window that cannot be opened says so in words.
//!
//! Bevy's plugins panic where there is no display, or no driver that draws, and cannot
//! be asked before: a window system may be connected to once in a program, and a second
//! look for a graphics card takes as long as the first. So these two panics, and no
//! others, are caught and told as what they are.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind, set_hook, take_hook};

/// What the window cannot do without.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoWindowError {
    /// No window system answers.
    #[error(
        "there is no display to open a window on; under Linux DISPLAY or WAYLAND_DISPLAY \
         names one. Without: `morphospace render`, `check`, `new` and `gallery` (see --help)"
    )]
    Display,
    /// No graphics card, and nothing that draws in its place.
    #[error(
        "no graphics driver was found that could draw the window; install your card's, or one \
         that draws in software (Debian and Ubuntu: mesa-vulkan-drivers). Without: \
         `morphospace render`, `check`, `new` and `gallery` (see --help)"
    )]
    Graphics,
}

/// With what Bevy's panics begin, as of 0.19.
const PANICS: [(&str, NoWindowError); 2] = [
    ("Failed to build event loop", NoWindowError::Display),
    ("Unable to find a GPU", NoWindowError::Graphics),
];

impl NoWindowError {
    fn of(panic: &dyn Any) -> Option<Self> {
        let text = match panic.downcast_ref::<String>() {
            Some(text) => text.as_str(),
            None => panic.downcast_ref::<&str>()?,
        };
        let begins = |(begin, _): &&(&str, Self)| text.starts_with(begin);
        PANICS.iter().find(begins).map(|(_, why)| *why)
    }
}

/// Runs a program with a window, or says what it lacks.
///
/// # Errors
/// [`NoWindowError`]; all other panics go on.
pub(super) fn catch_no_window<T>(program: impl FnOnce() -> T) -> Result<T, NoWindowError> {
    let usual = take_hook();
    set_hook(Box::new(move |panic| {
        if NoWindowError::of(panic.payload()).is_none() {
            usual(panic);
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
    fn the_two_panics_are_told_and_others_go_on() {
        assert_eq!(catch_no_window(|| 7), Ok(7));
        let detail = "no DISPLAY";
        let display = catch_no_window(|| panic!("Failed to build event loop: {detail}"));
        assert_eq!(display, Err::<(), _>(NoWindowError::Display));
        let graphics = catch_no_window(|| panic!("Unable to find a GPU! Make sure"));
        assert_eq!(graphics, Err::<(), _>(NoWindowError::Graphics));
        let other = catch_unwind(|| catch_no_window(|| panic!("another")));
        assert!(other.is_err());
    }
}
