//! Image size in pixels, and its limits.
//!
//! Guarantees: an image of any [`PixelSize`] can be allocated on an ordinary machine, so nothing
//! fails later because of the size.

use std::fmt;
use std::str::FromStr;

use crate::geometry::{Bounds, DVec2};

/// Maximum side of an image, in pixels (resource limit: maximum texture size of common GPUs; also
/// well within the 65,535 of GIF).
pub const MAX_SIDE_PX: u32 = 16_384;

/// Maximum number of pixels of an image (resource limit: 512 MiB at four bytes each).
pub const MAX_PIXELS: u64 = 1 << 27;

/// Maximum side of a contact sheet, in pixels (resource limit: every image viewer opens it).
pub(super) const MAX_SHEET_SIDE_PX: f64 = 8_192.0;

/// Width and height of an image in pixels, both at least 1.
///
/// ```
/// use morphospace::export::PixelSize;
/// let size: PixelSize = "1280x720".parse()?;
/// assert_eq!((size.width(), size.height()), (1280, 720));
/// assert!("100000x100000".parse::<PixelSize>().is_err());
/// # Ok::<(), morphospace::export::PixelSizeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelSize {
    width: u32,
    height: u32,
}

/// Reason why a size is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PixelSizeError {
    /// The text is not two whole numbers separated by `x`.
    #[error("`{0}` is not a size: write it as WIDTHxHEIGHT in pixels, for example 1280x720")]
    Unreadable(String),
    /// One side is 0.
    #[error("an image of {width}x{height} pixels is empty: both sides must be at least 1")]
    Empty {
        /// Requested width.
        width: u32,
        /// Requested height.
        height: u32,
    },
    /// A side exceeds [`MAX_SIDE_PX`], or the image exceeds [`MAX_PIXELS`].
    #[error(
        "an image of {width}x{height} pixels is too large: at most {MAX_SIDE_PX} pixels per side and {MAX_PIXELS} in total are possible; write a smaller SVG, which can be scaled up later"
    )]
    TooLarge {
        /// Requested width.
        width: u32,
        /// Requested height.
        height: u32,
    },
}

impl PixelSize {
    /// Creates a size within the limits.
    ///
    /// # Errors
    /// [`PixelSizeError`] if a side is 0 or the image is too large.
    pub fn new(width: u32, height: u32) -> Result<Self, PixelSizeError> {
        if width == 0 || height == 0 {
            return Err(PixelSizeError::Empty { width, height });
        }
        let pixels = u64::from(width) * u64::from(height);
        if width.max(height) > MAX_SIDE_PX || pixels > MAX_PIXELS {
            return Err(PixelSizeError::TooLarge { width, height });
        }
        Ok(Self { width, height })
    }

    /// Returns a size with the shape of `bounds` and the given longer side, which is clamped to the
    /// limits. The shorter side is at least a tenth of the longer one. Both sides are even.
    pub fn of_shape(bounds: Bounds, longer_side_px: u32) -> Self {
        // 8192² is half of `MAX_PIXELS`, so no shape exceeds the limits.
        let longer = round_up_to_even(longer_side_px.clamp(2, 8_192));
        let size = bounds.size();
        // The ratio is NaN if the bounds are a single point, which is shown in a square image.
        let ratio = size.min_element() / size.max_element();
        let ratio = if ratio.is_finite() {
            ratio.max(0.1)
        } else {
            1.0
        };
        let shorter = round_up_to_even((f64::from(longer) * ratio).round() as u32);
        let (width, height) = if size.x >= size.y {
            (longer, shorter)
        } else {
            (shorter, longer)
        };
        Self { width, height }
    }

    /// Rounds sides of any length up to whole pixels.
    ///
    /// # Errors
    /// [`PixelSizeError`] if a side is 0 or the image is too large.
    pub(super) fn rounded_up(sides_px: DVec2) -> Result<Self, PixelSizeError> {
        // A side that does not fit into 32 bits is converted by `as` to the largest 32-bit number,
        // which is then refused as too large.
        let [width, height] = sides_px.to_array().map(|side| side.ceil() as u32);
        Self::new(width, height)
    }

    /// Rounds each side up to an even number, as most video encoders require.
    pub fn to_even(self) -> Self {
        Self {
            width: round_up_to_even(self.width),
            height: round_up_to_even(self.height),
        }
    }

    /// Returns the width in pixels.
    pub fn width(self) -> u32 {
        self.width
    }

    /// Returns the height in pixels.
    pub fn height(self) -> u32 {
        self.height
    }

    /// Returns the number of pixels.
    pub fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Returns width and height in pixels, as a vector.
    pub fn as_dvec2(self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height))
    }
}

/// Rounds up to an even number of at least 2. A legal side stays legal, because [`MAX_SIDE_PX`] is
/// even.
fn round_up_to_even(side_px: u32) -> u32 {
    side_px.next_multiple_of(2).max(2)
}

impl FromStr for PixelSize {
    type Err = PixelSizeError;

    fn from_str(text: &str) -> Result<Self, PixelSizeError> {
        let unreadable = || PixelSizeError::Unreadable(text.to_owned());
        let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(unreadable)?;
        let side = |digits: &str| digits.trim().parse::<u32>().map_err(|_| unreadable());
        Self::new(side(width)?, side(height)?)
    }
}

impl fmt::Display for PixelSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_beyond_the_limits_are_refused() {
        assert!(PixelSize::new(1, 1).is_ok());
        assert!(PixelSize::new(MAX_SIDE_PX, 8_192).is_ok());
        assert!(matches!(
            PixelSize::new(MAX_SIDE_PX, MAX_SIDE_PX),
            Err(PixelSizeError::TooLarge { .. })
        ));
        assert!(matches!(
            PixelSize::new(MAX_SIDE_PX + 1, 1),
            Err(PixelSizeError::TooLarge { .. })
        ));
        assert!(matches!(
            PixelSize::new(0, 7),
            Err(PixelSizeError::Empty { .. })
        ));
    }

    #[test]
    fn sizes_are_parsed() {
        assert_eq!("64x48".parse(), PixelSize::new(64, 48));
        assert_eq!("64X48".parse(), PixelSize::new(64, 48));
        for bad in [
            "",
            "64",
            "x",
            "64x",
            "-1x5",
            "64x48x2",
            "4294967296x1",
            "6.5x2",
        ] {
            assert!(bad.parse::<PixelSize>().is_err(), "{bad}");
        }
    }

    #[test]
    fn the_shape_of_the_design_gives_even_sides() {
        let bounds = |x, y| Bounds {
            min: DVec2::ZERO,
            max: DVec2::new(x, y),
        };
        let sides = |b| {
            let size = PixelSize::of_shape(b, 960);
            (size.width(), size.height())
        };
        assert_eq!(sides(bounds(4.0, 3.0)), (960, 720));
        assert_eq!(sides(bounds(1.0, 2.0)), (480, 960));
        assert_eq!(sides(bounds(100.0, 1.0)), (960, 96));
        assert_eq!(sides(bounds(0.0, 0.0)), (960, 960));
    }
}
