//! Selects fonts for the text of a drawing from the installed fonts and the bundled one, and
//! records missing fonts and characters.

use crate::design::lettering::BUNDLED_FONT;
use skrifa::MetadataProvider;
use skrifa::raw::FontRef;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use usvg::fontdb::{Database, FaceInfo, Family, ID, Query, Source, Style, Weight};
use usvg::{Font, FontFamily, FontResolver, FontStyle};

/// Maximum number of font searches in one drawing. A search looks for a font with a character that
/// the chosen font lacks (resource limit: each search opens every font file).
const MAX_SEARCHES: usize = 64;

/// Font family for text that names none.
pub(super) const UNNAMED: &str = "serif";

/// Font selection for one drawing, with a record of missing fonts and characters.
#[derive(Default)]
pub(super) struct FontLookup {
    /// Number of font searches so far; see [`MAX_SEARCHES`].
    searches: AtomicUsize,
    absent: Mutex<MissingFonts>,
}

/// Font families that are not installed, and characters that their font lacks.
#[derive(Clone, Default)]
pub(super) struct MissingFonts {
    /// Names of missing font families.
    pub fonts: BTreeSet<String>,
    /// Characters for which no font was found, or for which no search was made because the drawing
    /// had reached the maximum number of searches.
    pub characters: BTreeSet<char>,
    /// Characters that their font lacks and that are drawn in another one.
    pub replaced: BTreeSet<char>,
}

impl FontLookup {
    /// Returns the font resolver for `usvg`, which also records missing fonts and characters.
    pub(super) fn resolver(&self) -> FontResolver<'_> {
        let select = FontResolver::default_font_selector();
        FontResolver {
            select_font: Box::new(move |font, fonts| {
                self.note_fonts(font.families(), fonts);
                let found = select(font, fonts);
                if let (Some(id), Some(FontFamily::Named(name))) = (found, font.families().first())
                    && let Some(style) = missing_style(font, id, fonts)
                {
                    self.absent().fonts.insert(format!("{name} {style}"));
                }
                found.or_else(|| bundled_font(fonts))
            }),
            select_fallback: Box::new(move |character, tried, fonts| {
                let searches = self.searches.fetch_add(1, Ordering::Relaxed);
                let found =
                    (searches < MAX_SEARCHES).then(|| fallback_font(character, tried, fonts));
                let found = found.flatten();
                let mut absent = self.absent();
                let characters = match found {
                    Some(_) => &mut absent.replaced,
                    None => &mut absent.characters,
                };
                characters.insert(character);
                found
            }),
        }
    }

    /// Returns the record of missing fonts and characters.
    pub(super) fn into_absent(self) -> MissingFonts {
        let absent = self.absent.into_inner();
        absent.unwrap_or_else(PoisonError::into_inner)
    }

    /// Records the first family of a list if no family of the list is installed.
    fn note_fonts(&self, families: &[FontFamily], fonts: &Database) {
        let is_available = |family: &FontFamily| match family {
            FontFamily::Named(name) => name == UNNAMED || is_installed(fonts, Family::Name(name)),
            _ => true,
        };
        if let Some(FontFamily::Named(name)) = families.first()
            && !families.iter().any(is_available)
        {
            self.absent().fonts.insert(name.clone());
        }
    }

    /// Locks the record. A poisoned lock is safe to use because the sets are always valid.
    fn absent(&self) -> std::sync::MutexGuard<'_, MissingFonts> {
        self.absent.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Returns the style that a font should have and the face found for it lacks, if any. Browsers
/// slant and thicken letters themselves in this case.
fn missing_style(font: &Font, id: ID, fonts: &Database) -> Option<&'static str> {
    let face = fonts.face(id)?;
    let is_slanted = font.style() != FontStyle::Normal && face.style == Style::Normal;
    let is_thicker = font.weight() >= Weight::SEMIBOLD.0 && face.weight < Weight::SEMIBOLD;
    let style = match (is_slanted, is_thicker) {
        (true, _) => "italic",
        (_, true) => "bold",
        _ => return None,
    };
    // Variable fonts have more styles than the one of their face.
    let is_variable = |data: &[u8], index: u32| {
        let face = FontRef::from_index(data, index);
        face.is_ok_and(|face| !face.axes().is_empty())
    };
    let is_variable = fonts.with_face_data(id, is_variable).unwrap_or(false);
    (!is_variable).then_some(style)
}

/// Returns a font that has a character, of those with the style of the first font that was tried,
/// or the most similar style.
fn fallback_font(character: char, tried: &[ID], fonts: &Database) -> Option<ID> {
    let wanted = fonts.face(*tried.first()?)?;
    let mut faces: Vec<&FaceInfo> = fonts.faces().filter(|f| !tried.contains(&f.id)).collect();
    faces.sort_by_key(|face| {
        let is_other_family = face.families.first() != wanted.families.first();
        let weight = face.weight.0.abs_diff(wanted.weight.0);
        let is_other_style = (face.style != wanted.style, face.stretch != wanted.stretch);
        (is_other_style, weight, is_other_family)
    });
    let has_character = |data: &[u8], index: u32| {
        let font = FontRef::from_index(data, index);
        font.is_ok_and(|font| font.charmap().map(character).is_some())
    };
    let found = faces
        .into_iter()
        .find(|face| fonts.with_face_data(face.id, has_character) == Some(true));
    found.map(|face| face.id)
}

fn is_installed(fonts: &Database, family: Family) -> bool {
    let query = Query {
        families: &[family],
        ..Query::default()
    };
    fonts.query(&query).is_some()
}

/// Returns the bundled font. It is recognised as the only font that was loaded from memory and not
/// from a file.
fn bundled_font(fonts: &Database) -> Option<ID> {
    let mut faces = fonts.faces();
    faces
        .find(|face| matches!(face.source, Source::Binary(_)))
        .map(|face| face.id)
}

/// Returns a database of the installed fonts and the bundled one; loads it on the first call.
pub(super) fn fonts() -> Arc<Database> {
    static FONTS: OnceLock<Arc<Database>> = OnceLock::new();
    let found = FONTS.get_or_init(|| {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        fonts.load_font_source(Source::Binary(Arc::new(BUNDLED_FONT)));
        set_generic_families(&mut fonts);
        Arc::new(fonts)
    });
    Arc::clone(found)
}

/// A font of this machine that text can be drawn in.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct InstalledFont {
    /// Name for the user: family and style.
    pub name: String,
    /// Path of the font file.
    pub path: PathBuf,
}

/// Returns the installed fonts, sorted by name. Of a file with several fonts, only the first is
/// listed, because text uses the first. Takes long on the first call, which reads all font files.
#[must_use]
pub fn installed_fonts() -> Vec<InstalledFont> {
    let fonts = fonts();
    let first_faces = fonts.faces().filter(|face| face.index == 0);
    let listed = first_faces.filter_map(|face| {
        let (Source::File(path) | Source::SharedFile(path, _)) = &face.source else {
            return None;
        };
        let name = format!("{} {}", face.families.first()?.0, style_name(face));
        Some(InstalledFont {
            name: name.trim_end().to_owned(),
            path: path.clone(),
        })
    });
    let mut listed: Vec<InstalledFont> = listed.collect();
    listed.sort();
    listed.dedup_by(|a, b| a.path == b.path);
    listed
}

/// Weight and slope of a font in words; empty for a regular upright one.
fn style_name(face: &FaceInfo) -> String {
    let weight = match face.weight.0 {
        0..=350 => "Light",
        351..=450 => "",
        451..=550 => "Medium",
        551..=650 => "Semibold",
        651..=850 => "Bold",
        _ => "Black",
    };
    let slope = match face.style {
        Style::Normal => "",
        Style::Italic | Style::Oblique => "Italic",
    };
    let words = [weight, slope].into_iter().filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join(" ")
}

/// Common serif fonts of operating systems in order of preference.
const SERIF: [&str; 5] = [
    "Times New Roman",
    "Liberation Serif",
    "Nimbus Roman",
    "DejaVu Serif",
    "Noto Serif",
];
/// Common sans-serif fonts of operating systems in order of preference.
const SANS_SERIF: [&str; 6] = [
    "Arial",
    "Helvetica",
    "Liberation Sans",
    "Nimbus Sans",
    "DejaVu Sans",
    "Noto Sans",
];
/// Common monospaced fonts of operating systems in order of preference.
const MONOSPACE: [&str; 6] = [
    "Courier New",
    "Liberation Mono",
    "Nimbus Mono PS",
    "DejaVu Sans Mono",
    "Noto Sans Mono",
    "Menlo",
];

/// Assigns an installed font to each generic family (serif, sans-serif, monospaced) whose
/// configured font is not installed.
fn set_generic_families(fonts: &mut Database) {
    let replacement = |fonts: &Database, kind: Family, names: &[&str]| {
        let found = names
            .iter()
            .find(|name| is_installed(fonts, Family::Name(name)));
        found
            .filter(|_| !is_installed(fonts, kind))
            .map(|name| (*name).to_owned())
    };
    if let Some(name) = replacement(fonts, Family::Serif, &SERIF) {
        fonts.set_serif_family(name);
    }
    if let Some(name) = replacement(fonts, Family::SansSerif, &SANS_SERIF) {
        fonts.set_sans_serif_family(name);
    }
    if let Some(name) = replacement(fonts, Family::Monospace, &MONOSPACE) {
        fonts.set_monospace_family(name);
    }
}
