// Draws the lines of a square grid of the source, deformed by the warp.
//
// `uv` is the position in the plane, `color.xy` the point of the source shown there; both relative
// to the part's origin.

#import bevy_sprite::{mesh2d_vertex_output::VertexOutput, mesh2d_view_bindings::view}
#ifdef SRGB_OUTPUT
#import bevy_render::color_operations::linear_to_srgb
#endif
#ifdef OKLAB_OUTPUT
#import bevy_render::color_operations::linear_rgb_to_oklab
#endif

// Same fields as GridLook in warp_grid.rs.
struct Grid {
    colour: vec4<f32>,
    halo: vec4<f32>,
    window: vec4<f32>,
    spacing: f32,
};

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> grid: Grid;

// Widths of lines and of their halos, in pixels, on a picture of LINE_HEIGHT pixels; they grow with
// the height (heuristic).
const LINE_PX: f32 = 1.2;
const HALO_PX: f32 = 3.2;
const LINE_HEIGHT: f32 = 800.0;

// Half of a width, scaled with the height of the picture.
fn half_px(width: f32) -> f32 {
    return 0.5 * width * max(view.viewport.w / LINE_HEIGHT, 1.0);
}

// Coverage of the pixel by a line (x), and by a line with its halo (y).
fn lines(at: vec2<f32>) -> vec2<f32> {
    let cell = at / grid.spacing;
    let pixel = max(fwidth(cell), vec2(1e-9));
    let away = abs(fract(cell - 0.5) - 0.5) / pixel;
    // Lines closer than a few pixels fade; otherwise they would merge into grey.
    let clear = clamp(1.5 - 6.0 * pixel, vec2(0.0), vec2(1.0));
    let line = clamp(half_px(LINE_PX) + 0.5 - away, vec2(0.0), vec2(1.0)) * clear;
    let wide = clamp(half_px(HALO_PX) + 0.5 - away, vec2(0.0), vec2(1.0)) * clear;
    return vec2(max(line.x, line.y), max(wide.x, wide.y));
}

@fragment
fn fragment(mesh: VertexOutput) -> @location(0) vec4<f32> {
    var cover = vec2(0.0);
#ifdef VERTEX_COLORS
    cover = lines(mesh.color.xy);
#endif
    let inside = all(mesh.uv >= grid.window.xy) && all(mesh.uv <= grid.window.zw);
    cover *= select(0.0, 1.0, inside);
    let ink = grid.colour.a * cover.x;
    let halo = grid.halo.a * cover.y * (1.0 - ink);
    let alpha = ink + halo;
    var colour = vec4((grid.colour.rgb * ink + grid.halo.rgb * halo) / max(alpha, 1e-6), alpha);
#ifdef SRGB_OUTPUT
    colour = vec4(linear_to_srgb(colour.rgb), colour.a);
#endif
#ifdef OKLAB_OUTPUT
    colour = vec4(linear_rgb_to_oklab(colour.rgb), colour.a);
#endif
    return colour;
}
