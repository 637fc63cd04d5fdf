//! What the match editor shows: both designs and how they go together, in the frame that both lie
//! in.
//!
//! A sheet is made anew whenever the project or its transition changes, and never by drawing it.

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

/// A cut that was asked for is shown by the one that came of it where the two are no farther apart
/// than this share of the design: a cut that the match moved is still the one that was asked for.
const SAME_CUT: f64 = 0.25;

/// Both designs and their match.
#[derive(Resource, Clone, Debug, Default)]
pub struct MatchSheet {
    /// Source and target; none where there is nothing to match.
    pub sides: Option<[SheetSide; 2]>,
    /// The matched rings; none while there is no transition.
    pub rings: Vec<SheetRing>,
    /// The pieces that rings belong to.
    pub pieces: Vec<SheetPiece>,
    /// Pins, as they stand in the project.
    pub pins: Vec<PointPair>,
    /// The pins that the match failed on.
    pub faulty: Vec<usize>,
    /// Some points that were matched without being asked for.
    pub features: Vec<PointPair>,
    /// What each of those is called, 0 for a.
    pub letters: Vec<usize>,
    /// Points of the sheet before that are not on this one, with their letters: on the next
    /// they may be again, as where a first film is followed by the best.
    pub earlier: Vec<(PointPair, usize)>,
    /// Pairs of lines, as they stand in the project.
    pub lines: Vec<LinePair>,
    /// What is seen, and so what pins are for.
    pub content: Option<ContentKind>,
    /// Pairs of parts that were asked for.
    pub links: Vec<PointPair>,
    /// Rings that are cut open.
    pub cuts: Vec<SheetCut>,
    /// What lays each design into the frame.
    pub by: [Similarity; 2],
}

/// One design.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetSide {
    /// Its parts as they are matched, each an outline and its holes; a later one hides what lies
    /// under it.
    pub parts: Vec<Vec<Vec<DVec2>>>,
    /// What pins snap to.
    pub corners: Vec<DVec2>,
    /// The box around it.
    pub bounds: Bounds,
    /// The picture that it came as, where it lies in the frame.
    pub picture: Option<Picture>,
}

/// One piece in both designs.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetPiece {
    /// What it is called: the same on both sides.
    pub name: String,
    /// What becomes of it.
    pub fate: PieceFate,
    /// Where its name stands, in the source and in the target.
    pub at: [DVec2; 2],
    /// It was paired by hand, or said to have no partner.
    pub is_linked: bool,
    /// The parts of the source and of the target that it comes of.
    pub parts: [Option<usize>; 2],
}

/// What becomes of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceFate {
    /// It is in both designs.
    Paired,
    /// It is in the target only, and grows from a point.
    Born,
    /// It is in the source only, and shrinks to a point.
    Dies,
}

/// A cut that opens a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetCut {
    /// The cut, as it was made.
    pub cut: RingCut,
    /// As it was asked for, where it was.
    pub wanted: Option<RingCut>,
    /// Which of the project's cuts it came from; none where it was found.
    pub asked: Option<usize>,
}

impl MatchSheet {
    /// Lays out a pair of designs, given as their files have them and painted as they were
    /// matched. Nothing where one of them has triangles or bars of its own.
    #[must_use]
    pub fn new(
        designs: [&Design; 2],
        by: [Similarity; 2],
        paint: PaintRule,
        matching: &MatchSettings,
        matched: Option<&RegionMatch>,
    ) -> Self {
        let side = |k: usize| side(designs[k], &by[k], paint);
        let [Some(source), Some(target)] = [0, 1].map(side) else {
            return Self::default();
        };
        let placed = matching.placed(&by);
        let pieces: &[PieceMatch] = matched.map_or(&[], |matched| &matched.pieces);
        let rings = rings(pieces);
        let diameter = source.bounds.diameter().max(target.bounds.diameter());
        let sides = [source, target];
        Self {
            // A pin says more than a found point, so points keep away from pins.
            features: sample_points::chosen(&rings, &placed.pins),
            pieces: names(pieces, &sides, &placed),
            cuts: cuts(pieces, &placed.cuts, diameter),
            sides: Some(sides),
            rings,
            pins: placed.pins,
            lines: placed.lines,
            content: None,
            links: placed.links,
            faulty: Vec::new(),
            letters: Vec::new(),
            earlier: Vec::new(),
            by,
        }
    }

    /// Calls each found point by a letter: as on the two sheets before where it was there already.
    pub fn call(&mut self, before: Option<&Self>) {
        let sizes = self.sides.iter().flatten();
        let largest = sizes.map(|side| side.bounds.diameter()).fold(0.0, f64::max);
        let shown: Vec<(PointPair, usize)> = before.map_or_else(Vec::new, |before| {
            let letters = before.letters.iter().copied();
            before.features.iter().copied().zip(letters).collect()
        });
        let earlier = before.map_or(&[][..], |before| &before.earlier);
        let known = [&shown[..], earlier].concat();
        self.letters = labels::stable_letters(&self.features, &known, labels::SAME * largest);
        let gone = shown.into_iter();
        let gone = gone.filter(|(_, letter)| !self.letters.contains(letter));
        self.earlier = gone.collect();
    }

    /// Pins and lines may lie anywhere: they move the plane and not a boundary.
    #[must_use]
    pub fn is_free(&self) -> bool {
        matches!(
            self.content,
            Some(ContentKind::Field | ContentKind::Colours)
        )
    }

    /// Pictures are what is seen.
    #[must_use]
    pub fn in_colours(&self) -> bool {
        self.content == Some(ContentKind::Colours)
    }

    /// The nearest place on the boundary of one side.
    #[must_use]
    pub fn on_boundary(&self, side: Side, p: DVec2) -> Option<polyline::NearestRingPoint> {
        let parts = &self.sides.as_ref()?[side].parts;
        polyline::nearest(parts.iter().flatten().map(Vec::as_slice), p)
    }

    /// The corner nearest to a point, if one is within reach.
    #[must_use]
    pub fn corner(&self, side: Side, p: DVec2, reach: f64) -> Option<DVec2> {
        let corners = &self.sides.as_ref()?[side].corners;
        let near = corners.iter().filter(|corner| corner.distance(p) <= reach);
        near.min_by(|a, b| a.distance(p).total_cmp(&b.distance(p)))
            .copied()
    }

    /// The point of the other side that a point of one side is matched with; none on what has no
    /// partner, and none while there is no match.
    #[must_use]
    pub fn partner(&self, side: Side, p: DVec2) -> Option<DVec2> {
        let rings = self.rings.iter().map(|ring| ring.sides[side].as_slice());
        let foot = polyline::nearest(rings, p)?;
        let ring = &self.rings[foot.ring];
        let other = &ring.sides[side.other()];
        let (a, b) = (other[foot.edge], other[(foot.edge + 1) % other.len()]);
        (ring.kind == RingKind::Matched).then(|| a.lerp(b, foot.along))
    }

    /// The part of one side that a point lies in, the uppermost of several; or else one within
    /// reach.
    #[must_use]
    pub fn part(&self, side: Side, p: DVec2, reach: f64) -> Option<usize> {
        let parts = &self.sides.as_ref()?[side].parts;
        // Inside wins over near: a part may lie in the hole of another.
        uppermost(parts, p).or_else(|| {
            let rings = |k: usize| parts[k].iter().map(Vec::as_slice);
            let far = |k: usize| polyline::nearest(rings(k), p).map_or(f64::MAX, |f| f.distance);
            let nearest = (0..parts.len()).min_by(|a, b| far(*a).total_cmp(&far(*b)))?;
            (far(nearest) <= reach).then_some(nearest)
        })
    }
}

/// The part that a point lies in: of several the last, which is painted over the others.
fn uppermost(parts: &[Vec<Vec<DVec2>>], p: DVec2) -> Option<usize> {
    parts
        .iter()
        .rposition(|rings| polyline::encloses(rings.iter().map(Vec::as_slice), p))
}

fn side(design: &Design, by: &Similarity, paint: PaintRule) -> Option<SheetSide> {
    let DesignForm::Outline(outline) = &design.form else {
        return None;
    };
    // In their own paint parts are matched coat by coat, and hide each other.
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

fn rings(pieces: &[PieceMatch]) -> Vec<SheetRing> {
    let of = |(k, piece): (usize, &PieceMatch)| -> Vec<SheetRing> {
        let ring = |ring: &crate::correspondence::RingMatch| {
            SheetRing::new(k, ring.kind, [ring.source.clone(), ring.target.clone()])
        };
        piece.rings.iter().chain(&piece.lone).map(ring).collect()
    };
    pieces.iter().enumerate().flat_map(of).collect()
}

fn names(pieces: &[PieceMatch], sides: &[SheetSide; 2], said: &MatchSettings) -> Vec<SheetPiece> {
    let part_at = |side: Side, p: DVec2| uppermost(&sides[side].parts, p);
    let links = said.links.iter();
    let linked: Vec<[Option<usize>; 2]> = links
        .map(|link| Side::BOTH.map(|side| part_at(side, link[side])))
        .collect();
    let lone = said.lone.iter();
    let lone: Vec<(Side, Option<usize>)> = lone
        .map(|lone| (lone.side, part_at(lone.side, lone.at)))
        .collect();
    let is_said = |parts: &[Option<usize>; 2]| {
        let is_linked = parts.iter().all(Option::is_some) && linked.contains(parts);
        let is_alone =
            |(side, part): &(Side, Option<usize>)| part.is_some() && parts[*side] == *part;
        is_linked || lone.iter().any(is_alone)
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
            [Some(_), None] => PieceFate::Dies,
            [None, Some(_)] => PieceFate::Born,
            _ => PieceFate::Paired,
        };
        let at = Side::BOTH.map(|side| {
            let own = parts[side].and_then(|k| Some((k, (*boxes[side].get(k)?)?)));
            let Some((own, bounds)) = own else {
                return middle(piece, side, &[]);
            };
            let all = sides[side].parts.iter().zip(&boxes[side]).skip(own + 1);
            let above = all.filter(|(_, other)| other.is_some_and(|other| other.meets(&bounds)));
            let above: Vec<&[Vec<DVec2>]> = above.map(|(part, _)| part.as_slice()).collect();
            middle(piece, side, &above)
        });
        SheetPiece {
            name: labels::of_part(k),
            fate,
            at,
            is_linked: is_said(&parts),
            parts,
        }
    };
    pieces.iter().enumerate().map(piece).collect()
}

/// Where a piece is seen, outside of the parts that lie above.
fn middle(piece: &PieceMatch, side: Side, above: &[&[Vec<DVec2>]]) -> DVec2 {
    let rings = piece.rings.iter().chain(&piece.lone);
    let rings = rings.map(|ring| [&ring.source, &ring.target][side].as_slice());
    let rings: Vec<&[DVec2]> = rings.collect();
    let first = rings.first().and_then(|ring| ring.first());
    // What is covered is named where it would be; a ring that is a point has no inside.
    polyline::label_point(&rings, above)
        .or_else(|| polyline::label_point(&rings, &[]))
        .or(first.copied())
        .unwrap_or_default()
}

/// The cuts that were made, each with the one that asked for it; then what was asked for and not
/// made.
fn cuts(pieces: &[PieceMatch], asked: &[RingCut], diameter: f64) -> Vec<SheetCut> {
    let far = |a: &RingCut, b: &RingCut| a.outer.distance(b.outer) + a.hole.distance(b.hole);
    let mut left: Vec<usize> = (0..asked.len()).collect();
    let mut cuts: Vec<SheetCut> = Vec::new();
    for cut in pieces.iter().flat_map(|piece| &piece.cuts) {
        let near = left
            .iter()
            .copied()
            .filter(|&k| asked[k].side == cut.side && far(&asked[k], cut) < SAME_CUT * diameter)
            .min_by(|&a, &b| far(&asked[a], cut).total_cmp(&far(&asked[b], cut)));
        // One asked for is answered by one cut only.
        left.retain(|k| Some(*k) != near);
        cuts.push(SheetCut {
            cut: *cut,
            wanted: near.map(|k| asked[k]),
            asked: near,
        });
    }
    cuts.extend(left.into_iter().map(|k| SheetCut {
        cut: asked[k],
        wanted: Some(asked[k]),
        asked: Some(k),
    }));
    cuts
}
