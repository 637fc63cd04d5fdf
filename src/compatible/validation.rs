//! Checks faces, bars and vertices before they become a compatible mesh; defines the errors for
//! invalid ones.

use super::truss::{TrussError, list_first};
use crate::geometry::{DVec2, Side, orient2d};
use crate::mesh::MeshError;

/// Bar of a truss that counts as a two-point element in the energy of a warp: its two vertex
/// indices.
pub type BarElement = [u32; 2];

/// Reason why two designs, as given, have no common triangulation. Indices start at 0 in fields and
/// at 1 in messages, as in mesh files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompatibleError {
    /// Source and target have different numbers of vertices. The field contains both numbers.
    #[error("the source has {} vertices and the target {}; both need the same vertices in the same order", .0[0], .0[1])]
    VertexCounts([usize; 2]),
    /// Source and target have different numbers of faces. The field contains both numbers.
    #[error("the source has {} faces and the target {}; both need the same faces in the same order", .0[0], .0[1])]
    FaceCounts([usize; 2]),
    /// The face with this index has different vertices in the two designs.
    #[error("face {} differs between source and target; both need the same faces in the same order", .0 + 1)]
    FacesDiffer(usize),
    /// The face with this index has more than three vertices, and no way to divide it into
    /// triangles is valid in both designs.
    #[error("face {} cannot be divided into triangles that are valid in both designs; divide it in the files", .0 + 1)]
    NoTriangulation(usize),
    /// A coordinate is NaN or infinite.
    #[error("vertex {} of the {side} is not a finite point; correct its coordinates", vertex + 1)]
    NotFinite {
        /// Design that contains the vertex.
        side: Side,
        /// Index of the vertex with the invalid coordinate.
        vertex: usize,
    },
    /// The faces form no valid mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// All faces have opposite orientation in the two designs: one design is a mirror image of the
    /// other.
    #[error(
        "the target is a mirror image of the source; mirror one of them (placement, mirror = true)"
    )]
    Mirrored,
    /// The faces with these indices have opposite orientation in the two designs.
    #[error("{}; move their vertices in one design, or mirror it if nearly all faces are listed", list(.0, "turned over between source and target"))]
    Flipped(Vec<usize>),
    /// Some faces have no area in one design.
    #[error("{}; move the vertices apart", list(faces, &format!("flat in the {side}")))]
    Flat {
        /// Design in which the faces are flat.
        side: Side,
        /// Indices of the faces without area.
        faces: Vec<usize>,
    },
    /// The vertex with this index belongs to no face and no bar.
    #[error("vertex {} belongs to no face and no bar; remove it or connect it", .0 + 1)]
    LooseVertex(usize),
    /// The bar with this index refers to a missing vertex, joins a vertex to itself, or has no
    /// length in one of the designs.
    #[error("bar {} does not join two different points in both designs; correct or remove it", .0 + 1)]
    BadBar(usize),
    /// There are no faces and no bars.
    #[error("there are no faces and no bars; give at least one triangle or bar")]
    Empty,
    /// Two trusses are incompatible, or a panel cannot be triangulated.
    #[error(transparent)]
    Truss(#[from] TrussError),
}

impl CompatibleError {
    /// Returns the error with other indices of faces: `listed` maps the index of a triangle to that
    /// of the face to which it belongs.
    pub(super) fn with_faces(self, listed: &dyn Fn(usize) -> usize) -> Self {
        let all = |triangles: Vec<usize>| {
            let mut faces: Vec<usize> = triangles.into_iter().map(listed).collect();
            faces.dedup();
            faces
        };
        match self {
            Self::Flipped(faces) => Self::Flipped(all(faces)),
            Self::Flat { side, faces } => Self::Flat {
                side,
                faces: all(faces),
            },
            Self::Mesh(error) => Self::Mesh(error.with_faces(listed)),
            other => other,
        }
    }
}

/// Formats face indices, which count from 0, as "face 3 is …" or "faces 3, 4, … and 9 more are …",
/// which count from 1.
fn list(faces: &[usize], what: &str) -> String {
    let numbers: Vec<usize> = faces.iter().map(|f| f + 1).collect();
    match numbers[..] {
        [face] => format!("face {face} is {what}"),
        // Only the first five faces are listed, because a list of thousands would fill the screen.
        // Five show where the problem is.
        _ => format!("faces {} are {what}", list_first(&numbers, 5)),
    }
}

/// Checks that all coordinates of one design are finite.
pub(super) fn check_points(points: &[DVec2], side: Side) -> Result<(), CompatibleError> {
    let bad = points.iter().position(|p| !p.is_finite());
    bad.map_or(Ok(()), |vertex| {
        Err(CompatibleError::NotFinite { side, vertex })
    })
}

/// Checks that every bar joins two existing vertices that lie at different points in both designs.
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

/// Returns the faces, reversed where necessary so that all are counter-clockwise in the source. All
/// are then counter-clockwise in the target too, or the result is an error.
///
/// # Errors
/// [`CompatibleError`] if a face has no area in a design, or has opposite orientation in the two
/// designs.
pub(super) fn orient_faces(
    mut faces: Vec<[u32; 3]>,
    source: &[DVec2],
    target: &[DVec2],
) -> Result<Vec<[u32; 3]>, CompatibleError> {
    let area = |face: &[u32; 3], points: &[DVec2]| {
        let [a, b, c] = face.map(|v| points[v as usize]);
        orient2d(a, b, c)
    };
    // This check comes first, because a flat face has no orientation.
    for (points, side) in [(source, Side::Source), (target, Side::Target)] {
        let flat = indices(&faces, |face| area(face, points) == 0.0);
        if !flat.is_empty() {
            return Err(CompatibleError::Flat { side, faces: flat });
        }
    }
    // After this loop all faces are counter-clockwise in the source; faces may still be clockwise
    // in the target only.
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
