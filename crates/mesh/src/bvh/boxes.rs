//! Boxes in f32, relative to a centre and scaled to the unit cube, rounded outward, and their intersection with rays.

use glam::{DVec3, Vec3, Vec3A};
use obvhs::aabb::Aabb;

use super::blocks::Blocks;
use crate::bounding_box;

/// A box in box space.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) min: Vec3,
    pub(super) max: Vec3,
}

/// The space of boxes: the built surface fills the cube from -1 to 1.
#[derive(Clone, Copy)]
pub(super) struct BoxSpace {
    pub(super) centre: DVec3,
    pub(super) scale: f64,
}

/// Boxes grow by this much of the cube, more than the rounding of everything that meets them.
const MARGIN: f32 = 1e-6;

/// This many consecutive vertices share a box: they are in Morton order, so a run of them is a patch.
pub(super) const RUN: usize = 64;

impl Span {
    pub(super) fn aabb(&self) -> Aabb {
        Aabb::new(Vec3A::from(self.min), Vec3A::from(self.max))
    }

    pub(super) fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The distance of a point, 0 inside.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        let outside = (self.min.as_dvec3() - point).max(point - self.max.as_dvec3());
        outside.max(DVec3::ZERO).length()
    }
}

impl BoxSpace {
    pub(super) fn of(positions: &[DVec3]) -> Self {
        let Some(bounds) = bounding_box(positions) else {
            return Self {
                centre: DVec3::ZERO,
                scale: 1.0,
            };
        };
        let scale = 2.0 / bounds.extent().max_element();
        Self {
            centre: bounds.centre(),
            scale: if scale.is_finite() { scale } else { 1.0 },
        }
    }

    pub(super) fn of_point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.scale
    }

    /// The f32 box of some points, rounded outward.
    pub(super) fn span(&self, points: impl IntoIterator<Item = DVec3>) -> Span {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for point in points {
            let point = self.of_point(point);
            (min, max) = (min.min(point), max.max(point));
        }
        // The margin is relative as well: a refitted surface may have left the cube.
        let margin = MARGIN * (1.0 + min.abs().max(max.abs()).max_element() as f32);
        Span {
            min: min.as_vec3() - Vec3::splat(margin),
            max: max.as_vec3() + Vec3::splat(margin),
        }
    }

    /// The box of a run of vertices.
    pub(super) fn run(&self, positions: &Blocks<DVec3>, run: usize) -> Span {
        let vertices = run * RUN..((run + 1) * RUN).min(positions.len());
        self.span(vertices.map(|vertex| positions.get(vertex)))
    }
}

/// A ray in box space; its parameter is that of the ray in world space.
pub(super) struct BoxRay {
    pub(super) origin: DVec3,
    pub(super) inverse: DVec3,
}

impl BoxRay {
    /// The ray's parameter where it enters the box, not before its origin; infinite if it misses.
    pub(super) fn entry(&self, span: &Span) -> f64 {
        let to_min = (span.min.as_dvec3() - self.origin) * self.inverse;
        let to_max = (span.max.as_dvec3() - self.origin) * self.inverse;
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            // Zero times infinity, for a ray inside a wall's plane, is NaN, which `min` and `max` ignore.
            enter = enter.max(to_min[axis].min(to_max[axis]));
            leave = leave.min(to_min[axis].max(to_max[axis]));
        }
        if enter <= leave { enter } else { f64::INFINITY }
    }
}
