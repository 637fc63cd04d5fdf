//! What a transition is built from.

use super::cached_match;
use super::cached_match::CachedMatch;
use super::common_frame::extent;
use super::drawing_pair::DrawingPair;
use super::error::BuildError;
use super::method::TransitionMethod;
use super::options::{BuildQuality, PaintRule, TransitionOptions};
use crate::content::ContentKind;
use crate::design::{Design, DesignForm, Format, PaintLayer, Picture};
use crate::geometry::{Regions, RegionsError};
use crate::work::budget::WorkloadKind;
use crate::work::progress::{Progress, beside, checkpoint};
use std::sync::Arc;

/// Everything a transition is built from: two designs laid into one frame, a
/// cell of the table and the options of all methods.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct TransitionSpec {
    /// The design at t = 0.
    pub source: Arc<Design>,
    /// The design at t = 1.
    pub target: Arc<Design>,
    /// Warp and content.
    pub cell: TransitionMethod,
    /// The options of all methods; places of the match are in the common
    /// frame.
    pub options: TransitionOptions,
    /// Whether what takes very long is begun all the same; see
    /// [`crate::work::budget`].
    pub patient: bool,
    /// What was found before, taken where it was found for this.
    pub found: CachedMatch,
    /// The other designs of a sequence, laid into the same frame: all its fields lie on
    /// one grid, and all its bars have one width.
    pub others: Vec<Arc<Design>>,
}

impl TransitionSpec {
    /// Two designs by the method that suits them best, with default options.
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
            cell,
            options: TransitionOptions::default(),
            patient: false,
            found: CachedMatch::default(),
            others: Vec::new(),
        }
    }

    /// The same as a draft, which is there sooner; `None` where nothing is
    /// tried for a better one, or the best was found before.
    #[must_use]
    pub fn draft(&self, progress: &dyn Progress) -> Option<Self> {
        let are_given = matches!(
            (&self.source.form, &self.target.form),
            (DesignForm::Mesh(_), DesignForm::Mesh(_))
                | (DesignForm::Truss(_), DesignForm::Truss(_))
        );
        let is_tried = self.cell == TransitionMethod::RIGID_PARTS && !are_given;
        let is_asked = is_tried && self.options.quality != BuildQuality::Draft;
        (is_asked && !self.is_found(progress)).then(|| {
            let mut draft = self.clone();
            draft.options.quality = BuildQuality::Draft;
            draft
        })
    }

    /// All designs that lie in the frame.
    pub(super) fn all(&self) -> impl Iterator<Item = &Arc<Design>> {
        [&self.source, &self.target].into_iter().chain(&self.others)
    }

    /// Whether what was found before was found for this.
    fn is_found(&self, progress: &dyn Progress) -> bool {
        // Outlines are looked at only where there is something to gain.
        if self.found.is_none() {
            return false;
        }
        let drawings = bar_width(self).and_then(|width| self.drawings(width, progress));
        let key = drawings.map(|drawings| cached_match::cache_key(&self.options, &drawings));
        key.is_ok_and(|key| self.found.is_for(&key))
    }

    /// The outlines of both designs; bars are so wide, in units of the designs.
    pub(super) fn outlines(
        &self,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<[Regions; 2], BuildError> {
        let outlines = [
            outline(&self.source, bar_width, progress)?,
            outline(&self.target, bar_width, progress)?,
        ];
        self.allow(&outlines, progress)?;
        // What is drawn well may be no piece to a triangulation.
        Ok(outlines.map(|outline| outline.pulled_apart()))
    }

    /// Both designs as they are matched for rigid parts; bars are so wide, in
    /// units of the designs.
    pub(super) fn drawings(
        &self,
        bar_width: f64,
        progress: &dyn Progress,
    ) -> Result<DrawingPair, BuildError> {
        let designs = [&self.source, &self.target];
        let is_painted = designs.iter().any(|design| !design.coats.is_empty());
        if self.options.paint == PaintRule::One || !is_painted {
            return Ok(DrawingPair::plain(self.outlines(bar_width, progress)?));
        }
        let [source, target] = designs.map(|design| coats_of(design, bar_width, progress));
        let drawings = DrawingPair::of([source?, target?]).ok_or(RegionsError::Empty)?;
        self.allow(&drawings.outlines, progress)?;
        Ok(drawings)
    }

    /// Whether outlines are not too much.
    pub(super) fn allow(
        &self,
        outlines: &[Regions; 2],
        progress: &dyn Progress,
    ) -> Result<(), BuildError> {
        let pieces = outlines.iter().map(|regions| regions.len()).sum();
        let rings = outlines.iter().flat_map(Regions::rings);
        let sizes: Vec<usize> = rings.map(|ring| ring.points().len()).collect();
        WorkloadKind::Pieces.allow(pieces, progress)?;
        WorkloadKind::Holes.allow(sizes.len() - pieces, progress)?;
        Ok(WorkloadKind::Points.allow(sizes.iter().sum(), progress)?)
    }

    /// Whether designs of these kinds can be interpolated by `cell`, without
    /// trying.
    ///
    /// # Errors
    /// [`BuildError::Unavailable`] with the reason, for a greyed button.
    pub fn available(
        cell: TransitionMethod,
        source: &Design,
        target: &Design,
    ) -> Result<(), BuildError> {
        // Every form has an outline; not every one came as a picture.
        if cell.content() != ContentKind::Colours {
            return Ok(());
        }
        match [source, target].iter().find(|d| d.picture.is_none()) {
            None => Ok(()),
            Some(design) => Err(BuildError::Unavailable(format!(
                "{} has no colours: open two pictures ({}), or choose fields or solids",
                design.name,
                Format::listed(Format::PICTURES)
            ))),
        }
    }
}

/// The width of bars, in units of the designs.
pub(crate) fn bar_width(spec: &TransitionSpec) -> Result<f64, BuildError> {
    let share = spec.options.bar_width;
    if !(share > 0.0 && share <= 1.0) {
        return Err(BuildError::BarWidth(share));
    }
    let diameters = spec.all().map(|design| extent(design).diameter());
    Ok(share * diameters.fold(0.0, f64::max))
}

/// The outline of a design. Uniting bars or faces is a long call of a library,
/// beside which a cancel is answered.
pub(crate) fn outline(
    design: &Arc<Design>,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Regions, BuildError> {
    if matches!(design.form, DesignForm::Outline(_)) {
        return Ok(design.outline(bar_width)?);
    }
    if let DesignForm::Truss(truss) = &design.form {
        WorkloadKind::Bars.allow(truss.bars().len(), progress)?;
    }
    checkpoint(progress, "uniting", 0.0)?;
    let design = Arc::clone(design);
    Ok(beside(progress, move || design.outline(bar_width))??)
}

/// The coats of a design; one without paint where it has none.
fn coats_of(
    design: &Arc<Design>,
    bar_width: f64,
    progress: &dyn Progress,
) -> Result<Vec<PaintLayer>, BuildError> {
    let coats = if design.coats.is_empty() {
        vec![PaintLayer {
            regions: outline(design, bar_width, progress)?,
            paint: None,
            gradient: None,
            line: None,
            name: String::new(),
            is_text: false,
        }]
    } else {
        design.coats.clone()
    };
    let apart = coats.into_iter().map(|coat| PaintLayer {
        regions: coat.regions.pulled_apart(),
        ..coat
    });
    Ok(apart.collect())
}
