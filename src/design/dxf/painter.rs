//! Turns the flattened drawing into its silhouette and its paint layers.
//!
//! The silhouette is the union of the closed outlines (even-odd over all of them), the areas and
//! the lines. Each combination of layer, colour and opacity is a group of its own: its outlines and
//! areas are stacked by containment, its lines lie above all areas, its letters above all lines.

use super::band::Pen;
use super::cover::{CoveredShape, CoveringAreas, TOUCHING};
use super::encoding::decode;
use super::error::DxfError;
use super::expansion::DxfDrawing;
use super::hidden_lines::{InnerContent, InnerLine, area_of};
use super::sheet::{OutlineRing, Sheet, SheetScale};
use super::style::{DEFAULT_WEIGHT, ResolvedStyle};
use crate::colour::Paint;
use crate::design::flatten::{Flattener, TooManyPoints};
use crate::design::form::{Design, ImportedOutlines};
use crate::design::note::{DxfNote, ImportNote};
use crate::design::paint_layer::{PaintGroup, PaintLayer, stack_by_containment};
use crate::design::svg::{WindingRings, boolean, union};
use crate::design::unit::LengthUnit;
use crate::geometry::{DVec2, FillRule, Regions, RegionsError, Repairs};
use i_overlay::core::overlay_rule::OverlayRule;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// Imported DXF drawing.
pub(in crate::design) struct DxfImport {
    pub outlines: ImportedOutlines,
    /// Unit of length that the file declares.
    pub unit: Option<LengthUnit>,
}

impl DxfImport {
    /// Turns the import result into a design with the given name.
    pub(in crate::design) fn into_design(self, name: String) -> Design {
        Design {
            unit: self.unit,
            ..self.outlines.into_design(name)
        }
    }
}

/// Paints a flattened drawing. Lines are part of the silhouette if `strokes` is true, and of the
/// paint layers in any case.
pub(super) fn paint(
    drawing: DxfDrawing,
    sheet: Sheet,
    scale: SheetScale,
    strokes: bool,
) -> Result<DxfImport, DxfError> {
    let mut painter = SheetPainter {
        units_per_mm: units_per_mm(&drawing, scale.hair),
        drawing,
        sheet,
        scale,
    };
    let mut notes = painter.line_notes(strokes);
    let hidden = painter.remove_hidden_outlines();
    notes.extend(hidden.map(ImportNote::Dxf));
    if strokes {
        let count = painter.open_hiding_outlines();
        notes.extend((count > 0).then_some(ImportNote::Dxf(DxfNote::OutlinesAsLines(count))));
    }
    let (groups, covered) = painter.groups()?;
    notes.extend(filled_outlines(&groups).map(ImportNote::Dxf));
    notes.extend(covered.into_iter().map(ImportNote::Dxf));
    let (outlines, mut repairs) = painter.repaired_outlines()?.unzip();
    let shown = groups.iter().flat_map(|(_, group)| group.areas(strokes));
    let all = outlines
        .iter()
        .map(rings_of)
        .chain(shown.cloned())
        .collect();
    let regions = match Regions::from_rings(&union(all), FillRule::NonZero) {
        Err(RegionsError::Empty) => {
            return Err(DxfError::Nothing(painter.drawing.report.into_left_out()));
        }
        found => found?,
    };
    // Duplicate rings are already counted. Add the duplicate curves.
    let repairs = repairs.get_or_insert_with(Repairs::default);
    repairs.duplicates += painter.sheet.duplicates;
    repairs.flat += painter.sheet.empty_areas;
    notes.splice(..0, ImportNote::from_repairs(repairs, FillRule::EvenOdd));
    let unit = painter.drawing.unit;
    let reported = painter.drawing.report.into_notes();
    notes.extend(reported.chain(painter.drawing.notes).map(ImportNote::Dxf));
    Ok(DxfImport {
        outlines: ImportedOutlines {
            extent: regions.bounds(),
            regions,
            drawn_colour: None,
            paint_layers: paint_layers(groups),
            notes,
        },
        unit,
    })
}

/// Layer, colour and opacity (as bits) of a group.
type GroupKey = (Rc<str>, [u8; 3], u64);

/// Groups of a drawing with their keys.
type StyledGroups = Vec<(GroupKey, StyledGroup)>;

/// Outlines, areas, lines and letters of one layer and paint. All areas are filled by the non-zero
/// rule.
#[derive(Default)]
struct StyledGroup {
    /// Number of closed outlines.
    count: usize,
    outlines: WindingRings,
    fills: WindingRings,
    lines: WindingRings,
    letters: WindingRings,
}

impl StyledGroup {
    /// Returns the areas of the group without its outlines; those of lines only if `strokes` is
    /// true.
    fn areas(&self, strokes: bool) -> impl Iterator<Item = &WindingRings> {
        let lines = strokes.then_some(&self.lines);
        [&self.fills, &self.letters].into_iter().chain(lines)
    }
}

/// Flattened drawing that is turned into regions.
struct SheetPainter {
    drawing: DxfDrawing,
    sheet: Sheet,
    scale: SheetScale,
    /// Width of a line with a line weight of 1 mm, in drawing units.
    units_per_mm: f64,
}

/// Returns the width of a line with a line weight of 1 mm, in drawing units. Line weights count in
/// the unit of the drawing if the heaviest line is at least a hair wide. Otherwise, as in a plan of
/// a building, and without a unit, they are relative to the default line weight, which is a hair.
fn units_per_mm(drawing: &DxfDrawing, hair: f64) -> f64 {
    let styles = drawing.paths.iter().map(|path| &drawing.styles[path.style]);
    let heaviest = styles.fold(0.0, |heaviest: f64, style| heaviest.max(style.weight));
    let exact = drawing.unit.map(|unit| 1.0 / unit.millimetres());
    let exact = exact.filter(|exact| heaviest * exact >= hair);
    exact.unwrap_or(hair / DEFAULT_WEIGHT)
}

impl SheetPainter {
    /// Returns the style of a path.
    fn style_of(&self, path: usize) -> &ResolvedStyle {
        &self.drawing.styles[self.sheet.paths[path].style]
    }

    /// Returns the width of a line in drawing units; none is thinner than a hair.
    fn width_of(&self, path: usize) -> f64 {
        (self.style_of(path).weight * self.units_per_mm).max(self.scale.hair)
    }

    fn ring_points(&self) -> WindingRings {
        self.sheet
            .rings
            .iter()
            .map(|ring| ring.points.clone())
            .collect()
    }

    /// Returns the notes on the curves that do not close.
    fn line_notes(&self, strokes: bool) -> Vec<ImportNote> {
        let lines = &self.sheet.lines;
        if lines.is_empty() {
            return Vec::new();
        }
        let widths = lines.iter().map(|&path| self.width_of(path));
        let range = widths.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], width| {
            [low.min(width), high.max(width)]
        });
        let drawn = match strokes {
            true => ImportNote::Dxf(DxfNote::Lines {
                count: lines.len(),
                widths: range,
            }),
            false => ImportNote::Strokes(lines.len()),
        };
        let dashed = lines.iter().map(|&path| self.style_of(path));
        let dashed: Vec<&ResolvedStyle> = dashed.filter(|style| style.is_dashed()).collect();
        let types: BTreeSet<String> = dashed
            .iter()
            .map(|style| decode(&style.line_type))
            .collect();
        let solid = (!dashed.is_empty()).then(|| DxfNote::SolidLines {
            count: dashed.len(),
            types: types.into_iter().collect(),
        });
        [drawn]
            .into_iter()
            .chain(solid.map(ImportNote::Dxf))
            .collect()
    }

    /// Removes each closed outline that an equal one on another layer or of another opaque paint
    /// covers, which is drawn later.
    fn remove_hidden_outlines(&mut self) -> Option<DxfNote> {
        let bits = |p: &DVec2| [p.x, p.y].map(f64::to_bits);
        let rings = &self.sheet.rings;
        let mut order: Vec<usize> = (0..rings.len()).collect();
        order.sort_by_key(|&ring| rings[ring].paths.iter().max().copied());
        let style = |ring: usize| &self.drawing.styles[rings[ring].style];
        let mut upper: HashMap<Vec<[u64; 2]>, usize> = HashMap::new();
        let mut hidden = BTreeMap::new(); // for each hidden ring the ring that hides it
        for ring in order.into_iter().rev() {
            let points = rings[ring].points.iter().map(bits).collect();
            let top = *upper.entry(points).or_insert(ring);
            let [own, other] = [ring, top].map(style);
            let differs = own.layer != other.layer || own.paint != other.paint;
            if differs && other.paint.opacity >= 1.0 {
                hidden.insert(ring, top);
            }
        }
        let layers = |(&ring, &top): (&usize, &usize)| {
            let [below, above] = [ring, top].map(|ring| style(ring).layer.to_string());
            DxfNote::HiddenOutlines {
                count: hidden.len(),
                below,
                above,
            }
        };
        let note = hidden.first_key_value().map(layers);
        let mut ring = 0..;
        let is_shown =
            |_: &OutlineRing| ring.next().is_some_and(|ring| !hidden.contains_key(&ring));
        self.sheet.rings.retain(is_shown);
        note
    }

    /// Turns closed outlines that would hide something into lines; returns their number.
    fn open_hiding_outlines(&mut self) -> usize {
        let Ok((regions, _)) =
            Regions::from_rings_reporting(&self.ring_points(), FillRule::EvenOdd)
        else {
            return 0;
        };
        let lines = self.sheet.lines.iter().map(|&path| InnerLine {
            points: &self.sheet.paths[path].points,
            width: self.width_of(path),
        });
        let content = InnerContent {
            lines: lines.collect(),
            areas: &self.sheet.areas,
            styles: &self.drawing.styles,
            tolerance: self.scale.tolerance,
            rounding: self.scale.rounding,
        };
        let is_hiding = content.hidden_by(&regions, &self.sheet.rings);
        let rings = std::mem::take(&mut self.sheet.rings);
        let mut hiding = 0;
        for (ring, is_hiding) in rings.into_iter().zip(is_hiding) {
            if is_hiding {
                hiding += 1;
                self.sheet.lines.extend(ring.paths);
            } else {
                self.sheet.rings.push(ring);
            }
        }
        hiding
    }

    /// Returns the outlines, areas, lines and letters of each layer and paint, in the order in
    /// which the drawing uses them first. Also returns notes on what others cover.
    fn groups(&self) -> Result<(StyledGroups, Vec<DxfNote>), TooManyPoints> {
        let mut parts: BTreeMap<GroupKey, GroupParts> = BTreeMap::new();
        for OutlineRing { points, style, .. } in &self.sheet.rings {
            let group = parts.entry(self.group_key(*style)).or_default();
            group.outlines.push(points.clone());
        }
        let mut covering = CoveringAreas::of(&self.sheet.areas, &self.drawing.styles);
        self.add_areas(&mut parts, &mut covering);
        self.add_lines(&mut parts, &mut covering)?;
        // Styles are numbered in the order of their first use.
        let mut first_use = BTreeMap::new();
        for style in (0..self.drawing.styles.len()).rev() {
            first_use.insert(self.group_key(style), style);
        }
        let parts = parts.into_iter();
        let mut groups: Vec<_> = parts.map(|(key, parts)| (key, parts.united())).collect();
        groups.sort_by_key(|(key, _)| first_use.get(key).copied());
        Ok((groups, covering.notes()))
    }

    /// Returns the area that the closed outlines enclose, with the repairs that it needed; `None`
    /// without an area.
    fn repaired_outlines(&self) -> Result<Option<(Regions, Repairs)>, RegionsError> {
        if self.sheet.rings.is_empty() {
            return Ok(None);
        }
        match Regions::from_rings_reporting(&self.ring_points(), FillRule::EvenOdd) {
            Err(RegionsError::Empty) => Ok(None),
            found => found.map(Some),
        }
    }

    fn group_key(&self, style: usize) -> GroupKey {
        let ResolvedStyle { layer, paint, .. } = &self.drawing.styles[style];
        (Rc::clone(layer), paint.colour.0, paint.opacity.to_bits())
    }

    /// Adds the areas and the letters to their groups.
    fn add_areas(&self, parts: &mut BTreeMap<GroupKey, GroupParts>, covering: &mut CoveringAreas) {
        for area in &self.sheet.areas {
            let rest = covering.rest_of(&CoveredShape {
                rings: &area.rings,
                order: area.order,
                paint: self.drawing.styles[area.style].paint,
                is_stacked: !area.is_text,
            });
            let group = parts.entry(self.group_key(area.style)).or_default();
            match area.is_text {
                true => group.letters.push(rest),
                false => group.fills.push(rest),
            }
        }
    }

    /// Adds the strokes along the lines to their groups.
    fn add_lines(
        &self,
        parts: &mut BTreeMap<GroupKey, GroupParts>,
        covering: &mut CoveringAreas,
    ) -> Result<(), TooManyPoints> {
        let mut flattener = Flattener::new(self.scale.tolerance);
        for &index in &self.sheet.lines {
            let path = &self.sheet.paths[index];
            let pen = Pen {
                width: self.width_of(index),
                is_round: true,
                tolerance: self.scale.tolerance,
            };
            let stroke = pen.stroke(&path.points, path.is_closed, &mut flattener)?;
            let rest = covering.rest_of(&CoveredShape {
                rings: &stroke,
                order: path.order,
                paint: self.style_of(index).paint,
                is_stacked: false,
            });
            let group = parts.entry(self.group_key(path.style)).or_default();
            group.lines.push(rest);
        }
        Ok(())
    }
}

/// Shapes of a group that are not united yet.
#[derive(Default)]
struct GroupParts {
    outlines: WindingRings,
    fills: Vec<WindingRings>,
    lines: Vec<WindingRings>,
    letters: Vec<WindingRings>,
}

impl GroupParts {
    fn united(self) -> StyledGroup {
        let outlines = Regions::from_rings_reporting(&self.outlines, FillRule::EvenOdd);
        StyledGroup {
            count: self.outlines.len(),
            outlines: outlines.map_or_else(|_| Vec::new(), |(regions, _)| rings_of(&regions)),
            fills: union(self.fills),
            lines: union(self.lines),
            letters: union(self.letters),
        }
    }
}

/// Returns a note on the outlines that are filled although no area of the same paint fills them.
fn filled_outlines(groups: &[(GroupKey, StyledGroup)]) -> Option<DxfNote> {
    let filled = groups.iter().filter(|(_, group)| {
        let by_areas = boolean(&group.outlines, &group.fills, OverlayRule::Intersect);
        area_of(&group.outlines) - area_of(&by_areas) > TOUCHING * area_of(&group.outlines)
    });
    let filled: Vec<_> = filled.collect();
    let ((layer, ..), _) = filled.first()?;
    Some(DxfNote::FilledOutlines {
        count: filled.iter().map(|(_, group)| group.count).sum(),
        layer: layer.to_string(),
    })
}

/// Returns the paint layers of all groups, lowest first.
fn paint_layers(groups: Vec<(GroupKey, StyledGroup)>) -> Vec<PaintLayer> {
    let regions = |rings: &WindingRings| Regions::from_rings(rings, FillRule::NonZero).ok();
    let (mut fills, mut lines, mut letters) = (Vec::new(), Vec::new(), Vec::new());
    for ((layer, rgb, opacity), group) in groups {
        let paint = Some(Paint {
            colour: crate::colour::Rgb(rgb),
            opacity: f64::from_bits(opacity),
        });
        let name = layer.to_string();
        let layer_of = |rings: &WindingRings, is_text: bool| {
            Some(PaintLayer {
                regions: regions(rings)?,
                paint,
                gradient: None,
                line: None,
                name: name.clone(),
                is_text,
            })
        };
        lines.extend(layer_of(&group.lines, false));
        letters.extend(layer_of(&group.letters, true));
        let filled = regions(&union(vec![group.outlines, group.fills]));
        fills.extend(filled.map(|regions| PaintGroup {
            regions,
            paint,
            name: name.clone(),
        }));
    }
    let mut layers = stack_by_containment(&fills);
    layers.extend(lines);
    layers.extend(letters);
    layers
}

/// Returns the rings of regions.
fn rings_of(regions: &Regions) -> Vec<Vec<DVec2>> {
    regions.rings().map(|ring| ring.points().to_vec()).collect()
}
