//! HATCH and MPOLYGON: boundary loops of polylines with bulges or of edges (lines, arcs, ellipses,
//! splines).
//!
//! The hatch style says which loops count; the even-odd rule decides what they enclose. Patterns
//! are drawn as flat fills and gradients in their mean colour.

use super::colours::from_index;
use super::curve::positive_angle;
use super::curve::{AreaLoops, DxfCurve, EllipseArc};
use super::error::EntityFault;
use super::pairs::GroupPair;
use super::polyline::{PolylineVertex, polyline_curves};
use super::record::{DxfRecord, points};
use super::spline;
use crate::colour::Rgb;
use crate::geometry::{DVec2, FillRule};
use glam::DAffine2;
use std::f64::consts::TAU;

/// Flags of a boundary loop (group code 92).
const EXTERNAL: i64 = 1;
const POLYLINE: i64 = 2;
const TEXT_BOX: i64 = 8;
const OUTERMOST: i64 = 16;

/// Reads the boundary loops of a HATCH or MPOLYGON.
pub(super) fn loops(record: &DxfRecord) -> Result<AreaLoops, EntityFault> {
    let position = |code: i32| record.pairs.iter().position(|pair| pair.code == code);
    let first = position(91).ok_or("it has no boundary")?;
    let boundary = &record.pairs[first + 1..];
    // The hatch style, or the pattern of an MPOLYGON, follows the last loop.
    let end = boundary
        .iter()
        .position(|pair| matches!(pair.code, 75 | 76));
    let boundary = &boundary[..end.unwrap_or(boundary.len())];
    let elevation = record.pairs[..first].iter().find(|pair| pair.code == 30);
    let elevation = elevation.map_or(Ok(0.0), |pair| pair.real())?;
    let plan = record.plane_map(elevation)?;
    let mut loops: Vec<(i64, Vec<DxfCurve>)> = Vec::new();
    for pairs in split_at(boundary, 92) {
        let flags = pairs[0].integer()?;
        if flags & TEXT_BOX == 0 {
            let curves = match flags & POLYLINE != 0 {
                true => polyline_loop(&pairs[1..])?,
                false => edge_loop(&pairs[1..])?,
            };
            loops.push((flags, curves));
        }
    }
    let loops = visible_loops(loops, record.integer(75)?);
    if loops.iter().all(Vec::is_empty) {
        return Err("it has no boundary".into());
    }
    let plan = match record.kind {
        b"MPOLYGON" => plan * DAffine2::from_translation(record.point(11)?.truncate()),
        _ => plan,
    };
    let place = |curves: Vec<DxfCurve>| curves.iter().map(|c| c.transformed(&plan)).collect();
    Ok(AreaLoops {
        loops: loops.into_iter().map(place).collect(),
        rule: FillRule::EvenOdd,
    })
}

/// Returns the loops that the hatch style shows: all (style 0), the external and outermost ones (1)
/// or the external ones (2). If no loop is marked as one of these, all are shown.
fn visible_loops(loops: Vec<(i64, Vec<DxfCurve>)>, style: i64) -> Vec<Vec<DxfCurve>> {
    let shown = match style {
        1 => EXTERNAL | OUTERMOST,
        2 => EXTERNAL,
        _ => !0,
    };
    let is_marked = loops.iter().any(|(flags, _)| flags & shown != 0);
    let is_shown = |flags: i64| style == 0 || !is_marked || flags & shown != 0;
    let shown = loops.into_iter().filter(|(flags, _)| is_shown(*flags));
    shown.map(|(_, curves)| curves).collect()
}

/// Splits a list of pairs before each pair with the group code `code`; pairs before the first are
/// dropped.
fn split_at<'p, 'a>(
    pairs: &'p [GroupPair<'a>],
    code: i32,
) -> impl Iterator<Item = &'p [GroupPair<'a>]> {
    let starts = pairs
        .iter()
        .enumerate()
        .filter(move |(_, pair)| pair.code == code);
    let mut starts = starts.map(|(i, _)| i).peekable();
    std::iter::from_fn(move || {
        let start = starts.next()?;
        let end = starts.peek().copied().unwrap_or(pairs.len());
        Some(&pairs[start..end])
    })
}

/// Reads a boundary loop that is a polyline.
fn polyline_loop(pairs: &[GroupPair]) -> Result<Vec<DxfCurve>, EntityFault> {
    let corners = PolylineVertex::list(pairs)?;
    Ok(polyline_curves(&corners, true).collect())
}

/// Reads a boundary loop that consists of edges.
fn edge_loop(pairs: &[GroupPair]) -> Result<Vec<DxfCurve>, EntityFault> {
    split_at(pairs, 72)
        .map(|pairs| EdgePairs(&pairs[1..]).curve(pairs[0].integer()?))
        .collect()
}

/// Pairs of one edge of a boundary loop.
struct EdgePairs<'p, 'a>(&'p [GroupPair<'a>]);

impl EdgePairs<'_, '_> {
    fn real(&self, code: i32, default: f64) -> Result<f64, EntityFault> {
        let first = self.0.iter().find(|pair| pair.code == code);
        first.map_or(Ok(default), |pair| pair.real())
    }

    fn reals(&self, code: i32) -> Result<Vec<f64>, EntityFault> {
        let pairs = self.0.iter().filter(|pair| pair.code == code);
        pairs.map(GroupPair::real).collect()
    }

    fn point(&self, code: i32) -> Result<DVec2, EntityFault> {
        Ok(DVec2::new(
            self.real(code, 0.0)?,
            self.real(code + 10, 0.0)?,
        ))
    }

    /// Returns the curve of an edge of the type `kind`: line, circular arc, elliptical arc or
    /// spline.
    fn curve(&self, kind: i64) -> Result<DxfCurve, EntityFault> {
        match kind {
            1 => Ok(DxfCurve::Line([self.point(10)?, self.point(11)?])),
            2 => {
                let radius = self.real(40, 0.0)?;
                self.arc(DVec2::new(radius, 0.0), 1.0)
            }
            3 => self.arc(self.point(11)?, self.real(40, 1.0)?),
            4 => self.spline(),
            _ => Err("its boundary has an edge of an unknown type".into()),
        }
    }

    /// Returns an elliptical arc with the semi-axis `major`; the other one is `ratio` times as
    /// long.
    fn arc(&self, major: DVec2, ratio: f64) -> Result<DxfCurve, EntityFault> {
        if !(major.length() > 0.0 && ratio > 0.0) {
            return Err("its boundary has an arc without a radius".into());
        }
        let angles = [self.real(50, 0.0)?, self.real(51, 360.0)?].map(f64::to_radians);
        let [from, to] = angles.map(|angle| ellipse_parameter(angle, ratio));
        let is_full = (angles[1] - angles[0]).abs() >= TAU - 1e-9;
        let sweep = if is_full {
            TAU
        } else {
            positive_angle(from, to)
        };
        // The angles of a clockwise arc are measured clockwise too.
        let sign = if self.real(73, 1.0)? == 0.0 {
            -1.0
        } else {
            1.0
        };
        Ok(DxfCurve::Arc(EllipseArc {
            centre: self.point(10)?,
            u: major,
            v: ratio * major.perp(),
            from: sign * from,
            sweep: sign * sweep,
        }))
    }

    fn spline(&self) -> Result<DxfCurve, EntityFault> {
        let control = points(self.0, 10)?;
        let curve = if control.is_empty() {
            let tangent = |code: i32| -> Result<Option<DVec2>, EntityFault> {
                let is_given = self.0.iter().any(|pair| pair.code == code);
                is_given.then(|| self.point(code)).transpose()
            };
            let is_closed = self.real(74, 0.0)? != 0.0;
            spline::through_fit_points(
                &points(self.0, 11)?,
                [tangent(12)?, tangent(13)?],
                is_closed,
            )
        } else {
            let degree = self.real(94, 3.0)? as usize;
            spline::with_control_points(degree, self.reals(40)?, &control, &self.reals(42)?)
        };
        curve.map(DxfCurve::Spline)
    }
}

/// Converts an angle seen from the centre of an ellipse to the parameter of the ellipse, in the
/// same turn.
fn ellipse_parameter(angle: f64, ratio: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    let turn = (sin / ratio).atan2(cos) - sin.atan2(cos);
    angle + turn
}

/// Fill of a hatch, if it is not solid or has a colour of its own: how it is drawn, and in which
/// colour.
pub(super) struct ReplacedFill {
    /// Treatment, as worded in a note; `None` if the fill is solid.
    pub what: Option<String>,
    /// Colour, if it is not that of the entity.
    pub colour: Option<Rgb>,
}

/// Returns how the fill of a hatch is replaced; `None` for a solid fill in the colour of the
/// entity.
pub(super) fn replaced_fill(record: &DxfRecord) -> Result<Option<ReplacedFill>, EntityFault> {
    if record.integer(450)? != 0 {
        let colours = record.pairs.iter().filter(|pair| pair.code == 421);
        let colours: Vec<i64> = colours.map(GroupPair::integer).collect::<Result<_, _>>()?;
        let what = "filled with the mean colour of the gradient".to_owned();
        let colour = mean_colour(&colours);
        return Ok(Some(ReplacedFill {
            what: Some(what),
            colour,
        }));
    }
    // MPOLYGON stores the flag of a solid fill under another group code.
    let solid = if record.kind == b"MPOLYGON" { 71 } else { 70 };
    let name = super::encoding::decode(record.text(2));
    if record.integer(solid)? != 0 || name.eq_ignore_ascii_case("SOLID") {
        // The fill of an MPOLYGON has a colour of its own; that of the entity is for its edges.
        let own = record.first(63).filter(|_| record.kind == b"MPOLYGON");
        let colour = own.map(GroupPair::integer).transpose()?;
        let colour = colour.filter(|number| (1..256).contains(number));
        return Ok(colour.map(|number| ReplacedFill {
            what: None,
            colour: Some(from_index(number)),
        }));
    }
    let what = format!("filled flat instead of with the pattern {name}");
    Ok(Some(ReplacedFill {
        what: Some(what),
        colour: None,
    }))
}

fn mean_colour(colours: &[i64]) -> Option<Rgb> {
    let count = i64::try_from(colours.len())
        .ok()
        .filter(|&count| count > 0)?;
    let channel = |shift: u32| {
        let sum: i64 = colours.iter().map(|bits| (bits >> shift) & 0xff).sum();
        u8::try_from((sum + count / 2) / count).unwrap_or(u8::MAX)
    };
    Some(Rgb([channel(16), channel(8), channel(0)]))
}
