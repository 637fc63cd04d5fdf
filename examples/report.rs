//! Prints the measures of a gallery project's transition as JSON; needs only the core library.
//!
//! `cargo run --release --no-default-features --example report [GALLERY NAME]`

use std::error::Error;

use morphospace::measure::{self, Verdict};
use morphospace::project::gallery;
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;
use serde_json::{Value, json};

/// Number of values of t, from 0 to 1, at which the film is measured.
const SAMPLES: usize = 33;

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1);
    let report = report(name.as_deref().unwrap_or("triangle-polar"))?;
    serde_json::to_writer_pretty(std::io::stdout().lock(), &report)?;
    Ok(())
}

/// Measures of the mesh and of the film of the gallery project `name`, and the defects of the film.
pub fn report(name: &str) -> Result<Value, Box<dyn Error>> {
    let loaded = gallery::load(name)?;
    let transition = Transition::build(&loaded.spec()?, &Silent)?;
    let film = measure::film_report(&transition, SAMPLES, &Silent)?;
    let verdict = Verdict::of_film(&transition, &film, &Silent)?;
    Ok(json!({
        "title": loaded.title(),
        "verdict": verdict.headline(),
        "findings": verdict.findings,
        "mesh": transition.compatible().and_then(measure::mesh_report),
        "film": film,
    }))
}
