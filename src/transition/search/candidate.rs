//! A candidate match of a piece: its mesh, and the defects of its motion.

use crate::compatible::{CompatibleMesh, PieceMeshError, mesh_of_piece};
use crate::correspondence::{HolePolicy, PieceMatch};
use crate::geometry::{
    DVec2, count_crossings, max_overshoot, orient2d, signed_area, total_turning,
};
use crate::transition::arap_build::build_arap;
use crate::transition::error::BuildError;
use crate::transition::options::TransitionOptions;
use crate::transition::stiffening::stiffen_folds;
use crate::transition::transients::holes::{PieceHole, timed};
use crate::transition::transients::layers::PieceLayers;
use crate::warp::homotopy::Homotopy;
use crate::warp::{Arap, ArapOptions, Warp};
use crate::work::progress::{Cancelled, Progress, ProgressSpan, check_cancelled};
use std::f64::consts::{FRAC_PI_6, PI, TAU};

/// Number of equal steps of t into which the motion is divided to count folds and crossings; folds
/// between two samples are missed (resource limit: at each step, every vertex of every candidate
/// match is placed).
const STEPS: u32 = 32;

/// Progress reported once the mesh is built, in [0, 1] (heuristic).
const MESH_PROGRESS: f64 = 0.9;

/// Fraction of the mesh's area that is left out when its distortion is computed. The most distorted
/// faces are left out (heuristic: the corners of every triangulation are distorted).
const IGNORED_AREA: f64 = 0.05;

/// Exponent of the factor 1 + [`MotionDefects::turning`] in the misfit by which candidate matches
/// are compared (heuristic).
const TURNING_EXPONENT: i32 = 3;

/// Exponent of the factor 1 + number of half turns of the piece, in the misfit by which candidate
/// matches are compared (heuristic).
const ROTATION_EXPONENT: i32 = 2;

/// Largest rotation, in radians, with which a piece counts as staying upright (heuristic).
const MAX_UPRIGHT_ROTATION: f64 = FRAC_PI_6;

/// A matched piece with its mesh and the defects of its motion.
#[derive(Clone)]
pub(in crate::transition) struct MatchCandidate {
    pub(in crate::transition) matched: PieceMatch,
    /// Treatment of unmatched holes with which the piece was matched.
    pub(in crate::transition) holes: HolePolicy,
    pub(in crate::transition) mesh: CompatibleMesh,
    defects: MotionDefects,
    /// Distortion of the mesh, at least 1; see [`CompatibleMesh::distortion`].
    pub(in crate::transition) distortion: f64,
}

/// Defects of a motion, sampled in [`STEPS`] equal steps of t.
#[derive(Clone, Copy, Default)]
struct MotionDefects {
    /// Number of faces that are not positively oriented, summed over all samples.
    folds: usize,
    /// Number of crossings of the outlines, summed over all samples.
    crossings: usize,
    /// Largest excess, over all samples, of the total turning of the outlines: the sum of their
    /// absolute exterior angles. The excess is measured above the linear interpolation between
    /// t = 0 and t = 1, as a fraction of the interpolated value.
    turning: f64,
    /// Largest excess, over all samples, of the area. The excess is measured above the linear
    /// interpolation between t = 0 and t = 1, as a fraction of the interpolated value.
    swelling: f64,
    /// Rotation of the piece as a whole, in radians.
    rotation: f64,
}

/// Reason why the motion of a candidate match could not be rated.
pub(in crate::transition) enum CandidateError {
    /// The piece could not be triangulated.
    Mesh(PieceMeshError),
    /// The motion could not be solved, or the work was cancelled.
    Build(BuildError),
}

impl From<BuildError> for CandidateError {
    fn from(error: BuildError) -> Self {
        Self::Build(error)
    }
}

impl From<Cancelled> for CandidateError {
    fn from(cancelled: Cancelled) -> Self {
        Self::Build(cancelled.into())
    }
}

impl MatchCandidate {
    /// Triangulates a matched piece, solves its motion, and measures its defects.
    ///
    /// # Errors
    /// If the piece cannot be triangulated, the motion cannot be solved, or the work is cancelled.
    pub(in crate::transition) fn new(
        matched: PieceMatch,
        holes: HolePolicy,
        options: &TransitionOptions,
        progress: &dyn Progress,
    ) -> Result<Self, CandidateError> {
        let [meshing, solving] = [(0.0, MESH_PROGRESS), (MESH_PROGRESS, 1.0)]
            .map(|(from, to)| ProgressSpan::new(progress, from, to));
        let mesh = mesh_of_piece(&matched, &options.triangulation, &meshing)
            .map_err(CandidateError::Mesh)?;
        let defects = if matched.is_matched() {
            let motion = build_arap(&mesh, &rating_options(options), &[], &solving)?;
            // A single piece lies on a single layer.
            let layers = PieceLayers::default();
            let holes = timed(std::slice::from_ref(&matched), &motion, &layers, progress)?;
            MotionDefects::of(&motion, &holes, progress)?
        } else {
            MotionDefects::default()
        };
        Ok(Self {
            defects,
            distortion: mesh.distortion(IGNORED_AREA),
            holes,
            matched,
            mesh,
        })
    }

    /// Returns whether this candidate match is better than another.
    pub(in crate::transition) fn is_better_than(&self, other: &Self) -> bool {
        // Comparisons with NaN are false: an undefined misfit is never better.
        self.comparison_key() < other.comparison_key()
    }

    /// Returns whether a face folds at a sampled time.
    pub(in crate::transition) fn folds(&self) -> bool {
        self.defects.folds > 0
    }

    /// Returns whether, after the folded faces have been stiffened, no face folds and no outlines
    /// cross at any sampled time.
    ///
    /// # Errors
    /// If the motion cannot be solved, or the work is cancelled.
    pub(in crate::transition) fn can_be_sound(
        &self,
        options: &TransitionOptions,
        progress: &dyn Progress,
    ) -> Result<bool, BuildError> {
        if self.defects.folds == 0 {
            return Ok(self.defects.crossings == 0);
        }
        let motion = build_arap(&self.mesh, &rating_options(options), &[], progress)?;
        let motion = stiffen_folds(motion, progress)?;
        let layers = PieceLayers::default();
        let holes = timed(
            std::slice::from_ref(&self.matched),
            &motion,
            &layers,
            progress,
        )?;
        let defects = MotionDefects::of(&motion, &holes, progress)?;
        Ok(defects.folds == 0 && defects.crossings == 0)
    }

    /// Returns whether the piece as a whole turns by at most [`MAX_UPRIGHT_ROTATION`].
    pub(in crate::transition) fn stays_upright(&self) -> bool {
        self.defects.rotation.abs() <= MAX_UPRIGHT_ROTATION
    }

    /// Returns the quantities by which candidate matches are compared, the most important first;
    /// lower is better.
    fn comparison_key(&self) -> (usize, usize, f64) {
        (self.defects.folds, self.defects.crossings, self.misfit())
    }

    /// Returns the misfit, which is at least 1: the distortion, multiplied by factors for the
    /// defects [`MotionDefects::turning`], [`MotionDefects::rotation`] and
    /// [`MotionDefects::swelling`].
    pub(in crate::transition) fn misfit(&self) -> f64 {
        let turning = (1.0 + self.defects.turning).powi(TURNING_EXPONENT);
        let rotation = (1.0 + self.defects.rotation.abs() / PI).powi(ROTATION_EXPONENT);
        let area = 1.0 + self.defects.swelling;
        self.distortion * turning * rotation * area
    }
}

/// Returns the options with which a piece is rated.
///
/// Apart from `symmetric` and the homotopy, they are the default options, because requested ones
/// such as the anchor refer to the whole design. The bounded homotopy is too expensive for a rating
/// and is replaced by the polar one, which starts and ends with the same shapes.
fn rating_options(options: &TransitionOptions) -> ArapOptions {
    let homotopy = match options.arap.homotopy {
        Homotopy::Bounded => Homotopy::Polar,
        homotopy => homotopy,
    };
    ArapOptions {
        homotopy,
        symmetric: options.arap.symmetric,
        ..ArapOptions::default()
    }
}

impl MotionDefects {
    /// Samples a motion in equal steps of t and measures its defects.
    ///
    /// # Errors
    /// [`Cancelled`] if the work is cancelled.
    fn of(
        arap: &Arap,
        unmatched_holes: &[PieceHole],
        progress: &dyn Progress,
    ) -> Result<Self, Cancelled> {
        let mesh = arap.mesh();
        let (loops, diameter) = (mesh.boundary_loops(), mesh.diameter());
        let [mut folds, mut crossings] = [0; 2];
        let [mut turned, mut areas] = [const { Vec::new() }; 2];
        let mut placer = arap.placer();
        for step in 0..=STEPS {
            check_cancelled(progress)?;
            let t = f64::from(step) / f64::from(STEPS);
            placer.place(t);
            let places = &placer.placement().in_frame;
            let ring = |ring: &Vec<u32>| ring.iter().map(|&v| places[v as usize]).collect();
            let holes = unmatched_holes
                .iter()
                .filter_map(|(_, hole)| hole.ring_at(places, t));
            let rings: Vec<Vec<DVec2>> = loops.iter().map(ring).chain(holes).collect();
            // A hole that has disappeared still counts as a point. Its outline turns by 2π, as that
            // of a convex hole does, so the total turning does not jump.
            let absent = loops.len() + unmatched_holes.len() - rings.len();
            turned.push([t, total_turning(&rings, diameter) + TAU * absent as f64]);
            areas.push([t, rings.iter().map(|ring| signed_area(ring)).sum::<f64>()]);
            // The frames at t = 0 and t = 1 are the designs themselves, which have no defects.
            if step > 0 && step < STEPS {
                folds += count_folded(arap, places);
                crossings += count_crossings(&rings);
            }
        }
        Ok(Self {
            folds,
            crossings,
            turning: max_overshoot(&turned),
            swelling: max_overshoot(&areas),
            rotation: arap.rotation(),
        })
    }
}

/// Returns the number of faces that are not positively oriented if the vertices lie at `places`.
fn count_folded(arap: &Arap, places: &[DVec2]) -> usize {
    let is_folded = |face: &&[u32; 3]| {
        let [a, b, c] = face.map(|v| places[v as usize]);
        orient2d(a, b, c) <= 0.0
    };
    arap.mesh().faces().iter().filter(is_folded).count()
}
