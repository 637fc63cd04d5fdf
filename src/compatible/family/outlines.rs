//! Creates a family from outlines that are each matched with one of them, the *hub*.

use super::shared_boundary::{PieceRings, shared_rings};
use super::{CompatibleFamily, FamilyError};
use crate::compatible::PolygonOptions;
use crate::compatible::polygons::triangulate_many;
use crate::correspondence::RegionMatch;
use crate::work::progress::{Progress, ProgressShares};
use rayon::prelude::*;

impl CompatibleFamily {
    /// Triangulates outlines with the same parts and holes in all designs at once.
    ///
    /// `matches` holds for each design its match with the hub as the source, and `None` at index
    /// `hub`. Vertices are ordered piece by piece; in each piece the ring points come first.
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
        // Results stay in order, so the reported error does not depend on the number of threads.
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
