//! Numbers and lists of nodes in sentences.

use std::fmt;

/// Number of nodes that a sentence lists (heuristic: more do not fit on a line).
const LISTED_NODES: usize = 6;

/// Displays node numbers in words: "node 3", or "nodes 3, 4 and 5". Long lists end with the number
/// of further nodes.
#[derive(Clone, Copy, Debug)]
pub struct NodeList<'a>(pub &'a [u32]);

impl fmt::Display for NodeList<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let noun = if self.0.len() == 1 { "node" } else { "nodes" };
        write!(f, "{noun} ")?;
        let listed = &self.0[..self.0.len().min(LISTED_NODES)];
        let more = self.0.len() - listed.len();
        for (i, node) in listed.iter().enumerate() {
            let is_last = i + 1 == listed.len() && more == 0;
            let before = match i {
                0 => "",
                _ if is_last => " and ",
                _ => ", ",
            };
            write!(f, "{before}{node}")?;
        }
        match more {
            0 => Ok(()),
            more => write!(f, " and {more} more"),
        }
    }
}

/// Displays a number with the given number of decimals, or with an exponent if it is too large or too
/// small for them.
pub(super) struct BoundedNumber(pub(super) f64, pub(super) usize);

impl fmt::Display for BoundedNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(number, decimals) = *self;
        let smallest = 0.5 * 0.1_f64.powi(decimals as i32);
        match number.abs() < 1e6 && (number == 0.0 || number.abs() >= smallest) {
            true => write!(f, "{number:.decimals$}"),
            false => write!(f, "{number:.1e}"),
        }
    }
}

/// Displays a length in m: in millimetres below one metre.
pub(super) struct LengthInWords(pub(super) f64);

impl fmt::Display for LengthInWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            metres if metres < 1.0 => write!(f, "{} mm", BoundedNumber(1e3 * metres, 1)),
            metres => write!(f, "{} m", BoundedNumber(metres, 2)),
        }
    }
}
