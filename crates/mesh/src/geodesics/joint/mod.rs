//! The joint of a limb: the narrowest ring around the surface between a point and the body.
//!
//! Rings are level sets of the distance along the surface from the point ([`rings`]). The first ring that is narrower
//! than the rings before and after it gives the limb; its farthest point is the tip. Rings around the tip run straight
//! across the limb, while rings around a point on its side are askew. The narrowest ring around the tip gives a plane
//! across the limb, and the joint is the narrowest ring at an even distance from that plane.
//!
//! A person can ask for another joint than this guess. The candidates are the rings around the tip that are narrower
//! than their surroundings, and evenly spaced ones where there is none for a while ([`candidates`]).
//!
//! If a limb is as thick as it is long, no ring around a point on its side closes before it reaches the body. Rings
//! around a point on a head's side close, but around the face. In both cases the tip is the point farthest from the other
//! end of the surface whose way from there goes through the point ([`far_tip`]).

mod candidates;
mod level_set;
mod rings;
mod shape;

use std::f64::consts::TAU;

use glam::DVec3;

use self::level_set::Segments;
pub use self::level_set::crossing as level_crossing;
use self::rings::{Body, End, Field, Narrowest, Rings, Source};
pub use self::shape::Shape;
use super::DistanceSearch;
use crate::{Cancel, Cancelled, SurfaceVertex};

/// If a point is so near to the tip of its rings that it is itself the tip, and the far tip is within so many radii, the
/// point is on the side of a head, not at the tip of a limb.
const HEAD_RADII: f64 = 3.0;

/// The tip of a limb is as far as possible from the other end of the surface, less so many times the detour through the
/// seeds.
const DETOUR: f64 = 1.0;

/// The first search covers this share of the component's extent; only if that is not enough does another search cover
/// all of it.
const FIRST_SHARE: f64 = 0.35;

/// The distance, in radii, between a ring and the plane from which a straighter ring is searched.
const SECTION_RADII: f64 = 2.0;

/// A straight joint is the narrowest ring within this many radii of the askew one, if there is one.
const NUDGE_RADII: f64 = 0.5;

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

/// The joint between a point in a triangle and the body, which has two fifths of the component's area or more; `None`
/// if no ring around the point's side is clearly shorter than that of a disc, as on a ball or a sheet.
///
/// `up` chooses the joint that is so many candidates farther from the limb's tip than the guess, which is the first one
/// beyond the point. If there are fewer, the last one is taken, and [`Joint::up`] has its number; it is 0 if `up` is
/// negative.
///
/// # Errors
/// [`Cancelled`] soon after `cancel` is raised.
///
/// # Panics
/// If there is no such triangle.
pub fn joint_of(
    shape: &Shape<'_>,
    triangle: u32,
    point: DVec3,
    up: i32,
    cancel: &Cancel,
) -> Result<Option<Joint>, Cancelled> {
    let corners = shape.triangles[triangle as usize];
    let seeds = corners.map(|v| (v, shape.positions[v.index()].distance(point)));
    let mut search = DistanceSearch::default();
    let near = FIRST_SHARE * extent(shape, corners[0]);
    let askew = Cut::narrowest(&mut search, shape, &seeds, near, &corners, cancel)?;
    let from_rings = askew.as_ref().map(|askew| {
        let tip = askew.tip(shape);
        Origin {
            tip,
            near: 1.6 * shape.positions[tip.index()].distance(askew.centre) + 4.0 * askew.radius,
            source: Source::Tip,
        }
    });
    let away = |origin: &Origin| shape.positions[origin.tip.index()].distance(point);
    let is_tip_itself = |askew: &Cut| from_rings.as_ref().is_some_and(|origin| away(origin) < askew.radius);
    // The far tip costs two searches of the whole surface, so it is found only where it may be needed, and once.
    let mut origins = Vec::new();
    if let Some(askew) = askew.as_ref().filter(|askew| is_tip_itself(askew)) {
        let far = Origin::far(&mut search, shape, &seeds, cancel)?;
        let is_on_head = (askew.radius..HEAD_RADII * askew.radius).contains(&away(&far));
        origins.extend(from_rings);
        origins.insert(if is_on_head { 0 } else { origins.len() }, far);
    } else {
        origins.extend(from_rings);
    }
    let mut found = Cut::first_candidate(&mut search, shape, &origins, &corners, up, cancel)?;
    if found.is_none() && origins.len() < 2 {
        let far = Origin::far(&mut search, shape, &seeds, cancel)?;
        found = Cut::candidate(&mut search, shape, far, &corners, up, cancel)?;
    }
    let Some((cut, up)) = found else {
        return Ok(None);
    };
    let straight = cut.straightened(&mut search, shape, &corners);
    cancel.check()?;
    let joint = straight.unwrap_or(cut).joint(&mut search, shape);
    Ok(joint.map(|joint| Joint { up, ..joint }))
}

/// The tip of the seeds' limb: a point far from the other end of the surface to which the way from there goes through the
/// seeds, or nearly so.
///
/// # Errors
/// [`Cancelled`].
fn far_tip(
    search: &mut DistanceSearch,
    shape: &Shape<'_>,
    seeds: &[(SurfaceVertex, f64); 3],
    cancel: &Cancel,
) -> Result<SurfaceVertex, Cancelled> {
    let position = |v: SurfaceVertex| shape.positions[v.index()];
    let mut distances = |from: &[(SurfaceVertex, f64)]| {
        let mut distance = vec![f64::NEG_INFINITY; shape.positions.len()];
        let reached = search.within(shape.triangles, shape.topology, position, from, f64::INFINITY);
        reached.iter().for_each(|&(v, at)| distance[v.index()] = at);
        (distance, reached.last().map_or(from[0].0, |&(v, _)| v))
    };
    let (from_seeds, other_end) = distances(seeds);
    cancel.check()?;
    let (from_end, _) = distances(&[(other_end, 0.0)]);
    let of_seeds = from_end[seeds[0].0.index()];
    let merit = |v: SurfaceVertex| {
        let detour = from_seeds[v.index()] + of_seeds - from_end[v.index()];
        from_end[v.index()] - DETOUR * detour
    };
    let component = shape.topology.vertices_of(shape.topology.component(other_end));
    let tip = component.max_by(|&a, &b| merit(a).total_cmp(&merit(b)));
    cancel.check()?;
    Ok(tip.unwrap_or(seeds[0].0))
}

/// The diagonal of the box around a vertex's component.
fn extent(shape: &Shape<'_>, of: SurfaceVertex) -> f64 {
    let component = shape.topology.component(of);
    let vertices = shape.topology.vertices_of(component);
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for position in vertices.map(|v| shape.positions[v.index()]) {
        (least, most) = (least.min(position), most.max(position));
    }
    least.distance(most)
}

/// The place from which the rings of a limb are measured.
#[derive(Clone, Copy)]
struct Origin {
    /// The limb's tip.
    tip: SurfaceVertex,
    /// The distance that the search first covers.
    near: f64,
    /// The rings that count.
    source: Source,
}

impl Origin {
    /// The far tip, from which nothing is known about the rings.
    fn far(
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        seeds: &[(SurfaceVertex, f64); 3],
        cancel: &Cancel,
    ) -> Result<Self, Cancelled> {
        Ok(Self {
            tip: far_tip(search, shape, seeds, cancel)?,
            near: f64::INFINITY,
            source: Source::Point,
        })
    }
}

/// A ring, and the vertices that it cuts off.
struct Cut {
    centre: DVec3,
    radius: f64,
    limb: Vec<SurfaceVertex>,
    ring: Segments,
    /// The corners of the triangles that the ring goes through, with their distances from it.
    beside: Vec<(SurfaceVertex, f64)>,
}

impl Cut {
    /// The narrowest ring around `seeds` with the triangle of these corners on the limb. The search first covers the
    /// distance `near`, and everything if the rings have not widened again by then.
    fn narrowest(
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        seeds: &[(SurfaceVertex, f64)],
        near: f64,
        corners: &[SurfaceVertex; 3],
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        for limit in [near, f64::INFINITY] {
            let field = Field::measure(search, shape, seeds, limit);
            cancel.check()?;
            let rings = Rings::of(shape, &field, Body::Large);
            cancel.check()?;
            match rings.narrowest(corners, 0, Source::Point) {
                Some(Narrowest { level, end }) if end == End::Widens || limit.is_infinite() => {
                    return Ok(Some(Self::of(shape, &field, &rings, level)));
                }
                _ => {}
            }
        }
        Ok(None)
    }

    /// The candidate from the first of some origins that has one.
    fn first_candidate(
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        origins: &[Origin],
        corners: &[SurfaceVertex; 3],
        up: i32,
        cancel: &Cancel,
    ) -> Result<Option<(Self, i32)>, Cancelled> {
        for &origin in origins {
            if let Some(found) = Self::candidate(search, shape, origin, corners, up, cancel)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    /// The candidate `up` places farther from the tip than the guess, and the number of places that there are.
    fn candidate(
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        origin: Origin,
        corners: &[SurfaceVertex; 3],
        up: i32,
        cancel: &Cancel,
    ) -> Result<Option<(Self, i32)>, Cancelled> {
        for limit in [origin.near, f64::INFINITY] {
            let field = Field::measure(search, shape, &[(origin.tip, 0.0)], limit);
            cancel.check()?;
            let rings = Rings::of(shape, &field, Body::Large);
            cancel.check()?;
            let candidates = candidates::candidates(&rings, corners, origin.source);
            let place = up.clamp(0, candidates.len().saturating_sub(1) as i32);
            let found = candidates.get(place as usize);
            if let Some(&level) = found.filter(|_| limit.is_infinite() || place == up) {
                return Ok(Some((Self::of(shape, &field, &rings, level), place)));
            }
            if limit.is_infinite() {
                break;
            }
        }
        Ok(None)
    }

    fn of(shape: &Shape<'_>, field: &Field, rings: &Rings, level: usize) -> Self {
        let (ring, beside) = rings.ring(shape, field, level);
        let length: f64 = ring.iter().map(|[a, b]| a.distance(*b)).sum();
        let weighted: DVec3 = ring.iter().map(|[a, b]| (*a + *b) * (0.5 * a.distance(*b))).sum();
        Self {
            centre: weighted / length,
            radius: length / TAU,
            limb: rings.limb(level),
            ring,
            beside,
        }
    }

    /// The narrowest ring, within so many radii of this one, at even distances from a plane across the limb a few radii
    /// away: those rings are straight if the limb is. `None` if there is none with the triangle of these corners on the
    /// limb.
    fn straightened(
        &self,
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        corners: &[SurfaceVertex; 3],
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
        let field = Field::measure(search, shape, &seeds, height + NUDGE_RADII * self.radius);
        let rings = Rings::of(shape, &field, Body::With(self.far_from_limb(shape, &is_limb)?));
        let nearest = field.level_at(height - NUDGE_RADII * self.radius);
        let level = rings.narrowest(corners, nearest, Source::Section)?.level;
        Some(Self::of(shape, &field, &rings, level))
    }

    /// The body's farthest point from the ring, in a straight line.
    fn far_from_limb(&self, shape: &Shape<'_>, is_limb: &[bool]) -> Option<SurfaceVertex> {
        let component = shape.topology.component(*self.limb.first()?);
        let body = shape.topology.vertices_of(component).filter(|v| !is_limb[v.index()]);
        let away = |v: &SurfaceVertex| shape.positions[v.index()].distance_squared(self.centre);
        body.max_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// The limb's farthest point from the ring, in a straight line.
    fn tip(&self, shape: &Shape<'_>) -> SurfaceVertex {
        let away = |v: &SurfaceVertex| shape.positions[v.index()].distance_squared(self.centre);
        let farthest = self.limb.iter().max_by(|a, b| away(a).total_cmp(&away(b)));
        farthest.copied().unwrap_or(self.beside[0].0)
    }

    /// The joint with its falloff; `None` if the limb has no vertex beyond it.
    fn joint(self, search: &mut DistanceSearch, shape: &Shape<'_>) -> Option<Joint> {
        let tip = shape.positions[self.tip(shape).index()];
        let falloff = self.radius.min(0.5 * tip.distance(self.centre));
        let mut is_limb = vec![false; shape.positions.len()];
        self.limb.iter().for_each(|v| is_limb[v.index()] = true);
        // Some triangles beyond the falloff, so that the outermost rings are closed.
        let step = self.beside.iter().map(|(_, distance)| *distance).fold(0.0, f64::max);
        let limit = falloff + 4.0 * step;
        let position = |v: SurfaceVertex| shape.positions[v.index()];
        let mut signed = vec![f64::NAN; shape.positions.len()];
        for &(v, distance) in search.within(shape.triangles, shape.topology, position, &self.beside, limit) {
            signed[v.index()] = if is_limb[v.index()] { -distance } else { distance };
        }
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests;
