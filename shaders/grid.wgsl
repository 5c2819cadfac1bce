// The ground grid: lines one step apart, every tenth stronger, and the world axes in their colours. It fades with
// distance and at grazing angles.
#include "lib/frame.wgsl"
#include "lib/colour.wgsl"
#include "lib/ground.wgsl"

// `GridUniform` in crates/render/src/frame/uniforms.rs.
struct Grid {
    // A crossing of strong lines near the camera's target, relative to the centre.
    middle: vec3f,
    // World units between lines.
    step: f32,
    // Unit vectors.
    along_u: vec3f,
    // Distance from the middle, in world units, at which the grid has faded out.
    reach: f32,
    along_v: vec3f,
    // Strength of the lines between the tenths, 0 to 1.
    fine_share: f32,
    // The crossing of the world axes, in steps from the middle.
    axes: vec2f,
    padding: vec2f,
    // sRGB with straight alpha.
    colour: vec4f,
    u_axis_colour: vec4f,
    v_axis_colour: vec4f,
}

@group(1) @binding(0) var<uniform> grid: Grid;

struct GridFragment {
    @builtin(position) position_clip: vec4f,
    // In steps from the middle.
    @location(0) at: vec2f,
    @location(1) position_view: vec3f,
}

@vertex
fn vs_grid(@builtin(vertex_index) vertex: u32) -> GridFragment {
    let corner = square_corner(vertex);
    let offset = corner * grid.reach;
    let position = vec4f(grid.middle + grid.along_u * offset.x + grid.along_v * offset.y, 1.0);
    var out: GridFragment;
    out.position_clip = frame.clip_from_world * position;
    out.at = offset / grid.step;
    out.position_view = (frame.view_from_world * position).xyz;
    return out;
}

// Pixel coverage of lines at integers. Lines less than two pixels apart turn into their mean coverage.
fn lines(at: vec2f, width_px: f32) -> f32 {
    let pixel = max(fwidth(at), vec2f(1e-6));
    let distance_px = abs(fract(at - 0.5) - 0.5) / pixel;
    let covered = clamp(vec2f(0.5 + 0.5 * width_px) - distance_px, vec2f(0.0), vec2f(1.0));
    let mean = vec2f(width_px) * pixel;
    let faded = mix(covered, min(mean, vec2f(1.0)), clamp(pixel * 2.0 - 0.4, vec2f(0.0), vec2f(1.0)));
    return max(faded.x, faded.y);
}

fn line_at(distance: f32, pixel: f32, width_px: f32) -> f32 {
    return clamp(0.5 + 0.5 * width_px - abs(distance) / max(pixel, 1e-6), 0.0, 1.0);
}

@fragment
fn fs_grid(in: GridFragment) -> @location(0) vec4f {
    let pixel = fwidth(in.at);
    let fine = lines(in.at, 1.0) * grid.fine_share;
    let strong = lines(in.at / 10.0, 1.2);
    var colour = grid.colour;
    colour.a *= max(0.45 * fine, strong);
    let on_u = line_at(in.at.y - grid.axes.y, pixel.y, 1.8);
    let on_v = line_at(in.at.x - grid.axes.x, pixel.x, 1.8);
    colour = mix(colour, grid.u_axis_colour, on_u);
    colour = mix(colour, grid.v_axis_colour, on_v);
    let from_middle = length(in.at) * grid.step / grid.reach;
    let up_view = normalize((frame.view_from_world * vec4f(cross(grid.along_u, grid.along_v), 0.0)).xyz);
    let seen = abs(dot(up_view, direction_to_eye(in.position_view)));
    let fade = (1.0 - smoothstep(0.25, 1.0, from_middle)) * smoothstep(0.015, 0.16, seen);
    return premultiplied_from_srgb(vec4f(colour.rgb, colour.a * fade), 1.0);
}
