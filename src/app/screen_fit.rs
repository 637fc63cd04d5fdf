//! Keeps the window within the screen it opens on: sets its initial size, its minimum size, and its
//! scale factor.
//!
//! The panels need [`MIN_SIZE`] logical pixels (points). On a screen that has fewer, such as 1280 ×
//! 720 physical pixels at scale factor 2, points are made smaller than the system asks for, so that
//! nothing is cut off.

use bevy::prelude::{Has, Local, Query, Single, UVec2, Vec2, With};
use bevy::window::{Monitor, OnMonitor, PrimaryMonitor, PrimaryWindow, Window, WindowMode};

/// Minimum size of the window, in logical pixels: wide enough for the list of keys, the widest
/// dialog.
pub const MIN_SIZE: Vec2 = Vec2::new(960.0, 540.0);

/// Width and height of the screen that the window leaves free when it opens, in logical pixels:
/// room for a title bar and a task bar, or for a dock at the side.
const MARGIN: Vec2 = Vec2::splat(80.0);

/// Minimum scale factor, in physical pixels per logical pixel (heuristic: text of 14 logical pixels
/// is then 7 physical pixels high, just legible).
const MIN_SCALE: f32 = 0.5;

/// Screen for which the window's sizes are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenFit {
    /// Size of the screen, in pixels.
    screen_px: UVec2,
    /// Scale factor that the system asks for.
    system_scale: f32,
}

impl ScreenFit {
    /// Maximum size of the window when it opens, in pixels.
    fn free_px(&self) -> Vec2 {
        (self.screen_px.as_vec2() - MARGIN * self.system_scale).max(Vec2::ONE)
    }

    /// Physical pixels per logical pixel: as the system asks for, or fewer if the panels would not
    /// fit.
    fn scale(&self) -> f32 {
        let fitting = (self.free_px() / MIN_SIZE).min_element();
        self.system_scale.min(fitting.max(MIN_SCALE))
    }

    /// Minimum size of the window, in logical pixels of the system.
    fn min_size(&self) -> Vec2 {
        MIN_SIZE * self.scale() / self.system_scale
    }

    /// Sets the scale factor, minimum size and size of a window. A window that opens (`is_first`)
    /// leaves the margin free; later the window may be as large as the screen.
    fn apply(&self, window: &mut Window, is_first: bool) {
        let is_smaller = self.scale() < self.system_scale;
        let scale = is_smaller.then_some(self.scale());
        window.resolution.set_scale_factor_override(scale);
        let min_size = self.min_size();
        window.resize_constraints.min_width = min_size.x;
        window.resize_constraints.min_height = min_size.y;
        let max_px = match is_first {
            true => self.free_px().as_uvec2(),
            false => self.screen_px,
        };
        let size = window.physical_size().min(max_px);
        window.resolution.set_physical_resolution(size.x, size.y);
    }
}

/// Fits the window to the screen it is on, whenever the screen or its scale factor changes.
pub fn fit_to_screen(
    window: Single<(&mut Window, Option<&OnMonitor>), With<PrimaryWindow>>,
    monitors: Query<(&Monitor, Has<PrimaryMonitor>)>,
    mut fitted: Local<Option<ScreenFit>>,
    mut is_placed: Local<bool>,
) {
    let (mut window, on_monitor) = window.into_inner();
    // In full screen the system sets the size.
    if window.mode != WindowMode::Windowed {
        return;
    }
    let current = on_monitor.and_then(|on| monitors.get(on.0).ok());
    // Until the system reports the window's screen, assume the primary one, where it probably
    // opens, or else the smallest one, on which it surely fits.
    let primary = monitors.iter().find(|(_, is_primary)| *is_primary);
    let area = |(monitor, _): &(&Monitor, bool)| monitor.physical_size().element_product();
    let smallest = monitors.iter().min_by_key(area);
    let Some((monitor, _)) = current.or(primary).or(smallest) else {
        return;
    };
    let fit = ScreenFit {
        screen_px: monitor.physical_size(),
        system_scale: window.resolution.base_scale_factor(),
    };
    if *fitted != Some(fit) {
        fit.apply(&mut window, !*is_placed);
        *fitted = Some(fit);
    }
    *is_placed |= on_monitor.is_some();
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::window::WindowResolution;

    /// New window of 1280 × 720 logical pixels, as the system creates it, fitted to a screen.
    fn fitted_window(screen_px: UVec2, system_scale: f32) -> Window {
        let size = Vec2::new(1280.0, 720.0) * system_scale;
        let mut resolution = WindowResolution::new(size.x as u32, size.y as u32);
        resolution.set_scale_factor(system_scale);
        let mut window = Window {
            resolution,
            ..Window::default()
        };
        let fit = ScreenFit {
            screen_px,
            system_scale,
        };
        fit.apply(&mut window, true);
        window
    }

    #[test]
    fn a_large_screen_leaves_the_window_as_it_is() {
        for scale in [1.0, 2.0] {
            let window = fitted_window(UVec2::new(3840, 2160), scale);
            assert_eq!(window.size(), Vec2::new(1280.0, 720.0));
            assert_eq!(window.scale_factor(), scale);
            assert_eq!(window.resize_constraints.min_width, MIN_SIZE.x);
        }
    }

    #[test]
    fn the_window_fits_small_screens_at_every_scale_factor() {
        for screen_px in [
            UVec2::new(1280, 720),
            UVec2::new(1366, 768),
            UVec2::new(1024, 600),
            UVec2::new(2560, 1440),
        ] {
            for scale in [1.0, 1.25, 1.5, 2.0] {
                let window = fitted_window(screen_px, scale);
                let context = format!("{screen_px} at {scale}");
                let free = screen_px.as_vec2() - MARGIN * scale;
                let size = window.physical_size();
                assert!(size.as_vec2().cmple(free).all(), "{context}");
                // One pixel is added, because pixel sizes are rounded down.
                let points = (size + UVec2::ONE).as_vec2() / window.scale_factor();
                assert!(points.cmpge(MIN_SIZE).all(), "{context}: {points}");
                // The minimum size does not exceed the window's size.
                let constraints = window.resize_constraints;
                let min = Vec2::new(constraints.min_width, constraints.min_height) * scale;
                assert!(
                    min.cmple((size + UVec2::ONE).as_vec2()).all(),
                    "{context}: {min}"
                );
            }
        }
    }

    #[test]
    fn points_are_no_smaller_than_needed() {
        let window = fitted_window(UVec2::new(1280, 720), 1.0);
        assert_eq!(window.resolution.scale_factor_override(), None);
        let window = fitted_window(UVec2::new(1280, 720), 2.0);
        // The screen's 720 pixels of height, less the margin of 160, hold 540 logical pixels.
        let scale = (720.0 - 160.0) / 540.0;
        assert!((window.scale_factor() - scale).abs() < 1e-5);
    }

    #[test]
    fn a_window_moved_to_another_screen_may_fill_it() {
        let mut window = fitted_window(UVec2::new(3840, 2160), 1.0);
        window.resolution.set_physical_resolution(1920, 1080);
        let fit = ScreenFit {
            screen_px: UVec2::new(1366, 768),
            system_scale: 1.0,
        };
        fit.apply(&mut window, false);
        assert_eq!(window.physical_size(), UVec2::new(1366, 768));
    }
}
