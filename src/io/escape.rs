//! Escaping of names and other text for the formats that are written.
//!
//! Names of designs, layers and stops come from files and from people, so they may contain anything
//! that a format gives a meaning: markup, quotes, line breaks, control characters, formulas. There
//! is one function or wrapper for each format, and every writer of the format uses it.
//!
//! Guarantees: the text cannot end the place in which it is written, and the file stays
//! well-formed. [`json_text`] and [`XmlEscaped`] keep all visible characters. XML, JSON and DXF text
//! loses the characters that control the writing direction, so that a name cannot reorder the text
//! around it. The caller removes them from CSV cells ([`SanitizedName`](super::sanitize::SanitizedName)).

use std::fmt::{self, Write};

use serde::Serialize;

use super::sanitize::{is_direction_control, is_hidden, without_direction_controls};

/// Text escaped for XML and HTML: for element content and for attributes in quotes of either kind.
///
/// Characters that XML forbids, and other control characters, become the replacement character.
/// Line breaks and tabs become spaces, as attributes are normalised (XML 1.0, section 3.3.3).
/// Characters that control the writing direction are removed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct XmlEscaped<'a>(pub &'a str);

impl fmt::Display for XmlEscaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in self.0.chars() {
            match c {
                '&' => f.write_str("&amp;")?,
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '"' => f.write_str("&quot;")?,
                '\'' => f.write_str("&#39;")?,
                '\t' | '\n' | '\r' => f.write_char(' ')?,
                c if is_direction_control(c) => {}
                c if c.is_control() || is_noncharacter(c) => f.write_char('\u{fffd}')?,
                c => f.write_char(c)?,
            }
        }
        Ok(())
    }
}

/// Returns whether a code point is reserved as a noncharacter (Unicode, section 23.7). XML forbids
/// two of them, and HTML calls all of them parse errors.
fn is_noncharacter(c: char) -> bool {
    let code = u32::from(c);
    code & 0xfffe == 0xfffe || (0xfdd0..=0xfdef).contains(&code)
}

/// Returns a value as JSON on one line, escaped by [`escaped_json`]. Characters that control the
/// writing direction are removed from its texts.
///
/// The types that are written this way have text keys and finite numbers, so serialisation does not
/// fail; if it did, the result would be `null`.
pub(crate) fn json_text(value: &impl Serialize) -> String {
    let json = serde_json::to_string(value).unwrap_or_else(|_| "null".to_owned());
    escaped_json(&without_direction_controls(&json))
}

/// Escapes hidden characters and `<` in JSON text. Both occur within strings only, except for line
/// breaks between the lines of indented JSON, which remain.
///
/// JSON itself requires escapes only for characters below the space. Terminals also interpret
/// others, and `</script>` or `<!--` in a string would end the script element of a page in which
/// the JSON is embedded.
pub(crate) fn escaped_json(json: &str) -> String {
    let mut escaped = String::with_capacity(json.len());
    for c in json.chars() {
        if c == '<' || (is_hidden(c) && c != '\n') {
            let units = c.encode_utf16(&mut [0; 2]).to_vec();
            escaped.extend(units.iter().map(|unit| format!("\\u{unit:04x}")));
        } else {
            escaped.push(c);
        }
    }
    escaped
}

/// Returns cells as a line of CSV (RFC 4180). A cell that a spreadsheet would take for a formula
/// gets a leading apostrophe, which spreadsheets take for the mark of text; numbers stay numbers.
#[cfg(feature = "cli")]
pub(crate) fn csv_line<C: AsRef<[u8]>>(cells: impl IntoIterator<Item = C>) -> Vec<u8> {
    let guarded = cells.into_iter().map(|cell| {
        let cell = cell.as_ref();
        let guard: &[u8] = if is_formula(cell) { b"'" } else { b"" };
        [guard, cell].concat()
    });
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing to memory does not fail.
    writer.write_record(guarded).unwrap_or_default();
    writer.into_inner().unwrap_or_default()
}

/// Returns whether a spreadsheet would take a cell for a formula: it starts with one of the
/// characters that start formulas, also in their full-width form, or with a character that is
/// skipped in front of them. Numbers with a sign are no formulas.
#[cfg(feature = "cli")]
fn is_formula(cell: &[u8]) -> bool {
    let text = String::from_utf8_lossy(cell);
    let start = text.trim_start_matches([' ', '\u{a0}', '\u{feff}']);
    let is_suspect = start.starts_with([
        '=', '+', '-', '@', '\t', '\r', '\n', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}',
    ]);
    is_suspect && !is_number(&text)
}

/// Returns whether a text is a decimal number. Unlike `f64::from_str`, does not accept `-inf`.
#[cfg(feature = "cli")]
fn is_number(text: &str) -> bool {
    let is_numeric = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    text.chars().all(is_numeric) && text.parse::<f64>().is_ok()
}

/// Maximum number of characters of a name in the symbol tables of a DXF document (limit of the
/// format, DXF reference, "Symbol table names").
const MAX_DXF_NAME: usize = 255;

/// Name of a layer, block or style, escaped for a DXF document.
///
/// Characters that the format forbids in names, and control characters, which end a line, become
/// underscores; those that control the writing direction are removed. Characters beyond ASCII are
/// written as `\U+XXXX`, which readers of all versions decode, whatever the code page. Longer names
/// are cut after [`MAX_DXF_NAME`] characters. An empty name becomes an underscore.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DxfName<'a>(pub &'a str);

impl fmt::Display for DxfName<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = without_direction_controls(self.0);
        let name = name.trim();
        if name.is_empty() {
            return f.write_char('_');
        }
        for c in name.chars().take(MAX_DXF_NAME) {
            match c {
                '<' | '>' | '/' | '\\' | '"' | ':' | ';' | '?' | '*' | '|' | ',' | '=' | '`' => {
                    f.write_char('_')?;
                }
                // `^` starts a control character and `%%` a special one.
                '^' | '%' => f.write_char('_')?,
                c if is_hidden(c) => f.write_char('_')?,
                ' '..='~' => f.write_char(c)?,
                c => {
                    let mut units = [0; 2];
                    for unit in c.encode_utf16(&mut units) {
                        write!(f, "\\U+{unit:04X}")?;
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names that attack one of the formats.
    pub(crate) const HOSTILE: [&str; 14] = [
        "</script><script>alert(1)</script>",
        "\"><svg onload=alert(1)>",
        "' onload='alert(1)",
        "]]>",
        "<!--",
        "&lt;&amp;&#0;",
        "a\nb\r\nc\td",
        "\0\u{1}\u{1b}[31m\u{7f}\u{85}\u{9b}",
        "\u{202e}cod.exe\u{2066}\u{200f}",
        "\u{2028}\u{2029}\u{feff}\u{fffe}\u{ffff}",
        "=HYPERLINK(\"http://x\",\"y\")",
        "^J0\\P%%c\\U+0041",
        "{{film}}{{title}}",
        "Größe 🎈 名前",
    ];

    #[test]
    fn escaped_xml_is_well_formed_and_keeps_visible_text() {
        for name in HOSTILE {
            let escaped = XmlEscaped(name).to_string();
            for document in [
                format!("<a b=\"{escaped}\">{escaped}</a>"),
                format!("<a b='{escaped}'>{escaped}</a>"),
            ] {
                let tree = usvg::roxmltree::Document::parse(&document);
                let tree = tree.unwrap_or_else(|error| panic!("{name:?}: {error}"));
                let root = tree.root_element();
                let shown: String = (without_direction_controls(name).chars())
                    .map(|c| match c {
                        '\n' | '\r' | '\t' => ' ',
                        c if c.is_control() || is_noncharacter(c) => '\u{fffd}',
                        c => c,
                    })
                    .collect();
                assert_eq!(root.text(), Some(shown.as_str()), "{name:?}");
                assert_eq!(root.attribute("b"), Some(shown.as_str()), "{name:?}");
                assert_eq!(root.children().count(), 1, "{name:?}");
            }
        }
    }

    #[test]
    fn json_text_reads_back_and_cannot_end_a_script() {
        for name in HOSTILE {
            let json = json_text(&name);
            let read: String = serde_json::from_str(&json).expect("JSON");
            assert_eq!(read, without_direction_controls(name));
            assert!(!json.contains('<'), "{json}");
            assert!(!json.chars().any(is_hidden), "{json:?}");
        }
    }

    #[cfg(feature = "cli")]
    #[test]
    fn csv_cells_are_no_formulas_and_numbers_stay_numbers() {
        let formulas = [
            "=1+1",
            "+1+cmd|' /C calc'!A0",
            "-1+1",
            "@SUM(1)",
            "\t=1",
            "\r=1",
            " =1",
            "\u{ff1d}1",
            "-inf",
            "=HYPERLINK(\"http://x\",\"y\")",
        ];
        let harmless = [
            "-1.5e-3", "+7", "1", "a=b", "", "x\ny", "a,\"b\"", "'=", "–",
        ];
        let line = csv_line(formulas.iter().chain(&harmless));
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .from_reader(line.as_slice());
        let record = reader.records().next().expect("a row").expect("a row");
        let cells: Vec<&str> = record.iter().collect();
        for (cell, formula) in cells.iter().zip(formulas) {
            assert_eq!(*cell, format!("'{formula}"));
        }
        assert_eq!(cells[formulas.len()..], harmless);
        assert!(reader.records().next().is_none(), "one line");
        let bytes = csv_line([b"\xff.obj".as_slice()]);
        assert_eq!(bytes, b"\xff.obj\n", "bytes that are no UTF-8 are kept");
    }

    #[test]
    fn dxf_names_stay_on_their_line() {
        for name in HOSTILE {
            let escaped = DxfName(name).to_string();
            assert!(
                escaped.chars().all(|c| matches!(c, ' '..='~')),
                "{escaped:?}"
            );
            let rest = escaped.replace("\\U+", "");
            let is_forbidden = |c: char| "<>/\\\":;?*|,=`^%".contains(c);
            assert!(!rest.contains(is_forbidden), "{escaped:?}");
        }
        assert_eq!(DxfName("WALL 1").to_string(), "WALL 1");
        assert_eq!(DxfName("Größe").to_string(), "Gr\\U+00F6\\U+00DFe");
        assert_eq!(
            DxfName("\u{202e}WALL\u{200f} 1\u{2069}").to_string(),
            "WALL 1"
        );
        assert_eq!(DxfName(" \n").to_string(), "_");
        assert_eq!(DxfName("\u{202e} \u{2066}").to_string(), "_");
        assert_eq!(DxfName(&"x".repeat(999)).to_string().len(), MAX_DXF_NAME);
    }
}
