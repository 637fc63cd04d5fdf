//! A design: what it consists of, and how it is made without a file.

use super::note::ImportNote;
use super::options::ImportOptions;
use super::outline;
use super::picture::Picture;
use super::silhouette::{self, PictureError};
use super::truss::Truss;
use crate::geometry::{Bounds, DVec2, FillRule, Regions, RegionsError, Similarity};
use crate::mesh::TriangleMesh;
use image::RgbaImage;

/// One of the given forms.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Design {
    /// What people call it: the file's name without its ending.
    pub name: String,
    /// The form itself, y up.
    pub form: Form,
    /// The rectangle of the picture or the page, its lower left corner at the
    /// origin, or the box around a mesh, a truss or an element of a drawing.
    pub extent: Bounds,
    /// The picture that it came as, if it did.
    pub picture: Option<Picture>,
    /// What was repaired or left out while it was read.
    pub notes: Vec<ImportNote>,
}

/// What a design consists of.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
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
    pub fn new(name: impl Into<String>, form: impl Into<Form>) -> Self {
        let form = form.into();
        Self {
            name: name.into(),
            extent: form.bounds(),
            form,
            picture: None,
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
    ///
    /// # Errors
    /// [`PictureError`] if an option is out of range or no figure stands out.
    pub fn of_picture(
        name: impl Into<String>,
        pixels: RgbaImage,
        options: &ImportOptions,
    ) -> Result<Self, PictureError> {
        options.check()?;
        let regions = silhouette::read(&pixels, options)?;
        let picture = Picture::new(pixels);
        Ok(Self {
            extent: picture.bounds(),
            picture: Some(picture),
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
                Form::Outline(regions) => Form::Outline(regions.transformed(by)),
                Form::Mesh(mesh) => Form::Mesh(mesh.transformed(by)),
                Form::Truss(truss) => Form::Truss(truss.transformed(by)),
            },
            extent: Bounds::of(corners).unwrap_or(self.extent),
            picture: self.picture.as_ref().map(|picture| picture.transformed(by)),
            notes: self.notes.clone(),
        }
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
            Form::Outline(regions) => Ok(regions.clone()),
            Form::Mesh(mesh) => outline::of_mesh(mesh),
            Form::Truss(truss) => outline::of_truss(truss, bar_width),
        }
    }
}

impl Form {
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

impl From<Regions> for Form {
    fn from(regions: Regions) -> Self {
        Self::Outline(regions)
    }
}

impl From<TriangleMesh> for Form {
    fn from(mesh: TriangleMesh) -> Self {
        Self::Mesh(mesh)
    }
}

impl From<Truss> for Form {
    fn from(truss: Truss) -> Self {
        Self::Truss(truss)
    }
}

/// Outlines as a reader gives them: a design without a name.
pub(super) struct Outlines {
    pub(super) regions: Regions,
    pub(super) extent: Bounds,
    pub(super) notes: Vec<ImportNote>,
}

impl Outlines {
    pub(super) fn named(self, name: String) -> Design {
        Design {
            extent: self.extent,
            notes: self.notes,
            ..Design::new(name, self.regions)
        }
    }
}
