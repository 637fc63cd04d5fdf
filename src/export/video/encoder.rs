//! Video file types: which pixels ffmpeg receives, and how it encodes them.

use super::super::error::ExportError;
use super::planes::PixelFormat;

/// Container of a video file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VideoContainer {
    /// H.264, or the encoder that ffmpeg uses for MP4 instead. Has no transparency.
    Mp4,
    /// VP9, with a second stream for transparency.
    WebM,
    /// ProRes 4444, for video editing.
    Mov,
}

/// Description of how frames become a video file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct VideoEncoder {
    /// Pixels that ffmpeg receives and encodes.
    pub pixels: PixelFormat,
    /// Options of ffmpeg for the output, separated by spaces.
    pub options: &'static str,
}

/// Options of VP9: constant quality, at which the edges of flat drawings are clean, on all cores.
const VP9: &str = "-c:v libvpx-vp9 -crf 20 -b:v 0 -row-mt 1 -deadline good -cpu-used 4 -f webm";

/// Options of VP9 with transparency. Alternate reference frames are not shown, so they have no
/// counterpart in the stream with the opacity.
const VP9_TRANSPARENT: &str = "-c:v libvpx-vp9 -crf 20 -b:v 0 -row-mt 1 -deadline good \
    -cpu-used 4 -auto-alt-ref 0 -f webm";

/// Options of ProRes 4444, which stores every frame on its own.
const PRORES: &str = "-c:v prores_ks -profile:v 4444 -vendor apl0 -movflags +faststart -f mov";

impl VideoEncoder {
    /// Returns the encoder for a container.
    ///
    /// # Errors
    /// [`ExportError::Mp4Transparent`] if the container has no transparency.
    pub(super) fn new(
        container: VideoContainer,
        is_transparent: bool,
    ) -> Result<Self, ExportError> {
        let (pixels, options) = match (container, is_transparent) {
            (VideoContainer::Mp4, true) => return Err(ExportError::Mp4Transparent),
            // The fast preset suffices for flat drawings and makes files no larger; encoders without
            // presets ignore it.
            (VideoContainer::Mp4, false) => (
                PixelFormat::Yuv420,
                "-preset veryfast -movflags +faststart -f mp4",
            ),
            (VideoContainer::WebM, false) => (PixelFormat::Yuv420, VP9),
            (VideoContainer::WebM, true) => (PixelFormat::Yuva420, VP9_TRANSPARENT),
            (VideoContainer::Mov, false) => (PixelFormat::Yuv444TenBit, PRORES),
            (VideoContainer::Mov, true) => (PixelFormat::Yuva444TenBit, PRORES),
        };
        Ok(Self { pixels, options })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_mp4_refuses_transparency() {
        for container in [VideoContainer::WebM, VideoContainer::Mov] {
            let encoder = VideoEncoder::new(container, true).expect("an encoder");
            assert!(encoder.pixels.ffmpeg_name().starts_with("yuva"));
            let encoder = VideoEncoder::new(container, false).expect("an encoder");
            assert!(encoder.pixels.ffmpeg_name().starts_with("yuv4"));
        }
        let message = VideoEncoder::new(VideoContainer::Mp4, true).expect_err("no transparency");
        for way_out in [".webm", ".mov", ".apng", ".png", "background"] {
            assert!(message.to_string().contains(way_out), "{message}");
        }
    }
}
