//! The colours of regions and handles on the surface, and the lines between them.

use std::sync::Arc;

use pliant_deform::Role;
use pliant_mesh::{ContourLine, Joint, SurfaceVertex};

use super::colour_revisions::ColouredBy;
use super::state::Workspace;
use crate::document::{HandleId, Paint};
use crate::region::{Rim, bounded};

/// The colour of a stiffness, sRGB with alpha: blue where it is soft (0.001), grey at 1, red where it is stiff (1000),
/// violet where it is rigid.
pub fn stiffness_colour(stiffness: f64) -> [u8; 4] {
    const SOFT: [f64; 3] = [58.0, 118.0, 214.0];
    const PLAIN: [f64; 3] = [196.0, 196.0, 192.0];
    const FIRM: [f64; 3] = [206.0, 66.0, 44.0];
    const RIGID: [u8; 4] = [126, 52, 160, 255];
    if stiffness == f64::INFINITY {
        return RIGID;
    }
    let decades = stiffness.max(f64::MIN_POSITIVE).log10() / 3.0;
    // Values near 1 are also distinct.
    let share = decades.abs().min(1.0).sqrt();
    let end = if decades < 0.0 { SOFT } else { FIRM };
    let [r, g, b] = std::array::from_fn(|i| (PLAIN[i] + (end[i] - PLAIN[i]) * share).round() as u8);
    [r, g, b, 255]
}

/// The opacity of a region's or a handle's colour over the surface's own, of 255: a tint, under which the form and the
/// file's colours stay visible. Outlines and lists have the full colours, and so have painted stiffness and highlighted
/// parts, which have no outline.
const TINT: u8 = 102;

/// The free region's and the fixed part's colours.
const FREE: [u8; 4] = [96, 150, 222, TINT];
const FIXED: [u8; 4] = [112, 112, 116, TINT];

/// The part of a limb that a press of the pose brush would turn, and the part that would bend with it.
const TURNS: [u8; 4] = [255, 150, 30, TINT];
const YIELDS: [u8; 4] = [255, 150, 30, TINT / 2];

/// The data for the colour of a vertex, sRGB; alpha is its opacity over the surface's own.
pub(crate) fn region_colour(workspace: &Workspace) -> impl Fn(SurfaceVertex) -> [u8; 4] {
    // The clay or the material stays unchanged: a share of any grey would wash it out.
    const STILL: [u8; 4] = [0; 4];
    const LIT: [u8; 4] = [255, 214, 110, 255];
    let document = &workspace.document;
    let lit = workspace.colours.lit().zip(workspace.model());
    let handles = document.handles();
    let largest = handles.iter().map(|handle| usize::from(handle.id.0) + 1).max();
    let mut of_handle = vec![STILL; largest.unwrap_or(0)];
    for handle in handles.iter().filter(|handle| handle.visible) {
        let [red, green, blue, _] = handle.colour;
        of_handle[usize::from(handle.id.0)] = [red, green, blue, TINT];
    }
    let by = workspace.colours.by();
    let (fluid, flowing) = (document.fluid(), workspace.flow.colours());
    let dye = move |vertex: usize| match flowing {
        Some(colours) => colours[vertex],
        None => fluid.colour(vertex),
    };
    let turning = workspace.colours.turning();
    move |vertex| {
        if lit.is_some_and(|(part, model)| model.topology.component(vertex) == part) {
            return LIT;
        }
        if by == ColouredBy::Stiffness {
            return stiffness_colour(document.stiffness().map_or(1.0, |field| field[vertex.index()]));
        }
        let dye = dye(vertex.index());
        if by == ColouredBy::Dye {
            return dye;
        }
        if let Some(joint) = turning.filter(|joint| joint.limb.binary_search(&vertex).is_ok()) {
            let turns_whole = joint.far_side.binary_search(&vertex).is_ok();
            return layered(if turns_whole { TURNS } else { YIELDS }, dye);
        }
        let tint = match document.paint[vertex.index()] {
            Paint::Fixed => FIXED,
            Paint::Free => FREE,
            Paint::Handle(HandleId(id)) => of_handle.get(usize::from(id)).copied().unwrap_or(STILL),
            Paint::Bare => match workspace.computed().region.roles.get(vertex.index()) {
                Some(Role::Free) => FREE,
                _ => STILL,
            },
        };
        layered(tint, dye)
    }
}

/// A colour over another, both with their opacities.
fn layered(top: [u8; 4], under: [u8; 4]) -> [u8; 4] {
    match (top[3], under[3]) {
        (_, 0) => return top,
        (0, _) => return under,
        _ => {}
    }
    let [above, below] = [top, under].map(|colour| f64::from(colour[3]) / 255.0);
    let below = below * (1.0 - above);
    let whole = above + below;
    let mix = |k: usize| (f64::from(top[k]) * above + f64::from(under[k]) * below) / whole;
    [mix(0), mix(1), mix(2), 255.0 * whole].map(|value| value.round() as u8)
}

/// Highlights a connected part, by its component's number, instead of the last one; `None` highlights none.
pub(crate) fn light_part(workspace: &mut Workspace, part: Option<u32>) {
    let Some(model) = workspace.model().map(Arc::clone) else {
        return;
    };
    let topology = &model.topology;
    let part = part.filter(|&part| (part as usize) < topology.components().len());
    let before = workspace.colours.lit();
    if part != before {
        let changed = before.into_iter().chain(part);
        let vertices: Vec<_> = changed.flat_map(|part| topology.vertices_of(part)).collect();
        workspace.colours.light(part, &vertices);
    }
}

/// Tints the limb that a press would turn, by its joint, instead of the last one; `None` tints none.
pub(crate) fn tint_limb(workspace: &mut Workspace, joint: Option<&Arc<Joint>>) {
    let before = workspace.colours.turning();
    if before.map(Arc::as_ptr) != joint.map(Arc::as_ptr) {
        workspace.colours.tint_limb(joint.cloned());
    }
}

/// The lines between the last measured regions, each with the region that it bounds; those of hidden handles and on
/// hidden triangles are left out.
pub(crate) fn rims(workspace: &Workspace) -> impl Iterator<Item = (&ContourLine, Rim)> {
    let region = &workspace.computed().region;
    let is_seen = |rim: &Rim| match rim {
        Rim::Held => true,
        Rim::Handle(id) => workspace.document.handle(*id).is_some_and(|handle| handle.visible),
    };
    let lines = region.rims.iter();
    let shown = lines.filter(|line| workspace.vertex_access.shows_triangle(line.triangle));
    shown.filter_map(move |line| Some((line, bounded(line.label, &region.handles).filter(is_seen)?)))
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::{FIXED, FREE, TINT};
    use crate::document::{HANDLE_COLOURS, from_srgb};

    /// The perceived colours, in linear light, without and with the three blindnesses [MOF09, severity 1], by rows.
    const VISIONS: [(&str, [f64; 9]); 4] = [
        ("none", [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]),
        (
            "protanopia",
            [
                0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998,
            ],
        ),
        (
            "deuteranopia",
            [
                0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881,
            ],
        ),
        (
            "tritanopia",
            [
                1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367, 0.303900,
            ],
        ),
    ];

    /// A colour as linear light.
    fn linear([red, green, blue, _]: [u8; 4]) -> DVec3 {
        DVec3::from_array([red, green, blue].map(from_srgb))
    }

    /// Linear light in CIE L*a*b* under a vision.
    fn seen(light: DVec3, vision: &[f64; 9]) -> DVec3 {
        let light = (DMat3::from_cols_array(vision).transpose() * light).clamp(DVec3::ZERO, DVec3::ONE);
        let to_xyz = DMat3::from_cols(
            DVec3::new(0.4124, 0.2126, 0.0193),
            DVec3::new(0.3576, 0.7152, 0.1192),
            DVec3::new(0.1805, 0.0722, 0.9505),
        );
        let xyz = to_xyz * light / DVec3::new(0.95047, 1.0, 1.08883);
        let [x, y, z] = xyz.to_array().map(|t| {
            if t > 0.008856 {
                t.cbrt()
            } else {
                7.787 * t + 16.0 / 116.0
            }
        });
        DVec3::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
    }

    /// Asserts that every two of the colours are more than `least` apart under every vision. Two adjacent colours look
    /// different from about 2 on.
    fn assert_apart(colours: impl Iterator<Item = DVec3>, least: f64) {
        let colours: Vec<DVec3> = colours.collect();
        for (name, vision) in &VISIONS {
            for (number, first) in colours.iter().enumerate() {
                for (other, second) in colours[..number].iter().enumerate() {
                    let apart = seen(*first, vision).distance(seen(*second, vision));
                    assert!(apart > least, "{name}: {number} and {other} are {apart:.1} apart");
                }
            }
        }
    }

    fn all() -> impl Iterator<Item = DVec3> {
        HANDLE_COLOURS.into_iter().chain([FREE, FIXED]).map(linear)
    }

    #[test]
    fn regions_and_handles_are_told_apart_under_every_common_colour_blindness() {
        assert_apart(all(), 15.0);
    }

    #[test]
    fn so_are_their_tints_on_dark_and_light_surfaces() {
        // `under_region` in shaders/lib/surface_shape.wgsl.
        let share = f64::from(TINT) / 255.0;
        for grey in [0.15, 0.3, 0.45, 0.6] {
            let tinted = |colour: DVec3| {
                let mixed = DVec3::splat(f64::sqrt(grey)) * (1.0 - share) + colour.map(f64::sqrt) * share;
                mixed * mixed
            };
            assert_apart(all().map(tinted), 5.0);
        }
    }
}
