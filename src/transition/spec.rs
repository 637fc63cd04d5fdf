//! The specification from which a transition is built.

use super::cached_match;
use super::cached_match::CachedMatch;
use super::common_frame::extent;
use super::drawing_pair::{DrawingPair, need_layers};
use super::error::BuildError;
use super::method::TransitionMethod;
use super::note::TransitionNote;
use super::options::{BuildQuality, PaintRule, TransitionOptions};
use crate::content::ContentKind;
use crate::design::{Design, DesignForm, Format, PaintLayer, Picture};
use crate::geometry::{Regions, RegionsError};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Progress, checkpoint, run_cancellable};
use std::sync::Arc;

/// Everything from which a transition is built: two designs placed in one frame, a method, and the
/// options of all methods.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TransitionSpec {
    /// Design at t = 0.
    pub source: Arc<Design>,
    /// Design at t = 1.
    pub target: Arc<Design>,
    /// The method: warp and content.
    pub method: TransitionMethod,
    /// Options of all methods. Positions in the match options are in the coordinates of the common
    /// frame.
    pub options: TransitionOptions,
    /// Whether to start work that will take very long; see [`crate::work::budget`].
    pub patient: bool,
    /// A cached match, reused if it was computed for the same outlines and options.
    pub cached_match: CachedMatch,
    /// The other designs of the same sequence, placed in the same frame. They are included in the
    /// grid of distance fields and in the width of bars, which are the same in the whole sequence.
    pub others: Vec<Arc<Design>>,
    /// Notes on how the designs were prepared, which the transition takes over.
    pub notes: Vec<TransitionNote>,
}

impl TransitionSpec {
    /// Creates the specification for two designs with default options and the method that suits
    /// them best: cross-dissolve for two photographs, otherwise rigid parts.
    #[must_use]
    pub fn new(source: Arc<Design>, target: Arc<Design>) -> Self {
        let are_photographs = [&source, &target]
            .iter()
            .all(|d| d.picture.as_ref().is_some_and(Picture::is_photograph));
        let cell = if are_photographs {
            TransitionMethod::CROSS_DISSOLVE
        } else {
            TransitionMethod::RIGID_PARTS
        };
        Self {
            source,
            target,
            method: cell,
            options: TransitionOptions::default(),
            patient: false,
            cached_match: CachedMatch::default(),
            others: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// Returns the same specification in draft quality, which takes less time to build; `None` if
    /// the method has no drafts, the quality is already that of a draft, or the match is cached.
    #[must_use]
    pub fn draft(&self, progress: &dyn Progress) -> Option<Self> {
        let have_a_common_mesh = matches!(
            (&self.source.form, &self.target.form),
            (DesignForm::Mesh(_), DesignForm::Mesh(_))
                | (DesignForm::Truss(_), DesignForm::Truss(_))
        );
        let is_matched = self.method == TransitionMethod::RIGID_PARTS && !have_a_common_mesh;
        let needs_draft = is_matched && self.options.quality != BuildQuality::Draft;
        (needs_draft && !self.has_cached_match(progress)).then(|| {
            let mut draft = self.clone();
            draft.options.quality = BuildQuality::Draft;
            draft
        })
    }

    /// Returns the source, the target and the other designs of the sequence.
    pub(super) fn all_designs(&self) -> impl Iterator<Item = &Arc<Design>> {
        [&self.source, &self.target].into_iter().chain(&self.others)
    }

    /// Returns whether the cached match was computed for the outlines and options of this
    /// specification.
    fn has_cached_match(&self, progress: &dyn Progress) -> bool {
        // The key is computed from the outlines, which takes time and is useless if nothing is
        // cached.
        if self.cached_match.is_none() {
            return false;
        }
        let drawings = bar_width(self).and_then(|width| self.drawings(width, progress));
        let key = drawings.map(|drawings| cached_match::cache_key(&self.options, &drawings));
        key.is_ok_and(|key| self.cached_match.is_for(&key))
    }

    /// Returns the outlines of both designs. `bar_width` is in units of the designs.
    ///
    /// # Errors
    /// If a design has no outline, the outlines are too large, or the work is cancelled.
    pub(super) fn outlines(
        &self,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<[Regions; 2], BuildError> {
        let outlines = [
            outline(&self.source, bar_width, progress)?,
            outline(&self.target, bar_width, progress)?,
        ];
        self.check_workload(&outlines, progress)?;
        // Parts that touch in a point are valid drawings but cannot be triangulated.
        Ok(outlines.map(|outline| outline.with_contacts_separated()))
    }

    /// Returns both designs prepared for matching, with their paint layers if drawings keep their
    /// own colours. `bar_width` is in units of the designs.
    ///
    /// # Errors
    /// As for [`Self::outlines`].
    pub(super) fn drawings(
        &self,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<DrawingPair, BuildError> {
        let designs = [&self.source, &self.target];
        let in_one_colour = || {
            let outlines = self.outlines(bar_width, progress)?;
            Ok(DrawingPair::in_one_colour(outlines))
        };
        if self.options.paint == PaintRule::One || !need_layers(designs.map(|d| &**d)) {
            return in_one_colour();
        }
        let [source, target] =
            designs.map(|design| separated_paint_layers(design, bar_width, progress));
        let drawings = DrawingPair::of([source?, target?]).ok_or(RegionsError::Empty)?;
        match self.check_workload(&drawings.outlines, progress) {
            Ok(()) => Ok(drawings),
            // United outlines have fewer parts, and without colours they look the same.
            Err(BuildError::TooMuch(_)) if !designs.iter().any(|d| d.is_painted()) => {
                Ok(DrawingPair {
                    are_names_ignored: true,
                    ..in_one_colour()?
                })
            }
            Err(error) => Err(error),
        }
    }

    /// Checks that outlines do not have too many parts, holes or points to be matched.
    ///
    /// # Errors
    /// [`BuildError::TooMuch`] with the first of these numbers that is too large.
    pub(super) fn check_workload(
        &self,
        outlines: &[Regions; 2],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let pieces = outlines.iter().map(|regions| regions.len()).sum();
        let rings = outlines.iter().flat_map(Regions::rings);
        let point_counts: Vec<usize> = rings.map(|ring| ring.points().len()).collect();
        WorkloadKind::Pieces.check(pieces, progress)?;
        WorkloadKind::Holes.check(point_counts.len() - pieces, progress)?;
        Ok(WorkloadKind::Points.check(point_counts.iter().sum(), progress)?)
    }

    /// Checks whether a method can interpolate designs of these kinds, without building anything.
    ///
    /// # Errors
    /// [`BuildError::Unavailable`] with the reason. The application shows it on the disabled
    /// button.
    pub fn available(
        cell: TransitionMethod,
        source: &Design,
        target: &Design,
    ) -> Result<(), BuildError> {
        // Every design has an outline, but only pictures have colours to interpolate.
        if cell.content() != ContentKind::Colours {
            return Ok(());
        }
        match [source, target].iter().find(|d| d.picture.is_none()) {
            None => Ok(()),
            Some(design) => Err(BuildError::Unavailable(format!(
                "{} has no colours: open two pictures ({}), or choose fields or solids",
                design.name,
                Format::or_list_of_names(Format::PICTURES)
            ))),
        }
    }
}

/// Returns the width of truss bars in units of the designs: the requested fraction of the largest
/// design's diameter.
///
/// # Errors
/// [`BuildError::BarWidth`] if the requested fraction is outside 0 < fraction ≤ 1.
pub(crate) fn bar_width(spec: &TransitionSpec) -> Result<f64, BuildError> {
    let fraction = spec.options.bar_width;
    if !(fraction > 0.0 && fraction <= 1.0) {
        return Err(BuildError::BarWidth(fraction));
    }
    let diameters = spec.all_designs().map(|design| extent(design).diameter());
    Ok(fraction * diameters.fold(0.0, f64::max))
}

/// Returns the outline of a design. Uniting bars or faces is one long library call. It runs in the
/// background, so that a cancellation can end the wait for it.
///
/// # Errors
/// If there are too many bars, the outline is empty, or the work is cancelled.
pub(crate) fn outline(
    design: &Arc<Design>,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Regions, BuildError> {
    if matches!(design.form, DesignForm::Outline(_)) {
        return Ok(design.outline(bar_width)?);
    }
    if let DesignForm::Truss(truss) = &design.form {
        WorkloadKind::Bars.check(truss.bars().len(), progress)?;
    }
    checkpoint(progress, "uniting", 0.0)?;
    let design = Arc::clone(design);
    Ok(run_cancellable(progress, move || {
        design.outline(bar_width)
    })??)
}

/// Returns the paint layers of a design, or a single layer without paint if it has none. Parts that
/// touch in a point are separated.
fn separated_paint_layers(
    design: &Arc<Design>,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Vec<PaintLayer>, BuildError> {
    let layers = if design.paint_layers.is_empty() {
        vec![PaintLayer {
            regions: outline(design, bar_width, progress)?,
            paint: None,
            gradient: None,
            line: None,
            name: String::new(),
            is_text: false,
        }]
    } else {
        design.paint_layers.clone()
    };
    let separated = layers.into_iter().map(|layer| PaintLayer {
        regions: layer.regions.with_contacts_separated(),
        ..layer
    });
    Ok(separated.collect())
}
