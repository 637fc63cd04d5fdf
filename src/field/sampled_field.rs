//! Interpolates a lattice of `f32` samples bilinearly.
//!
//! Guaranteed: interpolation is exact at the samples; positions outside are clamped to the
//! outermost samples. Not guaranteed: smoothness. The gradient jumps where the interpolation passes
//! from one square of samples to the next.

use super::Grid;

/// Regular lattice of borrowed samples in row-major order: sample (x, y) has index `y · width + x`.
/// The caller decides whether row 0 is the lowest or the uppermost.
///
/// ```
/// use morphospace::field::SampledField;
///
/// let ramp = SampledField::new(2, 1, &[0.0, 10.0])?;
/// assert_eq!(ramp.bilinear(0.25, 0.0), 2.5);
/// assert_eq!(ramp.bilinear(-7.0, 3.0), 0.0);
/// # Ok::<(), morphospace::field::SampledFieldError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SampledField<'a> {
    width: usize,
    height: usize,
    values: &'a [f32],
}

/// Error of reading values as a lattice: the lattice is empty, or the number of values is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a lattice of {width} × {height} samples got {values} values; give one value per sample, and at least one sample"
)]
pub struct SampledFieldError {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Number of values given.
    pub values: usize,
}

impl SampledFieldError {
    /// Checks that there is one value per sample, and at least one sample.
    pub(super) fn check(width: u32, height: u32, values: usize) -> Result<(), Self> {
        // Computed as `u64`, which holds every product of two `u32`.
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
    /// Returns an error if a side is 0, or `values` does not have `width · height` elements.
    pub fn new(width: u32, height: u32, values: &'a [f32]) -> Result<Self, SampledFieldError> {
        SampledFieldError::check(width, height, values.len())?;
        Ok(Self {
            width: width as usize,
            height: height as usize,
            values,
        })
    }

    /// Reads `values` as one sample per cell of `grid`. The grid and the number of values must be
    /// valid.
    pub(super) fn of_grid(grid: &Grid, values: &'a [f32]) -> Self {
        Self {
            width: grid.width as usize,
            height: grid.height as usize,
            values,
        }
    }

    /// Number of columns.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width as u32
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height as u32
    }

    /// Returns the interpolated value at (`x`, `y`), where sample (i, j) lies at (i, j). Positions
    /// outside the lattice are clamped to it; NaN counts as 0.
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

/// Returns the indices of the two samples around `x`, and the position of `x` between them as a
/// fraction of the way from the first to the second. `count` is the number of samples.
fn bracket(x: f64, count: usize) -> (usize, usize, f64) {
    // NaN becomes 0 because `max` comes first: of NaN and a number, it returns the number.
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
