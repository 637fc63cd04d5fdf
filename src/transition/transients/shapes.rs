//! Shapes that are drawn for the parts that exist in only one design.

use crate::compatible::CompatibleMesh;
use crate::content::{SeedShape, SwellingShape};
use crate::geometry::{DVec2, signed_area};
use crate::warp::{Arap, TimeWindow};
use rayon::iter::Either;
use rayon::prelude::*;

/// Returns the parts that swell (grow in thickness within their outline), and the parts that grow
/// from a seed shape. `swelling` contains the indices of the pieces that swell; piece k is
/// component k of the mesh.
pub(in crate::transition) fn drawn(
    film: &Arap,
    swelling: &[usize],
) -> (Vec<SwellingShape>, Vec<SeedShape>) {
    let mesh = film.mesh();
    let (loops, parts) = (mesh.boundary_loops(), mesh.components());
    let drawn = |(piece, life): (usize, &Option<TimeWindow>)| {
        let life = (*life)?;
        let is_of_piece = |walk: &usize| {
            let first = loops[*walk].first();
            first.is_some_and(|&v| parts[v as usize] as usize == piece)
        };
        let walks: Vec<usize> = (0..loops.len()).filter(is_of_piece).collect();
        Some(match swelling.contains(&piece) {
            true => Either::Left(swell(mesh, &loops, walks, life)?),
            false => Either::Right(SeedShape {
                loop_indices: walks,
                window: life,
            }),
        })
    };
    // This runs in parallel, because the outlines of a swelling part take long to compute.
    let lives = film.time_windows().par_iter().enumerate();
    lives.filter_map(drawn).partition_map(|drawn| drawn)
}

/// Creates a swelling part from its boundary loops. `loops` holds all boundary loops, and `walks`
/// the indices of those of the part; `None` if there are none.
fn swell(
    mesh: &CompatibleMesh,
    loops: &[Vec<u32>],
    mut walks: Vec<usize>,
    life: TimeWindow,
) -> Option<SwellingShape> {
    let places = [mesh.source(), mesh.target()][life.side];
    let ring = |&walk: &usize| loops[walk].iter().map(|&v| places[v as usize]).collect();
    let mut rings: Vec<Vec<DVec2>> = walks.iter().map(ring).collect();
    // The outer loop comes first, because its points determine the position of the shape.
    let outer = |k: &usize| signed_area(&rings[*k]);
    let first = (0..walks.len()).max_by(|a, b| outer(a).total_cmp(&outer(b)))?;
    walks.swap(0, first);
    rings.swap(0, first);
    Some(SwellingShape::new(walks, &rings, life))
}
