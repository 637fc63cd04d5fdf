//! Unfolds the faces of a blend that are turned over, by moving vertices.
//!
//! Interior vertices are moved first, which does not change the outline. Each is moved to the point
//! where the smallest of its faces is largest. Areas are linear in its position, so this is a
//! linear programme in three unknowns, which is solved by trying all triples of faces (Freitag,
//! Plassmann 2000, "Local optimization-based simplicial mesh untangling and improvement", with
//! areas instead of volumes). If that does not suffice, the corners of each folded face are moved
//! just far enough to open it (Müller, Heidelberger, Hennix, Ratcliff 2007, "Position based
//! dynamics", with areas as constraints).
//!
//! Guaranteed: a blend without folds is unchanged; outlines are unchanged if moving interior
//! vertices suffices. Not guaranteed: that all faces can be unfolded.

use crate::compatible::CompatibleFamily;
use crate::geometry::{DMat3, DVec2, DVec3, orient2d};

/// Maximum number of passes over the folded faces that move only interior vertices (resource
/// limit).
const ROUNDS: usize = 12;

/// Maximum number of further passes over the folded faces that also move vertices on outlines
/// (resource limit).
const PUSHES: usize = 20;

/// Twice the area of a folded face after it is opened, divided by the sum of its squared side
/// lengths (heuristic).
const THIN: f64 = 1e-3;

/// Maximum number of faces around a vertex; vertices with more faces are not moved (resource limit:
/// the number of triples grows with the cube).
const MOST_FACES: usize = 16;

/// The faces around each interior vertex.
#[derive(Clone, Debug)]
pub(super) struct Mender {
    /// For each vertex, the index in `around` of its first face; finally, the length of `around`.
    /// Vertices on a boundary or a bar have empty lists.
    starts: Vec<u32>,
    /// Indices of the faces around each vertex, vertex by vertex.
    around: Vec<u32>,
}

impl Mender {
    pub fn of(family: &CompatibleFamily) -> Self {
        let count = family.embeddings()[0].len();
        let mut is_fixed = vec![false; count];
        let loops = family.boundary_loops();
        let ends = family.elements().iter().flatten();
        for &v in loops.iter().flatten().chain(ends) {
            is_fixed[v as usize] = true;
        }
        let mut faces_of: Vec<Vec<u32>> = vec![Vec::new(); count];
        for (f, face) in family.faces().iter().enumerate() {
            for &v in face {
                if !is_fixed[v as usize] {
                    faces_of[v as usize].push(f as u32);
                }
            }
        }
        let mut starts = vec![0];
        let mut around = Vec::new();
        for faces in faces_of {
            around.extend(faces);
            starts.push(around.len() as u32);
        }
        Self { starts, around }
    }

    /// Unfolds folded faces as far as possible. Returns whether none is left.
    pub fn mend(&self, faces: &[[u32; 3]], places: &mut [DVec2]) -> bool {
        for round in 0..ROUNDS + PUSHES {
            let mut is_done = true;
            for face in faces {
                if !is_folded(places, *face) {
                    continue;
                }
                is_done = false;
                if round >= ROUNDS {
                    push(places, *face);
                }
                for &v in face {
                    self.settle(v, faces, places);
                    // The vertex may have no room to move until its neighbours have moved.
                    for &f in self.faces_of(v) {
                        let others = faces[f as usize];
                        others.iter().for_each(|&w| self.settle(w, faces, places));
                    }
                }
            }
            if is_done {
                return true;
            }
        }
        !faces.iter().any(|face| is_folded(places, *face))
    }

    fn faces_of(&self, v: u32) -> &[u32] {
        let [from, to] = [v, v + 1].map(|k| self.starts[k as usize] as usize);
        &self.around[from..to]
    }

    /// Moves a vertex to the position that maximises the smallest area of its faces.
    fn settle(&self, v: u32, faces: &[[u32; 3]], places: &mut [DVec2]) {
        let own = self.faces_of(v);
        if own.len() < 3 || own.len() > MOST_FACES {
            return;
        }
        // Twice the area of a face is n · p + c, where p is the position of the vertex. `lines`
        // holds n and c of each face.
        let mut lines = [DVec3::ZERO; MOST_FACES];
        for (line, &f) in lines.iter_mut().zip(own) {
            let face = faces[f as usize];
            let k = (0..3).find(|&k| face[k] == v).unwrap_or_default();
            let [a, b] = [1, 2].map(|by| places[face[(k + by) % 3] as usize]);
            let edge = b - a;
            let normal = edge.perp();
            *line = normal.extend(-normal.dot(a));
        }
        let lines = &lines[..own.len()];
        let least = |p: DVec2| {
            let all = lines.iter().map(|line| line.dot(p.extend(1.0)));
            all.fold(f64::INFINITY, f64::min)
        };
        let now = places[v as usize];
        let (mut best, mut most) = (now, least(now));
        for i in 0..lines.len() {
            for j in 0..i {
                for k in 0..j {
                    let place = level(lines[i], lines[j], lines[k]);
                    let Some(place) = place.filter(|place| place.is_finite()) else {
                        continue;
                    };
                    let found = least(place);
                    if found > most {
                        (best, most) = (place, found);
                    }
                }
            }
        }
        places[v as usize] = best;
    }
}

/// Moves the corners of a folded face just far enough to open it; the sum of the squared
/// displacements is minimal.
fn push(places: &mut [DVec2], face: [u32; 3]) {
    let [a, b, c] = face.map(|v| places[v as usize]);
    // Gradients of twice the area with respect to each corner.
    let ways = [(c - b).perp(), (a - c).perp(), (b - a).perp()];
    let square: f64 = ways.iter().map(|way| way.length_squared()).sum();
    let lack = THIN * square - (b - a).perp_dot(c - a);
    // If all corners coincide, there is no direction to move them.
    if lack > 0.0 && square > 0.0 {
        for (v, way) in face.into_iter().zip(ways) {
            places[v as usize] += way * (lack / square);
        }
    }
}

fn is_folded(places: &[DVec2], face: [u32; 3]) -> bool {
    let [a, b, c] = face.map(|v| places[v as usize]);
    orient2d(a, b, c) <= 0.0
}

/// Returns the position of a vertex at which three of its faces have equal area; `None` if this
/// position does not exist or is not unique. Each argument holds n and c of a face with twice the
/// area n · p + c, where p is the position.
fn level(a: DVec3, b: DVec3, c: DVec3) -> Option<DVec2> {
    // Solves n · p − r = −c for the position p and for r, twice the common area.
    let row = |line: DVec3| DVec3::new(line.x, line.y, -1.0);
    let matrix = DMat3::from_cols(row(a), row(b), row(c)).transpose();
    if matrix.determinant() == 0.0 {
        return None;
    }
    let solved = matrix.inverse() * -DVec3::new(a.z, b.z, c.z);
    Some(solved.truncate())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square with one vertex inside, at `middle`.
    fn square(middle: DVec2) -> (Vec<[u32; 3]>, Vec<DVec2>) {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        let faces = (0..4).map(|k| [k, (k + 1) % 4, 4]).collect();
        (faces, corners.into_iter().chain([middle]).collect())
    }

    #[test]
    fn a_vertex_outside_is_taken_in_and_one_inside_stays() {
        let (faces, start) = square(DVec2::splat(0.3));
        let family = CompatibleFamily::new(faces.clone(), vec![start.clone(); 2], vec![]);
        let mender = Mender::of(&family.expect("a family"));
        let mut places = start.clone();
        assert!(mender.mend(&faces, &mut places));
        assert_eq!(places, start);
        let (_, mut places) = square(DVec2::new(1.7, -0.4));
        assert!(mender.mend(&faces, &mut places));
        assert!(
            places[4].distance(DVec2::splat(0.5)) < 1e-9,
            "{}",
            places[4]
        );
        assert_eq!(places[..4], start[..4]);
    }

    #[test]
    fn a_face_without_a_vertex_inside_is_opened() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from);
        let faces = vec![[0, 1, 2], [0, 2, 3]];
        let family = CompatibleFamily::new(faces.clone(), vec![corners.to_vec(); 2], vec![]);
        let mender = Mender::of(&family.expect("a family"));
        let mut places = corners.to_vec();
        places[1] = DVec2::new(0.45, 0.55);
        let before = places.clone();
        assert!(mender.mend(&faces, &mut places));
        assert!(faces.iter().all(|face| !is_folded(&places, *face)));
        let gaps = places.iter().zip(&before).map(|(p, q)| p.distance(*q));
        assert!(gaps.fold(0.0, f64::max) < 0.08);
    }
}
