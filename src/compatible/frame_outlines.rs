//! A mesh of the whole frame in which matched outlines are edges.
//!
//! Inside and outside of the outlines are triangulated each on its own and
//! sewn together along the outlines. So it exists for whatever is matched,
//! where a mesh with pins alone may not, and carries boundaries exactly.
//! Rings that close to a point or open from one are left out: what they bound
//! is inside.

use super::assembly::MeshAssembly;
use super::border::border_points;
use super::{CompatibleError, CompatibleMesh, PieceMeshError, PolygonOptions};
use crate::correspondence::{PieceMatch, RegionMatch, RingKind, RingMatch};
use crate::geometry::{Bounds, DVec2, signed_area, winding};
use crate::work::progress::{Progress, ProgressShares};
use rayon::prelude::*;

/// Points along the longer side of the frame: half as many as about pins, since
/// outlines bring points of their own.
const ALONG: f64 = 12.0;

/// Why there is no such mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameOutlinesError {
    /// The outlines do not lie within each other alike in both designs, are
    /// cut open, or reach beyond the frame.
    #[error("the parts of the designs lie within each other in different ways")]
    Nesting,
    /// The cells do not fit together along the outlines.
    #[error("the cells between the outlines do not fit together: {0}")]
    Sewn(#[from] CompatibleError),
    /// A cell was not triangulated.
    #[error(transparent)]
    Polygons(#[from] PieceMeshError),
}

/// A connected piece of the plane between outlines: the ring around it and
/// those within it, each by its number and whether it is walked backwards.
struct FrameCell(Vec<(usize, bool)>);

impl CompatibleMesh {
    /// Triangulates a rectangle about the outlines of a match, the same in
    /// both designs.
    ///
    /// # Errors
    /// [`FrameOutlinesError`] where outlines lie within each other in different
    /// ways, or if the work is cancelled.
    ///
    /// # Panics
    /// If an outline of the match has no points.
    pub fn around_outlines(
        frame: &Bounds,
        matched: &RegionMatch,
        options: &PolygonOptions,
        progress: &dyn Progress,
    ) -> Result<Self, FrameOutlinesError> {
        let border = border_points(frame, frame.size().max_element() / ALONG);
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
                let walked = |&(ring, backwards): &(usize, bool)| {
                    let mut points = rings[ring][side].clone();
                    if backwards {
                        points.reverse();
                    }
                    points
                };
                cell.0.iter().map(walked).collect()
            };
            Self::from_piece(&side(0), &side(1), options, &shares.part(k))
        });
        let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
        Ok(sewn(&rings, &cells, &meshes)?)
    }
}

/// The cells of the plane, and all rings, the frame's first. A part inside,
/// then what is around it: the frame, or a hole of another part.
fn cells(pieces: &[PieceMatch], rings: &mut Vec<[Vec<DVec2>; 2]>) -> Option<Vec<FrameCell>> {
    let mut parts = Vec::new();
    // What is outside: first the frame, then each hole, walked backwards.
    let mut voids = vec![FrameCell(vec![(0, false)])];
    let mut outers = Vec::new();
    for piece in pieces {
        let [outer, holes @ ..] = piece.rings.as_slice() else {
            return None;
        };
        if outer.kind != RingKind::Matched {
            continue;
        }
        // A cut joins a hole with the outside, which here are cells of their own.
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

/// The void that a part lies in on one side: the hole around it with no other
/// part between, or else the frame. None where it lies in a part.
fn surrounding(
    parts: &[FrameCell],
    voids: &[FrameCell],
    rings: &[[Vec<DVec2>; 2]],
    outer: usize,
    side: usize,
) -> Option<usize> {
    // Outlines do not cross, so that one point tells for the whole.
    let p = rings[outer][side][0];
    let encloses = |ring: usize| winding(&rings[ring][side], p) != 0;
    let around_it = parts.iter().map(|part| part.0[0].0);
    let depth = around_it
        .filter(|&own| own != outer && encloses(own))
        .count();
    let ring = |void: usize| voids[void].0[0].0;
    let holes: Vec<usize> = (1..voids.len()).filter(|&k| encloses(ring(k))).collect();
    // The smallest hole around it; holes of one depth do not overlap.
    let area = |k: usize| signed_area(&rings[ring(k)][side]).abs();
    let smallest = (holes.iter().copied()).min_by(|&j, &k| area(j).total_cmp(&area(k)));
    // Each part around it has a hole around it too, or it lies in the part.
    (holes.len() == depth).then_some(smallest.unwrap_or(0))
}

/// The cells as one mesh: the rings' points once, then what is inside each.
fn sewn(
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
            // As its cell has walked it: the outside of a part runs backwards.
            let walk = (0..count).map(|k| first[ring] + if backwards { count - 1 - k } else { k });
            shared.extend(walk);
        }
        let points = [mesh.source(), mesh.target()];
        whole.add(&shared, points, mesh.faces().iter().copied());
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

    /// Each design's faces fill the frame once, and outlines are edges: no
    /// face has its corners on both sides of one.
    fn assert_sewn(mesh: &CompatibleMesh, outlines: [&[Vec<DVec2>]; 2]) {
        assert_eq!(mesh.boundary_loops().len(), 1, "sewn without a gap");
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
        assert_sewn(&around(&a, &b).expect("a mesh"), [&a, &b]);
    }

    #[test]
    fn a_part_in_a_hole_of_another_is_sewn_in() {
        let eye = |by: f64| [square(by, 6.0), square(by, 4.0), square(by, 2.0)];
        let [a, b] = [eye(0.0), eye(1.0)];
        assert_sewn(&around(&a, &b).expect("a mesh"), [&a, &b]);
    }

    #[test]
    fn a_hole_that_closes_is_inside() {
        let [a, b] = [
            vec![square(0.0, 5.0), square(0.0, 1.0)],
            vec![square(0.0, 4.0)],
        ];
        assert_sewn(&around(&a, &b).expect("a mesh"), [&a[..1], &b]);
    }

    #[test]
    fn what_reaches_beyond_the_frame_is_refused() {
        let found = around(&[square(0.0, 12.0)], &[square(0.0, 4.0)]);
        assert_eq!(found.err(), Some(FrameOutlinesError::Nesting));
    }
}
