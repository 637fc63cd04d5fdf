//! Mesh of the whole frame in which each pin is a vertex. A pin is a pair of corresponding points,
//! one in each design.
//!
//! The border of the frame stays in place. The space between the border and the pins is filled
//! evenly with points, which are triangulated (Delaunay) in the source. The pins are then moved to
//! the target in steps, and folds are removed after each step (see
//! [`crate::compatible::polygons::transfer`]).
//!
//! Guaranteed: pins are at their given positions bit by bit, and faces are positive in both
//! designs. Not guaranteed: that a mesh is found for every set of pins. If folds remain, the error
//! names the pins nearest to them.

use super::options::PolygonOptions;
use super::pair_mesh::{PairMesh, unit_scale};
use super::{quality, transfer};
use crate::compatible::border::border_points;
use crate::compatible::{CompatibleError, CompatibleMesh};
use crate::correspondence::PointPair;
use crate::geometry::{Bounds, DVec2, Side};
use crate::mesh::triangulation::{TriangulationError, delaunay};
use crate::work::progress::{Cancelled, Progress, ProgressSpan, check_cancelled, checkpoint};

/// Number of points along the longer side of the frame: about 700 points in total in a square frame
/// (heuristic).
const POINTS_ALONG: f64 = 24.0;

/// Minimum distance of a new point from all points that were placed before it, in units of the
/// spacing of its lattice (heuristic: less than the 0.87 between two rows of a triangular lattice).
const MIN_DISTANCE: f64 = 0.6;

/// Narrowest spacing of points around a pin, as a fraction of the distance to the nearest other pin
/// or border point (heuristic: this leaves one or two rows of points in between).
const PIN_SPACING: f64 = 0.35;
/// Growth of the spacing per unit of distance from a pin (heuristic: from one row of points to the
/// second row after it, the spacing grows by less than a factor of two).
const GRADING: f64 = 0.35;

/// Number of triangular lattices that fill the frame. Each has half the spacing of the one before,
/// so the last has 1/32 of the spacing of the first (resource limit: with this narrowest spacing,
/// pins may be as close as 1/270 of the frame's longer side).
const LATTICES: u32 = 6;

/// Maximum number of points after filling, border and pins included (resource limit: each new point
/// is compared with all earlier points).
const MAX_POINTS: usize = 8_000;

/// Number of steps in which the pins move from source to target. Edges can be flipped after each
/// step (heuristic).
const STEPS: u32 = 6;

/// Progress reported once the mesh has reached the target, in [0, 1] (heuristic).
const PROGRESS_AT_TARGET: f64 = 0.7;

/// Distance up to which two pins count as coincident in a design, as a fraction of the frame's
/// diameter (tolerance: too close to be placed by hand; faces between such pins would be slivers).
const SAME_PIN: f64 = 1e-6;

/// Reason why the frame has no mesh in which the pins are vertices. Pin indices start at 0 in
/// fields and at 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FramePinsError {
    /// A pin is not finite, or does not lie inside the frame.
    #[error("pin {} lies outside the frame of the {side} design; move it inside", pin + 1)]
    Outside {
        /// Index of the pin, from 0.
        pin: usize,
        /// Design in which the pin lies outside the frame.
        side: Side,
    },
    /// Two pins coincide in one design but not in the other.
    #[error("pins {} and {} lie at the same point in the {side} design but not in the other; delete one of them", pins[0] + 1, pins[1] + 1)]
    Coincide {
        /// Indices of the pins, from 0.
        pins: [usize; 2],
        /// Design in which the two pins coincide.
        side: Side,
    },
    /// No mesh without folds was found that meets all pins.
    #[error("the plane would have to fold near {}; move or delete {}", pin_list(pins), if pins.len() == 1 { "it" } else { "some of them" })]
    Folds {
        /// Indices of the pins nearest to the folds, from 0.
        pins: Vec<usize>,
    },
    /// The points that fill the frame could not be triangulated, because the frame's coordinates
    /// are out of range.
    #[error(transparent)]
    Triangulation(#[from] TriangulationError),
    /// The mesh is valid in the scaled coordinates in which it was computed, but rounding to the
    /// frame's own coordinates made it invalid.
    #[error("the mesh around the pins is not valid in the frame's coordinates: {0}")]
    Mesh(#[from] CompatibleError),
    /// The work was cancelled.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Formats pin indices, which count from 0, as "pin 3" or "pins 3, 5", which count from 1.
fn pin_list(pins: &[usize]) -> String {
    let numbers: Vec<String> = pins.iter().map(|pin| (pin + 1).to_string()).collect();
    let pin = if numbers.len() == 1 { "pin" } else { "pins" };
    format!("{pin} {}", numbers.join(", "))
}

impl CompatibleMesh {
    /// Triangulates a rectangle so that each pin is a vertex, at its source position in the source
    /// and at its target position in the target. The border is the same in both designs. The border
    /// vertices come first, then the pins.
    ///
    /// # Errors
    /// [`FramePinsError`] if a pin lies outside the rectangle, if two pins coincide in only one
    /// design, if no mesh without folds is found, or if the work is cancelled.
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
    /// # Ok::<(), morphospace::compatible::FramePinsError>(())
    /// ```
    pub fn around_pins(
        frame: &Bounds,
        pins: &[PointPair],
        progress: &dyn Progress,
    ) -> Result<Self, FramePinsError> {
        let pins = distinct_pins(frame, pins)?;
        let border = border_points(frame, spacing(frame));
        let fixed_points = |side: Side| {
            let fixed_points = pins.iter().map(|(_, pin)| pin[side]);
            border
                .iter()
                .copied()
                .chain(fixed_points)
                .collect::<Vec<DVec2>>()
        };
        let fixed_places = Side::BOTH.map(fixed_points);
        let fixed = fixed_places[0].len();
        let mut source = fixed_places[0].clone();
        source.extend(fill_points(frame, border.len(), &fixed_places, progress)?);
        let scale = unit_scale(&source);
        let scaled = |points: &[DVec2]| points.iter().map(|p| *p * scale).collect::<Vec<_>>();
        let (source, fixed_targets) = (scaled(&source), scaled(&fixed_places[1]));
        let faces = delaunay(&source)?;
        let mut mesh = PairMesh::new(fixed, [source.clone(), source], faces);
        // Every edge between two fixed vertices is split, so that each face has a vertex that can
        // move when the pins do.
        transfer::split_chords(&mut mesh);
        // The mesh moves in several steps, so that edges can be flipped between the steps.
        for step in 1..=STEPS {
            let along = f64::from(step) / f64::from(STEPS);
            // `fixed_targets` contains the targets of the border vertices, which stay in place, and
            // of the pins. `zip` stops after them, so the other vertices get no waypoint.
            let waypoints: Vec<DVec2> = (mesh.points[0].iter().zip(&fixed_targets))
                .map(|(p, q)| *p + (*q - *p) * along)
                .collect();
            let before = f64::from(step - 1) / f64::from(STEPS);
            let step = ProgressSpan::new(
                progress,
                before * PROGRESS_AT_TARGET,
                along * PROGRESS_AT_TARGET,
            );
            transfer::continue_transfer(&mut mesh, &waypoints, &step)?;
            if !mesh.is_valid() {
                return Err(FramePinsError::Folds {
                    pins: pins_near_folds(&mesh, border.len(), &pins),
                });
            }
            quality::relax_and_flip(&mut mesh, progress)?;
        }
        let remaining = ProgressSpan::new(progress, PROGRESS_AT_TARGET, 1.0);
        quality::improve(&mut mesh, &PolygonOptions::default(), &remaining)?;
        checkpoint(progress, "triangulating", 1.0)?;
        let fixed_places = fixed_places.each_ref().map(Vec::as_slice);
        Ok(mesh.to_compatible_mesh([scale; 2], fixed_places)?)
    }
}

/// Returns the distinct pins, each with its index in `pins`. Of pins that coincide in both designs,
/// the first is returned.
fn distinct_pins(
    frame: &Bounds,
    pins: &[PointPair],
) -> Result<Vec<(usize, PointPair)>, FramePinsError> {
    let same = SAME_PIN * frame.diameter();
    // A pin on the border would leave no room for faces.
    let inside = frame.padded(-same);
    let mut distinct: Vec<(usize, PointPair)> = Vec::new();
    for (pin, pair) in pins.iter().enumerate() {
        for side in Side::BOTH {
            if !inside.contains(pair[side]) {
                return Err(FramePinsError::Outside { pin, side });
            }
        }
        let near =
            |other: &PointPair| Side::BOTH.map(|side| other[side].distance(pair[side]) <= same);
        // A pin may coincide with an earlier pin in both designs, but not in one design only.
        let mut others = distinct
            .iter()
            .map(|(number, other)| (*number, near(other)));
        match others.find(|(_, near)| near.contains(&true)) {
            None => distinct.push((pin, *pair)),
            // A repeated pin counts once.
            Some((_, [true, true])) => {}
            Some((other, near)) => {
                let side = if near[0] { Side::Source } else { Side::Target };
                let pins = [other, pin];
                return Err(FramePinsError::Coincide { pins, side });
            }
        }
    }
    Ok(distinct)
}

/// Widest spacing between the points that fill the frame, in units of the plane.
fn spacing(frame: &Bounds) -> f64 {
    frame.size().max_element() / POINTS_ALONG
}

/// Returns the points of triangular lattices that fill the frame between border and pins. They are
/// spaced like the points of the border, but more closely around pins that are close to another pin
/// or to the border in either design. For each design, `ends` contains the points of the border,
/// followed by the pins; `border` is the number of points of the border.
fn fill_points(
    frame: &Bounds,
    border: usize,
    ends: &[Vec<DVec2>; 2],
    progress: &dyn Progress,
) -> Result<Vec<DVec2>, Cancelled> {
    let widest = spacing(frame);
    let pin_spacing = |k: usize| {
        let other_points = (0..ends[0].len()).filter(|&other| other != k);
        let far = |other: usize| {
            let [a, b] = [0, 1].map(|d: usize| ends[d][k].distance(ends[d][other]));
            a.min(b)
        };
        other_points.map(far).fold(f64::INFINITY, f64::min) * PIN_SPACING
    };
    let pins: Vec<(DVec2, f64)> = (border..ends[0].len())
        .map(|k| (ends[0][k], pin_spacing(k)))
        .collect();
    let spacing_at = |p: DVec2| {
        let about = |&(pin, min_spacing): &(DVec2, f64)| min_spacing + GRADING * p.distance(pin);
        pins.iter().map(about).fold(widest, f64::min)
    };
    let mut points = ends[0].clone();
    // The lattice with the narrowest spacing comes first, so that the points of wider lattices keep
    // their distance from its points.
    for lattice in (0..LATTICES).rev() {
        let step = widest / f64::from(1u32 << lattice);
        let is_last = lattice + 1 == LATTICES;
        for p in triangular_lattice(frame, step) {
            check_cancelled(progress)?;
            // Only one lattice adds points at each place: the one whose spacing is nearest below
            // the required spacing `size`. Where `size` is smaller than the spacing of the
            // narrowest lattice, the narrowest lattice adds points.
            let size = spacing_at(p);
            let fits =
                size < 2.0 * step && (size >= step || is_last) || lattice == 0 && size >= step;
            let min_distance = MIN_DISTANCE * step;
            let is_free = |q: &DVec2| p.distance_squared(*q) > min_distance * min_distance;
            if fits && points.len() < MAX_POINTS && points.iter().all(is_free) {
                points.push(p);
            }
        }
    }
    Ok(points.split_off(ends[0].len()))
}

/// Points of a triangular lattice inside the frame; `side` is the length of the lattice's edges.
fn triangular_lattice(frame: &Bounds, side: f64) -> impl Iterator<Item = DVec2> {
    let step = DVec2::new(side, side * 0.75f64.sqrt());
    let size = frame.size();
    let (columns, count) = ((size.x / step.x) as u32 + 1, (size.y / step.y) as u32);
    let low = frame.min;
    let place = move |i: u32, j: u32| {
        // Odd rows are shifted by half a lattice spacing against even rows, so that the triangles
        // are equilateral.
        let shift = if j.is_multiple_of(2) { 0.25 } else { 0.75 };
        low + step * DVec2::new(f64::from(i) + shift, f64::from(j) + 0.5)
    };
    let room = frame.padded(-0.5 * MIN_DISTANCE * side);
    (0..=count)
        .flat_map(move |j| (0..=columns).map(move |i| place(i, j)))
        .filter(move |p| room.contains(*p))
}

/// Returns the indices of the pins nearest to the faces that are folded in the target, ascending
/// and without duplicates. `first` is the vertex index of the first pin of `all`.
fn pins_near_folds(mesh: &PairMesh, first: usize, all: &[(usize, PointPair)]) -> Vec<usize> {
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
    fn pins_that_exchange_places_are_met_or_named() {
        let pins = [pin((0.0, 3.0), (3.0, 3.0)), pin((3.0, 3.0), (0.0, 3.0))];
        let mesh = CompatibleMesh::around_pins(&FRAME, &pins, &Silent);
        // A half turn of the plane around the point midway between the two pins satisfies both
        // pins. If the search finds no mesh for this, its error names the pins.
        match mesh {
            Ok(mesh) => assert!(mesh.target().contains(&pins[0].target)),
            Err(FramePinsError::Folds { pins }) => assert!(!pins.is_empty()),
            Err(error) => panic!("{error}"),
        }
    }

    #[test]
    fn impossible_pins_are_named_in_the_error() {
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
        #[ignore = "slow; run by scripts/test"]
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
