//! Random polygons with three kinds of outlines, and with round or spiky holes that do not touch
//! each other or the outline.

use morphospace::geometry::DVec2;
use std::f64::consts::TAU;

/// Outlines and holes of a design, to be filled by the non-zero rule.
pub type Rings = Vec<Vec<DVec2>>;

/// Random generator that gives the same numbers for a seed on every machine (splitmix64: G. Steele,
/// D. Lea, C. Flood, 2014).
pub struct SeededRandom(u64);

impl SeededRandom {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ (a >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ (b >> 31)
    }

    /// Returns a random number in [from, to).
    pub fn within(&mut self, from: f64, to: f64) -> f64 {
        let unit = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        from + (to - from) * unit
    }

    /// Returns a random integer from 0 to `count` − 1.
    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }
}

/// Returns a random polygon with `holes` holes, or with fewer if there is no room for them.
pub fn polygon(random: &mut SeededRandom, holes: usize) -> Rings {
    let outline = match random.below(3) {
        0 => star_shaped(random, DVec2::ZERO, 1.0),
        1 => limbs(random),
        _ => blocks(random),
    };
    let mut rings = vec![outline];
    // Most random centres lie outside the outline or too near to a boundary, so 40 are tried for
    // each hole.
    for _ in 0..40 * holes {
        if rings.len() > holes {
            break;
        }
        let centre = DVec2::new(random.within(-1.2, 1.2), random.within(-1.2, 1.2));
        let room = room(&rings, centre);
        if room > 0.06 {
            let radius = room * random.within(0.4, 0.8);
            let mut hole = star_shaped(random, centre, radius);
            hole.reverse();
            rings.push(hole);
        }
    }
    rings
}

/// A random star-shaped ring around `centre`, anything from a blob to a spiky star; its corners are
/// at most `radius` away from the centre.
fn star_shaped(random: &mut SeededRandom, centre: DVec2, radius: f64) -> Vec<DVec2> {
    let corners = 3 + random.below(30);
    let min_share = random.within(0.3, 1.0);
    let turn = random.within(0.0, TAU);
    (0..corners)
        .map(|i| {
            // The random offset is below 1, so no two corners have the same angle.
            let turn_share = (i as f64 + random.within(0.0, 0.8)) / corners as f64;
            let reach = radius * random.within(min_share, 1.0);
            centre + reach * DVec2::from_angle(turn + TAU * turn_share)
        })
        .collect()
}

/// A random ring with two to six long limbs, like a starfish around the origin.
fn limbs(random: &mut SeededRandom) -> Vec<DVec2> {
    let limbs = 2 + random.below(5);
    let mut ring = Vec::new();
    for i in 0..limbs {
        let angle = TAU * (i as f64 + random.within(0.0, 0.4)) / limbs as f64;
        let (out, across) = (DVec2::from_angle(angle), DVec2::from_angle(angle).perp());
        let (reach, half) = (random.within(0.6, 1.0), random.within(0.06, 0.12));
        let bend = across * random.within(-0.2, 0.2);
        ring.extend([
            out * 0.35 - across * half,
            out * reach - across * half + bend,
            out * reach + across * half + bend,
            out * 0.35 + across * half,
        ]);
    }
    ring
}

/// A random ring around adjacent columns of different heights, with right angles only.
fn blocks(random: &mut SeededRandom) -> Vec<DVec2> {
    let columns = 2 + random.below(6);
    let width = 2.0 / columns as f64;
    let (mut below, mut above) = (Vec::new(), Vec::new());
    for i in 0..columns {
        let (left, right) = (-1.0 + width * i as f64, -1.0 + width * (i + 1) as f64);
        let (bottom, top) = (random.within(-1.0, -0.2), random.within(0.2, 1.0));
        below.extend([DVec2::new(left, bottom), DVec2::new(right, bottom)]);
        above.extend([DVec2::new(left, top), DVec2::new(right, top)]);
    }
    below.into_iter().chain(above.into_iter().rev()).collect()
}

/// Distance from the point `p` to the nearest boundary; 0 if the point is outside the polygon.
fn room(rings: &[Vec<DVec2>], p: DVec2) -> f64 {
    let sides = || {
        rings.iter().flat_map(|ring| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().copied().zip(next.copied())
        })
    };
    let crossed = sides().filter(|(a, b)| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
    });
    if crossed.count() % 2 == 0 {
        return 0.0;
    }
    let distance = |(a, b): (DVec2, DVec2)| {
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, along))
    };
    sides().map(distance).fold(f64::INFINITY, f64::min)
}
