//! Letters as outlines: a glyph or a word in a font file or the bundled font.
//!
//! Shaped by `harfrust` (HarfBuzz's algorithm: advances, GPOS and `kern`
//! kerning, ligatures, right-to-left scripts), outlines from `skrifa`. One em
//! is 1000 units. The page is as wide as the text's advances and as high as
//! the font's ascent and descent, or more where glyphs reach beyond; without
//! that its lower left corner is the origin, and words in one font share their
//! base line in any case. Overlapping contours are
//! united by winding (non-zero). A variable font is drawn at its default.
//!
//! Guaranteed: no bytes, however broken, make it panic or run long; a
//! character that the font lacks is an error, never a box. Not read: bitmap
//! and colour glyphs, more than one line.

use super::flatten::{Flattener, MIN_TOLERANCE, TooManyPoints};
use super::form::ImportedOutlines;
use crate::geometry::{Bounds, DVec2, FillRule, Regions, RegionsError};
use harfrust::{ShapeOptions, ShaperData, UnicodeBuffer};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlinePen};
use skrifa::raw::{FileRef, FontRef};
use skrifa::{GlyphId, MetadataProvider};
use usvg::tiny_skia_path::PathBuilder;

/// Why text gives no outline.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextError {
    /// There is no text.
    #[error("there is no text; write one letter or more, as in glyph:D")]
    Empty,
    /// There are only spaces.
    #[error("the text is only spaces, which have no outline; write one letter or more")]
    OnlySpace,
    /// More text than a design should have.
    #[error("the text has {0} characters, more than the {MAX_CHARS} that are drawn; shorten it")]
    TooLong(usize),
    /// More marks on a letter than any text has.
    #[error("more than {MAX_MARKS} marks stand on one letter; leave some out")]
    TooManyMarks,
    /// The font's bytes are no font.
    #[error("the font cannot be read: {0}; choose a TrueType or OpenType font (.ttf, .otf)")]
    Font(&'static str),
    /// The font has no glyph for a character.
    #[error(
        "the font has no glyph for {character:?} (U+{:04X}); choose another character, or a font that has it as in glyph:TEXT@FONT.ttf",
        u32::from(*character)
    )]
    NoGlyph {
        /// The first such character.
        character: char,
    },
    /// A glyph that is a picture, or damaged.
    #[error(
        "the font has no outline for glyph {glyph} of the text; choose a font with outlines that is not damaged"
    )]
    NoOutline {
        /// The number of the glyph in the font.
        glyph: u32,
    },
    /// Curves into absurdly many points.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// Nothing is enclosed.
    #[error(transparent)]
    Regions(#[from] RegionsError),
}

/// The font for text that names none.
pub(super) const BUNDLED_FONT: &[u8] = include_bytes!("../../assets/fonts/Roboto-Bold.ttf");

/// Most characters: a page of text, far beyond what anyone blends.
const MAX_CHARS: usize = 2000;

/// Most accents and other marks on one letter, as of text that may be streamed
/// (Unicode, UAX #15). A thousand on an A are a thousand parts.
const MAX_MARKS: usize = 30;

/// Units of the design for one em, as most fonts have it: letters are then as
/// large as drawings are.
const EM: f64 = 1000.0;

/// Draws `text`. `font` is a font's bytes or `None` for the bundled font,
/// `tolerance` a fraction of the page's longer side.
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
    let font = font_of(font.unwrap_or(BUNDLED_FONT))?;
    // Shaping would draw a box for what the font lacks.
    check_characters(&font, text)?;
    TextLine::shaped(&font, text)?.outlined(&font, tolerance)
}

/// The font in a file, or the first of a collection.
fn font_of(bytes: &[u8]) -> Result<FontRef<'_>, TextError> {
    // Named, for it is a font to whoever has it, only packed.
    if bytes.starts_with(b"wOF") {
        return Err(TextError::Font("it is a web font"));
    }
    let font = match FileRef::new(bytes) {
        Ok(FileRef::Font(font)) => Ok(font),
        Ok(FileRef::Collection(fonts)) => fonts.get(0),
        Err(error) => Err(error),
    };
    font.map_err(|_| TextError::Font("it is damaged, or no font"))
}

fn check_characters(font: &FontRef, text: &str) -> Result<(), TextError> {
    let charmap = font.charmap();
    let is_missing = |c: &char| charmap.map(*c).is_none_or(|glyph| glyph == GlyphId::NOTDEF);
    match text.chars().find(is_missing) {
        Some(character) => Err(TextError::NoGlyph { character }),
        None => Ok(()),
    }
}

/// Glyphs at their places, in units of the design.
struct TextLine {
    glyphs: Vec<(GlyphId, DVec2)>,
    /// Units of the design for one of the font.
    scale: f64,
    page: Bounds,
}

impl TextLine {
    fn shaped(font: &FontRef, text: &str) -> Result<Self, TextError> {
        let metrics = font.metrics(Size::unscaled(), LocationRef::default());
        if metrics.units_per_em == 0 {
            return Err(TextError::Font("it has no size of its em"));
        }
        let scale = EM / f64::from(metrics.units_per_em);
        let data = ShaperData::new(font);
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text);
        // Script and direction, without which Arabic would run left to right.
        buffer.guess_segment_properties();
        let shaper = data.shaper(font).build();
        let shaped = shaper.shape(buffer, ShapeOptions::new());
        let mut letters = (shaped.glyph_infos()).chunk_by(|a, b| a.cluster == b.cluster);
        if letters.any(|letter| letter.len() > 1 + MAX_MARKS) {
            return Err(TextError::TooManyMarks);
        }
        // Where the page begins; a font may claim to end above its base line.
        let below = f64::from(metrics.descent).min(0.0);
        let mut pen = DVec2::new(0.0, -below);
        let places = shaped.glyph_positions().iter();
        let glyphs = shaped.glyph_infos().iter().zip(places).map(|(info, by)| {
            // Where the glyph is drawn; the pen moves on by its advance alone.
            let offset = DVec2::new(by.x_offset.into(), by.y_offset.into());
            let at = pen + offset;
            pen += DVec2::new(by.x_advance.into(), by.y_advance.into());
            (GlyphId::new(info.glyph_id), at * scale)
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
        })
    }

    fn outlined(&self, font: &FontRef, tolerance: f64) -> Result<ImportedOutlines, TextError> {
        // One em at least: a single narrow letter is no reason to be finer.
        let longer = self.page.size().max_element().max(EM);
        let mut flattener = Flattener::new(tolerance.max(MIN_TOLERANCE) * longer);
        let glyphs = font.outline_glyphs();
        let mut rings = Vec::new();
        for &(glyph, at) in &self.glyphs {
            let Some(path) = drawn(&glyphs, glyph)?.finish() else {
                continue; // a space
            };
            rings.extend(flattener.rings(&path, |p| {
                at + self.scale * DVec2::new(p.x.into(), p.y.into())
            })?);
        }
        let regions = Regions::from_rings(&rings, FillRule::NonZero)?;
        Ok(ImportedOutlines {
            coats: Vec::new(),
            extent: self.page.union(&regions.bounds()),
            regions,
            notes: Vec::new(),
        })
    }
}

fn drawn(glyphs: &OutlineGlyphCollection, glyph: GlyphId) -> Result<PathBuilder, TextError> {
    let missing = || TextError::NoOutline {
        glyph: glyph.to_u32(),
    };
    let mut pen = GlyphPen(PathBuilder::new());
    // Hints fit an outline to the pixels of a size, and here are none.
    let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
    let outline = glyphs.get(glyph).ok_or_else(missing)?;
    outline.draw(settings, &mut pen).map_err(|_| missing())?;
    Ok(pen.0)
}

/// Collects one glyph in the font's units.
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
    fn letters_have_their_holes_and_pieces() {
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
    fn every_capital_of_the_bundled_font_is_one_piece_on_the_base_line() {
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
        let apart = |text: &str| {
            let found = outline(text);
            let mut lefts: Vec<f64> = found.iter().map(|r| r.outer.bounds().min.x).collect();
            lefts.sort_by(f64::total_cmp);
            lefts[1] - lefts[0]
        };
        assert!(apart("AV") < apart("AH") - 20.0);
    }

    #[test]
    fn what_cannot_be_drawn_is_named() {
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
    fn any_font_file_will_do() {
        let found = read("D", Some(epaint_default_fonts::HACK_REGULAR), 1e-4).expect("D");
        assert_eq!(found.regions.rings().count(), 2);
    }
}
