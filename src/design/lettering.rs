//! Converts one line of text to outlines, in a given font file or the bundled font.
//!
//! `harfrust` shapes the text with HarfBuzz's algorithm (advances, GPOS and `kern` kerning,
//! ligatures, right-to-left scripts); `skrifa` supplies the glyph outlines. One em is 1000 units.
//! The page is as wide as the sum of the advances and as high as the font's ascent plus descent; it
//! is extended where glyphs reach beyond it. The origin is the lower left corner of the page before
//! that extension, so words in one font share a baseline. Overlapping contours are united by the
//! non-zero winding rule. Variable fonts use their default instance.
//!
//! Guarantees that damaged fonts cause neither panics nor long run times, and that a
//! missing character is an error instead of a box. Does not support bitmap or colour
//! glyphs or several lines.

mod glyph_work;

use super::flatten::{Flattener, MIN_TOLERANCE, TooManyPoints};
use super::form::ImportedOutlines;
use crate::geometry::{Bounds, DVec2, FillRule, Regions, RegionsError};
use glyph_work::GlyphWork;
use harfrust::{ShapeOptions, ShaperData, UnicodeBuffer};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::raw::{FileRef, FontRef};
use skrifa::{GlyphId, MetadataProvider};
use usvg::tiny_skia_path::PathBuilder;

/// Error of converting text to outlines.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextError {
    /// The text is empty.
    #[error("the text is empty; enter at least one letter, as in glyph:D")]
    Empty,
    /// The text consists of white space only.
    #[error("the text has only spaces, which have no outline; enter at least one letter")]
    OnlySpace,
    /// The text is too long; holds its number of characters.
    #[error("the text has {0} characters, but at most {MAX_CHARS} are supported; shorten it")]
    TooLong(usize),
    /// One letter carries too many combining marks.
    #[error("one letter has more than {MAX_MARKS} combining marks; remove some")]
    TooManyMarks,
    /// The bytes are not a usable font; holds the reason.
    #[error("the font cannot be read: {0}; choose a TrueType or OpenType font (.ttf, .otf)")]
    Font(&'static str),
    /// The font has no glyph for a character.
    #[error(
        "the font has no glyph for {character:?} (U+{:04X}); use another character, or name a font that has it, as in glyph:TEXT@FONT.ttf",
        u32::from(*character)
    )]
    NoGlyph {
        /// First character of the text that has no glyph in the font.
        character: char,
    },
    /// A glyph is a bitmap or is damaged.
    #[error(
        "the font has no outline for glyph {glyph}; choose an intact font with vector outlines"
    )]
    NoOutline {
        /// Glyph index in the font.
        glyph: u32,
    },
    /// The outline of a glyph is very complex.
    #[error("the outline of glyph {glyph} takes too long to draw; choose another font")]
    ComplexGlyph {
        /// Glyph index in the font.
        glyph: u32,
    },
    /// The outlines need too many points.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// The outlines enclose no area.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// Bytes of the bundled font, which is used for text that names no font.
pub(super) const BUNDLED_FONT: &[u8] = include_bytes!("../../assets/fonts/Roboto-Bold.ttf");

/// Maximum number of characters of a text (resource limit: about a page).
const MAX_CHARS: usize = 2000;

/// Maximum number of combining marks on one letter: the bound of the Stream-Safe Text
/// Format (Unicode, UAX #15).
const MAX_MARKS: usize = 30;

/// Design units per em: the usual resolution of fonts. Letters are then about as large, in design
/// units, as typical drawings.
const EM: f64 = 1000.0;

/// Converts `text` to outlines.
///
/// `font` holds the bytes of a font file; `None` selects the bundled font. `tolerance` is the
/// maximum deviation of flattened curves, as a fraction of the page's longer side.
pub(super) fn read(
    text: &str,
    font: Option<&[u8]>,
    tolerance: f64,
) -> Result<ImportedOutlines, TextError> {
    let characters = text.chars().count();
    match characters {
        0 => return Err(TextError::Empty),
        n if n > MAX_CHARS => return Err(TextError::TooLong(n)),
        _ => {}
    }
    if text.chars().all(char::is_whitespace) {
        return Err(TextError::OnlySpace);
    }
    let font = parsed_font(font.unwrap_or(BUNDLED_FONT))?;
    // Shaping would silently substitute a box for a missing character.
    check_characters(&font, text)?;
    TextLine::shape(&font, text)?.to_outlines(&font, tolerance)
}

/// Parses a font file; returns the first font of a font collection.
fn parsed_font(bytes: &[u8]) -> Result<FontRef<'_>, TextError> {
    // WOFF files get a separate message, because users regard them as valid fonts.
    if bytes.starts_with(b"wOF") {
        return Err(TextError::Font("it is a packed web font"));
    }
    let font = match FileRef::new(bytes) {
        Ok(FileRef::Font(font)) => Ok(font),
        Ok(FileRef::Collection(fonts)) => fonts.get(0),
        Err(error) => Err(error),
    };
    font.map_err(|_| TextError::Font("it is damaged or not a font"))
}

/// Checks that the font has a glyph for every character.
fn check_characters(font: &FontRef, text: &str) -> Result<(), TextError> {
    let charmap = font.charmap();
    let is_missing = |c: &char| charmap.map(*c).is_none_or(|glyph| glyph == GlyphId::NOTDEF);
    match text.chars().find(is_missing) {
        Some(character) => Err(TextError::NoGlyph { character }),
        None => Ok(()),
    }
}

/// The bundled font, for single lines of text in a drawing. Lengths are in design units, 1000 per
/// em.
pub(super) struct LineFont {
    font: FontRef<'static>,
    /// Heights of its letters.
    pub heights: LetterHeights,
}

/// Heights of the letters of a font above its baseline.
#[derive(Clone, Copy, Debug)]
pub(super) struct LetterHeights {
    /// Height of capital letters.
    pub cap: f64,
    /// Height of small letters without ascenders.
    pub x: f64,
    /// Depth of the descender of the letter p below the baseline.
    pub descent: f64,
}

/// Line of text as closed polygons, filled by the non-zero rule. The text starts at the origin, on
/// the baseline.
pub(super) struct LetteredLine {
    pub rings: Vec<Vec<DVec2>>,
    /// Sum of the advances.
    pub width: f64,
}

impl LineFont {
    /// Returns the bundled font.
    pub(super) fn bundled() -> Result<Self, TextError> {
        let font = parsed_font(BUNDLED_FONT)?;
        let metrics = font.metrics(Size::unscaled(), LocationRef::default());
        let cap = metrics.cap_height.filter(|&height| height > 0.0);
        let cap = cap.ok_or(TextError::Font("it lacks the height of capitals"))?;
        let glyphs = font.glyph_metrics(Size::unscaled(), LocationRef::default());
        let p = font
            .charmap()
            .map('p')
            .and_then(|glyph| glyphs.bounds(glyph));
        let scale = EM / f64::from(metrics.units_per_em.max(1));
        let heights = LetterHeights {
            cap: scale * f64::from(cap),
            x: scale * f64::from(metrics.x_height.unwrap_or(cap)),
            descent: -scale * f64::from(p.map_or(metrics.descent, |bounds| bounds.y_min)),
        };
        Ok(Self { font, heights })
    }

    /// Returns whether the font has a glyph for a character.
    pub(super) fn has_glyph(&self, character: char) -> bool {
        let glyph = self.font.charmap().map(character);
        glyph.is_some_and(|glyph| glyph != GlyphId::NOTDEF)
    }

    /// Converts a line of text to polygons. All its characters must have a glyph. `tolerance` is
    /// the maximum deviation of flattened curves, as a fraction of the em.
    pub(super) fn line(&self, text: &str, tolerance: f64) -> Result<LetteredLine, TextError> {
        let line = TextLine::shape(&self.font, text)?;
        let mut flattener = Flattener::new(tolerance.max(MIN_TOLERANCE) * EM);
        let baseline = DVec2::new(0.0, line.baseline);
        let mut rings = line.rings(&self.font, &mut flattener)?;
        rings.iter_mut().flatten().for_each(|p| *p -= baseline);
        Ok(LetteredLine {
            rings,
            width: line.page.max.x,
        })
    }
}

/// Line of text after shaping, in design units.
struct TextLine {
    /// Glyphs with the positions of their origins, in design units.
    glyphs: Vec<(GlyphId, DVec2)>,
    /// Design units per font unit.
    scale: f64,
    /// Page rectangle from advances, ascent and descent.
    page: Bounds,
    /// Height of the baseline above the lower edge of the page.
    baseline: f64,
}

impl TextLine {
    /// Shapes the text and positions its glyphs.
    fn shape(font: &FontRef, text: &str) -> Result<Self, TextError> {
        let metrics = font.metrics(Size::unscaled(), LocationRef::default());
        if metrics.units_per_em == 0 {
            return Err(TextError::Font("it does not define its em size"));
        }
        let scale = EM / f64::from(metrics.units_per_em);
        let data = ShaperData::new(font);
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text);
        // This call detects the script and its direction; without it, Arabic would run left to
        // right.
        buffer.guess_segment_properties();
        let shaper = data.shaper(font).build();
        let shaped = shaper.shape(buffer, ShapeOptions::new());
        let mut letters = (shaped.glyph_infos()).chunk_by(|a, b| a.cluster == b.cluster);
        if letters.any(|letter| letter.len() > 1 + MAX_MARKS) {
            return Err(TextError::TooManyMarks);
        }
        // Height of the page's lower edge relative to the baseline, in font units. It is limited to
        // at most 0, because some fonts claim a descent above the baseline.
        let below = f64::from(metrics.descent).min(0.0);
        let mut pen = DVec2::new(0.0, -below);
        let positions = shaped.glyph_positions().iter();
        let glyphs = shaped
            .glyph_infos()
            .iter()
            .zip(positions)
            .map(|(info, position)| {
                // The offset moves only the glyph; the pen moves by the advance.
                let offset = DVec2::new(position.x_offset.into(), position.y_offset.into());
                let origin = pen + offset;
                pen += DVec2::new(position.x_advance.into(), position.y_advance.into());
                (GlyphId::new(info.glyph_id), origin * scale)
            });
        let glyphs = glyphs.collect();
        let size = DVec2::new(pen.x, f64::from(metrics.ascent) - below);
        let page = Bounds {
            min: DVec2::ZERO,
            max: (size * scale).max(DVec2::ZERO),
        };
        Ok(Self {
            glyphs,
            scale,
            page,
            baseline: -below * scale,
        })
    }

    /// Converts the glyphs to closed polygons, to be filled by the non-zero rule.
    fn rings(
        &self,
        font: &FontRef,
        flattener: &mut Flattener,
    ) -> Result<Vec<Vec<DVec2>>, TextError> {
        let glyphs = font.outline_glyphs();
        let mut work = GlyphWork::new(font);
        let mut rings = Vec::new();
        for &(glyph, origin) in &self.glyphs {
            if !work.permits(glyph) {
                let glyph = glyph.to_u32();
                return Err(TextError::ComplexGlyph { glyph });
            }
            let Some(path) = glyph_path(&glyphs, glyph)?.finish() else {
                continue; // a space
            };
            rings.extend(flattener.rings(&path, |p| {
                origin + self.scale * DVec2::new(p.x.into(), p.y.into())
            })?);
        }
        Ok(rings)
    }

    /// Converts the glyphs to outlines and unites them.
    fn to_outlines(&self, font: &FontRef, tolerance: f64) -> Result<ImportedOutlines, TextError> {
        // The tolerance is a fraction of the page's longer side, but of at least one em, so that a
        // single narrow letter is not flattened more finely than others.
        let longer = self.page.size().max_element().max(EM);
        let mut flattener = Flattener::new(tolerance.max(MIN_TOLERANCE) * longer);
        let rings = self.rings(font, &mut flattener)?;
        let regions = Regions::from_rings(&rings, FillRule::NonZero)?;
        Ok(ImportedOutlines {
            drawn_colour: None,
            paint_layers: Vec::new(),
            extent: self.page.union(&regions.bounds()),
            regions,
            notes: Vec::new(),
        })
    }
}

/// Returns the outline of a glyph in font units.
fn glyph_path(glyphs: &OutlineGlyphCollection, glyph: GlyphId) -> Result<PathBuilder, TextError> {
    let missing = || TextError::NoOutline {
        glyph: glyph.to_u32(),
    };
    let mut pen = GlyphPen(PathBuilder::new());
    // Hinting would adjust the outlines to a pixel grid, but there is no such grid here.
    let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
    let outline = glyphs.get(glyph).ok_or_else(missing)?;
    outline.draw(settings, &mut pen).map_err(|_| missing())?;
    Ok(pen.0)
}

/// Receives the outline of one glyph, in font units, and builds a path from it.
struct GlyphPen(PathBuilder);

impl OutlinePen for GlyphPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.0.quad_to(cx, cy, x, y);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.0.cubic_to(cx0, cy0, cx1, cy1, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(text: &str) -> Regions {
        read(text, None, 1e-4).expect("an outline").regions
    }

    #[test]
    fn letters_have_the_expected_pieces_and_holes() {
        for (text, pieces, rings) in [
            ("D", 1, 2),
            ("S", 1, 1),
            ("B", 1, 3),
            ("i", 2, 2),
            ("% @", 4, 7),
        ] {
            let found = outline(text);
            let counts = (found.len(), found.rings().count());
            assert_eq!(counts, (pieces, rings), "{text}");
        }
    }

    #[test]
    fn every_capital_of_the_bundled_font_is_one_piece_on_the_baseline() {
        for letter in 'A'..='Z' {
            let found = outline(&letter.to_string());
            assert_eq!(found.len(), 1, "{letter}");
            let height = found.bounds().size().y;
            assert!((700.0..=860.0).contains(&height), "{letter}: {height}");
        }
    }

    #[test]
    fn words_are_kerned() {
        let width = |text: &str| {
            let found = read(text, None, 1e-4).expect("an outline");
            found.extent.size().x
        };
        assert!(width("AV") < width("A").min(width("V")) * 2.0);
        let left_edge_distance = |text: &str| {
            let found = outline(text);
            let mut lefts: Vec<f64> = found.iter().map(|r| r.outer.bounds().min.x).collect();
            lefts.sort_by(f64::total_cmp);
            lefts[1] - lefts[0]
        };
        assert!(left_edge_distance("AV") < left_edge_distance("AH") - 20.0);
    }

    #[test]
    fn unusable_text_and_fonts_are_reported() {
        let error = |text: &str| read(text, None, 1e-4).err().expect("no outline");
        assert_eq!(error(""), TextError::Empty);
        assert_eq!(error(" \t"), TextError::OnlySpace);
        assert_eq!(error(&"x".repeat(3000)), TextError::TooLong(3000));
        assert_eq!(
            error("D\u{2603}"),
            TextError::NoGlyph {
                character: '\u{2603}'
            }
        );
        assert!(error("a\nb").to_string().contains("U+000A"));
        let marked = |count: usize| format!("A{}", "\u{301}".repeat(count));
        assert_eq!(error(&marked(32)), TextError::TooManyMarks);
        assert!(outline(&marked(20)).len() > 2);
        for bytes in [&b""[..], b"wOF2rest", b"no font", &BUNDLED_FONT[..40]] {
            assert!(matches!(
                read("D", Some(bytes), 1e-4),
                Err(TextError::Font(_) | TextError::NoGlyph { .. })
            ));
        }
    }

    #[test]
    fn text_is_drawn_in_a_given_font() {
        let found = read("D", Some(epaint_default_fonts::HACK_REGULAR), 1e-4).expect("D");
        assert_eq!(found.regions.rings().count(), 2);
    }
}
