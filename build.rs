//! Build script: rebuilds when the embedded gallery changes, and shrinks the release binary.
//!
//! The gallery is embedded with `include_dir!`, which does not notice added or removed files,
//! so this script makes cargo watch the folder. For native release builds on x86-64 Linux, linker
//! flags fold identical functions and pack relocations.

use std::env::{self, VarError};
use std::path::Path;
use std::process::Command;

/// Linker flag that merges identical functions; it saves 4.6 MB of 80.
const FOLD_FUNCTIONS: &str = "-Wl,--icf=all";

/// Linker flag that stores relative relocations in packed form; it saves 10.3 MB.
const PACK_RELOCATIONS: &str = "-Wl,-z,pack-relative-relocs";

/// Oldest glibc version (major, minor) whose loader supports packed relocations.
const MIN_GLIBC: [u32; 2] = [2, 36];

fn main() {
    println!("cargo:rerun-if-changed=assets/gallery");
    println!("cargo:rerun-if-env-changed=RUSTC_LINKER");
    if !uses_bundled_linker() {
        return;
    }
    println!("cargo:rustc-link-arg-bin=morphospace={FOLD_FUNCTIONS}");
    if glibc().is_some_and(|version| version >= MIN_GLIBC) {
        println!("cargo:rustc-link-arg-bin=morphospace={PACK_RELOCATIONS}");
    }
}

/// Returns whether this is a native release build with the linker bundled with Rust.
///
/// Only that linker is known to support both flags. The packages of some Linux distributions come
/// without it.
fn uses_bundled_linker() -> bool {
    /// Target triple for which the flags were tested.
    const LINUX: &str = "x86_64-unknown-linux-gnu";
    let is = |name: &str, value: &str| env::var(name).as_deref() == Ok(value);
    let is_unset =
        |name: &str| env::var(name).map_or_else(|e| e == VarError::NotPresent, |v| v.is_empty());
    is("HOST", LINUX)
        && is("TARGET", LINUX)
        && is("PROFILE", "release")
        && is_unset("RUSTC_LINKER")
        && is_unset("CARGO_ENCODED_RUSTFLAGS")
        && has_bundled_linker(LINUX)
}

/// Returns whether the Rust toolchain includes its own linker for a target.
fn has_bundled_linker(target: &str) -> bool {
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(rustc).args(["--print", "sysroot"]).output();
    let Some(sysroot) = output
        .ok()
        .and_then(|output| String::from_utf8(output.stdout).ok())
    else {
        return false;
    };
    Path::new(sysroot.trim())
        .join("lib/rustlib")
        .join(target)
        .join("bin/gcc-ld/ld.lld")
        .exists()
}

/// Returns the major and minor version of the C library of this machine, if it is glibc.
fn glibc() -> Option<[u32; 2]> {
    let output = Command::new("getconf").arg("GNU_LIBC_VERSION").output();
    let text = String::from_utf8(output.ok()?.stdout).ok()?;
    let (major, minor) = text.trim().strip_prefix("glibc ")?.split_once('.')?;
    Some([major.parse().ok()?, minor.parse().ok()?])
}
