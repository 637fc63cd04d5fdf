//! Builds a design space: rigid parts of a common mesh, distance fields, or pictures.

use super::blend::{BlendContent, DesignSpace, DesignSpaceData};
use super::design_distance::DesignDistances;
use super::error::{SpaceError, SpaceNote};
use super::picture_space::PictureSpace;
use crate::compatible::{CompatibleFamily, FamilyError};
use crate::content::{ContentKind, FieldSet};
use crate::correspondence::{MatchSettings, RegionMatch};
use crate::design::{Design, DesignForm, Truss};
use crate::field::Grid;
use crate::geometry::{Bounds, DVec2, Regions};
use crate::mesh::TriangleMesh;
use crate::transition::{
    BuildError, BuildQuality, CollisionAvoidance, PaintRule, Transition, TransitionMethod,
    TransitionOptions, TransitionSpec, bar_width, field_frame, measured, outline,
};
use crate::warp::{ArapBlend, ManyFeatures, WarpKind};
use crate::work::budget::{WorkloadKind, WorkloadTooLarge};
use crate::work::progress::{
    OverallProgress, Progress, ProgressShares, ProgressSpan, check_cancelled, checkpoint,
};
use rayon::prelude::*;
use std::sync::Arc;

/// Maximum number of designs that are tried as the hub of a common mesh with draft matches
/// (heuristic).
///
/// The hub is the design with which all others are matched. Matches in the requested quality are
/// tried first, but only with the best hub. The points of such matches may be so close together
/// that no common mesh without folds exists, while draft matches still allow one.
const MAX_HUBS: usize = 3;

/// Specification of a design space: designs placed in one frame, and options.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpaceSpec {
    /// At least two designs.
    pub designs: Vec<Arc<Design>>,
    /// Kind of content: solid for rigid parts, distance fields, or pictures. `None` means rigid
    /// parts if the designs have a common mesh, otherwise distance fields.
    pub content: Option<ContentKind>,
    /// Warp that aligns pictures: lines, scattered points or a lattice. With any other warp,
    /// pictures stay in place.
    pub warp: WarpKind,
    /// Pins and lines that exist in all pictures, with their position in each, in the common frame.
    pub features: ManyFeatures,
    /// Number of pins and lines that exist in only some of the pictures; reported as a note.
    pub unmatched_features: usize,
    /// Notes on how the designs were prepared, which the space takes over.
    pub notes: Vec<SpaceNote>,
    /// Options of all methods. Pins, lines, links and cuts are ignored, because they belong to two
    /// particular designs.
    pub options: TransitionOptions,
    /// Whether jobs beyond the limits of [`crate::work::budget`] may start.
    pub patient: bool,
}

impl SpaceSpec {
    /// Creates a specification with default options and automatic content.
    #[must_use]
    pub fn new(designs: Vec<Arc<Design>>) -> Self {
        Self {
            designs,
            content: None,
            warp: WarpKind::None,
            features: ManyFeatures::default(),
            unmatched_features: 0,
            notes: Vec::new(),
            options: TransitionOptions::default(),
            patient: false,
        }
    }

    /// Returns the specification of the transition between two of the designs.
    fn pair(&self, source: usize, target: usize) -> TransitionSpec {
        let [a, b] = [source, target].map(|k| Arc::clone(&self.designs[k]));
        let mut spec = TransitionSpec::new(a, b);
        spec.method = TransitionMethod::RIGID_PARTS;
        spec.others = self.designs.clone();
        spec.patient = self.patient;
        spec.options = TransitionOptions {
            matching: MatchSettings {
                pins: Vec::new(),
                lines: Vec::new(),
                links: Vec::new(),
                lone: Vec::new(),
                cuts: Vec::new(),
                ..self.options.matching.clone()
            },
            parts: Vec::new(),
            paint: PaintRule::One,
            // Only the match of the transition is used, so collisions need not be avoided.
            guard: CollisionAvoidance::Off,
            ..self.options.clone()
        };
        spec
    }
}

impl DesignSpace {
    /// Builds a space. For rigid parts, matches and triangulates the designs and factors the
    /// equations of their blends. Otherwise, computes distance fields or prepares pictures.
    ///
    /// # Errors
    /// [`SpaceError`] says why the designs are incompatible, or that the work was cancelled.
    pub fn build(spec: &SpaceSpec, progress: &dyn Progress) -> Result<Self, SpaceError> {
        let count = spec.designs.len();
        if count < 2 {
            return Err(SpaceError::TooFew(count));
        }
        let progress = &OverallProgress::new(progress).patient(spec.patient);
        if spec.content == Some(ContentKind::Colours) {
            return Self::of_pictures(spec, progress);
        }
        let first = spec.pair(0, 1);
        let bar_width = bar_width(&first)?;
        let mut notes = spec.notes.clone();
        if spec.designs.iter().any(|design| design.is_painted()) {
            notes.push(SpaceNote::PaintIgnored);
        }
        let built = BuiltContent::of(spec, bar_width, &ProgressSpan::new(progress, 0.0, 0.3))?;
        let content_progress = ProgressSpan::new(progress, 0.3, 1.0);
        let solid = match spec.content {
            Some(ContentKind::Solid) | None => Some(built.solid(spec, &content_progress)?),
            Some(_) => None,
        };
        let content = match solid {
            Some(Ok(content)) => content,
            Some(Err(error)) if spec.content.is_some() => {
                return Err(SpaceError::NoCommonMesh(error));
            }
            no_mesh => {
                if let Some(Err(error)) = no_mesh {
                    notes.push(SpaceNote::AsFields(error.to_string()));
                }
                fields(spec, &first, bar_width, &content_progress)?
            }
        };
        let mut inner = DesignSpaceData {
            designs: spec.designs.clone(),
            bounds: field_frame(&first, bar_width),
            content,
            bar_width,
            distances: built.distances,
            notes,
        };
        if let BlendContent::Solid { blend, .. } = &inner.content {
            inner.bounds = swept_bounds(inner.bounds, blend, bar_width);
        }
        Ok(inner.into())
    }

    /// Builds a space of pictures.
    fn of_pictures(spec: &SpaceSpec, progress: &dyn Progress) -> Result<Self, SpaceError> {
        let pictures = PictureSpace::of(
            &spec.designs,
            spec.warp,
            &spec.features,
            &spec.options,
            progress,
        )?;
        let unmatched = Some(spec.unmatched_features).filter(|count| *count > 0);
        let inner = DesignSpaceData {
            designs: spec.designs.clone(),
            bounds: pictures.bounds(),
            bar_width: 0.0,
            distances: pictures.distances(),
            notes: (spec.notes.iter().cloned())
                .chain(unmatched.map(SpaceNote::UnmatchedFeatures))
                .collect(),
            content: BlendContent::Colours(Box::new(pictures)),
        };
        Ok(inner.into())
    }
}

/// Way to obtain the common mesh of the designs, and their dissimilarities.
struct BuiltContent {
    form: CommonForms,
    distances: DesignDistances,
}

/// Way to obtain the common mesh of the designs.
enum CommonForms {
    /// The common mesh, or why there is none, and the bars of trusses. This variant is used for
    /// trusses, for meshes with common connectivity, and for outlines with too many points to be
    /// matched.
    Given(Result<CompatibleFamily, FamilyError>, Vec<[u32; 2]>),
    /// The outlines of the designs must be matched and triangulated.
    Outlines,
}

impl BuiltContent {
    /// Determines how the common mesh is obtained, and measures how dissimilar the designs are.
    fn of(spec: &SpaceSpec, bar_width: f64, progress: &dyn Progress) -> Result<Self, SpaceError> {
        if let Some(built) = Self::from_common_connectivity(&spec.designs, progress)? {
            return Ok(built);
        }
        checkpoint(progress, "matching", 0.0)?;
        let outlines = spec
            .designs
            .iter()
            .map(|design| outline(design, bar_width, progress));
        let outlines: Vec<Regions> = outlines.collect::<Result<_, _>>()?;
        if let Err(error) = check_workload(&outlines, progress) {
            return Ok(Self {
                form: CommonForms::Given(Err(error.into()), Vec::new()),
                distances: DesignDistances::uniform(outlines.len()),
            });
        }
        Ok(Self {
            form: CommonForms::Outlines,
            distances: DesignDistances::of_outlines(&outlines, &spec.options.matching, progress)?,
        })
    }

    /// Returns the common mesh and the dissimilarities of trusses or of meshes; `None` for other
    /// designs, or if the numbers of points differ.
    fn from_common_connectivity(
        designs: &[Arc<Design>],
        progress: &dyn Progress,
    ) -> Result<Option<Self>, SpaceError> {
        let trusses: Option<Vec<&Truss>> = designs.iter().map(truss).collect();
        let meshes: Option<Vec<&TriangleMesh>> = designs.iter().map(mesh).collect();
        let places: Vec<_> = designs.iter().filter_map(points).collect();
        if places.windows(2).any(|pair| pair[0].len() != pair[1].len()) {
            return Ok(None);
        }
        let form = if let Some(trusses) = trusses {
            let bars = trusses[0].bars().to_vec();
            WorkloadKind::Bars
                .check(bars.len(), progress)
                .map_err(BuildError::from)?;
            CommonForms::Given(CompatibleFamily::from_trusses(&trusses, progress), bars)
        } else if let Some(meshes) = meshes {
            CommonForms::Given(CompatibleFamily::from_meshes(&meshes), Vec::new())
        } else {
            return Ok(None);
        };
        let distances = DesignDistances::of_corresponding_points(&places);
        Ok(Some(Self { form, distances }))
    }

    /// Returns the content for blending rigid parts. The inner error says why there is no common
    /// mesh.
    fn solid(
        &self,
        spec: &SpaceSpec,
        progress: &dyn Progress,
    ) -> Result<Result<BlendContent, FamilyError>, SpaceError> {
        let (family, bars) = match &self.form {
            CommonForms::Given(family, bars) => (family.clone(), bars.clone()),
            CommonForms::Outlines => {
                let matching = ProgressSpan::new(progress, 0.0, 0.9);
                (self.outlines(spec, &matching)?, Vec::new())
            }
        };
        // A cancellation also appears as an error of the mesh, but must be returned as a
        // cancellation.
        check_cancelled(progress)?;
        let family = match family {
            Ok(family) => family,
            Err(error) => return Ok(Err(error)),
        };
        let blend = ArapBlend::build(&family, &ProgressSpan::new(progress, 0.9, 1.0))?;
        let boundary_loops = match bars.is_empty() {
            true => family.boundary_loops(),
            // A truss is drawn as bars only, without a fill.
            false => Vec::new(),
        };
        Ok(Ok(BlendContent::Solid {
            blend,
            boundary_loops,
            bars,
        }))
    }

    /// Builds the common mesh of outlines by matching all of them with one design, the hub.
    ///
    /// The first hub to be tried is the design with the smallest sum of dissimilarities to all
    /// others.
    fn outlines(
        &self,
        spec: &SpaceSpec,
        progress: &dyn Progress,
    ) -> Result<Result<CompatibleFamily, FamilyError>, SpaceError> {
        let hubs = self.distances.most_central_first();
        let requested = spec.options.quality;
        let drafts = hubs
            .iter()
            .take(MAX_HUBS)
            .map(|&hub| (hub, BuildQuality::Draft));
        let best = hubs.first().map(|&hub| (hub, requested));
        let attempts: Vec<_> = best
            .filter(|_| requested != BuildQuality::Draft)
            .into_iter()
            .chain(drafts)
            .collect();
        let shares = ProgressShares::new(progress, attempts.len());
        let mut first_error = None;
        for (attempt, &(hub, quality)) in attempts.iter().enumerate() {
            let progress = &shares.part(attempt);
            let matches = matches(spec, hub, quality, &ProgressSpan::new(progress, 0.0, 0.7))?;
            let matches: Vec<Option<&RegionMatch>> = matches.iter().map(Option::as_ref).collect();
            let options = &spec.options.triangulation;
            let meshing = ProgressSpan::new(progress, 0.7, 1.0);
            let family = CompatibleFamily::from_outlines(hub, &matches, options, &meshing);
            check_cancelled(progress)?;
            match family {
                Ok(family) => return Ok(Ok(family)),
                // Another hub does not help: parts without a counterpart remain unmatched with any
                // hub.
                Err(error @ FamilyError::PartsDiffer { .. }) => return Ok(Err(error)),
                Err(error) => _ = first_error.get_or_insert(error),
            }
        }
        let count = spec.designs.len();
        Ok(Err(first_error.unwrap_or(FamilyError::TooFew(count))))
    }
}

/// Checks whether the outlines of a design space may be matched without confirmation.
///
/// # Errors
/// [`WorkloadTooLarge`] if there are too many outlines or points.
fn check_workload(outlines: &[Regions], progress: &dyn Progress) -> Result<(), WorkloadTooLarge> {
    WorkloadKind::Designs.check(outlines.len(), progress)?;
    // Only two designs at a time are matched, so the limit applies to the points of two designs.
    // Only consecutive designs are checked.
    outlines.windows(2).try_for_each(|pair| {
        let rings = pair.iter().flat_map(Regions::rings);
        WorkloadKind::Points.check(rings.map(|ring| ring.points().len()).sum(), progress)
    })
}

/// Matches the hub with each other design by building the transition between them.
///
/// Returns one match per design; that of the hub itself is `None`.
fn matches(
    spec: &SpaceSpec,
    hub: usize,
    quality: BuildQuality,
    progress: &dyn Progress,
) -> Result<Vec<Option<RegionMatch>>, SpaceError> {
    let count = spec.designs.len();
    let shares = ProgressShares::new(progress, count);
    let match_with_hub = |design: usize| {
        if design == hub {
            return Ok(None);
        }
        let mut pair = spec.pair(hub, design);
        pair.options.quality = quality;
        let transition = Transition::build(&pair, &shares.part(design))?;
        Ok(transition.matched().cloned())
    };
    let all: Vec<Result<_, BuildError>> = (0..count).into_par_iter().map(match_with_hub).collect();
    Ok(all.into_iter().collect::<Result<_, _>>()?)
}

fn truss(design: &Arc<Design>) -> Option<&Truss> {
    match &design.form {
        DesignForm::Truss(truss) => Some(truss),
        _ => None,
    }
}

/// Returns the nodes of a truss or the vertices of a mesh; `None` for outlines.
fn points(design: &Arc<Design>) -> Option<Vec<DVec2>> {
    match &design.form {
        DesignForm::Truss(truss) => Some(truss.nodes().to_vec()),
        DesignForm::Mesh(mesh) => Some(mesh.positions().to_vec()),
        DesignForm::Outline(_) => None,
    }
}

fn mesh(design: &Arc<Design>) -> Option<&TriangleMesh> {
    match &design.form {
        DesignForm::Mesh(mesh) => Some(mesh),
        _ => None,
    }
}

/// Computes the distance fields of all designs on one grid. The grid covers the same rectangle as
/// the grid of the transition that `frame` specifies.
fn fields(
    spec: &SpaceSpec,
    frame: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<BlendContent, SpaceError> {
    checkpoint(progress, "measuring distances", 0.0)?;
    let options = &spec.options.field;
    let bounds = field_frame(frame, bar_width);
    let grid = Grid::covering(&bounds, options.cells, options.margin).map_err(BuildError::from)?;
    let cells = grid.cells() * spec.designs.len();
    WorkloadKind::Cells
        .check(cells, progress)
        .map_err(BuildError::from)?;
    let shares = ProgressShares::new(progress, spec.designs.len());
    let field = |(k, design): (usize, &Arc<Design>)| {
        let progress = &shares.part(k);
        let outline = outline(design, bar_width, progress)?;
        measured(&outline, grid, options, progress)
            .map_err(|error| BuildError::Unavailable(format!("{}: {error}", design.name)))
    };
    let fields: Vec<Result<_, BuildError>> =
        spec.designs.par_iter().enumerate().map(field).collect();
    check_cancelled(progress)?;
    let fields = fields.into_iter().collect::<Result<_, _>>()?;
    let set = FieldSet::new(fields, options.blend).map_err(BuildError::from)?;
    Ok(BlendContent::Field(
        set.unwrap_or_else(|| unreachable!("there are designs")),
    ))
}

/// Returns a box around `ends` (the box of all designs), the blends halfway between each pair of
/// designs, and the blend of all designs with equal weights. The blends are widened by half of
/// `bar_width`.
fn swept_bounds(ends: Bounds, blend: &ArapBlend, bar_width: f64) -> Bounds {
    let count = blend.family().count();
    let mut placer = blend.placer();
    let mut weights = vec![1.0 / count as f64; count];
    let mut bounds = ends;
    let mut include = |weights: &[f64]| {
        if let Some(blend_bounds) = Bounds::of(placer.place(weights).iter().copied()) {
            bounds = bounds.union(&blend_bounds.padded(0.5 * bar_width));
        }
    };
    include(&weights);
    for a in 0..count {
        for b in a + 1..count {
            weights.fill(0.0);
            (weights[a], weights[b]) = (0.5, 0.5);
            include(&weights);
        }
    }
    bounds
}
