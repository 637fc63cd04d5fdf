//! Formats numbers for reports, and lines with aligned columns.

use crate::io::sanitize::SanitizedLine;

/// Formats a number with at most three decimals, without trailing zeros. From 1 on, it has at least
/// four significant digits. Below 5e-4 and from 1e7 on, it has an exponent and two digits.
pub(in crate::cli) fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return format!("{x:.0}");
    }
    // Three decimals would show too few digits, or the number would be too long for a column.
    if !(5e-4..1e7).contains(&size) {
        return format!("{x:.1e}");
    }
    let decimals = match size {
        s if s >= 1000.0 => 0,
        s if s >= 100.0 => 1,
        s if s >= 10.0 => 2,
        _ => 3,
    };
    let fixed = format!("{x:.decimals$}");
    if fixed.contains('.') {
        let trimmed = fixed.trim_end_matches('0').trim_end_matches('.');
        return trimmed.to_owned();
    }
    fixed
}

/// Text of a report, assembled line by line.
#[derive(Default)]
pub(in crate::cli) struct NumberLines(pub String);

impl NumberLines {
    /// Adds a line, without trailing spaces and control characters.
    pub fn line(&mut self, text: &str) {
        self.0 += &SanitizedLine(text.trim_end()).to_string();
        self.0.push('\n');
    }

    /// Adds an empty line.
    pub fn gap(&mut self) {
        self.0.push('\n');
    }

    /// Adds a line with a name, padded to `width` characters, and cells that are aligned to the
    /// right in columns of 12 characters.
    pub fn cells<C: AsRef<str>>(
        &mut self,
        (name, width): (&str, usize),
        cells: impl IntoIterator<Item = C>,
    ) {
        let cell = |cell: C| format!("{:>12}", cell.as_ref());
        let cells: String = cells.into_iter().map(cell).collect();
        self.line(&format!("{name:<width$}{cells}"));
    }
}

/// Formats a fraction as a percentage.
pub(super) fn percent(fraction: f64) -> String {
    format!("{} %", short(100.0 * fraction))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (1.23456, "1.235"),
            (1200.0, "1200"),
            (123.456, "123.5"),
            (1.5e-12, "1.5e-12"),
            (3.2e9, "3.2e9"),
            (-0.5, "-0.5"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(x), text);
        }
    }
}
