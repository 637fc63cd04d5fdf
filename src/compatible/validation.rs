//! Checks faces, bars and vertices before they become a compatible mesh, and defines the errors for
//! invalid ones.

use super::truss::{TrussError, list_first};
use crate::geometry::{DVec2, Side, orient2d};
use crate::mesh::MeshError;

/// Bar as a two-point element of the energy, given by its two vertices.
pub type BarElement = [u32; 2];

/// Reason why two designs, as given, have no common triangulation. Messages count from 1, as the
/// files do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompatibleError {
    /// The designs have different numbers of vertices.
    #[error("the source has {} vertices and the target {}; both need the same vertices in the same order", .0[0], .0[1])]
    VertexCounts([usize; 2]),
    /// The designs have different numbers of faces.
    #[error("the source has {} faces and the target {}; both need the same faces in the same order", .0[0], .0[1])]
    FaceCounts([usize; 2]),
    /// A face differs between the designs.
    #[error("face {} differs between source and target; both need the same faces in the same order", .0 + 1)]
    FacesDiffer(usize),
    /// A coordinate is NaN or infinite.
    #[error("vertex {} of the {side} is not a finite point; correct its coordinates", vertex + 1)]
    NotFinite {
        /// Design with the coordinate.
        side: Side,
        /// Index of the vertex.
        vertex: usize,
    },
    /// The faces form no valid mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// All faces have opposite orientation: one design is a mirror image of the other.
    #[error(
        "the target is a mirror image of the source; mirror one of them (placement, mirror = true)"
    )]
    Mirrored,
    /// Some faces have opposite orientation in the two designs.
    #[error("{}; move their vertices in one design, or mirror it if nearly all faces are listed", list(.0, "turned over between source and target"))]
    Flipped(Vec<usize>),
    /// Some faces have no area.
    #[error("{}; move the vertices apart", list(faces, &format!("flat in the {side}")))]
    Flat {
        /// Design with the flat faces.
        side: Side,
        /// Indices of the faces.
        faces: Vec<usize>,
    },
    /// A vertex belongs to no face and no bar.
    #[error("vertex {} belongs to no face and no bar; remove it or connect it", .0 + 1)]
    LooseVertex(usize),
    /// A bar refers to a missing vertex, joins a vertex to itself, or has no length.
    #[error("bar {} does not join two different points in both designs; correct or remove it", .0 + 1)]
    BadBar(usize),
    /// There are no faces and no bars.
    #[error("there are no faces and no bars; give at least one triangle or bar")]
    Empty,
    /// Two trusses are incompatible, or a panel cannot be triangulated.
    #[error(transparent)]
    Truss(#[from] TrussError),
}

/// Formats face indices as "face 3 is …" or "faces 3, 4, 5 and 9 more are …".
fn list(faces: &[usize], what: &str) -> String {
    let numbers: Vec<usize> = faces.iter().map(|f| f + 1).collect();
    match numbers[..] {
        [face] => format!("face {face} is {what}"),
        // Five faces show the place; a fold of thousands would fill the screen.
        _ => format!("faces {} are {what}", list_first(&numbers, 5)),
    }
}

/// Checks that all coordinates are finite.
pub(super) fn check_points(points: &[DVec2], side: Side) -> Result<(), CompatibleError> {
    let bad = points.iter().position(|p| !p.is_finite());
    bad.map_or(Ok(()), |vertex| {
        Err(CompatibleError::NotFinite { side, vertex })
    })
}

/// Checks that every bar joins two vertices that lie apart in both designs.
pub(super) fn check_elements(
    elements: &[BarElement],
    source: &[DVec2],
    target: &[DVec2],
) -> Result<(), CompatibleError> {
    let is_valid = |&[a, b]: &BarElement| {
        let (a, b) = (a as usize, b as usize);
        a < source.len() && b < source.len() && source[a] != source[b] && target[a] != target[b]
    };
    let bad = elements.iter().position(|bar| !is_valid(bar));
    bad.map_or(Ok(()), |bar| Err(CompatibleError::BadBar(bar)))
}

/// Returns the faces with counter-clockwise orientation in the source, and therefore in the target.
///
/// # Errors
/// [`CompatibleError`] for faces without area and for faces with opposite orientation.
pub(super) fn oriented(
    mut faces: Vec<[u32; 3]>,
    source: &[DVec2],
    target: &[DVec2],
) -> Result<Vec<[u32; 3]>, CompatibleError> {
    let area = |face: &[u32; 3], points: &[DVec2]| {
        let [a, b, c] = face.map(|v| points[v as usize]);
        orient2d(a, b, c)
    };
    // Checked first, because a flat face has no orientation.
    for (points, side) in [(source, Side::Source), (target, Side::Target)] {
        let flat = indices(&faces, |face| area(face, points) == 0.0);
        if !flat.is_empty() {
            return Err(CompatibleError::Flat { side, faces: flat });
        }
    }
    // Counter-clockwise in the source, so that only the target can still disagree.
    for face in &mut faces {
        if area(face, source) < 0.0 {
            face.swap(1, 2);
        }
    }
    let flipped = indices(&faces, |face| area(face, target) < 0.0);
    if flipped.is_empty() {
        Ok(faces)
    } else if flipped.len() == faces.len() {
        Err(CompatibleError::Mirrored)
    } else {
        Err(CompatibleError::Flipped(flipped))
    }
}

/// Returns the indices of the faces for which `bad` holds.
fn indices(faces: &[[u32; 3]], bad: impl Fn(&[u32; 3]) -> bool) -> Vec<usize> {
    (0..faces.len()).filter(|&f| bad(&faces[f])).collect()
}

/// Checks that every vertex belongs to a face or a bar.
pub(super) fn check_no_loose_vertex(
    faces: &[[u32; 3]],
    elements: &[BarElement],
    vertices: usize,
) -> Result<(), CompatibleError> {
    if faces.is_empty() && elements.is_empty() {
        return Err(CompatibleError::Empty);
    }
    let mut is_used = vec![false; vertices];
    for &v in faces.iter().flatten().chain(elements.iter().flatten()) {
        is_used[v as usize] = true;
    }
    let loose = is_used.iter().position(|h| !h);
    loose.map_or(Ok(()), |vertex| Err(CompatibleError::LooseVertex(vertex)))
}
