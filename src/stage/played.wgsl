// Vertices that are summed from a film, where there is one, and else are those of the
// mesh. Fragments are drawn by `ink.wgsl`.
//   WIRE  `uv` holds two barycentric coordinates

#import bevy_sprite::{
    mesh2d_functions as mesh_functions,
    mesh2d_vertex_output::VertexOutput,
}

struct Sum {
    weights: array<vec4<f32>, 6>,
    // How far from each end of the reel: together 1.
    shares: vec2<f32>,
    coefficients: u32,
    // In a row; 0 where the mesh has them.
    vertices: u32,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(3) var<uniform> sum: Sum;
// Row after row: where vertices are at both ends, then their coefficients.
@group(#{MATERIAL_BIND_GROUP}) @binding(4) var<storage, read> reel: array<vec2<f32>>;

struct Corner {
    @builtin(instance_index) instance_index: u32,
    @location(0) position: vec3<f32>,
    @location(1) vertex: u32,
#ifdef WIRE
    @location(2) uv: vec2<f32>,
#endif
}

fn place(vertex: u32) -> vec2<f32> {
    let begin = reel[vertex];
    let end = reel[sum.vertices + vertex];
    let way = end - begin;
    // From the nearer end, so that both are met to the last bit and what rests does
    // not tremble.
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
