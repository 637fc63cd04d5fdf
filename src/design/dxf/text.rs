//! TEXT, MTEXT, ATTRIB and ATTDEF as outlines in the bundled font.
//!
//! The text height is the height of capital letters. Baselines of MTEXT are 5/3 of the text height
//! apart (Autodesk, DXF Reference: MTEXT, line spacing). Inline formatting of MTEXT is removed and
//! reported; fonts other than the bundled one are replaced and reported.

use super::curve::{AreaLoops, DxfCurve};
use super::encoding::decode;
use super::entity::EntityShape;
use super::error::EntityFault;
use super::inline_codes::{plain_mtext, plain_text};
use super::record::DxfRecord;
use super::style::name_key;
use crate::design::lettering::{LetterHeights, LetteredLine, LineFont};
use crate::geometry::{DVec2, FillRule};
use glam::{DAffine2, DMat2};
use std::collections::HashMap;
use std::rc::Rc;

/// Distance of neighbouring baselines of MTEXT, as a fraction of the text height (DXF Reference).
const LINE_SPACING: f64 = 5.0 / 3.0;

/// Maximum number of characters of all texts of a file (resource limit: a hundred pages).
const MAX_CHARS: usize = 200_000;

/// File name of the bundled font, in capitals; text in this font is drawn exactly.
const BUNDLED_NAME: &str = "ROBOTO-BOLD.TTF";

/// Font file of the text style that a drawing without text styles uses.
const DEFAULT_FONT: &str = "txt";

/// Text style: properties of a STYLE table entry.
struct TextStyle {
    /// Name of the font file.
    font: Rc<str>,
    /// Factor of the widths of letters; MTEXT has none of its own.
    width: f64,
    /// Slant in degrees; MTEXT has none of its own.
    oblique: f64,
}

/// Converts texts to outlines.
pub(super) struct TextReader {
    styles: HashMap<Vec<u8>, TextStyle>,
    font: Option<LineFont>,
    /// Number of characters converted so far.
    characters: usize,
    /// Maximum deviation of flattened curves, as a fraction of the em.
    tolerance: f64,
}

/// Converted text.
pub(super) struct DrawnText {
    pub shape: EntityShape,
    /// Name of the font that was replaced by the bundled one, if any.
    pub font: Option<Rc<str>>,
    /// Approximation, as worded in a note.
    pub remark: Option<String>,
}

/// Lines of a text in their own coordinate system, in units of the font.
struct TextBlock {
    lines: Vec<LetteredLine>,
    /// Distance of neighbouring baselines.
    leading: f64,
    /// Fraction of its width by which a line is moved to the left.
    align_x: f64,
    /// Height, relative to the first baseline, that is placed at the insertion point.
    anchor_y: f64,
}

impl TextReader {
    /// Creates a reader without text styles.
    pub fn new(tolerance: f64) -> Self {
        Self {
            styles: HashMap::new(),
            font: LineFont::bundled().ok(),
            characters: 0,
            tolerance,
        }
    }

    /// Adds the text style of a STYLE record.
    pub fn add_style(&mut self, record: &DxfRecord) {
        let style = TextStyle {
            font: decode(record.text(3)).into(),
            width: record.real(41, 1.0).unwrap_or(1.0),
            oblique: record.real(50, 0.0).unwrap_or(0.0),
        };
        self.styles.insert(name_key(record.text(2)), style);
    }

    /// Converts a TEXT, ATTRIB, ATTDEF or MTEXT. `is_in_block` says whether the entity belongs to
    /// the definition of a block. Returns `None` if the text is invisible by design.
    pub fn text(
        &mut self,
        record: &DxfRecord,
        is_in_block: bool,
    ) -> Result<Option<DrawnText>, EntityFault> {
        let flags = record.integer(70)?;
        let words = match record.kind {
            // Flag 1 hides an attribute. Definitions of attributes are replaced by attributes,
            // unless they are constant (flag 2).
            b"ATTRIB" | b"ATTDEF" if flags & 1 != 0 => return Ok(None),
            b"ATTDEF" if is_in_block && flags & 2 == 0 => return Ok(None),
            b"ATTDEF" if !is_in_block => record.text(2),
            _ => record.text(1),
        };
        let style = name_key(record.text(7));
        let style = self
            .styles
            .get(&style)
            .or_else(|| self.styles.get(&b"STANDARD"[..]));
        let font = style.map(|style| Rc::clone(&style.font));
        let font = font
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| DEFAULT_FONT.into());
        let mut remarks = Vec::new();
        let shape = if record.kind == b"MTEXT" {
            let chunks = record
                .pairs
                .iter()
                .filter(|pair| matches!(pair.code, 1 | 3));
            let all: Vec<u8> = chunks.flat_map(|pair| pair.text()).copied().collect();
            let (text, has_codes) = plain_mtext(&decode(&all));
            if has_codes {
                remarks.push("drawn without its inline formatting".to_owned());
            }
            let fill = record.integer(90)?;
            if fill & 3 != 0 {
                remarks.push("drawn without its background".to_owned());
            }
            if fill & 16 != 0 {
                remarks.push("drawn without its frame".to_owned());
            }
            if record.has_columns {
                remarks.push("drawn without its columns".to_owned());
            }
            let stretch = style.map_or([1.0, 0.0], |style| [style.width, style.oblique]);
            self.paragraphs(record, &text, stretch, &mut remarks)?
        } else {
            self.single_line(record, &plain_text(&decode(words)), &mut remarks)?
        };
        let remark = (!remarks.is_empty()).then(|| remarks.join(", "));
        Ok(shape.map(|shape| DrawnText {
            shape,
            font: (!font.eq_ignore_ascii_case(BUNDLED_NAME)).then_some(font),
            remark,
        }))
    }

    /// Converts one line of text to polygons; characters without a glyph are left out and counted
    /// in `missing`.
    fn line(&mut self, text: &str, missing: &mut usize) -> Result<LetteredLine, EntityFault> {
        let font = self
            .font
            .as_ref()
            .ok_or("the bundled font cannot be read")?;
        self.characters += text.chars().count();
        if self.characters > MAX_CHARS {
            return Err("the drawing has too much text".into());
        }
        let known: String = text.chars().filter(|&c| font.has_glyph(c)).collect();
        *missing += text.chars().count() - known.chars().count();
        let line = font.line(&known, self.tolerance);
        line.map_err(|_| "its letters cannot be drawn".into())
    }

    /// Returns the heights of letters in units of the font.
    fn heights(&self) -> Result<LetterHeights, EntityFault> {
        let font = self.font.as_ref();
        Ok(font.ok_or("the bundled font cannot be read")?.heights)
    }

    /// Converts a TEXT, ATTRIB or ATTDEF.
    fn single_line(
        &mut self,
        record: &DxfRecord,
        text: &str,
        remarks: &mut Vec<String>,
    ) -> Result<Option<EntityShape>, EntityFault> {
        let mut missing = 0;
        let line = self.line(text, &mut missing)?;
        remarks.extend(missing_remark(missing));
        let heights = self.heights()?;
        let vertical_code = if record.kind == b"TEXT" { 73 } else { 74 };
        let (across, up) = (record.integer(72)?, record.integer(vertical_code)?);
        let block = TextBlock {
            leading: 0.0,
            align_x: match across {
                1 | 4 => 0.5,
                2 => 1.0,
                _ => 0.0,
            },
            anchor_y: match (across, up) {
                // "Middle" is halfway up the small letters, "middle left" and the like halfway up
                // the capitals.
                (4, _) => 0.5 * heights.x,
                (_, 1) => -heights.descent,
                (_, 2) => 0.5 * heights.cap,
                (_, 3) => heights.cap,
                _ => 0.0,
            },
            lines: vec![line],
        };
        let ends = [
            record.point(10)?,
            record.optional_point(11)?.unwrap_or(record.point(10)?),
        ];
        let is_spanned = matches!(across, 3 | 5);
        let anchor = ends[usize::from(!is_spanned && (across, up) != (0, 0))];
        let span = ends[1].truncate() - ends[0].truncate();
        let scale = positive_height(record)? / heights.cap;
        let mut stretch = DVec2::splat(scale) * DVec2::new(record.real(41, 1.0)?, 1.0);
        let mut turn = record.real(50, 0.0)?.to_radians();
        if is_spanned && span.length() > 0.0 && block.lines[0].width > 0.0 {
            turn = span.to_angle();
            stretch.x = span.length() / block.lines[0].width;
            if across == 3 {
                stretch.y = stretch.x;
            }
        }
        let flags = record.integer(71)?;
        let mirrored = DVec2::new(sign_of(flags & 2), sign_of(flags & 4));
        let oblique = slant(record.real(51, 0.0)?);
        let own = DMat2::from_angle(turn) * DMat2::from_diagonal(mirrored * stretch) * oblique;
        let plan = record.plane_map(anchor.z)?;
        let place = plan * DAffine2::from_mat2_translation(own, anchor.truncate());
        Ok(block.letters(&place))
    }

    /// Converts an MTEXT. `stretch` is the width factor and the slant of its text style.
    fn paragraphs(
        &mut self,
        record: &DxfRecord,
        text: &str,
        [width_factor, oblique]: [f64; 2],
        remarks: &mut Vec<String>,
    ) -> Result<Option<EntityShape>, EntityFault> {
        let heights = self.heights()?;
        let scale = positive_height(record)? / heights.cap;
        let column = record.real(41, 0.0)? / (scale * width_factor.max(f64::MIN_POSITIVE));
        let mut missing = 0;
        let mut lines = Vec::new();
        for paragraph in text.split('\n') {
            self.wrap(paragraph, column, &mut lines, &mut missing)?;
        }
        remarks.extend(missing_remark(missing));
        let leading = LINE_SPACING * heights.cap * record.real(44, 1.0)?;
        let attachment = record.integer_or(71, 1)?.clamp(1, 9) - 1;
        let last_baseline = -leading * lines.len().saturating_sub(1) as f64;
        let block = TextBlock {
            lines,
            leading,
            align_x: [0.0, 0.5, 1.0][(attachment % 3) as usize],
            anchor_y: match attachment / 3 {
                0 => heights.cap,
                1 => 0.5 * (heights.x + last_baseline),
                _ => last_baseline - heights.descent,
            },
        };
        let at = record.point(10)?;
        let along = record
            .optional_point(11)?
            .map(|direction| direction.truncate());
        let turn = match along.filter(|along| along.length() > 0.0) {
            Some(along) => along.to_angle(),
            None => record.real(50, 0.0)?.to_radians(),
        };
        let mirror = DVec2::new(1.0, if record.normal()?.z < 0.0 { -1.0 } else { 1.0 });
        let stretch = DVec2::new(scale * width_factor, scale) * mirror;
        let own = DMat2::from_angle(turn) * DMat2::from_diagonal(stretch) * slant(oblique);
        Ok(block.letters(&DAffine2::from_mat2_translation(own, at.truncate())))
    }

    /// Breaks a paragraph into lines at most `column` wide, in units of the font, and appends them
    /// to `lines`. A width of 0 or less does not break.
    fn wrap(
        &mut self,
        paragraph: &str,
        column: f64,
        lines: &mut Vec<LetteredLine>,
        missing: &mut usize,
    ) -> Result<(), EntityFault> {
        let mut line = self.line(paragraph, missing)?;
        if column <= 0.0 || line.width <= column {
            lines.push(line);
            return Ok(());
        }
        let mut current = String::new();
        for word in paragraph.split(' ') {
            let longer = match current.is_empty() {
                true => word.to_owned(),
                false => format!("{current} {word}"),
            };
            line = self.line(&longer, &mut 0)?;
            if line.width > column && !current.is_empty() {
                lines.push(self.line(&current, &mut 0)?);
                current = word.to_owned();
            } else {
                current = longer;
            }
        }
        lines.push(self.line(&current, &mut 0)?);
        Ok(())
    }
}

impl TextBlock {
    /// Returns the letters, mapped from the coordinate system of the text by `place`; `None` if
    /// there are none.
    fn letters(self, place: &DAffine2) -> Option<EntityShape> {
        let mut loops = Vec::new();
        for (k, line) in self.lines.into_iter().enumerate() {
            let below = self.leading * k as f64;
            let offset = DVec2::new(-self.align_x * line.width, -self.anchor_y - below);
            for ring in line.rings {
                let points = ring.into_iter().map(|p| place.transform_point2(p + offset));
                loops.push(vec![DxfCurve::Chain(points.collect())]);
            }
        }
        let rule = FillRule::NonZero;
        (!loops.is_empty()).then_some(EntityShape::Letters(AreaLoops { loops, rule }))
    }
}

/// Returns the text height of a text.
fn positive_height(record: &DxfRecord) -> Result<f64, EntityFault> {
    let height = record.real(40, 0.0)?;
    match height > 0.0 {
        true => Ok(height),
        false => Err("its text height is not positive".into()),
    }
}

/// Returns −1 if a flag is set, otherwise 1.
fn sign_of(flag: i64) -> f64 {
    if flag == 0 { 1.0 } else { -1.0 }
}

/// Returns the map that slants letters by an angle in degrees; an angle of 90° or more has no
/// effect.
fn slant(degrees: f64) -> DMat2 {
    // An angle of 350° means −10°.
    let degrees = (degrees + 180.0).rem_euclid(360.0) - 180.0;
    let shear = if degrees.abs() < 90.0 {
        degrees.to_radians().tan()
    } else {
        0.0
    };
    DMat2::from_cols(DVec2::X, DVec2::new(shear, 1.0))
}

fn missing_remark(missing: usize) -> Option<String> {
    (missing > 0).then(|| format!("drawn without {missing} characters that the font lacks"))
}
