//! Compatible mesh of many designs: one list of faces with an embedding (a position for every
//! vertex) in each design.
//!
//! Guaranteed: any two designs of a family form a [`CompatibleMesh`], because every face is
//! positively oriented in all embeddings, by exact predicates.

mod outlines;
mod shared_boundary;

use super::polygon_faces::common_triangles;
use super::{BarElement, CompatibleError, CompatibleMesh, PieceMeshError};
use crate::design::Truss;
use crate::geometry::{Bounds, DVec2};
use crate::mesh::{Connectivity, TriangleMesh};
use crate::work::budget::WorkloadTooLarge;
use crate::work::progress::{Cancelled, Progress, check_cancelled};
use std::sync::Arc;

/// One list of faces with two or more embeddings.
#[derive(Clone, Debug)]
pub struct CompatibleFamily {
    faces: Arc<[[u32; 3]]>,
    /// Vertex positions, one list for each design.
    embeddings: Vec<Vec<DVec2>>,
    elements: Vec<BarElement>,
    connectivity: Connectivity,
}

/// Reason why designs form no family. Design indices start at 0 in fields and at 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FamilyError {
    /// Fewer than two designs were given. The field is the number of designs given.
    #[error("at least two designs are needed, not {0}")]
    TooFew(usize),
    /// A design is not compatible with the first design.
    #[error("design {} is not compatible with the first: {error}", design + 1)]
    Incompatible {
        /// Index of the design that is not compatible.
        design: usize,
        /// Reason, in which "source" means the first design.
        error: CompatibleError,
    },
    /// Two designs do not have the same parts and holes, so some points have no counterpart.
    #[error("design {} does not have the same parts and holes as design {}", design + 1, of + 1)]
    PartsDiffer {
        /// Index of the design that differs.
        design: usize,
        /// Index of the design with which it was compared.
        of: usize,
    },
    /// The outline of a design is not a valid boundary after points that correspond to points of
    /// the other designs were inserted into it.
    #[error("design {}: {error}", design + 1)]
    Outline {
        /// Index of the design with the invalid outline.
        design: usize,
        /// Reason, in which "source" means the design with the invalid outline.
        error: PieceMeshError,
    },
    /// No triangulation was found that is free of folds in all designs.
    #[error(
        "no triangulation without folds was found for all designs; make them more alike, or change the matches"
    )]
    NoCommonTriangulation,
    /// No triangulation of the panels was found that is valid in all trusses.
    #[error(
        "no triangulation of the panels is valid in all trusses; add bars, or make them more alike"
    )]
    NoCommonPanels,
    /// Matching the outlines would exceed the limit on time or memory.
    #[error(transparent)]
    TooMuch(#[from] WorkloadTooLarge),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl CompatibleFamily {
    /// Creates a family from faces, the positions of their vertices in each design, and bars that
    /// lie in no face. Faces that are clockwise in all embeddings are reversed.
    ///
    /// # Errors
    /// [`FamilyError::TooFew`] for fewer than two embeddings; [`FamilyError::Incompatible`] with
    /// the error of [`CompatibleMesh::new`] if a design is not compatible with the first.
    ///
    /// ```
    /// use morphospace::{compatible::CompatibleFamily, geometry::DVec2};
    /// let first = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
    /// let places = [1.0, 2.0, 3.0].map(|by| first.iter().map(|&p| p * by).collect());
    /// let family = CompatibleFamily::new(vec![[0, 1, 2]], places.to_vec(), vec![])?;
    /// assert_eq!(family.pair(2, 0).target(), first);
    /// # Ok::<(), morphospace::compatible::FamilyError>(())
    /// ```
    pub fn new(
        faces: Vec<[u32; 3]>,
        embeddings: Vec<Vec<DVec2>>,
        elements: Vec<BarElement>,
    ) -> Result<Self, FamilyError> {
        let [first, others @ ..] = embeddings.as_slice() else {
            return Err(FamilyError::TooFew(0));
        };
        // Checking each design against the first is enough: faces that agree with the first in
        // orientation agree with each other.
        let mut first_mesh = None;
        for (k, embedding) in others.iter().enumerate() {
            let pair = |faces| {
                CompatibleMesh::new(faces, first.clone(), embedding.clone(), elements.clone())
            };
            let mesh = pair(faces.clone());
            let unlike = |error| FamilyError::Incompatible {
                design: k + 1,
                error,
            };
            first_mesh.get_or_insert(mesh.map_err(unlike)?);
        }
        let Some(first_mesh) = first_mesh else {
            return Err(FamilyError::TooFew(1));
        };
        Ok(Self {
            faces: first_mesh.faces,
            connectivity: first_mesh.connectivity,
            elements,
            embeddings,
        })
    }

    /// Creates a family of meshes that have the same faces in the same order.
    ///
    /// # Errors
    /// As [`Self::new`]; also [`FamilyError::Incompatible`] if the faces of a mesh differ from the
    /// first one's.
    pub fn from_meshes(meshes: &[&TriangleMesh]) -> Result<Self, FamilyError> {
        let Some((first, others)) = meshes.split_first() else {
            return Err(FamilyError::TooFew(0));
        };
        for (k, other) in others.iter().enumerate() {
            let design = k + 1;
            CompatibleMesh::from_meshes(first, other)
                .map_err(|error| FamilyError::Incompatible { design, error })?;
        }
        let places = meshes.iter().map(|mesh| mesh.positions().to_vec());
        let faces = common_triangles(meshes).map_err(|_| FamilyError::NoCommonTriangulation)?;
        Self::new(faces, places.collect(), Vec::new())
    }

    /// Creates a family of trusses with the same nodes and bars.
    ///
    /// The panels (areas enclosed by bars) are triangulated for one pair of trusses after another,
    /// until a triangulation is valid in all trusses. Bars that lie in no panel become two-point
    /// elements.
    ///
    /// # Errors
    /// [`FamilyError`] names a truss that is incompatible with truss 0, or reports that no
    /// triangulation is valid in all trusses or that the work was cancelled.
    pub fn from_trusses(trusses: &[&Truss], progress: &dyn Progress) -> Result<Self, FamilyError> {
        let embeddings: Vec<_> = trusses.iter().map(|t| t.nodes().to_vec()).collect();
        let mut family: Option<Self> = None;
        for (a, first) in trusses.iter().enumerate() {
            // All pairs with the first truss (`a` = 0) are tried, even after a triangulation has
            // been found, because each pair also checks that its second truss is compatible with
            // the first.
            if a > 0 && family.is_some() {
                break;
            }
            for (b, second) in trusses.iter().enumerate().skip(a + 1) {
                check_cancelled(progress)?;
                let mesh = match CompatibleMesh::from_trusses(first, second, progress) {
                    Ok(mesh) => mesh,
                    Err(error) if a == 0 => {
                        return Err(FamilyError::Incompatible { design: b, error });
                    }
                    Err(_) => continue,
                };
                if family.is_none() {
                    let elements = mesh.elements().to_vec();
                    family = Self::new(mesh.faces().to_vec(), embeddings.clone(), elements).ok();
                }
            }
        }
        family.ok_or(match trusses.len() {
            0 | 1 => FamilyError::TooFew(trusses.len()),
            _ => FamilyError::NoCommonPanels,
        })
    }

    /// Number of designs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.embeddings.len()
    }

    /// Vertex indices of the faces, counter-clockwise in all embeddings.
    #[must_use]
    pub fn faces(&self) -> &Arc<[[u32; 3]]> {
        &self.faces
    }

    /// Vertex positions, one list for each design.
    #[must_use]
    pub fn embeddings(&self) -> &[Vec<DVec2>] {
        &self.embeddings
    }

    /// Bars that lie in no face, as pairs of vertex indices.
    #[must_use]
    pub fn elements(&self) -> &[BarElement] {
        &self.elements
    }

    /// Closed boundary loops of the faces, each as the indices of its vertices in order.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        self.connectivity.boundary_loops(&self.faces)
    }

    /// Returns the compatible mesh of two of the designs, given by their indices.
    ///
    /// # Panics
    /// If an index is not below [`Self::count`].
    #[must_use]
    pub fn pair(&self, source: usize, target: usize) -> CompatibleMesh {
        self.with_embeddings([source, target].map(|design| self.embeddings[design].clone()))
    }

    /// Returns a mesh with the family's faces and the given embeddings, such as two blends of the
    /// designs. Nothing is checked; its faces may be folded.
    pub(crate) fn with_embeddings(&self, [source, target]: [Vec<DVec2>; 2]) -> CompatibleMesh {
        CompatibleMesh {
            faces: Arc::clone(&self.faces),
            source,
            target,
            elements: self.elements.clone(),
            connectivity: self.connectivity.clone(),
        }
    }

    /// Largest diameter of a design, in units of the plane.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        let diameters = self
            .embeddings
            .iter()
            .map(|points| Bounds::diameter_of(points));
        diameters.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests;
