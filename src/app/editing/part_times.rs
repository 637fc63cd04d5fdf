//! The times of parts, as they are said piece by piece.
//!
//! The project names a part by a point of a design. A piece is named in the design in which its
//! part is no other piece's, so that what is said of one half of a part that splits is not said of
//! the other.

use crate::app::editing::polyline;
use crate::app::editing::sheet::MatchSheet;
use crate::app::editing::sheet_ring::SheetRing;
use crate::geometry::{Bounds, DVec2, Side};
use crate::settings::choice::named;
use crate::time::easing::EasingFunction;
use crate::transition::PartTime;
use crate::warp::PartClock;

/// How much of the film a part takes when parts set out one after the other.
const SHARE: f64 = 0.5;

/// In which order parts set out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StaggerOrder {
    /// The leftmost first.
    LeftToRight,
    /// The highest first.
    TopToBottom,
    /// What is nearest to the middle first.
    FromTheMiddle,
}

named! { StaggerOrder {
    LeftToRight: "left-to-right", "Left to right", "The leftmost part sets out first";
    TopToBottom: "top-to-bottom", "Top to bottom", "The highest part sets out first";
    FromTheMiddle: "from-the-middle", "From the middle", "The part nearest to the middle sets out first";
} }

/// For each piece its time, by the number in the project: the last that was said.
#[must_use]
pub fn time_of_pieces(sheet: &MatchSheet, times: &[PartTime]) -> Vec<Option<usize>> {
    let mut said = vec![None; sheet.pieces.len()];
    for (k, named) in named_pieces(sheet, times).into_iter().enumerate() {
        for piece in named {
            said[piece] = Some(k);
        }
    }
    said
}

/// Says when a piece makes its way, and forgets what was said of it, but not of others; the clock
/// of the whole need not be said.
pub fn set(sheet: &MatchSheet, times: &mut Vec<PartTime>, piece: usize, clock: PartClock) {
    let said = time_of_pieces(sheet, times);
    let named_by = named_pieces(sheet, times);
    let is_forgotten = |k: usize| named_by[k].contains(&piece);
    // What goes with it was said of other pieces of its part too.
    let others = said.iter().enumerate().filter_map(|(other, time)| {
        let time = (*time).filter(|&k| other != piece && is_forgotten(k))?;
        named(sheet, other, times[time].clock())
    });
    let others: Vec<PartTime> = others.collect();
    let mut number = 0..times.len();
    times.retain(|_| !number.next().is_some_and(is_forgotten));
    times.extend(others);
    if clock != PartClock::WHOLE {
        times.extend(named(sheet, piece, clock));
    }
}

/// All pieces, one after the other.
#[must_use]
pub fn staggered(sheet: &MatchSheet, order: StaggerOrder) -> Vec<PartTime> {
    let middle = |k: usize| sheet.pieces[k].at[side_of(sheet, k)];
    let count = sheet.pieces.len();
    let sum: DVec2 = (0..count).map(middle).sum();
    let centre = sum / count.max(1) as f64;
    let rank = |k: usize| match order {
        StaggerOrder::LeftToRight => middle(k).x,
        StaggerOrder::TopToBottom => -middle(k).y,
        StaggerOrder::FromTheMiddle => middle(k).distance(centre),
    };
    let mut pieces: Vec<usize> = (0..count).collect();
    pieces.sort_by(|a, b| rank(*a).total_cmp(&rank(*b)));
    let time = |(place, piece): (usize, usize)| {
        let step = (1.0 - SHARE) / (count.max(2) - 1) as f64;
        let from = rounded(step * place as f64);
        let clock = PartClock {
            from,
            to: rounded(from + SHARE),
            easing: EasingFunction::default(),
        };
        named(sheet, piece, clock)
    };
    pieces.into_iter().enumerate().filter_map(time).collect()
}

/// To a thousandth, within the film.
fn rounded(t: f64) -> f64 {
    (t.clamp(0.0, 1.0) * 1000.0).round() / 1000.0
}

/// A piece's time, by a point of its own.
fn named(sheet: &MatchSheet, piece: usize, clock: PartClock) -> Option<PartTime> {
    let side = side_of(sheet, piece);
    let at = sheet.by[side]
        .inverse()
        .apply(sheet.pieces.get(piece)?.at[side]);
    let PartClock { from, to, easing } = clock;
    Some(PartTime {
        side,
        at,
        from,
        to,
        easing,
    })
}

/// The design in which a piece is named.
fn side_of(sheet: &MatchSheet, piece: usize) -> Side {
    let own = &sheet.pieces[piece].parts;
    let is_alone_in = |side: &Side| {
        let same = sheet
            .pieces
            .iter()
            .filter(|other| other.parts[*side] == own[*side]);
        own[*side].is_some() && same.count() == 1
    };
    let has = |side: &Side| own[*side].is_some();
    let sides = Side::BOTH.into_iter();
    let found = sides
        .clone()
        .find(is_alone_in)
        .or_else(|| sides.clone().find(has));
    found.unwrap_or(Side::Source)
}

/// The pieces that each time is of: those of the part that its point is in, the uppermost of
/// several, or nearest to.
fn named_pieces(sheet: &MatchSheet, times: &[PartTime]) -> Vec<Vec<usize>> {
    let mut of_pieces: Vec<Vec<&SheetRing>> = vec![Vec::new(); sheet.pieces.len()];
    for ring in &sheet.rings {
        of_pieces[ring.piece].push(ring);
    }
    let boxes = Side::BOTH.map(|side| {
        let of = |rings: &Vec<&SheetRing>| {
            Bounds::of(
                rings
                    .iter()
                    .flat_map(|ring| ring.sides[side].iter().copied()),
            )
        };
        of_pieces.iter().map(of).collect::<Vec<_>>()
    });
    let of_time = |time: &PartTime| {
        let (side, at) = (time.side, sheet.by[time.side].apply(time.at));
        let is_in = |piece: &usize| {
            let rings = of_pieces[*piece].iter();
            boxes[side][*piece].is_some_and(|bounds| bounds.contains(at))
                && polyline::encloses(rings.map(|ring| ring.sides[side].as_slice()), at)
        };
        let nearest = || {
            let all = sheet.rings.iter().map(|ring| ring.sides[side].as_slice());
            Some(sheet.rings[polyline::nearest(all, at)?.ring].piece)
        };
        let part = |k: usize| sheet.pieces[k].parts[side];
        let holding = (0..of_pieces.len()).filter(is_in);
        let Some(named) = holding.max_by_key(|&k| part(k)).or_else(nearest) else {
            return Vec::new();
        };
        let is_of_part = |&k: &usize| k == named || (part(k).is_some() && part(k) == part(named));
        (0..of_pieces.len()).filter(is_of_part).collect()
    };
    times.iter().map(of_time).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::editing::sheet::{PieceFate, SheetPiece};
    use crate::correspondence::{MatchSettings, RingKind};
    use crate::time::easing::NamedEasing;
    use crate::transition::PaintRule;
    use crate::work::progress::Silent;

    /// Three squares in a row; the first two are halves of one part of the source.
    fn sheet() -> MatchSheet {
        let square = |x: f64| -> Vec<DVec2> {
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
            corners.map(|(a, b)| DVec2::new(a + x, b)).to_vec()
        };
        let piece = |(k, parts): (usize, [usize; 2])| SheetPiece {
            name: k.to_string(),
            fate: PieceFate::Paired,
            at: [DVec2::new(3.0 * k as f64 + 0.5, 0.5); 2],
            is_linked: false,
            parts: parts.map(Some),
        };
        let ring = |k: usize| {
            let ring = square(3.0 * k as f64);
            SheetRing::new(k, RingKind::Matched, [ring.clone(), ring])
        };
        let parts = [[0, 0], [0, 1], [1, 2]];
        MatchSheet {
            pieces: parts.into_iter().enumerate().map(piece).collect(),
            rings: (0..3).map(ring).collect(),
            ..MatchSheet::default()
        }
    }

    const LATE: PartClock = PartClock {
        from: 0.5,
        to: 1.0,
        easing: EasingFunction::Named(NamedEasing::Linear),
    };

    #[test]
    fn a_piece_of_a_part_that_splits_has_a_time_of_its_own() {
        let (sheet, mut times) = (sheet(), Vec::new());
        set(&sheet, &mut times, 1, LATE);
        assert_eq!(time_of_pieces(&sheet, &times), [None, Some(0), None]);
        assert_eq!(times[0].side, Side::Target);
        set(&sheet, &mut times, 1, PartClock::WHOLE);
        assert!(times.is_empty());
    }

    #[test]
    fn what_is_said_of_a_part_is_said_of_its_pieces() {
        let sheet = sheet();
        let mut time = named(&sheet, 0, LATE).expect("a piece");
        time.side = Side::Source;
        assert_eq!(time_of_pieces(&sheet, &[time]), [Some(0), Some(0), None]);
        // The other half keeps what was said of both.
        let mut times = vec![time];
        set(&sheet, &mut times, 1, PartClock::WHOLE);
        assert_eq!(time_of_pieces(&sheet, &times), [Some(0), None, None]);
        assert_eq!(times[0].clock(), LATE);
    }

    #[test]
    fn parts_set_out_in_order_and_the_last_arrives_at_the_end() {
        let sheet = sheet();
        let times = staggered(&sheet, StaggerOrder::LeftToRight);
        let said = time_of_pieces(&sheet, &times).into_iter();
        let clocks: Vec<PartClock> = said.map(|k| times[k.expect("a time")].clock()).collect();
        let starts: Vec<f64> = clocks.iter().map(|clock| clock.from).collect();
        assert_eq!(starts, [0.0, 0.25, 0.5]);
        assert_eq!(clocks[2].to, 1.0);
        let first = staggered(&sheet, StaggerOrder::FromTheMiddle)[0];
        assert_eq!(time_of_pieces(&sheet, &[first])[1], Some(0));
    }

    #[test]
    fn a_part_upon_others_has_a_time_of_its_own() {
        let loaded = crate::project::gallery::load("day-to-night").expect("a project");
        let film = loaded.legs()[0].build(&Silent).expect("a film");
        let designs = [0, 1].map(|k| &*loaded.designs[k]);
        let by = loaded.arrangement().expect("places");
        let sheet = MatchSheet::new(
            designs,
            by,
            PaintRule::Own,
            &MatchSettings::default(),
            film.matched(),
        );
        let count = sheet.pieces.len();
        assert!(count > 8);
        for piece in 0..count {
            let mut times = Vec::new();
            set(&sheet, &mut times, piece, LATE);
            let mut expected = vec![None; count];
            expected[piece] = Some(0);
            assert_eq!(time_of_pieces(&sheet, &times), expected, "{piece}");
        }
    }
}
