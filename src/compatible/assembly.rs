//! Assembles one mesh in two designs from smaller meshes that share vertices.

use crate::geometry::DVec2;

/// Mesh under construction: the vertex positions in source and target, and the faces.
#[derive(Default)]
pub(super) struct MeshAssembly {
    pub(super) points: [Vec<DVec2>; 2],
    pub(super) faces: Vec<[u32; 3]>,
}

impl MeshAssembly {
    /// Appends a mesh with vertex positions `points` and faces `faces`. The first vertices of the
    /// appended mesh are already present, at the indices `shared`; its other vertices get new
    /// indices.
    ///
    /// # Panics
    /// If the mesh has fewer vertices than `shared`.
    pub(super) fn append(
        &mut self,
        shared: &[u32],
        points: [&[DVec2]; 2],
        faces: impl Iterator<Item = [u32; 3]>,
    ) {
        let offset = self.points[0].len() as u32;
        // The first vertices of the appended mesh exist already. The others get indices after all
        // present vertices.
        let new_index = |v: u32| match shared.get(v as usize) {
            Some(&existing) => existing,
            None => offset + v - shared.len() as u32,
        };
        self.faces.extend(faces.map(|face| face.map(new_index)));
        for (all, points) in self.points.iter_mut().zip(points) {
            all.extend_from_slice(&points[shared.len()..]);
        }
    }
}
