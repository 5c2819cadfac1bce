// The one vertex shader of surfaces: picture and triangle numbers share it, so they can't disagree.
struct Surface {
    // Triangle number of the surface's first triangle among all of the frame's, plus 1.
    id_base: u32,
    // 1 when vertex colours are linear light, 0 when they are sRGB.
    colours_are_linear: u32,
    // Mean length of an edge, in world units.
    mean_edge: f32,
    padding: u32,
}

@group(1) @binding(0) var<uniform> surface: Surface;

struct SurfaceVertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    @location(3) colour: vec4f,
    @location(4) region: vec4f,
}

struct SurfaceFragment {
    @builtin(position) @invariant position_clip: vec4f,
    // Not of unit length.
    @location(0) normal_view: vec3f,
    // Towards the eye, in view space; not of unit length.
    @location(1) to_eye_view: vec3f,
    @location(2) uv: vec2f,
    // The file's vertex colour, linear.
    @location(3) colour: vec4f,
    // Linear, in alpha how much of the surface's own colour it replaces.
    @location(4) region: vec4f,
}

@vertex
fn vs_surface(vertex: SurfaceVertex) -> SurfaceFragment {
    var out: SurfaceFragment;
    out.position_clip = frame.clip_from_world * vec4f(vertex.position, 1.0);
    out.normal_view = (frame.view_from_world * vec4f(vertex.normal, 0.0)).xyz;
    let to_eye = frame.eye.xyz - vertex.position * frame.eye.w;
    out.to_eye_view = (frame.view_from_world * vec4f(to_eye, 0.0)).xyz;
    out.uv = vertex.uv;
    let decoded = linear_from_srgb_fast(vertex.colour.rgb);
    out.colour = vec4f(select(decoded, vertex.colour.rgb, surface.colours_are_linear == 1u), vertex.colour.a);
    out.region = vec4f(linear_from_srgb_fast(vertex.region.rgb), vertex.region.a * frame.region_share);
    return out;
}
