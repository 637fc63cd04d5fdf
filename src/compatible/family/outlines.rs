//! Creates a family of designs from outlines, each of which is matched with the outline of one of
//! the designs, the *hub*.

use super::shared_boundary::{PieceRings, shared_rings};
use super::{CompatibleFamily, FamilyError};
use crate::compatible::PolygonOptions;
use crate::compatible::polygons::triangulate_many;
use crate::correspondence::RegionMatch;
use crate::work::progress::{Progress, ProgressShares};
use rayon::prelude::*;

impl CompatibleFamily {
    /// Triangulates the outlines of all designs at once. All designs must have the same parts and
    /// holes.
    ///
    /// All designs are matched with the design of index `hub`. For each design, `matches` contains
    /// the match with the hub as the source and this design as the target; at index `hub` it
    /// contains `None`. The vertices are ordered piece by piece (by matched connected part). Within
    /// a piece the points of its rings come first.
    ///
    /// # Errors
    /// [`FamilyError`] names the design whose parts or holes differ, or reports that no common
    /// triangulation was found or that the work was cancelled.
    pub fn from_outlines(
        hub: usize,
        matches: &[Option<&RegionMatch>],
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, FamilyError> {
        if matches.len() < 2 {
            return Err(FamilyError::TooFew(matches.len()));
        }
        let pieces = shared_rings(hub, matches)
            .map_err(|design| FamilyError::PartsDiffer { design, of: hub })?;
        let several = ProgressShares::new(progress, pieces.len());
        let triangulated = |(k, piece): (usize, &PieceRings)| {
            triangulate_many(piece, hub, options, &several.part(k)).map_err(|(design, error)| {
                match error {
                    Some(error) => FamilyError::Outline { design, error },
                    None => FamilyError::NoCommonTriangulation,
                }
            })
        };
        // The results keep their order, so the reported error does not depend on the number of
        // threads.
        let meshes: Vec<_> = pieces.par_iter().enumerate().map(triangulated).collect();
        let mut faces: Vec<[u32; 3]> = Vec::new();
        let mut embeddings = vec![Vec::new(); matches.len()];
        for mesh in meshes {
            let (piece_faces, points) = mesh?;
            let offset = embeddings[0].len() as u32;
            faces.extend(piece_faces.iter().map(|face| face.map(|v| v + offset)));
            for (all, piece_points) in embeddings.iter_mut().zip(points) {
                all.extend(piece_points);
            }
        }
        Self::new(faces, embeddings, Vec::new())
    }
}
