//! A plane to mirror across.

use glam::{DMat3, DVec3};

/// The points p with n · p = d, for a unit vector n and a number d in world units.
///
/// ```
/// # use glam::DVec3;
/// # use pliant_mesh::MirrorPlane;
/// let plane = MirrorPlane::across(0, 1.0);
/// assert_eq!(plane.mirrored(DVec3::new(3.0, 4.0, 5.0)), DVec3::new(-1.0, 4.0, 5.0));
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct MirrorPlane {
    normal: DVec3,
    distance: f64,
}

impl MirrorPlane {
    /// The plane across a direction of any length, at this distance from the origin along it; `None` if that is not a
    /// plane.
    pub fn new(normal: DVec3, distance: f64) -> Option<Self> {
        let normal = normal.try_normalize()?;
        distance.is_finite().then_some(Self { normal, distance })
    }

    /// The plane across an axis of the world (0, 1, 2 for x, y, z), which it crosses at `at`.
    pub fn across(axis: usize, at: f64) -> Self {
        Self {
            normal: DVec3::AXES[axis],
            distance: at,
        }
    }

    /// n.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// d.
    pub fn distance(&self) -> f64 {
        self.distance
    }

    /// The axis of the world that is its normal, if it is exactly one.
    pub fn axis(&self) -> Option<usize> {
        DVec3::AXES.iter().position(|&axis| axis == self.normal)
    }

    /// The distance of a point in front of the plane; negative behind it.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.distance
    }

    /// The point on the other side.
    pub fn mirrored(&self, point: DVec3) -> DVec3 {
        self.mirrored_vector(point) + self.normal * (2.0 * self.distance)
    }

    /// The direction on the other side.
    pub fn mirrored_vector(&self, vector: DVec3) -> DVec3 {
        vector - self.normal * (2.0 * self.normal.dot(vector))
    }

    /// I − 2 n nᵀ.
    pub fn reflection(&self) -> DMat3 {
        DMat3::from_cols_array_2d(&DVec3::AXES.map(|axis| self.mirrored_vector(axis).to_array()))
    }
}
