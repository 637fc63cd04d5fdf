//! Pictures on the graphics card.

use std::sync::Arc;

use bevy_egui::egui::{ColorImage, Context, Id, TextureHandle, TextureOptions};
use image::RgbaImage;

/// A picture on the graphics card, kept under a name until another one is there; straight alpha,
/// no longer or wider than `longest_px`.
pub fn texture(ctx: &Context, id: Id, pixels: &Arc<RgbaImage>, longest_px: u32) -> TextureHandle {
    // Pictures are shared and never changed: another one lies elsewhere, and the one that is shown
    // is held, so that no other takes its place.
    type CachedTexture = (Arc<RgbaImage>, TextureHandle);
    let kept = ctx.data(|data| data.get_temp::<CachedTexture>(id));
    if let Some((of, texture)) = kept
        && Arc::ptr_eq(&of, pixels)
    {
        return texture;
    }
    // Trades sharpness far zoomed in for the time and the memory of a photograph of full size.
    let longest = pixels.width().max(pixels.height());
    let small = (longest > longest_px).then(|| {
        let share = f64::from(longest_px) / f64::from(longest);
        let side = |px: u32| ((f64::from(px) * share) as u32).max(1);
        image::imageops::thumbnail(&**pixels, side(pixels.width()), side(pixels.height()))
    });
    let shown = small.as_ref().unwrap_or(pixels);
    let size = [shown.width() as usize, shown.height() as usize];
    let colours = ColorImage::from_rgba_unmultiplied(size, shown.as_raw());
    let texture = ctx.load_texture("a picture", colours, TextureOptions::LINEAR);
    ctx.data_mut(|data| data.insert_temp(id, (Arc::clone(pixels), texture.clone())));
    texture
}
