//! A part that exists in only one design. It grows from a seed shape, or it swells, that is, grows
//! in thickness within its outline.

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

/// Maximum number of candidate positions along the part's own outline (resource limit).
const OWN_PLACES: usize = 12;

/// A part that exists in only one design.
pub(super) struct TransientPart {
    /// Index of the piece.
    pub(super) piece: usize,
    /// Design that has the part.
    pub(super) side: Side,
    /// Index of its layer; parts on other layers are no obstacles.
    level: usize,
    /// Area in the design that has the part.
    area: f64,
    /// Centroids in source and target.
    pub(super) ends: [DVec2; 2],
    /// Rings of the part in full size, relative to its centroid.
    pub(super) rings: Vec<Vec<DVec2>>,
    /// Diameter of the seed shape, as a fraction of the part's diameter.
    pub(super) least: f64,
    swelling: SwellingProfile,
}

/// Outlines of a part that grows in thickness (swells) at each step of thickness, computed on first
/// use.
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
    /// Returns all parts of a match that exist in only one design, the largest first.
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
            // Ties are broken by position, because swapping the designs changes the order of the
            // pieces.
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

    /// Returns the size of the part relative to full size when the fraction `share` of its change
    /// of size is completed.
    pub(super) fn size(&self, share: f64) -> f64 {
        let grown = match self.side {
            Side::Source => 1.0 - share,
            Side::Target => share,
        };
        self.least * (1.0 - grown) + grown
    }

    /// Returns the centroids in source and target if the seed shape is at `place`.
    pub(super) fn ends_at(&self, place: DVec2) -> [DVec2; 2] {
        match self.side {
            Side::Source => [self.ends[0], place],
            Side::Target => [place, self.ends[1]],
        }
    }

    /// Returns candidate positions of the seed shape along the part's own outline, for a part at
    /// `place`. A crescent, for instance, can grow from its tip around a shape that lies within its
    /// curve.
    pub(super) fn own_places(&self, place: DVec2) -> Vec<DVec2> {
        let outer = self.rings.first().map_or(&[][..], Vec::as_slice);
        let step = outer.len().div_ceil(OWN_PLACES).max(1);
        outer.iter().step_by(step).map(|&p| place + p).collect()
    }

    /// Returns the outlines of the part for a given centroid and a size relative to full size.
    pub(super) fn at(&self, centre: DVec2, size: f64) -> Vec<LayeredOutline> {
        let placed = |ring: &Vec<DVec2>| ring.iter().map(|&p| centre + p * size).collect();
        let rings = self.rings.iter().map(placed);
        rings
            .map(|ring| LayeredOutline::of(ring, self.level))
            .collect()
    }

    /// Returns the area enclosed by the smallest ring of this part around the point `here` of its
    /// design; `None` if no ring encloses that point.
    pub(super) fn size_around(&self, here: DVec2) -> Option<f64> {
        let around = self.rings.iter().filter(|ring| {
            let from_centre = here - self.ends[self.side];
            winding(ring, from_centre) != 0
        });
        around
            .map(|ring| signed_area(ring).abs())
            .min_by(f64::total_cmp)
    }

    /// Returns the vector from the centroid of the part, if it grows from a seed shape, to the
    /// centroid of its full outline, if it swells, when the fraction `share` of the change is
    /// completed. The mean of the outer points is the same in both cases.
    pub(super) fn off_middle_at(&self, share: f64) -> DVec2 {
        let outer = self.rings.first().map_or(&[][..], Vec::as_slice);
        mean_point(outer) * (self.size(share) - 1.0)
    }

    /// Returns the vector that is added to the position of a swelling part to obtain the centroid
    /// of the seed shape that gives the same motion. A swelling part is placed by the mean of its
    /// outer points, a seed shape by its centroid.
    pub(super) fn off_middle(&self) -> DVec2 {
        let outer = self.rings.first().map_or(&[][..], Vec::as_slice);
        mean_point(outer) * (1.0 - self.least)
    }

    /// Returns the outlines of the swelling part (the part that grows in thickness) at the fraction
    /// `share` of the change. `centre` is the centroid at that time if the part grew from a seed
    /// shape instead. The thickness is rounded up to the next step.
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

    /// Returns the growth profile of the part if it grows in thickness; `diameter` is that of the
    /// whole design.
    pub(super) fn swelling(&self, diameter: f64) -> GrowthProfile {
        GrowthProfile::of_steps(|size| self.swelling.level(size, &self.rings), diameter)
    }

    /// Returns the shortest time window. A part that collides in all longer time windows uses it to
    /// appear or disappear at once.
    pub(super) fn at_once(&self) -> TimeWindow {
        life(self.side, FINE_STEP)
    }
}

/// Returns the centroid of the region that the rings enclose.
fn centroid<'a>(rings: impl Iterator<Item = &'a Vec<DVec2>>) -> DVec2 {
    let (mut sum, mut total, mut base) = (DVec2::ZERO, 0.0, None);
    for ring in rings {
        // Relative to a point of the ring, because far from the origin the sums would lose digits.
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
