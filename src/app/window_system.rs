//! Choice of the window system on Linux. The windowing library delivers no dropped files under
//! Wayland (winit 0.30), so the program runs through XWayland where that is available.

/// Environment variables that make the windowing library use Wayland.
const WAYLAND: [&str; 2] = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET"];

/// Whether the window opens under Wayland.
#[must_use]
pub fn is_wayland() -> bool {
    let is_set = |name: &&str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(target_os = "linux") && WAYLAND.iter().any(is_set)
}

/// Restarts the program without access to Wayland if an X server can be reached as well. Returns if
/// there is nothing to change or the restart fails.
pub fn prefer_x11() {
    #[cfg(target_os = "linux")]
    if is_wayland() && linux::has_x_server() {
        linux::restart_without_wayland();
    }
}

#[cfg(target_os = "linux")]
mod linux {
    use std::ffi::OsStr;
    use std::os::linux::net::SocketAddrExt;
    use std::os::unix::net::{SocketAddr, UnixStream};
    use std::os::unix::process::CommandExt;
    use std::process::Command;

    use bevy::prelude::warn;

    use super::WAYLAND;

    /// Whether the X server that `DISPLAY` names accepts connections on this machine.
    pub fn has_x_server() -> bool {
        let Some(number) = std::env::var_os("DISPLAY").and_then(|of| local_number(&of)) else {
            return false;
        };
        let path = format!("/tmp/.X11-unix/X{number}");
        // X servers listen on a socket file, in the abstract namespace, or both.
        let is_abstract = || {
            let address = SocketAddr::from_abstract_name(&path)?;
            UnixStream::connect_addr(&address)
        };
        UnixStream::connect(&path).is_ok() || is_abstract().is_ok()
    }

    /// Number of a display on this machine, such as 1 of `:1.0`; `None` for other machines.
    pub fn local_number(display: &OsStr) -> Option<u32> {
        let number = display.to_str()?.strip_prefix(':')?;
        number.split('.').next()?.parse().ok()
    }

    /// Replaces this process by one with the same arguments that cannot reach Wayland. An
    /// environment variable of a running process cannot be removed safely.
    pub fn restart_without_wayland() {
        let Ok(program) = std::env::current_exe() else {
            return;
        };
        let mut command = Command::new(program);
        command.args(std::env::args_os().skip(1));
        for name in WAYLAND {
            command.env_remove(name);
        }
        // Returns only on failure; the window then opens under Wayland.
        let error = command.exec();
        warn!("cannot restart with X11: {error}");
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn only_displays_of_this_machine_have_a_number() {
            let number = |display: &str| local_number(display.as_ref());
            assert_eq!(number(":0"), Some(0));
            assert_eq!(number(":12.0"), Some(12));
            assert_eq!(number("server:0"), None);
            assert_eq!(number(""), None);
        }
    }
}
