//! A mesh of the whole frame whose pins lie where they are in each design.
//!
//! The frame's border stays where it is. Between it and the pins points are
//! spread evenly and triangulated (Delaunay) in the source; carried to the
//! target harmonically, and without folds (see [`crate::compatible::polygons::transfer`]).
//!
//! Guaranteed: pins are met bit by bit, faces are positive in both designs.
//! Not guaranteed: that every set of pins can be met; pins that cross have no
//! such mesh, and are named.

use super::options::PolygonOptions;
use super::pair_mesh::{PairMesh, unit_scale};
use super::{quality, transfer};
use crate::compatible::border::border_points;
use crate::compatible::{CompatibleError, CompatibleMesh};
use crate::correspondence::PointPair;
use crate::geometry::{Bounds, DVec2, Side};
use crate::mesh::triangulation::{TriangulationError, delaunay};
use crate::work::progress::{Cancelled, Progress, ProgressSpan, checkpoint, still_wanted};

/// Points along the longer side of the frame: some 700 in all in a square one.
/// About pins that are near each other they stand closer anyway.
const ALONG: f64 = 24.0;

/// How near to another point, in spacings, none is put: less than the 0.87
/// between two rows, and as much of it as keeps faces from being thin.
const CLEAR: f64 = 0.6;

/// The narrowest spacing between a pin and the next one, as a share of their
/// distance, and by how much it widens with the distance from the pin: a row
/// or two between two pins, and sizes that less than double in two rows.
const NARROWER: f64 = 0.35;
const GRADING: f64 = 0.35;

/// Rows may be narrower by powers of two: down to 1/32, which is what pins ask
/// for that are 1/270 of the frame apart.
const LEVELS: u32 = 6;

/// Most points in all: each place is held against all points before it.
const MOST_POINTS: usize = 8_000;

/// Steps on the way to the target. Each is a minimisation of its own; in one
/// step the edges would stay those of the source.
const STEPS: u32 = 6;

/// How much of the work is done at the target, as it is told.
const CARRIED: f64 = 0.7;

/// Pins nearer than this share of the frame in either design are one: no
/// hand puts them so near, and between them faces would be slivers.
const SAME: f64 = 1e-6;

/// Why the frame was not triangulated. Pins are counted from 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FramePinsError {
    /// A pin is not finite, or not inside the frame.
    #[error("pin {} lies outside the frame of the {side} design; move it inside", pin + 1)]
    Outside {
        /// Counted from 0.
        pin: usize,
        /// In which design.
        side: Side,
    },
    /// Two pins coincide in one design and not in the other.
    #[error("pins {} and {} are one point in the {side} design and two in the other; delete one of them", pins[0] + 1, pins[1] + 1)]
    Coincide {
        /// Counted from 0.
        pins: [usize; 2],
        /// Where they coincide.
        side: Side,
    },
    /// No map without folds was found that meets all pins.
    #[error("the plane would have to fold about {}; move or delete {}", listed(pins), if pins.len() == 1 { "it" } else { "some of them" })]
    Folds {
        /// Those at the folds, counted from 0.
        pins: Vec<usize>,
    },
    /// Sizes that floating point cannot measure.
    #[error(transparent)]
    Triangulation(#[from] TriangulationError),
    /// The mesh is not valid in the frame's own coordinates.
    #[error("the mesh about the pins lost its validity: {0}")]
    Mesh(#[from] CompatibleError),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn listed(pins: &[usize]) -> String {
    let numbers: Vec<String> = pins.iter().map(|pin| (pin + 1).to_string()).collect();
    let pin = if numbers.len() == 1 { "pin" } else { "pins" };
    format!("{pin} {}", numbers.join(", "))
}

impl CompatibleMesh {
    /// Triangulates a rectangle so that each pin is a vertex, at its place in
    /// the source and at its place in the target; the border is the same in
    /// both. The border's vertices come first, then the pins.
    ///
    /// # Errors
    /// [`FramePinsError`] for pins outside the rectangle and for pins that no map
    /// without folds can meet, or if the work is cancelled.
    ///
    /// ```
    /// use morphospace::compatible::CompatibleMesh;
    /// use morphospace::correspondence::PointPair;
    /// use morphospace::geometry::{Bounds, DVec2};
    /// use morphospace::work::progress::Silent;
    /// let frame = Bounds { min: DVec2::ZERO, max: DVec2::new(4.0, 3.0) };
    /// let pin = PointPair { source: DVec2::new(1.0, 1.0), target: DVec2::new(2.5, 2.0) };
    /// let mesh = CompatibleMesh::around_pins(&frame, &[pin], &Silent)?;
    /// let k = mesh.source().iter().position(|p| *p == pin.source).expect("a vertex");
    /// assert_eq!(mesh.target()[k], pin.target);
    /// # Ok::<(), morphospace::compatible::PinnedError>(())
    /// ```
    pub fn around_pins(
        frame: &Bounds,
        pins: &[PointPair],
        progress: &dyn Progress,
    ) -> Result<Self, FramePinsError> {
        let pins = distinct(frame, pins)?;
        let border = border_points(frame, spacing(frame));
        let ends = |side: Side| {
            let ends = pins.iter().map(|(_, pin)| pin[side]);
            border.iter().copied().chain(ends).collect::<Vec<DVec2>>()
        };
        let given = Side::BOTH.map(ends);
        let fixed = given[0].len();
        let mut source = given[0].clone();
        source.extend(filling(frame, border.len(), &given, progress)?);
        let scale = unit_scale(&source);
        let scaled = |points: &[DVec2]| points.iter().map(|p| *p * scale).collect::<Vec<_>>();
        let (source, to) = (scaled(&source), scaled(&given[1]));
        let faces = delaunay(&source)?;
        let mut mesh = PairMesh::new(fixed, [source.clone(), source], faces);
        transfer::split_chords(&mut mesh);
        // Step by step, so that edges can be flipped on the way.
        for step in 1..=STEPS {
            let along = f64::from(step) / f64::from(STEPS);
            // As many as are fixed: the border's, which stay, and the pins.
            let part: Vec<DVec2> = (mesh.points[0].iter().zip(&to))
                .map(|(p, q)| *p + (*q - *p) * along)
                .collect();
            let before = f64::from(step - 1) / f64::from(STEPS);
            let step = ProgressSpan::new(progress, before * CARRIED, along * CARRIED);
            transfer::continue_transfer(&mut mesh, &part, &step)?;
            if !mesh.is_valid() {
                return Err(FramePinsError::Folds {
                    pins: at_folds(&mesh, border.len(), &pins),
                });
            }
            quality::settle(&mut mesh, progress)?;
        }
        let rest = ProgressSpan::new(progress, CARRIED, 1.0);
        quality::improve(&mut mesh, &PolygonOptions::default(), &rest)?;
        checkpoint(progress, "triangulating", 1.0)?;
        let given = given.each_ref().map(Vec::as_slice);
        Ok(mesh.finished([scale; 2], given)?)
    }
}

/// Pins that are different, each after its number; of equal ones the first.
fn distinct(frame: &Bounds, pins: &[PointPair]) -> Result<Vec<(usize, PointPair)>, FramePinsError> {
    let same = SAME * frame.diameter();
    let inside = frame.padded(-same);
    let mut kept: Vec<(usize, PointPair)> = Vec::new();
    for (pin, pair) in pins.iter().enumerate() {
        for side in Side::BOTH {
            if !inside.contains(pair[side]) {
                return Err(FramePinsError::Outside { pin, side });
            }
        }
        let near =
            |other: &PointPair| Side::BOTH.map(|side| other[side].distance(pair[side]) <= same);
        let mut others = kept.iter().map(|(number, other)| (*number, near(other)));
        match others.find(|(_, near)| near.contains(&true)) {
            None => kept.push((pin, *pair)),
            // One pin that is given twice is one.
            Some((_, [true, true])) => {}
            Some((other, near)) => {
                let side = if near[0] { Side::Source } else { Side::Target };
                let pins = [other, pin];
                return Err(FramePinsError::Coincide { pins, side });
            }
        }
    }
    Ok(kept)
}

fn spacing(frame: &Bounds) -> f64 {
    frame.size().max_element() / ALONG
}

/// Points in rows of triangles between those that are there: as wide as the
/// border's, narrower about pins that are near each other in either design.
fn filling(
    frame: &Bounds,
    border: usize,
    ends: &[Vec<DVec2>; 2],
    progress: &dyn Progress,
) -> Result<Vec<DVec2>, Cancelled> {
    let widest = spacing(frame);
    let narrow = |k: usize| {
        let others = (0..ends[0].len()).filter(|&other| other != k);
        let far = |other: usize| {
            let [a, b] = [0, 1].map(|d: usize| ends[d][k].distance(ends[d][other]));
            a.min(b)
        };
        others.map(far).fold(f64::INFINITY, f64::min) * NARROWER
    };
    let pins: Vec<(DVec2, f64)> = (border..ends[0].len())
        .map(|k| (ends[0][k], narrow(k)))
        .collect();
    let wanted = |p: DVec2| {
        let about = |&(pin, least): &(DVec2, f64)| least + GRADING * p.distance(pin);
        pins.iter().map(about).fold(widest, f64::min)
    };
    let mut points = ends[0].clone();
    // The narrowest rows first, so that wide ones keep off them.
    for level in (0..LEVELS).rev() {
        let step = widest / f64::from(1u32 << level);
        let is_last = level + 1 == LEVELS;
        for p in rows(frame, step) {
            still_wanted(progress)?;
            // Each place is filled by the one level whose rows fit it; what is
            // wanted beyond either end, by the last of that end.
            let size = wanted(p);
            let fits = size < 2.0 * step && (size >= step || is_last) || level == 0 && size >= step;
            let clear = CLEAR * step;
            let is_free = |q: &DVec2| p.distance_squared(*q) > clear * clear;
            if fits && points.len() < MOST_POINTS && points.iter().all(is_free) {
                points.push(p);
            }
        }
    }
    Ok(points.split_off(ends[0].len()))
}

/// Points in rows of triangles inside the frame.
fn rows(frame: &Bounds, side: f64) -> impl Iterator<Item = DVec2> {
    let step = DVec2::new(side, side * 0.75f64.sqrt());
    let size = frame.size();
    let (columns, count) = ((size.x / step.x) as u32 + 1, (size.y / step.y) as u32);
    let low = frame.min;
    let place = move |i: u32, j: u32| {
        // Every other row half a step on: triangles of equal sides.
        let shift = if j.is_multiple_of(2) { 0.25 } else { 0.75 };
        low + step * DVec2::new(f64::from(i) + shift, f64::from(j) + 0.5)
    };
    let room = frame.padded(-0.5 * CLEAR * side);
    (0..=count)
        .flat_map(move |j| (0..=columns).map(move |i| place(i, j)))
        .filter(move |p| room.contains(*p))
}

/// The pins nearest to each folded face, each once.
fn at_folds(mesh: &PairMesh, first: usize, all: &[(usize, PointPair)]) -> Vec<usize> {
    let targets = &mesh.points[1];
    let mut pins: Vec<usize> = (mesh.faces())
        .filter(|&face| !super::face_cost::is_positive(mesh.corners(face)[1]))
        .filter_map(|face| {
            let middle = face.iter().map(|&v| targets[v as usize]).sum::<DVec2>() / 3.0;
            let far = |pin: &usize| targets[first + pin].distance_squared(middle);
            let nearest = (0..all.len()).min_by(|a, b| far(a).total_cmp(&far(b)))?;
            Some(all[nearest].0)
        })
        .collect();
    pins.sort_unstable();
    pins.dedup();
    pins
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::work::progress::Silent;
    use proptest::prelude::*;

    const FRAME: Bounds = Bounds {
        min: DVec2::new(-2.0, 1.0),
        max: DVec2::new(6.0, 5.0),
    };

    fn pin(a: (f64, f64), b: (f64, f64)) -> PointPair {
        PointPair {
            source: a.into(),
            target: b.into(),
        }
    }

    #[test]
    fn without_pins_nothing_moves() {
        let mesh = CompatibleMesh::around_pins(&FRAME, &[], &Silent).expect("a mesh");
        for (p, q) in mesh.source().iter().zip(mesh.target()) {
            assert!(p.distance(*q) < 1e-9, "{p} {q}");
        }
    }

    #[test]
    fn pins_that_exchange_places_along_a_line_are_met_around_each_other() {
        let pins = [pin((0.0, 3.0), (3.0, 3.0)), pin((3.0, 3.0), (0.0, 3.0))];
        let mesh = CompatibleMesh::around_pins(&FRAME, &pins, &Silent);
        // Half a turn of the middle can do that; where it is not found, both are named.
        match mesh {
            Ok(mesh) => assert!(mesh.target().contains(&pins[0].target)),
            Err(FramePinsError::Folds { pins }) => assert!(!pins.is_empty()),
            Err(error) => panic!("{error}"),
        }
    }

    #[test]
    fn what_cannot_be_is_named() {
        let out = CompatibleMesh::around_pins(&FRAME, &[pin((0.0, 3.0), (9.0, 3.0))], &Silent);
        let side = Side::Target;
        assert_eq!(out.err(), Some(FramePinsError::Outside { pin: 0, side }));
        let pins = [pin((0.0, 3.0), (1.0, 3.0)), pin((0.0, 3.0), (2.0, 3.0))];
        let one = CompatibleMesh::around_pins(&FRAME, &pins, &Silent);
        let (pins, side) = ([0, 1], Side::Source);
        assert_eq!(one.err(), Some(FramePinsError::Coincide { pins, side }));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn small_moves_of_any_pins_are_met(
            pins in prop::collection::vec(((-1.6f64..5.6), (1.4f64..4.6), (-0.15f64..0.15), (-0.15f64..0.15)), 0..12)
        ) {
            let pins: Vec<PointPair> = pins.into_iter().map(|(x, y, dx, dy)| pin((x, y), (x + dx, y + dy))).collect();
            match CompatibleMesh::around_pins(&FRAME, &pins, &Silent) {
                Ok(mesh) => for pin in &pins {
                    let k = mesh.source().iter().position(|p| p.distance(pin.source) < 1e-4);
                    let k = k.expect("a vertex");
                    prop_assert!(mesh.target()[k].distance(pin.target) < 1e-4);
                },
                Err(FramePinsError::Folds { pins: named }) => prop_assert!(!named.is_empty()),
                Err(FramePinsError::Coincide { .. }) => {}
                Err(error) => return Err(TestCaseError::fail(error.to_string())),
            }
        }
    }
}
