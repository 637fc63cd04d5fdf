//! What is checked before faces and bars become a compatible mesh, and the
//! errors that say so.

use super::truss::{TrussError, list_first};
use crate::geometry::{DVec2, Side, orient2d};
use crate::mesh::MeshError;

/// A bar as a two-point element of the energy: its vertices.
pub type BarElement = [u32; 2];

/// Why two designs have no common triangulation as given. Numbers in messages
/// start at 1, as in the files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompatibleError {
    /// Different numbers of vertices.
    #[error("the source has {} vertices and the target {}; both need the same vertices in the same order", .0[0], .0[1])]
    VertexCounts([usize; 2]),
    /// Different numbers of faces.
    #[error("the source has {} faces and the target {}; both need the same faces in the same order", .0[0], .0[1])]
    FaceCounts([usize; 2]),
    /// A face is not the same in both.
    #[error("face {} differs between source and target; both need the same faces in the same order", .0 + 1)]
    FacesDiffer(usize),
    /// A coordinate is NaN or infinite.
    #[error("vertex {} of the {side} is not a finite point; correct its coordinates", vertex + 1)]
    NotFinite {
        /// In which design.
        side: Side,
        /// The vertex.
        vertex: usize,
    },
    /// The faces themselves are wrong.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// All faces change sides: one design is a mirror image of the other.
    #[error(
        "the target is a mirror image of the source; mirror one of them (placement, mirror = true)"
    )]
    Mirrored,
    /// Some faces change sides.
    #[error("{}; move their vertices in one design, or mirror it if nearly all are named", list(.0, "turned over between source and target"))]
    Flipped(Vec<usize>),
    /// Faces without area.
    #[error("{}; move their vertices apart", list(faces, &format!("without area in the {side}")))]
    Flat {
        /// In which design.
        side: Side,
        /// The faces.
        faces: Vec<usize>,
    },
    /// A vertex in no face and no bar.
    #[error("vertex {} belongs to no face and no bar; remove it or connect it", .0 + 1)]
    LooseVertex(usize),
    /// A bar that names no vertex, or one vertex twice, or has no length.
    #[error("bar {} joins no two different points in both designs; correct or remove it", .0 + 1)]
    BadBar(usize),
    /// Nothing to interpolate.
    #[error("there are no faces and no bars; give at least one triangle or bar")]
    Empty,
    /// Two trusses do not fit together, or a panel cannot be triangulated.
    #[error(transparent)]
    Truss(#[from] TrussError),
}

/// "face 3 is …" or "faces 3, 4, 5 and 9 more are …".
fn list(faces: &[usize], what: &str) -> String {
    let numbers: Vec<usize> = faces.iter().map(|f| f + 1).collect();
    match numbers[..] {
        [face] => format!("face {face} is {what}"),
        // Five lead to the place; a fold of thousands would fill the screen.
        _ => format!("faces {} are {what}", list_first(&numbers, 5)),
    }
}

pub(super) fn check_points(points: &[DVec2], side: Side) -> Result<(), CompatibleError> {
    let bad = points.iter().position(|p| !p.is_finite());
    bad.map_or(Ok(()), |vertex| {
        Err(CompatibleError::NotFinite { side, vertex })
    })
}

pub(super) fn check_elements(
    elements: &[BarElement],
    source: &[DVec2],
    target: &[DVec2],
) -> Result<(), CompatibleError> {
    let good = |&[a, b]: &BarElement| {
        let (a, b) = (a as usize, b as usize);
        a < source.len() && b < source.len() && source[a] != source[b] && target[a] != target[b]
    };
    let bad = elements.iter().position(|bar| !good(bar));
    bad.map_or(Ok(()), |bar| Err(CompatibleError::BadBar(bar)))
}

/// The faces, counter-clockwise in the source and so in the target.
pub(super) fn oriented(
    mut faces: Vec<[u32; 3]>,
    source: &[DVec2],
    target: &[DVec2],
) -> Result<Vec<[u32; 3]>, CompatibleError> {
    let area = |face: &[u32; 3], points: &[DVec2]| {
        let [a, b, c] = face.map(|v| points[v as usize]);
        orient2d(a, b, c)
    };
    // First: a face without area is of neither orientation.
    for (points, side) in [(source, Side::Source), (target, Side::Target)] {
        let flat = indices(&faces, |face| area(face, points) == 0.0);
        if !flat.is_empty() {
            return Err(CompatibleError::Flat { side, faces: flat });
        }
    }
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

fn indices(faces: &[[u32; 3]], bad: impl Fn(&[u32; 3]) -> bool) -> Vec<usize> {
    (0..faces.len()).filter(|&f| bad(&faces[f])).collect()
}

pub(super) fn check_no_loose_vertex(
    faces: &[[u32; 3]],
    elements: &[BarElement],
    vertices: usize,
) -> Result<(), CompatibleError> {
    if faces.is_empty() && elements.is_empty() {
        return Err(CompatibleError::Empty);
    }
    let mut held = vec![false; vertices];
    for &v in faces.iter().flatten().chain(elements.iter().flatten()) {
        held[v as usize] = true;
    }
    let loose = held.iter().position(|h| !h);
    loose.map_or(Ok(()), |vertex| Err(CompatibleError::LooseVertex(vertex)))
}
