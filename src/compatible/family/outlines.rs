//! A family of outlines, each matched with one of them.

use super::shared_boundary::{PieceRings, shared_rings};
use super::{CompatibleFamily, FamilyError};
use crate::compatible::PolygonOptions;
use crate::compatible::polygons::triangulate_many;
use crate::correspondence::RegionMatch;
use crate::work::progress::{Progress, ProgressShares};
use rayon::prelude::*;

impl CompatibleFamily {
    /// Outlines with the same parts and holes, each matched with that of the *hub*: the
    /// vertices of each piece follow those of the one before, its rings' first.
    ///
    /// `matches` has one for each design with the hub as its source, and none at the
    /// hub's own place.
    ///
    /// # Errors
    /// [`FamilyError`] names the design that has other parts or holes, or says that no
    /// common triangulation was found, or tells of a cancel.
    pub fn from_outlines(
        hub: usize,
        matches: &[Option<&RegionMatch>],
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, FamilyError> {
        if matches.len() < 2 {
            return Err(FamilyError::TooFew(matches.len()));
        }
        let pieces =
            shared_rings(hub, matches).map_err(|design| FamilyError::Parts { design, of: hub })?;
        let several = ProgressShares::new(progress, pieces.len());
        let triangulated = |(k, piece): (usize, &PieceRings)| {
            triangulate_many(piece, hub, options, &several.part(k)).map_err(|(design, error)| {
                match error {
                    Some(error) => FamilyError::Outline { design, error },
                    None => FamilyError::Folds,
                }
            })
        };
        // In order, so that the first fault is told whatever the number of threads.
        let meshes: Vec<_> = pieces.par_iter().enumerate().map(triangulated).collect();
        let mut faces: Vec<[u32; 3]> = Vec::new();
        let mut places = vec![Vec::new(); matches.len()];
        for mesh in meshes {
            let (own, points) = mesh?;
            let first = places[0].len() as u32;
            faces.extend(own.iter().map(|face| face.map(|v| v + first)));
            for (all, own) in places.iter_mut().zip(points) {
                all.extend(own);
            }
        }
        Self::new(faces, places, Vec::new())
    }
}
