//! The size of a picture in pixels, and its limits.
//!
//! Guarantees: a [`PixelSize`] can be allocated on an ordinary machine, so a
//! picture of it cannot fail for its size.

use std::fmt;
use std::str::FromStr;

use crate::geometry::{Bounds, DVec2};

/// The longest side of a picture in pixels; the size of graphics cards'
/// textures, and safely within what GIF can say (65,535).
pub const MAX_SIDE_PX: u32 = 16_384;

/// The most pixels of a picture: 512 MiB at four bytes each.
pub const MAX_PIXELS: u64 = 1 << 27;

/// The longer side of the largest sheet, in pixels: what every viewer opens.
pub(super) const MAX_SHEET_SIDE_PX: f64 = 8_192.0;

/// A picture's width and height in pixels, both at least 1.
///
/// ```
/// use morphospace::export::PixelSize;
/// let size: PixelSize = "1280x720".parse()?;
/// assert_eq!((size.width(), size.height()), (1280, 720));
/// assert!("100000x100000".parse::<PixelSize>().is_err());
/// # Ok::<(), morphospace::export::SizeError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelSize {
    width: u32,
    height: u32,
}

/// Why a size cannot be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PixelSizeError {
    /// Not two whole numbers with an `x` between them.
    #[error("`{0}` is not a size: write it as WIDTHxHEIGHT in pixels, for example 1280x720")]
    Unreadable(String),
    /// A side of no pixels.
    #[error("a picture of {width}x{height} pixels shows nothing: both sides must be at least 1")]
    Empty {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// Beyond [`MAX_SIDE_PX`] or [`MAX_PIXELS`].
    #[error(
        "a picture of {width}x{height} pixels is too large: a side may have {MAX_SIDE_PX} and the whole {MAX_PIXELS} pixels; SVG has no such limit when it is scaled up later"
    )]
    TooLarge {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
}

impl PixelSize {
    /// A size within the limits.
    ///
    /// # Errors
    /// [`PixelSizeError`] where a side is 0 or the picture is too large.
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

    /// The shape of `bounds`, with the longer side as given (clamped to what is
    /// legal) and the shorter one at least a tenth of it; both even.
    pub fn of_shape(bounds: Bounds, longer_side_px: u32) -> Self {
        // 8192² is half of `MAX_PIXELS`: no shape leaves the limits.
        let longer = even(longer_side_px.clamp(2, 8_192));
        let size = bounds.size();
        // Not a number for a point: that is shown in a square.
        let ratio = size.min_element() / size.max_element();
        let ratio = if ratio.is_finite() {
            ratio.max(0.1)
        } else {
            1.0
        };
        let shorter = even((f64::from(longer) * ratio).round() as u32);
        let (width, height) = if size.x >= size.y {
            (longer, shorter)
        } else {
            (shorter, longer)
        };
        Self { width, height }
    }

    /// Room for sides of any length: rounded up to whole pixels.
    ///
    /// # Errors
    /// [`PixelSizeError`] where a side is 0 or the picture is too large.
    pub(super) fn holding(sides_px: DVec2) -> Result<Self, PixelSizeError> {
        // `as` saturates, and what is far too large is refused as such.
        let [width, height] = sides_px.to_array().map(|side| side.ceil() as u32);
        Self::new(width, height)
    }

    /// Each side rounded up to an even number, as most film formats want it.
    pub fn to_even(self) -> Self {
        Self {
            width: even(self.width),
            height: even(self.height),
        }
    }

    /// Width in pixels.
    pub fn width(self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(self) -> u32 {
        self.height
    }

    /// Number of pixels.
    pub fn pixels(self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Width and height as a vector.
    pub fn as_dvec2(self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height))
    }
}

/// The next even number, at least 2; [`MAX_SIDE_PX`] is even, so no legal side
/// leaves the limit.
fn even(side_px: u32) -> u32 {
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
    fn limits_hold() {
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
    fn sizes_are_read() {
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
