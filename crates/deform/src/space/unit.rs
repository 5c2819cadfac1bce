//! Coordinates in which a problem is around the origin with a size of about 1.

use glam::DVec3;

/// An origin and a unit of length, so that nothing depends on a scan's position, its size and the axes' directions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Unit {
    /// The points' mean.
    pub world_origin: DVec3,
    /// The largest distance of a point from it; 1 if all are in one place.
    pub length: f64,
}

impl Unit {
    /// The unit of these points.
    pub fn of(world_points: impl Iterator<Item = DVec3> + Clone) -> Self {
        let mut rest = world_points.clone();
        let first = rest.next().unwrap_or_default();
        let count = 1 + rest.clone().count();
        let world_origin = first + rest.map(|point| point - first).sum::<DVec3>() / count as f64;
        let radius = world_points
            .map(|point| point.distance(world_origin))
            .fold(0.0, f64::max);
        Self {
            world_origin,
            length: if radius > 0.0 && radius.is_finite() {
                radius
            } else {
                1.0
            },
        }
    }

    /// A world point in these coordinates.
    pub fn local(&self, world_point: DVec3) -> DVec3 {
        (world_point - self.world_origin) / self.length
    }
}
