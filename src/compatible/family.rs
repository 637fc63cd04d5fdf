//! One connectivity with an embedding for each of many designs.
//!
//! Guaranteed: any two designs of a family are a [`CompatibleMesh`]: every face is
//! positive in all embeddings, by exact predicates.

mod outlines;
mod shared_boundary;

use super::{BarElement, CompatibleError, CompatibleMesh, PieceMeshError};
use crate::design::Truss;
use crate::geometry::{Bounds, DVec2};
use crate::mesh::{Connectivity, TriangleMesh};
use crate::work::budget::WorkloadTooLarge;
use crate::work::progress::{Cancelled, Progress, still_wanted};
use std::sync::Arc;

/// One connectivity with its embeddings, at least two.
#[derive(Clone, Debug)]
pub struct CompatibleFamily {
    faces: Arc<[[u32; 3]]>,
    /// For each design where its vertices are.
    places: Vec<Vec<DVec2>>,
    elements: Vec<BarElement>,
    connectivity: Connectivity,
}

/// Why designs are no family. Designs are counted from 0, and from 1 in words.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FamilyError {
    /// Fewer than two designs.
    #[error("there are {0} designs; a family has at least two")]
    TooFew(usize),
    /// A design does not share the connectivity of the first.
    #[error("design {} does not go with the first: {error}", design + 1)]
    Unlike {
        /// Which design.
        design: usize,
        /// What does not fit, with the first as the source.
        error: CompatibleError,
    },
    /// A design has parts or holes that another has not: there are points of the one
    /// that are nowhere in the other.
    #[error("design {} has not the parts and holes of design {}", design + 1, of + 1)]
    Parts {
        /// Which design.
        design: usize,
        /// Of which other.
        of: usize,
    },
    /// The outline of a design bounds no piece once it has the points of all.
    #[error("design {}: {error}", design + 1)]
    Outline {
        /// Which design.
        design: usize,
        /// What is wrong, as of a source.
        error: PieceMeshError,
    },
    /// No triangulation of one outline was found that is one of all others.
    #[error("no triangulation of one design was found that does not fold in another")]
    Folds,
    /// No panels of two trusses are panels of all.
    #[error("the panels of no two trusses are panels of all")]
    Panels,
    /// To match the outlines would take very long, or very much memory.
    #[error(transparent)]
    TooMuch(#[from] WorkloadTooLarge),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl CompatibleFamily {
    /// Joins faces, bars that lie in no face, and the embeddings of their vertices.
    /// Faces that are clockwise in all are turned round.
    ///
    /// # Errors
    /// [`FamilyError::TooFew`], or [`FamilyError::Unlike`] with what
    /// [`CompatibleMesh::new`] finds.
    ///
    /// ```
    /// use morphospace::{compatible::Family, geometry::DVec2};
    /// let first = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
    /// let places = [1.0, 2.0, 3.0].map(|by| first.iter().map(|&p| p * by).collect());
    /// let family = Family::new(vec![[0, 1, 2]], places.to_vec(), vec![])?;
    /// assert_eq!(family.pair(2, 0).target(), first);
    /// # Ok::<(), morphospace::compatible::FamilyError>(())
    /// ```
    pub fn new(
        faces: Vec<[u32; 3]>,
        places: Vec<Vec<DVec2>>,
        elements: Vec<BarElement>,
    ) -> Result<Self, FamilyError> {
        let [first, others @ ..] = places.as_slice() else {
            return Err(FamilyError::TooFew(0));
        };
        let mut joined = None;
        for (k, place) in others.iter().enumerate() {
            let pair =
                |faces| CompatibleMesh::new(faces, first.clone(), place.clone(), elements.clone());
            let made = pair(faces.clone());
            let unlike = |error| FamilyError::Unlike {
                design: k + 1,
                error,
            };
            joined.get_or_insert(made.map_err(unlike)?);
        }
        let Some(joined) = joined else {
            return Err(FamilyError::TooFew(1));
        };
        Ok(Self {
            faces: joined.faces,
            connectivity: joined.connectivity,
            elements,
            places,
        })
    }

    /// Meshes whose faces are the same, number by number.
    ///
    /// # Errors
    /// As [`Self::new`], and where faces differ.
    pub fn from_meshes(meshes: &[&TriangleMesh]) -> Result<Self, FamilyError> {
        let Some((first, others)) = meshes.split_first() else {
            return Err(FamilyError::TooFew(0));
        };
        for (k, other) in others.iter().enumerate() {
            let design = k + 1;
            CompatibleMesh::from_meshes(first, other)
                .map_err(|error| FamilyError::Unlike { design, error })?;
        }
        let places = meshes.iter().map(|mesh| mesh.positions().to_vec());
        Self::new(first.faces().to_vec(), places.collect(), Vec::new())
    }

    /// Trusses with the same nodes and bars: the panels of two of them that are panels
    /// of all, and the bars in none.
    ///
    /// # Errors
    /// [`FamilyError`] names the first that differs, or says that there are no such
    /// panels.
    pub fn from_trusses(trusses: &[&Truss], progress: &dyn Progress) -> Result<Self, FamilyError> {
        let places: Vec<_> = trusses.iter().map(|t| t.nodes().to_vec()).collect();
        let mut found: Option<Self> = None;
        for (a, first) in trusses.iter().enumerate() {
            // Those with the first alone say whether all are alike.
            if a > 0 && found.is_some() {
                break;
            }
            for (b, second) in trusses.iter().enumerate().skip(a + 1) {
                still_wanted(progress)?;
                let made = match CompatibleMesh::from_trusses(first, second, progress) {
                    Ok(made) => made,
                    Err(error) if a == 0 => {
                        return Err(FamilyError::Unlike { design: b, error });
                    }
                    Err(_) => continue,
                };
                if found.is_none() {
                    let elements = made.elements().to_vec();
                    found = Self::new(made.faces().to_vec(), places.clone(), elements).ok();
                }
            }
        }
        found.ok_or(match trusses.len() {
            0 | 1 => FamilyError::TooFew(trusses.len()),
            _ => FamilyError::Panels,
        })
    }

    /// How many designs there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.places.len()
    }

    /// Vertex indices, three a face, counter-clockwise in all embeddings.
    #[must_use]
    pub fn faces(&self) -> &Arc<[[u32; 3]]> {
        &self.faces
    }

    /// For each design where its vertices are.
    #[must_use]
    pub fn places(&self) -> &[Vec<DVec2>] {
        &self.places
    }

    /// Bars that lie in no face.
    #[must_use]
    pub fn elements(&self) -> &[BarElement] {
        &self.elements
    }

    /// The closed boundary walks of the faces, as vertex indices.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        self.connectivity.boundary_loops(&self.faces)
    }

    /// Two of the designs.
    ///
    /// # Panics
    /// If there are not so many.
    #[must_use]
    pub fn pair(&self, source: usize, target: usize) -> CompatibleMesh {
        self.between([source, target].map(|design| self.places[design].clone()))
    }

    /// The mesh with other vertices, such as two blends of the designs, which may fold.
    pub(crate) fn between(&self, [source, target]: [Vec<DVec2>; 2]) -> CompatibleMesh {
        CompatibleMesh {
            faces: Arc::clone(&self.faces),
            source,
            target,
            elements: self.elements.clone(),
            connectivity: self.connectivity.clone(),
        }
    }

    /// The largest diameter of a design.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        let diameters = self.places.iter().map(|places| Bounds::diameter_of(places));
        diameters.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests;
