//! A file's sections: the layers that are seen, the blocks, the objects, and
//! blocks put in their places.

use super::colours::{EntityStyle, LayerColours, from_index, from_rgb_bits};
use super::curve::DxfCurve;
use super::entity::{DxfEntity, DxfRecord, EntityShape};
use super::error::{DxfError, MAX_DEPTH, MAX_OBJECTS};
use super::pairs::{GroupPair, PairReader};
use crate::colour::Rgb;
use glam::{DAffine2, DVec2};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::rc::Rc;

/// Most pairs of one object that are kept, each of some 40 bytes: a spline of a
/// million points has x, y, z and a knot for each.
const MAX_PAIRS: usize = 4_000_000;
/// Most kinds of objects that are told apart as left out: a file can make up a
/// new one for each object.
const MAX_KINDS: usize = 50;

/// A drawing's curves.
#[derive(Default)]
pub(super) struct DxfDrawing {
    /// Each curves one after the other.
    pub paths: Vec<DxfPath>,
    /// How many objects of which kind were left out.
    pub skipped: BTreeMap<String, usize>,
}

/// Curves one after the other.
pub(super) struct DxfPath {
    pub curves: Vec<DxfCurve>,
    /// Whether they close.
    pub is_closed: bool,
    /// The name of its layer, and its colour.
    pub drawn: (Rc<[u8]>, Option<Rgb>),
}

#[derive(Default)]
struct DxfBlock {
    base: DVec2,
    entities: Vec<DxfEntity>,
}

#[derive(Default)]
struct DxfReader {
    hidden_layers: HashSet<Vec<u8>>,
    layers: LayerColours,
    blocks: HashMap<Vec<u8>, DxfBlock>,
    /// The block that is open, and its name.
    open: Option<(Vec<u8>, DxfBlock)>,
    entities: Vec<DxfEntity>,
    objects: usize,
    drawing: DxfDrawing,
}

/// Reads a whole file.
pub(super) fn read(bytes: &[u8]) -> Result<DxfDrawing, DxfError> {
    let mut records = RecordReader::of(bytes)?;
    let mut reader = DxfReader::default();
    // Of the section that is open: whether it is read.
    let mut section = None;
    loop {
        let record = records.next()?;
        match (record.kind, section) {
            (b"SECTION", _) => {
                let read: [&[u8]; 3] = [b"TABLES", b"BLOCKS", b"ENTITIES"];
                section = Some(read.contains(&record.text(2)));
                // A block that was never ended must not swallow what follows.
                reader.open = None;
            }
            (b"ENDSEC", _) => section = None,
            (b"EOF", Some(_)) => return Err(DxfError::Truncated(record.at)),
            (b"EOF", None) => return reader.placed(),
            (_, Some(true)) => reader.take(&record, &mut records)?,
            _ => {}
        }
    }
}

/// Reads one record after the other, with a look at the next.
struct RecordReader<'a> {
    pairs: PairReader<'a>,
    /// The pair that the next record begins with; `None` at the file's end.
    head: Option<GroupPair<'a>>,
}

impl<'a> RecordReader<'a> {
    fn of(bytes: &'a [u8]) -> Result<Self, DxfError> {
        let mut pairs = PairReader::of(bytes);
        let mut head = pairs.next()?;
        while head.is_some_and(|pair| pair.code != 0) {
            head = pairs.next()?;
        }
        Ok(Self { pairs, head })
    }

    /// The next record; at the file's end one of the kind EOF.
    fn next(&mut self) -> Result<DxfRecord<'a>, DxfError> {
        let mut record = DxfRecord {
            kind: self.head.map_or(b"EOF", |head| head.text()),
            at: self.head.map_or(self.pairs.place(), |head| head.at),
            pairs: Vec::new(),
        };
        if record.kind == b"EOF" {
            return Ok(record); // what follows need not be DXF
        }
        loop {
            let at = self.pairs.place();
            self.head = self.pairs.next()?;
            match self.head {
                // Some programs write no EOF behind the last section.
                None if record.kind != b"ENDSEC" => return Err(DxfError::Truncated(at)),
                None | Some(GroupPair { code: 0, .. }) => return Ok(record),
                Some(
                    pair @ GroupPair {
                        code: 2 | 8 | 10..=79 | 210..=239 | 420,
                        ..
                    },
                ) => {
                    record.pairs.push(pair);
                    at_most(record.pairs.len(), MAX_PAIRS)?;
                }
                Some(_) => {}
            }
        }
    }
}

fn at_most(count: usize, most: usize) -> Result<(), DxfError> {
    match count > most {
        true => Err(DxfError::TooMany),
        false => Ok(()),
    }
}

impl DxfReader {
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
                self.keep(record, record.polyline(&vertices)?)?;
            }
            _ => self.keep(record, record.shape()?)?,
        }
        Ok(())
    }

    fn layer(&mut self, record: &DxfRecord) -> Result<(), DxfError> {
        let is_frozen = record.whole(70)? & 1 != 0;
        // The colour, which is negative while the layer is off.
        let number = record.whole(62)?;
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

    /// Takes an object into the block that is open, or into the drawing.
    fn keep(&mut self, record: &DxfRecord, shape: Option<EntityShape>) -> Result<(), DxfError> {
        let is_hidden = record.whole(60)? != 0 || self.hidden_layers.contains(record.text(8));
        let is_on_paper = record.whole(67)? != 0;
        if is_hidden || is_on_paper {
            return Ok(());
        }
        self.count()?;
        let ink = record.ink()?;
        let entity = shape.map(|shape| DxfEntity { shape, ink });
        match (entity, &mut self.open) {
            (Some(entity), Some((_, block))) => block.entities.push(entity),
            (Some(entity), None) => self.entities.push(entity),
            // Layouts, styles and other records without a shape.
            (None, _) if record.text(8).is_empty() => {}
            (None, _) => skip(&mut self.drawing.skipped, record.kind),
        }
        Ok(())
    }

    fn count(&mut self) -> Result<(), DxfError> {
        self.objects += 1;
        at_most(self.objects, MAX_OBJECTS)
    }

    /// All curves, with blocks copied to their places.
    fn placed(self) -> Result<DxfDrawing, DxfError> {
        let mut placing = BlockExpansion {
            blocks: &self.blocks,
            layers: &self.layers,
            steps: 0,
            drawing: self.drawing,
        };
        placing.place(&self.entities, &DAffine2::IDENTITY, None, 0)?;
        Ok(placing.drawing)
    }
}

fn named_block(record: &DxfRecord) -> Result<(Vec<u8>, DxfBlock), DxfError> {
    let base = DVec2::new(record.real(10, 0.0)?, record.real(20, 0.0)?);
    let block = DxfBlock {
        base,
        entities: Vec::new(),
    };
    Ok((record.text(2).to_owned(), block))
}

fn skip(skipped: &mut BTreeMap<String, usize>, kind: &[u8]) {
    let kind: String = String::from_utf8_lossy(kind).chars().take(32).collect();
    if skipped.len() < MAX_KINDS || skipped.contains_key(&kind) {
        *skipped.entry(kind).or_default() += 1;
    }
}

struct BlockExpansion<'b> {
    blocks: &'b HashMap<Vec<u8>, DxfBlock>,
    layers: &'b LayerColours,
    steps: usize,
    drawing: DxfDrawing,
}

impl BlockExpansion<'_> {
    /// Puts objects where `by` says; recurses [`MAX_DEPTH`] levels at most.
    /// `outer` is what the block is drawn with that they are in.
    fn place(
        &mut self,
        entities: &[DxfEntity],
        by: &DAffine2,
        outer: Option<&EntityStyle>,
        depth: usize,
    ) -> Result<(), DxfError> {
        for DxfEntity { shape, ink } in entities {
            let ink = ink.within(outer);
            match shape {
                EntityShape::Path { curves, is_closed } => {
                    self.count(curves.iter().map(DxfCurve::size).sum())?;
                    let curves = curves.iter().map(|curve| curve.moved(by)).collect();
                    let rgb = ink.rgb(self.layers);
                    self.drawing.paths.push(DxfPath {
                        curves,
                        is_closed: *is_closed,
                        drawn: (ink.layer, rgb),
                    });
                }
                EntityShape::Insert { block, places } => match self.blocks.get(block) {
                    None => skip(&mut self.drawing.skipped, b"INSERT"),
                    Some(_) if depth >= MAX_DEPTH => return Err(DxfError::TooDeep),
                    Some(block) => {
                        let to_base = DAffine2::from_translation(-block.base);
                        for place in places {
                            self.count(1)?;
                            // From the right: its base to the origin, to its place, and along with
                            // the block that it is in.
                            let inner = *by * *place * to_base;
                            self.place(&block.entities, &inner, Some(&ink), depth + 1)?;
                        }
                    }
                },
            }
        }
        Ok(())
    }

    fn count(&mut self, steps: usize) -> Result<(), DxfError> {
        // One even for nothing, so that copies of empty blocks come to an end.
        self.steps += 1 + steps;
        at_most(self.steps, 2 * MAX_OBJECTS)
    }
}
