//! Sheets of faces that share edges, and the unknown scale factors of their vertices.
//!
//! Each vertex has a factor that scales the lengths around it. The factor is 1 along the outer
//! boundary. All vertices around a hole have one factor in common, so that the boundary of the hole
//! turns by the same total angle as in the designs. A vertex at which several fans of faces touch
//! counts once per fan; the faces of a fan are connected by edges at the vertex.

use crate::compatible::CompatibleMesh;
use crate::geometry::DVec2;
use crate::mesh::{Connectivity, components};
use crate::numerics::PatternCholesky;
use std::collections::VecDeque;
use std::f64::consts::{PI, TAU};

/// Marks a vertex without an unknown factor (its factor is 1), or an absent matrix entry.
pub(super) const FIXED: u32 = u32::MAX;

/// A sheet: a set of faces connected by shared edges.
#[derive(Debug)]
pub(super) struct FaceSheet {
    /// Indices of its faces. Each face except the first shares a side with an earlier one.
    pub faces: Vec<u32>,
    /// For each face, the side across which it was reached; unused for the first.
    pub reached: Vec<SheetTreeLink>,
    /// For each face, the squared lengths of its sides in source and target; side k runs from
    /// corner k to the next.
    pub lengths: Vec<[[f64; 3]; 2]>,
    /// For each face, the indices of the unknown scale factors at its corners; [`FIXED`] where the
    /// factor is 1.
    pub unknowns: Vec<[u32; 3]>,
    /// For each unknown scale factor, the required sum, in radians, of the angles at its vertices.
    pub sums: Vec<f64>,
    /// Sparsity pattern of the matrix of Newton's method; `None` if there are no unknowns or the
    /// matrix would need too much memory.
    pub pattern: Option<PatternCholesky>,
    /// For each side of each face, the indices of three entries of the matrix of Newton's method:
    /// the diagonal entries of the first and the second end, and their common off-diagonal entry;
    /// [`FIXED`] if absent.
    pub entries: Vec<[[u32; 3]; 3]>,
}

/// The side across which a face was reached from an earlier one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SheetTreeLink {
    /// Index of the earlier face within the sheet.
    pub from: u32,
    /// Index of the shared side in the earlier face.
    pub there: u8,
    /// Index of the shared side in the face that was reached.
    pub here: u8,
}

impl FaceSheet {
    /// Returns all sheets of a mesh.
    pub(super) fn all(mesh: &CompatibleMesh) -> Vec<Self> {
        let connectivity = mesh.connectivity();
        let count = mesh.faces().len();
        let fans = fans(connectivity, count);
        let mut done = vec![false; count];
        let mut sheets = Vec::new();
        for seed in 0..count {
            if !done[seed] {
                let (faces, reached) = walk(connectivity, seed, &mut done);
                sheets.push(Self::of(mesh, &fans, faces, reached));
            }
        }
        sheets
    }

    fn of(
        mesh: &CompatibleMesh,
        fans: &[u32],
        faces: Vec<u32>,
        reached: Vec<SheetTreeLink>,
    ) -> Self {
        let of_fan = Numbering::of(mesh, fans, &faces);
        let unknowns: Vec<[u32; 3]> = faces
            .iter()
            .map(|&f| [0, 1, 2].map(|k| of_fan.unknown[fans[3 * f as usize + k] as usize]))
            .collect();
        let (pattern, entries) = pattern(of_fan.sums.len(), &unknowns);
        Self {
            lengths: faces.iter().map(|&f| lengths(mesh, f as usize)).collect(),
            sums: of_fan.sums,
            faces,
            reached,
            unknowns,
            pattern,
            entries,
        }
    }
}

/// Returns, for each corner of each face, the index of its fan. Corners at the same vertex belong
/// to one fan if their faces share edges there.
fn fans(connectivity: &Connectivity, faces: usize) -> Vec<u32> {
    let halves = (0..faces).flat_map(|f| (0..3).map(move |k| (f, k)));
    let links = halves.filter_map(|(face, k)| {
        let twin = connectivity.twin(face, k)?;
        // The end of the side in this face is its start in the other face.
        Some([(3 * face + (k + 1) % 3) as u32, twin])
    });
    components(3 * faces, links)
}

/// Returns the faces connected to `seed`, in breadth-first order, with the sides across which they
/// were reached.
fn walk(
    connectivity: &Connectivity,
    seed: usize,
    done: &mut [bool],
) -> (Vec<u32>, Vec<SheetTreeLink>) {
    let (mut faces, mut reached) = (vec![seed as u32], vec![SheetTreeLink::default()]);
    let mut queue = VecDeque::from([0_u32]);
    done[seed] = true;
    while let Some(from) = queue.pop_front() {
        let face = faces[from as usize] as usize;
        for k in 0..3 {
            let Some(twin) = connectivity.twin(face, k) else {
                continue;
            };
            let other = twin / 3;
            if !std::mem::replace(&mut done[other as usize], true) {
                queue.push_back(faces.len() as u32);
                faces.push(other);
                reached.push(SheetTreeLink {
                    from,
                    there: k as u8,
                    here: (twin % 3) as u8,
                });
            }
        }
    }
    (faces, reached)
}

/// Numbering of the unknown scale factors of a sheet.
struct Numbering {
    /// For each fan of the mesh, the index of its unknown scale factor; [`FIXED`] on the outer
    /// boundary and in other sheets.
    unknown: Vec<u32>,
    /// For each unknown scale factor, the required sum, in radians, of the angles at its vertices.
    sums: Vec<f64>,
}

impl Numbering {
    fn of(mesh: &CompatibleMesh, fans: &[u32], faces: &[u32]) -> Self {
        let mut unknown = vec![FIXED; fans.len()];
        let mut sums = Vec::new();
        let mut is_rim = vec![false; fans.len()];
        let rims = rims(mesh, fans, faces);
        rims.iter()
            .flatten()
            .for_each(|&fan| is_rim[fan as usize] = true);
        for &face in faces {
            for &fan in &fans[3 * face as usize..][..3] {
                if !is_rim[fan as usize] && unknown[fan as usize] == FIXED {
                    unknown[fan as usize] = sums.len() as u32;
                    sums.push(TAU);
                }
            }
        }
        let angles = angles(mesh, fans, faces);
        let turning = |rim: &[u32]| -> f64 {
            let turns = rim.iter().map(|&fan| PI - angles[fan as usize]);
            // The exact sum is a whole number of turns; rounding to it removes the numerical error.
            TAU * (turns.sum::<f64>() / TAU).round()
        };
        let turnings: Vec<f64> = rims.iter().map(|rim| turning(rim)).collect();
        // The loop around a hole runs in the opposite direction, so the outer loop has the largest
        // turning.
        let outer =
            (0..rims.len()).max_by(|&a, &b| turnings[a].total_cmp(&turnings[b]).then(b.cmp(&a)));
        for (k, rim) in rims.iter().enumerate() {
            if Some(k) != outer {
                rim.iter()
                    .for_each(|&fan| unknown[fan as usize] = sums.len() as u32);
                sums.push(PI * rim.len() as f64 - turnings[k]);
            }
        }
        Self { unknown, sums }
    }
}

/// Returns the boundary loops of a sheet as lists of fans.
fn rims(mesh: &CompatibleMesh, fans: &[u32], faces: &[u32]) -> Vec<Vec<u32>> {
    let corners = faces
        .iter()
        .flat_map(|&f| (0..3).map(move |k| (f as usize, k)));
    let open = corners.filter(|&(f, k)| mesh.connectivity().twin(f, k).is_none());
    // At each fan on the boundary, exactly one boundary side starts.
    let mut next = std::collections::BTreeMap::new();
    for (f, k) in open {
        next.insert(fans[3 * f + k], fans[3 * f + (k + 1) % 3]);
    }
    let mut rims = Vec::new();
    while let Some((first, mut at)) = next.pop_first() {
        let mut rim = vec![first];
        while let Some(after) = next.remove(&at) {
            rim.push(at);
            at = after;
        }
        rims.push(rim);
    }
    rims
}

/// Returns the sum of the angles at each fan in the source, in radians.
fn angles(mesh: &CompatibleMesh, fans: &[u32], faces: &[u32]) -> Vec<f64> {
    let mut sums = vec![0.0; fans.len()];
    for &face in faces {
        let at = mesh.faces()[face as usize].map(|v| mesh.source()[v as usize]);
        for k in 0..3 {
            let [a, b] = [1, 2].map(|step| at[(k + step) % 3] - at[k]);
            sums[fans[3 * face as usize + k] as usize] += a.perp_dot(b).atan2(a.dot(b));
        }
    }
    sums
}

fn lengths(mesh: &CompatibleMesh, face: usize) -> [[f64; 3]; 2] {
    let corners = mesh.faces()[face];
    [mesh.source(), mesh.target()].map(|points: &[DVec2]| {
        let at = |k: usize| points[corners[k % 3] as usize];
        [0, 1, 2].map(|k| at(k).distance_squared(at(k + 1)))
    })
}

/// Returns the sparsity pattern of the matrix of Newton's method for a sheet, and the indices of
/// the matrix entries of each side.
fn pattern(
    unknowns: usize,
    of_corners: &[[u32; 3]],
) -> (Option<PatternCholesky>, Vec<[[u32; 3]; 3]>) {
    let mut places = Vec::new();
    let mut number = |i: u32, j: u32| {
        if i == FIXED || j == FIXED {
            return FIXED;
        }
        places.push([i, j]);
        places.len() as u32 - 1
    };
    let mut entries: Vec<[[u32; 3]; 3]> = of_corners
        .iter()
        .map(|corners| {
            [0, 1, 2].map(|k| {
                let [i, j] = [corners[k], corners[(k + 1) % 3]];
                // Both ends have the same unknown scale factor, so the matrix entries of this side
                // would cancel.
                if i == j {
                    return [FIXED; 3];
                }
                [number(i, i), number(j, j), number(i, j)]
            })
        })
        .collect();
    if unknowns == 0 {
        return (None, entries);
    }
    let Ok((pattern, slots)) = PatternCholesky::new(unknowns, &places) else {
        return (None, entries);
    };
    let numbered = entries.iter_mut().flatten().flatten();
    for entry in numbered.filter(|entry| **entry != FIXED) {
        *entry = slots[*entry as usize];
    }
    (Some(pattern), entries)
}
