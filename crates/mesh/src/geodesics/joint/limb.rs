//! The joint of a limb, as it is found.

use glam::DVec3;

use crate::SurfaceVertex;

/// The number of distances across the joint's falloff at which there are rings, the joint's own in the middle.
pub const JOINT_RINGS: usize = 7;

/// The joint of a limb, and the reach of its bend.
#[derive(Clone, PartialEq, Debug)]
pub struct Joint {
    /// The middle of the ring, in world space.
    pub centre: DVec3,
    /// The unit direction from there into the limb.
    pub axis: DVec3,
    /// The radius of the circle that is as long as the ring, in world units.
    pub radius: f64,
    /// The far end of the limb, in world space.
    pub tip: DVec3,
    /// The reach of the bend along the surface to either side of the ring, in world units.
    pub falloff: f64,
    /// The limb: every vertex of the component on the point's side of the ring, ascending.
    pub limb: Vec<SurfaceVertex>,
    /// The vertices of the limb beyond the falloff, ascending; never empty.
    pub far_side: Vec<SurfaceVertex>,
    /// Lines around the limb, in any order, at even distances from `-falloff` (on the limb) to `falloff` along the
    /// surface.
    pub rings: [Vec<[DVec3; 2]>; JOINT_RINGS],
    /// The number of candidates by which it is farther from the limb's tip than the guess.
    pub up: i32,
}

impl Joint {
    /// The distance along the surface within which a handle of the far side moves the surface: its falloff to either
    /// side.
    pub fn width(&self) -> f64 {
        2.0 * self.falloff
    }
}
