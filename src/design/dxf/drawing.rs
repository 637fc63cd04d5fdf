//! Reads the sections of a DXF file (layers, blocks and entities) and expands block
//! references into curves of the drawing.

use super::colours::{EntityStyle, LayerColours, from_index, from_rgb_bits};
use super::curve::DxfCurve;
use super::entity::{DxfEntity, DxfRecord, EntityShape};
use super::error::{DxfError, MAX_DEPTH, MAX_OBJECTS};
use super::pairs::{GroupPair, PairReader};
use crate::colour::Rgb;
use glam::{DAffine2, DVec2};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::rc::Rc;

/// Maximum number of pairs (group code and value) stored for one entity (resource limit: about 40
/// bytes per pair; a spline has about four pairs per control point, so a million control points
/// fit).
const MAX_PAIRS: usize = 4_000_000;
/// Maximum number of entity types for which ignored entities are counted (resource limit: a hostile
/// file could give every entity a new type).
const MAX_KINDS: usize = 50;

/// Curves of a drawing, and the numbers of ignored entities.
#[derive(Default)]
pub(super) struct DxfDrawing {
    /// Paths with all blocks expanded.
    pub paths: Vec<DxfPath>,
    /// For each type of entity that was ignored: the number of its entities.
    pub skipped: BTreeMap<String, usize>,
}

/// Path of connected curves with its layer and colour.
pub(super) struct DxfPath {
    pub curves: Vec<DxfCurve>,
    /// Whether the last curve ends at the start of the first.
    pub is_closed: bool,
    /// Name of the layer, and the colour if any.
    pub layer_and_colour: (Rc<[u8]>, Option<Rgb>),
}

/// Definition of a block: the entities that each reference to the block copies into the drawing.
#[derive(Default)]
struct DxfBlock {
    /// Point of the block that is placed at the insertion point of a reference.
    base: DVec2,
    entities: Vec<DxfEntity>,
}

/// Layers, blocks and entities of the file that have been read so far. Block references are not yet
/// expanded.
#[derive(Default)]
struct DxfReader {
    /// Names of layers that are frozen or off.
    hidden_layers: HashSet<Vec<u8>>,
    layers: LayerColours,
    /// Blocks by name.
    blocks: HashMap<Vec<u8>, DxfBlock>,
    /// Name and content of the block that is being read; `None` outside of blocks.
    open: Option<(Vec<u8>, DxfBlock)>,
    /// Entities outside of blocks.
    entities: Vec<DxfEntity>,
    /// Number of entities and polyline vertices read, including those in blocks.
    objects: usize,
    drawing: DxfDrawing,
}

/// Reads a DXF file and expands its block references.
pub(super) fn read(bytes: &[u8]) -> Result<DxfDrawing, DxfError> {
    let mut records = RecordReader::of(bytes)?;
    let mut reader = DxfReader::default();
    // `None` between sections; inside a section, whether it is read (`true`) or skipped.
    let mut is_section_read = None;
    loop {
        let record = records.next()?;
        match (record.kind, is_section_read) {
            (b"SECTION", _) => {
                let sections: [&[u8]; 3] = [b"TABLES", b"BLOCKS", b"ENTITIES"];
                is_section_read = Some(sections.contains(&record.text(2)));
                // A block without an end must not absorb the entities of later sections.
                reader.open = None;
            }
            (b"ENDSEC", _) => is_section_read = None,
            (b"EOF", Some(_)) => return Err(DxfError::Truncated(record.at)),
            (b"EOF", None) => return reader.expand_blocks(),
            (_, Some(true)) => reader.take(&record, &mut records)?,
            _ => {}
        }
    }
}

/// Reader of the records of a file. A record is a run of pairs (group code and value) that begins
/// with group code 0. The first pair of the next record has always been read already.
struct RecordReader<'a> {
    pairs: PairReader<'a>,
    /// First pair of the next record; `None` at the end of the file.
    head: Option<GroupPair<'a>>,
}

impl<'a> RecordReader<'a> {
    /// Creates a reader and skips to the first record of the file.
    fn of(bytes: &'a [u8]) -> Result<Self, DxfError> {
        let mut pairs = PairReader::of(bytes);
        let mut head = pairs.next()?;
        while head.is_some_and(|pair| pair.code != 0) {
            head = pairs.next()?;
        }
        Ok(Self { pairs, head })
    }

    /// Returns the next record; at the end of the file, a record of kind EOF.
    fn next(&mut self) -> Result<DxfRecord<'a>, DxfError> {
        let mut record = DxfRecord {
            kind: self.head.map_or(b"EOF", |head| head.text()),
            at: self.head.map_or(self.pairs.place(), |head| head.at),
            pairs: Vec::new(),
        };
        if record.kind == b"EOF" {
            return Ok(record); // data after the EOF record need not be DXF
        }
        loop {
            let at = self.pairs.place();
            self.head = self.pairs.next()?;
            match self.head {
                // Some programs write no EOF record after the last section.
                None if record.kind != b"ENDSEC" => return Err(DxfError::Truncated(at)),
                None | Some(GroupPair { code: 0, .. }) => return Ok(record),
                Some(
                    pair @ GroupPair {
                        code: 2 | 8 | 10..=79 | 210..=239 | 420,
                        ..
                    },
                ) => {
                    record.pairs.push(pair);
                    check_count(record.pairs.len(), MAX_PAIRS)?;
                }
                Some(_) => {}
            }
        }
    }
}

/// Returns an error if a count exceeds its maximum.
fn check_count(count: usize, max: usize) -> Result<(), DxfError> {
    match count > max {
        true => Err(DxfError::TooMany),
        false => Ok(()),
    }
}

impl DxfReader {
    /// Processes a record of one of the sections that are read: TABLES, BLOCKS and ENTITIES.
    fn take(&mut self, record: &DxfRecord, records: &mut RecordReader) -> Result<(), DxfError> {
        match record.kind {
            b"SEQEND" | b"TABLE" | b"ENDTAB" => {}
            b"LAYER" => self.layer(record)?,
            b"BLOCK" => self.open = Some(named_block(record)?),
            b"ENDBLK" => self.blocks.extend(self.open.take()),
            b"POLYLINE" => {
                let mut vertices = Vec::new();
                while records.head.is_some_and(|head| head.text() == b"VERTEX") {
                    self.count()?;
                    vertices.push(records.next()?);
                }
                self.store(record, record.polyline(&vertices)?)?;
            }
            _ => self.store(record, record.shape()?)?,
        }
        Ok(())
    }

    /// Reads a layer: its colour and whether it is hidden.
    fn layer(&mut self, record: &DxfRecord) -> Result<(), DxfError> {
        let is_frozen = record.integer(70)? & 1 != 0;
        // A negative colour number means that the layer is off.
        let number = record.integer(62)?;
        let is_off = number < 0;
        let exact = record.bits()?.map(from_rgb_bits);
        let name = record.text(2).to_owned();
        self.layers
            .insert(name, exact.or_else(|| from_index(number)));
        if is_frozen || is_off {
            self.hidden_layers.insert(record.text(2).to_owned());
        }
        Ok(())
    }

    /// Adds an entity to the open block or to the drawing, unless it is hidden or in paper space.
    /// `shape` is `None` for an unsupported type, which is only counted.
    fn store(&mut self, record: &DxfRecord, shape: Option<EntityShape>) -> Result<(), DxfError> {
        let is_hidden = record.integer(60)? != 0 || self.hidden_layers.contains(record.text(8));
        let is_on_paper = record.integer(67)? != 0;
        if is_hidden || is_on_paper {
            return Ok(());
        }
        self.count()?;
        let ink = record.ink()?;
        let entity = shape.map(|shape| DxfEntity { shape, ink });
        match (entity, &mut self.open) {
            (Some(entity), Some((_, block))) => block.entities.push(entity),
            (Some(entity), None) => self.entities.push(entity),
            // Records without a layer, such as layouts and styles, are not entities, so they are
            // not counted as ignored.
            (None, _) if record.text(8).is_empty() => {}
            (None, _) => skip(&mut self.drawing.skipped, record.kind),
        }
        Ok(())
    }

    /// Counts one entity or polyline vertex; returns an error if there are more than
    /// [`MAX_OBJECTS`].
    fn count(&mut self) -> Result<(), DxfError> {
        self.objects += 1;
        check_count(self.objects, MAX_OBJECTS)
    }

    /// Expands all block references into curves of the drawing.
    fn expand_blocks(self) -> Result<DxfDrawing, DxfError> {
        let mut expansion = BlockExpansion {
            blocks: &self.blocks,
            layers: &self.layers,
            steps: 0,
            drawing: self.drawing,
        };
        expansion.place(&self.entities, &DAffine2::IDENTITY, None, 0)?;
        Ok(expansion.drawing)
    }
}

/// Reads the name and base point of a block.
fn named_block(record: &DxfRecord) -> Result<(Vec<u8>, DxfBlock), DxfError> {
    let base = DVec2::new(record.real(10, 0.0)?, record.real(20, 0.0)?);
    let block = DxfBlock {
        base,
        entities: Vec::new(),
    };
    Ok((record.text(2).to_owned(), block))
}

/// Counts one ignored entity of the type `kind`.
fn skip(skipped: &mut BTreeMap<String, usize>, kind: &[u8]) {
    let kind: String = String::from_utf8_lossy(kind).chars().take(32).collect();
    if skipped.len() < MAX_KINDS || skipped.contains_key(&kind) {
        *skipped.entry(kind).or_default() += 1;
    }
}

/// Recursive expansion of block references: the blocks, and the drawing made so far.
struct BlockExpansion<'b> {
    blocks: &'b HashMap<Vec<u8>, DxfBlock>,
    layers: &'b LayerColours,
    /// Work done so far, counted in steps: one for each path and for each control point of a curve,
    /// and two for each block copy.
    steps: usize,
    drawing: DxfDrawing,
}

impl BlockExpansion<'_> {
    /// Adds entities, transformed by `by`, to the drawing. `outer` is the style of the enclosing
    /// block reference, `depth` the number of enclosing references. Recurses at most [`MAX_DEPTH`]
    /// levels.
    fn place(
        &mut self,
        entities: &[DxfEntity],
        by: &DAffine2,
        outer: Option<&EntityStyle>,
        depth: usize,
    ) -> Result<(), DxfError> {
        for DxfEntity { shape, ink } in entities {
            let ink = ink.inherited_from(outer);
            match shape {
                EntityShape::Path { curves, is_closed } => {
                    self.count(curves.iter().map(DxfCurve::point_count).sum())?;
                    let curves = curves.iter().map(|curve| curve.transformed(by)).collect();
                    let rgb = ink.rgb(self.layers);
                    self.drawing.paths.push(DxfPath {
                        curves,
                        is_closed: *is_closed,
                        layer_and_colour: (ink.layer, rgb),
                    });
                }
                EntityShape::Insert { block, places } => match self.blocks.get(block) {
                    None => skip(&mut self.drawing.skipped, b"INSERT"),
                    Some(_) if depth >= MAX_DEPTH => return Err(DxfError::TooDeep),
                    Some(block) => {
                        let to_base = DAffine2::from_translation(-block.base);
                        for place in places {
                            self.count(1)?;
                            // From right to left, the product moves the base point to the origin,
                            // inserts the block, and applies the outer block's transform.
                            let inner = *by * *place * to_base;
                            self.place(&block.entities, &inner, Some(&ink), depth + 1)?;
                        }
                    }
                },
            }
        }
        Ok(())
    }

    /// Adds `steps` + 1 to [`Self::steps`], the work done so far; returns an error if the sum
    /// exceeds twice [`MAX_OBJECTS`].
    fn count(&mut self, steps: usize) -> Result<(), DxfError> {
        // The additional 1 also limits the number of paths without curves, for which `steps` is 0.
        self.steps += 1 + steps;
        check_count(self.steps, 2 * MAX_OBJECTS)
    }
}
