// The environment light of materials, fixed to the eye: area lights in a grey room. It is drawn once into two cube
// maps: a prefiltered environment map, whose levels are blurred for rising roughness [Kar13], and a diffuse irradiance
// map.

// `EnvironmentUniform` in crates/render/src/frame/uniforms.rs.
struct Face {
    // The face's right, down and forward axes.
    right: vec4f,
    down: vec4f,
    forward: vec4f,
    // A glTF roughness, 0 to 1.
    roughness: f32,
    samples: u32,
    padding: vec2f,
}

@group(0) @binding(0) var<uniform> face: Face;

struct EnvironmentFragment {
    @builtin(position) position_clip: vec4f,
    // -1 to 1 on the face, y down.
    @location(0) at: vec2f,
}

@vertex
fn vs_environment(@builtin(vertex_index) vertex: u32) -> EnvironmentFragment {
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u)) * 2.0 - 1.0;
    var out: EnvironmentFragment;
    out.position_clip = vec4f(corner, 0.0, 1.0);
    out.at = vec2f(corner.x, -corner.y);
    return out;
}

// An upright rectangular light in the direction `towards`; `half_size` holds the tangents of its half angles.
fn area_light(direction: vec3f, towards: vec3f, half_size: vec2f, softness: f32, colour: vec3f) -> vec3f {
    let before = dot(direction, towards);
    let right = normalize(cross(vec3f(0.0, 1.0, 0.0), towards));
    let up = cross(towards, right);
    let at = vec2f(dot(direction, right), dot(direction, up)) / max(before, 1e-4);
    let inside = smoothstep(half_size + softness, half_size - softness, abs(at));
    return select(vec3f(0.0), colour * inside.x * inside.y, before > 0.02);
}

// Radiance from a direction in view space (x right, y up, z towards the eye).
fn environment(direction: vec3f) -> vec3f {
    let height = direction.y;
    let wall = mix(vec3f(0.30, 0.31, 0.33), vec3f(0.52, 0.55, 0.60), smoothstep(-0.05, 0.75, height));
    let floor = mix(vec3f(0.30, 0.31, 0.33), vec3f(0.115, 0.108, 0.100), smoothstep(0.02, -0.45, height));
    var light = select(floor, wall, height > 0.0);
    // A large soft key light at the upper left, a strip light at the right, a soft ceiling light, and two rim lights
    // from behind.
    light += area_light(direction, normalize(vec3f(-0.62, 0.62, 0.50)), vec2f(0.42, 0.34), 0.10, vec3f(5.6, 5.3, 4.9));
    light += area_light(direction, normalize(vec3f(0.93, 0.10, 0.35)), vec2f(0.13, 0.75), 0.05, vec3f(2.3, 2.5, 2.8));
    light += area_light(direction, normalize(vec3f(0.10, 0.98, 0.12)), vec2f(0.9, 0.5), 0.25, vec3f(1.25, 1.3, 1.35));
    light += area_light(direction, normalize(vec3f(0.60, 0.30, -0.74)), vec2f(0.22, 0.60), 0.08, vec3f(3.2, 3.4, 3.8));
    light += area_light(direction, normalize(vec3f(-0.70, 0.15, -0.70)), vec2f(0.16, 0.55), 0.08, vec3f(2.0, 1.9, 1.8));
    return light;
}

// The k-th of n points of the Hammersley sequence in the unit square.
fn hammersley(k: u32, n: u32) -> vec2f {
    return vec2f((f32(k) + 0.5) / f32(n), f32(reverseBits(k)) * 2.3283064365386963e-10);
}

// A tangent-space vector (z along the normal) in the space of `normal`.
fn from_tangent_space(normal: vec3f, local: vec3f) -> vec3f {
    let helper = select(vec3f(1.0, 0.0, 0.0), vec3f(0.0, 0.0, 1.0), abs(normal.z) < 0.9);
    let tangent = normalize(cross(helper, normal));
    return tangent * local.x + cross(normal, tangent) * local.y + normal * local.z;
}

fn direction_of(in: EnvironmentFragment) -> vec3f {
    return normalize(face.forward.xyz + in.at.x * face.right.xyz + in.at.y * face.down.xyz);
}

// The environment prefiltered for one roughness, with normal and view direction along the reflection [Kar13].
@fragment
fn fs_prefiltered(in: EnvironmentFragment) -> @location(0) vec4f {
    let normal = direction_of(in);
    if face.roughness < 0.01 {
        return vec4f(environment(normal), 1.0);
    }
    let a = face.roughness * face.roughness;
    var sum = vec3f(0.0);
    var weights = 0.0;
    for (var k = 0u; k < face.samples; k++) {
        let at = hammersley(k, face.samples);
        let cosine = sqrt((1.0 - at.y) / (1.0 + (a * a - 1.0) * at.y));
        let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
        let angle = 6.28318530718 * at.x;
        let half_vector = from_tangent_space(normal, vec3f(sine * cos(angle), sine * sin(angle), cosine));
        let towards = 2.0 * dot(normal, half_vector) * half_vector - normal;
        let weight = dot(normal, towards);
        if weight > 0.0 {
            sum += environment(towards) * weight;
            weights += weight;
        }
    }
    return vec4f(sum / max(weights, 1e-4), 1.0);
}

// Cosine-weighted mean radiance over the hemisphere: the irradiance by which a diffuse albedo is multiplied, divided by
// π.
@fragment
fn fs_irradiance(in: EnvironmentFragment) -> @location(0) vec4f {
    let normal = direction_of(in);
    var sum = vec3f(0.0);
    for (var k = 0u; k < face.samples; k++) {
        let at = hammersley(k, face.samples);
        let sine = sqrt(at.y);
        let angle = 6.28318530718 * at.x;
        sum += environment(from_tangent_space(normal, vec3f(sine * cos(angle), sine * sin(angle), sqrt(1.0 - at.y))));
    }
    return vec4f(sum / f32(face.samples), 1.0);
}
