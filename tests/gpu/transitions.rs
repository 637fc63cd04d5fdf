//! Transitions that the GPU tests render.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use image::{Rgba, RgbaImage};
use morphospace::content::{BlendSpace, ContentKind, FieldBlend};
use morphospace::correspondence::HoleRule;
use morphospace::design::{Design, DesignForm, Picture, Truss};
use morphospace::geometry::{DVec2, FillRule, Regions};
use morphospace::mesh::TriangleMesh;
use morphospace::project::gallery;
use morphospace::transition::{Transition, TransitionMethod, TransitionSpec};
use morphospace::warp::WarpKind;
use morphospace::work::progress::Silent;

fn design(form: impl Into<DesignForm>) -> Arc<Design> {
    Arc::new(Design::new("scene", form))
}

fn build(spec: &TransitionSpec) -> Transition {
    Transition::build(spec, &Silent).expect("a transition")
}

/// A strip that bends into a quarter of a ring; `offset` is added to all coordinates.
pub fn solid(offset: f64) -> Transition {
    strip(24, offset, |p| {
        let angle = FRAC_PI_2 * p.x / 6.0;
        DVec2::from_angle(FRAC_PI_2 - angle) * (2.5 + p.y)
    })
}

/// A strip that winds up into a spiral by `turn` radians.
pub fn spiral(turn: f64) -> Transition {
    strip(96, 0.0, |p| {
        let angle = turn * p.x / 24.0;
        DVec2::from_angle(-angle).perp() * (4.0 + 0.3 * (turn - angle) + p.y)
    })
}

/// Transition from a triangulated strip with `columns` columns to the image of the strip under the
/// mapping `bent`; `offset` is added to all coordinates of both strips.
fn strip(columns: u32, offset: f64, bent: impl Fn(DVec2) -> DVec2) -> Transition {
    let mesh = |map: &dyn Fn(DVec2) -> DVec2| {
        let rows = 4;
        let at = |i: u32| DVec2::new(f64::from(i / (rows + 1)), f64::from(i % (rows + 1))) / 4.0;
        let positions = (0..(columns + 1) * (rows + 1))
            .map(|i| map(at(i)) + DVec2::splat(offset))
            .collect();
        let faces = (0..columns * rows).flat_map(|i| {
            let a = (i / rows) * (rows + 1) + i % rows;
            let [b, c, d] = [a + rows + 1, a + rows + 2, a + 1];
            [[a, b, c], [a, c, d]]
        });
        DesignForm::Mesh(TriangleMesh::new(positions, faces.collect()).expect("a mesh"))
    };
    let source = design(mesh(&|p| p));
    let target = design(mesh(&bent));
    build(&TransitionSpec::new(source, target))
}

/// A plate that becomes an L; the four holes of the plate close on the way.
pub fn perforated() -> Transition {
    let block = |x: f64, y: f64, w: f64, h: f64| {
        let corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)];
        corners.map(DVec2::from).to_vec()
    };
    let mut plate = vec![block(0.0, 0.0, 9.0, 3.0)];
    plate.extend((0..4).map(|k| block(0.6 + 2.2 * f64::from(k), 1.0, 1.2, 1.0)));
    let corner = [
        (0.0, 0.0),
        (6.0, 0.0),
        (6.0, 6.0),
        (3.5, 6.0),
        (3.5, 2.5),
        (0.0, 2.5),
    ];
    let corner = vec![corner.map(DVec2::from).to_vec()];
    let [source, target] = [plate, corner].map(|rings| {
        let regions = Regions::from_rings(&rings, FillRule::EvenOdd).expect("regions");
        design(DesignForm::Outline(regions))
    });
    let mut spec = TransitionSpec::new(source, target);
    spec.options.matching.holes = HoleRule::Transient;
    build(&spec)
}

/// A truss girder whose upper chord rises into an arch.
pub fn truss() -> Transition {
    let panels = 6;
    let truss = |rise: f64| {
        let lower = (0..=panels).map(|i| DVec2::new(f64::from(i), 0.0));
        let upper = (0..panels).map(|i| {
            let x = f64::from(i) + 0.5;
            let along = x / f64::from(panels);
            DVec2::new(x, 1.0 + rise * 4.0 * along * (1.0 - along))
        });
        let first_upper = panels + 1;
        let mut bars: Vec<[u32; 2]> = Vec::new();
        for i in 0..panels {
            let top = first_upper + i;
            bars.extend([[i, i + 1], [i, top], [top, i + 1]]);
            if i + 1 < panels {
                bars.push([top, top + 1]);
            }
        }
        let truss = Truss::new(lower.chain(upper).collect(), bars).expect("a truss");
        DesignForm::Truss(truss)
    };
    let mut spec = TransitionSpec::new(design(truss(0.0)), design(truss(2.0)));
    spec.options.bar_width = 0.02;
    build(&spec)
}

/// An ellipse with 96 corners; `squash` is the ratio of its height to its width.
fn ring(centre: DVec2, radius: f64, squash: f64) -> Vec<DVec2> {
    let corner = |i: u32| DVec2::from_angle(TAU * f64::from(i) / 96.0);
    (0..96)
        .map(|i| centre + corner(i) * DVec2::new(radius, radius * squash))
        .collect()
}

/// Field blends from an annulus to two ellipses, with their names. Two use the logarithmic scale of
/// distances, with different lengths `epsilon`; one uses the linear scale.
pub fn field() -> Vec<(&'static str, Transition)> {
    let regions = |rings: &[Vec<DVec2>]| {
        design(DesignForm::Outline(
            Regions::from_rings(rings, FillRule::EvenOdd).expect("regions"),
        ))
    };
    let source = regions(&[ring(DVec2::ZERO, 2.0, 0.9), ring(DVec2::ZERO, 1.1, 1.0)]);
    let target = regions(&[
        ring(DVec2::new(-1.6, 0.3), 0.9, 1.5),
        ring(DVec2::new(1.6, -0.3), 1.0, 0.7),
    ]);
    let blends = [
        ("field-log", BlendSpace::Log, 1.0, 0.0),
        ("field-sharp", BlendSpace::Log, 0.01, 0.0),
        ("field-real", BlendSpace::Real, 1.0, -2.5),
    ];
    let cell = TransitionMethod::new(WarpKind::None, ContentKind::Field).expect("a cell");
    let transition = |(name, space, epsilon, threshold)| {
        let mut spec = TransitionSpec::new(source.clone(), target.clone());
        spec.method = cell;
        spec.options.field.cells = 200;
        spec.options.field.blend = FieldBlend {
            space,
            epsilon,
            threshold,
        };
        (name, build(&spec))
    };
    blends.map(transition).into()
}

/// Transition of a gallery project.
pub fn from_gallery(name: &str) -> Transition {
    let spec = gallery::load(name).and_then(|loaded| loaded.spec());
    build(&spec.expect("a bundled project"))
}

/// Transition of a gallery project, whose pictures are cut to discs with soft edges.
pub fn faded(name: &str) -> Transition {
    let spec = gallery::load(name).and_then(|loaded| loaded.spec());
    let mut spec = spec.expect("a bundled project");
    for design in [&mut spec.source, &mut spec.target] {
        let design = Arc::make_mut(design);
        design.picture = design.picture.as_ref().map(disc);
    }
    build(&spec)
}

/// The picture, cut to a disc with a soft edge.
fn disc(picture: &Picture) -> Picture {
    let (width, height) = picture.pixels().dimensions();
    let picture_centre = DVec2::new(f64::from(width), f64::from(height)) / 2.0;
    let radius = picture_centre.min_element();
    let pixel = |x: u32, y: u32| {
        let Rgba([r, g, b, _]) = *picture.pixels().get_pixel(x, y);
        let centre = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let inside = 3.0 - 4.0 * centre.distance(picture_centre) / radius;
        Rgba([r, g, b, (255.0 * inside.clamp(0.0, 1.0)) as u8])
    };
    Picture::new(RgbaImage::from_fn(width, height, pixel)).transformed(picture.place())
}
