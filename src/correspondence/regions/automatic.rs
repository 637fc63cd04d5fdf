//! Pins along matched outlines, for warps that know nothing of outlines.

use super::super::PointPair;
use super::{RegionMatch, RingKind, RingMatch};

/// A ring of little length is pinned at so many points all the same.
const FEWEST: usize = 4;

impl RegionMatch {
    /// Pairs of points evenly along the matched rings, some `count` along the
    /// longest one and fewer along shorter ones, ring by ring. Rings that
    /// close to a point or open from one have none: no map of the plane can
    /// do that.
    ///
    /// ```
    /// use morphospace::correspondence::{Matching, match_regions};
    /// use morphospace::geometry::{DVec2, FillRule, Regions};
    /// use morphospace::progress::Silent;
    /// let flag = [(0.0, 0.0), (3.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
    /// let flag = Regions::from_rings(&[flag], FillRule::EvenOdd)?;
    /// let matched = match_regions(&flag, &flag, &Matching::default(), &Silent)?;
    /// let pins = matched.automatic_pins(12);
    /// assert_eq!(pins[0].len(), 12);
    /// assert!(pins[0].iter().all(|pin| pin.source == pin.target));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn automatic_pins(&self, count: usize) -> Vec<Vec<PointPair>> {
        let rings = self.pieces.iter().flat_map(|piece| &piece.rings);
        let matched = rings.filter(|ring| ring.kind == RingKind::Matched);
        let lengths: Vec<(&RingMatch, f64)> = matched.map(|r| (r, total(&walked(r)))).collect();
        let longest = lengths.iter().fold(0.0, |most: f64, (_, l)| most.max(*l));
        let share = |length: f64| (count as f64 * length / longest).round() as usize;
        let pins = |&(ring, length): &(&RingMatch, f64)| pins(ring, share(length).max(FEWEST));
        lengths.iter().map(pins).collect()
    }
}

/// The mean length, of both designs, walked from the first vertex to each and
/// back to it.
fn walked(ring: &RingMatch) -> Vec<f64> {
    let n = ring.source.len();
    let mut sums = vec![0.0];
    for k in 0..n {
        let next = (k + 1) % n;
        let [a, b] = [&ring.source, &ring.target].map(|r| r[k].distance(r[next]));
        sums.push(sums[k] + 0.5 * (a + b));
    }
    sums
}

fn total(sums: &[f64]) -> f64 {
    sums.last().copied().unwrap_or(0.0)
}

/// `count` pairs of vertices as even as the vertices are.
fn pins(ring: &RingMatch, count: usize) -> Vec<PointPair> {
    let sums = walked(ring);
    let n = ring.source.len();
    let mut chosen: Vec<usize> = (0..count)
        .map(|k| total(&sums) * k as f64 / count as f64)
        .map(|place| sums.partition_point(|sum| *sum < place).min(n - 1))
        .collect();
    chosen.dedup();
    let pair = |k: usize| PointPair {
        source: ring.source[k],
        target: ring.target[k],
    };
    chosen.into_iter().map(pair).collect()
}
