//! Random polygons with holes, and checks of the transition between two such polygons.
//!
//! Used by the tests and by the fuzzer in `fuzz/`.

mod shapes;
pub mod transition_check;

pub use shapes::{Rings, SeededRandom, polygon};
pub use transition_check::{FilmDefects, check_transition};

/// Checks the transition between the two random polygons that a seed determines; each has at most
/// five holes.
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
