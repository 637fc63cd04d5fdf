//! A part of one design alone: a speck in the other.

use crate::content::mean_point;
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::geometry::{DVec2, Side, inradius, inset, ring_edges, signed_area, winding};
use crate::transition::transients::growth_profile::{GrowthProfile, SIZE_STEPS};
use crate::transition::transients::layered_outline::LayeredOutline;
use crate::transition::transients::layers::PieceLayers;
use crate::transition::transients::sample_times::FINE_STEP;
use crate::transition::transients::schedule::life;
use crate::warp::TimeWindow;
use std::sync::OnceLock;

/// Places along its own outline that are searched.
const OWN_PLACES: usize = 12;

/// A part of one design alone.
pub(super) struct TransientPart {
    pub(super) piece: usize,
    /// The design that has it.
    pub(super) side: Side,
    /// What is on another level is not in its way.
    level: usize,
    area: f64,
    /// Its centroids in source and target.
    pub(super) ends: [DVec2; 2],
    /// Its rings about its centroid, as large as they are.
    pub(super) rings: Vec<Vec<DVec2>>,
    /// Its size across where it is a speck, as a share of its own.
    pub(super) least: f64,
    swelling: SwellingProfile,
}

/// A part as it swells, from nothing to all of it, once somebody asks.
#[derive(Default)]
struct SwellingProfile {
    depth: OnceLock<f64>,
    levels: [OnceLock<Vec<Vec<DVec2>>>; SIZE_STEPS + 1],
}

impl SwellingProfile {
    fn level(&self, level: usize, rings: &[Vec<DVec2>]) -> &[Vec<DVec2>] {
        self.levels[level].get_or_init(|| {
            let depth = self.depth.get_or_init(|| inradius(rings));
            let thin = 1.0 - level as f64 / SIZE_STEPS as f64;
            inset(rings, depth * thin)
        })
    }
}

impl TransientPart {
    /// All of a match, the largest first.
    pub(super) fn all(matched: &RegionMatch, levels: &PieceLayers) -> Vec<Self> {
        let pieces = matched.pieces.iter().enumerate();
        let alone = |(k, piece): (usize, &PieceMatch)| {
            let side = piece.only_side()?;
            Some(Self::of(k, piece, (side, levels.of_piece(k))))
        };
        let mut all: Vec<Self> = pieces.filter_map(alone).collect();
        let key = |s: &Self| [s.ends[s.side].x, s.ends[s.side].y];
        all.sort_by(|a, b| {
            let order = b.area.total_cmp(&a.area);
            // The order of the pieces is another in the film run backwards.
            let [p, q] = [key(a), key(b)];
            order
                .then(p[0].total_cmp(&q[0]))
                .then(p[1].total_cmp(&q[1]))
        });
        all
    }

    fn of(piece: usize, matched: &PieceMatch, (side, level): (Side, usize)) -> Self {
        let rings = |side: Side| {
            matched
                .rings
                .iter()
                .map(move |r| [&r.source, &r.target][side])
        };
        let ends = Side::BOTH.map(|side| centroid(rings(side)));
        let area = |side: Side| rings(side).map(|r| signed_area(r)).sum::<f64>();
        let whole = area(side);
        let about = |ring: &Vec<DVec2>| ring.iter().map(|&p| p - ends[side]).collect();
        Self {
            rings: rings(side).map(about).collect(),
            least: (area(side.other()) / whole).abs().sqrt(),
            area: whole,
            swelling: SwellingProfile::default(),
            piece,
            side,
            level,
            ends,
        }
    }

    /// How large it is where so much of its change is done.
    pub(super) fn size(&self, share: f64) -> f64 {
        let grown = match self.side {
            Side::Source => 1.0 - share,
            Side::Target => share,
        };
        self.least * (1.0 - grown) + grown
    }

    pub(super) fn ends_at(&self, place: DVec2) -> [DVec2; 2] {
        match self.side {
            Side::Source => [self.ends[0], place],
            Side::Target => [place, self.ends[1]],
        }
    }

    /// Places along its own outline, were it at `place`: from a tip a crescent
    /// grows around what lies in it.
    pub(super) fn own_places(&self, place: DVec2) -> Vec<DVec2> {
        let outer = self.rings.first().map_or(&[][..], Vec::as_slice);
        let step = outer.len().div_ceil(OWN_PLACES).max(1);
        outer.iter().step_by(step).map(|&p| place + p).collect()
    }

    pub(super) fn at(&self, centre: DVec2, size: f64) -> Vec<LayeredOutline> {
        let placed = |ring: &Vec<DVec2>| ring.iter().map(|&p| centre + p * size).collect();
        let rings = self.rings.iter().map(placed);
        rings
            .map(|ring| LayeredOutline::of(ring, self.level))
            .collect()
    }

    /// What the innermost of its rings encloses that goes around a place where it is
    /// drawn; none where none does.
    pub(super) fn size_around(&self, here: DVec2) -> Option<f64> {
        let around = self.rings.iter().filter(|ring| {
            let from_centre = here - self.ends[self.side];
            winding(ring, from_centre) != 0
        });
        around
            .map(|ring| signed_area(ring).abs())
            .min_by(f64::total_cmp)
    }

    /// From where its centroid would be, were it a speck that grows, to where it
    /// is while it swells.
    pub(super) fn off_middle_at(&self, share: f64) -> DVec2 {
        let outer = self.rings.first().map_or(&[][..], Vec::as_slice);
        mean_point(outer) * (self.size(share) - 1.0)
    }

    /// What is to be added to a place at which it swells for that to be the
    /// place of a speck which grows: it keeps its middle, and not its centroid.
    pub(super) fn off_middle(&self) -> DVec2 {
        let outer = self.rings.first().map_or(&[][..], Vec::as_slice);
        mean_point(outer) * (1.0 - self.least)
    }

    /// Where so much of its change is done, and its centroid would be at
    /// `centre` were it a speck that grows: swelling, somewhat thicker than it
    /// is.
    pub(super) fn swollen(&self, centre: DVec2, share: f64) -> Vec<LayeredOutline> {
        let level = (self.size(share) * SIZE_STEPS as f64).ceil();
        let level = level.clamp(0.0, SIZE_STEPS as f64);
        let at = centre + self.off_middle_at(share);
        let placed = |ring: &Vec<DVec2>| ring.iter().map(|&p| at + p).collect();
        self.swelling
            .level(level as usize, &self.rings)
            .iter()
            .map(placed)
            .map(|ring| LayeredOutline::of(ring, self.level))
            .collect()
    }

    /// What it is while it swells; `diameter` is that of the whole.
    pub(super) fn swelling(&self, diameter: f64) -> GrowthProfile {
        GrowthProfile::of_steps(|size| self.swelling.level(size, &self.rings), diameter)
    }

    /// What would meet something in all times comes or goes at once.
    pub(super) fn at_once(&self) -> TimeWindow {
        life(self.side, FINE_STEP)
    }
}

/// The centroid of what some rings enclose together.
fn centroid<'a>(rings: impl Iterator<Item = &'a Vec<DVec2>>) -> DVec2 {
    let (mut sum, mut total, mut base) = (DVec2::ZERO, 0.0, None);
    for ring in rings {
        // About a point of its own: far from the origin sums lose their digits.
        let base = *base.get_or_insert(ring[0]);
        for (a, b) in ring_edges(ring) {
            let (a, b) = (a - base, b - base);
            let twice = a.perp_dot(b);
            sum += twice * (a + b) / 3.0;
            total += twice;
        }
    }
    base.unwrap_or_default() + sum / total
}
