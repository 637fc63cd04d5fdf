//! How the parts of a film are drawn that one of the designs has alone.

use crate::compatible::CompatibleMesh;
use crate::content::{Speck, Swell};
use crate::geometry::{DVec2, Side, signed_area};
use crate::warp::{Arap, Life};
use rayon::iter::Either;
use rayon::prelude::*;

/// The parts that swell, which are the pieces with these numbers and connected
/// parts of the film's mesh, and those that grow.
pub(super) fn drawn(film: &Arap, swelling: &[usize]) -> (Vec<Swell>, Vec<Speck>) {
    let mesh = film.mesh();
    let (loops, parts) = (mesh.boundary_loops(), mesh.components());
    let drawn = |(piece, life): (usize, &Option<Life>)| {
        let life = (*life)?;
        let is_of_piece = |walk: &usize| {
            let first = loops[*walk].first();
            first.is_some_and(|&v| parts[v as usize] as usize == piece)
        };
        let walks: Vec<usize> = (0..loops.len()).filter(is_of_piece).collect();
        let part = Part::of(mesh, &loops, walks);
        Some(match swelling.contains(&piece) {
            true => Either::Left(part.swell(life)?),
            false => Either::Right(part.speck(life)),
        })
    };
    // How thick each is takes some time.
    let lives = film.lives().par_iter().enumerate();
    lives.filter_map(drawn).partition_map(|drawn| drawn)
}

/// A part of one design alone.
struct Part {
    side: Side,
    /// The numbers of its walks.
    walks: Vec<usize>,
    /// Where they are in that design.
    rings: Vec<Vec<DVec2>>,
}

impl Part {
    fn of(mesh: &CompatibleMesh, loops: &[Vec<u32>], walks: Vec<usize>) -> Self {
        let mut ends = [mesh.source(), mesh.target()].map(|places| {
            let ring = |&walk: &usize| loops[walk].iter().map(|&v| places[v as usize]).collect();
            walks.iter().map(ring).collect::<Vec<Vec<DVec2>>>()
        });
        let area = |rings: &[Vec<DVec2>]| rings.iter().map(|ring| signed_area(ring)).sum::<f64>();
        let [source, target] = ends.each_ref().map(|rings| area(rings));
        let side = if source > target {
            Side::Source
        } else {
            Side::Target
        };
        Self {
            side,
            walks,
            rings: std::mem::take(&mut ends[side]),
        }
    }

    fn speck(self, life: Life) -> Speck {
        Speck {
            walks: self.walks,
            side: self.side,
            life,
        }
    }

    /// None of a part without a boundary.
    fn swell(mut self, life: Life) -> Option<Swell> {
        // The outer walk first, by which it is placed.
        let outer = |k: &usize| signed_area(&self.rings[*k]);
        let first = (0..self.walks.len()).max_by(|a, b| outer(a).total_cmp(&outer(b)))?;
        self.walks.swap(0, first);
        self.rings.swap(0, first);
        Some(Swell::new(self.side, self.walks, &self.rings, life))
    }
}
