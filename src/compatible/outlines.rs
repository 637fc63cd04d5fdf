//! Compatible mesh of a whole match. Its pieces (matched connected parts) are triangulated in
//! parallel, and the results form one mesh.

use super::assembly::MeshAssembly;
use super::{CompatibleMesh, PieceMeshError, PolygonOptions};
use crate::correspondence::{PieceMatch, RegionMatch};
use crate::work::progress::{Progress, ProgressShares};
use rayon::prelude::*;

/// Error of a match in which a piece could not be triangulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{error}", self.place())]
pub struct OutlineMeshError {
    /// Index of the piece that could not be triangulated.
    pub piece: usize,
    /// Number of pieces of the match.
    pub pieces: usize,
    /// Reason why that piece could not be triangulated.
    pub error: PieceMeshError,
}

impl OutlineMeshError {
    /// Returns the beginning of the error message, such as "piece 2 of 3: ". It is empty if the
    /// match has a single piece or if the work was cancelled.
    fn place(&self) -> String {
        match self.error {
            PieceMeshError::Cancelled(_) => String::new(),
            _ if self.pieces == 1 => String::new(),
            _ => format!("piece {} of {}: ", self.piece + 1, self.pieces),
        }
    }
}

impl CompatibleMesh {
    /// Triangulates all pieces of a match. The vertices are ordered piece by piece. Within a piece
    /// the points of its boundary rings come first, in order.
    ///
    /// # Errors
    /// [`OutlineMeshError`] names the piece that failed, or reports that the work was cancelled.
    ///
    /// ```
    /// use morphospace::compatible::{CompatibleMesh, PolygonOptions};
    /// use morphospace::correspondence::{MatchSettings, match_regions};
    /// use morphospace::geometry::{DVec2, FillRule, Regions};
    /// use morphospace::work::progress::Silent;
    /// let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec();
    /// let kite = [(0.0, 0.0), (1.0, -2.0), (2.0, 0.0), (1.0, 1.0)].map(DVec2::from).to_vec();
    /// let [a, b] = [Regions::from_rings(&[square], FillRule::NonZero)?,
    ///               Regions::from_rings(&[kite], FillRule::NonZero)?];
    /// let matched = match_regions(&a, &b, &MatchSettings::default(), &Silent)?;
    /// let mesh = CompatibleMesh::from_outlines(&matched, &PolygonOptions::default(), &Silent)?;
    /// assert_eq!(mesh.boundary_loops().len(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_outlines(
        matched: &RegionMatch,
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, OutlineMeshError> {
        let pieces = matched.pieces.len();
        let shares = ProgressShares::new(progress, pieces);
        let meshes = matched.pieces.par_iter().enumerate().map(|(piece, rings)| {
            mesh_of_piece(rings, options, &shares.part(piece)).map_err(|error| OutlineMeshError {
                piece,
                pieces,
                error,
            })
        });
        Ok(merged_meshes(&meshes.collect::<Result<Vec<_>, _>>()?))
    }
}

/// Returns the compatible mesh of one piece of a match.
pub(crate) fn mesh_of_piece(
    piece: &PieceMatch,
    options: &PolygonOptions,
    progress: &dyn Progress,
) -> Result<CompatibleMesh, PieceMeshError> {
    let source: Vec<_> = piece.rings.iter().map(|ring| &ring.source).collect();
    let target: Vec<_> = piece.rings.iter().map(|ring| &ring.target).collect();
    CompatibleMesh::from_piece(&source, &target, options, progress)
}

/// Merges meshes that share no vertices into one, in the given order.
pub(crate) fn merged_meshes<'a>(
    meshes: impl IntoIterator<Item = &'a CompatibleMesh>,
) -> CompatibleMesh {
    let mut whole = MeshAssembly::default();
    for mesh in meshes {
        // No vertices are shared, so the list of shared vertices is empty.
        whole.append(
            &[],
            [&mesh.source, &mesh.target],
            mesh.faces.iter().copied(),
        );
    }
    let [source, target] = whole.points;
    CompatibleMesh::new(whole.faces, source, target, Vec::new())
        .unwrap_or_else(|_| unreachable!("each mesh was valid, and they share nothing"))
}
