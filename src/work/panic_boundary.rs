//! Turns panics into errors. Decoders of pictures, fonts and drawings come from many libraries. A
//! damaged file must not end the program, and a failing pair must not end a run over many pairs.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether a panic of this thread becomes an error and is therefore not printed.
    static IS_CAUGHT: Cell<bool> = const { Cell::new(false) };
}

/// Runs `work` and returns its result, or the message of its panic. The first call replaces the
/// panic hook of the process by one that calls the previous hook, except for panics in `work`.
///
/// After a panic, the caller must not use data that `work` was changing.
pub(crate) fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let print = take_hook();
        set_hook(Box::new(move |panic| {
            if !IS_CAUGHT.get() {
                print(panic);
            }
        }));
    });
    let was_caught = IS_CAUGHT.replace(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    IS_CAUGHT.set(was_caught);
    result.map_err(|panic| message(&*panic))
}

/// Returns the message of a panic.
fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    text.unwrap_or("unknown reason").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_become_messages() {
        assert_eq!(catch_panic(|| 7), Ok(7));
        assert_eq!(
            catch_panic::<()>(|| panic!("no {}", 1)),
            Err("no 1".to_owned())
        );
        let inner = || catch_panic::<()>(|| panic!("inner"));
        assert_eq!(catch_panic(inner), Ok(Err("inner".to_owned())));
    }
}
