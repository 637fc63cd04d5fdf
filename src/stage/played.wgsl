// Vertex shader that evaluates a recording. Without one it uses the vertices of the mesh. Fragments
// are drawn by `ink.wgsl`.
//
// With the shader definition WIRE, `uv` holds two barycentric coordinates.

#import bevy_sprite::{
    mesh2d_functions as mesh_functions,
    mesh2d_vertex_output::VertexOutput,
}

// Same fields as RecordedSum in recorded_material.rs.
struct Sum {
    weights: array<vec4<f32>, 6>,
    // Distance from each end of the recorded interval; the two sum to 1.
    shares: vec2<f32>,
    coefficients: u32,
    // Number of vertices per row; 0 if the positions are those of the mesh.
    vertices: u32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(3) var<uniform> sum: Sum;
// Row by row: the positions at both ends of the interval, then the coefficient rows.
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var<storage, read> reel: array<vec2<f32>>;

struct Corner {
    @builtin(instance_index) instance_index: u32,
    @location(0) position: vec3<f32>,
    @location(1) vertex: u32,
#ifdef WIRE
    @location(2) uv: vec2<f32>,
#endif
}

// Position of a vertex: the straight line between the ends, plus the polynomial terms.
fn place(vertex: u32) -> vec2<f32> {
    let begin = reel[vertex];
    let end = reel[sum.vertices + vertex];
    let way = end - begin;
    // Computed from the nearer end, so that both ends are exact and vertices at rest do not jitter.
    let straight = select(
        end - sum.shares.y * way,
        begin + sum.shares.x * way,
        sum.shares.x < sum.shares.y,
    );
    var off = vec2(0.0);
    for (var k = 0u; k < sum.coefficients; k++) {
        off += sum.weights[k / 4u][k % 4u] * reel[(k + 2u) * sum.vertices + vertex];
    }
    return straight + off;
}

@vertex
fn vertex(corner: Corner) -> VertexOutput {
    var at = corner.position;
    if sum.vertices > 0u {
        at = vec3(place(corner.vertex), 0.0);
    }
    let world_from_local = mesh_functions::get_world_from_local(corner.instance_index);
    var out: VertexOutput;
    out.world_position = world_from_local * vec4(at, 1.0);
    out.position = mesh_functions::mesh2d_position_world_to_clip(out.world_position);
#ifdef WIRE
    out.uv = corner.uv;
#endif
    return out;
}
