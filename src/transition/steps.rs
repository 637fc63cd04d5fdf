//! Times at which a film is looked at where it matters what meets what.
//!
//! Evenly, and closer together near both ends: there what is born lies next to what it
//! comes from, and what dies beside what it goes to. By even steps alone 43 of 60 pairs of
//! icons were proved not to cross, instead of 46.

/// Even steps of the film, and how many of them at each end are divided in how many.
const EVEN: u32 = 64;
const DIVIDED: u32 = 2;
const PARTS: u32 = 4;

/// The number of the last step, at t = 1.
pub(super) const LAST: u32 = EVEN + 2 * DIVIDED * (PARTS - 1);

/// The time of a step.
pub(super) fn time(step: u32) -> f64 {
    let near = |step: u32| f64::from(step) / f64::from(EVEN * PARTS);
    if step <= DIVIDED * PARTS {
        near(step)
    } else if step >= LAST - DIVIDED * PARTS {
        1.0 - near(LAST - step)
    } else {
        f64::from(step - DIVIDED * (PARTS - 1)) / f64::from(EVEN)
    }
}

/// The last step that is not after a time in [0, 1].
pub(super) fn step_before(t: f64) -> u32 {
    (0..=LAST).rev().find(|&step| time(step) <= t).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_run_from_end_to_end_and_back_alike() {
        assert_eq!([time(0), time(LAST)], [0.0, 1.0]);
        for step in 0..LAST {
            let long = time(step + 1) - time(step);
            assert!(long == 1.0 / 64.0 || long == 1.0 / 256.0, "{step}: {long}");
            assert_eq!(time(step), 1.0 - time(LAST - step));
            assert_eq!(step_before(time(step) + 1e-6), step);
        }
        // What lives change at.
        assert!(
            (0..=8)
                .map(|k| f64::from(k) / 8.0)
                .all(|t| time(step_before(t)) == t)
        );
    }
}
