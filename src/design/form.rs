//! A design: what it consists of, what area that fills, and how it is made
//! without a file.

use super::note::ImportNote;
use super::options::ImportOptions;
use super::paint_layer::PaintLayer;
use super::picture::Picture;
use super::silhouette;
use super::silhouette::{PictureTones, SilhouetteError};
use super::truss::Truss;
use crate::geometry::{Bounds, DVec2, FillRule, Regions, RegionsError, Similarity};
use crate::mesh::TriangleMesh;
use image::RgbaImage;
use std::f64::consts::PI;

/// Sides of the half circle at either end of a bar. A chord of 1/16 of a half
/// circle stays within 0.5 % of the radius.
const CAP_SIDES: u32 = 16;

/// One of the given forms.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Design {
    /// What people call it: the file's name without its ending.
    pub name: String,
    /// The form itself, y up.
    pub form: DesignForm,
    /// The rectangle of the picture or the page, its lower left corner at the
    /// origin, or the box around a mesh, a truss or an element of a drawing.
    pub extent: Bounds,
    /// The picture that it came as, if it did.
    pub picture: Option<Picture>,
    /// What it shows in its own paint, the lowest first; none where it has none.
    pub coats: Vec<PaintLayer>,
    /// What was repaired or left out while it was read.
    pub notes: Vec<ImportNote>,
}

/// What a design consists of.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignForm {
    /// Filled regions with holes.
    Outline(Regions),
    /// Triangles that carry a correspondence.
    Mesh(TriangleMesh),
    /// Nodes joined by bars.
    Truss(Truss),
}

impl Design {
    /// A design of a form; the extent is the box around it.
    ///
    /// ```
    /// use morphospace::{design::Design, geometry::DVec2, mesh::TriangleMesh};
    /// let mesh = TriangleMesh::new(vec![DVec2::ZERO, DVec2::X, DVec2::Y], vec![[0, 1, 2]])?;
    /// let design = Design::new("triangle", mesh);
    /// assert_eq!(design.extent.max, DVec2::ONE);
    /// # Ok::<(), morphospace::mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn new(name: impl Into<String>, form: impl Into<DesignForm>) -> Self {
        let form = form.into();
        Self {
            name: name.into(),
            extent: form.bounds(),
            form,
            picture: None,
            coats: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// What lies within rings of points by the even-odd rule, so that rings in
    /// rings are holes whichever way they run. What had to be repaired stands
    /// in the notes.
    ///
    /// # Errors
    /// [`RegionsError`] if a coordinate is not finite or nothing is enclosed.
    ///
    /// ```
    /// use morphospace::design::Design;
    /// let kite = Design::of_rings("kite", [[(0.0, 0.0), (2.0, 1.0), (3.0, 3.0), (1.0, 2.0)]])?;
    /// assert!((kite.outline(0.0)?.area() - 3.0).abs() < 1e-9);
    /// # Ok::<(), morphospace::geometry::RegionsError>(())
    /// ```
    pub fn of_rings<R, P>(
        name: impl Into<String>,
        rings: impl IntoIterator<Item = R>,
    ) -> Result<Self, RegionsError>
    where
        R: IntoIterator<Item = P>,
        P: Into<DVec2>,
    {
        let points = |ring: R| ring.into_iter().map(Into::into).collect();
        let rings: Vec<Vec<DVec2>> = rings.into_iter().map(points).collect();
        let rule = FillRule::EvenOdd;
        let (regions, repairs) = Regions::from_rings_reporting(&rings, rule)?;
        Ok(Self {
            notes: ImportNote::of_repairs(&repairs, rule),
            ..Self::new(name, regions)
        })
    }

    /// The silhouette in a picture, and the picture with it. Pixels are sRGB
    /// with straight alpha, row 0 the uppermost; one is a unit of the design.
    /// The outline is that of all pixels; of the colours of more than 16
    /// million every fourth is kept, or fewer, and that is told.
    ///
    /// # Errors
    /// [`SilhouetteError`] if an option is out of range or no figure stands out.
    pub fn of_picture(
        name: impl Into<String>,
        pixels: RgbaImage,
        options: &ImportOptions,
    ) -> Result<Self, SilhouetteError> {
        options.check()?;
        let coats = match options.colours {
            true => silhouette::flat_colours::flat_colour_layers(&pixels, options)?,
            false => Vec::new(),
        };
        let is_shaded = options.colours && coats.is_empty();
        // The colours make room before the boundary is looked for.
        let seen = match covered(&coats) {
            Some(regions) => Ok(regions),
            None => Err(PictureTones::of(&pixels, options)?),
        };
        let given = pixels.dimensions();
        let picture = Picture::bounded(pixels);
        let regions = seen.or_else(|tones| tones.regions(options))?;
        let kept = picture.pixels().dimensions();
        let smaller = (kept != given).then_some(ImportNote::Smaller { given, kept });
        Ok(Self {
            extent: picture.bounds(),
            picture: Some(picture),
            notes: (smaller.into_iter())
                .chain(is_shaded.then_some(ImportNote::Shaded))
                .collect(),
            coats,
            ..Self::new(name, regions)
        })
    }

    /// The design laid down by a similarity; the extent becomes the box
    /// around its moved corners.
    #[must_use]
    pub fn transformed(&self, by: &Similarity) -> Self {
        let corners = self.extent.corners().map(|p| by.apply(p));
        Self {
            name: self.name.clone(),
            form: match &self.form {
                DesignForm::Outline(regions) => DesignForm::Outline(regions.transformed(by)),
                DesignForm::Mesh(mesh) => DesignForm::Mesh(mesh.transformed(by)),
                DesignForm::Truss(truss) => DesignForm::Truss(truss.transformed(by)),
            },
            extent: Bounds::of(corners).unwrap_or(self.extent),
            picture: self.picture.as_ref().map(|picture| picture.transformed(by)),
            coats: self.coats.iter().map(|coat| coat.transformed(by)).collect(),
            notes: self.notes.clone(),
        }
    }

    /// All pieces of its coats, the lowest first: what is matched where it is shown in its own
    /// paint. None where it has none.
    #[must_use]
    pub fn painted_pieces(&self) -> Option<Regions> {
        Regions::stacked(self.coats.iter().map(|coat| coat.regions.clone()))
    }

    /// The filled area of the form: an outline itself, a mesh without its
    /// inner edges, a truss with its bars drawn `bar_width` wide and round at
    /// the nodes. `bar_width` is in the design's units and matters to trusses
    /// only.
    ///
    /// # Errors
    /// [`RegionsError`] if no area is left, such as bars of no width.
    pub fn outline(&self, bar_width: f64) -> Result<Regions, RegionsError> {
        match &self.form {
            DesignForm::Outline(regions) => Ok(regions.clone()),
            DesignForm::Mesh(mesh) => of_mesh(mesh),
            DesignForm::Truss(truss) => of_truss(truss, bar_width),
        }
    }
}

impl DesignForm {
    /// The smallest box around it.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        match self {
            Self::Outline(regions) => regions.bounds(),
            Self::Mesh(mesh) => mesh.bounds(),
            Self::Truss(truss) => truss.bounds(),
        }
    }
}

impl From<Regions> for DesignForm {
    fn from(regions: Regions) -> Self {
        Self::Outline(regions)
    }
}

impl From<TriangleMesh> for DesignForm {
    fn from(mesh: TriangleMesh) -> Self {
        Self::Mesh(mesh)
    }
}

impl From<Truss> for DesignForm {
    fn from(truss: Truss) -> Self {
        Self::Truss(truss)
    }
}

/// The boundary loops of the mesh, overlaps united.
fn of_mesh(mesh: &TriangleMesh) -> Result<Regions, RegionsError> {
    let at = |&v: &u32| mesh.positions()[v as usize];
    let rings: Vec<Vec<DVec2>> = mesh
        .boundary_loops()
        .iter()
        .map(|walk| walk.iter().map(at).collect())
        .collect();
    Regions::from_rings(&rings, FillRule::NonZero)
}

/// The bars as strokes with round ends, united.
fn of_truss(truss: &Truss, bar_width: f64) -> Result<Regions, RegionsError> {
    if !(bar_width.is_finite() && bar_width > 0.0) {
        return Err(RegionsError::Empty);
    }
    let capsules: Vec<Vec<DVec2>> = truss
        .segments()
        .map(|[a, b]| capsule(a, b, 0.5 * bar_width))
        .collect();
    united(&capsules)
}

/// Shapes that are united at once. The 780 bars between 40 nodes of a circle,
/// which meet in the same points again and again, took 2 GB and more than 35 s
/// by 128, and 0.4 s by 16.
const AT_ONCE: usize = 16;

/// What lies in any of the rings. Many are united in halves: what is inside a
/// half is gone before it meets the other one.
fn united(rings: &[Vec<DVec2>]) -> Result<Regions, RegionsError> {
    if rings.len() <= AT_ONCE {
        return Regions::from_rings(rings, FillRule::NonZero);
    }
    let (near, far) = rings.split_at(rings.len() / 2);
    let (near, far) = rayon::join(|| united(near), || united(far));
    let (near, far) = (near?, far?);
    let both = near.rings().chain(far.rings());
    let both: Vec<Vec<DVec2>> = both.map(|ring| ring.points().to_vec()).collect();
    Regions::from_rings(&both, FillRule::NonZero)
}

/// All points within `radius` of the segment, counter-clockwise.
fn capsule(a: DVec2, b: DVec2, radius: f64) -> Vec<DVec2> {
    // Bars have a length: a truss is checked for it.
    let along = (b - a).to_angle();
    let cap = move |centre: DVec2, from: f64| {
        (0..=CAP_SIDES).map(move |k| {
            centre + radius * DVec2::from_angle(from + PI * f64::from(k) / f64::from(CAP_SIDES))
        })
    };
    // Two half circles; the straight sides are what lies between them.
    cap(b, along - 0.5 * PI)
        .chain(cap(a, along + 0.5 * PI))
        .collect()
}

/// Outlines as a reader gives them: a design without a name.
pub(super) struct ImportedOutlines {
    pub(super) regions: Regions,
    pub(super) extent: Bounds,
    pub(super) coats: Vec<PaintLayer>,
    pub(super) notes: Vec<ImportNote>,
}

impl ImportedOutlines {
    pub(super) fn named(self, name: String) -> Design {
        Design {
            extent: self.extent,
            coats: self.coats,
            notes: self.notes,
            ..Design::new(name, self.regions)
        }
    }
}

/// What all coats cover together; none where there are none.
fn covered(coats: &[PaintLayer]) -> Option<Regions> {
    let rings = coats.iter().flat_map(|coat| coat.regions.rings());
    let rings: Vec<Vec<DVec2>> = rings.map(|ring| ring.points().to_vec()).collect();
    Regions::from_rings(&rings, FillRule::NonZero).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thick_triangle_has_a_hole() {
        let nodes = vec![DVec2::ZERO, DVec2::new(4.0, 0.0), DVec2::new(0.0, 3.0)];
        let truss = Truss::new(nodes, vec![[0, 1], [1, 2], [2, 0]]).expect("valid");
        let regions = of_truss(&truss, 0.2).expect("area");
        assert_eq!(regions.len(), 1);
        assert_eq!(regions.rings().count(), 2);
        // Outer offset: area + perimeter r + π r²; inner: similar, inradius 1 less r.
        let expected = 6.0 + 12.0 * 0.1 + PI * 0.01 - 6.0 * 0.9 * 0.9;
        assert!(
            (regions.area() - expected).abs() < 1e-3,
            "{}",
            regions.area()
        );
    }

    #[test]
    fn bars_that_meet_in_the_same_points_again_and_again_are_united() {
        // Each node of a regular polygon joined to each other: what is left are
        // the gaps between the bars. By 128 it took two gigabytes.
        let count = 40_u32;
        let node = |k: u32| DVec2::from_angle(2.0 * PI * f64::from(k) / f64::from(count));
        let bars = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let truss = Truss::new((0..count).map(node).collect(), bars.collect()).expect("valid");
        let regions = of_truss(&truss, 0.01).expect("area");
        assert_eq!(regions.len(), 1);
        let disc = PI * 1.005_f64.powi(2);
        assert!(
            (0.8 * disc..disc).contains(&regions.area()),
            "{}",
            regions.area()
        );
    }

    #[test]
    fn many_bars_are_united_as_few_are() {
        // A grid whose bars come row by row, in more than two batches.
        let count = 12_u32;
        let node = |i: u32, j: u32| i * count + j;
        let places =
            (0..count * count).map(|k| DVec2::new(f64::from(k % count), f64::from(k / count)));
        let mut bars = Vec::new();
        for i in 0..count {
            for j in 0..count - 1 {
                bars.extend([[node(i, j), node(i, j + 1)], [node(j, i), node(j + 1, i)]]);
            }
        }
        assert!(bars.len() > 2 * AT_ONCE);
        let truss = Truss::new(places.collect(), bars).expect("valid");
        let regions = of_truss(&truss, 0.2).expect("area");
        assert_eq!((regions.len(), regions.rings().count()), (1, 1 + 11 * 11));
        // All within 0.1 of a bar, less the squares between.
        let whole = 11.0 * 11.0 + 4.0 * 11.0 * 0.1 + PI * 0.01;
        let area = regions.area();
        assert!((area - (whole - 121.0 * 0.64)).abs() < 1e-3, "{area}");
    }

    #[test]
    fn bars_without_width_enclose_nothing() {
        let truss = Truss::new(vec![DVec2::ZERO, DVec2::X], vec![[0, 1]]).expect("valid");
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(of_truss(&truss, width), Err(RegionsError::Empty));
        }
    }

    #[test]
    fn a_mesh_outline_leaves_inner_edges_and_mirrored_faces_out() {
        let square = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        for faces in [[[0, 1, 2], [0, 2, 3]], [[0, 2, 1], [0, 3, 2]]] {
            let mesh = TriangleMesh::new(square.clone(), faces.to_vec()).expect("valid");
            let regions = of_mesh(&mesh).expect("area");
            assert_eq!(regions.rings().count(), 1);
            assert!((regions.area() - 1.0).abs() < 1e-9);
        }
    }
}
