//! Times the recording of warps of 100,000 and a million vertices. Also times the frames of these
//! warps, once solved by the warp and once played from its recording.
//!
//! `cargo bench --no-default-features --bench film`. If the environment variable `FILM_CHOLMOD` is
//! set, the run also times CHOLMOD's back-substitution with the matrix of each warp
//! (`benches/film_cholmod.sh`).
//!
//! - `solved`: a frame computed by the warp (right-hand sides of its linear system, solution,
//!   vertex positions)
//! - `played`: the same frame evaluated from the recording on all threads
//! - `played, 1 thread`: the same on one thread

use criterion::{BenchmarkId, Criterion};
use morphospace::compatible::CompatibleMesh;
use morphospace::geometry::DVec2;
use morphospace::recording::{Recording, RecordingOptions};
use morphospace::warp::{Arap, ArapOptions, Placer, Warp};
use morphospace::work::progress::Silent;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::error::Error;
use std::hint::black_box;
use std::io::{BufWriter, Write};
use std::process::Command;
use std::sync::Arc;
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// A square sheet of `side` × `side` vertices that bends into a half ring.
fn sheet(side: u32) -> Result<CompatibleMesh> {
    let step = 1.0 / f64::from(side - 1);
    let source: Vec<DVec2> = (0..side * side)
        .map(|i| DVec2::new(f64::from(i % side), f64::from(i / side)) * step)
        .collect();
    let bent = |p: &DVec2| DVec2::from_angle(3.0 * p.x) * (1.5 - p.y);
    let target = source.iter().map(bent).collect();
    let faces = (0..(side - 1) * (side - 1))
        .flat_map(|i| {
            let v = i / (side - 1) * side + i % (side - 1);
            [[v, v + 1, v + side + 1], [v, v + side + 1, v + side]]
        })
        .collect();
    Ok(CompatibleMesh::new(faces, source, target, Vec::new())?)
}

/// Time, in milliseconds, of one back-substitution by CHOLMOD with the matrix of `arap`: the median
/// of `runs` runs.
fn cholmod_ms(arap: &Arap, runs: u32) -> Result<f64> {
    let matrix = arap.system();
    let path = std::env::temp_dir().join(format!("morphospace-film-{}.mtx", std::process::id()));
    let mut file = BufWriter::new(std::fs::File::create(&path)?);
    let mut entries = std::collections::BTreeMap::new();
    for (i, j, value) in matrix.entries() {
        *entries.entry((i.max(j), i.min(j))).or_insert(0.0) += value;
    }
    let n = matrix.size();
    writeln!(file, "%%MatrixMarket matrix coordinate real symmetric")?;
    writeln!(file, "{n} {n} {}", entries.len())?;
    for ((i, j), value) in entries {
        writeln!(file, "{} {} {value:e}", i + 1, j + 1)?;
    }
    file.into_inner()?.sync_all()?;
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/film_cholmod.sh");
    let out = Command::new(script)
        .arg(&path)
        .arg(runs.to_string())
        .output()?;
    std::fs::remove_file(&path)?;
    if !out.status.success() {
        return Err(String::from_utf8_lossy(&out.stderr).into());
    }
    Ok(String::from_utf8(out.stdout)?.trim().parse()?)
}

/// Times the frames that `placer` computes on `threads`, with a different t for each frame.
fn play(criterion: &mut Criterion, id: BenchmarkId, mut placer: Placer, threads: &ThreadPool) {
    let mut group = criterion.benchmark_group("film");
    group.sample_size(20);
    let mut t = 0.0;
    group.bench_function(id, |b| {
        b.iter(|| {
            t = (t + 0.01) % 1.0;
            threads.install(|| placer.place(black_box(t)));
        });
    });
    group.finish();
}

#[expect(
    clippy::print_stdout,
    reason = "recording is timed once, not by criterion"
)]
fn main() -> Result<()> {
    let mut criterion = Criterion::default().configure_from_args();
    let [one, all] = [1, 0].map(|threads| ThreadPoolBuilder::new().num_threads(threads).build());
    let (one, all) = (one?, all?);
    for (name, side) in [("100k", 317), ("1M", 1000)] {
        let arap = Arap::build(&sheet(side)?, &ArapOptions::default(), &Silent)?;
        let start = Instant::now();
        let recording = Recording::record(
            Arc::new(arap.clone()),
            &RecordingOptions::default(),
            &Silent,
        )?;
        println!(
            "{name}: recorded in {:.3} s by {} solves, {} bytes a vertex, error {:.1e}",
            start.elapsed().as_secs_f64(),
            recording.evaluation_count(),
            recording.bytes() / (side * side) as usize,
            recording.error(),
        );
        if std::env::var_os("FILM_CHOLMOD").is_some() {
            println!(
                "CHOLMOD, simplicial, {name}: {:.3} ms",
                cholmod_ms(&arap, 15)?
            );
        }
        let mut play = |kind: &str, placer: Placer, threads: &ThreadPool| {
            play(
                &mut criterion,
                BenchmarkId::new(kind, name),
                placer,
                threads,
            );
        };
        play("solved", arap.placer(), &all);
        play("played", recording.placer(), &all);
        play("played, 1 thread", recording.placer(), &one);
    }
    criterion.final_summary();
    Ok(())
}
