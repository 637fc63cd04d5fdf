//! Material that draws cross-dissolved pictures: both pictures are textures, which the fragment
//! shader mixes.
//!
//! Guaranteed: pictures are mixed in linear light with premultiplied alpha, as by [`PicturePair`];
//! an opaque picture shown at its original size keeps its pixel values. Not guaranteed: the last
//! digits. Pixel values agree with those of the CPU to about 1 of 255.

use bevy::asset::RenderAssetUsages;
use bevy::image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor, ToExtents};
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, ShaderType, TextureDimension, TextureFormat};
use bevy::shader::ShaderRef;
use bevy::sprite_render::{AlphaMode2d, Material2d};
use glam::DVec2;

use crate::content::{PictureLayer, PicturePair};

use super::ink_material::{embedded_shader_path, relative_rectangle};

/// Material with two pictures, and with the fraction in which they are mixed.
#[derive(Asset, TypePath, AsBindGroup, Clone, Debug)]
pub(super) struct PictureMaterial {
    #[uniform(0)]
    pub(super) look: PictureUniform,
    #[texture(1)]
    #[sampler(2)]
    source: Handle<Image>,
    #[texture(3)]
    #[sampler(4)]
    target: Handle<Image>,
}

/// Uniform of [`PictureMaterial`], with the same members as in `colours.wgsl`.
#[derive(ShaderType, Clone, Debug, Default, PartialEq)]
pub(super) struct PictureUniform {
    /// Rectangle outside which nothing is drawn, relative to the origin of the render part: minimum
    /// x and y, maximum x and y.
    window: Vec4,
    /// Fraction of the target picture in the mix.
    share: f32,
}

impl Material2d for PictureMaterial {
    fn fragment_shader() -> ShaderRef {
        ShaderRef::Path(embedded_shader_path("colours.wgsl"))
    }

    fn alpha_mode(&self) -> AlphaMode2d {
        AlphaMode2d::Blend
    }
}

impl PictureMaterial {
    pub(super) fn new(pair: &PicturePair, images: &mut Assets<Image>) -> Self {
        let [source, target] = pair.layers();
        Self {
            look: PictureUniform::default(), // set when it is drawn
            source: images.add(texture(source)),
            target: images.add(texture(target)),
        }
    }
}

impl PictureUniform {
    pub(super) fn new(pair: &PicturePair, t: f64, origin: DVec2) -> Self {
        Self {
            window: relative_rectangle(pair.window(t), origin),
            share: pair.mix().target_fraction(t) as f32,
        }
    }
}

/// Returns a texture of a picture with all mipmap levels, with premultiplied alpha and encoded as
/// sRGB. The graphics card decodes sRGB before it interpolates.
fn texture(layer: &PictureLayer) -> Image {
    let (width, height) = layer.picture().pixels().dimensions();
    let (bytes, levels) = layer.texture();
    // `Image::new` cannot be used, because it accepts only the largest mipmap level.
    let mut image = Image::new_uninit(
        UVec2::new(width, height).to_extents(),
        TextureDimension::D2,
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.texture_descriptor.mip_level_count = levels;
    image.data = Some(bytes);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::MirrorRepeat,
        address_mode_v: ImageAddressMode::MirrorRepeat,
        ..ImageSamplerDescriptor::linear()
    });
    image
}
