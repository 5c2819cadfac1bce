//! Level sets of a distance field that separate the body from the rest.
//!
//! At a level r the *body* is the connected component of {distance ≥ r} that has two fifths of the whole area or more, or
//! a tenth if there is hardly anything else beyond r; at a lower level it is the one that contains the body of the higher
//! level. So bodies are nested, and the ring of a
//! level, the boundary of its body, always separates the surface, even one with holes and handles. The *limb* is the
//! rest.

use std::f64::consts::TAU;

use glam::DVec3;

use super::level_set::{Segments, crossing};
use super::shape::Shape;
use super::ways::Ways;
use crate::geodesics::DistanceSearch;
use crate::{SurfaceVertex, face_area};

/// The number of levels for the whole distance.
const LEVELS: u32 = 256;
/// The body's least share of the area.
const BODY_SHARE: f64 = 0.4;
/// The least share of a body that is all that is beyond its level.
const LONE_BODY_SHARE: f64 = 0.1;
/// A piece with this share of the area beyond a level is all that is beyond it, but for tips.
const LONE: f64 = 0.9;
/// A ring counts if it is shorter than this share of the circle of its distance: the share is 0.64 for a sphere's
/// equator and less than 0.32 around a tube, once the circle has closed around it.
const ROUND_SHARE: f64 = 0.5;
/// A ring does not count if it is this many times longer than the ring at half its distance: the ratio is 2 for a disc
/// and for the corner of a sheet.
const GROWS: f64 = 1.3;
/// The same around a limb's tip, whose rings run across the limb: those of a thigh are longer than those of a shin.
const GROWS_FROM_TIP: f64 = 1.7;
/// A ring is the narrowest of its surroundings if a later one is this much longer.
const WIDENS: f64 = 1.25;

/// Distances from a place within its component.
pub(super) struct Field {
    /// One for each vertex of the surface; infinite beyond the search's limit.
    distance: Vec<f64>,
    component: u32,
    spacing: f64,
}

impl Field {
    /// Measures from the nearest of `seeds`, which are on one component, up to `limit`, by these lengths of ways.
    pub(super) fn measure(
        search: &mut DistanceSearch,
        shape: &Shape<'_>,
        ways: &Ways,
        seeds: &[(SurfaceVertex, f64)],
        limit: f64,
    ) -> Self {
        let position = |v: SurfaceVertex| shape.positions[v.index()];
        let mut distance = vec![f64::INFINITY; shape.positions.len()];
        let mut farthest = 0.0;
        let stretch = |v: SurfaceVertex| ways.stretch(v);
        for &(v, at) in search.within_stretched(shape.triangles, shape.topology, position, stretch, seeds, limit) {
            (distance[v.index()], farthest) = (at, at);
        }
        Self {
            distance,
            component: shape.topology.component(seeds[0].0),
            spacing: farthest / f64::from(LEVELS),
        }
    }

    /// The distance of a level, between multiples of the spacing so that no vertex of a regular mesh is exactly on it.
    fn at_level(&self, level: usize) -> f64 {
        (level as f64 + 0.5) * self.spacing
    }

    /// The level nearest to a distance.
    pub(super) fn level_at(&self, distance: f64) -> usize {
        // The cast turns NaN and negative numbers into 0.
        (distance / self.spacing - 0.5).round() as usize
    }

    /// The number of levels that a vertex is beyond.
    fn levels_below(&self, v: SurfaceVertex) -> u32 {
        let levels = (self.distance[v.index()] / self.spacing + 0.5).floor();
        // The cast turns infinity into the maximum, and 0/0 into 0.
        (levels as u32).min(LEVELS)
    }
}

/// The choice of the body.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Body {
    /// The component that has two fifths of the area or more.
    Large,
    /// The component with this vertex.
    With(SurfaceVertex),
}

/// The origin of distances.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Source {
    /// A point, whose rings begin as those of a disc.
    Point,
    /// The tip of a limb.
    Tip,
    /// A section across the limb.
    Section,
}

/// A ring that is narrower than others.
pub(super) struct Narrowest {
    pub(super) level: usize,
    pub(super) end: End,
}

/// The rings after the narrowest one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum End {
    /// Wider ones.
    Widens,
    /// The search ended before they widened.
    Open,
}

/// The vertices that each level cuts off.
pub(super) struct Rings {
    /// The number of levels, from the lowest on, at which each vertex belongs to the body.
    in_body: Vec<u32>,
    /// The ring's length for each level, smoothed over three.
    lengths: Vec<f64>,
    radii: Vec<f64>,
    /// The share of the component's area that each level cuts off.
    limb_shares: Vec<f64>,
    vertices: Vec<SurfaceVertex>,
}

impl Rings {
    pub(super) fn of(shape: &Shape<'_>, field: &Field, body: Body) -> Self {
        let vertices: Vec<SurfaceVertex> = shape.topology.vertices_of(field.component).collect();
        let mut levels = vec![0; shape.positions.len()];
        vertices.iter().for_each(|&v| levels[v.index()] = field.levels_below(v));
        let mut in_body = vec![0; shape.positions.len()];
        let innermost = match body {
            Body::Large => innermost_body(shape, &vertices, &levels),
            Body::With(v) => Some((v, levels[v.index()])),
        };
        if let Some((seed, highest)) = innermost {
            spread(shape, &levels, seed, highest, &mut in_body);
        }
        let mut raw = vec![0.0; LEVELS as usize];
        // The search's limit cuts off rings from here on.
        let mut complete = LEVELS;
        let mut limb_areas = vec![0.0; LEVELS as usize + 1];
        let is_own = |triangle: &&[SurfaceVertex; 3]| shape.topology.component(triangle[0]) == field.component;
        for &triangle in shape.triangles.iter().filter(is_own) {
            let beyond = triangle.map(|v| in_body[v.index()]);
            let area = face_area(shape.corners(triangle)) / 3.0;
            beyond.iter().for_each(|&level| limb_areas[level as usize] += area);
            let below = triangle.map(|v| levels[v.index()]);
            let (from, to) = (
                below.into_iter().fold(LEVELS, u32::min),
                beyond.into_iter().fold(0, u32::max),
            );
            if triangle.iter().any(|v| field.distance[v.index()].is_infinite()) {
                complete = complete.min(from);
                continue;
            }
            for level in from..to {
                if let Some([a, b]) = cut(shape, field, triangle, level as usize) {
                    raw[level as usize] += a.distance(b);
                }
            }
        }
        raw.truncate(complete as usize);
        let whole: f64 = limb_areas.iter().sum();
        let limb_shares = limb_areas.iter().scan(0.0, |limb, area| {
            *limb += area / whole;
            Some(*limb)
        });
        let lengths = (0..raw.len()).map(|level| {
            let (before, after) = (level.saturating_sub(1), (level + 1).min(raw.len() - 1));
            match raw[before].min(raw[level]).min(raw[after]) > 0.0 {
                true => 0.25 * (raw[before] + raw[after]) + 0.5 * raw[level],
                false => raw[level],
            }
        });
        Self {
            lengths: lengths.collect(),
            limb_shares: limb_shares.collect(),
            radii: (0..raw.len()).map(|level| field.at_level(level)).collect(),
            in_body,
            vertices,
        }
    }

    /// The lowest level with the triangle of these corners on the limb.
    pub(super) fn first(&self, triangle: &[SurfaceVertex; 3]) -> usize {
        let levels = triangle.iter().map(|v| self.in_body[v.index()]);
        levels.fold(0, u32::max) as usize
    }

    /// The length of each level's ring; 0 where there is none.
    pub(super) fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// The distance of each level from the seeds.
    pub(super) fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// The share of the component's area that is not in the body of a level.
    pub(super) fn limb_share(&self, level: usize) -> f64 {
        self.limb_shares.get(level).copied().unwrap_or(1.0)
    }

    /// Returns true if a ring is that of a disc or of the corner of a sheet rather than around a limb.
    pub(super) fn is_round(&self, level: usize, source: Source) -> bool {
        let length = self.lengths[level];
        let grows = match source {
            Source::Point => GROWS,
            Source::Tip => GROWS_FROM_TIP,
            Source::Section => return false,
        };
        length > ROUND_SHARE * TAU * self.radii[level] || length > grows * self.lengths[level / 2]
    }

    /// The first ring from the level `lowest` on, with the point's triangle on the limb, that is narrower than the rings
    /// before and after it; if none widens again, the narrowest of all.
    pub(super) fn narrowest(&self, triangle: &[SurfaceVertex; 3], lowest: usize, source: Source) -> Option<Narrowest> {
        let mut narrowest: Option<usize> = None;
        for level in self.first(triangle).max(lowest)..self.lengths.len() {
            let length = self.lengths[level];
            let is_round = self.is_round(level, source);
            match narrowest {
                Some(level) if length > WIDENS * self.lengths[level] => {
                    return Some(Narrowest {
                        level,
                        end: End::Widens,
                    });
                }
                Some(least) if length >= self.lengths[least] => {}
                _ if length > 0.0 && !is_round => narrowest = Some(level),
                _ => {}
            }
        }
        narrowest.map(|level| Narrowest { level, end: End::Open })
    }

    /// The ring of a level, and the corners of the triangles that it goes through with their distances from it.
    pub(super) fn ring(&self, shape: &Shape<'_>, field: &Field, level: usize) -> (Segments, Vec<(SurfaceVertex, f64)>) {
        let (mut ring, mut beside) = (Vec::new(), Vec::new());
        for &triangle in shape.triangles {
            let borders_on_body = triangle.iter().any(|v| self.in_body[v.index()] as usize > level);
            if let Some(segment) = cut(shape, field, triangle, level).filter(|_| borders_on_body) {
                ring.push(segment);
                let from_ring = |v: SurfaceVertex| (field.distance[v.index()] - field.at_level(level)).abs();
                beside.extend(triangle.map(|v| (v, from_ring(v))));
            }
        }
        (ring, beside)
    }

    /// Every vertex of the component that is not in the body of a level, ascending.
    pub(super) fn limb(&self, level: usize) -> Vec<SurfaceVertex> {
        let is_limb = |v: &&SurfaceVertex| self.in_body[v.index()] as usize <= level;
        self.vertices.iter().filter(is_limb).copied().collect()
    }

    /// Every vertex of the component that is in the body of a level, ascending.
    pub(super) fn body(&self, level: usize) -> Vec<SurfaceVertex> {
        let is_body = |v: &&SurfaceVertex| self.in_body[v.index()] as usize > level;
        self.vertices.iter().filter(is_body).copied().collect()
    }
}

/// The line of a level in a triangle; there is none beyond the limit.
fn cut(shape: &Shape<'_>, field: &Field, triangle: [SurfaceVertex; 3], level: usize) -> Option<[DVec3; 2]> {
    let values = triangle.map(|v| field.distance[v.index()] - field.at_level(level));
    if values.iter().any(|value| value.is_infinite()) {
        return None;
    }
    crossing(shape.corners(triangle), values)
}

/// A vertex of the body at the highest level that has one, and the number of levels at which it is in the body.
///
/// The body of a bust is smaller than its head. So the body goes on beyond the level at which it has its least share, as
/// long as nearly all that is beyond a level is one piece.
fn innermost_body(shape: &Shape<'_>, vertices: &[SurfaceVertex], levels: &[u32]) -> Option<(SurfaceVertex, u32)> {
    let mut areas = vec![0.0; levels.len()];
    let mut whole = 0.0;
    for &triangle in shape.triangles {
        if shape.topology.component(triangle[0]) == shape.topology.component(*vertices.first()?) {
            let area = face_area(shape.corners(triangle));
            whole += area;
            triangle.iter().for_each(|v| areas[v.index()] += area / 3.0);
        }
    }
    let mut falling = vertices.to_vec();
    falling.sort_by_key(|v| std::cmp::Reverse(levels[v.index()]));
    // Parents of a forest of sets; a vertex enters it when its level is reached.
    let mut parents: Vec<u32> = vec![u32::MAX; levels.len()];
    let (mut entered, mut largest) = (0.0, (0.0, 0));
    let mut innermost: Option<(SurfaceVertex, u32)> = None;
    for &v in &falling {
        if levels[v.index()] == 0 {
            break;
        }
        parents[v.index()] = v.0;
        entered += areas[v.index()];
        for &u in shape.topology.neighbours(v) {
            if parents[u.index()] == u32::MAX {
                continue;
            }
            let (one, other) = (root(&mut parents, v.0), root(&mut parents, u.0));
            if one != other {
                parents[other as usize] = one;
                areas[one as usize] += areas[other as usize];
            }
        }
        let own = root(&mut parents, v.0);
        if areas[own as usize] > largest.0 {
            largest = (areas[own as usize], own);
        }
        if areas[own as usize] >= BODY_SHARE * whole {
            let is_own = |(seed, _): &(SurfaceVertex, u32)| root(&mut parents, seed.0) == own;
            return innermost.filter(is_own).or(Some((v, levels[v.index()])));
        }
        let is_alone = largest.0 >= LONE_BODY_SHARE * whole && largest.0 >= LONE * entered;
        innermost = match is_alone {
            true => innermost.or(Some((SurfaceVertex(largest.1), levels[v.index()]))),
            false => None,
        };
    }
    None
}

/// The set of a vertex, with the path to it halved.
fn root(parents: &mut [u32], mut v: u32) -> u32 {
    while parents[v as usize] != v {
        let above = parents[parents[v as usize] as usize];
        parents[v as usize] = above;
        v = above;
    }
    v
}

/// The number of levels at which each vertex is in the body that `seed` is in for `highest` levels: the largest value,
/// over all paths from there, of the least on the path.
fn spread(shape: &Shape<'_>, levels: &[u32], seed: SurfaceVertex, highest: u32, in_body: &mut [u32]) {
    let mut waiting: Vec<Vec<SurfaceVertex>> = vec![Vec::new(); highest as usize + 1];
    waiting[highest as usize].push(seed);
    for level in (1..=highest).rev() {
        while let Some(v) = waiting[level as usize].pop() {
            if in_body[v.index()] > 0 {
                continue;
            }
            in_body[v.index()] = level;
            for &u in shape.topology.neighbours(v) {
                let reached = levels[u.index()].min(level);
                if in_body[u.index()] == 0 && reached > 0 {
                    waiting[reached as usize].push(u);
                }
            }
        }
    }
}
