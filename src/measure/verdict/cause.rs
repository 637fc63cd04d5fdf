//! What is measured where the trouble is worst.

use super::super::crossings::{Crossing, RingEdge, crossings};
use super::super::distortion::{Strain, edges};
use super::super::stretch;
use super::scan::{self, Glance};
use super::{Cause, Finding, Remedy, Trouble, remedy};
use crate::content::{FieldPair, Solid};
use crate::geometry::{DVec2, signed_area, twice_signed_area};
use crate::homotopy::{Homotopy, LocalMap};
use crate::progress::{Cancelled, Progress};
use crate::transition::Transition;
use crate::warp::Arap;
use std::f64::consts::{FRAC_PI_3, PI};

/// A stretch of the boundary that is longer or shorter than this many times
/// its mean is named as a cause. Good matches of animals of one kind stay
/// below 2 nearly everywhere.
const UNEVEN: f64 = 3.0;

/// A face of which less than this share of the area is left by its own path
/// is flattened by it, whatever its neighbours do.
const FLATTENED: f64 = 0.1;

/// Designs that share less than this have little to do with each other.
const LITTLE_OVERLAP: f64 = 0.5;

/// A transition of rigid parts at the t of a trouble.
pub(super) struct Scene<'a> {
    pub arap: &'a Arap,
    pub solid: &'a Solid,
    pub places: Vec<DVec2>,
    pub angles: Vec<f64>,
    pub part_of: Vec<u32>,
}

impl<'a> Scene<'a> {
    pub fn new(transition: &Transition, arap: &'a Arap, solid: &'a Solid, t: f64) -> Self {
        Self {
            arap,
            solid,
            places: transition.frame(t).placement().in_frame.clone(),
            angles: arap.face_angles(),
            part_of: arap.mesh().connectivity().dual_components(),
        }
    }

    pub fn centroid(&self, face: usize, points: &[DVec2]) -> DVec2 {
        let corners = self.arap.mesh().faces()[face].map(|v| points[v as usize]);
        corners.iter().sum::<DVec2>() / 3.0
    }

    /// The determinant of a face against the source.
    fn det(&self, face: usize) -> f64 {
        let mesh = self.arap.mesh();
        let corners = &mesh.faces()[face];
        Strain::of(edges(&self.places, corners) * edges(mesh.source(), corners).inverse()).det
    }

    fn local_map(&self, face: usize) -> LocalMap {
        let mesh = self.arap.mesh();
        let corners = &mesh.faces()[face];
        let whole = edges(mesh.target(), corners) * edges(mesh.source(), corners).inverse();
        LocalMap {
            angle: self.angles[face],
            ..LocalMap::of(whole)
        }
    }

    /// The face at an edge of the boundary.
    fn face_at(&self, edge: RingEdge) -> Option<usize> {
        let walk = &self.solid.loops[edge.ring];
        let (a, b) = (walk[edge.point], walk[(edge.point + 1) % walk.len()]);
        let faces = self.arap.mesh().faces();
        faces.iter().position(|f| f.contains(&a) && f.contains(&b))
    }

    /// The area-weighted mean angle of the faces that are chosen.
    fn mean_angle(&self, is: impl Fn(usize) -> bool) -> Option<f64> {
        let mesh = self.arap.mesh();
        let (mut sum, mut total) = (0.0, 0.0);
        for (f, face) in mesh.faces().iter().enumerate().filter(|(f, _)| is(*f)) {
            let [a, b, c] = face.map(|v| mesh.source()[v as usize]);
            let area = twice_signed_area(a, b, c);
            (sum, total) = (sum + area * self.angles[f], total + area);
        }
        (total > 0.0).then(|| sum / total)
    }

    /// The parts that share a vertex with one.
    fn neighbouring_parts(&self, part: u32) -> Vec<u32> {
        let faces = self.arap.mesh().faces();
        let mut on_part = vec![false; self.arap.mesh().source().len()];
        for (face, _) in faces.iter().zip(&self.part_of).filter(|(_, p)| **p == part) {
            face.iter().for_each(|&v| on_part[v as usize] = true);
        }
        let touches = |face: &[u32; 3]| face.iter().any(|&v| on_part[v as usize]);
        let others = faces.iter().zip(&self.part_of);
        let mut parts: Vec<u32> = others
            .filter(|(face, p)| **p != part && touches(face))
            .map(|(_, p)| *p)
            .collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }
}

pub(super) fn of_solid(
    transition: &Transition,
    solid: &Solid,
    glances: &[Glance],
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let Some(arap) = transition.arap() else {
        return Ok(of_boundaries(transition, solid, glances)
            .into_iter()
            .collect());
    };
    let mut found = Vec::new();
    if let Some((t, span)) = scan::worst(glances, |g| g.folds, 0) {
        let scene = Scene::new(transition, arap, solid, t);
        found.extend(of_folds(&scene, t, span));
    }
    if let Some((t, span)) = scan::worst(glances, |g| g.crossings, 0) {
        let scene = Scene::new(transition, arap, solid, t);
        found.extend(of_crossings(&scene, t, span));
    }
    remedy::for_rigid_parts(transition, arap, solid, glances, &mut found, progress)?;
    Ok(found)
}

/// Crossings of a boundary that has nothing inside.
fn of_boundaries(transition: &Transition, solid: &Solid, glances: &[Glance]) -> Option<Finding> {
    let (t, span) = scan::worst(glances, |g| g.crossings, 0)?;
    let frame = transition.frame(t);
    let crossings = crossings(&solid.rings_at(&frame.placement().in_frame));
    Some(Finding {
        place: crossings.first()?.place,
        trouble: Trouble::Crossings { crossings },
        t,
        span,
        cause: Cause::NothingInside,
        remedy: Remedy::RigidParts,
    })
}

fn of_folds(scene: &Scene<'_>, t: f64, span: [f64; 2]) -> Option<Finding> {
    let faces: Vec<usize> = scan::folded(scene.arap, &scene.places).collect();
    let by_det = |a: &&usize, b: &&usize| scene.det(**a).total_cmp(&scene.det(**b));
    let worst = *faces.iter().min_by(by_det)?;
    let cause = straight_paths(scene, worst, t)
        .or_else(|| far_turn_of_part(scene, worst))
        .or_else(|| uneven_match(scene, worst))
        .or_else(|| unlike_neighbours(scene, &faces))
        .or_else(|| far_turn(scene, worst));
    Some(Finding {
        place: scene.centroid(worst, &scene.places),
        trouble: Trouble::Folds { faces },
        t,
        span,
        cause: cause.unwrap_or(Cause::Unclear),
        remedy: remedy::by_hand(scene, worst),
    })
}

fn of_crossings(scene: &Scene<'_>, t: f64, span: [f64; 2]) -> Option<Finding> {
    let found = crossings(&scene.solid.rings_at(&scene.places));
    let first = *found.first()?;
    let faces: Vec<usize> = first
        .edges
        .iter()
        .filter_map(|&e| scene.face_at(e))
        .collect();
    let &[a, b] = faces.as_slice() else {
        return None;
    };
    let cause = straight_paths(scene, a, t)
        .or_else(|| straight_paths(scene, b, t))
        .or_else(|| far_turn_of_part(scene, a))
        .or_else(|| far_turn_of_part(scene, b))
        .or_else(|| {
            let near = near_each_other(scene, &first);
            near.then(|| uneven_match(scene, a)).flatten()
        });
    let meet = || Cause::PlacesMeet {
        turns: [a, b].map(|f| scene.angles[f]),
        source: [a, b].map(|f| scene.centroid(f, scene.arap.mesh().source())),
    };
    Some(Finding {
        place: first.place,
        trouble: Trouble::Crossings { crossings: found },
        t,
        span,
        cause: cause.unwrap_or_else(meet),
        remedy: remedy::by_hand(scene, a),
    })
}

/// Its own path flattens a face, before any neighbour has its say.
fn straight_paths(scene: &Scene<'_>, face: usize, t: f64) -> Option<Cause> {
    let homotopy = scene.arap.options().homotopy;
    if homotopy.keeps_orientation() {
        return None;
    }
    let map = scene.local_map(face);
    let left = homotopy.at(&map, t).determinant();
    let kept = Homotopy::Polar.at(&map, t).determinant();
    (left < FLATTENED * kept).then_some(Cause::StraightPaths {
        homotopy,
        turn: map.angle,
    })
}

/// The part of a face and one that it hangs on turn by more than half a turn
/// against each other; named is that which turns further.
fn far_turn_of_part(scene: &Scene<'_>, face: usize) -> Option<Cause> {
    let part = scene.part_of[face];
    let mean = |p: u32| scene.mean_angle(|f| scene.part_of[f] == p);
    let own = mean(part)?;
    let others = scene.neighbouring_parts(part).into_iter();
    let (other, angle) = others
        .filter_map(|other| Some((other, mean(other)?)))
        .max_by(|a, b| (a.1 - own).abs().total_cmp(&(b.1 - own).abs()))?;
    let (part, turn) = if angle.abs() > own.abs() {
        (other, angle - own)
    } else {
        (part, own - angle)
    };
    (turn.abs() > PI).then_some(Cause::FarTurn {
        part: Some(part as usize),
        turn,
    })
}

/// A face turns by more than half a turn against the whole.
pub(super) fn far_turn(scene: &Scene<'_>, face: usize) -> Option<Cause> {
    let turn = scene.angles[face] - scene.mean_angle(|_| true)?;
    (turn.abs() > PI).then_some(Cause::FarTurn { part: None, turn })
}

/// The boundary near a face is stretched unevenly.
pub(super) fn uneven_match(scene: &Scene<'_>, face: usize) -> Option<Cause> {
    /// How far from the face the boundary may be, by its diameter.
    const NEAR: f64 = 0.1;
    let mesh = scene.arap.mesh();
    let (source, target) = (mesh.source(), mesh.target());
    let about = scene.centroid(face, source);
    let near = NEAR * mesh.diameter();
    let worst = stretch::boundary(mesh)
        .into_iter()
        .filter(|s| source[s.vertex as usize].distance(about) < near)
        .max_by(|a, b| a.unevenness().total_cmp(&b.unevenness()))?;
    (worst.unevenness() > UNEVEN).then(|| Cause::UnevenMatch {
        ratio: worst.ratio,
        source: source[worst.vertex as usize],
        target: target[worst.vertex as usize],
    })
}

/// The largest difference of angles across an edge of one of the faces.
pub(super) fn unlike_neighbours(scene: &Scene<'_>, faces: &[usize]) -> Option<Cause> {
    let connectivity = scene.arap.mesh().connectivity();
    let across = |f: usize| (0..3).filter_map(move |k| Some((f, connectivity.neighbour(f, k)?)));
    let turn = faces
        .iter()
        .flat_map(|&f| across(f))
        .map(|(a, b)| (scene.angles[a] - scene.angles[b]).abs())
        .reduce(f64::max)?;
    (turn > FRAC_PI_3).then_some(Cause::UnlikeNeighbours { turn })
}

/// Whether two edges of one ring are less than a tenth of it apart.
fn near_each_other(scene: &Scene<'_>, crossing: &Crossing) -> bool {
    let [a, b] = crossing.edges;
    let n = scene.solid.loops[a.ring].len();
    let between = a.point.abs_diff(b.point);
    a.ring == b.ring && 10 * between.min(n - between) < n
}

pub(super) fn of_field(
    transition: &Transition,
    pair: &FieldPair,
    glances: &[Glance],
    progress: &dyn Progress,
) -> Result<Vec<Finding>, Cancelled> {
    let (Some(first), Some(last)) = (glances.first(), glances.last()) else {
        return Ok(Vec::new());
    };
    let ends = |of: scan::Count| of(first).max(of(last));
    let mut found = Vec::new();
    if ends(|g| g.pieces) > 0 {
        let gone = scan::times(glances, |g| g.pieces == 0);
        if let (Some(&begin), Some(&end)) = (gone.first(), gone.last()) {
            let t = gone[gone.len() / 2];
            found.push(field_finding(
                transition,
                pair,
                Trouble::Gone,
                t,
                [begin, end],
            ));
        }
    }
    let at_ends = ends(|g| g.pieces);
    if let Some((t, span)) = scan::worst(glances, |g| g.pieces, at_ends) {
        let count = scan::most(glances, |g| g.pieces);
        found.push(field_finding(
            transition,
            pair,
            Trouble::Pieces { count, at_ends },
            t,
            span,
        ));
    }
    let at_ends = ends(|g| g.holes);
    if let Some((t, span)) = scan::worst(glances, |g| g.holes, at_ends) {
        let count = scan::most(glances, |g| g.holes);
        found.push(field_finding(
            transition,
            pair,
            Trouble::Holes { count, at_ends },
            t,
            span,
        ));
    }
    remedy::for_fields(transition, pair, glances.len(), &mut found, progress)?;
    Ok(found)
}

fn field_finding(
    transition: &Transition,
    pair: &FieldPair,
    trouble: Trouble,
    t: f64,
    span: [f64; 2],
) -> Finding {
    let share = overlap(pair);
    Finding {
        place: place_of(transition, pair, &trouble, t),
        cause: if share < LITTLE_OVERLAP {
            Cause::LittleOverlap { share }
        } else {
            Cause::BlindFields
        },
        remedy: remedy::for_overlap(share < LITTLE_OVERLAP),
        trouble,
        t,
        span,
    }
}

/// The middle of the smallest piece or hole, or of the frame.
fn place_of(transition: &Transition, pair: &FieldPair, trouble: &Trouble, t: f64) -> DVec2 {
    let wanted = if matches!(trouble, Trouble::Holes { .. }) {
        -1.0
    } else {
        1.0
    };
    let rings = transition.frame(t).figure().rings.into_iter();
    let sized = rings.map(|ring| (wanted * signed_area(&ring), ring));
    let smallest = sized
        .filter(|(area, _)| *area > 0.0)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    smallest.map_or_else(
        || pair.grid().bounds().centre(),
        |(_, ring)| ring.iter().sum::<DVec2>() / ring.len() as f64,
    )
}

/// The share of the smaller design that lies on the other, in cells.
fn overlap(pair: &FieldPair) -> f64 {
    let level = pair.blend().threshold;
    let is_inside = |value: &f32| f64::from(*value) >= level;
    let (mut source, mut target, mut both) = (0_usize, 0_usize, 0_usize);
    for (a, b) in pair.source().values().iter().zip(pair.target().values()) {
        let (a, b) = (is_inside(a), is_inside(b));
        source += usize::from(a);
        target += usize::from(b);
        both += usize::from(a && b);
    }
    both as f64 / source.min(target).max(1) as f64
}
