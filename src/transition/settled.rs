//! Parts that keep out of each other's way.
//!
//! Parts of both designs that would go through each other are let go, before
//! anything else is chosen: what is there dies, and what it was to become is
//! born. In the film that is chosen all that is born or dies then gets its
//! place and its time.

use super::births::{self, lives};
use super::conflicts::in_the_way;
use super::error::BuildError;
use super::rigid::arap;
use super::spec::TransitionSpec;
use crate::compatible::{CompatibleMesh, PieceMeshes};
use crate::correspondence::{Prepared, RegionMatch};
use crate::progress::{Progress, Span};
use crate::warp::Arap;

/// How often pieces are let go: what was split is split anew, and may meet
/// anew.
const ROUNDS: u32 = 3;

/// The match that was asked for, once what would go through other parts in
/// its film is let go, with its mesh and its film.
pub(super) fn parted(
    prepared: &mut Prepared,
    spec: &TransitionSpec,
    progress: &dyn Progress,
) -> Result<(RegionMatch, CompatibleMesh, Arap), BuildError> {
    let options = &spec.options;
    let mut meshes = PieceMeshes::default();
    let mut round = 0;
    loop {
        // Most films need one round, few the last.
        let done = |rounds: u32| 1.0 - 0.5_f64.powi(rounds as i32);
        let progress = &Span::new(progress, done(round), done(round + 1));
        let [matching, meshing, filming] =
            [(0.0, 0.2), (0.2, 0.9), (0.9, 1.0)].map(|(from, to)| Span::new(progress, from, to));
        let matched = prepared.matched_as_asked(&matching)?;
        let mesh = meshes.of(&matched, &options.triangulation, &meshing)?;
        let film = arap(&mesh, &options.arap, &lives(&matched), &filming)?;
        let gone = in_the_way(&matched, &film, progress)?;
        if round == ROUNDS || !prepared.let_go(&matched, &gone, progress) {
            return Ok((matched, mesh, film));
        }
        round += 1;
    }
}

/// The match and its film with all that is born or dies in its place and time.
pub(super) fn placed(
    (matched, film): (RegionMatch, Arap),
    progress: &dyn Progress,
) -> Result<(RegionMatch, Arap), BuildError> {
    // Where the film is subdivided its mesh is too: it is not divided again.
    let (mesh, once) = (film.mesh(), film.options());
    Ok(match births::placed(&matched, mesh, &film, progress)? {
        Some(placed) => {
            let film = arap(&placed.mesh, once, &placed.lives, progress)?;
            (placed.matched, film)
        }
        None => (matched, film),
    })
}
