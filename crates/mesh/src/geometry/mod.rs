//! Lengths, areas, angles and normals of single triangles, and boxes.
//!
//! Angles and areas come from edge lengths \[Kah14\], so that the same functions serve mollified lengths, for which
//! there are no positions.

mod areas;
mod clusters;
mod concavity;
mod curvature;
mod damage;
mod distortion;
mod ears;
mod gradient;
mod normals;
mod smooth_normals;
mod triangle_distance;
mod triangle_intersection;
mod vector3;

use glam::DVec3;
use rayon::prelude::*;

pub(crate) use areas::signed_volume;
pub use areas::{face_areas, mixed_corner_areas, mixed_voronoi_areas};
pub use concavity::concavities;
pub use curvature::mean_curvatures;
pub use damage::{Damage, Damaged, point_in_words};
pub use distortion::{Distortion, has_normal};
pub use ears::{WithoutEar, ears, turn};
pub use gradient::face_gradient;
pub use normals::vertex_normals;
pub(crate) use smooth_normals::SomeVertices;
pub(crate) use triangle_distance::{distance_to_triangle, nearest_on_triangle};
pub(crate) use triangle_intersection::triangle_intersection;
pub use vector3::Vector3;

/// An axis-aligned box, `min <= max` in each coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least coordinates.
    pub min: DVec3,
    /// The greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The length of the diagonal.
    pub fn diagonal(&self) -> f64 {
        self.extent().length()
    }

    /// The middle.
    pub fn centre(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The side lengths.
    pub fn extent(&self) -> DVec3 {
        self.max - self.min
    }

    /// The least box that holds both.
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The smallest box around positions; `None` for none.
    pub fn around(positions: impl Iterator<Item = DVec3>) -> Option<Self> {
        positions.map(|p| Self { min: p, max: p }).reduce(|a, b| a.union(&b))
    }

    /// The same, larger by `distance` on each side.
    pub fn grown(&self, distance: f64) -> Self {
        Self {
            min: self.min - distance,
            max: self.max + distance,
        }
    }

    /// Returns true if the two have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && self.max.cmpge(other.min).all()
    }

    /// The distance of a point, 0 inside.
    pub(crate) fn distance(&self, point: DVec3) -> f64 {
        (self.min - point).max(point - self.max).max(DVec3::ZERO).length()
    }
}

/// The smallest box that contains all `positions`; `None` for none. It runs on the caller's thread: the window calls it
/// too, and waiting for a job's loops would take longer than the work itself.
pub fn bounding_box(positions: &[DVec3]) -> Option<Bounds> {
    Bounds::around(positions.iter().copied())
}

/// The smallest box of a parallel iterator's positions. Minima and maxima don't depend on the order.
pub(crate) fn bounds_of(positions: impl ParallelIterator<Item = DVec3>) -> Option<Bounds> {
    positions
        .map(|p| Bounds { min: p, max: p })
        .reduce_with(|a, b| a.union(&b))
}

/// The area of a triangle.
pub fn face_area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// The unit normal of a counter-clockwise triangle; zero for one without area.
pub fn face_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// Returns true if a triangle is a line or a point to within rounding: its height is below 1e-10 of its longest edge.
pub fn is_without_area(corners: [DVec3; 3]) -> bool {
    area_vector(corners).is_none()
}

/// The normal of a counter-clockwise triangle with twice the area as its length, and this length; `None` for a triangle
/// without area.
fn area_vector([a, b, c]: [DVec3; 3]) -> Option<(DVec3, f64)> {
    let longest_squared = a
        .distance_squared(b)
        .max(b.distance_squared(c))
        .max(c.distance_squared(a));
    let area_vector = (b - a).cross(c - a);
    let double_area = area_vector.length();
    let is_line = double_area <= 1e-10 * longest_squared;
    (!is_line).then_some((area_vector, double_area))
}

/// Edge lengths; entry `i` is the edge opposite corner `i`.
pub fn edge_lengths([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [b.distance(c), c.distance(a), a.distance(b)]
}

/// The area of a triangle with these edge lengths, in any order, by Kahan's form of Heron's formula, whose relative
/// error stays a few roundings even for needles. Zero if the lengths violate the triangle inequality.
pub fn area_of_lengths(lengths: [f64; 3]) -> f64 {
    let [mut a, mut b, mut c] = lengths;
    if a < b {
        (a, b) = (b, a);
    }
    if b < c {
        (b, c) = (c, b);
    }
    if a < b {
        (a, b) = (b, a);
    }
    // a >= b >= c; the parentheses matter.
    let squared = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    0.25 * squared.max(0.0).sqrt()
}

/// Cotangents of the three angles, entry `i` at corner `i`; `lengths[i]` is the edge opposite corner `i`.
///
/// cot αᵢ = (lⱼ² + lₖ² − lᵢ²) / 4A, from [-∞, ∞]: not finite for a triangle without area, so mollify lengths first.
pub fn cotangents(lengths: [f64; 3]) -> [f64; 3] {
    let four_areas = 4.0 * area_of_lengths(lengths);
    let [a, b, c] = lengths;
    [
        ((b - a) * (b + a) + c * c) / four_areas,
        ((c - b) * (c + b) + a * a) / four_areas,
        ((a - c) * (a + c) + b * b) / four_areas,
    ]
}
