//! The display of the plane of symmetry, as a frame that hides and tints nothing, and of the brush's ring on its other
//! side.

use glam::DVec3;
use pliant_mesh::{Bounds, MirrorPlane};

use crate::view::ControlShape;
use crate::workspace::Workspace;

/// A violet that differs from handles and axes.
const EDGE: [u8; 4] = [170, 90, 230, 200];
const RING: [u8; 4] = [235, 235, 245, 150];

/// The extent of the plane beyond the model, as a share of its size.
const MARGIN: f64 = 0.06;

/// The plane at the model, and the image of the brush's ring.
pub(super) fn symmetry_shapes(workspace: &Workspace, ring: &[DVec3]) -> Vec<ControlShape> {
    let (Some(sides), Some(bounds)) = (
        workspace.both_sides(),
        workspace.model().and_then(|model| model.bounds()),
    ) else {
        return Vec::new();
    };
    let outline = section(&bounds, &sides.plane);
    let mut shapes = vec![ControlShape::lines(EDGE, closed(&outline))];
    // The other side of a bent shape is at another place.
    let is_at_rest = !workspace.document.is_displaced() && !workspace.document.is_applied();
    if is_at_rest && !ring.is_empty() {
        let image: Vec<DVec3> = ring.iter().map(|point| sides.plane.mirrored(*point)).collect();
        shapes.push(ControlShape::lines(RING, closed(&image)));
    }
    shapes
}

/// The segments of a closed line through these points.
pub(super) fn closed(points: &[DVec3]) -> Vec<[DVec3; 2]> {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(from, to)| [*from, *to]).collect()
}

/// The polygon of a plane's intersection with a box a little larger than the bounds, in order.
fn section(bounds: &Bounds, plane: &MirrorPlane) -> Vec<DVec3> {
    let margin = DVec3::splat(MARGIN * bounds.diagonal());
    let (min, max) = (bounds.min - margin, bounds.max + margin);
    let corner = |bits: usize| {
        let is_max = glam::BVec3::new(bits & 1 != 0, bits & 2 != 0, bits & 4 != 0);
        DVec3::select(is_max, max, min)
    };
    let edges = (0..8).flat_map(|from| [1, 2, 4].map(|bit| (from, from | bit)));
    let crossed = edges.filter(|(from, to)| from != to).filter_map(|(from, to)| {
        let ends = [corner(from), corner(to)];
        let heights = ends.map(|end| plane.height(end));
        let share = heights[0] / (heights[0] - heights[1]);
        ((heights[0] < 0.0) != (heights[1] < 0.0)).then(|| ends[0].lerp(ends[1], share))
    });
    let mut points: Vec<DVec3> = crossed.collect();
    let middle = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let (right, up) = plane.normal().any_orthonormal_pair();
    let angle = |point: &DVec3| (*point - middle).dot(up).atan2((*point - middle).dot(right));
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    points
}
