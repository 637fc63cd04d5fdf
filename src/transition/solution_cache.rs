//! What was found for two designs, in a form that a document keeps: it opens at
//! once, and plays the same film wherever it is opened.
//!
//! Kept is the match with the mesh of its film, both as they were settled, from
//! which the film is one factorisation away. It is taken only for the outlines
//! and the options that it was found for, and only where all of it is sound;
//! otherwise the match is looked for anew, and nothing is said.

use super::arap_build::{check_size, unsubdivided};
use super::cached_match::{CachedMatch, SharedText};
use super::error::BuildError;
use super::note::TransitionNote;
use super::options::TransitionOptions;
use super::rigid_solution::RigidSolution;
use super::transients::holes;
use crate::compatible::CompatibleMesh;
use crate::correspondence::PieceMatch;
use crate::geometry::DVec2;
use crate::warp::{Arap, Guard, OutlineParameters, TimeWindow};
use crate::work::progress::{Progress, still_wanted};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};
use serde::{Deserialize, Serialize};
use std::io::Read;

/// What is kept unpacks to less: some 50 bytes a face. What is made up of empty
/// pieces takes 16 times as much memory as it has bytes.
const MOST_BYTES: u64 = 16 << 20;

/// Characters of a line of what is kept, as of certificates and letters.
const LINE: usize = 76;

/// A settled film and the key of what it was found for.
#[derive(Clone, Debug)]
pub(super) struct KeyedSolution {
    pub key: String,
    pub film: RigidSolution,
}

impl KeyedSolution {
    /// As text for a document.
    pub fn packed(&self) -> CachedMatch {
        let film = SolutionRecord::of(&self.film).and_then(|record| record.packed());
        CachedMatch {
            of: self.key.clone(),
            film: SharedText(film.unwrap_or_default().into()),
        }
    }
}

/// The film that was found for what has this key, if there is one that is
/// sound.
///
/// # Errors
/// A cancel, or the film is too large.
pub(super) fn restore(
    found: &CachedMatch,
    key: &str,
    options: &TransitionOptions,
    progress: &dyn Progress,
) -> Result<Option<RigidSolution>, BuildError> {
    let record = if found.is_for(key) {
        SolutionRecord::unpacked(&found.film.0)
    } else {
        None
    };
    let film = record.map(|record| record.film(options, progress));
    still_wanted(progress)?;
    Ok(film.transpose()?.flatten())
}

/// A film as it is written. Holes are found again by what is in the match.
#[derive(Serialize, Deserialize)]
struct SolutionRecord {
    pieces: Vec<PieceMatch>,
    faces: Vec<[u32; 3]>,
    places: [Vec<DVec2>; 2],
    lives: Vec<Option<TimeWindow>>,
    stiffness: Vec<f64>,
    holes: Vec<TimeWindow>,
    swelling: Vec<usize>,
    /// Distortion as drawn, and mirrored.
    mirrored: Option<[f64; 2]>,
    guard: Option<Guard>,
}

impl SolutionRecord {
    /// None of a film with more to say than can be written.
    fn of(film: &RigidSolution) -> Option<Self> {
        let mesh = film.arap.mesh();
        let mirrored = match film.notes[..] {
            [] => None,
            [TransitionNote::Mirrored { as_drawn, mirrored }] => Some([as_drawn, mirrored]),
            _ => return None,
        };
        Some(Self {
            pieces: film.matched.pieces.clone(),
            faces: mesh.faces().to_vec(),
            places: [mesh.source().to_vec(), mesh.target().to_vec()],
            lives: film.arap.lives().to_vec(),
            stiffness: film.arap.stiffness().to_vec(),
            holes: film.holes.iter().map(|(_, hole)| hole.life).collect(),
            swelling: film.swelling.clone(),
            mirrored,
            guard: film.arap.guard().cloned(),
        })
    }

    fn packed(&self) -> Option<String> {
        let bytes = rmp_serde::to_vec(self).ok()?;
        let mut packed = Vec::new();
        let mut encoder = ZlibEncoder::new(&bytes[..], Compression::best());
        encoder.read_to_end(&mut packed).ok()?;
        let text = STANDARD.encode(packed);
        let lines = text.as_bytes().chunks(LINE).map(String::from_utf8_lossy);
        Some(lines.collect::<Vec<_>>().join("\n"))
    }

    fn unpacked(text: &str) -> Option<Self> {
        let text: Vec<u8> = text.bytes().filter(|b| !b.is_ascii_whitespace()).collect();
        let packed = STANDARD.decode(text).ok()?;
        let mut bytes = Vec::new();
        let decoder = ZlibDecoder::new(&packed[..]);
        decoder.take(MOST_BYTES).read_to_end(&mut bytes).ok()?;
        rmp_serde::from_slice(&bytes).ok()
    }

    /// The film; none where something about it is not sound.
    fn film(
        self,
        options: &TransitionOptions,
        progress: &dyn Progress,
    ) -> Result<Option<RigidSolution>, BuildError> {
        if !self.is_sound() {
            return Ok(None);
        }
        let [source, target] = self.places;
        let Ok(mesh) = CompatibleMesh::new(self.faces, source, target, Vec::new()) else {
            return Ok(None);
        };
        let parts = mesh.components().into_iter().max().map_or(0, |k| k + 1);
        if parts as usize != self.pieces.len() {
            return Ok(None);
        }
        check_size(&mesh, &options.arap, progress)?;
        let options = unsubdivided(&options.arap);
        let settled = OutlineParameters {
            lives: &self.lives,
            stiffness: &self.stiffness,
        };
        let arap = Arap::settled(&mesh, &options, settled, progress);
        let Ok(arap) = arap else {
            return Ok(None);
        };
        let arap = arap.guarded(self.guard);
        let holes = holes::with_lives(&self.pieces, arap.mesh(), &self.holes);
        Ok(holes.map(|holes| RigidSolution {
            matched: self.pieces.into(),
            arap,
            holes,
            swelling: self.swelling,
            notes: self
                .mirrored
                .map(|[as_drawn, mirrored]| TransitionNote::Mirrored { as_drawn, mirrored })
                .into_iter()
                .collect(),
        }))
    }

    /// Whether all numbers are what they could be; the mesh looks after its own.
    fn is_sound(&self) -> bool {
        let pieces = self.pieces.len();
        let is_piece = |piece: &PieceMatch| {
            let mut rings = piece.rings.iter().chain(&piece.lone);
            let mut cuts = piece.cuts.iter().flat_map(|cut| [cut.outer, cut.hole]);
            !piece.rings.is_empty()
                && rings.all(|ring| ring.is_sound())
                && cuts.all(DVec2::is_finite)
        };
        let is_of = |(life, piece): (&Option<TimeWindow>, &PieceMatch)| {
            life.is_none_or(|life| life.is_sound() && piece.alone() == Some(life.side))
        };
        self.pieces.iter().all(is_piece)
            && self.lives.len() <= pieces
            && self.lives.iter().zip(&self.pieces).all(is_of)
            && self.holes.iter().all(TimeWindow::is_sound)
            && self.swelling.iter().all(|&piece| piece < pieces)
            && self.stiffness.len() <= self.faces.len()
            && self.stiffness.iter().all(|&by| (1.0..1e12).contains(&by))
            && self
                .guard
                .iter()
                .all(|guard| guard.is_sound(self.places[0].len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::PointPair;
    use crate::design::{Design, ImportOptions, import};
    use crate::geometry::Side;
    use crate::transition::cached_match::cache_key;
    use crate::transition::{BuildQuality, CollisionAvoidance, Transition, TransitionSpec};
    use crate::warp::Warp;
    use crate::work::progress::Silent;
    use std::sync::Arc;

    fn svg(path: &str) -> Arc<Design> {
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg'><path d='{path}'/></svg>");
        Arc::new(import("a.svg", text.as_bytes(), &ImportOptions::default()).expect("a drawing"))
    }

    /// Parts that move, a hole of one design alone, a ring that swells, and a
    /// part that is born.
    fn spec() -> TransitionSpec {
        let bars = svg("M32 30h12v40h-12z M56 30h12v40h-12z M34 40v4h4v-4z");
        let badge = svg(
            "M32 30h12v40h-12z M56 32h12v38h-12z M50 2a48 48 0 0 1 0 96a48 48 0 0 1 0-96 M50 12a38 38 0 0 0 0 76a38 38 0 0 0 0-76 M2 2h6v6h-6z",
        );
        let mut spec = TransitionSpec::new(bars, badge);
        // The bar with a hole is not to become the ring.
        let at = |design: &Design| design.form.bounds().centre() - 12.0 * DVec2::X;
        spec.options.matching.links = vec![PointPair {
            source: at(&spec.source),
            target: at(&spec.target),
        }];
        spec
    }

    fn built(spec: &TransitionSpec) -> Transition {
        Transition::build(spec, &Silent).expect("a film")
    }

    fn rings(transition: &Transition) -> Vec<Vec<Vec<DVec2>>> {
        let at = |k: u32| transition.frame(f64::from(k) / 8.0).figure().rings;
        (0..=8).map(at).collect()
    }

    /// What was found, as a document has it.
    fn found(transition: &Transition) -> CachedMatch {
        let found = transition.found().expect("outlines were matched");
        let text = toml::to_string_pretty(&found).expect("text");
        assert!(text.lines().all(|line| line.len() < 100), "{text}");
        toml::from_str(&text).expect("what was written")
    }

    #[test]
    fn what_was_found_plays_the_same_film_without_a_draft() {
        let mut spec = spec();
        for subdivisions in 0..2 {
            spec.options.arap.subdivisions = subdivisions;
            spec.found = CachedMatch::default();
            let first = built(&spec);
            assert!(spec.draft(&Silent).is_some());
            spec.found = found(&first);
            assert!(spec.draft(&Silent).is_none());
            let again = built(&spec);
            assert_eq!(rings(&again), rings(&first));
            assert_eq!(again.notes(), first.notes());
            assert_eq!(
                again.found().map(|f| f.film.0),
                first.found().map(|f| f.film.0)
            );
        }
    }

    /// So many vertices are moved at t = 0.5.
    fn guard(vertices: usize) -> Option<Guard> {
        let mut rows = vec![vec![DVec2::ZERO; vertices]; 3];
        rows[1].fill(DVec2::new(0.125, 0.0));
        Guard::new(vec![0.25, 0.5, 0.75], &rows)
    }

    #[test]
    fn a_guard_is_kept() {
        let mut spec = spec();
        let first = built(&spec);
        let found = found(&first);
        let mut record = SolutionRecord::unpacked(&found.film.0).expect("a record");
        record.guard = guard(record.places[0].len());
        spec.found = CachedMatch {
            film: record.packed().expect("text").into(),
            ..found
        };
        let again = built(&spec);
        let guarded = again.arap().expect("rigid parts");
        assert_eq!(guarded.guard(), record.guard.as_ref());
        assert!(rings(&again) != rings(&first));
    }

    #[test]
    fn it_is_taken_for_what_it_was_found_for_alone() {
        let mut spec = spec();
        let of = |spec: &TransitionSpec| {
            let drawings = spec.drawings(1.0, &Silent).expect("outlines");
            cache_key(&spec.options, &drawings)
        };
        let asked = of(&spec);
        // Not of what is done with the film once it is settled.
        spec.options.arap.subdivisions = 2;
        spec.options.field.cells = 99;
        assert_eq!(asked, of(&spec));
        spec.options.guard = CollisionAvoidance::Plain;
        assert_ne!(asked, of(&spec));
        spec.options.guard = CollisionAvoidance::Guarded;
        spec.options.arap.symmetric = !spec.options.arap.symmetric;
        assert_ne!(asked, of(&spec));
        spec.options.arap.symmetric = !spec.options.arap.symmetric;
        spec.options.triangulation.edge_length = Some(0.5);
        assert_ne!(asked, of(&spec));
        let [source, target] = [Arc::clone(&spec.source), Arc::clone(&spec.target)];
        assert_ne!(asked, of(&TransitionSpec::new(target, source)));
    }

    #[test]
    fn what_is_not_sound_is_looked_for_anew() {
        let mut spec = spec();
        // Many films: the quick ones will do.
        spec.options.quality = BuildQuality::Draft;
        let first = built(&spec);
        let wanted = rings(&first);
        let found = found(&first);
        let record = || SolutionRecord::unpacked(&found.film.0).expect("a record");
        let mut changed: Vec<SolutionRecord> = Vec::new();
        let mut change = |by: &dyn Fn(&mut SolutionRecord)| {
            let mut record = record();
            by(&mut record);
            changed.push(record);
        };
        change(&|record| record.faces[0] = [0, 1, 1 << 30]);
        change(&|record| record.places[1][3].x = f64::NAN);
        change(&|record| record.places[0].clear());
        change(&|record| record.pieces.clear());
        change(&|record| record.pieces[0].rings.clear());
        change(&|record| record.pieces[0].rings[0].target.truncate(2));
        change(&|record| record.holes.push(TimeWindow::whole(Side::Source)));
        change(&|record| record.holes[0].side = record.holes[0].side.other());
        let birth = record().lives.iter().position(Option::is_some);
        let birth = birth.expect("a birth");
        let change_life = |record: &mut SolutionRecord, by: &dyn Fn(&mut TimeWindow)| {
            record.lives[birth].as_mut().map(by);
        };
        change(&|record| change_life(record, &|life| life.to = life.from));
        change(&|record| change_life(record, &|life| life.side = life.side.other()));
        change(&|record| record.swelling = vec![99]);
        change(&|record| record.stiffness = vec![-1.0]);
        change(&|record| record.guard = guard(1 << 20));
        let texts = changed.iter().map(|record| record.packed().expect("text"));
        let cut = |k: usize| found.film.0[..found.film.0.len() * k / 8].to_owned();
        for text in texts.chain((1..8).map(cut)).chain(["-".to_owned()]) {
            spec.found = CachedMatch {
                of: found.of.clone(),
                film: text.into(),
            };
            assert_eq!(rings(&built(&spec)), wanted);
        }
        // What is sound is taken, so that the films above were no others.
        let mut record = record();
        change_life(&mut record, &|life| [life.from, life.to] = [0.3, 0.4]);
        spec.found = CachedMatch {
            of: found.of.clone(),
            film: record.packed().expect("text").into(),
        };
        assert_ne!(rings(&built(&spec)), wanted);
    }

    #[test]
    fn whatever_the_bytes_are_there_is_a_film_or_none() {
        let mut spec = spec();
        spec.options.quality = BuildQuality::Draft;
        let record = SolutionRecord::unpacked(&found(&built(&spec)).film.0).expect("a record");
        let bytes = rmp_serde::to_vec(&record).expect("bytes");
        let mut state = 1_u64;
        let mut random = |below: usize| {
            // Knuth's MMIX: its high bits are random enough.
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            (state >> 33) as usize % below
        };
        let mut films = 0;
        for _ in 0..400 {
            let mut bytes = bytes.clone();
            for _ in 0..=random(3) {
                let at = random(bytes.len());
                bytes[at] = random(256) as u8;
            }
            let Ok(record) = rmp_serde::from_slice::<SolutionRecord>(&bytes) else {
                continue;
            };
            if let Ok(Some(film)) = record.film(&spec.options, &Silent) {
                films += 1;
                let mut placer = film.arap.placer();
                placer.place(0.5);
                let places = &placer.placement().in_frame;
                assert!(places.iter().all(|p| p.is_finite()));
            }
        }
        assert!(films > 0, "no number was changed without harm");
    }
}
