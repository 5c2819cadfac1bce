// A linear deformation evaluated where it is drawn: positions from the handles' bases, then normals from the moved
// triangles. Nothing is uploaded in a frame but four columns a handle.

// `DeformUniform` in crates/render/src/uniforms.rs.
struct Job {
    vertex_count: u32,
    handle_count: u32,
    // 1 when the file has normals of its own, which are turned along.
    has_stored: u32,
    padding: u32,
}

@group(0) @binding(0) var<uniform> job: Job;
@group(0) @binding(1) var<storage, read_write> positions: array<f32>;
@group(0) @binding(2) var<storage, read_write> normals: array<f32>;

// For each vertex its position at rest and, in bits, the number of its row; all bits set where it does not move.
@group(1) @binding(0) var<storage, read> rest: array<vec4u>;
// Row by row, one entry a handle.
@group(1) @binding(1) var<storage, read> rows: array<vec4f>;
// The motions' columns: four a handle, x, y, z and constant.
@group(1) @binding(2) var<storage, read> columns: array<vec4f>;

// For each vertex the first of the faces that its normal is the mean of, and one more at the end.
@group(2) @binding(0) var<storage, read> starts: array<u32>;
@group(2) @binding(1) var<storage, read> faces: array<u32>;
@group(2) @binding(2) var<storage, read> triangles: array<u32>;
// Two a vertex: the mean at rest, and the file's own normal, zero where it has none.
@group(2) @binding(3) var<storage, read> rest_normals: array<vec4f>;

const STILL: u32 = 0xffffffffu;
const GROUP: u32 = 64u;

fn vertex_of(id: vec3u, groups: vec3u) -> u32 {
    return id.x + id.y * groups.x * GROUP;
}

@compute @workgroup_size(64)
fn move_vertices(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = vertex_of(id, groups);
    if vertex >= job.vertex_count {
        return;
    }
    let own = rest[vertex];
    var shift = vec3f(0.0);
    if own.w != STILL {
        for (var handle = 0u; handle < job.handle_count; handle++) {
            let weights = rows[own.w * job.handle_count + handle];
            shift += columns[4u * handle].xyz * weights.x;
            shift += columns[4u * handle + 1u].xyz * weights.y;
            shift += columns[4u * handle + 2u].xyz * weights.z;
            shift += columns[4u * handle + 3u].xyz * weights.w;
        }
    }
    let moved = bitcast<vec3f>(own.xyz) + shift;
    positions[3u * vertex] = moved.x;
    positions[3u * vertex + 1u] = moved.y;
    positions[3u * vertex + 2u] = moved.z;
}

fn position_of(vertex: u32) -> vec3f {
    return vec3f(positions[3u * vertex], positions[3u * vertex + 1u], positions[3u * vertex + 2u]);
}

// `stored`, turned by the smallest rotation from one unit vector to another.
fn carried(stored: vec3f, from_normal: vec3f, to_normal: vec3f) -> vec3f {
    let cosine = dot(from_normal, to_normal);
    if cosine < -0.9999999 {
        // Half a turn has no smallest axis; any across will do.
        let helper = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 1.0, 0.0), abs(from_normal.x) > 0.9);
        let axis = normalize(cross(from_normal, helper));
        return 2.0 * dot(stored, axis) * axis - stored;
    }
    let axis = cross(from_normal, to_normal);
    return stored * cosine + cross(axis, stored) + axis * (dot(axis, stored) / (1.0 + cosine));
}

@compute @workgroup_size(64)
fn turn_normals(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = vertex_of(id, groups);
    if vertex >= job.vertex_count {
        return;
    }
    // Areas of a fine mesh are small: scaled up by the largest they survive the sum of their squares.
    var sum = vec3f(0.0);
    var largest = 0.0;
    for (var at = starts[vertex]; at < starts[vertex + 1u]; at++) {
        let first = 3u * faces[at];
        let a = position_of(triangles[first]);
        let area = cross(position_of(triangles[first + 1u]) - a, position_of(triangles[first + 2u]) - a);
        sum += area;
        largest = max(largest, max(abs(area.x), max(abs(area.y), abs(area.z))));
    }
    var normal = vec3f(0.0, 0.0, 1.0);
    if largest > 0.0 {
        let scaled = sum / largest;
        let length_squared = dot(scaled, scaled);
        if length_squared > 0.0 {
            normal = scaled * inverseSqrt(length_squared);
        }
    }
    if job.has_stored == 1u {
        let at_rest = rest_normals[2u * vertex].xyz;
        let stored = rest_normals[2u * vertex + 1u].xyz;
        if dot(stored, stored) > 0.0 {
            normal = normalize(carried(stored, at_rest, normal));
        }
    }
    normals[3u * vertex] = normal.x;
    normals[3u * vertex + 1u] = normal.y;
    normals[3u * vertex + 2u] = normal.z;
}
