//! Expands block references into the curves and areas of the drawing, with resolved styles.

use super::band::WideBand;
use super::curve::{AreaLoops, DxfCurve};
use super::entity::{BlockReference, DxfEntity, EntityShape};
use super::error::{DxfError, MAX_DEPTH, MAX_OBJECTS, check_count};
use super::report::{EntityRemark, EntityReport};
use super::style::{LayerTable, ResolvedStyle, StyleKey};
use crate::design::note::DxfNote;
use crate::design::unit::LengthUnit;
use crate::geometry::DVec2;
use glam::DAffine2;
use std::collections::HashMap;

/// Definition of a block: the entities that each reference to the block copies into the drawing.
#[derive(Default)]
pub(super) struct DxfBlock {
    /// Point of the block that is placed at the insertion point of a reference.
    pub base: DVec2,
    pub entities: Vec<DxfEntity>,
}

/// Curves and areas of a drawing.
#[derive(Default)]
pub(super) struct DxfDrawing {
    /// Paths with all blocks expanded.
    pub paths: Vec<DxfPath>,
    /// Areas with all blocks expanded.
    pub areas: Vec<DxfArea>,
    /// Different styles of the paths and areas.
    pub styles: Vec<ResolvedStyle>,
    /// Entities that were left out or approximated.
    pub report: EntityReport,
    /// Other notes.
    pub notes: Vec<DxfNote>,
    /// Unit of length that the file declares.
    pub unit: Option<LengthUnit>,
}

/// Path of connected curves.
pub(super) struct DxfPath {
    pub curves: Vec<DxfCurve>,
    /// Whether the last curve ends at the start of the first.
    pub is_closed: bool,
    /// Index of the style.
    pub style: usize,
    /// Position in the order of drawing, which paths and areas share.
    pub order: usize,
}

/// Filled area.
pub(super) struct DxfArea {
    pub shape: AreaShape,
    pub is_text: bool,
    /// Index of the style.
    pub style: usize,
    /// Position in the order of drawing, which paths and areas share.
    pub order: usize,
}

/// Geometry of a filled area.
pub(super) enum AreaShape {
    Loops(AreaLoops),
    Band(WideBand),
}

impl DxfDrawing {
    /// Returns points whose bounding box contains the drawing.
    pub fn hull(&self) -> impl Iterator<Item = DVec2> {
        let paths = self.paths.iter().flat_map(|path| &path.curves);
        let areas = self.areas.iter().flat_map(|area| match &area.shape {
            AreaShape::Loops(area) => area
                .loops
                .iter()
                .flatten()
                .flat_map(DxfCurve::hull)
                .collect(),
            AreaShape::Band(band) => band.hull(),
        });
        paths.flat_map(DxfCurve::hull).chain(areas)
    }
}

/// Recursive expansion of block references: the blocks, and the drawing made so far.
pub(super) struct BlockExpansion<'b> {
    blocks: &'b HashMap<Vec<u8>, DxfBlock>,
    layers: &'b mut LayerTable,
    /// Work done so far, counted in steps: one for each path and for each control point of a curve,
    /// and two for each block copy.
    steps: usize,
    /// Keys of the blocks that are being expanded, the outermost first.
    open: Vec<&'b [u8]>,
    /// Indices of the drawing's styles by their keys.
    style_indices: HashMap<StyleKey, usize>,
    drawing: DxfDrawing,
}

/// Place and style of the block reference that contains an entity.
#[derive(Clone, Copy)]
struct BlockContext<'c> {
    /// Affine map from the block to the drawing.
    by: DAffine2,
    /// Style of the reference; `None` outside of blocks.
    outer: Option<&'c ResolvedStyle>,
}

impl<'b> BlockExpansion<'b> {
    /// Creates an expansion. `report` holds the remarks that reading the file has made.
    pub fn new(
        blocks: &'b HashMap<Vec<u8>, DxfBlock>,
        layers: &'b mut LayerTable,
        report: EntityReport,
    ) -> Self {
        Self {
            blocks,
            layers,
            steps: 0,
            open: Vec::new(),
            style_indices: HashMap::new(),
            drawing: DxfDrawing {
                report,
                ..DxfDrawing::default()
            },
        }
    }

    /// Expands the entities outside of blocks.
    pub fn expand(mut self, entities: &'b [DxfEntity]) -> Result<DxfDrawing, DxfError> {
        let context = BlockContext {
            by: DAffine2::IDENTITY,
            outer: None,
        };
        self.place_all(entities, context)?;
        Ok(self.drawing)
    }

    /// Adds the visible ones of some entities to the drawing. Recurses at most [`MAX_DEPTH`]
    /// levels.
    fn place_all(
        &mut self,
        entities: &'b [DxfEntity],
        context: BlockContext,
    ) -> Result<(), DxfError> {
        for entity in entities {
            self.count(1)?;
            let style = self.layers.resolve(&entity.style, context.outer);
            // A block reference is hidden only by its own flag or a frozen layer; the entities of
            // the block have layers of their own.
            let is_hidden = match entity.shape {
                EntityShape::Insert(_) => style.is_invisible || style.is_frozen,
                _ => !style.is_visible,
            };
            if is_hidden {
                continue;
            }
            if let Some(remark) = &entity.remark {
                self.drawing.report.add(remark, &style.layer);
            }
            if let Some(font) = &entity.font {
                self.drawing.report.add_font(font);
            }
            self.place(&entity.shape, context, &style)?;
        }
        Ok(())
    }

    /// Adds a shape to the drawing.
    fn place(
        &mut self,
        shape: &'b EntityShape,
        context: BlockContext,
        style: &ResolvedStyle,
    ) -> Result<(), DxfError> {
        let by = context.by;
        let order = self.drawing.paths.len() + self.drawing.areas.len();
        let placed = |curves: &[DxfCurve]| curves.iter().map(|c| c.transformed(&by)).collect();
        let area = match shape {
            EntityShape::Nothing => return Ok(()),
            EntityShape::Path { curves, is_closed } => {
                self.count_points(curves)?;
                let style = self.style_index(style);
                self.drawing.paths.push(DxfPath {
                    curves: placed(curves),
                    is_closed: *is_closed,
                    style,
                    order,
                });
                return Ok(());
            }
            EntityShape::Group(shapes) => {
                let mut shapes = shapes.iter();
                return shapes.try_for_each(|shape| self.place(shape, context, style));
            }
            EntityShape::Insert(reference) => return self.insert(reference, context, style),
            EntityShape::Area(area) | EntityShape::Letters(area) => {
                self.count_points(area.loops.iter().flatten())?;
                AreaShape::Loops(AreaLoops {
                    loops: area.loops.iter().map(|curves| placed(curves)).collect(),
                    rule: area.rule,
                })
            }
            EntityShape::Band(band) => {
                self.count_points(&band.curves)?;
                AreaShape::Band(WideBand {
                    place: by * band.place,
                    ..band.clone()
                })
            }
        };
        let style = self.style_index(style);
        self.drawing.areas.push(DxfArea {
            shape: area,
            is_text: matches!(shape, EntityShape::Letters(_)),
            style,
            order,
        });
        Ok(())
    }

    /// Adds the copies of a block to the drawing.
    fn insert(
        &mut self,
        reference: &'b BlockReference,
        context: BlockContext,
        style: &ResolvedStyle,
    ) -> Result<(), DxfError> {
        let fault = match self.blocks.get_key_value(&reference.block) {
            None => "left out: its block is not defined",
            Some((key, _)) if self.open.contains(&key.as_slice()) => {
                "left out: its block contains itself"
            }
            Some(_) if self.open.len() >= MAX_DEPTH => "left out: its blocks are nested too deeply",
            Some((key, block)) => {
                return self.insert_copies(reference, (key, block), context, style);
            }
        };
        let remark = EntityRemark {
            kind: reference.kind.clone(),
            what: fault.into(),
            at: reference.at,
            handle: String::new(),
        };
        self.drawing.report.add(&remark, &style.layer);
        Ok(())
    }

    fn insert_copies(
        &mut self,
        reference: &'b BlockReference,
        (key, block): (&'b Vec<u8>, &'b DxfBlock),
        context: BlockContext,
        style: &ResolvedStyle,
    ) -> Result<(), DxfError> {
        let base = if reference.uses_base_point {
            block.base
        } else {
            DVec2::ZERO
        };
        self.open.push(key);
        for place in &reference.places {
            self.count(1)?;
            // From right to left, the product moves the base point to the origin, inserts the
            // block, and applies the outer block's transform.
            let inner = BlockContext {
                by: context.by * *place * DAffine2::from_translation(-base),
                outer: Some(style),
            };
            self.place_all(&block.entities, inner)?;
        }
        self.open.pop();
        Ok(())
    }

    /// Returns the index of a style in the drawing; adds the style if it is new.
    fn style_index(&mut self, style: &ResolvedStyle) -> usize {
        let styles = &mut self.drawing.styles;
        *self.style_indices.entry(style.key()).or_insert_with(|| {
            styles.push(style.clone());
            styles.len() - 1
        })
    }

    /// Counts the control points of curves.
    fn count_points<'c>(
        &mut self,
        curves: impl IntoIterator<Item = &'c DxfCurve>,
    ) -> Result<(), DxfError> {
        self.count(curves.into_iter().map(DxfCurve::point_count).sum())
    }

    /// Adds `steps` + 1 to [`Self::steps`], the work done so far; returns an error if the sum
    /// exceeds four times [`MAX_OBJECTS`].
    fn count(&mut self, steps: usize) -> Result<(), DxfError> {
        self.steps += 1 + steps;
        check_count(self.steps, 4 * MAX_OBJECTS)
    }
}
