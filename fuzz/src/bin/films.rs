//! Checks the transitions between random polygons, one after the other: `films FIRST COUNT`.
//!
//! The same pairs as `tests/random_pairs.rs`, without a fuzzer. Prints the pairs that fail, the
//! numbers of pairs with folds and crossings, and the slowest pair.

#[path = "../../../tests/random/mod.rs"]
#[allow(dead_code, reason = "the fuzzer uses the rest")]
mod random;

use std::process::ExitCode;
use std::time::{Duration, Instant};

fn main() -> ExitCode {
    let numbers: Vec<u64> = std::env::args().skip(1).flat_map(|a| a.parse()).collect();
    let [first, count] = numbers[..] else {
        eprintln!("usage: films FIRST COUNT, for example: films 0 500");
        return ExitCode::from(2);
    };
    let start = Instant::now();
    let (mut broken, mut folded, mut crossed) = (0, 0, 0);
    let mut slowest = (Duration::ZERO, first);
    for seed in first..first.saturating_add(count) {
        let pair_start = Instant::now();
        match random::defects_of_seed(seed) {
            Ok(defects) => {
                folded += u32::from(defects.folds > 0);
                crossed += u32::from(defects.crossings > 0);
            }
            Err(error) => {
                broken += 1;
                println!("pair {seed}: {error}");
            }
        }
        slowest = slowest.max((pair_start.elapsed(), seed));
    }
    println!(
        "{count} pairs, {:.1} a second: {broken} broken, {folded} with a fold, {crossed} with a crossing; slowest {:.2} s, pair {}",
        count as f64 / start.elapsed().as_secs_f64(),
        slowest.0.as_secs_f64(),
        slowest.1,
    );
    ExitCode::from(u8::from(broken > 0))
}
