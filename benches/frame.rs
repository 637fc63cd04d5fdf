//! Times the construction and the frames of as-rigid-as-possible interpolations with 1,000, 10,000
//! and 100,000 vertices. For comparison, times faer's own back-substitution with the same matrix.
//!
//! `cargo bench --no-default-features --bench frame`
//!
//! - `build`: affine maps of the faces, assembly of the matrix, and factorisation
//! - `bare`: solution of the linear system by faer alone, for two right-hand sides and with reused
//!   memory
//! - `solve`: the same solution by this library
//! - `frame`: a whole frame (right-hand sides, solution, vertex positions)

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, MatMut, Par, Side};
use morphospace::compatible::CompatibleMesh;
use morphospace::geometry::DVec2;
use morphospace::numerics::{Cholesky, SymmetricMatrix};
use morphospace::warp::{Arap, ArapOptions, Warp};
use morphospace::work::progress::Silent;
use std::hint::black_box;

/// A square sheet of `side` × `side` vertices that bends into a half ring.
fn sheet(side: u32) -> CompatibleMesh {
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
    CompatibleMesh::new(faces, source, target, Vec::new()).expect("a valid sheet")
}

/// A Cholesky factor computed by faer without this library.
struct FaerCholesky {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl FaerCholesky {
    fn new(matrix: &SymmetricMatrix, threshold: SupernodalThreshold) -> Self {
        let n = matrix.size();
        let entries: Vec<_> = matrix
            .entries()
            .map(|(i, j, v)| Triplet::new(i, j, v))
            .collect();
        let lower = SparseColMat::<u32, f64>::try_new_from_triplets(n, n, &entries).expect("valid");
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: threshold,
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(
            lower.symbolic(),
            Side::Lower,
            SymmetricOrdering::Amd,
            params,
        )
        .expect("fits");
        let mut values = vec![0.0; symbolic.len_val()];
        let request = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        symbolic
            .factorize_numeric_llt(
                &mut values,
                lower.as_ref(),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(request)),
                Default::default(),
            )
            .expect("positive definite");
        let memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(2, Par::Seq));
        Self {
            symbolic,
            values,
            memory,
        }
    }

    fn solve(&mut self, rhs: &mut [f64]) {
        let n = self.symbolic.nrows();
        faer::sparse::linalg::cholesky::LltRef::new(&self.symbolic, &self.values)
            .solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(rhs, n, 2),
                Par::Seq,
                MemStack::new(&mut self.memory),
            );
    }
}

fn frames(c: &mut Criterion) {
    for (name, side) in [("1k", 32), ("10k", 100), ("100k", 317)] {
        let mesh = sheet(side);
        let mut group = c.benchmark_group("arap");
        group.sample_size(if side > 200 { 20 } else { 50 });
        let build = || Arap::build(&mesh, &ArapOptions::default(), &Silent).expect("valid");
        group.bench_function(BenchmarkId::new("build", name), |b| b.iter(build));
        let arap = build();
        let matrix = arap.system();
        let rhs: Vec<f64> = (0..2 * matrix.size()).map(|i| (i as f64).sin()).collect();
        let mut x = rhs.clone();
        for (kind, threshold) in [
            ("simplicial", SupernodalThreshold::FORCE_SIMPLICIAL),
            ("supernodal", SupernodalThreshold::FORCE_SUPERNODAL),
        ] {
            let mut bare = FaerCholesky::new(&matrix, threshold);
            group.bench_function(BenchmarkId::new(format!("bare {kind}"), name), |b| {
                b.iter(|| {
                    x.copy_from_slice(&rhs);
                    bare.solve(black_box(&mut x));
                });
            });
        }
        let cholesky = Cholesky::factor(&matrix).expect("positive definite");
        let mut workspace = cholesky.workspace(2);
        group.bench_function(BenchmarkId::new("solve", name), |b| {
            b.iter(|| {
                x.copy_from_slice(&rhs);
                cholesky.solve_ordered(black_box(&mut x), &mut workspace);
            });
        });
        let mut placer = arap.placer();
        let mut t = 0.0;
        group.bench_function(BenchmarkId::new("frame", name), |b| {
            b.iter(|| {
                t = (t + 0.01) % 1.0;
                placer.place(black_box(t));
            });
        });
        group.finish();
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
