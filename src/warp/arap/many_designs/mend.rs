//! Faces that are turned over in a blend are turned back: by moving vertices inside, which
//! changes nothing of what is seen of a solid, as far as that goes.
//!
//! A vertex goes to where the least of its faces is largest: areas are linear in its place,
//! so that this is a linear programme in three unknowns, solved by trying the triples of
//! faces (Freitag, Plassmann 2000, "Local optimization-based simplicial mesh untangling and
//! improvement", with areas in the place of volumes). Where that is not enough, the corners of
//! what is left are moved as little as opens it (Müller, Heidelberger, Hennix, Ratcliff 2007,
//! "Position based dynamics", with areas as constraints). Guaranteed: a blend that folds
//! nowhere stays as it is, and outlines do where vertices inside have room. Not guaranteed:
//! that nothing is folded any more.

use crate::compatible::CompatibleFamily;
use crate::geometry::{DMat3, DVec2, DVec3, orient2d};

/// Rounds over the vertices of what is folded. With these alone 9 of 200 blends of three
/// devices and a brick stayed folded and 4 of a frog, a rat, an octopus and a child; of two
/// more families that had folded at 187 and 192 none.
const ROUNDS: usize = 12;

/// Rounds after these in which outlines make room as well: where a face has no vertex inside,
/// or these have no room. One of those 200 blends stayed folded, with 80 rounds as well.
const PUSHES: usize = 20;

/// What twice the area of a face that is pushed open is of the squares of its sides.
const THIN: f64 = 1e-3;

/// A vertex with more faces is left where it is: triples grow with the cube.
const MOST_FACES: usize = 16;

/// Which faces a vertex inside has.
#[derive(Clone, Debug)]
pub(super) struct Mender {
    /// For each vertex where its faces begin among `around`, and one behind the last; none of
    /// those on a boundary.
    starts: Vec<u32>,
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

    /// Turns back what is turned over, as far as there is room, and says whether all is.
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
                    // What is around it may have to make room.
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

    /// Moves a vertex to where its least face is largest.
    fn settle(&self, v: u32, faces: &[[u32; 3]], places: &mut [DVec2]) {
        let own = self.faces_of(v);
        if own.len() < 3 || own.len() > MOST_FACES {
            return;
        }
        // Twice the area of a face is n · p + c at a place p of the vertex.
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

/// Moves the corners of a face just so far that it is not turned over any more, all together
/// no more than they must.
fn push(places: &mut [DVec2], face: [u32; 3]) {
    let [a, b, c] = face.map(|v| places[v as usize]);
    // How twice the area grows with each corner.
    let ways = [(c - b).perp(), (a - c).perp(), (b - a).perp()];
    let square: f64 = ways.iter().map(|way| way.length_squared()).sum();
    let lack = THIN * square - (b - a).perp_dot(c - a);
    // A face that is a point has no way out.
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

/// Where three faces are of one area.
fn level(a: DVec3, b: DVec3, c: DVec3) -> Option<DVec2> {
    // n · p − r = −c for all three.
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

    /// A square around a vertex in its middle.
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
