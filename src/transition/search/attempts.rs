//! Choosing among matches: for each piece the one whose film has the least
//! trouble.
//!
//! No measure of two boundaries alone tells what becomes of the inside, so a
//! match is judged by its film. Each piece moves by itself, so that each is
//! chosen for itself. Candidates come in rounds: first the match at the prices
//! that were asked for, without the holes that have no partner; with these cut
//! open or closed. Then other prices, where the shapes are unlike, and where the best
//! film still folds or distorts much the last ones. Where it folded as it was asked for,
//! all of that without any hole. The best of all so far is the one with the fewest
//! folded faces over all its steps, then the fewest crossings of its outlines, then the
//! least distortion, outlines that grow jagged on the way and parts that swell included,
//! then the earliest.
//!
//! What was chosen then slides, as long as that makes it better; with holes and without,
//! if both were tried, before one is chosen. A draft is the match that was asked for
//! alone.

use super::candidate::MatchCandidate;
use super::group::{GroupSearch, MatchVariant, PieceResult, piece, take_better};
use crate::compatible::slide_outlines;
use crate::correspondence::{HolePolicy, HoleRule, MatchOptions, MatchSettings};
use crate::transition::error::BuildError;
use crate::transition::spec::TransitionSpec;
use crate::work::progress::{Progress, ProgressShares, ProgressSpan, still_wanted};
use rayon::prelude::*;

/// A match of at most this cost whose film does not fold is taken at once.
/// Two poses of a thing cost up to about 0.3, unlike things 0.4 and more.
const ALIKE: f64 = 0.34;

/// Prices of stretch that are tried for unlike shapes, after the default.
const OTHER_PRICES: [f64; 2] = [0.6, 1.2];

/// The price of inner distances of a match that is tried for unlike shapes as
/// well. It sees limbs and strokes, and with this price little else.
const INNER: f64 = 8.0;

/// What is tried where all of those fold: prices without regard to
/// thickness, which of a thick body and thin arms makes one arm the body.
const LAST_PRICES: [f64; 4] = [0.12, 0.25, 0.5, 1.0];

/// What distorts more is tried at the last prices as well, folds or not. By it
/// the worst tenth of pictures traced went from 18 to 13, and of outlines
/// turned 0.23 too much instead of 0.31.
const DISTORTED: f64 = 3.0;

/// A round of films of the pieces of a group may cost so much: the number of
/// films times the square of a piece's boundary vertices. A film of 700 vertices
/// takes some 0.3 s, those of drawings that fold whatever is tried up to 2 s.
/// Without a bound a pair of icons took 24 s, and folded.
const MOST_WORK: usize = 2_500_000;

/// The same for the first film, which is waited for.
const DRAFT_WORK: usize = 100_000;

/// Holes without a partner cut open or closed, whichever matches better.
const CUT: HolePolicy = HolePolicy::By(HoleRule::Auto);

/// How much is done once the match that was asked for has its film, that with
/// its holes cut, those at other prices, that without holes, and these at other
/// prices, as it is told.
const FIRST: f64 = 0.2;
const SECOND: f64 = 0.3;
const THIRD: f64 = 0.5;
const FOURTH: f64 = 0.6;
const FIFTH: f64 = 0.7;

/// How often a piece slides.
const SLIDES: u32 = 3;

/// Maps that distort less are left as they are: two drawings of one thing.
const FAITHFUL: f64 = 1.02;

/// The best of each piece of a group of parts; `drafts` are the same pieces as
/// they were asked for, if that is known.
pub(in crate::transition) fn best_of_group(
    group: &GroupSearch,
    drafts: Option<&Vec<PieceResult>>,
    progress: &dyn Progress,
) -> Result<Vec<PieceResult>, BuildError> {
    let span = |from, to| ProgressSpan::new(progress, from, to);
    let mut chosen = match drafts {
        Some(drafts) => drafts.clone(),
        None => group.as_asked(&span(0.0, FIRST))?,
    };
    let mut unpaired = Vec::new();
    if !group.prepared.is_crowd() {
        if !group.prepared.is_lined(group.group) {
            let lone: Vec<bool> = chosen.iter().map(has_lone_holes).collect();
            group.try_holes(&mut chosen, CUT, &lone, &span(FIRST, SECOND))?;
        }
        let folds: Vec<bool> = chosen.iter().map(has_folding_holes).collect();
        let mut others = chosen.clone();
        group.try_others(&mut chosen, &|_| true, &span(SECOND, THIRD))?;
        group.try_holes(
            &mut others,
            HolePolicy::Unpaired,
            &folds,
            &span(THIRD, FOURTH),
        )?;
        group.try_others(&mut others, &is_unpaired, &span(FOURTH, FIFTH))?;
        let others = others.into_iter().map(Some);
        unpaired = others.map(|other| other.filter(is_unpaired)).collect();
    }
    let last = span(FIFTH, 1.0);
    let shares = ProgressShares::new(&last, chosen.len());
    let settled =
        |chosen: PieceResult, progress: &dyn Progress| -> Result<PieceResult, BuildError> {
            Ok(match chosen {
                Ok(best) => Ok(settled_by_sliding(best, group.spec, progress)?),
                none => none,
            })
        };
    unpaired.resize_with(chosen.len(), || None);
    let pairs = chosen.into_par_iter().zip(unpaired).enumerate();
    let best = pairs.map(|(k, (chosen, unpaired))| {
        let share = shares.part(k);
        let Some(unpaired) = unpaired else {
            return Ok(vec![settled(chosen, &share)?]);
        };
        let [first, second] =
            [(0.0, 0.5), (0.5, 1.0)].map(|(a, b)| ProgressSpan::new(&share, a, b));
        let mut best = vec![settled(chosen, &first)?];
        // Only now: the holes of D and P slide to where they can be paired, those of a
        // frame of letters do not.
        take_better(&mut best, vec![settled(unpaired, &second)?.ok()]);
        Ok(best)
    });
    let best: Vec<Vec<PieceResult>> = best.collect::<Result<_, BuildError>>()?;
    Ok(best.concat())
}

/// Each piece as it was asked for, or as it was drawn where it would turn far: the
/// first film is seen, too.
pub(in crate::transition) fn drafts_of_group(
    group: &GroupSearch,
    progress: &dyn Progress,
) -> Result<Vec<PieceResult>, BuildError> {
    let [asking, turning] =
        [(0.0, 0.7), (0.7, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
    let mut chosen = group.as_asked(&asking)?;
    if !group.prepared.is_crowd() {
        group.try_upright(&mut chosen, (&|_| true, DRAFT_WORK), &turning)?;
    }
    Ok(chosen)
}

impl GroupSearch<'_> {
    /// Tries the pieces that want it at the prices that were asked for, with
    /// their holes treated so.
    fn try_holes(
        &self,
        chosen: &mut [PieceResult],
        holes: HolePolicy,
        wants: &[bool],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let asked = &self.spec.options.matching;
        if asked.holes != HoleRule::Auto {
            return Ok(());
        }
        let options = asked.options();
        self.try_ways(chosen, &[MatchVariant { options, holes }], wants, progress)
    }

    /// Tries what else there is besides holes, of those pieces.
    fn try_others(
        &self,
        chosen: &mut [PieceResult],
        of: &dyn Fn(&PieceResult) -> bool,
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let [turning, pricing] =
            [(0.0, 0.2), (0.2, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
        self.try_upright(chosen, (of, MOST_WORK), &turning)?;
        self.try_other_prices(chosen, of, &pricing)
    }

    /// Tries other prices where the shapes are unlike, and then those for want
    /// of better.
    fn try_other_prices(
        &self,
        chosen: &mut [PieceResult],
        of: &dyn Fn(&PieceResult) -> bool,
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let spans = [(0.0, 0.5), (0.5, 1.0)].map(|(a, b)| ProgressSpan::new(progress, a, b));
        let rounds = rounds(&self.spec.options.matching);
        for (k, (round, span)) in rounds.iter().zip(&spans).enumerate() {
            let wants = |chosen: &PieceResult| match chosen {
                Err(_) => true,
                Ok(best) if k == 0 => best.matched.is_in_both() && best.matched.cost > ALIKE,
                // The last prices match worse, and are for want of better. Tried
                // against crossings too they take twice as long and help one pair
                // of icons of 58.
                Ok(best) => best.folds() || best.distortion > DISTORTED,
            };
            let wants = |chosen: &PieceResult| of(chosen) && wants(chosen);
            let wants = affordable(chosen, &wants, round.len(), MOST_WORK);
            self.try_with_their_holes(chosen, round, &wants, span)?;
        }
        Ok(())
    }

    /// Tries the pieces that turn far as they were drawn.
    fn try_upright(
        &self,
        chosen: &mut [PieceResult],
        (of, most_work): (&dyn Fn(&PieceResult) -> bool, usize),
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let asked = &self.spec.options.matching;
        if asked.stretch.is_some() || asked.keep_up {
            return Ok(());
        }
        let upright = MatchOptions {
            keep_up: true,
            ..asked.options()
        };
        let wants = |chosen: &PieceResult| of(chosen) && turns_far(chosen);
        let wants = affordable(chosen, &wants, 1, most_work);
        self.try_with_their_holes(chosen, &[upright], &wants, progress)
    }

    /// Tries the pieces that want it in these ways, each with its holes as they
    /// were best so far.
    fn try_with_their_holes(
        &self,
        chosen: &mut [PieceResult],
        options: &[MatchOptions],
        wants: &[bool],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let holes = |chosen: &PieceResult| match chosen {
            Ok(best) => best.holes,
            Err(_) => self.first_holes(),
        };
        let holes: Vec<HolePolicy> = chosen.iter().map(holes).collect();
        for now in [self.first_holes(), CUT, HolePolicy::Unpaired] {
            let way = |options: &MatchOptions| MatchVariant {
                options: options.clone(),
                holes: now,
            };
            let ways: Vec<MatchVariant> = options.iter().map(way).collect();
            let wants = holes.iter().zip(wants);
            let wants: Vec<bool> = wants
                .map(|(holes, wants)| *wants && *holes == now)
                .collect();
            self.try_ways(chosen, &ways, &wants, progress)?;
        }
        Ok(())
    }
}

/// Which of the pieces that want so many more films get them: the smallest, for
/// as much work as a round may cost.
fn affordable(
    chosen: &[PieceResult],
    wants: &dyn Fn(&PieceResult) -> bool,
    films: usize,
    most_work: usize,
) -> Vec<bool> {
    let work = |k: usize| {
        let rings = piece(&chosen[k]).rings.iter();
        let vertices: usize = rings.map(|ring| ring.source.len()).sum();
        films * vertices * vertices
    };
    let mut wanting: Vec<usize> = (0..chosen.len()).filter(|&k| wants(&chosen[k])).collect();
    wanting.sort_by_key(|&k| work(k));
    let (mut done, mut get) = (0, vec![false; chosen.len()]);
    for k in wanting {
        done += work(k);
        get[k] = done <= most_work;
    }
    get
}

/// The piece turns far on its way, and is no copy that was turned.
fn turns_far(chosen: &PieceResult) -> bool {
    let is_far = |best: &MatchCandidate| !best.is_upright() && best.distortion > FAITHFUL;
    chosen.as_ref().is_ok_and(is_far)
}

/// A hole of the piece has no partner.
fn has_lone_holes(chosen: &PieceResult) -> bool {
    let piece = piece(chosen);
    piece.is_in_both() && !piece.lone.is_empty()
}

/// Holes of the piece have partners, and it folds with them.
fn has_folding_holes(chosen: &PieceResult) -> bool {
    let piece = piece(chosen);
    let folds = chosen.as_ref().map_or(true, MatchCandidate::folds);
    piece.is_in_both() && piece.rings.len() > 1 && folds
}

/// None of the holes of the piece has a partner, for want of better.
fn is_unpaired(chosen: &PieceResult) -> bool {
    chosen
        .as_ref()
        .is_ok_and(|best| best.holes == HolePolicy::Unpaired)
}

/// What was chosen, its correspondence and its map improved together as long
/// as its film is the better for it.
fn settled_by_sliding(
    mut best: MatchCandidate,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<MatchCandidate, BuildError> {
    for round in 0..SLIDES {
        if !best.matched.is_in_both() || best.distortion < FAITHFUL {
            break;
        }
        let share = |k: u32| f64::from(k) / f64::from(SLIDES);
        let progress = &ProgressSpan::new(progress, share(round), share(round + 1));
        let options = &spec.options.triangulation;
        let places = slide_outlines(&best.matched, &best.mesh, options, progress);
        still_wanted(progress)?;
        let Some(places) = places else { break };
        let moved = best.matched.moved(&places);
        let moved = MatchCandidate::new(moved, best.holes, &spec.options, progress).ok();
        still_wanted(progress)?;
        match moved {
            Some(moved) if moved.is_better_than(&best) => best = moved,
            _ => break,
        }
    }
    Ok(best)
}

/// What is tried after the match that was asked for, round by round; nothing
/// where somebody settled the price.
fn rounds(asked: &MatchSettings) -> Vec<Vec<MatchOptions>> {
    if asked.stretch.is_some() {
        return Vec::new();
    }
    let asked = asked.options();
    let priced = |stretch: f64, thickness: f64| MatchOptions {
        stretch,
        thickness,
        ..asked.clone()
    };
    let inside = MatchOptions {
        inner: INNER,
        ..asked.clone()
    };
    let mut others = OTHER_PRICES
        .map(|price| priced(price, asked.thickness))
        .to_vec();
    others.push(inside);
    vec![others, LAST_PRICES.map(|price| priced(price, 0.0)).to_vec()]
}
