//! Importer of Wavefront OBJ files as plane triangle meshes.
//!
//! Reads `v` lines (vertices) and `f` lines (faces); ignores names, groups, normals and texture
//! coordinates. Lines of other kinds, such as materials, curves and points, are reported. Vertices
//! keep their number and order, so two files with the same `f` lines give the same connectivity.
//! OBJ crates that renumber vertices by first use or per texture coordinate do not guarantee this,
//! and lose the numbers that error messages need.
//!
//! Faces with more than three vertices, also concave ones, are divided into triangles. Two files
//! with the same `f` lines need the same triangles, which [`CompatibleMesh::from_meshes`] finds.
//! The orientation of the faces is not checked here, but when two meshes are paired.
//!
//! [`CompatibleMesh::from_meshes`]: crate::compatible::CompatibleMesh::from_meshes

use super::note::ImportNote;
use crate::geometry::{DVec2, RANGE_MESSAGE, is_in_range};
use crate::mesh::{MeshError, PolygonFaces, TriangleMesh};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Error of importing an OBJ file. Lines, vertices and faces are counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// A line cannot be used.
    #[error("line {line}: {fault}")]
    Line {
        /// Number of the line, counted from 1.
        line: usize,
        /// Reason why the line cannot be used.
        fault: ObjFault,
    },
    /// A vertex belongs to no face. Holds the number of the vertex.
    #[error("vertex {0} belongs to no face; remove it or add the missing face")]
    Unused(usize),
    /// The file has no vertices or no faces.
    #[error("the mesh has {vertices} vertices and {faces} faces; it needs at least one triangle")]
    NoMesh {
        /// Number of vertices.
        vertices: usize,
        /// Number of faces.
        faces: usize,
    },
    /// The file has more vertices than 32-bit indices can address.
    #[error("the mesh has more than {} vertices; use a coarser mesh", u32::MAX)]
    TooMany,
    /// The faces do not form a valid mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Fault of a line that defines a vertex or a face. Vertices and faces are numbered from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjFault {
    /// A `v` line does not begin with two or three numbers. Holds the number of the vertex.
    #[error("vertex {0} needs the numbers x y z; correct the line")]
    Vertex(usize),
    /// A coordinate is not finite, or the absolute value of x or y exceeds [`MAX_COORDINATE`].
    /// Holds the number of the vertex.
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("vertex {0} {RANGE_MESSAGE}")]
    CoordinateRange(usize),
    /// The vertices do not all have the same z.
    #[error(
        "vertex {vertex} has z = {z}, but vertex 1 has z = {first}; flatten the mesh to constant z"
    )]
    NotFlat {
        /// Number of the vertex, counted from 1.
        vertex: usize,
        /// The z coordinate of that vertex.
        z: f64,
        /// The z coordinate of the first vertex.
        first: f64,
    },
    /// A face has a word that is not a vertex number. Holds the number of the face and the word,
    /// shortened.
    #[error("face {0} has \"{1}\" in place of a vertex number; correct the line")]
    Face(usize, String),
    /// A face has fewer than three vertices. Holds the number of the face.
    #[error("face {0} has fewer than three vertices; remove it or complete it")]
    TooFewCorners(usize),
    /// A face refers to a vertex that does not exist.
    #[error(
        "face {face} refers to vertex {named}, but there are {vertices} vertices; correct the face"
    )]
    OutOfRange {
        /// Number of the face, counted from 1.
        face: usize,
        /// Vertex number as written in the file.
        named: i64,
        /// Number of vertices in the file; if `named` is not positive, only those before the face.
        vertices: usize,
    },
    /// A face touches or crosses itself, or encloses no area. Holds the number of the face.
    #[error("face {0} touches or crosses itself, or encloses no area; correct or remove it")]
    NotSimple(usize),
    /// A face uses a vertex twice.
    #[error("face {face} uses vertex {vertex} twice; correct the face")]
    Repeated {
        /// Number of the face, counted from 1.
        face: usize,
        /// Number of the vertex, counted from 1.
        vertex: usize,
    },
}

/// Vertices and faces read so far.
#[derive(Default)]
struct ObjParser {
    /// Vertex positions in file order.
    positions: Vec<DVec2>,
    /// The z coordinate of the first vertex; all other vertices must have the same.
    first_z: f64,
    /// For each face: its line number, and the index in `corners` of its first vertex.
    polygons: Vec<(usize, usize)>,
    /// Vertex indices (from 0) of all faces in one list, because allocating a list per face
    /// would dominate the import time of large meshes.
    corners: Vec<i64>,
}

/// Maximum number of kinds of lines that are reported (resource limit: a hostile file could give
/// every line a new kind).
const MAX_KINDS: usize = 20;

/// Keywords of lines that change nothing in a plane mesh without materials: normals, texture
/// coordinates, names, and how its surface is shaded and refined.
const WITHOUT_EFFECT: [&str; 14] = [
    "vn",
    "vt",
    "g",
    "o",
    "s",
    "mg",
    "mtllib",
    "maplib",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
];

/// Imports the text of an OBJ file. Also returns notes on the lines that were ignored.
///
/// # Errors
/// Returns an [`ObjError`] that names the line, vertex or face that cannot be used.
pub(super) fn read(text: &str) -> Result<(TriangleMesh, Vec<ImportNote>), ObjError> {
    let mut parser = ObjParser::default();
    let mut ignored = BTreeMap::new();
    for (line, words) in logical_lines(text) {
        let mut words = words.split_whitespace();
        let read = match words.next() {
            Some("v") => parser.vertex(words),
            Some("f") => parser.face(line, words),
            Some(other) if !WITHOUT_EFFECT.contains(&other) => {
                count_kind(&mut ignored, other);
                Ok(())
            }
            _ => Ok(()),
        };
        read.map_err(|fault| ObjError::Line { line, fault })?;
    }
    let notes = ImportNote::from_skipped(ignored).collect();
    Ok((parser.finish()?, notes))
}

/// Counts a line of a kind that is ignored.
fn count_kind(ignored: &mut BTreeMap<String, usize>, keyword: &str) {
    let kind = match keyword {
        "p" => "p (point)".to_owned(),
        "l" => "l (line)".to_owned(),
        "curv" | "curv2" => format!("{keyword} (curve)"),
        "surf" => "surf (surface)".to_owned(),
        "usemtl" => "usemtl (material)".to_owned(),
        other => other.chars().take(24).collect(),
    };
    if ignored.len() < MAX_KINDS || ignored.contains_key(&kind) {
        *ignored.entry(kind).or_default() += 1;
    } else {
        *ignored.entry("other".to_owned()).or_default() += 1;
    }
}

/// Returns the numbered lines (from 1) without comments. A line that ends in a backslash is
/// joined with the next.
fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.lines().zip(1..);
    std::iter::from_fn(move || {
        let (first, number) = lines.next()?;
        let mut joined = Cow::Borrowed(without_comment(first));
        while joined.ends_with('\\') {
            let joined = joined.to_mut();
            joined.pop();
            let Some((more, _)) = lines.next() else { break };
            joined.push(' ');
            joined.push_str(without_comment(more));
        }
        Some((number, joined))
    })
}

/// Removes a comment and trailing white space.
fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim_end()
}

impl ObjParser {
    /// Reads `x y` or `x y z` of a `v` line; ignores a weight or colour after them.
    fn vertex<'a>(&mut self, mut words: impl Iterator<Item = &'a str>) -> Result<(), ObjFault> {
        let vertex = self.positions.len() + 1;
        let mut number = || words.next().map(str::parse::<f64>);
        let (p, z) = match [number(), number(), number()] {
            [Some(Ok(x)), Some(Ok(y)), Some(Ok(z))] => (DVec2::new(x, y), z),
            [Some(Ok(x)), Some(Ok(y)), None] => (DVec2::new(x, y), 0.0),
            _ => return Err(ObjFault::Vertex(vertex)),
        };
        if !(is_in_range(p) && z.is_finite()) {
            return Err(ObjFault::CoordinateRange(vertex));
        }
        if self.positions.is_empty() {
            self.first_z = z;
        }
        let first = self.first_z;
        // The comparison is exact: a tolerance would depend on the size of the mesh, which is not
        // yet known.
        if z != first {
            return Err(ObjFault::NotFlat { vertex, z, first });
        }
        self.positions.push(p);
        Ok(())
    }

    /// Reads the vertex numbers of an `f` line. Numbers above the number of vertices read so far
    /// are accepted here and checked at the end of the file, because more vertices may follow.
    fn face<'a>(
        &mut self,
        line: usize,
        words: impl Iterator<Item = &'a str>,
    ) -> Result<(), ObjFault> {
        let face = self.polygons.len() + 1;
        let vertex_count = self.positions.len() as i64;
        let first = self.corners.len();
        for word in words {
            let number = word.split('/').next().unwrap_or_default();
            let named: i64 = number
                .parse()
                .map_err(|_| ObjFault::Face(face, word.chars().take(24).collect()))?;
            // Negative numbers count back from the last vertex read: −1 is that vertex.
            let corner = match named < 0 {
                true => vertex_count.saturating_add(named),
                false => named - 1,
            };
            if corner < 0 {
                return Err(self.out_of_range(face, named));
            }
            self.corners.push(corner);
        }
        self.polygons.push((line, first));
        match self.corners.len() - first < 3 {
            true => Err(ObjFault::TooFewCorners(face)),
            false => Ok(()),
        }
    }

    /// Returns the fault for a vertex number that does not exist.
    fn out_of_range(&self, face: usize, named: i64) -> ObjFault {
        ObjFault::OutOfRange {
            face,
            named,
            vertices: self.positions.len(),
        }
    }

    /// Checks the faces against all vertices and builds the mesh.
    fn finish(self) -> Result<TriangleMesh, ObjError> {
        if self.positions.is_empty() || self.polygons.is_empty() {
            return Err(ObjError::NoMesh {
                vertices: self.positions.len(),
                faces: self.polygons.len(),
            });
        }
        if u32::try_from(self.positions.len()).is_err() {
            return Err(ObjError::TooMany);
        }
        let mut faces = PolygonFaces::default();
        let mut used = vec![false; self.positions.len()];
        let ends = self.polygons.iter().skip(1).map(|&(_, first)| first);
        let ends = ends.chain([self.corners.len()]);
        for (face, (&(line, first), end)) in (1..).zip(self.polygons.iter().zip(ends)) {
            let corners = &self.corners[first..end];
            let checked = self.check_corners(face, corners, &mut used);
            checked.map_err(|fault| ObjError::Line { line, fault })?;
            faces.push(corners.iter().map(|&corner| corner as u32));
        }
        if let Some(unused) = used.iter().position(|&used| !used) {
            return Err(ObjError::Unused(unused + 1));
        }
        let lines = self.polygons;
        TriangleMesh::from_polygons(self.positions, faces).map_err(|error| match error {
            MeshError::NotSimple(face) => ObjError::Line {
                line: lines[face].0,
                fault: ObjFault::NotSimple(face + 1),
            },
            error => error.into(),
        })
    }

    /// Checks that the vertices of a face exist and differ, and marks them as used. Runs after the
    /// last line has been read, because faces may precede their vertices.
    fn check_corners(
        &self,
        face: usize,
        corners: &[i64],
        used: &mut [bool],
    ) -> Result<(), ObjFault> {
        for &corner in corners {
            let Some(mark) = used.get_mut(corner as usize) else {
                return Err(self.out_of_range(face, corner.saturating_add(1)));
            };
            *mark = true;
        }
        let repeated = |vertex: i64| ObjFault::Repeated {
            face,
            vertex: vertex as usize + 1,
        };
        // Fast path: nearly all faces are triangles.
        if let [a, b, c] = *corners {
            return match a == b || a == c || b == c {
                true => Err(repeated(if b == c { b } else { a })),
                false => Ok(()),
            };
        }
        let mut sorted = corners.to_vec();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(repeated(pair[0])),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
