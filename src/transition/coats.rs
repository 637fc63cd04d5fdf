//! Designs as coats of paint: the parts that are matched, how they look, and the
//! coats of the film.

use super::error::BuildError;
use super::holes::HoleOf;
use super::options::PaintRule;
use super::spec::{TransitionSpec, outline};
use crate::colour::{Line, Paint};
use crate::content::{Coat, Coating};
use crate::correspondence::{Look, Looks, PieceMatch, RegionMatch};
use crate::design::{Coat as Painted, Design};
use crate::geometry::{Regions, RegionsError, Side};
use crate::progress::Progress;
use crate::warp::Arap;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The t at which parts change places that lie over each other otherwise at the
/// ends.
const REORDERED_AT: f64 = 0.5;

/// Two designs as they are matched.
pub(super) struct Drawings {
    /// All parts, of all coats.
    pub outlines: [Regions; 2],
    /// Empty where neither design is shown in its own paint.
    pub looks: Looks,
    /// The inks of each coat, the lowest first; none of such designs.
    inks: [Vec<Ink>; 2],
}

/// Paint and line of a coat.
#[derive(Clone, Copy, Default)]
struct Ink {
    paint: Option<Paint>,
    line: Option<Line>,
}

impl Drawings {
    /// Of the outlines of designs that are shown in one colour.
    fn plain(outlines: [Regions; 2]) -> Self {
        Self {
            outlines,
            looks: Looks::default(),
            inks: Default::default(),
        }
    }
}

impl TransitionSpec {
    /// Both designs as they are matched for rigid parts; bars are so wide, in
    /// units of the designs.
    pub(super) fn drawings(
        &self,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<Drawings, BuildError> {
        let designs = [&self.source, &self.target];
        let is_painted = designs.iter().any(|design| !design.coats.is_empty());
        if self.options.paint == PaintRule::One || !is_painted {
            return Ok(Drawings::plain(self.outlines(bar_width, progress)?));
        }
        let [source, target] = designs.map(|design| coats_of(design, bar_width, progress));
        let [source, target] = [source?, target?];
        let outlines = [stacked(&source)?, stacked(&target)?];
        self.allow(&outlines, progress)?;
        let looks = [&source, &target].map(|coats| looks_of(coats));
        let ink = |coat: &Painted| Ink {
            paint: coat.paint,
            line: coat.line,
        };
        let inks = [source, target].map(|coats| coats.iter().map(ink).collect());
        Ok(Drawings {
            outlines,
            looks: Looks(looks),
            inks,
        })
    }
}

/// The coats of a design; one without paint where it has none.
fn coats_of(
    design: &Arc<Design>,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Vec<Painted>, BuildError> {
    let coats = if design.coats.is_empty() {
        vec![Painted {
            regions: outline(design, bar_width, progress)?,
            paint: None,
            line: None,
            name: String::new(),
        }]
    } else {
        design.coats.clone()
    };
    let apart = coats.into_iter().map(|coat| Painted {
        regions: coat.regions.pulled_apart(),
        ..coat
    });
    Ok(apart.collect())
}

fn stacked(coats: &[Painted]) -> Result<Regions, BuildError> {
    let layers = coats.iter().map(|coat| coat.regions.clone());
    Regions::stacked(layers).ok_or_else(|| RegionsError::Empty.into())
}

fn looks_of(coats: &[Painted]) -> Vec<Look> {
    let top = coats.len().saturating_sub(1).max(1) as f64;
    let coats = coats.iter().enumerate();
    let looks = coats.flat_map(|(k, coat)| {
        let look = Look {
            coat: k,
            height: k as f64 / top,
            paint: coat.paint,
            is_lined: coat.line.is_some(),
            name: given_name(&coat.name),
        };
        std::iter::repeat_n(look, coat.regions.len())
    });
    looks.collect()
}

/// What drawing programs call things by themselves.
const KINDS: [&str; 12] = [
    "path", "rect", "circle", "ellipse", "line", "polyline", "polygon", "shape", "vector", "layer",
    "group", "g",
];

/// A name that somebody gave; nothing of one that a program counted, which says
/// as little of another drawing's.
fn given_name(name: &str) -> String {
    let is_counted = name.contains(|c: char| c.is_ascii_digit());
    let is_kind = KINDS.contains(&name.to_ascii_lowercase().as_str());
    let given = if is_counted || is_kind { "" } else { name };
    given.to_owned()
}

/// For each piece of a match its level: what is on one goes from one coat to one
/// coat, and is in each other's way; what is not passes over or under.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Levels {
    of_pieces: Vec<usize>,
    /// The coats in source and target.
    coats: Vec<[Option<usize>; 2]>,
}

impl Levels {
    pub(super) fn of(matched: &RegionMatch, looks: &Looks) -> Self {
        let coats = |piece: &PieceMatch| -> [Option<usize>; 2] {
            let parts = [piece.source_part, piece.target_part];
            Side::BOTH.map(|side| parts[side].map(|part| looks.coat(side, part)))
        };
        let mut of_pieces: Vec<[Option<usize>; 2]> = matched.pieces.iter().map(coats).collect();
        // What is born or dies goes with most of its coat.
        let both: Vec<[Option<usize>; 2]> = of_pieces.clone();
        for own in &mut of_pieces {
            for side in Side::BOTH {
                if own[side].is_none() {
                    own[side] = partner(&both, side.other(), own[side.other()]);
                }
            }
        }
        let mut levels = BTreeMap::new();
        for own in &of_pieces {
            let next = levels.len();
            levels.entry(*own).or_insert(next);
        }
        let mut coats = vec![[None; 2]; levels.len()];
        levels.iter().for_each(|(own, &level)| coats[level] = *own);
        Self {
            of_pieces: of_pieces.iter().map(|own| levels[own]).collect(),
            coats,
        }
    }

    /// The level of a piece.
    pub(super) fn of_piece(&self, piece: usize) -> usize {
        self.of_pieces.get(piece).copied().unwrap_or(0)
    }
}

/// The coat that most pieces of a coat of one design go to in the other.
fn partner(pieces: &[[Option<usize>; 2]], side: Side, coat: Option<usize>) -> Option<usize> {
    let mut counts = BTreeMap::new();
    for piece in pieces.iter().filter(|piece| piece[side] == coat) {
        if let Some(other) = piece[side.other()] {
            *counts.entry(other).or_insert(0) += 1;
        }
    }
    let most = counts
        .iter()
        .max_by_key(|(other, count)| (**count, usize::MAX - **other));
    most.map(|(other, _)| *other)
}

/// How a film is painted: a coat for each level. None of designs in one colour.
pub(super) fn coating(
    drawings: &Drawings,
    matched: &RegionMatch,
    film: &Arap,
    holes: &[HoleOf],
) -> Option<Coating> {
    if drawings.looks == Looks::default() {
        return None;
    }
    let levels = Levels::of(matched, &drawings.looks);
    let ink = |side: Side, coat: Option<usize>| coat.map(|coat| drawings.inks[side][coat]);
    let heights = Side::BOTH.map(|side| heights(&levels.coats, side));
    let coat = |level: usize| {
        let own = levels.coats[level];
        let inks = Side::BOTH.map(|side| ink(side, own[side]));
        // What one design has alone keeps its paint, while its line grows with it.
        let paints = [inks[0].or(inks[1]), inks[1].or(inks[0])];
        Coat {
            paints: paints.map(|ink| ink.and_then(|ink| ink.paint)),
            lines: inks.map(|ink| ink.and_then(|ink| ink.line)),
            heights: [heights[0][level], heights[1][level]],
        }
    };
    let parts = film.mesh().components();
    let walks = film.mesh().boundary_loops();
    let piece = |walk: &Vec<u32>| walk.first().map_or(0, |&v| parts[v as usize] as usize);
    Some(Coating {
        coats: (0..levels.coats.len()).map(coat).collect(),
        of_walks: walks
            .iter()
            .map(|walk| levels.of_piece(piece(walk)))
            .collect(),
        of_holes: holes
            .iter()
            .map(|(piece, _)| levels.of_piece(*piece))
            .collect(),
        reordered_at: REORDERED_AT,
    })
}

/// How many levels lie below each, in one design; one that it does not have lies
/// right above the one that is next below it in the other design.
fn heights(levels: &[[Option<usize>; 2]], side: Side) -> Vec<usize> {
    let other = side.other();
    let mut order: Vec<usize> = (0..levels.len())
        .filter(|&k| levels[k][side].is_some())
        .collect();
    order.sort_by_key(|&k| (levels[k][side], levels[k][other]));
    let mut alone: Vec<usize> = (0..levels.len())
        .filter(|&k| levels[k][side].is_none())
        .collect();
    alone.sort_by_key(|&k| levels[k][other]);
    for k in alone {
        let is_below = |&other_level: &usize| levels[other_level][other] < levels[k][other];
        let at = order.iter().rposition(is_below).map_or(0, |at| at + 1);
        order.insert(at, k);
    }
    let mut heights = vec![0; levels.len()];
    order
        .iter()
        .enumerate()
        .for_each(|(height, &k)| heights[k] = height);
    heights
}
