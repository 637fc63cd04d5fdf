//! From two designs to a transition: everything that can fail.

use super::options::{Boundary, Options};
use super::{Cell, Inner, boundaries, outlines, plane};
use crate::compatible::{CompatibleError, CompatibleMesh, OutlinesError, PinnedError};
use crate::content::{
    ColourMixError, Content, ContentKind, FieldPair, FieldPairError, PicturePair, Solid,
};
use crate::correspondence::{RegionMatch, RegionMatchError};
use crate::design::{Design, Form, Format, Picture};
use crate::field::{DistanceField, FieldError, Grid, GridError, Metric};
use crate::geometry::{Bounds, RegionsError};
use crate::progress::{Cancelled, Progress, checkpoint};
use crate::warp::{
    Arap, ArapError, LatticeError, LinesError, PathsError, ScatteredError, Warp, WarpKind,
};
use std::sync::Arc;

/// Everything a transition is built from: two designs laid into one frame, a
/// cell of the table and the options of all methods.
#[derive(Clone, Debug)]
pub struct TransitionSpec {
    /// The design at t = 0.
    pub source: Arc<Design>,
    /// The design at t = 1.
    pub target: Arc<Design>,
    /// Warp and content.
    pub cell: Cell,
    /// The options of all methods; places of the match are in the common
    /// frame.
    pub options: Options,
}

/// Why a transition could not be built.
#[derive(Clone, Debug, thiserror::Error)]
pub enum BuildError {
    /// The designs are of kinds that cannot be interpolated this way.
    #[error("{0}")]
    Unavailable(String),
    /// The designs do not share a triangulation.
    #[error("{source_name} and {target_name}: {error}")]
    Compatible {
        /// Name of the source.
        source_name: String,
        /// Name of the target.
        target_name: String,
        /// What does not fit.
        error: CompatibleError,
    },
    /// The outlines were not matched.
    #[error(transparent)]
    Match(#[from] RegionMatchError),
    /// The matched outlines were not triangulated.
    #[error(transparent)]
    Triangulation(#[from] OutlinesError),
    /// The rigidity-preserving interpolation failed.
    #[error(transparent)]
    Arap(#[from] ArapError),
    /// A design has no outline.
    #[error(transparent)]
    Outline(#[from] RegionsError),
    /// The frame has no grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A distance field could not be made.
    #[error("{design}: {error}")]
    Field {
        /// Name of the design.
        design: String,
        /// What went wrong.
        error: FieldError,
    },
    /// ε or the threshold is out of range.
    #[error(transparent)]
    Blend(#[from] FieldPairError),
    /// The span in which colours change is none.
    #[error(transparent)]
    Colours(#[from] ColourMixError),
    /// The frame could not be triangulated with its pins.
    #[error(transparent)]
    Frame(#[from] PinnedError),
    /// The warp by lines could not be made.
    #[error(transparent)]
    Lines(#[from] LinesError),
    /// The warp by scattered points could not be made.
    #[error(transparent)]
    Scattered(#[from] ScatteredError),
    /// The warp by lattices could not be made.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// The boundary paths could not be made.
    #[error(transparent)]
    Paths(#[from] PathsError),
    /// The width of bars is no positive number.
    #[error("the bar width {0} is not between 0 and 1; give a fraction of the design's size")]
    BarWidth(f64),
    /// Nobody wants the result.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl TransitionSpec {
    /// Two designs by the method that suits them best, with default options.
    #[must_use]
    pub fn new(source: Arc<Design>, target: Arc<Design>) -> Self {
        let are_photographs = [&source, &target]
            .iter()
            .all(|d| d.picture.as_ref().is_some_and(Picture::is_photograph));
        let cell = if are_photographs {
            Cell::CROSS_DISSOLVE
        } else {
            Cell::RIGID_PARTS
        };
        Self {
            source,
            target,
            cell,
            options: Options::default(),
        }
    }

    /// Whether designs of these kinds can be interpolated by `cell`, without
    /// trying.
    ///
    /// # Errors
    /// [`BuildError::Unavailable`] with the reason, for a greyed button.
    pub fn available(cell: Cell, source: &Design, target: &Design) -> Result<(), BuildError> {
        // Every form has an outline; not every one came as a picture.
        if cell.content() != ContentKind::Colours {
            return Ok(());
        }
        match [source, target].iter().find(|d| d.picture.is_none()) {
            None => Ok(()),
            Some(design) => Err(BuildError::Unavailable(format!(
                "{} has no colours: open two pictures ({}), or choose fields or solids",
                design.name,
                Format::listed(&Format::PICTURES)
            ))),
        }
    }
}

pub(super) fn build(spec: &TransitionSpec, progress: &dyn Progress) -> Result<Inner, BuildError> {
    TransitionSpec::available(spec.cell, &spec.source, &spec.target)?;
    if !(spec.options.bar_width > 0.0 && spec.options.bar_width <= 1.0) {
        return Err(BuildError::BarWidth(spec.options.bar_width));
    }
    let diameter = extent(&spec.source)
        .diameter()
        .max(extent(&spec.target).diameter());
    let bar_width = spec.options.bar_width * diameter;
    match spec.cell.content() {
        ContentKind::Solid if spec.cell.warp() == WarpKind::Paths => {
            build_paths(spec, bar_width, progress)
        }
        ContentKind::Solid => build_arap(spec, bar_width, progress),
        ContentKind::Field => build_field(spec, bar_width, progress),
        ContentKind::Colours => build_colours(spec, progress),
    }
}

/// The box around the form itself, not around its picture.
fn extent(design: &Design) -> Bounds {
    match &design.form {
        Form::Outline(regions) => regions.bounds(),
        Form::Mesh(mesh) => mesh.bounds(),
        Form::Truss(truss) => truss.bounds(),
    }
}

fn build_arap(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Inner, BuildError> {
    checkpoint(progress, "triangulating", 0.0)?;
    let Common {
        arap,
        bars,
        matched,
    } = common(spec, bar_width, progress)?;
    let loops = if bars.is_empty() {
        arap.mesh().boundary_loops()
    } else {
        Vec::new()
    };
    let room = if bars.is_empty() { 0.0 } else { bar_width };
    let content = Content::Solid(Solid {
        loops,
        bars,
        bar_width,
    });
    Ok(Inner {
        cell: spec.cell,
        designs: [Arc::clone(&spec.source), Arc::clone(&spec.target)],
        bounds: swept_bounds(&arap).padded(room),
        warp: Arc::new(arap.clone()),
        arap: Some(arap),
        automatic: Vec::new(),
        matched,
        content,
        bar_width,
    })
}

fn build_paths(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Inner, BuildError> {
    checkpoint(progress, "matching", 0.0)?;
    let (paths, matched) = boundaries::paths(spec, bar_width, progress)?;
    checkpoint(progress, "preparing frames", 0.9)?;
    Ok(Inner {
        cell: spec.cell,
        designs: [Arc::clone(&spec.source), Arc::clone(&spec.target)],
        bounds: swept_bounds(&paths),
        content: Content::Solid(Solid {
            loops: paths.loops(),
            ..Solid::default()
        }),
        warp: Arc::new(paths),
        arap: None,
        automatic: Vec::new(),
        matched,
        bar_width,
    })
}

/// One triangulation of both designs, ready to be interpolated.
struct Common {
    arap: Arap,
    bars: Vec<[u32; 2]>,
    /// How outlines were matched; meshes and trusses bring their match along.
    matched: Option<RegionMatch>,
}

fn common(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Common, BuildError> {
    let (mesh, bars) = match (&spec.source.form, &spec.target.form) {
        (Form::Mesh(a), Form::Mesh(b)) => (CompatibleMesh::from_meshes(a, b), Vec::new()),
        (Form::Truss(a), Form::Truss(b)) => (CompatibleMesh::from_trusses(a, b), a.bars().to_vec()),
        _ => {
            let (matched, arap) = outlines::best(spec, bar_width, progress)?;
            return Ok(Common {
                arap,
                bars: Vec::new(),
                matched: Some(matched),
            });
        }
    };
    let mesh = mesh.map_err(|error| BuildError::Compatible {
        source_name: spec.source.name.clone(),
        target_name: spec.target.name.clone(),
        error,
    })?;
    Ok(Common {
        arap: Arap::build(&mesh, &spec.options.arap, progress)?,
        bars,
        matched: None,
    })
}

/// The box around a few frames: a part that swings may leave the ends' box.
fn swept_bounds(warp: &dyn Warp) -> Bounds {
    const SAMPLES: u32 = 8;
    let mut placer = warp.placer();
    let placement = placer.placement();
    let ends = placement.in_source.iter().chain(&placement.in_target);
    let mut bounds =
        Bounds::of(ends.copied()).unwrap_or_else(|| unreachable!("a warp of solids has vertices"));
    for i in 1..SAMPLES {
        placer.place(f64::from(i) / f64::from(SAMPLES));
        if let Some(b) = Bounds::of(placer.placement().in_frame.iter().copied()) {
            bounds = bounds.union(&b);
        }
    }
    bounds
}

/// The same around what a warp carries, which may leave the frame on its way.
fn carried_bounds(frame: Bounds, warp: &dyn Warp, pair: &FieldPair) -> Bounds {
    const SAMPLES: u32 = 8;
    let mut placer = warp.placer();
    let mut bounds = frame;
    for i in 1..SAMPLES {
        let t = f64::from(i) / f64::from(SAMPLES);
        placer.place(t);
        let rings = pair.contour_carried(placer.placement(), t);
        if let Some(seen) = Bounds::of(rings.into_iter().flatten()) {
            bounds = bounds.union(&seen);
        }
    }
    bounds
}

fn build_field(
    spec: &TransitionSpec,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Inner, BuildError> {
    let frame = field_frame(spec, bar_width);
    let grid = Grid::covering(&frame, spec.options.field.cells, spec.options.field.margin)?;
    let source = field_of(&spec.source, spec, grid, bar_width, progress)?;
    checkpoint(progress, "measuring distances", 0.5)?;
    let target = field_of(&spec.target, spec, grid, bar_width, progress)?;
    let pair = FieldPair::new(source, target, spec.options.field.blend)?;
    let (warp, automatic) = plane::warp(spec, &grid.bounds(), bar_width, progress)?;
    let bounds = if spec.cell.warp() == WarpKind::None {
        frame
    } else {
        carried_bounds(frame, warp.as_ref(), &pair)
    };
    Ok(Inner {
        cell: spec.cell,
        designs: [Arc::clone(&spec.source), Arc::clone(&spec.target)],
        warp,
        automatic,
        arap: None,
        matched: None,
        bounds,
        content: Content::Field(pair),
        bar_width,
    })
}

fn build_colours(spec: &TransitionSpec, progress: &dyn Progress) -> Result<Inner, BuildError> {
    checkpoint(progress, "reading colours", 0.0)?;
    let picture = |design: &Design| {
        let missing = || BuildError::Unavailable(format!("{} has no colours", design.name));
        design.picture.clone().ok_or_else(missing)
    };
    let [source, target] = [picture(&spec.source)?, picture(&spec.target)?];
    let bounds = source.bounds().union(&target.bounds());
    let pair = PicturePair::new(&source, &target, spec.options.colours)?;
    // The mesh reaches beyond what is shown, so that its edge is never seen.
    let frame = bounds.padded(0.02 * bounds.diameter());
    let (warp, automatic) = plane::warp(spec, &frame, 0.0, progress)?;
    Ok(Inner {
        cell: spec.cell,
        designs: [Arc::clone(&spec.source), Arc::clone(&spec.target)],
        warp,
        automatic,
        arap: None,
        matched: None,
        bounds,
        content: Content::Colours(pair),
        bar_width: 0.0,
    })
}

/// The rectangle of the fields without their margin: pictures and pages whole,
/// meshes and trusses with the thickness of their bars.
fn field_frame(spec: &TransitionSpec, bar_width: f64) -> Bounds {
    let of = |design: &Design| match design.form {
        Form::Truss(_) => design.extent.padded(0.5 * bar_width),
        _ => design.extent.union(&extent(design)),
    };
    of(&spec.source).union(&of(&spec.target))
}

fn field_of(
    design: &Design,
    spec: &TransitionSpec,
    grid: Grid,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<DistanceField, BuildError> {
    let outline = design.outline(bar_width)?;
    // The exact boundary has Euclidean distances only; the other metrics
    // belong to the pixels of a binary picture.
    let exact = spec.options.field.boundary == Boundary::Exact
        && spec.options.field.metric == Metric::Euclidean;
    let field = if exact {
        DistanceField::from_regions(&outline, grid, progress)
    } else {
        DistanceField::from_raster(&outline, grid, spec.options.field.metric, progress)
    };
    field.map_err(|error| match error {
        FieldError::Cancelled(cancelled) => BuildError::Cancelled(cancelled),
        error => BuildError::Field {
            design: design.name.clone(),
            error,
        },
    })
}
