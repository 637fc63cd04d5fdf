//! Records of a DXF file: entities, table entries and section heads, each with its pairs of group
//! code and value.

use super::error::{DxfError, EntityFault, check_count};
use super::pairs::{GroupPair, PairReader};
use super::report::EntityRemark;
use crate::design::note::DxfPlace;
use crate::geometry::DVec2;
use glam::{DAffine2, DMat2, DVec3};
use std::borrow::Cow;

/// Maximum number of pairs (group code and value) stored for one record (resource limit: about 40
/// bytes per pair; a spline has about four pairs per control point, so a million control points
/// fit).
const MAX_PAIRS: usize = 4_000_000;

/// Record of the file: an entity or table entry with its pairs of group code and value.
pub(super) struct DxfRecord<'a> {
    /// Type name, such as `LINE`.
    pub kind: &'a [u8],
    /// Position of the record in the file.
    pub at: DxfPlace,
    pub pairs: Vec<GroupPair<'a>>,
    /// Whether an MTEXT has columns, which an embedded object describes.
    pub has_columns: bool,
}

impl<'a> DxfRecord<'a> {
    /// Returns the first pair with the group code `code`.
    pub fn first(&self, code: i32) -> Option<&GroupPair<'a>> {
        self.pairs.iter().find(|pair| pair.code == code)
    }

    /// Returns the first real number with the group code `code`, or `default` if there is none.
    pub fn real(&self, code: i32, default: f64) -> Result<f64, EntityFault> {
        self.first(code).map_or(Ok(default), GroupPair::real)
    }

    /// Returns the first integer with the group code `code`, or `default` if there is none.
    pub fn integer_or(&self, code: i32, default: i64) -> Result<i64, EntityFault> {
        self.first(code).map_or(Ok(default), GroupPair::integer)
    }

    /// Returns the first integer with the group code `code`, or 0 if there is none.
    pub fn integer(&self, code: i32) -> Result<i64, EntityFault> {
        self.integer_or(code, 0)
    }

    /// Returns the first text with the group code `code`, or an empty text if there is none.
    pub fn text(&self, code: i32) -> &'a [u8] {
        self.first(code).map_or(b"", GroupPair::text)
    }

    /// Returns the handle of the record; `None` if it has none.
    pub fn handle(&self) -> Option<u64> {
        self.first(5).and_then(GroupPair::handle)
    }

    /// Returns the point whose x, y and z have the group codes `code`, `code + 10` and `code + 20`.
    pub fn point(&self, code: i32) -> Result<DVec3, EntityFault> {
        Ok(DVec3::new(
            self.real(code, 0.0)?,
            self.real(code + 10, 0.0)?,
            self.real(code + 20, 0.0)?,
        ))
    }

    /// Returns the point with the group code `code`, or `None` if the record has none.
    pub fn optional_point(&self, code: i32) -> Result<Option<DVec3>, EntityFault> {
        self.first(code).map(|_| self.point(code)).transpose()
    }

    /// Returns all real numbers with the group code `code`, in file order.
    pub fn reals(&self, code: i32) -> Result<Vec<f64>, EntityFault> {
        let pairs = self.pairs.iter().filter(|pair| pair.code == code);
        pairs.map(GroupPair::real).collect()
    }

    /// Returns all points whose x has the group code `code` and whose y has `code + 10`.
    pub fn points(&self, code: i32) -> Result<Vec<DVec2>, EntityFault> {
        points(&self.pairs, code)
    }

    /// Returns the extrusion direction as a unit vector; +z if it has no length.
    pub fn normal(&self) -> Result<DVec3, EntityFault> {
        // The z component of the direction defaults to 1, that of other points to 0.
        let z = self.real(230, 1.0)?;
        let given = self.point(210)?.with_z(z);
        Ok(given.try_normalize().unwrap_or(DVec3::Z))
    }

    /// Returns the affine map to the xy plane of the drawing from the plane z = `elevation` of the
    /// entity's own coordinate system.
    ///
    /// The axes of that system follow from the extrusion direction by the "arbitrary axis
    /// algorithm" of the DXF Reference. The entity is projected onto the xy plane.
    pub fn plane_map(&self, elevation: f64) -> Result<DAffine2, EntityFault> {
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

    /// Returns a remark on the entity.
    pub fn remark(&self, what: impl Into<Cow<'static, str>>) -> EntityRemark {
        let text = |bytes: &[u8]| -> String {
            let text = String::from_utf8_lossy(bytes);
            text.chars().take(MAX_NAME_CHARS).collect()
        };
        EntityRemark {
            kind: text(self.kind),
            what: what.into(),
            at: self.at,
            handle: text(self.text(5)),
        }
    }
}

/// Maximum number of characters of a type name or a handle that a remark keeps (resource limit).
const MAX_NAME_CHARS: usize = 32;

/// Returns all points of a list of pairs whose x has the group code `code` and whose y has
/// `code + 10`.
pub(super) fn points(pairs: &[GroupPair], code: i32) -> Result<Vec<DVec2>, EntityFault> {
    let reals = |code: i32| -> Result<Vec<f64>, EntityFault> {
        let pairs = pairs.iter().filter(|pair| pair.code == code);
        pairs.map(GroupPair::real).collect()
    };
    let (xs, ys) = (reals(code)?, reals(code + 10)?);
    if xs.len() != ys.len() {
        return Err("a point lacks its x or y coordinate".into());
    }
    Ok(xs.into_iter().zip(ys).map(DVec2::from).collect())
}

/// Reader of the records of a file. A record is a run of pairs (group code and value) that begins
/// with group code 0. The first pair of the next record has always been read already.
pub(super) struct RecordReader<'a> {
    pairs: PairReader<'a>,
    /// First pair of the next record; `None` at the end of the file.
    head: Option<GroupPair<'a>>,
}

impl<'a> RecordReader<'a> {
    /// Creates a reader and skips to the first record of the file.
    pub fn of(bytes: &'a [u8]) -> Result<Self, DxfError> {
        let mut pairs = PairReader::of(bytes);
        let mut head = pairs.next()?;
        while head.is_some_and(|pair| pair.code != 0) {
            head = pairs.next()?;
        }
        Ok(Self { pairs, head })
    }

    /// Returns the type name of the next record; empty at the end of the file.
    pub fn next_kind(&self) -> &'a [u8] {
        self.head.map_or(b"", |head| head.text())
    }

    /// Returns the next record; at the end of the file, a record of kind EOF.
    pub fn next(&mut self) -> Result<DxfRecord<'a>, DxfError> {
        let mut record = DxfRecord {
            kind: self.head.map_or(b"EOF", |head| head.text()),
            at: self.head.map_or(self.pairs.place(), |head| head.at),
            pairs: Vec::new(),
            has_columns: false,
        };
        if record.kind == b"EOF" {
            return Ok(record); // data after the EOF record need not be DXF
        }
        // An object that is embedded in an entity has group codes of its own.
        let mut is_embedded = false;
        loop {
            let at = self.pairs.place();
            self.head = self.pairs.next()?;
            match self.head {
                // Some programs write no EOF record after the last section.
                None if record.kind != b"ENDSEC" => return Err(DxfError::Truncated(at)),
                None | Some(GroupPair { code: 0, .. }) => return Ok(record),
                Some(pair) if pair.code == 101 => is_embedded = true,
                Some(pair) if !is_embedded && is_stored(pair.code) => {
                    record.pairs.push(pair);
                    check_count(record.pairs.len(), MAX_PAIRS)?;
                }
                Some(pair) => record.has_columns |= is_column_type(record.kind, &pair),
            }
        }
    }
}

/// Returns whether a pair of an embedded object is the type of the columns of an MTEXT.
fn is_column_type(kind: &[u8], pair: &GroupPair) -> bool {
    kind == b"MTEXT" && pair.code == 71 && pair.integer().is_ok_and(|kind| kind > 0)
}

/// Returns whether the importer uses pairs with this group code.
fn is_stored(code: i32) -> bool {
    matches!(
        code,
        1..=99 | 100 | 210..=239 | 331 | 370 | 420..=429 | 440 | 450..=469 | 1001 | 1071
    )
}
