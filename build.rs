//! The gallery is held in the binary: a file that comes or goes there must
//! build it anew, which the compiler does not notice by itself.

fn main() {
    println!("cargo:rerun-if-changed=assets/gallery");
}
