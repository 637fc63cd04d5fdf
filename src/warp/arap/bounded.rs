//! Local maps of the bounded homotopy: their distortion (ratio of singular values) is limited to
//! that of the maps from source to target.
//!
//! Chen, Weber, Keren, Ben-Chen, "Planar shape interpolation with bounded distortion" (2013):
//! squared edge lengths change linearly, l²(t) = (1−t) l₀² + t l₁², so that a face with the linear
//! map M from source to target has the metric (1−t) I + t MᵀM. Its distortion never exceeds that of
//! M, but faces with such metrics do not fit together in the plane. They are flattened conformally
//! (`flat`: discrete conformal equivalence; Springborn, Schröder, Pinkall 2008) and laid out face
//! by face (`layout`). The energy then integrates the resulting local maps like those of any
//! homotopy. Within a sheet without holes they fit together exactly.
//!
//! A sheet is a set of faces connected by shared edges. One rotation per sheet is left free. It is
//! chosen such that, on average, the faces rotate as in the polar homotopy; both designs count
//! equally in the average. Whole turns are therefore preserved.
//!
//! Guaranteed: a sheet that is marked flat could be flattened at every tested t; swapping the
//! designs gives the reversed local maps. Not guaranteed: that a flattened triangle is distorted no
//! more than its metric, because discrete conformal maps scale the corners of a face differently,
//! the more so the larger the face; nor that the local maps fit together around a hole.
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

/// Number of equal steps of t in [0, 1]; flattening is tested at the times between them (resource
/// limit).
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
    /// The faces, in the same order as in `sheet`.
    faces: Vec<BoundedFace>,
    /// Whether the sheet could be flattened at all tested times.
    is_flat: bool,
    /// Largest distortion (ratio of singular values) of a face from source to target; at least 1.
    /// It bounds the distortion during the motion.
    sheared: f64,
    /// For each face, a matrix that compensates for the resistance of its neighbours: if a
    /// requested change of the face's local map is multiplied by it, the map changes as requested.
    /// Computed on first use.
    unyielding: Vec<OnceLock<DMat2>>,
}

/// A face that exceeds the distortion bound: index of its sheet, and index within the sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beyond {
    sheet: usize,
    face: usize,
}

/// Memory for the local maps at one t, reused at the next; `sheets` has one entry per sheet.
#[derive(Debug, Default)]
pub(super) struct Memory {
    sheets: Vec<OfSheet>,
    /// Faces that exceed the distortion bound, each with the change that its local map needs.
    pub(super) beyond: Vec<(Beyond, DMat2)>,
}

#[derive(Debug)]
struct OfSheet {
    flattening: Flattening,
    /// Local map of each face of the sheet.
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

    /// Adds the contribution M(t) W g of each face to the right-hand sides at its corners. M(t) is
    /// the face's local map, W its weight matrix, and g are the gradients of its hat functions.
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
    /// returns the deviation of a vertex from the straight line between its positions in the
    /// designs. Finds nothing unless 0 < t < 1.
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

    /// Returns the change that the local map of a face needs to satisfy the distortion bound;
    /// `None` if the face satisfies the bound, or unless 0 < t < 1.
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

    /// Returns the matrix by which a requested change of a face's local map must be multiplied for
    /// the map to change as requested, despite the resistance of its neighbours. `answer` returns
    /// the change of the map if the identity is requested. If this change has no finite inverse,
    /// the result is the identity.
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
    /// Computes the local maps of all faces at t.
    fn maps(&self, t: f64, memory: &mut OfSheet) {
        let OfSheet { flattening, maps } = memory;
        if !self.is_flat || !(0.0..=1.0).contains(&t) {
            for (map, face) in maps.iter_mut().zip(&self.faces) {
                *map = Homotopy::Bounded.at(&face.map, t);
            }
            return;
        }
        // The result is used even if flattening does not converge at this t, because it converged
        // at the tested times nearby.
        flattening.flatten(&self.sheet, t);
        layout::laid_out(&self.sheet, &self.faces, flattening.corners(), maps);
        layout::turn_along(&self.faces, t, maps);
    }
}
