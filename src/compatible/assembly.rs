//! Meshes in two designs put together into one.

use crate::geometry::DVec2;

/// Vertices in source and target, and the faces between them.
#[derive(Default)]
pub(super) struct MeshAssembly {
    pub(super) points: [Vec<DVec2>; 2],
    pub(super) faces: Vec<[u32; 3]>,
}

impl MeshAssembly {
    /// Adds a mesh. Its first vertices are there already, numbered as
    /// `shared` says; the others follow those that there are.
    ///
    /// # Panics
    /// If the mesh has fewer vertices than are shared.
    pub(super) fn add(
        &mut self,
        shared: &[u32],
        points: [&[DVec2]; 2],
        faces: impl Iterator<Item = [u32; 3]>,
    ) {
        let own = self.points[0].len() as u32;
        let number = |v: u32| match shared.get(v as usize) {
            Some(&there) => there,
            None => own + v - shared.len() as u32,
        };
        self.faces.extend(faces.map(|face| face.map(number)));
        for (all, points) in self.points.iter_mut().zip(points) {
            all.extend_from_slice(&points[shared.len()..]);
        }
    }
}
