//! Uploads images to the GPU as egui textures, and caches the textures.

use std::sync::Arc;

use bevy_egui::egui::{ColorImage, Context, Id, TextureHandle, TextureOptions};
use image::RgbaImage;

/// Returns the texture of an image with straight alpha. Images larger than `longest_px` along their
/// longer side are downscaled.
///
/// The texture is cached under `id` and reused until another image is passed for the same `id`.
pub fn texture(ctx: &Context, id: Id, pixels: &Arc<RgbaImage>, longest_px: u32) -> TextureHandle {
    // Images are immutable, and the cache holds a reference, so no other image can have the same
    // address. The pointer therefore identifies the image.
    type CachedTexture = (Arc<RgbaImage>, TextureHandle);
    let cached = ctx.data(|data| data.get_temp::<CachedTexture>(id));
    if let Some((image, texture)) = cached
        && Arc::ptr_eq(&image, pixels)
    {
        return texture;
    }
    // Downscaling saves memory and upload time; the image is less sharp if the user zooms in far.
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
