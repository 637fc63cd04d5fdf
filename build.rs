//! The gallery is held in the binary: a file that comes or goes there must
//! build it anew, which the compiler does not notice by itself. And the
//! linker is told to pack what it would write out at length.

use std::env::{self, VarError};
use std::process::Command;

/// Functions that came out the same are kept once, 4.6 MB of 80 less.
const FOLDED: &str = "-Wl,--icf=all";

/// Addresses that are set when the program is loaded, packed: 10.3 MB less.
const PACKED: &str = "-Wl,-z,pack-relative-relocs";

/// The first glibc whose loader reads packed addresses.
const READS_PACKED: [u32; 2] = [2, 36];

fn main() {
    println!("cargo:rerun-if-changed=assets/gallery");
    println!("cargo:rerun-if-env-changed=RUSTC_LINKER");
    if !is_own_linker() {
        return;
    }
    println!("cargo:rustc-link-arg-bin=morphospace={FOLDED}");
    if glibc().is_some_and(|version| version >= READS_PACKED) {
        println!("cargo:rustc-link-arg-bin=morphospace={PACKED}");
    }
}

/// Whether a program for this machine is linked by the linker that Rust brings
/// along on this system, which knows these arguments.
fn is_own_linker() -> bool {
    const LINUX: &str = "x86_64-unknown-linux-gnu";
    let is = |name: &str, value: &str| env::var(name).as_deref() == Ok(value);
    let is_unset =
        |name: &str| env::var(name).map_or_else(|e| e == VarError::NotPresent, |v| v.is_empty());
    is("HOST", LINUX)
        && is("TARGET", LINUX)
        && is("PROFILE", "release")
        && is_unset("RUSTC_LINKER")
        && is_unset("CARGO_ENCODED_RUSTFLAGS")
}

/// The version of the C library here, if it is glibc.
fn glibc() -> Option<[u32; 2]> {
    let told = Command::new("getconf").arg("GNU_LIBC_VERSION").output();
    let told = String::from_utf8(told.ok()?.stdout).ok()?;
    let (major, minor) = told.trim().strip_prefix("glibc ")?.split_once('.')?;
    Some([major.parse().ok()?, minor.parse().ok()?])
}
