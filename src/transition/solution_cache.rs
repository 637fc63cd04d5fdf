//! Packs the solved motion of two designs as text for a project file, and restores it. A project
//! file with this text opens at once and plays the same motion on every machine.
//!
//! The text contains the match and the mesh of the solved motion; restoring the motion takes one
//! factorisation. A stored motion is used only for the outlines and options for which it was
//! computed, and only if all of it is valid and belongs to these outlines. Otherwise the motion is
//! computed again.

mod fit;

use super::cached_match::{CachedMatch, SharedText};
use crate::compatible::CompatibleMesh;
use crate::correspondence::PieceMatch;
use crate::geometry::{DVec2, Regions};
use crate::transition::arap_build::{check_size, without_subdivision};
use crate::transition::error::BuildError;
use crate::transition::note::TransitionNote;
use crate::transition::options::TransitionOptions;
use crate::transition::rigid_solution::RigidSolution;
use crate::transition::transients::holes;
use crate::warp::{Arap, Guard, OutlineParameters, TimeWindow};
use crate::work::progress::{Progress, check_cancelled};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::{ZlibDecoder, ZlibEncoder};
use serde::{Deserialize, Serialize};
use std::io::Read;

/// Maximum size of the decompressed data in bytes (resource limit: a mesh takes about 50 bytes per
/// face; a malicious list of empty pieces takes 16 times its size in memory).
const MAX_BYTES: u64 = 16 << 20;

/// Number of characters in a line of the encoded text, as is usual for base64 in e-mail.
const LINE_LENGTH: usize = 76;

/// A solved motion, with the key of the outlines and options from which it was computed.
#[derive(Clone, Debug)]
pub(in crate::transition) struct KeyedSolution {
    pub key: String,
    pub solution: RigidSolution,
}

impl KeyedSolution {
    /// Packs the motion as text for a project file.
    pub fn cached_match(&self) -> CachedMatch {
        let packed = SolutionRecord::of(&self.solution).and_then(|record| record.encode());
        CachedMatch {
            of: self.key.clone(),
            film: SharedText(packed.unwrap_or_default().into()),
        }
    }
}

/// Restores the cached motion of two outlines. Returns `None` if it is invalid or does not belong
/// to them.
///
/// # Errors
/// If the mesh is too large or the work is cancelled.
pub(in crate::transition) fn restore(
    found: &CachedMatch,
    outlines: &[Regions; 2],
    options: &TransitionOptions,
    progress: &dyn Progress,
) -> Result<Option<RigidSolution>, BuildError> {
    let record = SolutionRecord::decode(&found.film.0);
    let solution = record.map(|record| record.rebuild(outlines, options, progress));
    check_cancelled(progress)?;
    Ok(solution.transpose()?.flatten())
}

/// The stored form of a solved motion. For unmatched holes only the time windows are stored; their
/// shape follows from the match.
#[derive(Serialize, Deserialize)]
struct SolutionRecord {
    pieces: Vec<PieceMatch>,
    faces: Vec<[u32; 3]>,
    places: [Vec<DVec2>; 2],
    lives: Vec<Option<TimeWindow>>,
    stiffness: Vec<f64>,
    holes: Vec<TimeWindow>,
    swelling: Vec<usize>,
    /// Distortions of the match as drawn and with one design mirrored, if mirroring was suggested.
    mirrored: Option<[f64; 2]>,
    guard: Option<Guard>,
    /// Number of parts whose positions were not searched. Older records lack it.
    #[serde(default)]
    unsearched: usize,
}

impl SolutionRecord {
    /// Converts a motion to a record; `None` if the motion has notes that cannot be stored.
    fn of(solution: &RigidSolution) -> Option<Self> {
        let mesh = solution.arap.mesh();
        let (mut mirrored, mut unsearched) = (None, 0);
        for note in &solution.notes {
            match *note {
                TransitionNote::CachedMatchIgnored => {}
                TransitionNote::Mirrored {
                    as_drawn,
                    mirrored: distortion,
                } => mirrored = Some([as_drawn, distortion]),
                TransitionNote::PartsUnsearched { parts } => unsearched = parts,
                _ => return None,
            }
        }
        Some(Self {
            pieces: solution.matched.pieces.clone(),
            faces: mesh.faces().to_vec(),
            places: [mesh.source().to_vec(), mesh.target().to_vec()],
            lives: solution.arap.time_windows().to_vec(),
            stiffness: solution.arap.stiffness().to_vec(),
            holes: solution.holes.iter().map(|(_, hole)| hole.window).collect(),
            swelling: solution.swelling.clone(),
            mirrored,
            guard: solution.arap.guard().cloned(),
            unsearched,
        })
    }

    /// Returns the notes of the motion.
    fn notes(&self) -> Vec<TransitionNote> {
        let mirrored = self
            .mirrored
            .map(|[as_drawn, mirrored]| TransitionNote::Mirrored { as_drawn, mirrored });
        let unsearched = (self.unsearched > 0).then_some(TransitionNote::PartsUnsearched {
            parts: self.unsearched,
        });
        mirrored.into_iter().chain(unsearched).collect()
    }

    /// Serialises, compresses and encodes the record.
    fn encode(&self) -> Option<String> {
        let bytes = rmp_serde::to_vec(self).ok()?;
        let mut packed = Vec::new();
        let mut encoder = ZlibEncoder::new(&bytes[..], Compression::best());
        encoder.read_to_end(&mut packed).ok()?;
        let text = STANDARD.encode(packed);
        let lines = text
            .as_bytes()
            .chunks(LINE_LENGTH)
            .map(String::from_utf8_lossy);
        Some(lines.collect::<Vec<_>>().join("\n"))
    }

    /// Decodes, decompresses and deserialises a record; `None` if it is invalid.
    fn decode(text: &str) -> Option<Self> {
        let text: Vec<u8> = text.bytes().filter(|b| !b.is_ascii_whitespace()).collect();
        let packed = STANDARD.decode(text).ok()?;
        let mut bytes = Vec::new();
        let decoder = ZlibDecoder::new(&packed[..]);
        decoder.take(MAX_BYTES).read_to_end(&mut bytes).ok()?;
        rmp_serde::from_slice(&bytes).ok()
    }

    /// Rebuilds the motion; `None` if the record is invalid.
    ///
    /// # Errors
    /// If the mesh is too large.
    fn rebuild(
        self,
        outlines: &[Regions; 2],
        options: &TransitionOptions,
        progress: &dyn Progress,
    ) -> Result<Option<RigidSolution>, BuildError> {
        if !self.is_sound(fit::max_length(outlines)) {
            return Ok(None);
        }
        let notes = self.notes();
        let [source, target] = self.places;
        let Ok(mesh) = CompatibleMesh::new(self.faces, source, target, Vec::new()) else {
            return Ok(None);
        };
        let parts = mesh.components().into_iter().max().map_or(0, |k| k + 1);
        let is_complete = parts as usize == self.pieces.len();
        if !is_complete || !fit::is_of_outlines(&self.pieces, &mesh, outlines) {
            return Ok(None);
        }
        check_size(&mesh, &options.arap, progress)?;
        let options = without_subdivision(&options.arap);
        let parameters = OutlineParameters {
            time_windows: &self.lives,
            stiffness: &self.stiffness,
        };
        let arap = Arap::with_outline_parameters(&mesh, &options, parameters, progress);
        let Ok(arap) = arap else {
            return Ok(None);
        };
        let arap = arap.with_guard(self.guard);
        let holes = holes::with_lives(&self.pieces, arap.mesh(), &self.holes);
        Ok(holes.map(|holes| RigidSolution {
            matched: self.pieces.into(),
            arap,
            holes,
            swelling: self.swelling,
            notes,
        }))
    }

    /// Returns whether all numbers and indices are in range, and no list is longer than the number
    /// of pieces, faces or vertices that it describes. Faces and positions are checked later, when
    /// the mesh is built. `max_length` is the longest displacement of a guard.
    fn is_sound(&self, max_length: f64) -> bool {
        let pieces = self.pieces.len();
        let is_piece = |piece: &PieceMatch| {
            let mut rings = piece.rings.iter().chain(&piece.lone);
            let mut cuts = piece.cuts.iter().flat_map(|cut| [cut.outer, cut.hole]);
            !piece.rings.is_empty()
                && rings.all(|ring| ring.is_sound())
                && cuts.all(DVec2::is_finite)
        };
        let is_of = |(life, piece): (&Option<TimeWindow>, &PieceMatch)| {
            life.is_none_or(|life| life.is_valid() && piece.only_side() == Some(life.side))
        };
        self.pieces.iter().all(is_piece)
            && self.lives.len() <= pieces
            && self.lives.iter().zip(&self.pieces).all(is_of)
            && self.holes.iter().all(TimeWindow::is_valid)
            && self.swelling.iter().all(|&piece| piece < pieces)
            && self.unsearched <= pieces
            && self.stiffness.len() <= self.faces.len()
            && self.stiffness.iter().all(|&by| (1.0..1e12).contains(&by))
            && self
                .guard
                .iter()
                .all(|guard| guard.is_sound(self.places[0].len(), max_length))
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

    /// Returns a specification with moving parts, an unmatched hole, a ring that swells, and a part
    /// that appears.
    fn spec() -> TransitionSpec {
        let bars = svg("M32 30h12v40h-12z M56 30h12v40h-12z M34 40v4h4v-4z");
        let badge = svg(
            "M32 30h12v40h-12z M56 32h12v38h-12z M50 2a48 48 0 0 1 0 96a48 48 0 0 1 0-96 M50 12a38 38 0 0 0 0 76a38 38 0 0 0 0-76 M2 2h6v6h-6z",
        );
        let mut spec = TransitionSpec::new(bars, badge);
        // The link keeps the bar with the hole from being matched to the ring.
        let at = |design: &Design| design.form.bounds().centre() - 12.0 * DVec2::X;
        spec.options.matching.links = vec![PointPair {
            source: at(&spec.source),
            target: at(&spec.target),
        }];
        spec
    }

    fn built(spec: &TransitionSpec) -> Transition {
        Transition::build(spec, &Silent).expect("a transition")
    }

    fn rings(transition: &Transition) -> Vec<Vec<Vec<DVec2>>> {
        let at = |k: u32| transition.frame(f64::from(k) / 8.0).figure().rings;
        (0..=8).map(at).collect()
    }

    /// Returns the cached match after it was written as text and read again.
    fn found(transition: &Transition) -> CachedMatch {
        let found = transition.cached_match().expect("outlines were matched");
        let text = toml::to_string_pretty(&found).expect("text");
        assert!(text.lines().all(|line| line.len() < 100), "{text}");
        toml::from_str(&text).expect("what was written")
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn a_cached_match_plays_the_same_motion_without_a_draft() {
        let mut spec = spec();
        for subdivisions in 0..2 {
            spec.options.arap.subdivisions = subdivisions;
            spec.cached_match = CachedMatch::default();
            let first = built(&spec);
            assert!(spec.draft(&Silent).is_some());
            spec.cached_match = found(&first);
            assert!(spec.draft(&Silent).is_none());
            let again = built(&spec);
            assert_eq!(rings(&again), rings(&first));
            assert_eq!(again.notes(), first.notes());
            assert_eq!(
                again.cached_match().map(|f| f.film.0),
                first.cached_match().map(|f| f.film.0)
            );
        }
    }

    /// Returns a guard, which moves vertices aside to avoid collisions, for a mesh with `vertices`
    /// vertices. It moves all of them at t = ½.
    fn guard(vertices: usize) -> Option<Guard> {
        let mut rows = vec![vec![DVec2::ZERO; vertices]; 3];
        rows[1].fill(DVec2::new(0.125, 0.0));
        Guard::new(vec![0.25, 0.5, 0.75], &rows)
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn a_guard_is_cached() {
        let mut spec = spec();
        let first = built(&spec);
        let found = found(&first);
        let mut record = SolutionRecord::decode(&found.film.0).expect("a record");
        record.guard = guard(record.places[0].len());
        spec.cached_match = CachedMatch {
            film: record.encode().expect("text").into(),
            ..found
        };
        let again = built(&spec);
        let guarded = again.arap().expect("rigid parts");
        assert_eq!(guarded.guard(), record.guard.as_ref());
        assert!(rings(&again) != rings(&first));
    }

    #[test]
    fn a_cached_match_is_used_only_for_its_own_inputs() {
        let mut spec = spec();
        let of = |spec: &TransitionSpec| {
            let drawings = spec.drawings(1.0, &Silent).expect("outlines");
            cache_key(&spec.options, &drawings)
        };
        let asked = of(&spec);
        // Options that apply only after the motion is solved do not change the key.
        spec.options.arap.subdivisions = 2;
        spec.options.field.cells = 99;
        assert_eq!(asked, of(&spec));
        spec.options.guard = CollisionAvoidance::Off;
        assert_ne!(asked, of(&spec));
        spec.options.guard = CollisionAvoidance::On;
        spec.options.arap.symmetric = !spec.options.arap.symmetric;
        assert_ne!(asked, of(&spec));
        spec.options.arap.symmetric = !spec.options.arap.symmetric;
        spec.options.triangulation.edge_length = Some(0.5);
        assert_ne!(asked, of(&spec));
        let [source, target] = [Arc::clone(&spec.source), Arc::clone(&spec.target)];
        assert_ne!(asked, of(&TransitionSpec::new(target, source)));
    }

    /// Changes the time window of the part of a record that appears.
    fn change_life(record: &mut SolutionRecord, by: &dyn Fn(&mut TimeWindow)) {
        record.lives.iter_mut().flatten().take(1).for_each(by);
    }

    /// Returns records that are invalid or belong to other designs, each made from `record`.
    fn invalid_records(record: &dyn Fn() -> SolutionRecord) -> Vec<SolutionRecord> {
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
        change(&|record| change_life(record, &|life| life.to = life.from));
        change(&|record| change_life(record, &|life| life.side = life.side.other()));
        change(&|record| record.swelling = vec![99]);
        change(&|record| record.stiffness = vec![-1.0]);
        change(&|record| record.guard = guard(1 << 20));
        // Coordinates far away, and a motion of other designs.
        change(&|record| record.places[1][3].x = 1e9);
        change(&|record| record.pieces[0].rings[0].target[0].x = 1e9);
        change(&|record| record.pieces[0].rotation = 3.5);
        change(&|record| {
            let mut far = vec![vec![DVec2::ZERO; record.places[0].len()]; 3];
            far[1].fill(DVec2::new(1e9, 0.0));
            record.guard = Guard::new(vec![0.25, 0.5, 0.75], &far);
        });
        change(&|record| {
            let places = record.places.iter_mut().flatten();
            places.for_each(|p| *p *= 0.5);
        });
        changed
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn an_invalid_cached_match_is_computed_again() {
        let mut spec = spec();
        // Drafts keep this test short: it builds many transitions.
        spec.options.quality = BuildQuality::Draft;
        let first = built(&spec);
        let expected = rings(&first);
        let found = found(&first);
        let record = || SolutionRecord::decode(&found.film.0).expect("a record");
        let changed = invalid_records(&record);
        let texts = changed.iter().map(|record| record.encode().expect("text"));
        let cut = |k: usize| found.film.0[..found.film.0.len() * k / 8].to_owned();
        for text in texts.chain((1..8).map(cut)).chain(["-".to_owned()]) {
            spec.cached_match = CachedMatch {
                of: found.of.clone(),
                film: text.into(),
            };
            assert_eq!(rings(&built(&spec)), expected);
        }
        // A changed record that is still valid is used. This shows that the records above were
        // rejected.
        let mut record = record();
        change_life(&mut record, &|life| [life.from, life.to] = [0.3, 0.4]);
        spec.cached_match = CachedMatch {
            of: found.of.clone(),
            film: record.encode().expect("text").into(),
        };
        assert_ne!(rings(&built(&spec)), expected);
    }

    #[test]
    #[ignore = "slow; run by scripts/test"]
    fn random_bytes_give_a_finite_motion_or_none() {
        let mut spec = spec();
        spec.options.quality = BuildQuality::Draft;
        let record = SolutionRecord::decode(&found(&built(&spec)).film.0).expect("a record");
        let bytes = rmp_serde::to_vec(&record).expect("bytes");
        let outlines = spec.drawings(1.0, &Silent).expect("outlines").outlines;
        let mut state = 1_u64;
        let mut random = |below: usize| {
            // Knuth's MMIX generator: its high bits are random enough.
            state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            (state >> 33) as usize % below
        };
        let mut valid_count = 0;
        for _ in 0..400 {
            let mut bytes = bytes.clone();
            for _ in 0..=random(3) {
                let at = random(bytes.len());
                bytes[at] = random(256) as u8;
            }
            let Ok(record) = rmp_serde::from_slice::<SolutionRecord>(&bytes) else {
                continue;
            };
            if let Ok(Some(solution)) = record.rebuild(&outlines, &spec.options, &Silent) {
                valid_count += 1;
                let mut placer = solution.arap.placer();
                placer.place(0.5);
                let places = &placer.placement().in_frame;
                assert!(places.iter().all(|p| p.is_finite()));
            }
        }
        assert!(valid_count > 0, "no number was changed without harm");
    }
}
