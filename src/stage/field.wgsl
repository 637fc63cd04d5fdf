// Blends two distance fields and cuts them at a threshold, anti-aliased at any zoom.
//
// `color` holds the lookup positions in the source (xy) and in the target (zw), in samples: sample
// (i, j) is at (i, j), row 0 is the lowest. The fields are 32-bit floats, which the graphics card
// may be unable to filter. The shader interpolates them itself and then applies L, as the CPU does.

#import bevy_sprite::{
    mesh2d_vertex_output::VertexOutput,
    mesh2d_view_bindings::view,
}
#ifdef SRGB_OUTPUT
#import bevy_render::color_operations::linear_to_srgb
#endif
#ifdef OKLAB_OUTPUT
#import bevy_render::color_operations::linear_rgb_to_oklab
#endif

// Same fields as FieldLook in field_material.rs.
struct Field {
    fill: vec4<f32>,
    inside: vec4<f32>,
    outside: vec4<f32>,
    line: vec4<f32>,
    // Blend parameter of the pair.
    t: f32,
    epsilon: f32,
    // L of the threshold.
    level: f32,
    // Distance between lines of equal distance, in cells.
    spacing: f32,
};

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> field: Field;
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var source: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var target_field: texture_2d<f32>;

// Distance to the contour, in pixels, beyond which the estimate by the gradient suffices.
const NEAR_PX: f32 = 16.0;
// Number of bisections within one pixel (tolerance: 1/64 of a pixel is finer than 8 bits can show).
const BISECTIONS: u32 = 6u;
// Width of lines, in pixels, on a picture of LINE_HEIGHT pixels; it grows with the height
// (heuristic).
const LINE_PX: f32 = 1.25;
// Height of the picture, in pixels, for which line widths are given.
const LINE_HEIGHT: f32 = 800.0;

struct Sample {
    value: f32,
    gradient: vec2<f32>,
}

// Value and gradient of a field at a position in samples, clamped to the field.
fn bilinear(samples: texture_2d<f32>, q: vec2<f32>) -> Sample {
    let last = vec2<f32>(textureDimensions(samples)) - 1.0;
    let at = clamp(q, vec2(0.0), last);
    let low = min(floor(at), max(last - 1.0, vec2(0.0)));
    let w = at - low;
    let i = vec2<i32>(low);
    let j = min(i + 1, vec2<i32>(last));
    let f00 = textureLoad(samples, vec2(i.x, i.y), 0).x;
    let f10 = textureLoad(samples, vec2(j.x, i.y), 0).x;
    let f01 = textureLoad(samples, vec2(i.x, j.y), 0).x;
    let f11 = textureLoad(samples, vec2(j.x, j.y), 0).x;
    let bottom = mix(f00, f10, w.x);
    let top = mix(f01, f11, w.x);
    var out: Sample;
    out.value = mix(bottom, top, w.y);
    out.gradient = vec2(mix(f10 - f00, f11 - f01, w.y), top - bottom);
    return out;
}

// L of FieldBlend (content/field.rs).
fn spaced(x: f32) -> f32 {
#ifdef LOG_SPACE
    return sign(x) * log(1.0 + abs(x) / field.epsilon);
#else
    return x;
#endif
}

// Derivative of L.
fn spaced_slope(x: f32) -> f32 {
#ifdef LOG_SPACE
    return 1.0 / (field.epsilon + abs(x));
#else
    return 1.0;
#endif
}

// Inverse of L: converts a blended value to a distance in cells.
fn in_cells(v: f32) -> f32 {
#ifdef LOG_SPACE
    return sign(v) * field.epsilon * (exp(min(abs(v), 80.0)) - 1.0);
#else
    return v;
#endif
}

// Lookup positions of a pixel in both fields, and their change to the next pixel to the right and
// below.
struct Sight {
    at: vec4<f32>,
    right: vec4<f32>,
    below: vec4<f32>,
};

// Lookup positions at an offset of `px` pixels.
fn moved(sight: Sight, px: vec2<f32>) -> vec4<f32> {
    return sight.at + px.x * sight.right + px.y * sight.below;
}

// Blended value minus the level that it is cut at.
fn blend(at: vec4<f32>) -> f32 {
    let f0 = bilinear(source, at.xy);
    let f1 = bilinear(target_field, at.zw);
    return (1.0 - field.t) * spaced(f0.value) + field.t * spaced(f1.value) - field.level;
}

// Same as blend, with its gradient per pixel.
fn blend_with_gradient(sight: Sight) -> Sample {
    let f0 = bilinear(source, sight.at.xy);
    let f1 = bilinear(target_field, sight.at.zw);
    let by = vec4(
        (1.0 - field.t) * spaced_slope(f0.value) * f0.gradient,
        field.t * spaced_slope(f1.value) * f1.gradient,
    );
    var out: Sample;
    out.value = (1.0 - field.t) * spaced(f0.value) + field.t * spaced(f1.value) - field.level;
    out.gradient = vec2(dot(by, sight.right), dot(by, sight.below));
    return out;
}

// Signed distance to the contour in pixels, exact within one pixel of it. The gradient alone
// overestimates it at the cusp of L, so the crossing is searched along the gradient.
fn contour_px(sight: Sight, here: Sample) -> f32 {
    let steep = length(here.gradient);
    let guess = here.value / max(steep, 1e-20);
    if steep < 1e-12 || abs(guess) > NEAR_PX { return clamp(guess, -NEAR_PX, NEAR_PX); }
    let downhill = -sign(here.value) * here.gradient / steep;
    if blend(moved(sight, downhill)) * here.value > 0.0 { return sign(here.value) * max(abs(guess), 1.0); }
    var low = 0.0;
    var high = 1.0;
    for (var k = 0u; k < BISECTIONS; k++) {
        let mid = 0.5 * (low + high);
        if blend(moved(sight, mid * downhill)) * here.value > 0.0 { low = mid; } else { high = mid; }
    }
    return sign(here.value) * 0.5 * (low + high);
}

// Composites straight-alpha colours, `top` over `below`.
fn over(top: vec4<f32>, below: vec4<f32>) -> vec4<f32> {
    let alpha = top.a + below.a * (1.0 - top.a);
    let rgb = top.rgb * top.a + below.rgb * below.a * (1.0 - top.a);
    return vec4(rgb / max(alpha, 1e-6), alpha);
}

// Multiplies the opacity.
fn faded(colour: vec4<f32>, by: f32) -> vec4<f32> {
    return vec4(colour.rgb, colour.a * by);
}

@fragment
fn fragment(mesh: VertexOutput) -> @location(0) vec4<f32> {
    var sight: Sight;
#ifdef VERTEX_COLORS
    sight.at = mesh.color;
    sight.right = dpdx(mesh.color);
    sight.below = dpdy(mesh.color);
#endif
    let here = blend_with_gradient(sight);
    let to_contour = contour_px(sight, here);
    let half_line = 0.5 * LINE_PX * max(view.viewport.w / LINE_HEIGHT, 1.0);
    let distance = in_cells(here.value + field.level) - in_cells(field.level);

    var colour = vec4(0.0);
#ifdef SIGNS
    let strength = 0.85 * (1.0 - exp(-abs(distance) / (4.0 * field.spacing)));
    colour = faded(select(field.outside, field.inside, here.value >= 0.0), strength);
#else
#ifdef FILL
    colour = faded(field.fill, clamp(to_contour + 0.5, 0.0, 1.0));
#endif
#endif
#ifdef LINES
    // Change of the blended distance per pixel.
    let slope = length(here.gradient) / spaced_slope(in_cells(here.value + field.level));
    let ring = abs(fract(distance / field.spacing - 0.5) - 0.5) * field.spacing;
    let apart = clamp(0.5 * field.spacing / max(slope, 1e-20) - half_line, 0.0, 1.0);
    let on_line = clamp(half_line + 0.5 - ring / max(slope, 1e-20), 0.0, 1.0);
    colour = over(faded(field.line, 0.55 * apart * on_line), colour);
#endif
#ifdef SIGNS
    let on_edge = clamp(2.0 * half_line + 0.5 - abs(to_contour), 0.0, 1.0);
    colour = over(faded(field.line, on_edge), colour);
#endif
#ifdef SRGB_OUTPUT
    colour = vec4(linear_to_srgb(colour.rgb), colour.a);
#endif
#ifdef OKLAB_OUTPUT
    colour = vec4(linear_rgb_to_oklab(colour.rgb), colour.a);
#endif
    return colour;
}
