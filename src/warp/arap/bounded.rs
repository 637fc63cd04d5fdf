//! Local maps whose distortion (ratio of singular values) never exceeds that at the worse end.
//!
//! Chen, Weber, Keren, Ben-Chen, "Planar shape interpolation with bounded distortion" (2013):
//! squared edge lengths change linearly, l²(t) = (1−t) l₀² + t l₁², so that a face with the map M
//! has the metric (1−t) I + t MᵀM. Its distortion never exceeds that of M, but faces with such
//! metrics do not fit together in the plane. They are flattened conformally (`flat`: discrete
//! conformal equivalence; Springborn, Schröder, Pinkall 2008) and laid out face by face (`layout`).
//! The energy then integrates the resulting maps like those of any homotopy. Within a sheet without
//! holes they fit together exactly.
//!
//! A sheet is a set of faces connected by shared edges. One rotation per sheet is left free. It is
//! chosen such that, on average, the faces rotate as in the polar homotopy, seen equally from both
//! designs. Whole turns are therefore preserved.
//!
//! Guaranteed: a sheet that is marked flat could be flattened at every tested t; swapping the
//! designs gives the reversed maps. Not guaranteed: that a flattened triangle is distorted no more
//! than its metric, because discrete conformal maps scale the corners of a face differently, the
//! more so the larger the face; nor that the maps fit together around a hole.
//!
//! The module `excess` finds faces that exceed the bound even so, and the frame solver corrects
//! them.
//!
//! In a sheet that cannot be flattened, each face follows its own metric ([`Homotopy::Bounded`]).
//! The number of such sheets is reported.

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

/// Number of equal steps of t at which flattening is tested (resource limit).
const TRIED: u32 = 16;

/// All sheets of a mesh. A sheet is a set of faces connected by shared edges.
#[derive(Debug)]
pub(super) struct Bounded {
    sheets: Vec<BoundedSheet>,
}

/// A sheet with its faces.
#[derive(Debug)]
struct BoundedSheet {
    sheet: FaceSheet,
    /// The faces, in the order of the sheet.
    faces: Vec<BoundedFace>,
    /// Whether the sheet could be flattened at all tested times.
    is_flat: bool,
    /// Largest distortion (ratio of singular values) of a face between the designs; at least 1.
    sheared: f64,
    /// For each face, the matrix by which a requested change of its map must be multiplied for the
    /// map to change as requested; computed on first use.
    unyielding: Vec<OnceLock<DMat2>>,
}

/// A face that exceeds the distortion bound: index of its sheet, and index within the sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beyond {
    sheet: usize,
    face: usize,
}

/// Memory for the maps of a frame, one entry per sheet.
#[derive(Debug, Default)]
pub(super) struct Memory {
    sheets: Vec<OfSheet>,
    /// Faces that exceed the bound, each with the change that its map needs.
    pub(super) beyond: Vec<(Beyond, DMat2)>,
}

#[derive(Debug)]
struct OfSheet {
    flattening: Flattening,
    /// For each face of the sheet, its map.
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

    /// Returns the number of sheets that could not be flattened.
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

    /// Adds M(t) W g of each face to the forces on its corners.
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
    /// Finds the faces that exceed the distortion bound and stores them in `memory`. `deviation`
    /// returns the deviation of a vertex from its straight path. Finds nothing unless 0 < t < 1.
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

    /// Returns the change that the map of a face needs to satisfy the distortion bound; `None` if
    /// it satisfies it.
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

    /// Returns the matrix by which a requested change must be multiplied for the map of a face to
    /// change as requested; the identity if the face does not yield at all. `answer` returns the
    /// change of the map when the identity is requested.
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
    /// Computes the maps of all faces at t.
    fn maps(&self, t: f64, memory: &mut OfSheet) {
        let OfSheet { flattening, maps } = memory;
        if !self.is_flat || !(0.0..=1.0).contains(&t) {
            for (map, face) in maps.iter_mut().zip(&self.faces) {
                *map = Homotopy::Bounded.at(&face.map, t);
            }
            return;
        }
        // The result is used even if it is not flat: flattening succeeded at times nearby.
        flattening.flatten(&self.sheet, t);
        layout::laid_out(&self.sheet, &self.faces, flattening.corners(), maps);
        layout::turn_along(&self.faces, t, maps);
    }
}
