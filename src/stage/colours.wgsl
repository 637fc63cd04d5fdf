// Cross-dissolves two pictures, each sampled at the position given by the warp.
//
// `uv` is the position in the plane relative to the part's origin. `color` holds the lookup
// positions in the source (xy) and in the target (zw), from 0 to 1, x right and y down. Textures
// are premultiplied and are decoded to linear light when sampled.

#import bevy_sprite::mesh2d_vertex_output::VertexOutput
#ifdef SRGB_OUTPUT
#import bevy_render::color_operations::linear_to_srgb
#endif
#ifdef OKLAB_OUTPUT
#import bevy_render::color_operations::linear_rgb_to_oklab
#endif

// Same fields as ColourLook in picture_material.rs.
struct Colours {
    // Minimum x and y, maximum x and y of the visible rectangle.
    window: vec4<f32>,
    // Fraction of the target in the mix.
    share: f32,
};

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> colours: Colours;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var source: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var source_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var target_picture: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var target_sampler: sampler;

// Fraction of the pixel inside the visible rectangle: the product of both axes.
fn covered(at: vec2<f32>) -> f32 {
    let pixel = max(fwidth(at), vec2(1e-20));
    let low = clamp((at - colours.window.xy) / pixel + 0.5, vec2(0.0), vec2(1.0));
    let high = clamp((colours.window.zw - at) / pixel + 0.5, vec2(0.0), vec2(1.0));
    let both = max(low + high - 1.0, vec2(0.0));
    return both.x * both.y;
}

@fragment
fn fragment(mesh: VertexOutput) -> @location(0) vec4<f32> {
    var light = vec4(0.0);
#ifdef VERTEX_COLORS
    let from_source = textureSample(source, source_sampler, mesh.color.xy);
    let from_target = textureSample(target_picture, target_sampler, mesh.color.zw);
    light = mix(from_source, from_target, colours.share);
#endif
    let alpha = light.a * covered(mesh.uv);
    var colour = vec4(light.rgb / max(light.a, 1e-6), alpha);
#ifdef SRGB_OUTPUT
    colour = vec4(linear_to_srgb(colour.rgb), colour.a);
#endif
#ifdef OKLAB_OUTPUT
    colour = vec4(linear_rgb_to_oklab(colour.rgb), colour.a);
#endif
    return colour;
}
