//! Random polygons with holes, and checks of the transition between two of them.
//!
//! Shared by the tests and the fuzzer (`fuzz/`).

mod shapes;
mod transition_check;

pub use shapes::{Rings, SeededRandom, polygon};
pub use transition_check::{FilmDefects, check_transition};

/// Checks the transition between the two polygons of a seed, with 0 to 5 holes each.
///
/// # Errors
/// Those of [`check_transition`].
pub fn defects_of_seed(seed: u64) -> Result<FilmDefects, String> {
    let mut random = SeededRandom::new(seed);
    let [source, target] = [(); 2].map(|()| {
        let holes = random.below(6);
        polygon(&mut random, holes)
    });
    check_transition(source, target)
}
