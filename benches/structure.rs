//! Times the structural analysis of girders: one t with forces, displacements and the first
//! frequency, and the whole check at 241 values of t with the proof that the girder stands.
//!
//! `cargo bench --no-default-features --bench structure`

use criterion::Criterion;
use morphospace::Design;
use morphospace::design::{Truss, TrussLoad, TrussParts, TrussSupport};
use morphospace::geometry::DVec2;
use morphospace::structure::{FilmStructure, StructureLimits, TransitionStructure};
use morphospace::transition::{Transition, TransitionSpec};
use morphospace::work::progress::Silent;
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default().configure_from_args().sample_size(20);
    for panels in [25, 250] {
        let girders = [girder(panels, 0.0)?, girder(panels, 0.3)?];
        let bars = girders[0].bars().len();
        let [source, target] = girders.map(|truss| Arc::new(Design::new("girder", truss)));
        let transition = Transition::build(&TransitionSpec::new(source, target), &Silent)?;
        let mut structure = TransitionStructure::new(&transition)?;
        let mut t = 0.0;
        criterion.bench_function(&format!("{bars} bars, one t"), |bencher| {
            bencher.iter(|| {
                t = (t + 0.37) % 1.0;
                structure.solve(t).compliance
            });
        });
        criterion.bench_function(&format!("{bars} bars, 241 values of t"), |bencher| {
            let limits = StructureLimits::default();
            bencher.iter(|| FilmStructure::of(&transition, 241, &limits, &Silent));
        });
    }
    criterion.final_summary();
    Ok(())
}

/// Warren girder with verticals; its middle rises by the fraction `rise` of its length.
fn girder(panels: u32, rise: f64) -> Result<Truss, Box<dyn Error>> {
    let top = panels + 1;
    let length = 2.0 * f64::from(panels);
    let node = |y: f64| {
        move |k: u32| {
            let x = 2.0 * f64::from(k);
            let share = x / length;
            DVec2::new(x, y + 4.0 * rise * length * share * (1.0 - share))
        }
    };
    let mut bars: Vec<[u32; 2]> = (0..panels)
        .flat_map(|k| [[k, k + 1], [top + k, top + k + 1]])
        .collect();
    bars.extend((0..=panels).map(|k| [k, top + k]));
    bars.extend((0..panels).map(|k| match k % 2 {
        0 => [k + 1, top + k],
        _ => [k, top + k + 1],
    }));
    let support = |node: u32, x: bool| TrussSupport {
        node,
        fixed: [x, true, false],
        rolls_along: None,
    };
    let load = |node: u32| TrussLoad {
        node,
        force: DVec2::new(0.0, -20.0),
        moment: 0.0,
    };
    let nodes = (0..=panels)
        .map(node(0.0))
        .chain((0..=panels).map(node(2.0)));
    Ok(Truss::from_parts(TrussParts {
        nodes: nodes.collect(),
        areas: vec![4e-3; bars.len()],
        bars,
        supports: vec![support(0, true), support(panels, false)],
        loads: (1..panels).map(load).collect(),
        ..TrussParts::default()
    })?)
}
