//! Edits the time windows of pieces. A time window is the interval of the film in which a part
//! moves.
//!
//! A piece is a part of the source matched with a part of the target, or an unmatched part. A part
//! that splits belongs to several pieces. The project identifies a part by a point of one design.
//! For a piece, the point lies in a design where no other piece has the same part; so setting the
//! time of one half of a part that splits does not affect the other half.

use crate::app::editing::polyline;
use crate::app::editing::sheet::MatchSheet;
use crate::app::editing::sheet_ring::SheetRing;
use crate::geometry::{Bounds, DVec2, Side};
use crate::settings::named;
use crate::time::EasingFunction;
use crate::transition::PartTime;
use crate::warp::PartClock;

/// Fraction of the film that each part takes when parts start one after the other (heuristic).
const PART_DURATION: f64 = 0.5;

/// Order in which parts start one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StaggerOrder {
    /// The leftmost part first.
    LeftToRight,
    /// The topmost part first.
    TopToBottom,
    /// The part nearest to the centre first.
    FromTheMiddle,
}

named! { StaggerOrder {
    LeftToRight: "left-to-right", "Left to right", "Leftmost part starts first";
    TopToBottom: "top-to-bottom", "Top to bottom", "Topmost part starts first";
    FromTheMiddle: "from-the-middle", "From the centre", "Part nearest to the centre starts first";
} }

/// For each piece, the index in `times` of the time window that applies to it, or of the last one
/// if several apply; `None` if none applies.
#[must_use]
pub fn time_of_pieces(sheet: &MatchSheet, times: &[PartTime]) -> Vec<Option<usize>> {
    let mut time_of_piece = vec![None; sheet.pieces.len()];
    for (k, pieces) in pieces_of_times(sheet, times).into_iter().enumerate() {
        for piece in pieces {
            time_of_piece[piece] = Some(k);
        }
    }
    time_of_piece
}

/// Sets the time window of one piece and leaves those of other pieces unchanged. The whole film is
/// the default and needs no entry in `times`.
pub fn set_part_time(
    sheet: &MatchSheet,
    times: &mut Vec<PartTime>,
    piece: usize,
    clock: PartClock,
) {
    let time_of_piece = time_of_pieces(sheet, times);
    let pieces_of_time = pieces_of_times(sheet, times);
    let is_removed = |k: usize| pieces_of_time[k].contains(&piece);
    // A removed entry may also apply to other pieces of the same part. Each of these pieces gets a
    // separate entry with the same time window.
    let remaining = time_of_piece
        .iter()
        .enumerate()
        .filter_map(|(other, time)| {
            let time = (*time).filter(|&k| other != piece && is_removed(k))?;
            part_time_of_piece(sheet, other, times[time].clock())
        });
    let remaining: Vec<PartTime> = remaining.collect();
    let mut number = 0..times.len();
    times.retain(|_| !number.next().is_some_and(is_removed));
    times.extend(remaining);
    if clock != PartClock::WHOLE {
        times.extend(part_time_of_piece(sheet, piece, clock));
    }
}

/// Time windows that let all pieces start one after the other.
#[must_use]
pub fn staggered_times(sheet: &MatchSheet, order: StaggerOrder) -> Vec<PartTime> {
    let middle = |k: usize| sheet.pieces[k].label_at[identifying_side(sheet, k)];
    let count = sheet.pieces.len();
    let sum: DVec2 = (0..count).map(middle).sum();
    let centre = sum / count.max(1) as f64;
    // Smaller ranks start earlier; y points up.
    let rank = |k: usize| match order {
        StaggerOrder::LeftToRight => middle(k).x,
        StaggerOrder::TopToBottom => -middle(k).y,
        StaggerOrder::FromTheMiddle => middle(k).distance(centre),
    };
    let mut pieces: Vec<usize> = (0..count).collect();
    pieces.sort_by(|a, b| rank(*a).total_cmp(&rank(*b)));
    let time = |(place, piece): (usize, usize)| {
        // The pieces start at regular intervals, and the last piece ends with the film.
        let step = (1.0 - PART_DURATION) / (count.max(2) - 1) as f64;
        let from = round_to_thousandth(step * place as f64);
        let clock = PartClock {
            from,
            to: round_to_thousandth(from + PART_DURATION),
            easing: EasingFunction::default(),
        };
        part_time_of_piece(sheet, piece, clock)
    };
    pieces.into_iter().enumerate().filter_map(time).collect()
}

/// Rounds a time to a thousandth of the film, within [0, 1].
fn round_to_thousandth(t: f64) -> f64 {
    (t.clamp(0.0, 1.0) * 1000.0).round() / 1000.0
}

/// Project entry for the time window `clock` of a piece. It identifies the piece by the point at
/// which the label of the piece is placed.
fn part_time_of_piece(sheet: &MatchSheet, piece: usize, clock: PartClock) -> Option<PartTime> {
    let side = identifying_side(sheet, piece);
    let at = sheet.frame_from_design[side]
        .inverse()
        .apply(sheet.pieces.get(piece)?.label_at[side]);
    let PartClock { from, to, easing } = clock;
    Some(PartTime {
        side,
        at,
        from,
        to,
        easing,
    })
}

/// Returns the design in which a point identifies the piece: one in which the part of the piece
/// belongs to no other piece or, if there is none, the first design that contains the piece.
fn identifying_side(sheet: &MatchSheet, piece: usize) -> Side {
    let parts = &sheet.pieces[piece].parts;
    let is_only_piece_in = |side: &Side| {
        let same = sheet
            .pieces
            .iter()
            .filter(|other| other.parts[*side] == parts[*side]);
        parts[*side].is_some() && same.count() == 1
    };
    let has = |side: &Side| parts[*side].is_some();
    let sides = Side::BOTH.into_iter();
    let identifying = sides
        .clone()
        .find(is_only_piece_in)
        .or_else(|| sides.clone().find(has));
    identifying.unwrap_or(Side::Source)
}

/// For each time window, the pieces to which it applies. The project stores a time window with a
/// point of one design. The window applies to all pieces of the topmost part that contains this
/// point or, if no part contains it, of the nearest part.
fn pieces_of_times(sheet: &MatchSheet, times: &[PartTime]) -> Vec<Vec<usize>> {
    let mut rings_of_piece: Vec<Vec<&SheetRing>> = vec![Vec::new(); sheet.pieces.len()];
    for ring in &sheet.rings {
        rings_of_piece[ring.piece].push(ring);
    }
    let boxes = Side::BOTH.map(|side| {
        let bounds_of = |rings: &Vec<&SheetRing>| {
            Bounds::of(
                rings
                    .iter()
                    .flat_map(|ring| ring.sides[side].iter().copied()),
            )
        };
        rings_of_piece.iter().map(bounds_of).collect::<Vec<_>>()
    });
    let pieces_of_time = |time: &PartTime| {
        let (side, at) = (time.side, sheet.frame_from_design[time.side].apply(time.at));
        let is_in = |piece: &usize| {
            let rings = rings_of_piece[*piece].iter();
            boxes[side][*piece].is_some_and(|bounds| bounds.contains(at))
                && polyline::encloses(rings.map(|ring| ring.sides[side].as_slice()), at)
        };
        let nearest = || {
            let all = sheet.rings.iter().map(|ring| ring.sides[side].as_slice());
            Some(sheet.rings[polyline::nearest(all, at)?.ring].piece)
        };
        let part = |k: usize| sheet.pieces[k].parts[side];
        let containing = (0..rings_of_piece.len()).filter(is_in);
        // The part with the largest index is painted last and so lies on top.
        let Some(topmost) = containing.max_by_key(|&k| part(k)).or_else(nearest) else {
            return Vec::new();
        };
        // A time window set for a part applies to all pieces of the part.
        let is_of_part =
            |&k: &usize| k == topmost || (part(k).is_some() && part(k) == part(topmost));
        (0..rings_of_piece.len()).filter(is_of_part).collect()
    };
    times.iter().map(pieces_of_time).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::editing::sheet::{PieceFate, SheetPiece};
    use crate::correspondence::{MatchSettings, RingKind};
    use crate::time::NamedEasing;
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
            label_at: [DVec2::new(3.0 * k as f64 + 0.5, 0.5); 2],
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

    /// Time window of the second half of the film.
    const LATE: PartClock = PartClock {
        from: 0.5,
        to: 1.0,
        easing: EasingFunction::Named(NamedEasing::Linear),
    };

    #[test]
    fn each_half_of_a_split_part_has_its_own_time() {
        let (sheet, mut times) = (sheet(), Vec::new());
        set_part_time(&sheet, &mut times, 1, LATE);
        assert_eq!(time_of_pieces(&sheet, &times), [None, Some(0), None]);
        assert_eq!(times[0].side, Side::Target);
        set_part_time(&sheet, &mut times, 1, PartClock::WHOLE);
        assert!(times.is_empty());
    }

    #[test]
    fn the_time_of_a_part_applies_to_its_pieces() {
        let sheet = sheet();
        let mut time = part_time_of_piece(&sheet, 0, LATE).expect("a piece");
        time.side = Side::Source;
        assert_eq!(time_of_pieces(&sheet, &[time]), [Some(0), Some(0), None]);
        // The other half keeps the time window that was set for both halves.
        let mut times = vec![time];
        set_part_time(&sheet, &mut times, 1, PartClock::WHOLE);
        assert_eq!(time_of_pieces(&sheet, &times), [Some(0), None, None]);
        assert_eq!(times[0].clock(), LATE);
    }

    #[test]
    fn parts_start_in_order_and_the_last_ends_with_the_film() {
        let sheet = sheet();
        let times = staggered_times(&sheet, StaggerOrder::LeftToRight);
        let time_of_piece = time_of_pieces(&sheet, &times).into_iter();
        let clocks: Vec<PartClock> = time_of_piece
            .map(|k| times[k.expect("a time")].clock())
            .collect();
        let starts: Vec<f64> = clocks.iter().map(|clock| clock.from).collect();
        assert_eq!(starts, [0.0, 0.25, 0.5]);
        assert_eq!(clocks[2].to, 1.0);
        let first = staggered_times(&sheet, StaggerOrder::FromTheMiddle)[0];
        assert_eq!(time_of_pieces(&sheet, &[first])[1], Some(0));
    }

    #[test]
    fn a_part_on_top_of_others_has_its_own_time() {
        let loaded = crate::project::gallery::load("day-to-night").expect("a project");
        let film = loaded.segments()[0].build(&Silent).expect("a film");
        let designs = [0, 1].map(|k| &*loaded.designs[k]);
        let similarities = loaded.frame_similarities().expect("places");
        let sheet = MatchSheet::new(
            designs,
            similarities,
            PaintRule::Own,
            &MatchSettings::default(),
            film.matched(),
        );
        let count = sheet.pieces.len();
        assert!(count > 8);
        for piece in 0..count {
            let mut times = Vec::new();
            set_part_time(&sheet, &mut times, piece, LATE);
            let mut expected = vec![None; count];
            expected[piece] = Some(0);
            assert_eq!(time_of_pieces(&sheet, &times), expected, "{piece}");
        }
    }
}
