//! Converts DXF entities to curves in the plane and to block references.
//!
//! An entity with an extrusion direction has its own coordinate system, defined by the "arbitrary
//! axis algorithm" of the DXF Reference. Such an entity is projected onto the xy plane.

use super::colours::{ColourSource, EntityStyle};
use super::curve::{DxfCurve, EllipseArc, NurbsCurve};
use super::error::{DxfError, DxfPlace};
use super::pairs::GroupPair;
use crate::geometry::DVec2;
use glam::{DAffine2, DMat2, DVec3};
use std::f64::consts::TAU;

/// Entity with its layer and colour.
#[derive(Debug)]
pub(super) struct DxfEntity {
    pub shape: EntityShape,
    pub ink: EntityStyle,
}

/// Geometry of an entity: its own curves, or a reference to a block.
#[derive(Debug)]
pub(super) enum EntityShape {
    /// Path of connected curves.
    Path {
        curves: Vec<DxfCurve>,
        is_closed: bool,
    },
    /// Reference that places one or more copies of a block.
    Insert {
        /// Name of the block.
        block: Vec<u8>,
        /// For each copy, the affine map from block coordinates, with the base point as origin, to
        /// the coordinate system that contains the reference.
        places: Vec<DAffine2>,
    },
}

/// Maximum number of block copies that one INSERT makes (resource limit: a grid of 100 by 100;
/// checked before memory for the copies is allocated).
const MAX_COPIES: i64 = 10_000;

/// Record of the file: an entity or table entry with its pairs of group code and value.
pub(super) struct DxfRecord<'a> {
    /// Type name, such as `LINE`.
    pub kind: &'a [u8],
    /// Position of the record in the file.
    pub at: DxfPlace,
    pub pairs: Vec<GroupPair<'a>>,
}

impl<'a> DxfRecord<'a> {
    /// Returns the first pair with the group code `code`.
    fn first(&self, code: i32) -> Option<&GroupPair<'a>> {
        self.pairs.iter().find(|pair| pair.code == code)
    }

    /// Returns the first real number with the group code `code`, or `default` if there is none.
    pub fn real(&self, code: i32, default: f64) -> Result<f64, DxfError> {
        self.first(code).map_or(Ok(default), GroupPair::real)
    }

    /// Returns the first integer with the group code `code`, or 0 if there is none.
    pub fn integer(&self, code: i32) -> Result<i64, DxfError> {
        self.first(code).map_or(Ok(0), GroupPair::integer)
    }

    /// Returns the first text with the group code `code`, or an empty text if there is none.
    pub fn text(&self, code: i32) -> &'a [u8] {
        self.first(code).map_or(b"", GroupPair::text)
    }

    /// Returns the layer and the colour source of the entity.
    pub fn ink(&self) -> Result<EntityStyle, DxfError> {
        let number = self.first(62).map_or(Ok(256), GroupPair::integer)?;
        Ok(EntityStyle {
            layer: self.text(8).into(),
            colour: ColourSource::of(number, self.bits()?),
        })
    }

    /// Returns the 24-bit colour (group code 420), if given.
    pub fn bits(&self) -> Result<Option<i64>, DxfError> {
        self.first(420).map(GroupPair::integer).transpose()
    }

    /// Returns the point whose x, y and z have the group codes `code`, `code + 10` and `code + 20`.
    fn point(&self, code: i32) -> Result<DVec3, DxfError> {
        Ok(DVec3::new(
            self.real(code, 0.0)?,
            self.real(code + 10, 0.0)?,
            self.real(code + 20, 0.0)?,
        ))
    }

    /// Returns all real numbers with the group code `code`, in file order.
    fn reals(&self, code: i32) -> Result<Vec<f64>, DxfError> {
        let pairs = self.pairs.iter().filter(|pair| pair.code == code);
        pairs.map(GroupPair::real).collect()
    }

    /// Returns all points whose x has the group code `code` and whose y has `code + 10`.
    fn points(&self, code: i32) -> Result<Vec<DVec2>, DxfError> {
        let (xs, ys) = (self.reals(code)?, self.reals(code + 10)?);
        if xs.len() != ys.len() {
            return Err(self.inconsistency_error("a point lacks its x or y coordinate"));
        }
        Ok(xs.into_iter().zip(ys).map(DVec2::from).collect())
    }

    /// Returns the extrusion direction as a unit vector; +z if it has no length.
    fn normal(&self) -> Result<DVec3, DxfError> {
        // The z component of the direction defaults to 1, that of other points to 0.
        let z = self.real(230, 1.0)?;
        let given = self.point(210)?.with_z(z);
        Ok(given.try_normalize().unwrap_or(DVec3::Z))
    }

    /// Returns the affine map to the xy plane of the drawing from the plane z = `elevation` of the
    /// entity's own coordinate system.
    fn plane_map(&self, elevation: f64) -> Result<DAffine2, DxfError> {
        let normal = self.normal()?;
        // The arbitrary axis algorithm of the DXF Reference prescribes the bound 1/64 for the
        // choice of the reference axis.
        let near_z = normal.x.abs() < 1.0 / 64.0 && normal.y.abs() < 1.0 / 64.0;
        let reference_axis = if near_z { DVec3::Y } else { DVec3::Z };
        let x_axis = reference_axis
            .cross(normal)
            .try_normalize()
            .unwrap_or(DVec3::X);
        let y_axis = normal.cross(x_axis);
        Ok(DAffine2 {
            matrix2: DMat2::from_cols(x_axis.truncate(), y_axis.truncate()),
            translation: elevation * normal.truncate(),
        })
    }

    /// Returns the error for an entity with inconsistent data; `what` describes the fault.
    fn inconsistency_error(&self, what: &'static str) -> DxfError {
        DxfError::Broken {
            at: self.at,
            kind: String::from_utf8_lossy(self.kind).into_owned(),
            what,
        }
    }

    /// Converts the entity to geometry; returns `None` for unsupported types.
    ///
    /// POLYLINE is converted by [`Self::polyline`] because its vertices are separate records.
    pub fn shape(&self) -> Result<Option<EntityShape>, DxfError> {
        Ok(Some(match self.kind {
            b"LINE" => open_path(DxfCurve::Line([
                self.point(10)?.truncate(),
                self.point(11)?.truncate(),
            ])),
            b"LWPOLYLINE" => self.light_polyline()?,
            b"CIRCLE" => self.arc(0.0, TAU)?,
            b"ARC" => {
                let [from, to] = [self.real(50, 0.0)?, self.real(51, 360.0)?].map(f64::to_radians);
                self.arc(from, positive_angle(from, to))?
            }
            b"ELLIPSE" => self.ellipse()?,
            b"SPLINE" => return self.spline(),
            b"INSERT" => self.insert()?,
            _ => return Ok(None),
        }))
    }

    /// Converts an LWPOLYLINE.
    fn light_polyline(&self) -> Result<EntityShape, DxfError> {
        let mut corners: Vec<PolylineVertex> = Vec::new();
        for pair in &self.pairs {
            match (pair.code, corners.last_mut()) {
                (10, _) => {
                    let point = DVec2::new(pair.real()?, 0.0);
                    corners.push(PolylineVertex { point, bulge: 0.0 });
                }
                (20, Some(corner)) => corner.point.y = pair.real()?,
                (42, Some(corner)) => corner.bulge = pair.real()?,
                _ => {}
            }
        }
        let plan = self.plane_map(self.real(38, 0.0)?)?;
        Ok(polyline(&corners, self.integer(70)? & 1 != 0, &plan))
    }

    /// Converts a POLYLINE with its VERTEX records; returns `None` for a mesh.
    pub fn polyline(&self, vertices: &[DxfRecord]) -> Result<Option<EntityShape>, DxfError> {
        let flags = self.integer(70)?;
        if flags & (16 | 64) != 0 {
            return Ok(None);
        }
        let is_in_space = flags & 8 != 0;
        let mut corners = Vec::with_capacity(vertices.len());
        for vertex in vertices {
            if vertex.integer(70)? & 16 != 0 {
                continue; // control point of a curve whose fitted vertices follow
            }
            let bulge = match is_in_space {
                true => 0.0,
                false => vertex.real(42, 0.0)?,
            };
            let point = DVec2::new(vertex.real(10, 0.0)?, vertex.real(20, 0.0)?);
            corners.push(PolylineVertex { point, bulge });
        }
        let plan = match is_in_space {
            true => DAffine2::IDENTITY,
            false => self.plane_map(self.real(30, 0.0)?)?,
        };
        Ok(Some(polyline(&corners, flags & 1 != 0, &plan)))
    }

    /// Converts a CIRCLE or ARC with the given start angle and sweep in radians.
    fn arc(&self, from: f64, sweep: f64) -> Result<EntityShape, DxfError> {
        let centre = self.point(10)?;
        let radius = self.real(40, 0.0)?;
        let arc = EllipseArc {
            centre: centre.truncate(),
            u: DVec2::new(radius, 0.0),
            v: DVec2::new(0.0, radius),
            from,
            sweep,
        };
        Ok(arc_shape(arc, &self.plane_map(centre.z)?))
    }

    /// Converts an ELLIPSE.
    fn ellipse(&self) -> Result<EntityShape, DxfError> {
        let (centre, major) = (self.point(10)?, self.point(11)?);
        // An ELLIPSE is given in world coordinates, unlike a CIRCLE, so it needs no change of
        // coordinates, only the projection onto the xy plane.
        let minor = self.real(40, 1.0)? * self.normal()?.cross(major);
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

    /// Converts a SPLINE; returns `None` if it has only fit points.
    fn spline(&self) -> Result<Option<EntityShape>, DxfError> {
        let points = self.points(10)?;
        if points.is_empty() {
            return Ok(None);
        }
        let degree = usize::try_from(self.integer(71)?).unwrap_or(0);
        let (knots, weights) = (self.reals(40)?, self.reals(41)?);
        let spline = NurbsCurve::new(degree, knots, &points, &weights).ok_or_else(|| {
            self.inconsistency_error(
                "its degree, knots, control points and weights are inconsistent",
            )
        })?;
        Ok(Some(open_path(DxfCurve::Spline(spline))))
    }

    /// Converts an INSERT, a reference that places a grid of block copies.
    fn insert(&self) -> Result<EntityShape, DxfError> {
        let at = self.point(10)?;
        let plan = self.plane_map(at.z)?;
        let scale = DVec2::new(self.real(41, 1.0)?, self.real(42, 1.0)?);
        let rotation = DMat2::from_angle(self.real(50, 0.0)?.to_radians());
        // A number of columns or rows of 0 means 1.
        let counts = [self.integer(70)?, self.integer(71)?].map(|n| n.max(1));
        if counts[0].saturating_mul(counts[1]) > MAX_COPIES {
            return Err(self.inconsistency_error("it makes too many copies"));
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
        Ok(EntityShape::Insert {
            block: self.text(2).to_owned(),
            places,
        })
    }
}

/// Returns the counter-clockwise angle from the direction `from` to the direction `to`, in (0, 2π]
/// radians.
fn positive_angle(from: f64, to: f64) -> f64 {
    let sweep = (to - from).rem_euclid(TAU);
    // Directions that are equal up to rounding errors mean a full turn.
    if sweep <= 1e-12 { TAU } else { sweep }
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

struct PolylineVertex {
    point: DVec2,
    /// Bulge of the line or arc that starts at this vertex: the tangent of a quarter of the arc's
    /// angle, or 0 for a line.
    bulge: f64,
}

/// Returns the path through the vertices of a polyline, transformed by `plan`, the affine map to
/// the xy plane of the drawing.
fn polyline(corners: &[PolylineVertex], is_closed: bool, plan: &DAffine2) -> EntityShape {
    // An open polyline has one line or arc fewer than it has vertices.
    let last = corners.len().saturating_sub(1);
    let sides = if is_closed { corners.len() } else { last };
    let side = |i: usize| {
        let (a, b) = (&corners[i], &corners[(i + 1) % corners.len()]);
        DxfCurve::from_bulge(a.point, b.point, a.bulge).transformed(plan)
    };
    EntityShape::Path {
        curves: (0..sides).map(side).collect(),
        is_closed,
    }
}
