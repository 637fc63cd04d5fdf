//! Local maps that are never sheared more than at the worse end.
//!
//! Chen, Weber, Keren, Ben-Chen, "Planar shape interpolation with bounded
//! distortion" (2013): squared edge lengths run evenly, l²(t) = (1−t) l₀² + t l₁²,
//! so that the metric of a face is (1−t) I + t MᵀM. It is never sheared more than
//! M; but faces of such metrics lie together on no plane. They are flattened without
//! shearing them further (`flat`: discrete conformal equivalence; Springborn,
//! Schröder, Pinkall 2008), laid out side by side (`layout`), and the map of
//! each face is read off: the energy integrates these as those of any homotopy.
//! Where faces lie around no hole they fit together exactly.
//!
//! What is free is one rotation for each sheet of faces that share edges. It is the
//! one with which the faces turn as by the polar homotopy in the mean, seen from
//! both designs alike, so that whole turns are kept.
//!
//! Guaranteed: where it is said so, each sheet is flat at every t that was tried; the
//! maps of the exchanged designs are those that run back. Not guaranteed: that a flat
//! triangle is sheared no more than its metric. Discrete conformal maps scale the
//! corners of a face unlike, the more so the larger the face; and around a hole the
//! maps need not close.
//!
//! What is sheared more than at the worse end for all that is found here (`excess`), and
//! put back by who solves.
//!
//! A sheet that cannot be flattened takes the metric of each face by itself,
//! [`Homotopy::Bounded`] as it is written there, and that is told.

mod excess;
mod flat;
mod layout;
mod sheet;
#[cfg(test)]
mod tests;

use super::assembly::LocalMaps;
use super::evaluation_times::EvaluationTimes;
use crate::compatible::CompatibleMesh;
use crate::geometry::{DMat2, DVec2};
use crate::warp::homotopy::Homotopy;
use flat::Flattening;
use layout::BoundedFace;
use sheet::FaceSheet;
use std::sync::OnceLock;

/// Even steps at which it is tried whether a sheet can be flattened.
const TRIED: u32 = 16;

/// All sheets of a mesh.
#[derive(Debug)]
pub(super) struct Bounded {
    sheets: Vec<BoundedSheet>,
}

/// A sheet, and what its maps act on.
#[derive(Debug)]
struct BoundedSheet {
    sheet: FaceSheet,
    /// In the order of the sheet.
    faces: Vec<BoundedFace>,
    /// Whether it was flat wherever it was tried.
    is_flat: bool,
    /// How much its worst face is sheared between the designs.
    sheared: f64,
    /// What has to be asked of each face for it to give way as it should, once it is
    /// known.
    unyielding: Vec<OnceLock<DMat2>>,
}

/// A face that is sheared more than at the worse end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beyond {
    sheet: usize,
    face: usize,
}

/// The memory that the maps of a frame take, a sheet each.
#[derive(Debug, Default)]
pub(super) struct Memory {
    sheets: Vec<OfSheet>,
    /// What is sheared too much, and what it lacks.
    pub(super) beyond: Vec<(Beyond, DMat2)>,
}

#[derive(Debug)]
struct OfSheet {
    flattening: Flattening,
    /// Of each face of the sheet.
    maps: Vec<DMat2>,
}

impl Bounded {
    pub(super) fn new(mesh: &CompatibleMesh, maps: &LocalMaps) -> Self {
        let sheets = FaceSheet::all(mesh).into_iter().map(|sheet| {
            let faces = sheet.faces.iter();
            let faces = faces.map(|&f| BoundedFace::new(mesh, f as usize, &maps.faces[f as usize]));
            let mut flattening = Flattening::of(&sheet);
            let is_flat = (1..TRIED)
                .map(|step| f64::from(step) / f64::from(TRIED))
                .all(|t| flattening.flatten(&sheet, t));
            let faces: Vec<BoundedFace> = faces.collect();
            let sheared = faces.iter().map(|face| excess::sheared(face.map.matrix()));
            BoundedSheet {
                sheared: sheared.fold(1.0, f64::max),
                unyielding: faces.iter().map(|_| OnceLock::new()).collect(),
                faces,
                is_flat,
                sheet,
            }
        });
        Self {
            sheets: sheets.collect(),
        }
    }

    /// How many sheets could not be flattened.
    pub(super) fn unflattened(&self) -> usize {
        self.sheets.iter().filter(|whole| !whole.is_flat).count()
    }

    pub(super) fn memory(&self) -> Memory {
        let of_sheet = |whole: &BoundedSheet| OfSheet {
            flattening: Flattening::of(&whole.sheet),
            maps: vec![DMat2::IDENTITY; whole.faces.len()],
        };
        Memory {
            sheets: self.sheets.iter().map(of_sheet).collect(),
            beyond: Vec::with_capacity(self.sheets.iter().map(|whole| whole.faces.len()).sum()),
        }
    }

    /// Adds M(t) W g of each face to its corners.
    pub(super) fn add(&self, times: EvaluationTimes, memory: &mut Memory, forces: &mut [DVec2]) {
        for (whole, memory) in self.sheets.iter().zip(&mut memory.sheets) {
            let t = times.of_vertex(whole.faces[0].corners[0] as usize);
            whole.maps(t, memory);
            for (face, &map) in whole.faces.iter().zip(&memory.maps) {
                face.pull(map, forces);
            }
        }
    }
}

impl Bounded {
    /// Finds what is sheared more than at the worse end, of what deviates so from the
    /// straight line: nothing at the ends themselves and beyond.
    pub(super) fn find_beyond(
        &self,
        times: EvaluationTimes,
        memory: &mut Memory,
        deviation: impl Fn(u32) -> DVec2,
    ) {
        memory.beyond.clear();
        for (sheet, whole) in self.sheets.iter().enumerate() {
            for face in 0..whole.faces.len() {
                let of = Beyond { sheet, face };
                if let Some(by) = self.lacking(of, times, &deviation) {
                    memory.beyond.push((of, by));
                }
            }
        }
    }

    /// What the map of a face lacks where it is sheared more than at the worse end.
    pub(super) fn lacking(
        &self,
        Beyond { sheet, face }: Beyond,
        times: EvaluationTimes,
        deviation: impl Fn(u32) -> DVec2,
    ) -> Option<DMat2> {
        let whole = &self.sheets[sheet];
        let face = &whole.faces[face];
        let t = times.of_vertex(face.corners[0] as usize);
        if !(t > 0.0 && t < 1.0) {
            return None;
        }
        let straight = DMat2::IDENTITY * (1.0 - t) + face.map.matrix() * t;
        excess::taken_back(face, straight + face.strayed(deviation), whole.sheared)
    }

    pub(super) fn face(&self, Beyond { sheet, face }: Beyond) -> &BoundedFace {
        &self.sheets[sheet].faces[face]
    }

    /// What has to be asked of a face alone for its map to change as it should; the
    /// identity where it does not give way at all. `answer` is how it changes where it is
    /// asked for that.
    pub(super) fn unyielding(
        &self,
        Beyond { sheet, face }: Beyond,
        answer: impl FnOnce() -> DMat2,
    ) -> DMat2 {
        let inverse = || Some(answer().inverse()).filter(|by| by.is_finite());
        *self.sheets[sheet].unyielding[face].get_or_init(|| inverse().unwrap_or(DMat2::IDENTITY))
    }
}

impl BoundedSheet {
    /// The maps of all faces at t.
    fn maps(&self, t: f64, memory: &mut OfSheet) {
        let OfSheet { flattening, maps } = memory;
        if !self.is_flat || !(0.0..=1.0).contains(&t) {
            for (map, face) in maps.iter_mut().zip(&self.faces) {
                *map = Homotopy::Bounded.at(&face.map, t);
            }
            return;
        }
        // Whatever comes of it is drawn: it was tried nearby.
        flattening.flatten(&self.sheet, t);
        layout::laid_out(&self.sheet, &self.faces, flattening.corners(), maps);
        layout::turn_along(&self.faces, t, maps);
    }
}
