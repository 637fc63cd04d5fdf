//! How the parts of a film are drawn that one of the designs has alone.

use crate::compatible::CompatibleMesh;
use crate::content::{SeedShape, SwellingShape};
use crate::geometry::{DVec2, signed_area};
use crate::warp::{Arap, TimeWindow};
use rayon::iter::Either;
use rayon::prelude::*;

/// The parts that swell, which are the pieces with these numbers and connected
/// parts of the film's mesh, and those that grow.
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
    // How thick each is takes some time.
    let lives = film.time_windows().par_iter().enumerate();
    lives.filter_map(drawn).partition_map(|drawn| drawn)
}

/// A part of these walks that swells; none of one without a boundary.
fn swell(
    mesh: &CompatibleMesh,
    loops: &[Vec<u32>],
    mut walks: Vec<usize>,
    life: TimeWindow,
) -> Option<SwellingShape> {
    let places = [mesh.source(), mesh.target()][life.side];
    let ring = |&walk: &usize| loops[walk].iter().map(|&v| places[v as usize]).collect();
    let mut rings: Vec<Vec<DVec2>> = walks.iter().map(ring).collect();
    // The outer walk first, by which it is placed.
    let outer = |k: &usize| signed_area(&rings[*k]);
    let first = (0..walks.len()).max_by(|a, b| outer(a).total_cmp(&outer(b)))?;
    walks.swap(0, first);
    rings.swap(0, first);
    Some(SwellingShape::new(walks, &rings, life))
}
