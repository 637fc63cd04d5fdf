//! The [`Design`] type: its form (outline, mesh or truss), paint layers and import notes. Creates
//! designs from rings and pictures, transforms them, and computes the outline of the filled area.

use super::note::ImportNote;
use super::options::ImportOptions;
use super::paint_layer::PaintLayer;
use super::picture::Picture;
use super::silhouette;
use super::silhouette::{SilhouetteError, choose_tones};
use super::truss::Truss;
use super::unit::LengthUnit;
use crate::colour::Rgb;
use crate::geometry::{Bounds, DVec2, FillRule, Regions, RegionsError, Similarity};
use crate::mesh::TriangleMesh;
use image::RgbaImage;
use std::f64::consts::PI;

/// Number of chords for the half circle at either end of a truss bar (tolerance: the distance
/// between a chord and the half circle is at most 0.5 % of the radius).
const CAP_SIDES: u32 = 16;

/// One of the shapes to blend.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Design {
    /// Display name: by default the file's name without its extension.
    pub name: String,
    /// Geometry, y up.
    pub form: DesignForm,
    /// Rectangle of the picture, of the SVG page or of the line of text; for all other sources, the
    /// bounding box of the geometry. Pictures and pages have their lower left corner at the origin.
    pub extent: Bounds,
    /// Whether `extent` is a picture or a page, whose size says nothing about the size of what it
    /// shows.
    pub has_page: bool,
    /// Original pixels, if the design was imported from a picture.
    pub picture: Option<Picture>,
    /// Regions with their own colours or names, lowest layer first; empty if the file specifies
    /// neither.
    pub paint_layers: Vec<PaintLayer>,
    /// Colour in which other programs show the drawing although its file names none, such as the
    /// black of an icon; `None` if the file names colours or has none at all.
    pub drawn_colour: Option<Rgb>,
    /// Repairs and omissions made during the import.
    pub notes: Vec<ImportNote>,
    /// Unit of the coordinates, if the file declares one.
    pub unit: Option<LengthUnit>,
}

/// Geometry of a design.
#[derive(Clone, Debug, PartialEq)]
pub enum DesignForm {
    /// Filled regions with holes.
    Outline(Regions),
    /// Triangle mesh. Vertices with the same number in two meshes correspond to each other.
    Mesh(TriangleMesh),
    /// Nodes joined by bars.
    Truss(Truss),
}

impl Design {
    /// Creates a design from its geometry. The extent is the bounding box of the geometry.
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
            has_page: false,
            form,
            picture: None,
            paint_layers: Vec::new(),
            drawn_colour: None,
            notes: Vec::new(),
            unit: None,
        }
    }

    /// Creates a design from closed rings of points.
    ///
    /// The even-odd rule decides what is inside, so nested rings are holes regardless
    /// of their orientation. Repairs are reported in the notes.
    ///
    /// # Errors
    /// [`RegionsError`] if a coordinate is not finite or nothing is enclosed.
    ///
    /// ```
    /// use morphospace::design::Design;
    /// let kite = Design::from_rings("kite", [[(0.0, 0.0), (2.0, 1.0), (3.0, 3.0), (1.0, 2.0)]])?;
    /// assert!((kite.outline(0.0)?.area() - 3.0).abs() < 1e-9);
    /// # Ok::<(), morphospace::geometry::RegionsError>(())
    /// ```
    pub fn from_rings<R, P>(
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
            notes: ImportNote::from_repairs(&repairs, rule),
            ..Self::new(name, regions)
        })
    }

    /// Creates a design from the silhouette in a picture and keeps the picture.
    ///
    /// Pixels are sRGB with straight alpha, row 0 at the top; one pixel is one unit.
    /// The outline is traced at full resolution. Colours of a picture with more than 16
    /// million pixels are stored at half the resolution or less, and a note reports it.
    ///
    /// # Errors
    /// [`SilhouetteError`] if an option is out of range or no figure can be separated from
    /// the background.
    pub fn from_picture(
        name: impl Into<String>,
        pixels: RgbaImage,
        options: &ImportOptions,
    ) -> Result<Self, SilhouetteError> {
        options.check()?;
        let layers = match options.colours {
            true => silhouette::flat_colours::flat_colour_layers(&pixels, options)?,
            false => Vec::new(),
        };
        let is_shaded = options.colours && layers.is_empty();
        // Extract the opacities or grey levels now, so that the full-size pixels are freed before
        // tracing allocates its own memory.
        let outline_or_tones = match covered_area(&layers) {
            Some(regions) => Ok(regions),
            None => Err(choose_tones(&pixels, options)?),
        };
        let alternatives = match &outline_or_tones {
            Ok(_) => None,
            Err(chosen) => chosen.alternatives,
        };
        let given = pixels.dimensions();
        let picture = Picture::downscaled(pixels);
        let regions = outline_or_tones.or_else(|chosen| chosen.tones.regions(options))?;
        let kept = picture.pixels().dimensions();
        let smaller = (kept != given).then_some(ImportNote::ReducedPicture { given, kept });
        Ok(Self {
            extent: picture.bounds(),
            has_page: true,
            picture: Some(picture),
            notes: (smaller.into_iter())
                .chain(is_shaded.then_some(ImportNote::NoFlatColours))
                .chain(alternatives.map(|[used, other]| ImportNote::Reading { used, other }))
                .collect(),
            paint_layers: layers,
            ..Self::new(name, regions)
        })
    }

    /// Returns the design transformed by a similarity. The new extent is the bounding box of the
    /// transformed corners of the old extent. A scaled design has no unit.
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
            has_page: self.has_page,
            picture: self.picture.as_ref().map(|picture| picture.transformed(by)),
            drawn_colour: self.drawn_colour,
            paint_layers: self
                .paint_layers
                .iter()
                .map(|layer| layer.transformed(by))
                .collect(),
            notes: self.notes.clone(),
            unit: self.unit.filter(|_| by.scale == 1.0),
        }
    }

    /// Returns whether the file specifies colours: whether any paint layer has a fill or a line.
    #[must_use]
    pub fn is_painted(&self) -> bool {
        let is_painted = |layer: &PaintLayer| layer.paint.is_some() || layer.line.is_some();
        self.paint_layers.iter().any(is_painted)
    }

    /// Returns the regions of all paint layers, lowest layer first; `None` if there are no layers.
    ///
    /// These regions are matched when designs are shown in their own colours.
    #[must_use]
    pub fn painted_pieces(&self) -> Option<Regions> {
        Regions::stacked(self.paint_layers.iter().map(|layer| layer.regions.clone()))
    }

    /// Returns the filled area: an outline itself, the union of a mesh's triangles, or a
    /// truss with its bars drawn `bar_width` wide and rounded at the nodes.
    ///
    /// `bar_width` is in the design's units; only trusses use it.
    ///
    /// # Errors
    /// [`RegionsError`] if the area is empty, for example with bars of zero width.
    pub fn outline(&self, bar_width: f64) -> Result<Regions, RegionsError> {
        match &self.form {
            DesignForm::Outline(regions) => Ok(regions.clone()),
            DesignForm::Mesh(mesh) => mesh_outline(mesh),
            DesignForm::Truss(truss) => truss_outline(truss, bar_width),
        }
    }
}

impl DesignForm {
    /// Returns the bounding box of the geometry.
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

/// Returns the area inside the boundary loops of a mesh; overlaps are united.
fn mesh_outline(mesh: &TriangleMesh) -> Result<Regions, RegionsError> {
    let position = |&v: &u32| mesh.positions()[v as usize];
    let rings: Vec<Vec<DVec2>> = mesh
        .boundary_loops()
        .iter()
        .map(|boundary| boundary.iter().map(position).collect())
        .collect();
    Regions::from_rings(&rings, FillRule::NonZero)
}

/// Returns the union of the bars of a truss, drawn `bar_width` wide with round ends.
fn truss_outline(truss: &Truss, bar_width: f64) -> Result<Regions, RegionsError> {
    if !(bar_width.is_finite() && bar_width > 0.0) {
        return Err(RegionsError::Empty);
    }
    let capsules: Vec<Vec<DVec2>> = truss
        .segments()
        .map(|[a, b]| capsule(a, b, 0.5 * bar_width))
        .collect();
    union_of(&capsules)
}

/// Maximum number of shapes united in one operation (resource limit: if hundreds of bars that cross
/// in the same points are united in a single operation, this takes gigabytes).
const UNION_BATCH: usize = 16;

/// Returns the union of the rings. Large sets are halved recursively: each half is united
/// separately, which removes its inner edges before the two halves are united.
fn union_of(rings: &[Vec<DVec2>]) -> Result<Regions, RegionsError> {
    if rings.len() <= UNION_BATCH {
        return Regions::from_rings(rings, FillRule::NonZero);
    }
    let (first, second) = rings.split_at(rings.len() / 2);
    let (first, second) = rayon::join(|| union_of(first), || union_of(second));
    let (first, second) = (first?, second?);
    let both = first.rings().chain(second.rings());
    let both: Vec<Vec<DVec2>> = both.map(|ring| ring.points().to_vec()).collect();
    Regions::from_rings(&both, FillRule::NonZero)
}

/// Returns the outline of all points within `radius` of the line segment from `a` to `b`,
/// counter-clockwise.
fn capsule(a: DVec2, b: DVec2, radius: f64) -> Vec<DVec2> {
    // The direction is defined: a truss rejects bars of zero length.
    let along = (b - a).to_angle();
    let cap = move |centre: DVec2, from: f64| {
        (0..=CAP_SIDES).map(move |k| {
            centre + radius * DVec2::from_angle(from + PI * f64::from(k) / f64::from(CAP_SIDES))
        })
    };
    // Two half circles; the edges that join them are the straight sides.
    cap(b, along - 0.5 * PI)
        .chain(cap(a, along + 0.5 * PI))
        .collect()
}

/// Result of an importer of outlines: a design that has no name yet.
pub(super) struct ImportedOutlines {
    /// Union of all shapes.
    pub(super) regions: Regions,
    /// Rectangle of the page, or bounding box of the regions if the file has no page.
    pub(super) extent: Bounds,
    /// Regions with colours or names, lowest layer first; empty if the file specifies neither.
    pub(super) paint_layers: Vec<PaintLayer>,
    /// Colour of a drawing that names none; see [`Design::drawn_colour`].
    pub(super) drawn_colour: Option<Rgb>,
    /// Repairs and omissions made during the import.
    pub(super) notes: Vec<ImportNote>,
}

impl ImportedOutlines {
    /// Turns the import result into a design with the given name.
    pub(super) fn into_design(self, name: String) -> Design {
        Design {
            extent: self.extent,
            paint_layers: self.paint_layers,
            drawn_colour: self.drawn_colour,
            notes: self.notes,
            ..Design::new(name, self.regions)
        }
    }
}

/// Returns the union of all paint layers, or `None` if there are none.
fn covered_area(layers: &[PaintLayer]) -> Option<Regions> {
    let rings = layers.iter().flat_map(|layer| layer.regions.rings());
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
        let regions = truss_outline(&truss, 0.2).expect("area");
        assert_eq!(regions.len(), 1);
        assert_eq!(regions.rings().count(), 2);
        // Let r = 0.1 be half the bar width. The triangle of the nodes has area 6, perimeter 12 and
        // inradius 1. The outer outline encloses 6 + 12 r + π r²; the hole is a similar triangle
        // with the inradius 1 − r.
        let expected = 6.0 + 12.0 * 0.1 + PI * 0.01 - 6.0 * 0.9 * 0.9;
        assert!(
            (regions.area() - expected).abs() < 1e-3,
            "{}",
            regions.area()
        );
    }

    #[test]
    fn bars_that_cross_in_the_same_points_are_united() {
        // The bars join all pairs of corners of a regular polygon and leave only small gaps.
        let count = 40_u32;
        let node = |k: u32| DVec2::from_angle(2.0 * PI * f64::from(k) / f64::from(count));
        let bars = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let truss = Truss::new((0..count).map(node).collect(), bars.collect()).expect("valid");
        let regions = truss_outline(&truss, 0.01).expect("area");
        assert_eq!(regions.len(), 1);
        let disc = PI * 1.005_f64.powi(2);
        assert!(
            (0.8 * disc..disc).contains(&regions.area()),
            "{}",
            regions.area()
        );
    }

    #[test]
    fn batched_union_of_many_bars_is_exact() {
        // A square grid with so many bars that they are united in more than two batches.
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
        assert!(bars.len() > 2 * UNION_BATCH);
        let truss = Truss::new(places.collect(), bars).expect("valid");
        let regions = truss_outline(&truss, 0.2).expect("area");
        assert_eq!((regions.len(), regions.rings().count()), (1, 1 + 11 * 11));
        // Area of the outer square with rounded corners; the 121 holes of side 0.8 are subtracted
        // below.
        let whole = 11.0 * 11.0 + 4.0 * 11.0 * 0.1 + PI * 0.01;
        let area = regions.area();
        assert!((area - (whole - 121.0 * 0.64)).abs() < 1e-3, "{area}");
    }

    #[test]
    fn bars_without_width_enclose_nothing() {
        let truss = Truss::new(vec![DVec2::ZERO, DVec2::X], vec![[0, 1]]).expect("valid");
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(truss_outline(&truss, width), Err(RegionsError::Empty));
        }
    }

    #[test]
    fn a_mesh_outline_ignores_inner_edges_and_face_orientation() {
        let square = vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        for faces in [[[0, 1, 2], [0, 2, 3]], [[0, 2, 1], [0, 3, 2]]] {
            let mesh = TriangleMesh::new(square.clone(), faces.to_vec()).expect("valid");
            let regions = mesh_outline(&mesh).expect("area");
            assert_eq!(regions.rings().count(), 1);
            assert!((regions.area() - 1.0).abs() < 1e-9);
        }
    }
}
