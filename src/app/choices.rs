//! What there is to choose from at the screen.

/// The colours of the panels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThemeChoice {
    /// Light panels on a dark ground.
    #[default]
    Dark,
    /// Dark panels on a light ground.
    Light,
}

/// The size of a screenshot of the stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CaptureScale {
    /// As many pixels as the window has.
    #[default]
    One,
    /// Twice as many along each side.
    Two,
    /// 3840 pixels along the longer side.
    FourK,
}

/// The kind of file that a recording writes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RecordFormat {
    /// One animated GIF.
    #[default]
    Gif,
    /// One animated PNG: full colour, may be transparent.
    Apng,
    /// One MP4, where `ffmpeg` is installed.
    Mp4,
    /// A folder of numbered PNGs.
    Pngs,
}
