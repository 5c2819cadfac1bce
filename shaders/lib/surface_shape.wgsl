// A surface's vertices: position, normal and region colour.
struct SurfaceVertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    // sRGB; alpha is the share of the surface's own colour that it replaces.
    @location(2) region: vec4f,
}

fn normal_to_view(normal: vec3f) -> vec3f {
    return (frame.view_from_world * vec4f(normal, 0.0)).xyz;
}

fn position_to_view(position: vec3f) -> vec3f {
    return (frame.view_from_world * vec4f(position, 1.0)).xyz;
}

// The region colour as square roots of linear light and premultiplied, so that between a vertex with a colour and one
// without only the colour's weight falls and no other colour is mixed in.
fn region_share(region: vec4f) -> vec4f {
    let share = region.a * frame.region_share;
    return vec4f(sqrt(linear_from_srgb_fast(region.rgb)) * share, share);
}

// A region colour composited over a linear colour. The mix is of square roots, because the eye sees a share of them as
// that share of the difference; a share of a dark colour's linear light would hardly be visible.
fn under_region(colour: vec3f, region: vec4f) -> vec3f {
    let mixed = sqrt(colour) * (1.0 - region.a) + region.rgb;
    return mixed * mixed;
}

// The unit normal of the visible side. Where interpolation turns it away from the eye, it is reflected into the visible
// hemisphere, which is continuous at the silhouette, unlike a change of sign.
fn seen_normal(normal_view: vec3f, position_view: vec3f, to_eye: vec3f, is_front: bool) -> vec3f {
    let length_squared = dot(normal_view, normal_view);
    let has_normal = length_squared > 1e-20;
    var n = select(to_eye, normal_view * inverseSqrt(length_squared), has_normal);
    n = select(-n, n, is_front);
    // Derivatives need a place that all fragments pass.
    let face = cross(dpdx(position_view), dpdy(position_view));
    let face_squared = dot(face, face);
    if face_squared > 1e-30 && (frame.flatness > 0.5 || !has_normal) {
        n = face * inverseSqrt(face_squared);
        n = select(-n, n, dot(n, to_eye) >= 0.0);
    }
    let facing = dot(n, to_eye);
    return select(n - 2.0 * facing * to_eye, n, facing >= 0.0);
}
