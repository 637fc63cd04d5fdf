//! A mesh with two embeddings: one list of faces with the positions of their vertices in source and
//! target.

use super::polygon_faces::common_triangles;
use super::truss;
use super::validation;
use super::validation::{BarElement, CompatibleError};
use crate::design::Truss;
use crate::geometry::{Bounds, DMat2, DVec2, Side, orient2d};
use crate::mesh::{
    Connectivity, Subdivision, TooManyVertices, TriangleMesh, check_faces, components,
};
use crate::work::progress::Progress;
use std::sync::Arc;

/// One list of faces with two embeddings, source and target.
#[derive(Clone, Debug)]
pub struct CompatibleMesh {
    pub(super) faces: Arc<[[u32; 3]]>,
    pub(super) source: Vec<DVec2>,
    pub(super) target: Vec<DVec2>,
    /// Bars that lie in no face. Each counts as a two-point element in the energy of a warp.
    pub(super) elements: Vec<BarElement>,
    pub(super) connectivity: Connectivity,
}

impl CompatibleMesh {
    /// Creates a mesh from faces, the positions of their vertices in source and target, and bars
    /// that lie in no face. Faces that are clockwise in both embeddings are reversed.
    ///
    /// # Errors
    /// [`CompatibleError`] if the embeddings have different lengths, a coordinate is not finite, a
    /// face is flat in one embedding or has opposite orientations in the two, a bar has no length,
    /// or a vertex belongs to no face and no bar.
    ///
    /// ```
    /// use morphospace::{compatible::CompatibleMesh, geometry::DVec2};
    /// let source = vec![DVec2::ZERO, DVec2::X, DVec2::Y];
    /// let target = source.iter().map(|&p| 2.0 * p).collect();
    /// let mesh = CompatibleMesh::new(vec![[0, 1, 2]], source, target, vec![])?;
    /// assert_eq!(mesh.faces().len(), 1);
    /// # Ok::<(), morphospace::compatible::CompatibleError>(())
    /// ```
    pub fn new(
        faces: Vec<[u32; 3]>,
        source: Vec<DVec2>,
        target: Vec<DVec2>,
        elements: Vec<BarElement>,
    ) -> Result<Self, CompatibleError> {
        if source.len() != target.len() {
            return Err(CompatibleError::VertexCounts([source.len(), target.len()]));
        }
        // Each check relies on the checks before it.
        validation::check_points(&source, Side::Source)?;
        validation::check_points(&target, Side::Target)?;
        check_faces(&faces, source.len())?;
        validation::check_elements(&elements, &source, &target)?;
        let faces = validation::orient_faces(faces, &source, &target)?;
        validation::check_no_loose_vertex(&faces, &elements, source.len())?;
        let connectivity = Connectivity::new(&faces).map_err(crate::mesh::MeshError::from)?;
        Ok(Self {
            faces: faces.into(),
            source,
            target,
            elements,
            connectivity,
        })
    }

    /// Creates a mesh from two meshes that have the same faces in the same order. The direction in
    /// which a face lists its vertices does not matter. Faces with more than three vertices are
    /// divided into the same triangles in both.
    ///
    /// # Errors
    /// [`CompatibleError::FaceCounts`] or [`CompatibleError::FacesDiffer`] if the faces differ,
    /// [`CompatibleError::NoTriangulation`] for a face without common triangles. Otherwise as
    /// [`Self::new`]. Faces are counted as the meshes list them.
    pub fn from_meshes(
        source: &TriangleMesh,
        target: &TriangleMesh,
    ) -> Result<Self, CompatibleError> {
        let faces = common_triangles(&[source, target])?;
        let places = [source, target].map(|mesh| mesh.positions().to_vec());
        let [in_source, in_target] = places;
        Self::new(faces, in_source, in_target, Vec::new())
            .map_err(|error| error.with_faces(&|face| source.listed_face(face)))
    }

    /// Creates a mesh from two trusses with the same nodes and bars. Panels (areas enclosed by
    /// bars) are triangulated. Bars that lie in no panel become two-point elements.
    ///
    /// # Errors
    /// [`CompatibleError::Truss`] names the first difference between the trusses or the panel that
    /// cannot be triangulated in both designs, or reports that the work was cancelled. Otherwise as
    /// [`Self::new`].
    pub fn from_trusses(
        source: &Truss,
        target: &Truss,
        progress: &dyn Progress,
    ) -> Result<Self, CompatibleError> {
        let (faces, elements) = truss::triangulate_panels(source, target, progress)?;
        let (source, target) = (source.nodes().to_vec(), target.nodes().to_vec());
        Self::new(faces, source, target, elements)
    }

    /// Vertex indices of the faces, counter-clockwise in both embeddings.
    #[must_use]
    pub fn faces(&self) -> &Arc<[[u32; 3]]> {
        &self.faces
    }

    /// Vertex positions in the source.
    #[must_use]
    pub fn source(&self) -> &[DVec2] {
        &self.source
    }

    /// Vertex positions in the target.
    #[must_use]
    pub fn target(&self) -> &[DVec2] {
        &self.target
    }

    /// Bars that lie in no face, as pairs of vertex indices.
    #[must_use]
    pub fn elements(&self) -> &[BarElement] {
        &self.elements
    }

    /// Which faces meet at which edges.
    #[must_use]
    pub fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    /// Closed boundary loops of the faces, each as the indices of its vertices in order.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        self.connectivity.boundary_loops(&self.faces)
    }

    /// For each vertex, the index of its connected part. Faces and bars connect vertices.
    #[must_use]
    pub fn components(&self) -> Vec<u32> {
        // Two edges of a face are enough to connect its corners.
        let face_edges = self.faces.iter().flat_map(|&[a, b, c]| [[a, b], [a, c]]);
        let links = face_edges.chain(self.elements.iter().copied());
        components(self.source.len(), links)
    }

    /// Smallest axis-parallel box around both embeddings.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.source.iter().chain(&self.target).copied())
            .unwrap_or_else(|| unreachable!("a compatible mesh has vertices"))
    }

    /// Larger diameter of the two embeddings, in units of the plane.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        Bounds::diameter_of(&self.source).max(Bounds::diameter_of(&self.target))
    }

    /// Conformal distortion from source to target, 1 or more. The distortion of a face is σ₁/σ₂,
    /// the ratio of the singular values of its affine map; it is 1 for a similarity. The result is
    /// the largest distortion of a face, apart from the ignored faces, and 1 for a mesh without
    /// faces.
    ///
    /// The weight of a face is the mean of its shares of the source's and the target's area. The
    /// worst faces, up to the fraction `ignored_area` of the total weight, are ignored.
    #[must_use]
    pub fn distortion(&self, ignored_area: f64) -> f64 {
        let edges = |points: &[DVec2], face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| points[v as usize]);
            DMat2::from_cols(b - a, c - a)
        };
        let face_distortion = |face| {
            let [p, q] = [&self.source, &self.target].map(|points| edges(points, face));
            // J is the Jacobian of the face's affine map. Because |J|² = σ₁² + σ₂² and det J =
            // σ₁σ₂, the mean of r = σ₁/σ₂ and 1/r is |J|² / (2 det J). The edge matrix p is
            // invertible, because the face is positive in the source.
            let j = q * p.inverse();
            let square = j.x_axis.length_squared() + j.y_axis.length_squared();
            let mean = 0.5 * square / j.determinant();
            (mean, [p, q].map(|edges| edges.determinant()))
        };
        let mut faces: Vec<(f64, [f64; 2])> = self.faces.iter().map(face_distortion).collect();
        // The worst faces come first. They are skipped until their total weight exceeds
        // `ignored_area`.
        faces.sort_by(|a, b| b.0.total_cmp(&a.0));
        let total = |side: usize| faces.iter().map(|face| face.1[side]).sum::<f64>();
        let totals = [total(0), total(1)];
        let mut share = 0.0;
        let mut is_beyond = |face: &&(f64, [f64; 2])| {
            share += 0.5 * (face.1[0] / totals[0] + face.1[1] / totals[1]);
            share > ignored_area
        };
        let mean = faces
            .iter()
            .find(|face| is_beyond(face))
            .map_or(1.0, |face| face.0);
        // Solves mean = (r + 1/r) / 2 for r; rounding may leave the mean slightly below 1.
        mean + (mean * mean - 1.0).max(0.0).sqrt()
    }

    /// Returns the mesh with source and target exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            source: self.target.clone(),
            target: self.source.clone(),
            ..self.clone()
        }
    }

    /// Returns the mesh with each connected part translated. `by[part]` contains the offset in the
    /// source and the offset in the target. `None` if rounding makes a face flat or turns it over.
    pub(crate) fn with_parts_translated(&self, by: &[[DVec2; 2]]) -> Option<Self> {
        let parts = self.components();
        let translated = |side: Side, points: &[DVec2]| -> Vec<DVec2> {
            let places = points.iter().zip(&parts);
            places
                .map(|(&p, &part)| p + by[part as usize][side])
                .collect()
        };
        let mesh = Self {
            source: translated(Side::Source, &self.source),
            target: translated(Side::Target, &self.target),
            ..self.clone()
        };
        let is_positive = |points: &[DVec2]| {
            let corners = mesh
                .faces
                .iter()
                .map(|face| face.map(|v| points[v as usize]));
            corners.into_iter().all(|[a, b, c]| orient2d(a, b, c) > 0.0)
        };
        // Translations preserve shapes, but rounding may flip a face that is nearly flat.
        (is_positive(&mesh.source) && is_positive(&mesh.target)).then_some(mesh)
    }

    /// Splits every face into four at its edge midpoints, `rounds` times. The shapes stay the same
    /// in both designs. Existing vertices keep their indices; new vertices follow them.
    ///
    /// # Errors
    /// [`TooManyVertices`] if the result would have more vertices than a mesh may have.
    pub fn subdivided(&self, rounds: u32) -> Result<Self, TooManyVertices> {
        if rounds == 0 || self.faces.is_empty() {
            return Ok(self.clone());
        }
        let fine = Subdivision::new(&self.faces, self.source.len(), rounds)?;
        let extend = |points: &[DVec2]| {
            let mut all = points.to_vec();
            // The midpoints are listed in the order of creation: a later round halves edges that an
            // earlier round created.
            for &[a, b] in &fine.midpoints {
                all.push(all[a as usize].midpoint(all[b as usize]));
            }
            all
        };
        let connectivity = Connectivity::new(&fine.faces)
            .unwrap_or_else(|_| unreachable!("splitting keeps a manifold"));
        Ok(Self {
            source: extend(&self.source),
            target: extend(&self.target),
            faces: fine.faces.into(),
            elements: self.elements.clone(),
            connectivity,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (Vec<[u32; 3]>, Vec<DVec2>) {
        let points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        (vec![[0, 1, 2], [0, 2, 3]], points.map(DVec2::from).to_vec())
    }

    #[test]
    fn faces_clockwise_in_both_are_reversed() {
        let (faces, points) = square();
        let clockwise = faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mesh = CompatibleMesh::new(clockwise, points.clone(), points, vec![]).expect("valid");
        assert_eq!(mesh.boundary_loops(), vec![vec![0, 1, 2, 3]]);
    }

    #[test]
    fn mirrored_flipped_and_flat_faces_give_different_errors() {
        let (faces, points) = square();
        let mirrored = points.iter().map(|p| DVec2::new(-p.x, p.y)).collect();
        assert_eq!(
            CompatibleMesh::new(faces.clone(), points.clone(), mirrored, vec![]).map(|_| ()),
            Err(CompatibleError::Mirrored)
        );
        let mut folded = points.clone();
        folded[3] = DVec2::new(2.0, 0.0);
        assert_eq!(
            CompatibleMesh::new(faces.clone(), points.clone(), folded, vec![]).map(|_| ()),
            Err(CompatibleError::Flipped(vec![1]))
        );
        let mut flat = points.clone();
        flat[3] = DVec2::new(0.5, 0.5);
        assert_eq!(
            CompatibleMesh::new(faces, flat, points, vec![]).map(|_| ()),
            Err(CompatibleError::Flat {
                side: Side::Source,
                faces: vec![1]
            })
        );
    }

    #[test]
    fn a_loose_vertex_is_named_in_the_error() {
        let (faces, mut points) = square();
        points.push(DVec2::new(5.0, 5.0));
        assert_eq!(
            CompatibleMesh::new(faces, points.clone(), points, vec![]).map(|_| ()),
            Err(CompatibleError::LooseVertex(4))
        );
    }

    #[test]
    fn subdivision_keeps_area_and_counts() {
        let (faces, points) = square();
        let mesh = CompatibleMesh::new(faces, points.clone(), points, vec![]).expect("valid");
        let fine = mesh.subdivided(2).expect("small");
        assert_eq!(fine.faces().len(), 32);
        assert_eq!(fine.source().len(), 25);
        let area: f64 = fine
            .faces()
            .iter()
            .map(|f| {
                let [a, b, c] = f.map(|v| fine.source()[v as usize]);
                crate::geometry::twice_signed_area(a, b, c)
            })
            .sum();
        assert!((area - 2.0).abs() < 1e-12);
        assert!(mesh.subdivided(20).is_err());
    }
}
