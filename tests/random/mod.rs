//! Random polygons with holes, and what must hold of every film between two.
//!
//! The tests and the fuzzer (`fuzz/`) both read these files.

mod film;
mod shapes;

pub use film::{Seen, seen};
pub use shapes::{Rings, Seeded, polygon};

/// The film between the two polygons of a seed, of 0 to 5 holes each.
///
/// # Errors
/// As [`seen`].
pub fn seen_of_seed(seed: u64) -> Result<Seen, String> {
    let mut random = Seeded::new(seed);
    let [source, target] = [(); 2].map(|()| {
        let holes = random.below(6);
        polygon(&mut random, holes)
    });
    seen(source, target)
}
