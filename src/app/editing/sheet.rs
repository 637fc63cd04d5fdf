//! The match sheet: everything the match editor shows of both designs and their match, in the frame
//! that both are placed in.
//!
//! It is rebuilt whenever the project or its transition changes, and never while drawing.

use bevy::prelude::Resource;

use crate::app::editing::sheet_ring::SheetRing;
use crate::app::editing::{labels, polyline, sample_points};
use crate::content::ContentKind;
use crate::correspondence::{
    LinePair, MatchSettings, PieceMatch, PointPair, RegionMatch, RingCut, RingKind,
};
use crate::design::{Design, DesignForm, Picture};
use crate::geometry::{Bounds, DVec2, Side, Similarity};
use crate::transition::PaintRule;

/// Maximum distance between a cut that the user requested and a cut of the match that fulfils this
/// request; the match may move the requested cut. The distance is summed over both ends of the cut,
/// as a fraction of the designs' size (heuristic).
const CUT_SHIFT: f64 = 0.25;

/// Both designs and their match, placed in the common frame.
#[derive(Resource, Clone, Debug, Default)]
pub struct MatchSheet {
    /// Source and target; `None` if they are not both outlines.
    pub sides: Option<[SheetSide; 2]>,
    /// Rings of all pieces, matched or not; empty while there is no transition.
    pub rings: Vec<SheetRing>,
    /// Pieces of the match; empty while there is no transition.
    pub pieces: Vec<SheetPiece>,
    /// Pins of the project, in frame coordinates.
    pub pins: Vec<PointPair>,
    /// Indices of the pins that caused the match to fail.
    pub faulty_pins: Vec<usize>,
    /// Automatically matched points that are shown.
    pub features: Vec<PointPair>,
    /// Letter index of each point in `features`; 0 is the letter a.
    pub letters: Vec<usize>,
    /// Points of the previous sheet that are missing on this one, with their letter indices. They
    /// keep their letters if the next sheet contains them again, as when the best film replaces a
    /// draft.
    pub missing_points: Vec<(PointPair, usize)>,
    /// Pairs of lines of the project, in frame coordinates.
    pub lines: Vec<LinePair>,
    /// Content of the film; it decides whether pins move a boundary or the plane.
    pub content: Option<ContentKind>,
    /// Cuts along which parts with holes open, automatic or set by the user.
    pub cuts: Vec<SheetCut>,
    /// Transformations from each design's own coordinates to the frame.
    pub frame_from_design: [Similarity; 2],
}

/// One of the two designs on the match sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetSide {
    /// Parts of the design as they are matched, each an outline followed by its holes; later parts
    /// cover earlier ones.
    pub parts: Vec<Vec<Vec<DVec2>>>,
    /// Corners that pins snap to.
    pub corners: Vec<DVec2>,
    /// Bounding box of the parts.
    pub bounds: Bounds,
    /// Picture that the design was read from, placed in the frame; `None` if it was not a picture.
    pub picture: Option<Picture>,
}

/// A piece: a part of the source matched with a part of the target, or a part of only one design.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetPiece {
    /// Label of the piece, the same in both designs.
    pub name: String,
    /// Whether the piece exists in both designs, or appears or disappears.
    pub fate: PieceFate,
    /// Position of the label in the source and in the target.
    pub label_at: [DVec2; 2],
    /// Whether the user paired the piece's parts, or marked its part as unmatched.
    pub is_linked: bool,
    /// Index of the piece's part in the source and in the target; `None` where it has none.
    pub parts: [Option<usize>; 2],
}

/// Whether a piece exists in both designs or in only one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceFate {
    /// The piece exists in both designs.
    Paired,
    /// The piece exists only in the target and appears, growing from a point.
    Appears,
    /// The piece exists only in the source and disappears, shrinking to a point.
    Disappears,
}

/// A cut from a hole to another boundary of its part. The part opens along the cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetCut {
    /// The cut that the match uses, or the user's request if no cut of the match fulfils it.
    pub cut: RingCut,
    /// The cut as the user requested it; `None` for an automatic cut.
    pub requested: Option<RingCut>,
    /// Index, in the project, of the cut that the user requested; `None` for an automatic cut.
    pub requested_index: Option<usize>,
}

impl MatchSheet {
    /// Lays out a pair of imported designs in the frame. `paint` is the rule by which their paint
    /// layers were matched. The sheet is empty if a design is not an outline.
    #[must_use]
    pub fn new(
        designs: [&Design; 2],
        similarities: [Similarity; 2],
        paint: PaintRule,
        matching: &MatchSettings,
        matched: Option<&RegionMatch>,
    ) -> Self {
        let side = |k: usize| side(designs[k], &similarities[k], paint);
        let [Some(source), Some(target)] = [0, 1].map(side) else {
            return Self::default();
        };
        let placed = matching.placed(&similarities);
        let pieces: &[PieceMatch] = matched.map_or(&[], |matched| &matched.pieces);
        let rings = rings(pieces);
        let diameter = source.bounds.diameter().max(target.bounds.diameter());
        let sides = [source, target];
        Self {
            // Automatic points keep away from pins, which matter more.
            features: sample_points::choose_sample_points(&rings, &placed.pins),
            pieces: label_pieces(pieces, &sides, &placed),
            cuts: cuts(pieces, &placed.cuts, diameter),
            sides: Some(sides),
            rings,
            pins: placed.pins,
            lines: placed.lines,
            content: None,
            faulty_pins: Vec::new(),
            letters: Vec::new(),
            missing_points: Vec::new(),
            frame_from_design: similarities,
        }
    }

    /// Assigns letters to the automatic points; points that were on one of the last two sheets keep
    /// their letters.
    pub fn assign_letters(&mut self, before: Option<&Self>) {
        let sizes = self.sides.iter().flatten();
        let largest = sizes.map(|side| side.bounds.diameter()).fold(0.0, f64::max);
        let previous: Vec<(PointPair, usize)> = before.map_or_else(Vec::new, |before| {
            let letters = before.letters.iter().copied();
            before.features.iter().copied().zip(letters).collect()
        });
        let missing_before = before.map_or(&[][..], |before| &before.missing_points);
        let lettered = [&previous[..], missing_before].concat();
        self.letters = labels::stable_letters(
            &self.features,
            &lettered,
            labels::SAME_POINT_DISTANCE * largest,
        );
        let missing = previous.into_iter();
        let missing = missing.filter(|(_, letter)| !self.letters.contains(letter));
        self.missing_points = missing.collect();
    }

    /// Whether pins and lines may lie anywhere, because they move the plane and not a boundary.
    #[must_use]
    pub fn has_free_pins(&self) -> bool {
        matches!(
            self.content,
            Some(ContentKind::Field | ContentKind::Colours)
        )
    }

    /// Whether the content is pictures.
    #[must_use]
    pub fn shows_pictures(&self) -> bool {
        self.content == Some(ContentKind::Colours)
    }

    /// Nearest point on the boundary of one design.
    #[must_use]
    pub fn nearest_boundary_point(
        &self,
        side: Side,
        p: DVec2,
    ) -> Option<polyline::NearestRingPoint> {
        let parts = &self.sides.as_ref()?[side].parts;
        polyline::nearest(parts.iter().flatten().map(Vec::as_slice), p)
    }

    /// Nearest corner of one design within the distance `reach`.
    #[must_use]
    pub fn corner_near(&self, side: Side, p: DVec2, reach: f64) -> Option<DVec2> {
        let corners = &self.sides.as_ref()?[side].corners;
        let near = corners.iter().filter(|corner| corner.distance(p) <= reach);
        near.min_by(|a, b| a.distance(p).total_cmp(&b.distance(p)))
            .copied()
    }

    /// The point in the other design matched with a boundary point; `None` if there is no match.
    #[must_use]
    pub fn matched_point(&self, side: Side, p: DVec2) -> Option<DVec2> {
        let rings = self.rings.iter().map(|ring| ring.sides[side].as_slice());
        let foot = polyline::nearest(rings, p)?;
        let ring = &self.rings[foot.ring];
        let other = &ring.sides[side.other()];
        let (a, b) = (other[foot.edge], other[(foot.edge + 1) % other.len()]);
        (ring.kind == RingKind::Matched).then(|| a.lerp(b, foot.along))
    }

    /// Index of the topmost part that contains a point, or else of the nearest part within the
    /// distance `reach`.
    #[must_use]
    pub fn part_at(&self, side: Side, p: DVec2, reach: f64) -> Option<usize> {
        let parts = &self.sides.as_ref()?[side].parts;
        // A part that contains the point is preferred to a nearer boundary: a part may lie in the
        // hole of another.
        uppermost(parts, p).or_else(|| {
            let rings = |k: usize| parts[k].iter().map(Vec::as_slice);
            let distance =
                |k: usize| polyline::nearest(rings(k), p).map_or(f64::MAX, |f| f.distance);
            let nearest = (0..parts.len()).min_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
            (distance(nearest) <= reach).then_some(nearest)
        })
    }
}

/// Index of the last part that contains a point; later parts are painted over earlier ones.
fn uppermost(parts: &[Vec<Vec<DVec2>>], p: DVec2) -> Option<usize> {
    parts
        .iter()
        .rposition(|rings| polyline::encloses(rings.iter().map(Vec::as_slice), p))
}

/// Places one design on the sheet; `None` if the design is not an outline.
fn side(design: &Design, by: &Similarity, paint: PaintRule) -> Option<SheetSide> {
    let DesignForm::Outline(outline) = &design.form else {
        return None;
    };
    // Designs with their own colours are matched by paint layer, where upper layers cover lower
    // ones.
    let painted = (paint == PaintRule::Own).then(|| design.painted_pieces());
    let painted = painted.flatten();
    let regions = painted.as_ref().unwrap_or(outline);
    let ring = |points: &[DVec2]| points.iter().map(|p| by.apply(*p)).collect::<Vec<_>>();
    let parts: Vec<Vec<Vec<DVec2>>> = regions
        .iter()
        .map(|region| {
            let holes = region.holes.iter().map(|hole| ring(hole.points()));
            std::iter::once(ring(region.outer.points()))
                .chain(holes)
                .collect()
        })
        .collect();
    let corners = parts
        .iter()
        .flatten()
        .flat_map(|ring| polyline::corners(ring));
    let corners = corners.collect();
    let bounds = Bounds::of(parts.iter().flatten().flatten().copied())?;
    Some(SheetSide {
        parts,
        corners,
        bounds,
        picture: design
            .picture
            .as_ref()
            .map(|picture| picture.transformed(by)),
    })
}

/// Rings of all pieces, including rings that exist in only one design.
fn rings(pieces: &[PieceMatch]) -> Vec<SheetRing> {
    let rings_of_piece = |(k, piece): (usize, &PieceMatch)| -> Vec<SheetRing> {
        let ring = |ring: &crate::correspondence::RingMatch| {
            SheetRing::new(k, ring.kind, [ring.source.clone(), ring.target.clone()])
        };
        piece.rings.iter().chain(&piece.lone).map(ring).collect()
    };
    pieces.iter().enumerate().flat_map(rings_of_piece).collect()
}

/// Names the pieces and places their labels.
fn label_pieces(
    pieces: &[PieceMatch],
    sides: &[SheetSide; 2],
    matching: &MatchSettings,
) -> Vec<SheetPiece> {
    let part_at = |side: Side, p: DVec2| uppermost(&sides[side].parts, p);
    let links = matching.links.iter();
    let linked: Vec<[Option<usize>; 2]> = links
        .map(|link| Side::BOTH.map(|side| part_at(side, link[side])))
        .collect();
    let unmatched = matching.lone.iter();
    let unmatched: Vec<(Side, Option<usize>)> = unmatched
        .map(|part| (part.side, part_at(part.side, part.at)))
        .collect();
    // Whether the user paired these parts, or marked one of them as unmatched.
    let is_user_set = |parts: &[Option<usize>; 2]| {
        let is_linked = parts.iter().all(Option::is_some) && linked.contains(parts);
        let is_unmatched =
            |(side, part): &(Side, Option<usize>)| part.is_some() && parts[*side] == *part;
        is_linked || unmatched.iter().any(is_unmatched)
    };
    let boxes = Side::BOTH.map(|side| {
        let parts = sides[side].parts.iter();
        parts
            .map(|part| Bounds::of(part.iter().flatten().copied()))
            .collect::<Vec<_>>()
    });
    let piece = |(k, piece): (usize, &PieceMatch)| {
        let parts = [piece.source_part, piece.target_part];
        let fate = match parts {
            [Some(_), None] => PieceFate::Disappears,
            [None, Some(_)] => PieceFate::Appears,
            _ => PieceFate::Paired,
        };
        let at = Side::BOTH.map(|side| {
            let part = parts[side].and_then(|k| Some((k, (*boxes[side].get(k)?)?)));
            let Some((part, bounds)) = part else {
                return label_position(piece, side, &[]);
            };
            // Later parts are painted above this one; only those that meet its box can cover it.
            let all = sides[side].parts.iter().zip(&boxes[side]).skip(part + 1);
            let above = all.filter(|(_, other)| other.is_some_and(|other| other.meets(&bounds)));
            let above: Vec<&[Vec<DVec2>]> = above.map(|(part, _)| part.as_slice()).collect();
            label_position(piece, side, &above)
        });
        SheetPiece {
            name: labels::part_label(k),
            fate,
            label_at: at,
            is_linked: is_user_set(&parts),
            parts,
        }
    };
    pieces.iter().enumerate().map(piece).collect()
}

/// Position of a piece's label, outside the parts that are painted above the piece.
fn label_position(piece: &PieceMatch, side: Side, above: &[&[Vec<DVec2>]]) -> DVec2 {
    let rings = piece.rings.iter().chain(&piece.lone);
    let rings = rings.map(|ring| [&ring.source, &ring.target][side].as_slice());
    let rings: Vec<&[DVec2]> = rings.collect();
    let first = rings.first().and_then(|ring| ring.first());
    // A covered piece is labelled as if nothing lay above it. A ring shrunk to a point has no
    // inside and is labelled at that point.
    polyline::label_point(&rings, above)
        .or_else(|| polyline::label_point(&rings, &[]))
        .or(first.copied())
        .unwrap_or_default()
}

/// The cuts to show: first the cuts that the match uses, each with the user's request that it
/// fulfils, if any; then the requests that the match does not fulfil.
fn cuts(pieces: &[PieceMatch], requests: &[RingCut], diameter: f64) -> Vec<SheetCut> {
    let gap = |a: &RingCut, b: &RingCut| a.outer.distance(b.outer) + a.hole.distance(b.hole);
    let mut open_requests: Vec<usize> = (0..requests.len()).collect();
    let mut cuts: Vec<SheetCut> = Vec::new();
    for cut in pieces.iter().flat_map(|piece| &piece.cuts) {
        let nearest = open_requests
            .iter()
            .copied()
            .filter(|&k| {
                requests[k].side == cut.side && gap(&requests[k], cut) < CUT_SHIFT * diameter
            })
            .min_by(|&a, &b| gap(&requests[a], cut).total_cmp(&gap(&requests[b], cut)));
        // Each request belongs to at most one cut.
        open_requests.retain(|k| Some(*k) != nearest);
        cuts.push(SheetCut {
            cut: *cut,
            requested: nearest.map(|k| requests[k]),
            requested_index: nearest,
        });
    }
    cuts.extend(open_requests.into_iter().map(|k| SheetCut {
        cut: requests[k],
        requested: Some(requests[k]),
        requested_index: Some(k),
    }));
    cuts
}
