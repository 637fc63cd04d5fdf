//! Creates pins along matched outlines, for warps of the plane that do not use outlines themselves.

use super::super::PointPair;
use super::region_match::{RegionMatch, RingKind, RingMatch};

/// Minimum number of pins on a ring, even if the ring is short (heuristic).
const MIN_PINS: usize = 4;

impl RegionMatch {
    /// Returns pairs of points (pins) along the matched rings, one list for each matched ring. Pins
    /// lie where the outlines bend and where they change most. The longest ring gets about `count`
    /// pins, a shorter one proportionally fewer, but at least four. Rings that close to a point or
    /// open from one have no list, because no invertible mapping of the plane closes a ring to a
    /// point.
    ///
    /// ```
    /// use morphospace::correspondence::{MatchSettings, match_regions};
    /// use morphospace::geometry::{DVec2, FillRule, Regions};
    /// use morphospace::work::progress::Silent;
    /// let flag = [(0.0, 0.0), (3.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
    /// let flag = Regions::from_rings(&[flag], FillRule::EvenOdd)?;
    /// let matched = match_regions(&flag, &flag, &MatchSettings::default(), &Silent)?;
    /// let pins = matched.automatic_pins(12);
    /// assert_eq!(pins[0].len(), 12);
    /// assert!(pins[0].iter().all(|pin| pin.source == pin.target));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn automatic_pins(&self, count: usize) -> Vec<Vec<PointPair>> {
        let rings = self.pieces.iter().flat_map(|piece| &piece.rings);
        let matched = rings.filter(|ring| ring.kind == RingKind::Matched);
        let lengths: Vec<(&RingMatch, f64)> =
            matched.map(|r| (r, total(&arc_lengths(r)))).collect();
        let longest = lengths.iter().fold(0.0, |max: f64, (_, l)| max.max(*l));
        let pin_count = |length: f64| (count as f64 * length / longest).round() as usize;
        let pins =
            |&(ring, length): &(&RingMatch, f64)| pins(ring, pin_count(length).max(MIN_PINS));
        lengths.iter().map(pins).collect()
    }
}

/// Returns the arc length along a ring from its first vertex to each vertex, and at last the length
/// of the whole ring. Lengths are averaged over both designs.
fn arc_lengths(ring: &RingMatch) -> Vec<f64> {
    let n = ring.source.len();
    let mut sums = vec![0.0];
    for k in 0..n {
        let next = (k + 1) % n;
        let [a, b] = [&ring.source, &ring.target].map(|r| r[k].distance(r[next]));
        sums.push(sums[k] + 0.5 * (a + b));
    }
    sums
}

/// Returns a ring's total length: the last entry of its [`arc_lengths`].
fn total(sums: &[f64]) -> f64 {
    sums.last().copied().unwrap_or(0.0)
}

/// Selects at most `count` pairs of vertices as pins. Starts with a few evenly spaced vertices, and
/// repeatedly adds the vertex whose position is predicted worst by linear interpolation between the
/// neighbouring pins.
fn pins(ring: &RingMatch, count: usize) -> Vec<PointPair> {
    let sums = arc_lengths(ring);
    let n = ring.source.len();
    let mut chosen: Vec<usize> = (0..MIN_PINS)
        .map(|k| total(&sums) * k as f64 / MIN_PINS as f64)
        .map(|place| sums.partition_point(|sum| *sum < place).min(n - 1))
        .collect();
    chosen.dedup();
    let mut spans: Vec<PinInterval> = (0..chosen.len())
        .map(|k| {
            let next = chosen.get(k + 1).copied().unwrap_or(chosen[0] + n);
            PinInterval::new(ring, &sums, chosen[k], next)
        })
        .collect();
    while spans.len() < count.min(n) {
        let worst = (0..spans.len()).reduce(|a, b| if spans[b].off > spans[a].off { b } else { a });
        let Some(k) = worst.filter(|&k| spans[k].off > 0.0) else {
            break;
        };
        let PinInterval {
            from, to, farthest, ..
        } = spans[k];
        spans[k] = PinInterval::new(ring, &sums, from, farthest);
        spans.insert(k + 1, PinInterval::new(ring, &sums, farthest, to));
    }
    let pair = |span: &PinInterval| PointPair {
        source: ring.source[span.from % n],
        target: ring.target[span.from % n],
    };
    spans.iter().map(pair).collect()
}

/// The vertices from one pin of a ring to the next. Indices continue from round to round: with n
/// vertices, index n is vertex 0 again.
#[derive(Clone, Copy, Debug)]
struct PinInterval {
    from: usize,
    to: usize,
    /// Vertex between the two pins whose position is predicted worst by interpolation between the
    /// pins; `from` if there is no vertex between them.
    farthest: usize,
    /// Squared prediction error of the vertex `farthest`, summed over both designs.
    off: f64,
}

impl PinInterval {
    /// Finds the vertex with the largest prediction error between the pins at vertices `from` and
    /// `to`. `sums` are the ring's [`arc_lengths`].
    fn new(ring: &RingMatch, sums: &[f64], from: usize, to: usize) -> Self {
        let n = ring.source.len();
        let position = |k: usize| sums[k % n] + total(sums) * (k / n) as f64;
        let length = position(to) - position(from);
        let off = |k: usize| {
            let along = (position(k) - position(from)) / length;
            let square = [&ring.source, &ring.target].map(|side| {
                let predicted = side[from % n].lerp(side[to % n], along);
                predicted.distance_squared(side[k % n])
            });
            square[0] + square[1]
        };
        let (farthest, off) =
            (from + 1..to)
                .map(|k| (k, off(k)))
                .fold(
                    (from, 0.0),
                    |worst, next| if next.1 > worst.1 { next } else { worst },
                );
        Self {
            from,
            to,
            farthest,
            off,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::correspondence::{MatchSettings, match_regions};
    use crate::geometry::{DVec2, FillRule, Regions};
    use crate::work::progress::Silent;

    #[test]
    fn corners_are_pinned_before_edges() {
        // A U shape with many vertices along its edges.
        let corners: Vec<DVec2> = [
            (0, 0),
            (6, 0),
            (6, 3),
            (5, 3),
            (5, 1),
            (1, 1),
            (1, 3),
            (0, 3),
        ]
        .map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)))
        .to_vec();
        let mut points = Vec::new();
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            points.extend((0..8).map(|i| a.lerp(b, f64::from(i) / 8.0)));
        }
        let regions = Regions::from_rings(&[points], FillRule::EvenOdd).expect("a comb");
        let matched =
            match_regions(&regions, &regions, &MatchSettings::default(), &Silent).expect("itself");
        let pins = matched.automatic_pins(14).concat();
        let missing = corners
            .iter()
            .filter(|c| pins.iter().all(|p| p.source != **c));
        assert_eq!(missing.count(), 0, "{pins:?}");
    }
}
