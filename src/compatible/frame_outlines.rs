//! Mesh of the whole frame in which matched outlines are mesh edges.
//!
//! The regions inside and outside the outlines are triangulated separately and joined along them.
//! Such a mesh carries outlines exactly, and it exists for matches where a mesh around pins may
//! not. Rings that close to a point or open from one are left out; the area they bound counts as
//! inside.

use super::assembly::MeshAssembly;
use super::border::border_points;
use super::{CompatibleError, CompatibleMesh, PieceMeshError, PolygonOptions};
use crate::correspondence::{PieceMatch, RegionMatch, RingKind, RingMatch};
use crate::geometry::{Bounds, DVec2, signed_area, winding};
use crate::work::progress::{Progress, ProgressShares};
use rayon::prelude::*;

/// Number of points along the longer side of the frame: half as many as around pins, because
/// outlines add points of their own (heuristic).
const POINTS_ALONG: f64 = 12.0;

/// Reason why the frame has no mesh around the outlines.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameOutlinesError {
    /// The outlines are nested differently in the two designs, are cut open, or reach beyond the
    /// frame.
    #[error(
        "the outlines are nested differently in the two designs, are cut open, or reach beyond the frame"
    )]
    Nesting,
    /// The cells do not fit together along the outlines.
    #[error("the cells between the outlines do not fit together: {0}")]
    Assembly(#[from] CompatibleError),
    /// A cell could not be triangulated.
    #[error(transparent)]
    Cell(#[from] PieceMeshError),
}

/// Connected region of the plane between outlines: the ring around it, then the rings inside it.
/// Each is a ring index and whether the ring runs backwards.
struct FrameCell(Vec<(usize, bool)>);

impl CompatibleMesh {
    /// Triangulates a rectangle around the outlines of a match. Its border is the same in both
    /// designs.
    ///
    /// # Errors
    /// [`FrameOutlinesError`] if the outlines are nested differently in the two designs, or if the
    /// work is cancelled.
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
        // An outline on the border would leave cells without area.
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

/// Returns the cells of the plane and adds their rings to `rings`, which holds the frame's border.
/// Parts come first, then the voids around them: inside the frame, and inside each hole. `None` if
/// a piece is cut open or nested differently in the two designs.
fn cells(pieces: &[PieceMatch], rings: &mut Vec<[Vec<DVec2>; 2]>) -> Option<Vec<FrameCell>> {
    let mut parts = Vec::new();
    // Voids are outside all parts: first the one inside the frame, then each hole, run backwards.
    let mut voids = vec![FrameCell(vec![(0, false)])];
    let mut outers = Vec::new();
    for piece in pieces {
        let [outer, holes @ ..] = piece.rings.as_slice() else {
            return None;
        };
        if outer.kind != RingKind::Matched {
            continue;
        }
        // A cut joins a hole with the outside, which are separate cells here.
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
    // A part must lie in the same void in both designs, or their cells do not correspond.
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

/// Returns the void that contains a part on one side: the smallest hole around it, or else the
/// frame (index 0). `None` if it lies inside another part.
fn surrounding(
    parts: &[FrameCell],
    voids: &[FrameCell],
    rings: &[[Vec<DVec2>; 2]],
    outer: usize,
    side: usize,
) -> Option<usize> {
    // Outlines do not cross, so one point decides for the whole outline.
    let p = rings[outer][side][0];
    let encloses = |ring: usize| winding(&rings[ring][side], p) != 0;
    // Counts the other parts around it.
    let around_it = parts.iter().map(|part| part.0[0].0);
    let depth = around_it
        .filter(|&own| own != outer && encloses(own))
        .count();
    let ring = |void: usize| voids[void].0[0].0;
    let holes: Vec<usize> = (1..voids.len()).filter(|&k| encloses(ring(k))).collect();
    // The smallest of the nested holes is the one directly around it.
    let area = |k: usize| signed_area(&rings[ring(k)][side]).abs();
    let smallest = (holes.iter().copied()).min_by(|&j, &k| area(j).total_cmp(&area(k)));
    // Each part around it must contribute a hole around it too, or it lies inside that part.
    (holes.len() == depth).then_some(smallest.unwrap_or(0))
}

/// Joins the cells into one mesh: the points of all rings once, then the inner vertices of each
/// cell.
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
            // In the order in which the cell runs along the ring.
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
        let wanted = MatchSettings {
            holes: HoleRule::Close,
            keep_up: true,
            ..MatchSettings::default()
        };
        let matched = match_regions(&a, &b, &wanted, &Silent).expect("a match");
        CompatibleMesh::around_outlines(&FRAME, &matched, &PolygonOptions::default(), &Silent)
    }

    /// Checks that each design's faces fill the frame once and that outlines are mesh edges: no
    /// face has corners on both sides of one.
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
