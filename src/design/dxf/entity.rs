//! The objects of a drawing as curves in the plane.
//!
//! Objects with an extrusion direction lie in a coordinate system of their
//! own (the "arbitrary axis algorithm" of the DXF Reference); they are seen
//! from above, as a plan.

use super::colours::{ColourSource, EntityStyle};
use super::curve::{DxfCurve, EllipseArc, NurbsCurve};
use super::error::{DxfError, DxfPlace};
use super::pairs::GroupPair;
use crate::geometry::DVec2;
use glam::{DAffine2, DMat2, DVec3};
use std::f64::consts::TAU;

/// An object, and what it is drawn with.
#[derive(Debug)]
pub(super) struct DxfEntity {
    pub shape: EntityShape,
    pub ink: EntityStyle,
}

/// What an object gives.
#[derive(Debug)]
pub(super) enum EntityShape {
    /// Curves one after the other.
    Path {
        curves: Vec<DxfCurve>,
        is_closed: bool,
    },
    /// A copy of a block, for each of the places.
    Insert {
        block: Vec<u8>,
        places: Vec<DAffine2>,
    },
}

/// Most copies of one INSERT, refused before their places are listed: a field
/// of a hundred by a hundred is large for a drawing.
const MAX_COPIES: i64 = 10_000;

/// An object's kind and its pairs.
pub(super) struct DxfRecord<'a> {
    pub kind: &'a [u8],
    pub at: DxfPlace,
    pub pairs: Vec<GroupPair<'a>>,
}

impl<'a> DxfRecord<'a> {
    fn first(&self, code: i32) -> Option<&GroupPair<'a>> {
        self.pairs.iter().find(|pair| pair.code == code)
    }

    pub fn real(&self, code: i32, default: f64) -> Result<f64, DxfError> {
        self.first(code).map_or(Ok(default), GroupPair::real)
    }

    pub fn whole(&self, code: i32) -> Result<i64, DxfError> {
        self.first(code).map_or(Ok(0), GroupPair::whole)
    }

    pub fn text(&self, code: i32) -> &'a [u8] {
        self.first(code).map_or(b"", GroupPair::text)
    }

    /// What the object is drawn with.
    pub fn ink(&self) -> Result<EntityStyle, DxfError> {
        let number = self.first(62).map_or(Ok(256), GroupPair::whole)?;
        Ok(EntityStyle {
            layer: self.text(8).into(),
            colour: ColourSource::of(number, self.bits()?),
        })
    }

    /// The 24 bits of its colour, where it has any.
    pub fn bits(&self) -> Result<Option<i64>, DxfError> {
        self.first(420).map(GroupPair::whole).transpose()
    }

    fn point(&self, code: i32) -> Result<DVec3, DxfError> {
        Ok(DVec3::new(
            self.real(code, 0.0)?,
            self.real(code + 10, 0.0)?,
            self.real(code + 20, 0.0)?,
        ))
    }

    /// The numbers that stand under a code, in order.
    fn reals(&self, code: i32) -> Result<Vec<f64>, DxfError> {
        let pairs = self.pairs.iter().filter(|pair| pair.code == code);
        pairs.map(GroupPair::real).collect()
    }

    /// The points whose x stands under a code and whose y under ten more.
    fn points(&self, code: i32) -> Result<Vec<DVec2>, DxfError> {
        let (xs, ys) = (self.reals(code)?, self.reals(code + 10)?);
        if xs.len() != ys.len() {
            return Err(self.broken("a point has x and no y, or y and no x"));
        }
        Ok(xs.into_iter().zip(ys).map(DVec2::from).collect())
    }

    /// The extrusion direction; upwards where it has no length.
    fn normal(&self) -> Result<DVec3, DxfError> {
        // Left out it is upwards, where every other number is 0.
        let z = self.real(230, 1.0)?;
        let given = self.point(210)?.with_z(z);
        Ok(given.try_normalize().unwrap_or(DVec3::Z))
    }

    /// From the object's own plane at a height to the plan.
    fn plan(&self, elevation: f64) -> Result<DAffine2, DxfError> {
        let normal = self.normal()?;
        // The bound is the reference's, to the last digit: all programs must agree.
        let near_z = normal.x.abs() < 1.0 / 64.0 && normal.y.abs() < 1.0 / 64.0;
        let aside = if near_z { DVec3::Y } else { DVec3::Z };
        let x_axis = aside.cross(normal).try_normalize().unwrap_or(DVec3::X);
        let y_axis = normal.cross(x_axis);
        Ok(DAffine2 {
            matrix2: DMat2::from_cols(x_axis.truncate(), y_axis.truncate()),
            translation: elevation * normal.truncate(),
        })
    }

    fn broken(&self, what: &'static str) -> DxfError {
        DxfError::Broken {
            at: self.at,
            kind: String::from_utf8_lossy(self.kind).into_owned(),
            what,
        }
    }

    /// The object as curves; `None` where it is of a kind without an outline.
    /// POLYLINE needs its vertices and goes another way.
    pub fn shape(&self) -> Result<Option<EntityShape>, DxfError> {
        Ok(Some(match self.kind {
            b"LINE" => open(DxfCurve::Line([
                self.point(10)?.truncate(),
                self.point(11)?.truncate(),
            ])),
            b"LWPOLYLINE" => self.light_polyline()?,
            b"CIRCLE" => self.arc(0.0, TAU)?,
            b"ARC" => {
                let [from, to] = [self.real(50, 0.0)?, self.real(51, 360.0)?].map(f64::to_radians);
                self.arc(from, turn(from, to))?
            }
            b"ELLIPSE" => self.ellipse()?,
            b"SPLINE" => return self.spline(),
            b"INSERT" => self.insert()?,
            _ => return Ok(None),
        }))
    }

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
        let plan = self.plan(self.real(38, 0.0)?)?;
        Ok(polyline(&corners, self.whole(70)? & 1 != 0, &plan))
    }

    /// A POLYLINE with its vertices; `None` for a mesh.
    pub fn polyline(&self, vertices: &[DxfRecord]) -> Result<Option<EntityShape>, DxfError> {
        let flags = self.whole(70)?;
        if flags & (16 | 64) != 0 {
            return Ok(None);
        }
        let is_in_space = flags & 8 != 0;
        let mut corners = Vec::with_capacity(vertices.len());
        for vertex in vertices {
            if vertex.whole(70)? & 16 != 0 {
                continue; // the frame of a curve that stands there fitted
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
            false => self.plan(self.real(30, 0.0)?)?,
        };
        Ok(Some(polyline(&corners, flags & 1 != 0, &plan)))
    }

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
        Ok(of_arc(arc, &self.plan(centre.z)?))
    }

    fn ellipse(&self) -> Result<EntityShape, DxfError> {
        let (centre, major) = (self.point(10)?, self.point(11)?);
        // Given in the plan already, unlike a circle's: no plane of its own.
        let minor = self.real(40, 1.0)? * self.normal()?.cross(major);
        let (from, to) = (self.real(41, 0.0)?, self.real(42, TAU)?);
        let arc = EllipseArc {
            centre: centre.truncate(),
            u: major.truncate(),
            v: minor.truncate(),
            from,
            sweep: turn(from, to),
        };
        Ok(of_arc(arc, &DAffine2::IDENTITY))
    }

    /// `None` for one that is given by the points it goes through only.
    fn spline(&self) -> Result<Option<EntityShape>, DxfError> {
        let points = self.points(10)?;
        if points.is_empty() {
            return Ok(None);
        }
        let degree = usize::try_from(self.whole(71)?).unwrap_or(0);
        let (knots, weights) = (self.reals(40)?, self.reals(41)?);
        let spline = NurbsCurve::new(degree, knots, &points, &weights).ok_or_else(|| {
            self.broken("its degree, knots, control points and weights do not go together")
        })?;
        Ok(Some(open(DxfCurve::Spline(spline))))
    }

    fn insert(&self) -> Result<EntityShape, DxfError> {
        let at = self.point(10)?;
        let plan = self.plan(at.z)?;
        let scale = DVec2::new(self.real(41, 1.0)?, self.real(42, 1.0)?);
        let turned = DMat2::from_angle(self.real(50, 0.0)?.to_radians());
        // None is written for one.
        let counts = [self.whole(70)?, self.whole(71)?].map(|n| n.max(1));
        if counts[0].saturating_mul(counts[1]) > MAX_COPIES {
            return Err(self.broken("it stands for too many copies"));
        }
        let apart = DVec2::new(self.real(44, 0.0)?, self.real(45, 0.0)?);
        let mut places = Vec::new();
        for row in 0..counts[1] {
            for column in 0..counts[0] {
                let offset = turned * (apart * DVec2::new(column as f64, row as f64));
                places.push(
                    plan * DAffine2 {
                        matrix2: turned * DMat2::from_diagonal(scale),
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

/// The angle counter-clockwise from one direction to another, in (0, 2π].
fn turn(from: f64, to: f64) -> f64 {
    let sweep = (to - from).rem_euclid(TAU);
    // From a direction to itself is once around, or as near as radians come to it.
    if sweep <= 1e-12 { TAU } else { sweep }
}

fn open(curve: DxfCurve) -> EntityShape {
    EntityShape::Path {
        curves: vec![curve],
        is_closed: false,
    }
}

fn of_arc(arc: EllipseArc, plan: &DAffine2) -> EntityShape {
    EntityShape::Path {
        is_closed: arc.is_whole(),
        curves: vec![DxfCurve::Arc(arc).moved(plan)],
    }
}

struct PolylineVertex {
    point: DVec2,
    /// Of the side that begins here: the tangent of a quarter of its angle.
    bulge: f64,
}

fn polyline(corners: &[PolylineVertex], is_closed: bool, plan: &DAffine2) -> EntityShape {
    // No corner has no side, and open ones have a side less.
    let last = corners.len().saturating_sub(1);
    let sides = if is_closed { corners.len() } else { last };
    let side = |i: usize| {
        let (a, b) = (&corners[i], &corners[(i + 1) % corners.len()]);
        DxfCurve::bulging(a.point, b.point, a.bulge).moved(plan)
    };
    EntityShape::Path {
        curves: (0..sides).map(side).collect(),
        is_closed,
    }
}
