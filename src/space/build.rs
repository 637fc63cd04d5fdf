//! From designs to a space: everything that can fail.

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
use crate::work::budget::WorkloadKind;
use crate::work::progress::{
    Progress, ProgressShares, ProgressSpan, WholeProgress, checkpoint, still_wanted,
};
use rayon::prelude::*;
use std::sync::Arc;

/// How many hubs are tried before outlines have no common mesh, after the best matches with
/// the first, by drafts of their matches. The best ones have their points where their films
/// need them, close together in places, and one mesh for all may fold then: of a bone, a
/// bottle, a fish and a key it did with all hubs, and by drafts with none.
const HUBS: usize = 3;

/// What a space is built from: designs laid into one frame.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpaceSpec {
    /// Two designs or more.
    pub designs: Vec<Arc<Design>>,
    /// Solid for rigid parts, or fields, or pictures; none for rigid parts where the
    /// designs have a common mesh, and else fields.
    pub content: Option<ContentKind>,
    /// What pictures are led by: lines, points or a lattice; any other leaves them where
    /// they lie.
    pub warp: WarpKind,
    /// Where what all pictures have is in each of them, in the common frame.
    pub features: ManyFeatures,
    /// How many features only some of them have, which is told.
    pub lone_features: usize,
    /// The options of both; pins, links and cuts are of two designs, and left out.
    pub options: TransitionOptions,
    /// Whether what takes very long is begun all the same; see [`crate::work::budget`].
    pub patient: bool,
}

impl SpaceSpec {
    /// Designs as they suit best, with default options.
    #[must_use]
    pub fn new(designs: Vec<Arc<Design>>) -> Self {
        Self {
            designs,
            content: None,
            warp: WarpKind::None,
            features: ManyFeatures::default(),
            lone_features: 0,
            options: TransitionOptions::default(),
            patient: false,
        }
    }

    /// Two of the designs, the others beside them in the same frame.
    fn pair(&self, source: usize, target: usize) -> TransitionSpec {
        let [a, b] = [source, target].map(|k| Arc::clone(&self.designs[k]));
        let mut spec = TransitionSpec::new(a, b);
        spec.cell = TransitionMethod::RIGID_PARTS;
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
            // The match alone is wanted.
            guard: CollisionAvoidance::Plain,
            ..self.options.clone()
        };
        spec
    }
}

impl DesignSpace {
    /// Matches, triangulates and factors, or measures the fields.
    ///
    /// # Errors
    /// [`SpaceError`] says what does not go together, or that nobody wants the result.
    pub fn build(spec: &SpaceSpec, progress: &dyn Progress) -> Result<Self, SpaceError> {
        let count = spec.designs.len();
        if count < 2 {
            return Err(SpaceError::TooFew(count));
        }
        let progress = &WholeProgress::new(progress).patient(spec.patient);
        if spec.content == Some(ContentKind::Colours) {
            return Self::of_pictures(spec, progress);
        }
        let first = spec.pair(0, 1);
        let bar_width = bar_width(&first)?;
        let mut notes = Vec::new();
        if spec.designs.iter().any(|design| !design.coats.is_empty()) {
            notes.push(SpaceNote::OneColour);
        }
        let made = BuiltContent::of(spec, bar_width, &ProgressSpan::new(progress, 0.0, 0.3))?;
        let rest = ProgressSpan::new(progress, 0.3, 1.0);
        let solid = match spec.content {
            Some(ContentKind::Solid) | None => Some(made.solid(spec, &rest)?),
            Some(_) => None,
        };
        let seen = match solid {
            Some(Ok(seen)) => seen,
            Some(Err(error)) if spec.content.is_some() => {
                return Err(SpaceError::NoFamily(error));
            }
            other => {
                if let Some(Err(error)) = other {
                    notes.push(SpaceNote::AsFields(error.to_string()));
                }
                fields(spec, &first, bar_width, &rest)?
            }
        };
        let mut inner = DesignSpaceData {
            designs: spec.designs.clone(),
            bounds: field_frame(&first, bar_width),
            seen,
            bar_width,
            likeness: made.likeness,
            notes,
        };
        if let BlendContent::Solid { blend, .. } = &inner.seen {
            inner.bounds = swept(inner.bounds, blend, bar_width);
        }
        Ok(inner.into())
    }

    fn of_pictures(spec: &SpaceSpec, progress: &dyn Progress) -> Result<Self, SpaceError> {
        let pictures = PictureSpace::of(
            &spec.designs,
            (spec.warp, &spec.features),
            &spec.options,
            progress,
        )?;
        let lone = Some(spec.lone_features).filter(|lone| *lone > 0);
        let inner = DesignSpaceData {
            designs: spec.designs.clone(),
            bounds: pictures.bounds(),
            bar_width: 0.0,
            likeness: pictures.likeness(),
            notes: lone.map(SpaceNote::LoneFeatures).into_iter().collect(),
            seen: BlendContent::Colours(Box::new(pictures)),
        };
        Ok(inner.into())
    }
}

/// What the designs are, and how unlike each other.
struct BuiltContent {
    form: CommonForms,
    likeness: DesignDistances,
}

/// Designs that share their connectivity, or are matched.
enum CommonForms {
    /// A common mesh, or why there is none, and the bars.
    Given(Result<CompatibleFamily, FamilyError>, Vec<[u32; 2]>),
    /// It is to be made.
    Outlines,
}

impl BuiltContent {
    fn of(spec: &SpaceSpec, bar_width: f64, progress: &dyn Progress) -> Result<Self, SpaceError> {
        if let Some(given) = Self::given(&spec.designs, progress)? {
            return Ok(given);
        }
        checkpoint(progress, "matching", 0.0)?;
        let outlines = spec.designs.iter();
        let outlines = outlines.map(|design| outline(design, bar_width, progress));
        let outlines: Vec<Regions> = outlines.collect::<Result<_, _>>()?;
        // Each as often as there are others, two at a time.
        for two in outlines.windows(2) {
            let rings = two.iter().flat_map(Regions::rings);
            let points = rings.map(|ring| ring.points().len()).sum();
            if let Err(error) = WorkloadKind::Points.allow(points, progress) {
                return Ok(Self {
                    form: CommonForms::Given(Err(error.into()), Vec::new()),
                    likeness: DesignDistances::even(outlines.len()),
                });
            }
        }
        Ok(Self {
            form: CommonForms::Outlines,
            likeness: DesignDistances::of_outlines(&outlines, &spec.options.matching, progress)?,
        })
    }

    /// Trusses, or meshes, of as many points each; none of others.
    fn given(designs: &[Arc<Design>], progress: &dyn Progress) -> Result<Option<Self>, SpaceError> {
        let trusses: Option<Vec<&Truss>> = designs.iter().map(truss).collect();
        let meshes: Option<Vec<&TriangleMesh>> = designs.iter().map(mesh).collect();
        let places: Vec<_> = designs.iter().filter_map(points).collect();
        if places.windows(2).any(|two| two[0].len() != two[1].len()) {
            return Ok(None);
        }
        let form = if let Some(trusses) = trusses {
            let bars = trusses[0].bars().to_vec();
            WorkloadKind::Bars
                .allow(bars.len(), progress)
                .map_err(BuildError::from)?;
            CommonForms::Given(CompatibleFamily::from_trusses(&trusses, progress), bars)
        } else if let Some(meshes) = meshes {
            CommonForms::Given(CompatibleFamily::from_meshes(&meshes), Vec::new())
        } else {
            return Ok(None);
        };
        let likeness = DesignDistances::of_points(&places);
        Ok(Some(Self { form, likeness }))
    }

    /// As rigid parts; why not, where there is no common mesh.
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
        // A cancel comes back as an error of the mesh.
        still_wanted(progress)?;
        let family = match family {
            Ok(family) => family,
            Err(error) => return Ok(Err(error)),
        };
        let blend = ArapBlend::build(&family, &ProgressSpan::new(progress, 0.9, 1.0))?;
        let walks = match bars.is_empty() {
            true => family.boundary_loops(),
            // Of a truss its bars are drawn, and nothing between them.
            false => Vec::new(),
        };
        Ok(Ok(BlendContent::Solid { blend, walks, bars }))
    }

    /// A common mesh of outlines: all are matched with the one that is least unlike them.
    fn outlines(
        &self,
        spec: &SpaceSpec,
        progress: &dyn Progress,
    ) -> Result<Result<CompatibleFamily, FamilyError>, SpaceError> {
        let hubs = self.likeness.by_nearness();
        let asked = spec.options.quality;
        let drafts = hubs
            .iter()
            .take(HUBS)
            .map(|&hub| (hub, BuildQuality::Draft));
        let best = hubs.first().map(|&hub| (hub, asked));
        let tries: Vec<_> = best
            .filter(|_| asked != BuildQuality::Draft)
            .into_iter()
            .chain(drafts)
            .collect();
        let several = ProgressShares::new(progress, tries.len());
        let mut first = None;
        for (tried, &way) in tries.iter().enumerate() {
            let progress = &several.part(tried);
            let matches = matches(spec, way, &ProgressSpan::new(progress, 0.0, 0.7))?;
            let matches: Vec<Option<&RegionMatch>> = matches.iter().map(Option::as_ref).collect();
            let options = &spec.options.triangulation;
            let meshing = ProgressSpan::new(progress, 0.7, 1.0);
            let family = CompatibleFamily::from_outlines(way.0, &matches, options, &meshing);
            still_wanted(progress)?;
            match family {
                Ok(family) => return Ok(Ok(family)),
                // What one has alone it has whichever is the hub.
                Err(error @ FamilyError::Parts { .. }) => return Ok(Err(error)),
                Err(error) => _ = first.get_or_insert(error),
            }
        }
        let count = spec.designs.len();
        Ok(Err(first.unwrap_or(FamilyError::TooFew(count))))
    }
}

/// The match of the hub with each other design, as the best film between the two has it.
fn matches(
    spec: &SpaceSpec,
    (hub, quality): (usize, BuildQuality),
    progress: &dyn Progress,
) -> Result<Vec<Option<RegionMatch>>, SpaceError> {
    let count = spec.designs.len();
    let several = ProgressShares::new(progress, count);
    let matched = |design: usize| {
        if design == hub {
            return Ok(None);
        }
        let mut pair = spec.pair(hub, design);
        pair.options.quality = quality;
        let made = Transition::build(&pair, &several.part(design))?;
        Ok(made.matched().cloned())
    };
    let all: Vec<Result<_, BuildError>> = (0..count).into_par_iter().map(matched).collect();
    Ok(all.into_iter().collect::<Result<_, _>>()?)
}

fn truss(design: &Arc<Design>) -> Option<&Truss> {
    match &design.form {
        DesignForm::Truss(truss) => Some(truss),
        _ => None,
    }
}

/// The points of what has some of its own.
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

/// As distance fields on one grid.
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
        .allow(cells, progress)
        .map_err(BuildError::from)?;
    let several = ProgressShares::new(progress, spec.designs.len());
    let field = |(k, design): (usize, &Arc<Design>)| {
        let progress = &several.part(k);
        let outline = outline(design, bar_width, progress)?;
        measured(&outline, grid, options, progress)
            .map_err(|error| BuildError::Unavailable(format!("{}: {error}", design.name)))
    };
    let fields: Vec<Result<_, BuildError>> =
        spec.designs.par_iter().enumerate().map(field).collect();
    still_wanted(progress)?;
    let fields = fields.into_iter().collect::<Result<_, _>>()?;
    let set = FieldSet::new(fields, options.blend).map_err(BuildError::from)?;
    Ok(BlendContent::Field(
        set.unwrap_or_else(|| unreachable!("there are designs")),
    ))
}

/// The box around the designs and what is seen halfway between each two, and between all.
fn swept(ends: Bounds, blend: &ArapBlend, room: f64) -> Bounds {
    let count = blend.family().count();
    let mut placer = blend.placer();
    let mut weights = vec![1.0 / count as f64; count];
    let mut bounds = ends;
    let mut widen = |weights: &[f64]| {
        if let Some(now) = Bounds::of(placer.place(weights).iter().copied()) {
            bounds = bounds.union(&now.padded(0.5 * room));
        }
    };
    widen(&weights);
    for a in 0..count {
        for b in a + 1..count {
            weights.fill(0.0);
            (weights[a], weights[b]) = (0.5, 0.5);
            widen(&weights);
        }
    }
    bounds
}
