//! Converts DXF entities to curves and areas in the plane and to block references.

use super::band::WideBand;
use super::curve::{AreaLoops, DxfCurve, EllipseArc, positive_angle};
use super::error::EntityFault;
use super::hatch;
use super::pairs::GroupPair;
use super::polyline::{PolylineVertex, polyline_curves};
use super::record::DxfRecord;
use super::report::EntityRemark;
use super::spline;
use super::style::{EntityStyle, Inheritable, name_key};
use crate::design::note::DxfPlace;
use crate::geometry::{DVec2, FillRule};
use glam::{DAffine2, DMat2};
use std::f64::consts::TAU;
use std::rc::Rc;

/// Entity with its style.
#[derive(Debug)]
pub(super) struct DxfEntity {
    pub shape: EntityShape,
    pub style: EntityStyle,
    /// Omission or approximation to report if the entity is visible.
    pub remark: Option<Box<EntityRemark>>,
    /// Name of the font of a text that was replaced by the bundled font.
    pub font: Option<Rc<str>>,
    pub handle: Option<u64>,
}

/// Geometry of an entity: its own curves or area, or a reference to a block.
#[derive(Debug)]
pub(super) enum EntityShape {
    /// Nothing: the entity is left out.
    Nothing,
    /// Path of connected curves.
    Path {
        curves: Vec<DxfCurve>,
        is_closed: bool,
    },
    /// Filled area.
    Area(AreaLoops),
    /// Letters of a text.
    Letters(AreaLoops),
    /// Polyline with a width.
    Band(WideBand),
    /// Several shapes with the same style.
    Group(Vec<EntityShape>),
    /// Reference that places one or more copies of a block.
    Insert(BlockReference),
}

/// Reference to a block.
#[derive(Debug)]
pub(super) struct BlockReference {
    /// Type name of the entity that refers to the block.
    pub kind: String,
    /// Key of the name of the block.
    pub block: Vec<u8>,
    /// For each copy, the affine map from block coordinates to the coordinate system that contains
    /// the reference.
    pub places: Vec<DAffine2>,
    /// Whether the base point of the block is moved to the origin first.
    pub uses_base_point: bool,
    /// Position of the reference in the file.
    pub at: DxfPlace,
}

/// Treatment of an MLINE whose style may have caps or a fill.
pub(super) const MULTILINE_REMARK: &str = "drawn without caps and fill";

/// Maximum number of block copies that one INSERT makes (resource limit: a grid of 100 by 100;
/// checked before memory for the copies is allocated).
const MAX_COPIES: i64 = 10_000;

/// Supported entity, or the reason why an entity is left out.
pub(super) type ShapeOrReason = Result<EntityShape, &'static str>;

/// Returns why entities of a type that is not supported are left out. The types are those of the
/// DXF Reference; others are unknown.
fn reason_to_leave_out(kind: &[u8]) -> &'static str {
    match kind {
        b"3DSOLID" | b"BODY" | b"REGION" | b"SURFACE" | b"EXTRUDEDSURFACE" | b"LOFTEDSURFACE"
        | b"REVOLVEDSURFACE" | b"SWEPTSURFACE" | b"PLANESURFACE" | b"NURBSURFACE" => {
            "left out: its ACIS data is not read; explode or trace it"
        }
        b"MESH" => "left out: meshes in space have no plane outline; explode it",
        b"XLINE" | b"RAY" => "left out: it has no end; draw a line of finite length",
        b"POINT" => "left out: it has no area",
        b"WIPEOUT" => "left out: it hides nothing here; trim what it covers",
        b"IMAGE" | b"OLEFRAME" | b"OLE2FRAME" | b"PDFUNDERLAY" | b"DWFUNDERLAY"
        | b"DGNUNDERLAY" | b"PDFREFERENCE" | b"POINTCLOUD" | b"POINTCLOUDEX" => {
            "left out: embedded and attached pictures are not read"
        }
        b"SHAPE" => "left out: its shape file is not read; explode it",
        b"LIGHT" | b"SUN" | b"CAMERA" | b"SECTION" | b"GEOPOSITIONMARKER" => {
            "left out: it has no outline"
        }
        _ => "left out: this type is not supported; explode it to lines and arcs",
    }
}

impl DxfRecord<'_> {
    /// Converts the entity to geometry, or returns why it is left out.
    ///
    /// POLYLINE is converted by [`Self::polyline`] because its vertices are separate records, text
    /// by [`TextReader`](super::text::TextReader) because it needs the table of text styles.
    pub fn shape(&self) -> Result<ShapeOrReason, EntityFault> {
        Ok(Ok(match self.kind {
            b"LINE" => {
                let ends = [self.point(10)?, self.point(11)?].map(|p| p.truncate());
                if ends[0] == ends[1] {
                    return Err("it has no length".into());
                }
                open_path(DxfCurve::Line(ends))
            }
            b"LWPOLYLINE" => self.light_polyline()?,
            b"CIRCLE" => self.arc(0.0, TAU)?,
            b"ARC" => {
                let [from, to] = [self.real(50, 0.0)?, self.real(51, 360.0)?].map(f64::to_radians);
                self.arc(from, positive_angle(from, to))?
            }
            b"ELLIPSE" => self.ellipse()?,
            b"SPLINE" => open_path(DxfCurve::Spline(spline::spline(self)?)),
            b"HELIX" => {
                let cut = |pair: &&GroupPair| !(pair.code == 100 && pair.text() == b"AcDbHelix");
                let pairs = self.pairs.iter().take_while(cut).copied().collect();
                let own = DxfRecord { pairs, ..*self };
                open_path(DxfCurve::Spline(spline::spline(&own)?))
            }
            b"SOLID" | b"TRACE" => {
                // The DXF Reference numbers the corners row by row.
                let plan = self.plane_map(self.point(10)?.z)?;
                self.quadrilateral([10, 11, 13, 12], &plan)?
            }
            b"3DFACE" => self.quadrilateral([10, 11, 12, 13], &DAffine2::IDENTITY)?,
            b"HATCH" | b"MPOLYGON" => EntityShape::Area(hatch::loops(self)?),
            b"MLINE" => self.multiline()?,
            b"LEADER" => self.leader()?,
            b"INSERT" => self.insert()?,
            b"DIMENSION" | b"ARC_DIMENSION" | b"LARGE_RADIAL_DIMENSION" => self.dimension()?,
            b"ACAD_TABLE" => self.table()?,
            kind => return Ok(Err(reason_to_leave_out(kind))),
        }))
    }

    /// Returns the style of the entity and the treatment of its fill, if that is approximated.
    pub fn style_and_remark(&self) -> Result<(EntityStyle, Option<EntityRemark>), EntityFault> {
        let mut style = EntityStyle::of(self);
        let what = match self.kind {
            b"HATCH" | b"MPOLYGON" => hatch::replaced_fill(self)?.and_then(|fill| {
                style.colour = fill.colour.map_or(style.colour, Inheritable::Own);
                fill.what
            }),
            b"3DFACE" => Some("filled as an area instead of drawn by its edges".into()),
            b"LEADER" if self.integer_or(71, 1)? != 0 => Some("drawn without its arrow".into()),
            b"MLINE" => Some(MULTILINE_REMARK.into()),
            _ => None,
        };
        Ok((style, what.map(|what| self.remark(what))))
    }

    /// Converts an LWPOLYLINE.
    fn light_polyline(&self) -> Result<EntityShape, EntityFault> {
        let mut corners = PolylineVertex::list(&self.pairs)?;
        let width = self.real(43, 0.0)?;
        if width != 0.0 {
            corners.iter_mut().for_each(|c| c.widths = [width; 2]);
        }
        let plan = self.plane_map(self.real(38, 0.0)?)?;
        polyline(&corners, self.integer(70)? & 1 != 0, &plan)
    }

    /// Converts a POLYLINE with its VERTEX records, or returns why it is left out.
    pub fn polyline(&self, vertices: &[DxfRecord]) -> Result<ShapeOrReason, EntityFault> {
        let flags = self.integer(70)?;
        if flags & (16 | 64) != 0 {
            return Ok(Err(
                "left out: meshes in space have no plane outline; explode it",
            ));
        }
        let is_in_space = flags & 8 != 0;
        let widths = [self.real(40, 0.0)?, self.real(41, 0.0)?];
        let mut corners = Vec::with_capacity(vertices.len());
        for vertex in vertices {
            if vertex.integer(70)? & 16 != 0 {
                continue; // control point of a curve whose fitted vertices follow
            }
            let mut corner = PolylineVertex {
                point: DVec2::new(vertex.real(10, 0.0)?, vertex.real(20, 0.0)?),
                bulge: 0.0,
                widths: [0.0; 2],
            };
            if !is_in_space {
                corner.bulge = vertex.real(42, 0.0)?;
                corner.widths = [vertex.real(40, widths[0])?, vertex.real(41, widths[1])?];
            }
            corners.push(corner);
        }
        let plan = match is_in_space {
            true => DAffine2::IDENTITY,
            false => self.plane_map(self.real(30, 0.0)?)?,
        };
        Ok(Ok(polyline(&corners, flags & 1 != 0, &plan)?))
    }

    /// Converts a CIRCLE or ARC with the given start angle and sweep in radians.
    fn arc(&self, from: f64, sweep: f64) -> Result<EntityShape, EntityFault> {
        let centre = self.point(10)?;
        let radius = self.real(40, 0.0)?;
        if radius <= 0.0 {
            return Err("its radius is not positive".into());
        }
        let arc = EllipseArc::circular(centre.truncate(), radius, from, sweep);
        Ok(arc_shape(arc, &self.plane_map(centre.z)?))
    }

    /// Converts an ELLIPSE.
    fn ellipse(&self) -> Result<EntityShape, EntityFault> {
        let (centre, major) = (self.point(10)?, self.point(11)?);
        // An ELLIPSE is given in world coordinates, unlike a CIRCLE, so it needs no change of
        // coordinates, only the projection onto the xy plane.
        let minor = self.real(40, 1.0)? * self.normal()?.cross(major);
        if minor.length() == 0.0 {
            return Err("one of its axes has no length".into());
        }
        let (from, to) = (self.real(41, 0.0)?, self.real(42, TAU)?);
        let arc = EllipseArc {
            centre: centre.truncate(),
            u: major.truncate(),
            v: minor.truncate(),
            from,
            sweep: positive_angle(from, to),
        };
        Ok(arc_shape(arc, &DAffine2::IDENTITY))
    }

    /// Converts a quadrilateral or triangle. `codes` are the group codes of its corners in the
    /// order of its boundary; a triangle repeats or omits the fourth corner of the file.
    fn quadrilateral(&self, codes: [i32; 4], plan: &DAffine2) -> Result<EntityShape, EntityFault> {
        let mut corners = Vec::with_capacity(4);
        for code in codes {
            let corner = match self.optional_point(code)? {
                None if code == 13 => continue,
                None => return Err("one of its corners is missing".into()),
                Some(corner) => corner.truncate(),
            };
            corners.push(plan.transform_point2(corner));
        }
        let is_flat = corners.windows(2).all(|edge| {
            let along = corners
                .iter()
                .map(|&p| (p - corners[0]).perp_dot(edge[1] - edge[0]));
            along.fold(0.0, |far: f64, distance| far.max(distance.abs())) == 0.0
        });
        let outline = vec![DxfCurve::Chain(corners)];
        // A face seen from its edge is a line.
        Ok(match is_flat {
            true => EntityShape::Path {
                curves: outline,
                is_closed: true,
            },
            false => EntityShape::Area(AreaLoops {
                loops: vec![outline],
                rule: FillRule::NonZero,
            }),
        })
    }

    /// Converts an MLINE: one line for each element of its style.
    fn multiline(&self) -> Result<EntityShape, EntityFault> {
        let is_closed = self.integer(71)? & 2 != 0;
        let mut lines: Vec<Vec<DVec2>> = Vec::new();
        let (mut vertex, mut mitre) = (DVec2::ZERO, DVec2::ZERO);
        // Number of the element, and whether the next parameter is its offset.
        let (mut element, mut is_offset) = (0, false);
        for pair in &self.pairs {
            match pair.code {
                11 => (vertex.x, element) = (pair.real()?, 0),
                21 => vertex.y = pair.real()?,
                13 => mitre.x = pair.real()?,
                23 => mitre.y = pair.real()?,
                74 => is_offset = pair.integer()? > 0,
                41 if is_offset => {
                    is_offset = false;
                    if element == lines.len() {
                        lines.push(Vec::new());
                    }
                    lines[element].push(vertex + pair.real()? * mitre);
                    element += 1;
                }
                _ => {}
            }
        }
        if lines.is_empty() {
            return Err("it has no lines".into());
        }
        let path = |points: Vec<DVec2>| EntityShape::Path {
            curves: vec![DxfCurve::Chain(points)],
            is_closed,
        };
        Ok(EntityShape::Group(lines.into_iter().map(path).collect()))
    }

    /// Converts a LEADER to its line or spline.
    fn leader(&self) -> Result<EntityShape, EntityFault> {
        let points = self.points(10)?;
        if points.len() < 2 {
            return Err("it has fewer than two points".into());
        }
        Ok(open_path(match self.integer(72)? {
            1 => DxfCurve::Spline(spline::through_fit_points(&points, [None; 2], false)?),
            _ => DxfCurve::Chain(points),
        }))
    }

    /// Converts an INSERT, a reference that places a grid of block copies.
    fn insert(&self) -> Result<EntityShape, EntityFault> {
        let at = self.point(10)?;
        let plan = self.plane_map(at.z)?;
        let scale = DVec2::new(self.real(41, 1.0)?, self.real(42, 1.0)?);
        let rotation = DMat2::from_angle(self.real(50, 0.0)?.to_radians());
        // A number of columns or rows of 0 means 1.
        let counts = [self.integer(70)?, self.integer(71)?].map(|n| n.max(1));
        if counts[0].saturating_mul(counts[1]) > MAX_COPIES {
            return Err("it makes too many copies".into());
        }
        let spacing = DVec2::new(self.real(44, 0.0)?, self.real(45, 0.0)?);
        let mut places = Vec::new();
        for row in 0..counts[1] {
            for column in 0..counts[0] {
                let offset = rotation * (spacing * DVec2::new(column as f64, row as f64));
                places.push(
                    plan * DAffine2 {
                        matrix2: rotation * DMat2::from_diagonal(scale),
                        translation: at.truncate() + offset,
                    },
                );
            }
        }
        Ok(self.reference(places, true))
    }

    /// Converts a DIMENSION: a reference to the block that contains its lines and text.
    fn dimension(&self) -> Result<EntityShape, EntityFault> {
        if self.text(2).is_empty() {
            return Err("it has no block with its lines and text".into());
        }
        // The block is drawn where the dimension is; a copy of a dimension moves it.
        let moved = self.point(12)?;
        let plan = self.plane_map(moved.z)?;
        let place = plan * DAffine2::from_translation(moved.truncate());
        Ok(self.reference(vec![place], false))
    }

    /// Converts an ACAD_TABLE: a reference to the block that contains its lines and text.
    fn table(&self) -> Result<EntityShape, EntityFault> {
        let at = self.point(10)?;
        let along = self
            .optional_point(11)?
            .map(|direction| direction.truncate());
        let along = along.and_then(DVec2::try_normalize).unwrap_or(DVec2::X);
        let turned = DMat2::from_cols(along, along.perp());
        let place = DAffine2::from_mat2_translation(turned, at.truncate());
        Ok(self.reference(vec![place], true))
    }

    fn reference(&self, places: Vec<DAffine2>, uses_base_point: bool) -> EntityShape {
        EntityShape::Insert(BlockReference {
            kind: String::from_utf8_lossy(self.kind).into_owned(),
            block: name_key(self.text(2)),
            places,
            uses_base_point,
            at: self.at,
        })
    }
}

/// Returns an open path that consists of one curve.
fn open_path(curve: DxfCurve) -> EntityShape {
    EntityShape::Path {
        curves: vec![curve],
        is_closed: false,
    }
}

/// Returns a path that consists of one arc, transformed by `plan`, the affine map to the xy plane
/// of the drawing.
fn arc_shape(arc: EllipseArc, plan: &DAffine2) -> EntityShape {
    EntityShape::Path {
        is_closed: arc.is_full_ellipse(),
        curves: vec![DxfCurve::Arc(arc).transformed(plan)],
    }
}

/// Returns the path through the vertices of a polyline, or the band along it if it has a width,
/// transformed by `plan`, the affine map to the xy plane of the drawing.
fn polyline(
    corners: &[PolylineVertex],
    is_closed: bool,
    plan: &DAffine2,
) -> Result<EntityShape, EntityFault> {
    if corners.len() < 2 {
        return Err("it has fewer than two vertices".into());
    }
    let curves = polyline_curves(corners, is_closed);
    if corners.iter().all(|corner| corner.widths == [0.0; 2]) {
        let curves = curves.map(|curve| curve.transformed(plan)).collect();
        return Ok(EntityShape::Path { curves, is_closed });
    }
    Ok(EntityShape::Band(WideBand {
        curves: curves.collect(),
        widths: corners
            .iter()
            .map(|corner| corner.widths.map(f64::abs))
            .collect(),
        is_closed,
        place: *plan,
    }))
}
