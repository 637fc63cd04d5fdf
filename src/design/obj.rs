//! Wavefront OBJ as a plane triangle mesh.
//!
//! Read are `v` and `f`; names, groups, materials, normals and texture
//! coordinates are passed over. Vertices keep their number and order, so that
//! two files with the same `f` lines give the same mesh: loaders that number
//! vertices by their first use in a face, or once for each texture
//! coordinate, do not promise that, and lose the numbers that errors need.
//!
//! Faces of more than three vertices must be convex enough to be cut into a
//! fan about their first vertex; a fan is the same in any two files, a better
//! triangulation would not be. Whether faces are oriented alike, and
//! positively, is checked where two meshes meet.

use crate::geometry::{DVec2, RANGE_MESSAGE, is_in_range};
use crate::mesh::{MeshError, TriangleMesh};
use std::borrow::Cow;

/// Why an OBJ file is no plane mesh. Lines, vertices and faces count from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjError {
    /// A line that cannot be used.
    #[error("line {line}: {fault}")]
    Line {
        /// The line.
        line: usize,
        /// What is wrong with it.
        fault: ObjFault,
    },
    /// A vertex that nothing holds.
    #[error("vertex {0} belongs to no face; remove it, or add the face that is missing")]
    Unused(usize),
    /// No vertices or no faces.
    #[error("the mesh has {vertices} vertices and {faces} faces; give at least one triangle")]
    NoMesh {
        /// How many vertices.
        vertices: usize,
        /// How many faces.
        faces: usize,
    },
    /// More vertices than can be numbered.
    #[error("the mesh has more than {} vertices; give a coarser one", u32::MAX)]
    TooMany,
    /// Faces that do not fit together.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// What is wrong with a vertex or a face, which is named by its number.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ObjFault {
    /// A `v` line without two or three numbers.
    #[error("vertex {0} needs the numbers x y z; correct the line")]
    Vertex(usize),
    /// A coordinate is no number, or beyond [`MAX_COORDINATE`].
    ///
    /// [`MAX_COORDINATE`]: crate::geometry::MAX_COORDINATE
    #[error("vertex {0} {RANGE_MESSAGE}")]
    Place(usize),
    /// The vertices do not lie in one plane of constant z.
    #[error(
        "vertex {vertex} has z = {z}, but vertex 1 has z = {first}; lay the mesh flat, only x and y are used"
    )]
    NotFlat {
        /// The vertex.
        vertex: usize,
        /// Its z.
        z: f64,
        /// The z of the first vertex.
        first: f64,
    },
    /// A face with a word, cut short, that is no vertex.
    #[error("face {0} has \"{1}\" where a vertex number should be; correct the line")]
    Face(usize, String),
    /// A face of one or two vertices.
    #[error("face {0} has fewer than three vertices; remove it or complete it")]
    TooFewCorners(usize),
    /// A face that names a vertex that is not there.
    #[error("face {face} names vertex {named}, but there are {vertices}; correct the face")]
    OutOfRange {
        /// The face.
        face: usize,
        /// The number as it stands in the file.
        named: i64,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A face that passes a vertex twice.
    #[error("face {face} names vertex {vertex} twice; correct the face")]
    Repeated {
        /// The face.
        face: usize,
        /// The vertex.
        vertex: usize,
    },
}

#[derive(Default)]
struct ObjParser {
    positions: Vec<DVec2>,
    first_z: f64,
    /// The line of each face, and how many of `corners` come before its own.
    polygons: Vec<(usize, usize)>,
    /// The vertices of faces from 0, not yet triangles: one after the other, since a
    /// list for each would be most of the time that a million takes.
    corners: Vec<i64>,
}

/// Reads the text of an OBJ file.
pub(super) fn read(text: &str) -> Result<TriangleMesh, ObjError> {
    let mut parser = ObjParser::default();
    for (line, words) in logical_lines(text) {
        let mut words = words.split_whitespace();
        let read = match words.next() {
            Some("v") => parser.vertex(words),
            Some("f") => parser.face(line, words),
            _ => Ok(()),
        };
        read.map_err(|fault| ObjError::Line { line, fault })?;
    }
    parser.finish()
}

/// Lines from 1, without comments, with those joined that end in a backslash.
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

fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim_end()
}

impl ObjParser {
    /// Takes `x y` or `x y z`; a weight or a colour behind them is passed over.
    fn vertex<'a>(&mut self, mut words: impl Iterator<Item = &'a str>) -> Result<(), ObjFault> {
        let vertex = self.positions.len() + 1;
        let mut number = || words.next().map(str::parse::<f64>);
        let (p, z) = match [number(), number(), number()] {
            [Some(Ok(x)), Some(Ok(y)), Some(Ok(z))] => (DVec2::new(x, y), z),
            [Some(Ok(x)), Some(Ok(y)), None] => (DVec2::new(x, y), 0.0),
            _ => return Err(ObjFault::Vertex(vertex)),
        };
        if !(is_in_range(p) && z.is_finite()) {
            return Err(ObjFault::Place(vertex));
        }
        if self.positions.is_empty() {
            self.first_z = z;
        }
        let first = self.first_z;
        // Exact: "ignored if constant" has no scale to measure a difference by.
        if z != first {
            return Err(ObjFault::NotFlat { vertex, z, first });
        }
        self.positions.push(p);
        Ok(())
    }

    /// Takes the vertices of a face.
    fn face<'a>(
        &mut self,
        line: usize,
        words: impl Iterator<Item = &'a str>,
    ) -> Result<(), ObjFault> {
        let face = self.polygons.len() + 1;
        let so_far = self.positions.len() as i64;
        let first = self.corners.len();
        for word in words {
            let number = word.split('/').next().unwrap_or_default();
            let named: i64 = number
                .parse()
                .map_err(|_| ObjFault::Face(face, word.chars().take(24).collect()))?;
            // Negative numbers count back from the latest vertex.
            let corner = match named < 0 {
                true => so_far.saturating_add(named),
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

    fn out_of_range(&self, face: usize, named: i64) -> ObjFault {
        ObjFault::OutOfRange {
            face,
            named,
            vertices: self.positions.len(),
        }
    }

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
        let mut faces = Vec::with_capacity(self.polygons.len());
        let mut used = vec![false; self.positions.len()];
        let ends = self.polygons.iter().skip(1).map(|&(_, first)| first);
        let ends = ends.chain([self.corners.len()]);
        for (face, (&(line, first), end)) in (1..).zip(self.polygons.iter().zip(ends)) {
            let corners = &self.corners[first..end];
            let checked = self.check_corners(face, corners, &mut used);
            checked.map_err(|fault| ObjError::Line { line, fault })?;
            // Three at least, so that there is a first and a fan about it.
            let fan = corners[1..].windows(2).map(|w| [corners[0], w[0], w[1]]);
            faces.extend(fan.map(|corners| corners.map(|c| c as u32)));
        }
        if let Some(unused) = used.iter().position(|&used| !used) {
            return Err(ObjError::Unused(unused + 1));
        }
        Ok(TriangleMesh::new(self.positions, faces)?)
    }

    /// Corners exist and differ; marks them as used. Faces may stand before
    /// their vertices, so that this waits for the last line.
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
        // Nearly all are triangles.
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
