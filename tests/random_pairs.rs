//! Tests that the transition between two random polygons with holes passes the checks in `random`.
//!
//! `cargo test --release --no-default-features --test random_pairs -- --include-ignored
//! --nocapture` tests 500 pairs.

mod random;

use rayon::prelude::*;

/// Checks the transitions of the pairs with the seeds 0 to `count` − 1, and prints how many of them
/// have folds and how many have crossings.
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
    // One of the candidate matches of this pair gives outlines that touch, and therefore fails.
    random::defects_of_seed(385).expect("the first match has a film");
}

#[test]
#[ignore = "500 pairs: minutes in a build without optimisation"]
fn five_hundred_random_pairs_have_valid_transitions() {
    check_pairs(500);
}
