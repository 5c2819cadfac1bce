//! A ring that cuts a limb off, straightened, and the joint that it makes.

use std::f64::consts::TAU;

use glam::DVec3;

use super::level_set::{self, Segments};
use super::limb::{JOINT_RINGS, Joint};
use super::rings::{Body, Field, Rings, Source};
use super::shape::Shape;
use super::ways::Ways;
use crate::geodesics::DistanceSearch;
use crate::{SurfaceVertex, face_area};

/// The distance, in radii, between a ring and the plane from which a straighter ring is searched.
const SECTION_RADII: f64 = 2.0;

/// A straight joint is the narrowest ring within this many radii of the askew one, if there is one.
pub(super) const NUDGE_RADII: f64 = 0.5;

/// A straight ring is at most so many times as long as the askew one, unless the point is beyond that.
const STRAIGHT: f64 = 1.1;

/// A joint's falloff is at most this share of the distance to the limb's tip, so that most of a head keeps its shape.
const FALLOFF_SHARE: f64 = 0.25;

/// A joint's falloff has at most this share of the limb's area: a head with long ears has its tip far away, and is squat.
const FALLOFF_AREA: f64 = 0.3;

/// A ring, and the vertices that it cuts off.
pub(super) struct Cut {
    /// The middle of the ring.
    pub(super) centre: DVec3,
    /// The radius of the circle that is as long as the ring.
    pub(super) radius: f64,
    /// The vertices that it cuts off, ascending.
    pub(super) limb: Vec<SurfaceVertex>,
    /// Their share of the component's area.
    pub(super) share: f64,
    ring: Segments,
    /// The corners of the triangles that the ring goes through, with their distances from it.
    beside: Vec<(SurfaceVertex, f64)>,
}

impl Cut {
    /// The ring of a level.
    pub(super) fn of(shape: &Shape<'_>, field: &Field, rings: &Rings, level: usize) -> Self {
        let (ring, beside) = rings.ring(shape, field, level);
        let length: f64 = ring.iter().map(|[a, b]| a.distance(*b)).sum();
        let weighted: DVec3 = ring.iter().map(|[a, b]| (*a + *b) * (0.5 * a.distance(*b))).sum();
        Self {
            centre: weighted / length,
            radius: length / TAU,
            limb: rings.limb(level),
            share: rings.limb_share(level),
            ring,
            beside,
        }
    }

    /// The narrowest ring, within `nudge` radii of this one towards the body, at even distances from a plane across the limb a few radii
    /// away: those rings are straight if the limb is. `None` if there is none with the triangle of these corners on the
    /// limb.
    pub(super) fn straightened(
        &self,
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        ways: &Ways,
        corners: &[SurfaceVertex; 3],
        nudge: f64,
    ) -> Option<Self> {
        let arm = |v: SurfaceVertex| shape.positions[v.index()] - self.centre;
        let near = self.limb.iter().map(|&v| arm(v));
        let (mut sum, mut is_limb) = (DVec3::ZERO, vec![false; shape.positions.len()]);
        near.filter(|arm| arm.length() < SECTION_RADII * 2.0 * self.radius)
            .for_each(|arm| sum += arm);
        self.limb.iter().for_each(|v| is_limb[v.index()] = true);
        let axis = sum.try_normalize()?;
        let length = self.limb.iter().map(|&v| arm(v).dot(axis)).fold(0.0, f64::max);
        let height = (SECTION_RADII * self.radius).min(0.5 * length);
        let below = |v: SurfaceVertex| height - arm(v).dot(axis);
        let mut seeds = Vec::new();
        for triangle in shape.triangles {
            let is_crossed = triangle.iter().any(|&v| below(v) < 0.0) && triangle.iter().any(|&v| below(v) >= 0.0);
            if is_crossed && triangle.iter().all(|v| is_limb[v.index()]) {
                seeds.extend(triangle.map(|v| (v, below(v).max(0.0))));
            }
        }
        if seeds.is_empty() {
            return None;
        }
        let field = Field::measure(search, shape, ways, &seeds, height + nudge * self.radius);
        let rings = Rings::of(shape, &field, Body::With(self.far_from_limb(shape, &is_limb)?));
        let nearest = field.level_at(height - NUDGE_RADII * self.radius);
        let level = rings.narrowest(corners, nearest, Source::Section)?.level;
        let straight = Self::of(shape, &field, &rings, level);
        (nudge > NUDGE_RADII || straight.radius <= STRAIGHT * self.radius).then_some(straight)
    }

    /// The body's farthest point from the ring, in a straight line.
    fn far_from_limb(&self, shape: &Shape<'_>, is_limb: &[bool]) -> Option<SurfaceVertex> {
        let component = shape.topology.component(*self.limb.first()?);
        let body = shape.topology.vertices_of(component).filter(|v| !is_limb[v.index()]);
        let away = |v: &SurfaceVertex| shape.positions[v.index()].distance_squared(self.centre);
        body.max_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// The limb's farthest point from the ring, in a straight line.
    pub(super) fn tip(&self, shape: &Shape<'_>) -> SurfaceVertex {
        let away = |v: &SurfaceVertex| shape.positions[v.index()].distance_squared(self.centre);
        let farthest = self.limb.iter().max_by(|a, b| away(a).total_cmp(&away(b)));
        farthest.copied().unwrap_or(self.beside[0].0)
    }

    /// The distance from the ring within which [`FALLOFF_AREA`] of the limb is, by distances that are negative on the limb;
    /// infinite if that is beyond them.
    fn squat(&self, shape: &Shape<'_>, signed: &[f64]) -> f64 {
        let area = |v: SurfaceVertex| {
            let faces = shape.topology.faces(v, shape.triangles);
            faces
                .map(|face| face_area(shape.corners(shape.triangles[face as usize])))
                .sum::<f64>()
        };
        let whole: f64 = self.limb.iter().map(|&v| area(v)).sum();
        let near = self.limb.iter().filter(|v| signed[v.index()].is_finite());
        let mut near: Vec<(f64, f64)> = near.map(|&v| (-signed[v.index()], area(v))).collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut within = 0.0;
        let mut beyond = near.iter().skip_while(|(_, area)| {
            within += area;
            within <= FALLOFF_AREA * whole
        });
        beyond.next().map_or(f64::INFINITY, |(distance, _)| *distance)
    }

    /// The joint with its falloff; `None` if the limb has no vertex beyond it.
    pub(super) fn joint(self, search: &mut DistanceSearch, shape: &Shape<'_>) -> Option<Joint> {
        let tip = shape.positions[self.tip(shape).index()];
        let most = self.radius.min(FALLOFF_SHARE * tip.distance(self.centre));
        let mut is_limb = vec![false; shape.positions.len()];
        self.limb.iter().for_each(|v| is_limb[v.index()] = true);
        // Some triangles beyond the falloff, so that the outermost rings are closed.
        let step = self.beside.iter().map(|(_, distance)| *distance).fold(0.0, f64::max);
        let limit = most + 4.0 * step;
        let position = |v: SurfaceVertex| shape.positions[v.index()];
        let mut signed = vec![f64::NAN; shape.positions.len()];
        for &(v, distance) in search.within(shape.triangles, shape.topology, position, &self.beside, limit) {
            signed[v.index()] = if is_limb[v.index()] { -distance } else { distance };
        }
        let falloff = most.min(self.squat(shape, &signed).max(step));
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        for v in self.limb.iter().filter(|v| signed[v.index()].is_finite()) {
            sum += position(*v) - self.centre;
            count += 1.0;
        }
        let is_far = |v: &&SurfaceVertex| signed[v.index()].is_nan() || signed[v.index()] < -falloff;
        let far_side: Vec<SurfaceVertex> = self.limb.iter().filter(is_far).copied().collect();
        let mut rings = std::array::from_fn(|_| Vec::new());
        let middle = JOINT_RINGS / 2;
        for (number, ring) in rings.iter_mut().enumerate().filter(|(number, _)| *number != middle) {
            let share = number as f64 / middle as f64 - 1.0;
            *ring = level_set::segments(shape, &signed, share * falloff);
        }
        rings[middle] = self.ring;
        (!far_side.is_empty() && count > 0.0).then(|| Joint {
            tip,
            centre: self.centre,
            axis: (sum / count).normalize_or((tip - self.centre).normalize_or(DVec3::Y)),
            radius: self.radius,
            falloff,
            limb: self.limb,
            far_side,
            rings,
            up: 0,
        })
    }
}
