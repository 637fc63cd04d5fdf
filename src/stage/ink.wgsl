// Faces, bars, discs, wires and outlines in one colour, with smooth edges at
// any zoom. The kind of shape is a shader definition:
//   (none)  faces: the triangles are the shape
//   COATS   faces whose vertices bring their colours
//   ROUND   `uv` is where the fragment is in units of the shape's radius
//   WIRE    `uv` holds two barycentric coordinates; the edges are drawn
//   LINE    segments of constant width on the screen: the vertex shader pushes
//           each corner by `offset.xy` half line widths; `offset.z` is the
//           corner's side, −1 or 1

#import bevy_sprite::{
    mesh2d_functions as mesh_functions,
    mesh2d_vertex_output::VertexOutput,
    mesh2d_view_bindings::view,
}
#ifdef SRGB_OUTPUT
#import bevy_render::color_operations::linear_to_srgb
#endif
#ifdef OKLAB_OUTPUT
#import bevy_render::color_operations::linear_rgb_to_oklab
#endif

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> ink: vec4<f32>;

// Lines have these widths on a picture of LINE_HEIGHT pixels and grow with it.
const WIRE_PX: f32 = 1.0;
const OUTLINE_PX: f32 = 1.75;
const LINE_HEIGHT: f32 = 800.0;

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
    // One pixel more than the line, for its smooth edge.
    let reach_px = half_line_px(OUTLINE_PX) + 1.0;
    var out: VertexOutput;
    out.world_position = world_from_local * vec4(corner.position, 1.0);
    out.position = view.clip_from_world * out.world_position;
    out.position += vec4(reach_px * unit / half_view * out.position.w, 0.0, 0.0);
    out.uv = vec2(reach_px * corner.offset.z, 0.0);
    return out;
}
#endif

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
