//! Bounds the work of drawing glyphs before they are drawn. A font of a few kilobytes can describe
//! outlines without end, because charstrings call subroutines, and composite glyphs consist of
//! other glyphs, many times and on many levels.

use skrifa::raw::ps::cff::CffFontRef;
use skrifa::raw::ps::cff::blend::BlendState;
use skrifa::raw::ps::cff::index::Index;
use skrifa::raw::ps::cs::{self, CharstringContext, CharstringKind, CommandSink};
use skrifa::raw::ps::error::Error as CharstringError;
use skrifa::raw::tables::glyf::Glyph;
use skrifa::raw::types::Fixed;
use skrifa::raw::{FontRef, TableProvider};
use skrifa::{GlyphId, Tag};
use std::cell::Cell;
use std::collections::HashMap;

/// Maximum work of the glyphs of a text (resource limit: a megabyte of charstrings or a million
/// points).
const MAX_WORK: u64 = 1_000_000;

/// Maximum depth of composite glyphs inside each other (resource limit: the count recurses; the
/// specification of the format suggests 16 at most).
const MAX_COMPOSITES: usize = 32;

/// Counter of the work of drawing glyphs: bytes of charstrings and points of outlines.
pub(super) struct GlyphWork<'f> {
    font: &'f FontRef<'f>,
    /// Work that is left.
    left: u64,
    /// Work of the composite glyphs met so far, and of their parts.
    counted: HashMap<GlyphId, u64>,
}

impl<'f> GlyphWork<'f> {
    pub(super) fn new(font: &'f FontRef<'f>) -> Self {
        Self {
            font,
            left: MAX_WORK,
            counted: HashMap::new(),
        }
    }

    /// Returns whether a further glyph can be drawn within the limit. Damaged glyphs, which cannot
    /// be drawn anyway, count as drawable.
    pub(super) fn permits(&mut self, glyph: GlyphId) -> bool {
        // Variable composites are evaluated on the fly, so that their parts cannot be counted.
        if self.font.table_data(Tag::new(b"VARC")).is_some() {
            return false;
        }
        let work = self.truetype_work(glyph, 0);
        let work = work.and_then(|work| Some(work + self.charstring_work(glyph)?));
        let left = work.and_then(|work| self.left.checked_sub(work));
        self.left = left.unwrap_or(0);
        left.is_some()
    }

    /// Returns the number of points of a TrueType outline and of its components; `None` if there
    /// are too many.
    fn truetype_work(&mut self, glyph: GlyphId, depth: usize) -> Option<u64> {
        if let Some(&work) = self.counted.get(&glyph) {
            return Some(work);
        }
        let (Ok(loca), Ok(glyf)) = (self.font.loca(None), self.font.glyf()) else {
            return Some(0);
        };
        let work = match loca.get_glyf(glyph, &glyf) {
            Ok(Some(Glyph::Simple(outline))) => 1 + outline.num_points() as u64,
            Ok(Some(Glyph::Composite(composite))) => {
                if depth == MAX_COMPOSITES {
                    return None;
                }
                let mut sum = 1;
                for part in composite.components() {
                    sum += self.truetype_work(part.glyph.into(), depth + 1)?;
                    if sum > MAX_WORK {
                        return None;
                    }
                }
                sum
            }
            Ok(None) | Err(_) => 0,
        };
        self.counted.insert(glyph, work);
        Some(work)
    }

    /// Returns the number of bytes of a charstring and of the subroutines that it calls, counted at
    /// each call; `None` if there are too many.
    fn charstring_work(&self, glyph: GlyphId) -> Option<u64> {
        let table = |tag| self.font.table_data(tag).map(|data| data.as_bytes());
        let font = match (table(Tag::new(b"CFF2")), table(Tag::new(b"CFF "))) {
            (Some(data), _) => CffFontRef::new_cff2(data, None),
            (None, Some(data)) => CffFontRef::new_cff(data, 0, None),
            (None, None) => return Some(0),
        };
        let Ok(font) = font else {
            return Some(0);
        };
        let Some((bytes, local)) = charstring(&font, glyph) else {
            return Some(0);
        };
        let counted = CountedSubroutines {
            context: (font.data(), font.charstrings(), font.global_subrs(), &local),
            left: Cell::new(MAX_WORK),
        };
        let is_within_limit = counted.evaluates(&font, bytes);
        is_within_limit.then(|| MAX_WORK - counted.left.get())
    }
}

/// Returns the charstring of a glyph and the local subroutines that it can call; `None` if the font
/// is damaged.
fn charstring<'a>(font: &CffFontRef<'a>, glyph: GlyphId) -> Option<(&'a [u8], Index<'a>)> {
    let subfont = font.subfont(font.subfont_index(glyph)?, &[]).ok()?;
    let local = match subfont.subrs_offset() {
        0 => Index::Empty,
        offset => Index::new(font.data().get(offset as usize..)?, font.version() == 2).ok()?,
    };
    let bytes = font.charstrings().get(glyph.to_u32() as usize).ok()?;
    Some((bytes, local))
}

/// Subroutines of a charstring, whose bytes are counted at each call.
struct CountedSubroutines<'a> {
    /// The whole table, the charstrings, and the global and the local subroutines.
    context: (&'a [u8], &'a Index<'a>, &'a Index<'a>, &'a Index<'a>),
    /// Number of bytes that may still be evaluated.
    left: Cell<u64>,
}

impl CountedSubroutines<'_> {
    /// Evaluates a charstring without drawing it; returns whether it ends within the limit. Damaged
    /// charstrings end where they are damaged.
    fn evaluates(&self, font: &CffFontRef, bytes: &[u8]) -> bool {
        let store = font.var_store().cloned();
        let blend = store.and_then(|store| BlendState::new(store, &[], 0).ok());
        let counted = self.count(bytes);
        let width = counted.and_then(|bytes| cs::evaluate(self, blend, bytes, &mut NoPen));
        width.is_ok() || self.left.get() > 0
    }

    /// Counts bytes that are evaluated next.
    fn count<'b>(&self, bytes: &'b [u8]) -> Result<&'b [u8], CharstringError> {
        let left = self.left.get().saturating_sub(1 + bytes.len() as u64);
        self.left.set(left);
        match left {
            0 => Err(CharstringError::CharstringNestingDepthLimitExceeded),
            _ => Ok(bytes),
        }
    }
}

impl CharstringContext for CountedSubroutines<'_> {
    fn kind(&self) -> CharstringKind {
        CharstringKind::Type2
    }

    fn seac_components(&self, base: i32, accent: i32) -> Result<[&[u8]; 2], CharstringError> {
        let [base, accent] = self.context.seac_components(base, accent)?;
        Ok([self.count(base)?, self.count(accent)?])
    }

    fn global_subr(&self, index: i32) -> Result<&[u8], CharstringError> {
        self.count(subroutine(self.context.2, index)?)
    }

    fn subr(&self, index: i32) -> Result<&[u8], CharstringError> {
        self.count(subroutine(self.context.3, index)?)
    }
}

/// Returns the subroutine with a number as it is written in charstrings.
fn subroutine<'a>(index: &Index<'a>, number: i32) -> Result<&'a [u8], CharstringError> {
    // A negative sum becomes an index out of range.
    index.get(number.wrapping_add(index.subr_bias()) as usize)
}

/// Receives the outline of a charstring that is only counted.
struct NoPen;

impl CommandSink for NoPen {
    fn move_to(&mut self, _: Fixed, _: Fixed) {}
    fn line_to(&mut self, _: Fixed, _: Fixed) {}
    fn curve_to(&mut self, _: Fixed, _: Fixed, _: Fixed, _: Fixed, _: Fixed, _: Fixed) {}
    fn close(&mut self) {}
}
