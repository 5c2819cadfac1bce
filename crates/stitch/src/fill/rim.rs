//! A closed line to fill.

use glam::DVec3;

/// A closed line to fill.
pub(crate) struct Rim<'a> {
    /// Its points, in order.
    pub points: &'a [DVec3],
    /// For each edge (it has the number of its first point) the third corner of the surface's triangle beyond it.
    pub beyond: &'a [DVec3],
    /// Pairs of its points that the surface already joins, ascending, lower point first.
    pub joined: &'a [[u32; 2]],
}

impl Rim<'_> {
    /// True if the surface joins two points, so that no triangle of the patch may.
    pub fn is_joined(&self, a: u32, b: u32) -> bool {
        self.joined.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }
}
