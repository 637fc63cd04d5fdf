//! One part matched with one part, holes and all.

use super::super::boundary::match_curves;
use super::super::boundary_match::BoundaryMatch;
use super::super::curve::Curve;
use super::super::options::{MatchError, MatchOptions};
use super::super::pairing::pair_other_holes;
use super::super::pins::{Pin, PinError};
use super::super::polygons::{PolygonOptions, SharedPolygons};
use super::super::{HoleRule, RingCut};
use super::closing::{Vertices, centre, point_ring};
use super::cut;
use super::outcome::{PieceMatch, RegionMatchError, RingKind, RingMatch};
use super::slits::mirror;
use super::walk::Walk;
use crate::geometry::{DVec2, Region, Ring, Side};

/// Longest edge of a shared outline, as a share of the outer one's length.
const SPACING: f64 = 0.0125;

/// A ring has at least so many vertices.
const LEAST_VERTICES: f64 = 10.0;

/// What it costs a match to close a hole, in its length over the outer one's.
const CLOSING_PRICE: f64 = 0.35;

/// What was said of one part and its partner.
#[derive(Clone, Debug)]
pub(super) struct Task<'a> {
    /// Source and target.
    pub(super) regions: [&'a Region; 2],
    /// Their numbers.
    pub(super) parts: [usize; 2],
    /// Number and points of each pin on them.
    pub(super) pins: Vec<(usize, [DVec2; 2])>,
    /// Number of each cut through one of them.
    pub(super) cuts: Vec<(usize, RingCut)>,
    pub(super) holes: HoleRule,
    pub(super) options: MatchOptions,
}

/// A pin with the rings it lies on.
struct PinHere {
    index: usize,
    rings: [usize; 2],
    points: [DVec2; 2],
}

/// Both parts on the way to being matched.
struct Sides<'a> {
    walks: [Walk; 2],
    /// For each side which of its holes the walk goes around by now.
    opened: [Vec<usize>; 2],
    pins: Vec<PinHere>,
    task: &'a Task<'a>,
}

/// Matches a part with a part.
pub(super) fn matched(task: &Task) -> Result<PieceMatch, RegionMatchError> {
    let mut sides = Sides::new(task);
    let blunt = sides.outer_match()?;
    let across = sides.pins_across()?;
    let asked = sides.asked_cuts();
    let taken = Side::BOTH.map(|side| {
        let mut taken: Vec<usize> = across[side].clone();
        taken.extend(asked[side].iter().map(|&(_, hole, _)| hole));
        taken.sort_unstable();
        taken.dedup();
        taken
    });
    let [source, target] = task.regions;
    let pairing = pair_other_holes(
        source,
        target,
        blunt.rotation(),
        &sides.pinned_holes(&taken),
        [&taken[0], &taken[1]],
    )?;
    let mut cuts = Vec::new();
    for side in Side::BOTH {
        for &(number, hole, ends) in &asked[side] {
            let slit = sides.open_asked(side, hole, ends);
            let ends = slit.ok_or(RegionMatchError::Cut(number))?;
            cuts.push(ring_cut(side, ends));
        }
        let alone = [&pairing.dying, &pairing.born][side];
        for hole in sides.largest_first(side, alone) {
            cuts.extend(
                sides
                    .open_if_better(side, hole, false)
                    .map(|e| ring_cut(side, e)),
            );
        }
        for &hole in &across[side] {
            if !sides.opened[side].contains(&hole) {
                cuts.extend(
                    sides
                        .open_if_better(side, hole, true)
                        .map(|e| ring_cut(side, e)),
                );
            }
        }
    }
    let outer = if cuts.is_empty() {
        blunt
    } else {
        sides.outer_match()?
    };
    let mut rings = vec![sides.outer_ring(&outer)?];
    for &pair in &pairing.pairs {
        rings.push(sides.hole_ring(pair, outer.rotation())?);
    }
    sides.closing_rings(&mut rings, outer.rotation());
    Ok(PieceMatch {
        rings,
        source_part: Some(task.parts[0]),
        target_part: Some(task.parts[1]),
        cuts,
        rotation: outer.rotation(),
        cost: outer.cost(),
    })
}

fn ring_cut(side: Side, [outer, hole]: [DVec2; 2]) -> RingCut {
    RingCut { side, outer, hole }
}

impl<'a> Sides<'a> {
    fn new(task: &'a Task<'a>) -> Self {
        let nearest = |side: Side, p: DVec2| {
            let distances = task.regions[side]
                .rings()
                .map(|ring| ring.distance_squared(p));
            let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            nearest.map_or(0, |(ring, _)| ring)
        };
        let pin = |&(index, points): &(usize, [DVec2; 2])| PinHere {
            index,
            rings: Side::BOTH.map(|side| nearest(side, points[side])),
            points,
        };
        Self {
            walks: task.regions.map(Walk::around),
            opened: [Vec::new(), Vec::new()],
            pins: task.pins.iter().map(pin).collect(),
            task,
        }
    }

    /// For each side the holes that a pin ties to the other's outer ring.
    fn pins_across(&self) -> Result<[Vec<usize>; 2], RegionMatchError> {
        let mut across = [Vec::new(), Vec::new()];
        for pin in &self.pins {
            let side = match pin.rings {
                [0, 0] => continue,
                [_, 0] => Side::Source,
                [0, _] => Side::Target,
                _ => continue,
            };
            if self.task.holes == HoleRule::Close {
                return Err(RegionMatchError::PinAcross(pin.index));
            }
            across[side].push(pin.rings[side] - 1);
        }
        for holes in &mut across {
            holes.sort_unstable();
            holes.dedup();
        }
        Ok(across)
    }

    /// For each side the cuts that were asked for: number, hole, ends.
    fn asked_cuts(&self) -> [Vec<(usize, usize, [DVec2; 2])>; 2] {
        Side::BOTH.map(|side| {
            let region = self.task.regions[side];
            let here = self.task.cuts.iter().filter(|(_, cut)| cut.side == side);
            let mut asked: Vec<(usize, usize, [DVec2; 2])> = Vec::new();
            for &(number, cut) in here {
                let far = |ring: &Ring| ring.distance_squared(cut.hole);
                let holes = region.holes.iter().map(far).enumerate();
                let nearest = holes.min_by(|a, b| a.1.total_cmp(&b.1));
                if let Some((hole, _)) = nearest
                    && asked.iter().all(|other| other.1 != hole)
                {
                    asked.push((number, hole, [cut.outer, cut.hole]));
                }
            }
            asked
        })
    }

    fn pinned_holes(&self, taken: &[Vec<usize>; 2]) -> Vec<[usize; 2]> {
        let mut fixed: Vec<[usize; 2]> = self
            .pins
            .iter()
            .filter(|pin| pin.rings[0] > 0 && pin.rings[1] > 0)
            .map(|pin| pin.rings.map(|ring| ring - 1))
            .filter(|pair| (0..2).all(|s| !taken[s].contains(&pair[s])))
            .collect();
        fixed.sort_unstable();
        fixed.dedup();
        fixed
    }

    fn largest_first(&self, side: Side, holes: &[usize]) -> Vec<usize> {
        let area = |hole: usize| self.task.regions[side].holes[hole].signed_area();
        let mut holes = holes.to_vec();
        holes.sort_by(|&a, &b| area(a).total_cmp(&area(b))); // clockwise: negative
        holes
    }

    /// The holes that the walk does not go around, with their numbers.
    fn closed_holes(&self, side: Side) -> (Vec<usize>, Vec<&'a Ring>) {
        let holes = self.task.regions[side].holes.iter().enumerate();
        let closed = holes.filter(|(k, _)| !self.opened[side].contains(k));
        closed.unzip()
    }

    fn open_asked(&mut self, side: Side, hole: usize, ends: [DVec2; 2]) -> Option<[DVec2; 2]> {
        let (numbers, holes) = self.closed_holes(side);
        let at = numbers.iter().position(|&k| k == hole)?;
        let (walk, slit) = cut::asked(&self.walks[side], &holes, at, ends)?;
        self.walks[side] = walk;
        self.opened[side].push(hole);
        Some(slit.ends)
    }

    /// Opens a hole where the rules say so, or where that matches better than
    /// closing it.
    fn open_if_better(&mut self, side: Side, hole: usize, forced: bool) -> Option<[DVec2; 2]> {
        let rule = self.task.holes;
        if rule == HoleRule::Close && !forced {
            return None;
        }
        let (numbers, holes) = self.closed_holes(side);
        let at = numbers.iter().position(|&k| k == hole)?;
        let other = self.walks[side.other()].curve().ok()?;
        let opened = cut::best(&self.walks[side], &holes, at, &other, &self.task.options)?;
        if rule == HoleRule::Auto && !forced {
            let blunt = self.coarse_cost(side, &other)?;
            let share = holes[at].perimeter() / self.walks[side].ring.perimeter();
            if blunt + CLOSING_PRICE * share <= opened.cost {
                return None;
            }
        }
        self.walks[side] = opened.walk;
        self.opened[side].push(hole);
        Some(opened.slit.ends)
    }

    fn coarse_cost(&self, side: Side, other: &Curve) -> Option<f64> {
        let curve = self.walks[side].curve().ok()?;
        let coarse = cut::coarse(&self.task.options);
        let matched = match_curves(&curve, other, &[], &coarse).ok()?;
        Some(matched.cost())
    }

    fn curves(&self) -> Result<[Curve; 2], RegionMatchError> {
        let curve = |side: Side| self.walks[side].curve().map_err(MatchError::from);
        Ok([curve(Side::Source)?, curve(Side::Target)?])
    }

    /// The match of the walks as they are now.
    fn outer_match(&self) -> Result<BoundaryMatch, RegionMatchError> {
        let curves = self.curves()?;
        let is_outer =
            |side: Side, ring: usize| ring == 0 || self.opened[side].contains(&(ring - 1));
        let pins: Vec<&PinHere> = self
            .pins
            .iter()
            .filter(|pin| {
                Side::BOTH
                    .iter()
                    .all(|&side| is_outer(side, pin.rings[side]))
            })
            .collect();
        self.with_pins(&pins, &curves, |pins| {
            match_curves(&curves[0], &curves[1], pins, &self.task.options)
        })
    }

    /// Runs a match and names pins by their numbers among all.
    fn with_pins(
        &self,
        pins: &[&PinHere],
        curves: &[Curve; 2],
        run: impl Fn(&[Pin]) -> Result<BoundaryMatch, MatchError>,
    ) -> Result<BoundaryMatch, RegionMatchError> {
        let places: Vec<Pin> = pins
            .iter()
            .map(|pin| Pin::of(|side| curves[side].nearest(pin.points[side])))
            .collect();
        let number = |k: usize| pins.get(k).map_or(k, |pin| pin.index);
        run(&places).map_err(|error| match error {
            MatchError::Pins(error) => RegionMatchError::Pins(renumbered(error, number)),
            error => RegionMatchError::Match(error),
        })
    }

    fn outer_ring(&self, matched: &BoundaryMatch) -> Result<RingMatch, RegionMatchError> {
        let curves = self.curves()?;
        let mut shared = matched.polygons(&curves[0], &curves[1], &spaced(1.0));
        for side in Side::BOTH {
            for &slit in &self.walks[side].slits {
                mirror(
                    &mut shared,
                    side,
                    &curves[side],
                    slit,
                    &curves[side.other()],
                );
            }
        }
        Ok(ring_of(shared))
    }

    /// Two holes that belong together. Where their form leaves the rotation
    /// open, they turn with their part.
    fn hole_ring(&self, [a, b]: [usize; 2], rotation: f64) -> Result<RingMatch, RegionMatchError> {
        let holes = [
            &self.task.regions[0].holes[a],
            &self.task.regions[1].holes[b],
        ];
        let curve = |ring: &Ring| Curve::closed(ring).map_err(MatchError::from);
        let curves = [curve(holes[0])?, curve(holes[1])?];
        let turned = |ring: &Ring, by: f64| {
            let (turn, middle) = (DVec2::from_angle(by), centre(ring));
            curve(&ring.mapped(|p| turn.rotate(p - middle)))
        };
        let posed = [
            turned(holes[0], 0.5 * rotation)?,
            turned(holes[1], -0.5 * rotation)?,
        ];
        let pins: Vec<&PinHere> = self
            .pins
            .iter()
            .filter(|pin| pin.rings == [a + 1, b + 1])
            .collect();
        let matched = self.with_pins(&pins, &curves, |pins| {
            match_curves(&posed[0], &posed[1], pins, &self.task.options)
        })?;
        let share = |side: Side| holes[side].perimeter() / self.walks[side].ring.perimeter();
        let options = spaced(0.5 * (share(Side::Source) + share(Side::Target)));
        Ok(ring_of(matched.polygons(&curves[0], &curves[1], &options)))
    }

    /// What is alone and was not opened closes to a point.
    fn closing_rings(&self, rings: &mut Vec<RingMatch>, rotation: f64) {
        let paired = rings.len() - 1;
        for side in Side::BOTH {
            let mut taken = Vec::new();
            for hole in self.unpaired(side, rings, paired) {
                let (from, to) = (&rings[0].source, &rings[0].target);
                let (outer, turn) = match side {
                    Side::Source => (Vertices { from, to }, rotation),
                    Side::Target => (Vertices { from: to, to: from }, -rotation),
                };
                let hole = self.divided(side, hole);
                let part = self.task.regions[side.other()];
                let point = point_ring(&hole, &outer, part, &taken, turn);
                taken.extend(point.first());
                let whole = hole.points().to_vec();
                rings.push(RingMatch::alone(side, whole, point));
            }
        }
    }

    /// Holes that neither the walk goes around nor a pair holds.
    fn unpaired(&self, side: Side, rings: &[RingMatch], paired: usize) -> Vec<&'a Ring> {
        let (_, holes) = self.closed_holes(side);
        let held = |hole: &Ring| {
            rings[1..=paired].iter().any(|ring| {
                let points = match side {
                    Side::Source => &ring.source,
                    Side::Target => &ring.target,
                };
                points.contains(&hole.points()[0])
            })
        };
        holes.into_iter().filter(|hole| !held(hole)).collect()
    }

    /// The ring with its long edges divided.
    fn divided(&self, side: Side, ring: &Ring) -> Ring {
        let outer = self.walks[side].ring.perimeter();
        let longest = (SPACING * outer).min(ring.perimeter() / LEAST_VERTICES);
        let mut points = Vec::new();
        for (a, b) in ring.edges() {
            let pieces = (a.distance(b) / longest).ceil().clamp(1.0, 1e4) as u32;
            points.extend((0..pieces).map(|k| a.lerp(b, f64::from(k) / f64::from(pieces))));
        }
        Ring::new(points).unwrap_or_else(|_| ring.clone())
    }
}

/// How vertices are shared on a ring that is `share` as long as the outer one.
fn spaced(share: f64) -> PolygonOptions {
    PolygonOptions {
        spacing: (SPACING / share).min(1.0 / LEAST_VERTICES),
        ..PolygonOptions::default()
    }
}

fn ring_of(shared: SharedPolygons) -> RingMatch {
    RingMatch {
        source: shared.source,
        target: shared.target,
        kind: RingKind::Matched,
    }
}

fn renumbered(error: PinError, number: impl Fn(usize) -> usize) -> PinError {
    match error {
        PinError::NotFinite(k) => PinError::NotFinite(number(k)),
        PinError::SamePoint(a, b) => PinError::SamePoint(number(a), number(b)),
        PinError::Crossing(a, b) => PinError::Crossing(number(a), number(b)),
        PinError::End(k) => PinError::End(number(k)),
    }
}
