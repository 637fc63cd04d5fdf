//! Reads the sections of a DXF file: header, layers, text styles, blocks and entities.

use super::encoding::decode;
use super::entity::{DxfEntity, EntityShape, MULTILINE_REMARK};
use super::error::{DxfError, EntityFault, MAX_OBJECTS, check_count};
use super::expansion::{BlockExpansion, DxfBlock, DxfDrawing};
use super::record::{DxfRecord, RecordReader};
use super::report::EntityReport;
use super::style::{EntityStyle, LayerTable, name_key};
use super::text::TextReader;
use crate::design::note::DxfNote;
use crate::design::unit::LengthUnit;
use std::collections::HashMap;

/// Section of a DXF file.
#[derive(Clone, Copy, PartialEq)]
enum DxfSection {
    Tables,
    Blocks,
    Entities,
    Objects,
    /// A section that is skipped.
    Other,
}

/// Layers, blocks and entities of the file that have been read so far. Block references are not yet
/// expanded.
struct DxfReader {
    layers: LayerTable,
    texts: TextReader,
    /// Blocks by the keys of their names.
    blocks: HashMap<Vec<u8>, DxfBlock>,
    /// Key and content of the block that is being read; `None` outside of blocks.
    open: Option<(Vec<u8>, DxfBlock)>,
    /// Entities outside of blocks.
    entities: Vec<DxfEntity>,
    /// Style of the last block reference, to which the attributes after it belong.
    reference: EntityStyle,
    /// Handles that replace those of entities in the order of drawing (SORTENTSTABLE).
    sort_handles: HashMap<u64, u64>,
    /// Number of entities and polyline vertices read, including those in blocks.
    objects: usize,
    report: EntityReport,
    unit: Option<LengthUnit>,
    /// Code page that the header names.
    code_page: String,
    /// Whether a style of MLINE entities has caps or a fill.
    has_multiline_caps: bool,
}

/// Reads a DXF file and expands its block references. `tolerance` is the maximum deviation of
/// flattened letters, as a fraction of their height.
pub(super) fn read(bytes: &[u8], tolerance: f64) -> Result<DxfDrawing, DxfError> {
    let mut records = RecordReader::of(bytes)?;
    let mut reader = DxfReader {
        layers: LayerTable::default(),
        texts: TextReader::new(tolerance),
        blocks: HashMap::new(),
        open: None,
        entities: Vec::new(),
        reference: EntityStyle::default(),
        sort_handles: HashMap::new(),
        objects: 0,
        report: EntityReport::default(),
        unit: None,
        code_page: String::new(),
        has_multiline_caps: false,
    };
    // `None` between sections.
    let mut section = None;
    loop {
        let record = records.next()?;
        match (record.kind, section) {
            (b"SECTION", _) => section = Some(reader.section(&record)),
            (b"ENDSEC", _) => section = None,
            (b"EOF", Some(_)) => return Err(DxfError::Truncated(record.at)),
            (b"EOF", None) => return reader.into_drawing(bytes),
            (_, Some(DxfSection::Tables)) => reader.table_entry(&record),
            (_, Some(DxfSection::Blocks | DxfSection::Entities)) => {
                reader.entity(&record, &mut records)?;
            }
            (b"SPATIAL_FILTER", Some(DxfSection::Objects)) => {
                let what = "ignored: the block is drawn without its clipping boundary";
                reader.report.add(&record.remark(what), "0");
            }
            (b"SORTENTSTABLE", Some(DxfSection::Objects)) => reader.sort_table(&record),
            (b"MLINESTYLE", Some(DxfSection::Objects)) => {
                let flags = record.integer(70).unwrap_or(0);
                // Flag 2 shows mitres at the corners; all others are caps or a fill.
                reader.has_multiline_caps |= flags & !2 != 0;
            }
            _ => {}
        }
    }
}

impl DxfReader {
    /// Begins a section. The variables of the header are part of its first record.
    fn section(&mut self, record: &DxfRecord) -> DxfSection {
        // A block without an end must not absorb the entities of later sections.
        self.open = None;
        match record.text(2) {
            b"HEADER" => {
                self.header(record);
                DxfSection::Other
            }
            b"TABLES" => DxfSection::Tables,
            b"BLOCKS" => DxfSection::Blocks,
            b"ENTITIES" => DxfSection::Entities,
            b"OBJECTS" => DxfSection::Objects,
            _ => DxfSection::Other,
        }
    }

    /// Reads the variables of the header: each is a name (group code 9) and its values.
    fn header(&mut self, record: &DxfRecord) {
        for variable in record.pairs.windows(2) {
            let value = &variable[1];
            match (variable[0].code, variable[0].text()) {
                (9, b"$INSUNITS") => {
                    let code = value.integer().ok();
                    self.unit = code.and_then(LengthUnit::from_dxf_code);
                }
                (9, b"$DWGCODEPAGE") => self.code_page = decode(value.text()),
                _ => {}
            }
        }
    }

    /// Reads an entry of a table: a layer or a text style.
    fn table_entry(&mut self, record: &DxfRecord) {
        match record.kind {
            b"LAYER" => {
                if let Err(fault) = self.layers.add(record) {
                    let what = "ignored: the layer is visible and black because";
                    self.report_fault(record, what, fault, &decode(record.text(2)));
                }
            }
            b"STYLE" => self.texts.add_style(record),
            _ => {}
        }
    }

    /// Reads a table of the order of drawing: pairs of the handle of an entity (group code 331) and
    /// the handle that replaces it (5).
    fn sort_table(&mut self, record: &DxfRecord) {
        let mut entity = None;
        for pair in &record.pairs {
            match pair.code {
                331 => entity = pair.handle(),
                5 => {
                    let replaced = entity.take().zip(pair.handle());
                    self.sort_handles.extend(replaced);
                }
                _ => {}
            }
        }
    }

    /// Reads a record of the sections BLOCKS and ENTITIES.
    fn entity(&mut self, record: &DxfRecord, records: &mut RecordReader) -> Result<(), DxfError> {
        match record.kind {
            // A VIEWPORT shows the model in a layout; it has no content of its own.
            b"SEQEND" | b"VERTEX" | b"VIEWPORT" => {}
            // Definition points of dimensions are not plotted.
            b"POINT" if record.text(8).eq_ignore_ascii_case(b"DEFPOINTS") => {}
            b"BLOCK" => self.open = Some(self.named_block(record)),
            b"ENDBLK" => self.blocks.extend(self.open.take()),
            b"POLYLINE" => {
                let mut vertices = Vec::new();
                while records.next_kind() == b"VERTEX" {
                    self.count()?;
                    vertices.push(records.next()?);
                }
                self.store(record, &vertices)?;
            }
            _ => self.store(record, &[])?,
        }
        Ok(())
    }

    /// Reads the name and base point of a block.
    fn named_block(&mut self, record: &DxfRecord) -> (Vec<u8>, DxfBlock) {
        let base = record.point(10).unwrap_or_else(|fault| {
            let what = "placed by the origin instead of its base point because";
            self.report_fault(record, what, fault, "0");
            glam::DVec3::ZERO
        });
        let block = DxfBlock {
            base: base.truncate(),
            entities: Vec::new(),
        };
        (name_key(record.text(2)), block)
    }

    /// Adds an entity to the open block or to the drawing, unless it is in paper space.
    fn store(&mut self, record: &DxfRecord, vertices: &[DxfRecord]) -> Result<(), DxfError> {
        self.count()?;
        let is_on_paper = record.integer(67).is_ok_and(|flag| flag != 0);
        if is_on_paper && self.open.is_none() {
            let what = "left out: it lies in paper space, not in the model";
            self.report
                .add(&record.remark(what), &decode(record.text(8)));
            return Ok(());
        }
        let entity = match self.converted(record, vertices) {
            Ok(Some(entity)) => entity,
            Ok(None) => return Ok(()),
            Err(EntityFault { at, reason }) => {
                let mut remark = record.remark(format!("left out: {reason}"));
                remark.at = at.unwrap_or(remark.at);
                DxfEntity {
                    shape: EntityShape::Nothing,
                    style: EntityStyle::of(record),
                    remark: Some(Box::new(remark)),
                    font: None,
                    handle: record.handle(),
                }
            }
        };
        match &mut self.open {
            Some((_, block)) => block.entities.push(entity),
            None => self.entities.push(entity),
        }
        Ok(())
    }

    /// Converts an entity; returns `None` if it is invisible by design.
    fn converted(
        &mut self,
        record: &DxfRecord,
        vertices: &[DxfRecord],
    ) -> Result<Option<DxfEntity>, EntityFault> {
        let (mut style, mut remark) = record.style_and_remark()?;
        let mut font = None;
        match record.kind {
            b"INSERT" => self.reference = style.clone(),
            b"ATTRIB" => style = style.of_attribute(&self.reference),
            _ => {}
        }
        let shape = match record.kind {
            b"TEXT" | b"MTEXT" | b"ATTRIB" | b"ATTDEF" => {
                let Some(text) = self.texts.text(record, self.open.is_some())? else {
                    return Ok(None);
                };
                remark = text.remark.map(|what| record.remark(what));
                font = text.font;
                Ok(text.shape)
            }
            b"POLYLINE" => record.polyline(vertices)?,
            _ => record.shape()?,
        };
        let shape = shape.unwrap_or_else(|reason| {
            remark = Some(record.remark(reason));
            EntityShape::Nothing
        });
        Ok(Some(DxfEntity {
            shape,
            style,
            remark: remark.map(Box::new),
            font,
            handle: record.handle(),
        }))
    }

    fn report_fault(
        &mut self,
        record: &DxfRecord,
        what: &'static str,
        fault: EntityFault,
        layer: &str,
    ) {
        let mut remark = record.remark(format!("{what} {}", fault.reason));
        remark.at = fault.at.unwrap_or(remark.at);
        self.report.add(&remark, layer);
    }

    /// Counts one entity or polyline vertex; returns an error if there are more than
    /// [`MAX_OBJECTS`].
    fn count(&mut self) -> Result<(), DxfError> {
        self.objects += 1;
        check_count(self.objects, MAX_OBJECTS)
    }

    /// Expands all block references. `bytes` is the whole file.
    fn into_drawing(mut self, bytes: &[u8]) -> Result<DxfDrawing, DxfError> {
        let is_decoded = matches!(&*self.code_page, "" | "ANSI_1252" | "ascii" | "UTF-8")
            || std::str::from_utf8(bytes).is_ok()
            || bytes.starts_with(super::BINARY);
        let code_page = (!is_decoded).then_some(DxfNote::CodePage(self.code_page));
        let blocks = self.blocks.values_mut().map(|block| &mut block.entities);
        for entities in blocks.chain([&mut self.entities]) {
            sort_for_drawing(entities, &self.sort_handles);
        }
        let expansion = BlockExpansion::new(&self.blocks, &mut self.layers, self.report);
        let mut drawing = expansion.expand(&self.entities)?;
        if !self.has_multiline_caps {
            drawing.report.remove("MLINE", MULTILINE_REMARK);
        }
        drawing.unit = self.unit;
        drawing.notes.extend(code_page);
        Ok(drawing)
    }
}

/// Sorts entities in the order of drawing: by their handles, some of which a table replaces.
/// Without such handles, they are drawn in the order of the file.
fn sort_for_drawing(entities: &mut [DxfEntity], sort_handles: &HashMap<u64, u64>) {
    let replaced = |entity: &DxfEntity| sort_handles.get(&entity.handle?).copied();
    let has_all = entities.iter().all(|entity| entity.handle.is_some());
    if has_all && entities.iter().any(|entity| replaced(entity).is_some()) {
        entities.sort_by_key(|entity| replaced(entity).or(entity.handle));
    }
}
