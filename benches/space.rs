//! Times the map of six outlines of 150 points each. For a new position of the marker, it times the
//! weights, the blend of the designs as rigid parts, and the image of the blend as the window draws
//! it. For the whole map, it times the measurement of the blends on a grid of 64 × 64 positions.
//!
//! `cargo bench --no-default-features --bench space`

use criterion::Criterion;
use morphospace::design::Design;
use morphospace::export::{Drawing, PixelSize, PlaneView, rasterise};
use morphospace::geometry::DVec2;
use morphospace::measure::MapLandscape;
use morphospace::space::{DesignSpace, MapLayout, SpaceSpec, WeightMap};
use morphospace::transition::TransitionStyle;
use morphospace::work::progress::Silent;
use std::error::Error;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Number of points of each outline.
const POINTS: u32 = 150;

/// Width and height, in pixels, of the image of the blend in a window of 1280 × 720 pixels.
const SIZE: [u32; 2] = [360, 472];

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default().configure_from_args().sample_size(30);
    let designs: Vec<Arc<Design>> = (0..6).map(flower).collect::<Result<_, _>>()?;
    let space = DesignSpace::build(&SpaceSpec::new(designs), &Silent)?;
    // Without a common mesh the space would blend fields instead of rigid parts.
    space.family().ok_or("no common mesh")?;
    let map = WeightMap::new(&MapLayout::Polygon.sites(space.distances()))?;
    let mut frame = space.frame();
    let mut weights = [0.0; 6];
    let mut k = 0;
    let mut next_position = || {
        k += 1;
        DVec2::from_angle(f64::from(k) * 2.4) * (0.8 * (f64::from(k) * 0.618).fract().sqrt())
    };
    criterion.bench_function("weights and solve, 6 designs", |bencher| {
        bencher.iter(|| {
            map.weights(next_position(), &mut weights);
            frame.seek(&weights);
        });
    });
    let size = PixelSize::new(SIZE[0], SIZE[1])?;
    let bounds = space.bounds();
    let view = PlaneView::fit(bounds.padded(0.04 * bounds.diameter()), size);
    criterion.bench_function("weights, solve and draw, 6 designs", |bencher| {
        bencher.iter(|| {
            map.weights(next_position(), &mut weights);
            frame.seek(&weights);
            let mut drawing = Drawing::new(size, None);
            let tint = space.colour_fraction(&weights);
            drawing.push_figure(&frame.figure(), tint, &TransitionStyle::default(), &view);
            rasterise(&drawing)
        });
    });
    let mut slow = Criterion::default().configure_from_args().sample_size(10);
    slow.bench_function("64 x 64 measures of the map", |bencher| {
        bencher.iter(|| MapLandscape::measure(&space, &map, 64, 1.2, &Silent));
    });
    slow.final_summary();
    Ok(())
}

/// A smooth outline with `k` + 2 lobes.
fn flower(k: u32) -> Result<Arc<Design>, Box<dyn Error>> {
    let lobes = f64::from(k + 2);
    let corner = |i: u32| {
        let angle = TAU * f64::from(i) / f64::from(POINTS);
        let radius = 100.0 * (1.0 + 0.3 * (lobes * angle).cos());
        DVec2::from_angle(angle) * radius
    };
    let ring: Vec<DVec2> = (0..POINTS).map(corner).collect();
    Ok(Arc::new(Design::from_rings(format!("flower {k}"), [ring])?))
}
