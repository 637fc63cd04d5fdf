//! Compatible triangulation: one list of faces, two embeddings; of a [`CompatibleFamily`] many.
//!
//! [`CompatibleMesh`] guarantees that every face is positively oriented in
//! both embeddings, by exact predicates, so that each local map has a
//! positive determinant. It does not promise that faces do not overlap: a
//! spiral may lie over itself.

mod assembly;
mod border;
mod family;
mod frame_outlines;
mod outlines;
mod polygons;
mod truss;
mod validation;

pub use family::{CompatibleFamily, FamilyError};
pub use outlines::OutlineMeshError;
pub(crate) use outlines::{merged_meshes, mesh_of_piece};
pub(crate) use polygons::slide_outlines;
pub use polygons::{FramePinsError, PieceEdge, PieceMeshError, PolygonOptions};
pub use validation::{BarElement, CompatibleError};

pub use frame_outlines::FrameOutlinesError;
pub use truss::TrussError;

use crate::design::Truss;
use crate::geometry::{Bounds, DMat2, DVec2, Side, orient2d};
use crate::mesh::{
    Connectivity, Subdivision, TooManyVertices, TriangleMesh, check_faces, components,
};
use crate::work::progress::Progress;
use std::sync::Arc;

/// One connectivity with its two embeddings.
#[derive(Clone, Debug)]
pub struct CompatibleMesh {
    faces: Arc<[[u32; 3]]>,
    source: Vec<DVec2>,
    target: Vec<DVec2>,
    /// Two-point elements: bars that lie in no panel.
    elements: Vec<BarElement>,
    connectivity: Connectivity,
}

impl CompatibleMesh {
    /// Joins faces and two embeddings of their vertices, with bars that lie
    /// in no face as further elements. Faces that are clockwise in both
    /// embeddings are turned round.
    ///
    /// # Errors
    /// [`CompatibleError`] if the embeddings differ in number, a face is not
    /// positive in both, or a vertex is held by nothing.
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
        // In this order each check may rely on what those before it made sure of.
        validation::check_points(&source, Side::Source)?;
        validation::check_points(&target, Side::Target)?;
        check_faces(&faces, source.len())?;
        validation::check_elements(&elements, &source, &target)?;
        let faces = validation::oriented(faces, &source, &target)?;
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

    /// Two meshes whose faces are the same, number by number.
    ///
    /// # Errors
    /// [`CompatibleError`] names the first face that differs, or what
    /// [`Self::new`] finds.
    pub fn from_meshes(
        source: &TriangleMesh,
        target: &TriangleMesh,
    ) -> Result<Self, CompatibleError> {
        let (a, b) = (source.faces(), target.faces());
        if a.len() != b.len() {
            return Err(CompatibleError::FaceCounts([a.len(), b.len()]));
        }
        if let Some(face) = (0..a.len()).find(|&f| !same_face(a[f], b[f])) {
            return Err(CompatibleError::FacesDiffer(face));
        }
        Self::new(
            a.to_vec(),
            source.positions().to_vec(),
            target.positions().to_vec(),
            Vec::new(),
        )
    }

    /// Two trusses with the same nodes and bars: the panels between the bars
    /// are triangulated, bars in no panel become elements.
    ///
    /// # Errors
    /// [`CompatibleError::Truss`] names the first difference or the panel that
    /// cannot be triangulated in both, or tells of a cancel; otherwise what
    /// [`Self::new`] finds.
    pub fn from_trusses(
        source: &Truss,
        target: &Truss,
        progress: &dyn Progress,
    ) -> Result<Self, CompatibleError> {
        let (faces, elements) = truss::triangulate_panels(source, target, progress)?;
        let (source, target) = (source.nodes().to_vec(), target.nodes().to_vec());
        Self::new(faces, source, target, elements)
    }

    /// Vertex indices, three a face, counter-clockwise in both embeddings.
    #[must_use]
    pub fn faces(&self) -> &Arc<[[u32; 3]]> {
        &self.faces
    }

    /// The vertices in the source.
    #[must_use]
    pub fn source(&self) -> &[DVec2] {
        &self.source
    }

    /// The vertices in the target.
    #[must_use]
    pub fn target(&self) -> &[DVec2] {
        &self.target
    }

    /// Bars that lie in no face.
    #[must_use]
    pub fn elements(&self) -> &[BarElement] {
        &self.elements
    }

    /// Which faces meet at which edges.
    #[must_use]
    pub fn connectivity(&self) -> &Connectivity {
        &self.connectivity
    }

    /// The closed boundary walks of the faces, as vertex indices.
    #[must_use]
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        self.connectivity.boundary_loops(&self.faces)
    }

    /// For each vertex the number of its connected part; faces join, and bars
    /// do.
    #[must_use]
    pub fn components(&self) -> Vec<u32> {
        // Two of a face's three edges join its corners.
        let face_edges = self.faces.iter().flat_map(|&[a, b, c]| [[a, b], [a, c]]);
        let links = face_edges.chain(self.elements.iter().copied());
        components(self.source.len(), links)
    }

    /// The smallest box around both embeddings.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.source.iter().chain(&self.target).copied())
            .unwrap_or_else(|| unreachable!("a compatible mesh has vertices"))
    }

    /// The larger of the two embeddings' diameters.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        Bounds::diameter_of(&self.source).max(Bounds::diameter_of(&self.target))
    }

    /// How much the map between the embeddings distorts shapes: the largest
    /// σ₁/σ₂ of a face but for a share of the area, which is that of the source
    /// and of the target in equal parts; 1 for a similarity. Without faces 1.
    #[must_use]
    pub fn distortion(&self, but_for: f64) -> f64 {
        let edges = |points: &[DVec2], face: &[u32; 3]| {
            let [a, b, c] = face.map(|v| points[v as usize]);
            DMat2::from_cols(b - a, c - a)
        };
        let of = |face| {
            let [p, q] = [&self.source, &self.target].map(|points| edges(points, face));
            // |J|² is σ₁² + σ₂², det J is σ₁σ₂; p has an inverse, its face being
            // positive.
            let j = q * p.inverse();
            let square = j.x_axis.length_squared() + j.y_axis.length_squared();
            let mean = 0.5 * square / j.determinant();
            (mean, [p, q].map(|edges| edges.determinant()))
        };
        let mut faces: Vec<(f64, [f64; 2])> = self.faces.iter().map(of).collect();
        faces.sort_by(|a, b| b.0.total_cmp(&a.0));
        let total = |side: usize| faces.iter().map(|face| face.1[side]).sum::<f64>();
        let totals = [total(0), total(1)];
        let mut share = 0.0;
        let mut is_beyond = |face: &&(f64, [f64; 2])| {
            share += 0.5 * (face.1[0] / totals[0] + face.1[1] / totals[1]);
            share > but_for
        };
        let mean = faces
            .iter()
            .find(|face| is_beyond(face))
            .map_or(1.0, |face| face.0);
        // Of r and 1/r: rounding may leave it below 1.
        mean + (mean * mean - 1.0).max(0.0).sqrt()
    }

    /// The designs exchanged.
    #[must_use]
    pub fn swapped(&self) -> Self {
        Self {
            source: self.target.clone(),
            target: self.source.clone(),
            ..self.clone()
        }
    }

    /// With each connected part moved in the source and in the target; none if
    /// rounding turns a face over.
    pub(crate) fn with_parts_moved(&self, by: &[[DVec2; 2]]) -> Option<Self> {
        let parts = self.components();
        let moved = |side: Side, points: &[DVec2]| -> Vec<DVec2> {
            let places = points.iter().zip(&parts);
            places
                .map(|(&p, &part)| p + by[part as usize][side])
                .collect()
        };
        let moved = Self {
            source: moved(Side::Source, &self.source),
            target: moved(Side::Target, &self.target),
            ..self.clone()
        };
        let is_positive = |points: &[DVec2]| {
            let corners = moved
                .faces
                .iter()
                .map(|face| face.map(|v| points[v as usize]));
            corners.into_iter().all(|[a, b, c]| orient2d(a, b, c) > 0.0)
        };
        (is_positive(&moved.source) && is_positive(&moved.target)).then_some(moved)
    }

    /// Every face split into four, `rounds` times; neither shape changes,
    /// vertices keep their numbers and new ones follow.
    ///
    /// # Errors
    /// [`TooManyVertices`] beyond the limit.
    pub fn subdivided(&self, rounds: u32) -> Result<Self, TooManyVertices> {
        if rounds == 0 || self.faces.is_empty() {
            return Ok(self.clone());
        }
        let fine = Subdivision::new(&self.faces, self.source.len(), rounds)?;
        let extend = |points: &[DVec2]| {
            let mut all = points.to_vec();
            // In their order: a later round halves edges of an earlier one.
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

/// The same vertices, run either way: which way round a face is listed is
/// decided by its embeddings.
fn same_face(mut a: [u32; 3], mut b: [u32; 3]) -> bool {
    a.sort_unstable();
    b.sort_unstable();
    a == b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (Vec<[u32; 3]>, Vec<DVec2>) {
        let points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        (vec![[0, 1, 2], [0, 2, 3]], points.map(DVec2::from).to_vec())
    }

    #[test]
    fn clockwise_in_both_is_turned_round() {
        let (faces, points) = square();
        let clockwise = faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mesh = CompatibleMesh::new(clockwise, points.clone(), points, vec![]).expect("valid");
        assert_eq!(mesh.boundary_loops(), vec![vec![0, 1, 2, 3]]);
    }

    #[test]
    fn mirror_image_flipped_face_and_flat_face_are_told_apart() {
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
    fn a_loose_vertex_is_named() {
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
