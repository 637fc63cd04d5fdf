//! Mesh of the whole frame in which matched outlines are mesh edges.
//!
//! The regions inside and outside the outlines are triangulated separately and joined along the
//! outlines. Such a mesh maps matched outlines onto each other exactly. It exists for some matches
//! for which a mesh around pins (`CompatibleMesh::around_pins`) does not. Rings that close to a
//! point or open from a point are left out; the area that they bound belongs to the region around
//! them.

use super::assembly::MeshAssembly;
use super::border::border_points;
use super::{CompatibleError, CompatibleMesh, PieceMeshError, PolygonOptions};
use crate::correspondence::{PieceMatch, RegionMatch, RingKind, RingMatch};
use crate::geometry::{Bounds, DVec2, signed_area, winding};
use crate::work::progress::{Progress, ProgressShares};
use rayon::prelude::*;

/// Number of border points along the longer side of the frame (heuristic: half as many as in
/// `CompatibleMesh::around_pins`, because the points of the outlines are added).
const POINTS_ALONG: f64 = 12.0;

/// Reason why the frame has no mesh in which the outlines are mesh edges.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameOutlinesError {
    /// The outlines are nested differently in the two designs, are cut open, or extend beyond the
    /// frame.
    #[error(
        "the outlines are nested differently in the two designs, are cut open, or reach beyond the frame"
    )]
    Nesting,
    /// The meshes of the cells (the regions between outlines) do not form a valid mesh when they
    /// are joined along the outlines.
    #[error("the cells between the outlines do not fit together: {0}")]
    Assembly(#[from] CompatibleError),
    /// A cell (a region between outlines) could not be triangulated.
    #[error(transparent)]
    Cell(#[from] PieceMeshError),
}

/// Cell: a connected region of the plane between outlines. The first entry is the ring around it,
/// the others are the rings inside it. An entry is the index of a ring, and whether the boundary of
/// the cell passes the points of this ring in reverse order.
struct FrameCell(Vec<(usize, bool)>);

impl CompatibleMesh {
    /// Triangulates the rectangle `frame` so that the outlines of a match are mesh edges. The
    /// border of the rectangle is the same in both designs.
    ///
    /// # Errors
    /// [`FrameOutlinesError`] if the outlines are cut open, extend beyond the frame or are nested
    /// differently in the two designs, if a cell has no valid mesh, or if the work is cancelled.
    ///
    /// # Panics
    /// If an outline of the match has no points.
    pub fn around_outlines(
        frame: &Bounds,
        matched: &RegionMatch,
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, FrameOutlinesError> {
        let border = border_points(frame, frame.size().max_element() / POINTS_ALONG);
        let mut rings = vec![[border.clone(), border]];
        let cells = cells(&matched.pieces, &mut rings).ok_or(FrameOutlinesError::Nesting)?;
        // If an outline touched the border, the cell between the two could not be triangulated.
        let inside = |p: &DVec2| frame.padded(-1e-6 * frame.diameter()).contains(*p);
        if !rings[1..].iter().flatten().flatten().all(inside) {
            return Err(FrameOutlinesError::Nesting);
        }
        let shares = ProgressShares::new(progress, cells.len());
        let meshes = cells.par_iter().enumerate().map(|(k, cell)| {
            let side = |side: usize| -> Vec<Vec<DVec2>> {
                let ring_points = |&(ring, backwards): &(usize, bool)| {
                    let mut points = rings[ring][side].clone();
                    if backwards {
                        points.reverse();
                    }
                    points
                };
                cell.0.iter().map(ring_points).collect()
            };
            Self::from_piece(&side(0), &side(1), options, &shares.part(k))
        });
        let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
        Ok(join_cells(&rings, &cells, &meshes)?)
    }
}

/// Returns the cells of the frame and appends their rings to `rings`, which initially holds the
/// frame's border alone. Cells inside parts come first, then the voids: the cell inside the frame
/// around all outer parts, and the cell inside each hole. `None` if a piece is cut open, or if
/// parts are nested differently in the two designs.
fn cells(pieces: &[PieceMatch], rings: &mut Vec<[Vec<DVec2>; 2]>) -> Option<Vec<FrameCell>> {
    let mut parts = Vec::new();
    // Voids are the cells outside all parts: first the one inside the frame, then one inside each
    // hole. The boundary of a void passes the points of the hole's ring in reverse order.
    let mut voids = vec![FrameCell(vec![(0, false)])];
    let mut outers = Vec::new();
    for piece in pieces {
        let [outer, holes @ ..] = piece.rings.as_slice() else {
            return None;
        };
        if outer.kind != RingKind::Matched {
            continue;
        }
        // A cut would join a hole with the outside of its part. The cells of the frame need them
        // separate, so a match with cuts is refused.
        if !piece.cuts.is_empty() {
            return None;
        }
        let mut add = |ring: &RingMatch| {
            rings.push([ring.source.clone(), ring.target.clone()]);
            rings.len() - 1
        };
        let own = add(outer);
        outers.push(own);
        let mut part = vec![(own, false)];
        for hole in holes.iter().filter(|hole| hole.kind == RingKind::Matched) {
            let ring = add(hole);
            part.push((ring, false));
            voids.push(FrameCell(vec![(ring, true)]));
        }
        parts.push(FrameCell(part));
    }
    // Each part must lie in the same void in both designs. Otherwise the cells of the two designs
    // do not correspond.
    for outer in outers {
        let around = [0, 1].map(|side| surrounding(&parts, &voids, rings, outer, side));
        match around {
            [Some(a), Some(b)] if a == b => voids[a].0.push((outer, true)),
            _ => return None,
        }
    }
    parts.append(&mut voids);
    Some(parts)
}

/// Returns the index in `voids` of the void that directly contains the part with the outer ring
/// `outer`, in one design. This is the smallest hole around the part, or the void inside the frame
/// (index 0). `None` if the part lies inside the filled area of another part.
fn surrounding(
    parts: &[FrameCell],
    voids: &[FrameCell],
    rings: &[[Vec<DVec2>; 2]],
    outer: usize,
    side: usize,
) -> Option<usize> {
    // Outlines do not cross, so one point decides for the whole ring.
    let p = rings[outer][side][0];
    let encloses = |ring: usize| winding(&rings[ring][side], p) != 0;
    // Counts the other parts whose outer rings enclose this part.
    let around_it = parts.iter().map(|part| part.0[0].0);
    let depth = around_it
        .filter(|&own| own != outer && encloses(own))
        .count();
    let ring = |void: usize| voids[void].0[0].0;
    let holes: Vec<usize> = (1..voids.len()).filter(|&k| encloses(ring(k))).collect();
    // The smallest of the enclosing holes is the one directly around the part.
    let area = |k: usize| signed_area(&rings[ring(k)][side]).abs();
    let smallest = (holes.iter().copied()).min_by(|&j, &k| area(j).total_cmp(&area(k)));
    // Every enclosing part must have a hole that also encloses this part. Otherwise this part lies
    // in the filled area of another one.
    (holes.len() == depth).then_some(smallest.unwrap_or(0))
}

/// Joins the meshes of all cells. The vertices of the result are the points of all rings, each
/// once, then the inner vertices of each cell.
fn join_cells(
    rings: &[[Vec<DVec2>; 2]],
    cells: &[FrameCell],
    meshes: &[CompatibleMesh],
) -> Result<CompatibleMesh, CompatibleError> {
    let mut whole = MeshAssembly::default();
    let mut first = Vec::with_capacity(rings.len());
    for ring in rings {
        first.push(whole.points[0].len() as u32);
        for (points, ring) in whole.points.iter_mut().zip(ring) {
            points.extend_from_slice(ring);
        }
    }
    for (cell, mesh) in cells.iter().zip(meshes) {
        let mut shared = Vec::new();
        for &(ring, backwards) in &cell.0 {
            let count = rings[ring][0].len() as u32;
            // Vertices of the ring in the order in which the boundary of the cell passes them.
            let vertices =
                (0..count).map(|k| first[ring] + if backwards { count - 1 - k } else { k });
            shared.extend(vertices);
        }
        let points = [mesh.source(), mesh.target()];
        whole.append(&shared, points, mesh.faces().iter().copied());
    }
    let [source, target] = whole.points;
    CompatibleMesh::new(whole.faces, source, target, Vec::new())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::correspondence::{HoleRule, MatchSettings, match_regions};
    use crate::geometry::{FillRule, Regions, Ring, twice_signed_area};
    use crate::work::progress::Silent;

    const FRAME: Bounds = Bounds {
        min: DVec2::new(-10.0, -10.0),
        max: DVec2::new(10.0, 10.0),
    };

    fn square(at: f64, half: f64) -> Vec<DVec2> {
        let corner = |x: f64, y: f64| DVec2::new(at + half * x, half * y);
        vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ]
    }

    fn around(
        source: &[Vec<DVec2>],
        target: &[Vec<DVec2>],
    ) -> Result<CompatibleMesh, FrameOutlinesError> {
        let [a, b] = [source, target]
            .map(|rings| Regions::from_rings(rings, FillRule::EvenOdd).expect("regions"));
        let settings = MatchSettings {
            holes: HoleRule::Close,
            keep_up: true,
            ..MatchSettings::default()
        };
        let matched = match_regions(&a, &b, &settings, &Silent).expect("a match");
        CompatibleMesh::around_outlines(&FRAME, &matched, &PolygonOptions::default(), &Silent)
    }

    /// Checks that in each design the faces cover the frame exactly once, and that the outlines are
    /// mesh edges: no face has area on both sides of an outline.
    fn assert_joined(mesh: &CompatibleMesh, outlines: [&[Vec<DVec2>]; 2]) {
        assert_eq!(mesh.boundary_loops().len(), 1, "joined without a gap");
        for (points, rings) in [mesh.source(), mesh.target()].into_iter().zip(outlines) {
            let corners = |face: &[u32; 3]| face.map(|v| points[v as usize]);
            let area = |face: &[u32; 3]| {
                let [a, b, c] = corners(face);
                0.5 * twice_signed_area(a, b, c)
            };
            let sum: f64 = mesh.faces().iter().map(area).sum();
            assert!((sum - 400.0).abs() < 1e-9, "{sum}");
            for ring in rings {
                let ring = Ring::new(ring.clone()).expect("a ring");
                let is_in =
                    |face: &&[u32; 3]| ring.winding(corners(face).iter().sum::<DVec2>() / 3.0) != 0;
                let inside: f64 = mesh.faces().iter().filter(is_in).map(area).sum();
                assert!((inside - ring.signed_area().abs()).abs() < 1e-9, "{inside}");
            }
        }
    }

    #[test]
    fn inside_and_outside_fill_the_frame() {
        let [a, b] = [[square(-3.0, 2.0)], [square(2.0, 3.0)]];
        assert_joined(&around(&a, &b).expect("a mesh"), [&a, &b]);
    }

    #[test]
    fn a_part_in_a_hole_of_another_is_included() {
        let eye = |by: f64| [square(by, 6.0), square(by, 4.0), square(by, 2.0)];
        let [a, b] = [eye(0.0), eye(1.0)];
        assert_joined(&around(&a, &b).expect("a mesh"), [&a, &b]);
    }

    #[test]
    fn a_hole_that_closes_counts_as_inside() {
        let [a, b] = [
            vec![square(0.0, 5.0), square(0.0, 1.0)],
            vec![square(0.0, 4.0)],
        ];
        assert_joined(&around(&a, &b).expect("a mesh"), [&a[..1], &b]);
    }

    #[test]
    fn outlines_beyond_the_frame_are_refused() {
        let result = around(&[square(0.0, 12.0)], &[square(0.0, 4.0)]);
        assert_eq!(result.err(), Some(FrameOutlinesError::Nesting));
    }
}
