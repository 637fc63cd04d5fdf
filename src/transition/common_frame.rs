//! How unlike designs are laid into one frame.

use crate::design::{Design, DesignForm};
use crate::geometry::{Bounds, DVec2, Similarity, SimilarityError, twice_signed_area};
use crate::settings::choice::named;
use std::sync::Arc;

/// How the other designs are fitted to the first, before each design's own
/// placement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DesignFit {
    /// Coordinates as they stand in the files; photographs, which have none,
    /// middle on middle.
    #[default]
    AsDrawn,
    /// The middles of both boxes meet.
    Centred,
    /// As centred, and scaled to the first design's area; for a truss
    /// to its size.
    SameArea,
}

named! { DesignFit {
    AsDrawn: "as-drawn", "As drawn", "Where the files have them";
    Centred: "centred", "Centred", "Centre on centre, sizes as drawn";
    SameArea: "same-area", "Same area", "Centre on centre, scaled to one area";
} }

/// A design laid into the frame of another: fitted to that one, then placed about its
/// own middle. The design that others are fitted to is laid into its own.
///
/// # Errors
/// A placement that is not a similarity, or that leads out of range.
pub fn place_in_frame(
    design: &Arc<Design>,
    (first, fit): (&Design, DesignFit),
    place: Similarity,
) -> Result<Arc<Design>, SimilarityError> {
    let by = frame_similarity(design, (first, fit), place)?;
    by.check_on(&extent(design))?;
    Ok(laid(design, by))
}

/// What lays a design into the frame of another: [`place_in_frame`] applies it.
///
/// # Errors
/// A placement that is not a similarity.
pub fn frame_similarity(
    design: &Design,
    (first, fit): (&Design, DesignFit),
    place: Similarity,
) -> Result<Similarity, SimilarityError> {
    // By the form's box: pictures have margins that nobody means.
    let to_middle = middle(first) - middle(design);
    let fitted = match fit {
        DesignFit::AsDrawn => Similarity {
            offset: photographs([first, design])
                .map_or(DVec2::ZERO, |[a, b]| a.centre() - b.centre()),
            ..Similarity::IDENTITY
        },
        DesignFit::Centred => Similarity {
            offset: to_middle,
            ..Similarity::IDENTITY
        },
        DesignFit::SameArea => scaled_to(first, design)?,
    };
    let centre = fitted.apply(middle(design));
    let place = about(centre, place.checked()?);
    if fitted == Similarity::IDENTITY {
        return Ok(place); // the first design keeps its last bit
    }
    Ok(place.after(&fitted))
}

/// The boxes of two photographs. They are drawn nowhere: that their lower left
/// corners lie on each other means nothing, and cuts them on the other sides.
fn photographs(designs: [&Design; 2]) -> Option<[Bounds; 2]> {
    let [a, b] = designs.map(|design| {
        let picture = design.picture.as_ref();
        picture.filter(|picture| picture.is_photograph())
    });
    Some([a?.bounds(), b?.bounds()])
}

fn scaled_to(first: &Design, design: &Design) -> Result<Similarity, SimilarityError> {
    let scale = (size(first) / size(design)).sqrt();
    Similarity {
        scale,
        offset: middle(first) - middle(design) * scale,
        ..Similarity::IDENTITY
    }
    .checked()
}

/// The placement with `centre` in the role of the origin.
fn about(centre: DVec2, placement: Similarity) -> Similarity {
    if placement == Similarity::IDENTITY {
        return placement; // designs as drawn keep their last bit
    }
    Similarity {
        offset: placement.offset + centre - placement.linear() * centre,
        ..placement
    }
}

fn laid(design: &Arc<Design>, by: Similarity) -> Arc<Design> {
    if by == Similarity::IDENTITY {
        Arc::clone(design)
    } else {
        Arc::new(design.transformed(&by))
    }
}

/// The box around the form itself, not around its picture.
pub(super) fn extent(design: &Design) -> Bounds {
    match &design.form {
        DesignForm::Outline(regions) => regions.bounds(),
        DesignForm::Mesh(mesh) => mesh.bounds(),
        DesignForm::Truss(truss) => truss.bounds(),
    }
}

fn middle(design: &Design) -> DVec2 {
    extent(design).centre()
}

/// Area, or for a truss the square of its diameter.
fn size(design: &Design) -> f64 {
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
