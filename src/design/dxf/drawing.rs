//! A file's sections: the layers that are seen, the blocks, the objects, and
//! blocks put in their places.

use super::curve::Curve;
use super::entity::{Entity, Record};
use super::error::{DxfError, MAX_DEPTH, MAX_OBJECTS};
use super::pairs::{Pair, Pairs};
use glam::{DAffine2, DVec2};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Most pairs of one object that are kept.
const MAX_PAIRS: usize = 4_000_000;
/// Most kinds of objects that are told apart as left out.
const MAX_KINDS: usize = 50;

/// A drawing's curves.
#[derive(Default)]
pub(super) struct Drawing {
    /// Each curves one after the other, and whether they close.
    pub paths: Vec<(Vec<Curve>, bool)>,
    /// How many objects of which kind were left out.
    pub skipped: BTreeMap<String, usize>,
}

#[derive(Default)]
struct Block {
    base: DVec2,
    entities: Vec<Entity>,
}

#[derive(Default)]
struct Reader {
    hidden_layers: HashSet<Vec<u8>>,
    blocks: HashMap<Vec<u8>, Block>,
    entities: Vec<Entity>,
    objects: usize,
    skipped: BTreeMap<String, usize>,
}

/// Reads a whole file.
pub(super) fn read(bytes: &[u8]) -> Result<Drawing, DxfError> {
    let mut pairs = Pairs::of(bytes);
    let mut reader = Reader::default();
    while let Some(pair) = pairs.next()? {
        match (pair.code, pair.text()) {
            (0, b"SECTION") => reader.section(&mut pairs)?,
            (0, b"EOF") => break,
            _ => {}
        }
    }
    reader.placed()
}

/// The next pair of a section, which must not end without an ENDSEC.
fn inside<'a>(pairs: &mut Pairs<'a>) -> Result<Pair<'a>, DxfError> {
    let at = pairs.place();
    let pair = pairs.next()?.ok_or(DxfError::Truncated(at))?;
    if pair.code == 0 && pair.text() == b"EOF" {
        return Err(DxfError::Truncated(at));
    }
    Ok(pair)
}

impl Reader {
    fn section(&mut self, pairs: &mut Pairs) -> Result<(), DxfError> {
        let name = inside(pairs)?;
        match name.text() {
            b"TABLES" | b"BLOCKS" | b"ENTITIES" => self.records(pairs),
            _ => {
                let is_end = |pair: &Pair| pair.code == 0 && pair.text() == b"ENDSEC";
                while !is_end(&inside(pairs)?) {}
                Ok(())
            }
        }
    }

    /// Reads records up to the end of the section.
    fn records(&mut self, pairs: &mut Pairs) -> Result<(), DxfError> {
        let mut block: Option<(Vec<u8>, Block)> = None;
        let mut polyline: Option<(Record, Vec<Record>)> = None;
        let mut head = first_head(pairs)?;
        loop {
            let (record, next) = record(head, pairs)?;
            match (record.kind, &mut polyline) {
                (b"VERTEX", Some((_, vertices))) => {
                    self.count()?;
                    vertices.push(record);
                }
                (kind, open) => {
                    if let Some((line, vertices)) = open.take() {
                        let entity = line.polyline(&vertices)?;
                        self.keep(&line, entity, block.as_mut())?;
                    }
                    match kind {
                        b"ENDSEC" => return Ok(()),
                        b"POLYLINE" => polyline = Some((record, Vec::new())),
                        b"SEQEND" | b"TABLE" | b"ENDTAB" => {}
                        b"LAYER" => self.layer(&record)?,
                        b"BLOCK" => block = Some(named_block(&record)?),
                        b"ENDBLK" => self.blocks.extend(block.take()),
                        _ => {
                            let entity = record.entity()?;
                            self.keep(&record, entity, block.as_mut())?;
                        }
                    }
                }
            }
            head = next;
        }
    }

    fn layer(&mut self, record: &Record) -> Result<(), DxfError> {
        let is_frozen = record.whole(70)? & 1 != 0;
        let is_off = record.whole(62)? < 0;
        if is_frozen || is_off {
            self.hidden_layers.insert(record.text(2).to_owned());
        }
        Ok(())
    }

    /// Takes an object into the block that is open, or into the drawing.
    fn keep(
        &mut self,
        record: &Record,
        entity: Option<Entity>,
        block: Option<&mut (Vec<u8>, Block)>,
    ) -> Result<(), DxfError> {
        let is_hidden = record.whole(60)? != 0 || self.hidden_layers.contains(record.text(8));
        let is_on_paper = record.whole(67)? != 0;
        if is_hidden || is_on_paper {
            return Ok(());
        }
        self.count()?;
        match (entity, block) {
            (Some(entity), Some((_, block))) => block.entities.push(entity),
            (Some(entity), None) => self.entities.push(entity),
            // Layouts, styles and other records without a shape.
            (None, _) if record.text(8).is_empty() => {}
            (None, _) => skip(&mut self.skipped, record.kind),
        }
        Ok(())
    }

    fn count(&mut self) -> Result<(), DxfError> {
        self.objects += 1;
        match self.objects > MAX_OBJECTS {
            true => Err(DxfError::TooMany),
            false => Ok(()),
        }
    }

    /// All curves, with blocks copied to their places.
    fn placed(self) -> Result<Drawing, DxfError> {
        let mut placing = Placing {
            blocks: &self.blocks,
            steps: 0,
            drawing: Drawing {
                paths: Vec::new(),
                skipped: self.skipped,
            },
        };
        placing.place(&self.entities, &DAffine2::IDENTITY, 0)?;
        Ok(placing.drawing)
    }
}

/// What is yet to be read of the next record: its kind.
type Head<'a> = Pair<'a>;

fn first_head<'a>(pairs: &mut Pairs<'a>) -> Result<Head<'a>, DxfError> {
    loop {
        let pair = inside(pairs)?;
        if pair.code == 0 {
            return Ok(pair);
        }
    }
}

/// A record and the head of the next one; after ENDSEC that is none, and it
/// stands for itself.
fn record<'a>(head: Head<'a>, pairs: &mut Pairs<'a>) -> Result<(Record<'a>, Head<'a>), DxfError> {
    let mut record = Record {
        kind: head.text(),
        at: head.at,
        pairs: Vec::new(),
    };
    if record.kind == b"ENDSEC" {
        return Ok((record, head));
    }
    loop {
        let pair = inside(pairs)?;
        match pair.code {
            0 => return Ok((record, pair)),
            2 | 8 | 10..=79 | 210..=239 => record.pairs.push(pair),
            _ => {}
        }
        if record.pairs.len() > MAX_PAIRS {
            return Err(DxfError::TooMany);
        }
    }
}

fn named_block(record: &Record) -> Result<(Vec<u8>, Block), DxfError> {
    let base = DVec2::new(record.real(10, 0.0)?, record.real(20, 0.0)?);
    let block = Block {
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

struct Placing<'b> {
    blocks: &'b HashMap<Vec<u8>, Block>,
    steps: usize,
    drawing: Drawing,
}

impl Placing<'_> {
    /// Puts objects where `by` says; recurses [`MAX_DEPTH`] levels at most.
    fn place(&mut self, entities: &[Entity], by: &DAffine2, depth: usize) -> Result<(), DxfError> {
        for entity in entities {
            match entity {
                Entity::Path { curves, is_closed } => {
                    self.count(curves.iter().map(Curve::size).sum())?;
                    let curves = curves.iter().map(|curve| curve.moved(by)).collect();
                    self.drawing.paths.push((curves, *is_closed));
                }
                Entity::Insert { block, places } => match self.blocks.get(block) {
                    None => skip(&mut self.drawing.skipped, b"INSERT"),
                    Some(_) if depth >= MAX_DEPTH => return Err(DxfError::TooDeep),
                    Some(block) => {
                        let to_base = DAffine2::from_translation(-block.base);
                        for place in places {
                            self.count(1)?;
                            let inner = *by * *place * to_base;
                            self.place(&block.entities, &inner, depth + 1)?;
                        }
                    }
                },
            }
        }
        Ok(())
    }

    fn count(&mut self, steps: usize) -> Result<(), DxfError> {
        self.steps += 1 + steps;
        match self.steps > 2 * MAX_OBJECTS {
            true => Err(DxfError::TooMany),
            false => Ok(()),
        }
    }
}
