//! Cache of images uploaded to the GPU as egui textures.

use std::sync::Arc;

use bevy_egui::egui::{ColorImage, Context, Id, TextureHandle, TextureOptions};
use image::RgbaImage;

/// Uploads an image under `id`, downscaled to at most `longest_px` along its longer side.
///
/// The texture is reused until another image is passed for the same `id`. Alpha is straight.
pub fn texture(ctx: &Context, id: Id, pixels: &Arc<RgbaImage>, longest_px: u32) -> TextureHandle {
    // Images are shared and immutable, so the pointer identifies them; the cache holds a reference,
    // so no other image can take the same address.
    type CachedTexture = (Arc<RgbaImage>, TextureHandle);
    let cached = ctx.data(|data| data.get_temp::<CachedTexture>(id));
    if let Some((image, texture)) = cached
        && Arc::ptr_eq(&image, pixels)
    {
        return texture;
    }
    // A full-size photograph would cost memory and upload time; far zoomed in it loses sharpness.
    let longest = pixels.width().max(pixels.height());
    let downscaled = (longest > longest_px).then(|| {
        let scale = f64::from(longest_px) / f64::from(longest);
        let side = |px: u32| ((f64::from(px) * scale) as u32).max(1);
        image::imageops::thumbnail(&**pixels, side(pixels.width()), side(pixels.height()))
    });
    let uploaded = downscaled.as_ref().unwrap_or(pixels);
    let size = [uploaded.width() as usize, uploaded.height() as usize];
    let colours = ColorImage::from_rgba_unmultiplied(size, uploaded.as_raw());
    let texture = ctx.load_texture("a picture", colours, TextureOptions::LINEAR);
    ctx.data_mut(|data| data.insert_temp(id, (Arc::clone(pixels), texture.clone())));
    texture
}
