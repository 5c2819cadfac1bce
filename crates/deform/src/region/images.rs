//! The mirror images of vertices if a part of a surface is its own image.

use glam::DVec3;
use pliant_mesh::{MirrorPlane, mirror_planes};

use crate::numerical::nearest::NearestPoints;

/// The share of a part's vertices that must have their image across a plane.
const MOST: f64 = 0.95;

/// A vertex is the image of another if it is this near to it, as a share of the part's size.
const NEAR: f64 = 1e-4;

/// The plane across which a part is its own image: the likeliest if there are several, because nodes in fours or eights
/// crowd.
pub(super) struct Images<'a> {
    positions: &'a [DVec3],
    plane: Option<MirrorPlane>,
    vertices: Option<NearestPoints>,
    near: f64,
}

impl<'a> Images<'a> {
    /// The images of these vertices.
    pub fn of(positions: &'a [DVec3], part: &[u32]) -> Self {
        let own: Vec<DVec3> = part.iter().map(|&vertex| positions[vertex as usize]).collect();
        let far = own.iter().map(|p| p.distance(own[0])).fold(0.0, f64::max);
        let near = NEAR * far;
        // A flat part is its own image across its own plane, vertex by vertex.
        let has_sides = |plane: &MirrorPlane| own.iter().any(|p| plane.height(*p).abs() > near);
        let planes = mirror_planes(&own).into_iter();
        let mut planes = planes.filter(|(share, plane)| *share > MOST && has_sides(plane));
        let plane = planes.next().map(|(_, plane)| plane);
        Self {
            vertices: plane
                .is_some()
                .then(|| NearestPoints::of(positions, part.iter().copied())),
            positions,
            plane,
            near,
        }
    }

    /// The vertex and its image, if it has another one. If these would be closer together than `apart`: the vertex
    /// between them, if it has none and may be taken.
    pub fn pair(&self, vertex: u32, apart: f64, may_be: impl Fn(u32) -> bool) -> Vec<u32> {
        let at = |vertex: u32| self.positions[vertex as usize];
        let Some(image) = self.image(vertex) else {
            return vec![vertex];
        };
        if at(vertex).distance(at(image)) < apart {
            let between = self
                .vertices
                .as_ref()
                .and_then(|vertices| vertices.nearest(0.5 * (at(vertex) + at(image))));
            let between = between.map(|(between, _)| between);
            if let Some(between) = between.filter(|between| may_be(*between) && self.image(*between).is_none()) {
                return vec![between];
            }
        }
        vec![vertex, image]
    }

    /// The vertex on the other side, if it is another one.
    fn image(&self, vertex: u32) -> Option<u32> {
        let image = self.plane.as_ref()?.mirrored(self.positions[vertex as usize]);
        let (nearest, distance) = self.vertices.as_ref()?.nearest(image)?;
        (distance <= self.near && nearest != vertex).then_some(nearest)
    }
}
