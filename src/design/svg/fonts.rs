//! The letters of a drawing: in the fonts of the machine, and in the bundled one
//! where the machine has none.

use crate::design::lettering::BUNDLED_FONT;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use usvg::fontdb::{Database, Family, ID, Query, Source};
use usvg::{FontFamily, FontResolver};

/// Most searches of all fonts for one that has a character: each looks into every
/// file.
const MAX_SEARCHES: usize = 64;

/// The font of text that names none: of the kind that goes by this name.
pub(super) const UNNAMED: &str = "serif";

/// What of a drawing's text could not be shown as it was meant.
#[derive(Default)]
pub(super) struct FontLookup {
    searches: AtomicUsize,
    absent: Mutex<MissingFonts>,
}

/// What the machine does not have.
#[derive(Clone, Default)]
pub(super) struct MissingFonts {
    /// Families of fonts.
    pub fonts: BTreeSet<String>,
    /// Characters that no font has.
    pub characters: BTreeSet<char>,
}

impl FontLookup {
    /// Chooses fonts, and keeps what is absent.
    pub(super) fn resolver(&self) -> FontResolver<'_> {
        let select = FontResolver::default_font_selector();
        let find = FontResolver::default_fallback_selector();
        FontResolver {
            select_font: Box::new(move |font, fonts| {
                self.note_fonts(font.families(), fonts);
                select(font, fonts).or_else(|| bundled(fonts))
            }),
            select_fallback: Box::new(move |character, tried, fonts| {
                let searches = self.searches.fetch_add(1, Ordering::Relaxed);
                let found = (searches < MAX_SEARCHES).then(|| find(character, tried, fonts));
                let found = found.flatten();
                if found.is_none() {
                    self.absent().characters.insert(character);
                }
                found
            }),
        }
    }

    /// What was found to be absent.
    pub(super) fn into_absent(self) -> MissingFonts {
        let absent = self.absent.into_inner();
        absent.unwrap_or_else(PoisonError::into_inner)
    }

    /// A list of families of which the first that is there is taken; one is told if
    /// none is.
    fn note_fonts(&self, families: &[FontFamily], fonts: &Database) {
        let is_there = |family: &FontFamily| match family {
            FontFamily::Named(name) => name == UNNAMED || is_there(fonts, Family::Name(name)),
            _ => true,
        };
        if let Some(FontFamily::Named(name)) = families.first()
            && !families.iter().any(is_there)
        {
            self.absent().fonts.insert(name.clone());
        }
    }

    fn absent(&self) -> std::sync::MutexGuard<'_, MissingFonts> {
        self.absent.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn is_there(fonts: &Database, family: Family) -> bool {
    let query = Query {
        families: &[family],
        ..Query::default()
    };
    fonts.query(&query).is_some()
}

/// The font that is always there.
fn bundled(fonts: &Database) -> Option<ID> {
    let mut faces = fonts.faces();
    faces
        .find(|face| matches!(face.source, Source::Binary(_)))
        .map(|face| face.id)
}

/// The fonts of the machine and the bundled one, looked for once.
pub(super) fn fonts() -> Arc<Database> {
    static FONTS: OnceLock<Arc<Database>> = OnceLock::new();
    let found = FONTS.get_or_init(|| {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        fonts.load_font_source(Source::Binary(Arc::new(BUNDLED_FONT)));
        name_kinds(&mut fonts);
        Arc::new(fonts)
    });
    Arc::clone(found)
}

/// Fonts of each kind as systems ship them, the first that is there is taken.
const SERIF: [&str; 5] = [
    "Times New Roman",
    "Liberation Serif",
    "Nimbus Roman",
    "DejaVu Serif",
    "Noto Serif",
];
const SANS_SERIF: [&str; 6] = [
    "Arial",
    "Helvetica",
    "Liberation Sans",
    "Nimbus Sans",
    "DejaVu Sans",
    "Noto Sans",
];
const MONOSPACE: [&str; 6] = [
    "Courier New",
    "Liberation Mono",
    "Nimbus Mono PS",
    "DejaVu Sans Mono",
    "Noto Sans Mono",
    "Menlo",
];

/// Says which fonts the kinds of fonts stand for, where the system's settings name
/// one that is not there.
fn name_kinds(fonts: &mut Database) {
    let first = |fonts: &Database, kind: Family, names: &[&str]| {
        let found = names
            .iter()
            .find(|name| is_there(fonts, Family::Name(name)));
        found
            .filter(|_| !is_there(fonts, kind))
            .map(|name| (*name).to_owned())
    };
    if let Some(name) = first(fonts, Family::Serif, &SERIF) {
        fonts.set_serif_family(name);
    }
    if let Some(name) = first(fonts, Family::SansSerif, &SANS_SERIF) {
        fonts.set_sans_serif_family(name);
    }
    if let Some(name) = first(fonts, Family::Monospace, &MONOSPACE) {
        fonts.set_monospace_family(name);
    }
}
