//! Random pairs of polygons with holes: each has a valid transition.
//!
//! All 500: `cargo test --release --no-default-features --test random_pairs --
//! --include-ignored --nocapture`.

mod random;

use rayon::prelude::*;

/// Checks the transitions of the pairs with seeds 0 to `count` − 1, and prints counts of defects.
#[expect(clippy::print_stdout, reason = "the counts are the result")]
fn check_pairs(count: u64) {
    let results: Vec<_> = (0..count)
        .into_par_iter()
        .map(|seed| random::defects_of_seed(seed).map_err(|error| format!("pair {seed}: {error}")))
        .collect();
    let errors: Vec<_> = results
        .iter()
        .filter_map(|result| result.as_ref().err())
        .collect();
    assert_eq!(errors, Vec::<&String>::new());
    let defects = || results.iter().flatten();
    let folded = defects().filter(|defects| defects.folds > 0).count();
    let crossed = defects().filter(|defects| defects.crossings > 0).count();
    println!("{count} pairs: {folded} with a fold, {crossed} with a crossing");
}

#[test]
fn random_polygons_with_holes_have_valid_transitions() {
    check_pairs(8);
}

#[test]
fn a_failed_candidate_match_does_not_fail_the_transition() {
    // One candidate match of this pair fails, since its outlines touch.
    random::defects_of_seed(385).expect("the first match has a film");
}

#[test]
#[ignore = "500 pairs: minutes in a build without optimisation"]
fn five_hundred_random_pairs_have_valid_transitions() {
    check_pairs(500);
}
