//! Labels of contact sheets: line wrapping, text colour, and short number formatting.

use std::fmt;

use crate::colour::Rgb;
use crate::geometry::DVec2;

use super::drawing::Drawing;
use super::glyph_outlines;

/// Text colour of error messages.
pub(super) const ERROR_COLOUR: Rgb = Rgb([0xc0, 0x3a, 0x20]);

/// Area in which a label is wrapped.
#[derive(Clone, Copy, Debug)]
pub(super) struct LabelBox {
    /// Upper left corner of the area, in pixels.
    pub corner: DVec2,
    /// Width of the area, in pixels.
    pub width_px: f64,
    /// Maximum number of lines of the label.
    pub max_lines: usize,
}

/// Font size and line height of a label.
#[derive(Clone, Copy, Debug)]
pub(super) struct LabelStyle {
    /// Font size in pixels.
    pub font_px: f64,
    /// Line height in pixels.
    pub line_px: f64,
}

impl LabelStyle {
    /// Draws text that starts in the upper left corner of `area`, is wrapped to its width, and has
    /// at most `area.max_lines` lines. Returns the number of lines drawn.
    pub fn push(self, drawing: &mut Drawing, words: &str, area: LabelBox, colour: Rgb) -> usize {
        let lines = self.wrap(words, area.width_px, area.max_lines);
        for (i, line) in lines.iter().enumerate() {
            let middle = 0.5 * glyph_outlines::width(line, self.font_px);
            // The baseline is at 80 % of the line's height; descenders need the rest.
            let base = area.corner + DVec2::new(middle, (i as f64 + 0.8) * self.line_px);
            drawing.push_label(line, base, self.font_px, colour);
        }
        lines.len()
    }

    /// Breaks text into at most `max_lines` lines of `width_px`; an ellipsis replaces the rest.
    /// Words longer than a line are broken.
    fn wrap(self, words: &str, width_px: f64, max_lines: usize) -> Vec<String> {
        let fits = |line: &str| glyph_outlines::width(line, self.font_px) <= width_px;
        let mut lines: Vec<String> = Vec::new();
        let mut line = String::new();
        for word in words.split_whitespace() {
            if !line.is_empty() && !fits(&format!("{line} {word}")) {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            for c in word.chars() {
                line.push(c);
                // The width is checked after each character, because a word such as a file path may
                // be longer than a line.
                if !fits(&line) {
                    line.pop();
                    lines.push(std::mem::replace(&mut line, c.to_string()));
                }
            }
        }
        lines.push(line);
        lines.retain(|line| !line.is_empty());
        if lines.len() > max_lines {
            lines.truncate(max_lines);
            if let Some(last) = lines.last_mut() {
                while !last.is_empty() && !fits(&format!("{last}\u{2026}")) {
                    last.pop();
                }
                last.push('\u{2026}');
            }
        }
        lines
    }
}

/// Returns a text colour that is readable on the given background. For a transparent background,
/// returns a middle grey, which is readable on light and on dark backgrounds.
#[must_use]
pub fn text_colour_on(ground: Option<Rgb>) -> Rgb {
    let grey = |c: u8| Rgb([c; 3]);
    match ground {
        None => grey(0x80),
        Some(Rgb([r, g, b])) => {
            // The luma weights of Rec. 601 are precise enough to distinguish light from dark.
            let luma = 0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b);
            if luma > 128.0 { grey(0x20) } else { grey(0xe8) }
        }
    }
}

/// Returns the label below a frame, such as `t = 0.25`, with a typographic minus sign.
pub(super) fn time_label(t: f64) -> String {
    format!(
        "t = {}",
        ShortNumber(t).to_string().replace('-', "\u{2212}")
    )
}

/// Displays a number with at most three decimals, without trailing zeros or negative zero.
pub(super) struct ShortNumber(pub f64);

impl fmt::Display for ShortNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let fixed = format!("{:.3}", self.0);
        let short = fixed.trim_end_matches('0').trim_end_matches('.');
        f.write_str(if short == "-0" { "0" } else { short })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STYLE: LabelStyle = LabelStyle {
        font_px: 13.0,
        line_px: 16.0,
    };

    #[test]
    fn words_are_wrapped_broken_and_cut() {
        assert_eq!(STYLE.wrap("", 100.0, 3), Vec::<String>::new());
        assert_eq!(STYLE.wrap("a  b\nc", 100.0, 3), ["a b c"]);
        let long = "x".repeat(200);
        let lines = STYLE.wrap(&long, 100.0, 3);
        assert_eq!(lines.len(), 3);
        assert!(lines[2].ends_with('\u{2026}'));
        for line in STYLE.wrap("several words that do not fit", 60.0, 9) {
            assert!(
                glyph_outlines::width(&line, STYLE.font_px) <= 60.0,
                "{line}"
            );
        }
        assert_eq!(STYLE.wrap("narrow", 0.0, 2).len(), 2);
    }

    #[test]
    fn labels_are_short() {
        assert_eq!(time_label(0.0), "t = 0");
        assert_eq!(time_label(-0.0001), "t = 0");
        assert_eq!(time_label(0.25), "t = 0.25");
        assert_eq!(time_label(1.0 / 3.0), "t = 0.333");
        assert_eq!(time_label(-0.5), "t = \u{2212}0.5");
        assert_eq!(time_label(100.0), "t = 100");
    }

    #[test]
    fn numbers_are_short_and_never_negative_zero() {
        let text = |x: f64| ShortNumber(x).to_string();
        assert_eq!(text(0.0), "0");
        assert_eq!(text(-0.0001), "0");
        assert_eq!(text(1.5), "1.5");
        assert_eq!(text(-2.0), "-2");
        assert_eq!(text(100.0), "100");
        assert_eq!(text(0.12349), "0.123");
    }
}
