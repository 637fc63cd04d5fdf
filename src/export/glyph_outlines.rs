//! Converts text to glyph outlines, in the font bundled with the UI toolkit.
//!
//! Outlines instead of text elements make labels look the same in every image on every machine,
//! whatever fonts are installed.
//!
//! Guarantees: never fails; a character missing from the font is drawn as the font's replacement
//! box. Text is not shaped (no ligatures, kerning or right-to-left text), because labels are short
//! and plain.

use glam::DVec2;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::DrawSettings;
use skrifa::outline::pen::PathElement;
use skrifa::{FontRef, MetadataProvider};

use super::outline::{OutlinePath, PathCommand};

/// Returns the outlines of `words`, in pixels, y down. `base_px` is the point in the middle of the
/// baseline, and `height_px` is the font size.
pub fn centred_text(words: &str, base_px: DVec2, height_px: f64) -> OutlinePath {
    let mut origin = base_px - DVec2::new(0.5 * width(words, height_px), 0.0);
    let font = font();
    let glyphs = font.outline_glyphs();
    let size = Size::new(height_px as f32);
    let mut outline = OutlinePath::default();
    for (glyph_id, advance) in advances(&font, words, height_px) {
        let settings = DrawSettings::unhinted(size, LocationRef::default());
        let mut path = Vec::new();
        let glyph = glyphs.get(glyph_id);
        // A glyph whose outline cannot be drawn completely is left out.
        if glyph.is_some_and(|glyph| glyph.draw(settings, &mut path).is_ok()) {
            let steps = path.into_iter().map(|element| step(element, origin));
            outline.commands.extend(steps);
        }
        origin.x += advance;
    }
    outline
}

/// Returns the width of a text with a font size of `height_px`, in pixels.
pub fn width(words: &str, height_px: f64) -> f64 {
    advances(&font(), words, height_px)
        .map(|(_, advance)| advance)
        .sum()
}

/// Returns the font of all labels: Ubuntu Light, under the Ubuntu Font Licence.
fn font() -> FontRef<'static> {
    FontRef::new(epaint_default_fonts::UBUNTU_LIGHT)
        .unwrap_or_else(|error| unreachable!("the bundled font is valid: {error}"))
}

/// Returns the glyph of each character and its advance width in pixels.
fn advances<'a>(
    font: &FontRef<'a>,
    words: &'a str,
    height_px: f64,
) -> impl Iterator<Item = (skrifa::GlyphId, f64)> + 'a {
    let charmap = font.charmap();
    let metrics = font.glyph_metrics(Size::new(height_px as f32), LocationRef::default());
    words.chars().map(move |c| {
        let glyph_id = charmap.map(c).unwrap_or_default();
        let advance = metrics.advance_width(glyph_id).unwrap_or_default();
        (glyph_id, f64::from(advance))
    })
}

/// Converts a path element of a glyph whose origin is at `origin`, in pixels. Font coordinates have
/// y up.
fn step(element: PathElement, origin: DVec2) -> PathCommand {
    let at = |x: f32, y: f32| origin + DVec2::new(f64::from(x), -f64::from(y));
    match element {
        PathElement::MoveTo { x, y } => PathCommand::Move(at(x, y)),
        PathElement::LineTo { x, y } => PathCommand::Line(at(x, y)),
        PathElement::QuadTo { cx0, cy0, x, y } => PathCommand::Quad(at(cx0, cy0), at(x, y)),
        PathElement::CurveTo {
            cx0,
            cy0,
            cx1,
            cy1,
            x,
            y,
        } => PathCommand::Cubic(at(cx0, cy0), at(cx1, cy1), at(x, y)),
        PathElement::Close => PathCommand::Close,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(outline: &OutlinePath) -> Vec<DVec2> {
        let end = |step: &PathCommand| match *step {
            PathCommand::Move(p)
            | PathCommand::Line(p)
            | PathCommand::Quad(_, p)
            | PathCommand::Cubic(_, _, p) => Some(p),
            PathCommand::Close => None,
        };
        outline.commands.iter().filter_map(end).collect()
    }

    #[test]
    fn text_is_centred_and_sits_on_the_baseline() {
        let base = DVec2::new(100.0, 50.0);
        let points = ends(&centred_text("t = 0.25", base, 20.0));
        assert!(!points.is_empty());
        let xs = points.iter().map(|p| p.x);
        let (left, right) = (
            xs.clone().fold(f64::INFINITY, f64::min),
            xs.fold(f64::NEG_INFINITY, f64::max),
        );
        assert!(
            (0.5 * (left + right) - base.x).abs() < 2.0,
            "{left}..{right}"
        );
        assert!((right - left) > 40.0 && (right - left) <= width("t = 0.25", 20.0));
        assert!(points.iter().all(|p| p.y > 30.0 && p.y < 52.0));
    }

    #[test]
    fn twice_the_height_is_twice_the_width() {
        let ratio = width("t = 1", 40.0) / width("t = 1", 20.0);
        assert!((ratio - 2.0).abs() < 1e-6);
    }

    #[test]
    fn unknown_characters_are_boxes_and_empty_text_is_empty() {
        assert!(
            !centred_text("\u{10ffff}", DVec2::ZERO, 20.0)
                .commands
                .is_empty()
        );
        assert!(centred_text("", DVec2::ZERO, 20.0).commands.is_empty());
    }
}
