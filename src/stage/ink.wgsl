// Draws faces, bars, discs, wireframes and outlines in one colour, with smooth edges at any zoom,
// and faces in paint layers. A shader definition selects the kind of shape:
//
// - (none): faces; the triangles are the shape
// - COATS: faces in paint layers; vertices bring their colours. A colour with opacity below 0
//   refers to a gradient instead: its red component is the index in the table, and `uv` is the
//   position in the gradient's own space
// - ROUND: bars and discs; `uv` is the position in units of the shape's radius
// - WIRE: wireframe; `uv` holds two barycentric coordinates, and the edges are drawn
// - LINE: outlines, segments of constant width on the screen; the vertex shader moves each corner
//   by `offset.xy` half line widths, and `offset.z` is the corner's side, −1 or 1

#import bevy_sprite::{
    mesh2d_functions as mesh_functions,
    mesh2d_vertex_output::VertexOutput,
    mesh2d_view_bindings::view,
}
#ifdef SRGB_OUTPUT
#import bevy_render::color_operations::linear_to_srgb
#endif
#ifdef COATS
#import bevy_render::color_operations::srgb_to_linear_rgb
#endif
#ifdef OKLAB_OUTPUT
#import bevy_render::color_operations::linear_rgb_to_oklab
#endif

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> ink: vec4<f32>;
#ifdef COATS
struct Gradients {
    // For each gradient: a vector of kind (0 linear, 1 radial), spread, number of stops and inner
    // radius; a vector with the focus; and for each stop two vectors, its colour and its offset.
    // Same as GradientTable in gradients.rs.
    numbers: array<vec4<f32>, 512>,
}
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var<uniform> gradients: Gradients;
#endif

// Widths of lines, in pixels, on a picture of LINE_HEIGHT pixels; they grow with the height
// (heuristic).
const WIRE_PX: f32 = 1.0;
const OUTLINE_PX: f32 = 1.75;
const LINE_HEIGHT: f32 = 800.0;

// Half of a width, scaled with the height of the picture.
fn half_line_px(width: f32) -> f32 {
    return 0.5 * width * max(view.viewport.w / LINE_HEIGHT, 1.0);
}

#ifdef LINE
struct Corner {
    @builtin(instance_index) instance_index: u32,
    @location(0) position: vec3<f32>,
    @location(1) offset: vec3<f32>,
}

@vertex
fn vertex(corner: Corner) -> VertexOutput {
    let world_from_local = mesh_functions::get_world_from_local(corner.instance_index);
    let clip_from_local = view.clip_from_world * world_from_local;
    let half_view = 0.5 * view.viewport.zw;
    let seen = (clip_from_local * vec4(corner.offset.xy, 0.0, 0.0)).xy * half_view;
    let unit = seen * length(corner.offset.xy) / max(length(seen), 1e-20);
    // One pixel wider than the line, for its smooth edge.
    let reach_px = half_line_px(OUTLINE_PX) + 1.0;
    var out: VertexOutput;
    out.world_position = world_from_local * vec4(corner.position, 1.0);
    out.position = view.clip_from_world * out.world_position;
    out.position += vec4(reach_px * unit / half_view * out.position.w, 0.0, 0.0);
    out.uv = vec2(reach_px * corner.offset.z, 0.0);
    return out;
}
#endif

#ifdef COATS
// Offset of a point along a radial gradient: the point lies on the circle whose centre and radius
// are interpolated from the inner circle to the unit circle. Below 0 if there is none.
fn round(p: vec2<f32>, focus: vec2<f32>, inner: f32) -> f32 {
    let d = p - focus;
    let grown = 1.0 - inner;
    let a = dot(focus, focus) - grown * grown;
    let b = dot(d, focus) - inner * grown;
    let c = dot(d, d) - inner * inner;
    if abs(a) < 1e-6 {
        return -0.5 * c / b;
    }
    return (-b - sqrt(max(b * b - a * c, 0.0))) / a;
}

// Colour of the gradient that starts at index `first`, at a point of its own space.
fn shaded(first: u32, p: vec2<f32>) -> vec4<f32> {
    let head = gradients.numbers[first];
    let focus = gradients.numbers[first + 1u].xy;
    var s = p.x;
    if head.x > 0.5 {
        s = round(p, focus, head.w);
    }
    if head.y > 1.5 {
        s = fract(s);
    } else if head.y > 0.5 {
        s = 1.0 - abs(2.0 * fract(0.5 * s) - 1.0);
    }
    let count = u32(head.z);
    var colour = gradients.numbers[first + 2u];
    for (var k = 1u; k < count; k++) {
        let here = gradients.numbers[first + 1u + 2u * k].x;
        let next = gradients.numbers[first + 3u + 2u * k].x;
        let way = select(f32(s >= next), clamp((s - here) / (next - here), 0.0, 1.0), next > here);
        colour = mix(colour, gradients.numbers[first + 2u + 2u * k], way);
    }
    // Stops are mixed in sRGB, as in SVG; everything after that is linear.
    return vec4(srgb_to_linear_rgb(colour.rgb), colour.a);
}
#endif

// Fraction of the pixel that the shape covers.
fn coverage(uv: vec2<f32>) -> f32 {
#ifdef LINE
    return clamp(half_line_px(OUTLINE_PX) + 0.5 - abs(uv.x), 0.0, 1.0);
#else
#ifdef WIRE
    let b = vec3(uv, 1.0 - uv.x - uv.y);
    let dx = dpdx(b);
    let dy = dpdy(b);
    let edges = abs(b) / max(sqrt(dx * dx + dy * dy), vec3(1e-12));
    // Each of the two faces at an edge draws its half of the line.
    return clamp(half_line_px(WIRE_PX) + 0.5 - min(edges.x, min(edges.y, edges.z)), 0.0, 1.0);
#else
#ifdef ROUND
    let d = length(uv);
    let slope = max(length(vec2(dpdx(d), dpdy(d))), 1e-12);
    return clamp((1.0 - d) / slope + 0.5, 0.0, 1.0);
#else
    return 1.0;
#endif
#endif
#endif
}

@fragment
fn fragment(mesh: VertexOutput) -> @location(0) vec4<f32> {
#ifdef COATS
    var colour = mesh.color;
    if colour.a < 0.0 {
        colour = shaded(u32(colour.r + 0.5), mesh.uv);
    }
#else
    var colour = vec4(ink.rgb, ink.a * coverage(mesh.uv));
#endif
#ifdef SRGB_OUTPUT
    colour = vec4(linear_to_srgb(colour.rgb), colour.a);
#endif
#ifdef OKLAB_OUTPUT
    colour = vec4(linear_rgb_to_oklab(colour.rgb), colour.a);
#endif
    return colour;
}
