//! Places designs in one common coordinate system, the common frame.

use crate::design::{Design, DesignForm};
use crate::geometry::{Bounds, DVec2, Similarity, SimilarityError, twice_signed_area};
use crate::io::sanitize::SanitizedLine;
use crate::settings::named;
use std::fmt;
use std::sync::Arc;

/// Alignment of designs with the first design, before each design's own placement is applied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DesignFit {
    /// As [`Self::AsDrawn`]; but a page whose longer side is more than four times as long or as
    /// short as that of the first design's page is scaled to fit into that page, with the same
    /// centre.
    #[default]
    Auto,
    /// Coordinates as in the files; the centres of photographs, which have no coordinates, are
    /// aligned.
    AsDrawn,
    /// The centres of the bounding boxes are aligned; sizes do not change.
    Centred,
    /// As [`Self::Centred`], and designs are scaled to the area of the first one. For a truss, the
    /// area is the square of its diameter.
    SameArea,
}

named! { DesignFit {
    Auto: "auto", "Auto", "Uses the coordinates in the files, and fits pages that differ by more than 4 times";
    AsDrawn: "as-drawn", "As drawn", "Uses the coordinates in the files";
    Centred: "centred", "Centred", "Aligns the centres and keeps the sizes";
    SameArea: "same-area", "Same area", "Aligns the centres and scales to equal area";
} }

/// Largest ratio of the longer sides of two pages that are used as drawn (derived: icon sets are
/// drawn on pages of 16 to 48 or of 256 to 1024 units, so pages of one set differ by less, and
/// those of different sets by more).
const MAX_PAGE_RATIO: f64 = 4.0;

/// A page that was scaled to fit into the page of the first design.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedPage {
    /// Name of the design.
    pub design: String,
    /// Width and height of its page.
    pub size: DVec2,
    /// Width and height of the first design's page.
    pub first_size: DVec2,
}

impl DesignFit {
    /// Returns whether the placement of any of these designs depends on the first one.
    #[must_use]
    pub fn depends_on_first(self, designs: &[Arc<Design>]) -> bool {
        match self {
            Self::Auto => designs
                .iter()
                .any(|design| self.fitted_page(design, &designs[0]).is_some()),
            Self::AsDrawn => false,
            Self::Centred | Self::SameArea => true,
        }
    }

    /// Returns the page of a design if this rule scales it to fit into the page of the first
    /// design, without being asked for it.
    #[must_use]
    pub fn fitted_page(self, design: &Design, first: &Design) -> Option<FittedPage> {
        if self != Self::Auto || !(design.has_page && first.has_page) {
            return None;
        }
        let [size, first_size] = [design, first].map(|design| design.extent.size());
        let ratio = size.max_element() / first_size.max_element();
        (ratio.max(ratio.recip()) > MAX_PAGE_RATIO).then(|| FittedPage {
            design: design.name.clone(),
            size,
            first_size,
        })
    }
}

impl FittedPage {
    /// Returns the similarity that scales the page of `design` to fit into that of `first`, with
    /// the same centre.
    fn similarity(&self, design: &Design, first: &Design) -> Similarity {
        let scale = (self.first_size / self.size).min_element();
        Similarity {
            scale,
            offset: first.extent.centre() - design.extent.centre() * scale,
            ..Similarity::IDENTITY
        }
    }
}

impl fmt::Display for FittedPage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the page of {}, {} × {}, was scaled to that of the first design, {} × {}; fit = {} keeps the coordinates of the files",
            SanitizedLine(&self.design),
            self.size.x,
            self.size.y,
            self.first_size.x,
            self.first_size.y,
            DesignFit::AsDrawn
        )
    }
}

/// Places a design in the coordinate system of the first one: fits the design to the first one,
/// then applies `place` about the design's centre. Also places the first design itself.
///
/// # Errors
/// If the placement is not a similarity, or moves the design out of the permitted range of
/// coordinates.
pub fn place_in_frame(
    design: &Arc<Design>,
    first: &Design,
    fit: DesignFit,
    place: Similarity,
) -> Result<Arc<Design>, SimilarityError> {
    let by = frame_similarity(design, first, fit, place)?;
    by.check_on(&extent(design))?;
    Ok(transformed(design, by))
}

/// Returns the similarity that places a design in the coordinate system of the first one;
/// [`place_in_frame`] applies it.
///
/// # Errors
/// If the placement is not a similarity.
pub fn frame_similarity(
    design: &Design,
    first: &Design,
    fit: DesignFit,
    place: Similarity,
) -> Result<Similarity, SimilarityError> {
    // The centre is that of the geometry, not that of the picture, whose margins are meaningless.
    let to_centre = form_centre(first) - form_centre(design);
    let fitted_page = fit.fitted_page(design, first);
    let fitted = match (fit, fitted_page) {
        (_, Some(page)) => page.similarity(design, first).checked()?,
        (DesignFit::Auto | DesignFit::AsDrawn, None) => Similarity {
            offset: photographs([first, design])
                .map_or(DVec2::ZERO, |[a, b]| a.centre() - b.centre()),
            ..Similarity::IDENTITY
        },
        (DesignFit::Centred, None) => Similarity {
            offset: to_centre,
            ..Similarity::IDENTITY
        },
        (DesignFit::SameArea, None) => similarity_to_size_of(first, design)?,
    };
    let centre = fitted.apply(form_centre(design));
    let place = centred_at(centre, place.checked()?);
    if fitted == Similarity::IDENTITY {
        return Ok(place); // no rounding for the first design
    }
    Ok(place.after(&fitted))
}

/// Returns the boxes of two designs if both are photographs. Photographs have no coordinates of
/// their own; if their lower left corners were aligned, they would be cropped only at the top and
/// on the right.
fn photographs(designs: [&Design; 2]) -> Option<[Bounds; 2]> {
    let [first, second] = designs.map(|design| {
        let picture = design.picture.as_ref();
        picture.filter(|picture| picture.is_photograph())
    });
    Some([first?.bounds(), second?.bounds()])
}

/// Returns the similarity that aligns the centres and scales `design` to the size of `first`.
fn similarity_to_size_of(first: &Design, design: &Design) -> Result<Similarity, SimilarityError> {
    let scale = (form_area(first) / form_area(design)).sqrt();
    Similarity {
        scale,
        offset: form_centre(first) - form_centre(design) * scale,
        ..Similarity::IDENTITY
    }
    .checked()
}

/// Returns the placement applied about `centre` instead of the origin.
fn centred_at(centre: DVec2, placement: Similarity) -> Similarity {
    if placement == Similarity::IDENTITY {
        return placement; // no rounding for designs as drawn
    }
    Similarity {
        offset: placement.offset + centre - placement.linear() * centre,
        ..placement
    }
}

/// Returns the transformed design, or the same shared design if `by` is the identity.
fn transformed(design: &Arc<Design>, by: Similarity) -> Arc<Design> {
    if by == Similarity::IDENTITY {
        Arc::clone(design)
    } else {
        Arc::new(design.transformed(&by))
    }
}

/// Returns the box around a design's geometry (outline, mesh or truss), not around its picture.
pub(super) fn extent(design: &Design) -> Bounds {
    match &design.form {
        DesignForm::Outline(regions) => regions.bounds(),
        DesignForm::Mesh(mesh) => mesh.bounds(),
        DesignForm::Truss(truss) => truss.bounds(),
    }
}

/// Returns the centre of the form's box.
fn form_centre(design: &Design) -> DVec2 {
    extent(design).centre()
}

/// Returns the area of a design; for a truss, the square of its diameter.
fn form_area(design: &Design) -> f64 {
    match &design.form {
        DesignForm::Outline(regions) => regions.area(),
        DesignForm::Mesh(mesh) => {
            let areas = mesh.faces().iter().map(|face| {
                let [a, b, c] = face.map(|v| mesh.positions()[v as usize]);
                0.5 * twice_signed_area(a, b, c).abs()
            });
            areas.sum()
        }
        DesignForm::Truss(truss) => truss.bounds().diameter().powi(2),
    }
}
