//! A curve that is laid onto a surface.

use glam::DVec3;

/// Points joined along the surface, each by the section of the surface with the plane through two of them.
#[derive(Clone, PartialEq, Debug)]
pub struct SurfaceCurve {
    /// In world space; each is put onto the nearest triangle.
    pub points: Vec<DVec3>,
    /// True if the last point is joined to the first one.
    pub is_closed: bool,
    /// The third direction of the planes.
    pub sight: Sight,
}

/// The direction that the plane through two neighbouring points contains.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Sight {
    /// The mean of the surface's normals at the points.
    Normals,
    /// That from an eye, in world space: the curve covers straight lines in its picture.
    From(DVec3),
    /// The same everywhere: that of an eye without perspective.
    Along(DVec3),
}

impl SurfaceCurve {
    /// The numbers of the points at the ends of each of its segments.
    pub(super) fn segments(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        let count = self.points.len();
        let last = if self.is_closed { count } else { count - 1 };
        (0..last).map(move |from| [from, (from + 1) % count])
    }
}
