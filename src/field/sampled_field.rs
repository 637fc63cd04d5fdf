//! A picture of `f32` samples read between its samples.
//!
//! Guarantees: interpolation is bilinear and exact at the samples; positions
//! outside are clamped to the outermost samples. Does not guarantee smoothness:
//! the gradient jumps from cell to cell.

use super::Grid;

/// A regular lattice of samples, borrowed: row-major, sample (x, y) at index
/// `y · width + x`. Whether row 0 is the lowest or the uppermost is the
/// caller's affair.
///
/// ```
/// use morphospace::field::Samples;
///
/// let ramp = Samples::new(2, 1, &[0.0, 10.0])?;
/// assert_eq!(ramp.bilinear(0.25, 0.0), 2.5);
/// assert_eq!(ramp.bilinear(-7.0, 3.0), 0.0);
/// # Ok::<(), morphospace::field::SamplesError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SampledField<'a> {
    width: usize,
    height: usize,
    values: &'a [f32],
}

/// Why values are no lattice of samples: of a field, a mask or a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a lattice of {width} × {height} samples needs at least one sample and as many values as samples, but {values} values were given"
)]
pub struct SampledFieldError {
    /// Samples along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// How many values were given.
    pub values: usize,
}

impl SampledFieldError {
    /// That there is a value for each sample, and one at least.
    pub(super) fn check(width: u32, height: u32, values: usize) -> Result<(), Self> {
        // As u64, which no product of two u32 leaves.
        let samples = u64::from(width) * u64::from(height);
        if samples == 0 || samples != values as u64 {
            return Err(Self {
                width,
                height,
                values,
            });
        }
        Ok(())
    }
}

impl<'a> SampledField<'a> {
    /// Reads `values` as `height` rows of `width` samples.
    ///
    /// # Errors
    /// Where a side is 0, or `values` is not `width · height` long.
    pub fn new(width: u32, height: u32, values: &'a [f32]) -> Result<Self, SampledFieldError> {
        SampledFieldError::check(width, height, values.len())?;
        Ok(Self {
            width: width as usize,
            height: height as usize,
            values,
        })
    }

    /// The samples of a grid that was checked, as many values as it has cells.
    pub(super) fn of_grid(grid: &Grid, values: &'a [f32]) -> Self {
        Self {
            width: grid.width as usize,
            height: grid.height as usize,
            values,
        }
    }

    /// Samples along a row.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width as u32
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height as u32
    }

    /// The value at (`x`, `y`) in units of samples, sample (0, 0) at (0, 0);
    /// positions outside, and NaN, are clamped to the lattice.
    #[must_use]
    pub fn bilinear(&self, x: f64, y: f64) -> f64 {
        let (left, right, u) = bracket(x, self.width);
        let (below, above, v) = bracket(y, self.height);
        let row = |y: usize| {
            let at = |x: usize| f64::from(self.values[y * self.width + x]);
            at(left) + (at(right) - at(left)) * u
        };
        row(below) + (row(above) - row(below)) * v
    }
}

/// The two samples around `x`, and how far it is from the first to the second.
fn bracket(x: f64, count: usize) -> (usize, usize, f64) {
    // In this order NaN becomes 0: `max` takes the number.
    let clamped = x.max(0.0).min((count - 1) as f64);
    let first = clamped as usize;
    (first, (first + 1).min(count - 1), clamped - first as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bilinear_is_exact_at_samples_and_linear_between() -> Result<(), SampledFieldError> {
        let values = [1.0, 2.0, 5.0, -3.0, 0.5, 7.0];
        let samples = SampledField::new(3, 2, &values)?;
        for y in 0..2 {
            for x in 0..3 {
                let expected = f64::from(values[y * 3 + x]);
                assert_eq!(samples.bilinear(x as f64, y as f64), expected);
            }
        }
        assert_eq!(samples.bilinear(0.5, 0.0), 1.5);
        assert_eq!(samples.bilinear(1.0, 0.5), 1.25);
        assert_eq!(
            samples.bilinear(1.5, 0.5),
            0.25 * (2.0 + 5.0 + 0.5 + 7.0),
            "the middle of four is their mean"
        );
        Ok(())
    }

    #[test]
    fn positions_outside_are_clamped() -> Result<(), SampledFieldError> {
        let samples = SampledField::new(2, 2, &[1.0, 2.0, 3.0, 4.0])?;
        assert_eq!(samples.bilinear(-5.0, -5.0), 1.0);
        assert_eq!(samples.bilinear(1e300, f64::INFINITY), 4.0);
        assert_eq!(samples.bilinear(f64::NAN, 0.0), 1.0);
        Ok(())
    }

    #[test]
    fn a_slice_of_the_wrong_length_is_refused() {
        assert!(SampledField::new(2, 2, &[0.0; 3]).is_err());
        assert!(SampledField::new(0, 2, &[]).is_err());
        assert!(SampledField::new(u32::MAX, u32::MAX, &[0.0; 3]).is_err());
    }
}
