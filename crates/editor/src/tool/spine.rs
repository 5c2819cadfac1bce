//! The middle of a limb along a stroke, and the limb around it.
//!
//! A stroke tells only roughly where the limb is, and nothing about its depth. Rays from each sample across the stroke
//! find the limb's walls, in depth and beside the stroke, and the sample moves half way between them.

use glam::DVec3;
use pliant_mesh::{Curve, Model, SurfaceVertex, Topology};

use super::spine_tips::tips;
use crate::view::{Pick, Picking, Ray};

/// The limb around a spine has the vertices within this many of its half thicknesses.
const GIRTH: f64 = 1.6;

/// Tips that it cuts off are its own if they are within this many half thicknesses of the spine.
const TIP: f64 = 4.0;

/// A vertex turns away from the spine of its limb if the cosine of its normal and the way to it is at least this. A
/// crotch, from which a stroke on a thigh would run over to the other one, has a smaller one.
const LEAST_FACING: f64 = 0.2;

/// Walls that are farther apart than this many times the usual way belong to the body or to another limb.
const MOST_APART: f64 = 1.6;

/// Samples to either side from which the direction of the stroke and the way to the middle are taken.
const AROUND: usize = 10;

/// How often samples move to the middle: what is beside the stroke changes the depth, and the other way round.
const ROUNDS: usize = 3;

/// A sample of a stroke on the surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// The visible surface under the pointer.
    pub(super) pick: Pick,
    /// The point of the curve.
    pub(super) point: DVec3,
    /// The unit direction away from the viewer.
    inwards: DVec3,
}

impl Sample {
    /// A sample on the surface.
    pub(super) fn on(pick: Pick) -> Self {
        Self {
            pick,
            point: pick.point,
            inwards: -pick.normal,
        }
    }

    /// A sample half way through what the ray to `pick` goes through there.
    pub(super) fn inside(picking: &Picking<'_>, pick: Pick, ray: Ray) -> Self {
        // A little beyond the entry, so that the next hit is the exit.
        let step = picking.camera.world_per_px(pick.point, picking.viewport_px);
        let origin = pick.point + ray.direction * step;
        let exit = picking.along(Ray { origin, ..ray });
        let half = exit.map_or(0.0, |exit| 0.5 * exit.point.distance(pick.point));
        Self {
            pick,
            point: pick.point + ray.direction * half,
            inwards: ray.direction,
        }
    }
}

/// Moves samples inside a limb to its middle. Returns its usual half thickness, the larger one of both directions.
pub(super) fn to_the_middle(samples: &mut [Sample], picking: &Picking<'_>) -> f64 {
    level_depths(samples);
    let last = samples.len().saturating_sub(1);
    let inwards: Vec<DVec3> = samples.iter().map(|sample| sample.inwards).collect();
    // The directions are those of the stroke as it was drawn: moved samples would turn them.
    let across = (0..samples.len()).map(|place| {
        let along = samples[(place + AROUND).min(last)].point - samples[place.saturating_sub(AROUND)].point;
        along.cross(inwards[place]).normalize_or_zero()
    });
    let across: Vec<DVec3> = across.collect();
    let mut half = 0.0;
    for _ in 0..ROUNDS {
        let beside = between_walls(samples, &across, picking);
        half = between_walls(samples, &inwards, picking).max(beside);
    }
    half
}

/// Gives samples that go through a gap, or through the body too, the usual depth below the visible surface.
fn level_depths(samples: &mut [Sample]) {
    let depth = |sample: &Sample| sample.point.distance(sample.pick.point);
    let mut depths: Vec<f64> = samples.iter().map(depth).collect();
    depths.sort_by(f64::total_cmp);
    let Some(&usual) = depths.get(depths.len() / 2) else {
        return;
    };
    for sample in samples {
        if !(usual / MOST_APART..=usual * MOST_APART).contains(&depth(sample)) {
            sample.point = sample.pick.point + sample.inwards * usual;
        }
    }
}

/// Moves the samples half way between the walls in a direction and against it. Where these are missing or unusually far
/// apart, a sample moves as its neighbours do. Returns half of the walls' usual distance; 0 if there are none.
fn between_walls(samples: &mut [Sample], directions: &[DVec3], picking: &Picking<'_>) -> f64 {
    let walls = samples.iter().zip(directions).map(|(sample, &direction)| {
        let wall = |direction| {
            Some(
                picking
                    .along(Ray {
                        origin: sample.point,
                        direction,
                    })?
                    .point,
            )
        };
        (direction != DVec3::ZERO).then(|| Some((wall(direction)?, wall(-direction)?)))?
    });
    let walls: Vec<Option<(DVec3, DVec3)>> = walls.collect();
    let mut widths: Vec<f64> = walls.iter().flatten().map(|(a, b)| a.distance(*b)).collect();
    widths.sort_by(f64::total_cmp);
    let Some(&usual) = widths.get(widths.len() / 2) else {
        return 0.0;
    };
    let way = |(sample, walls): (&Sample, &Option<(DVec3, DVec3)>)| {
        let (a, b) = walls.filter(|(a, b)| a.distance(*b) <= MOST_APART * usual)?;
        Some(a.midpoint(b) - sample.point)
    };
    let ways: Vec<Option<DVec3>> = samples.iter().zip(&walls).map(way).collect();
    // The mean over the neighbours with a way, over more of them where few have one.
    for (place, sample) in samples.iter_mut().enumerate() {
        let mut reach = AROUND;
        while reach < 2 * ways.len() {
            let near = &ways[place.saturating_sub(reach)..(place + reach + 1).min(ways.len())];
            let known: Vec<DVec3> = near.iter().flatten().copied().collect();
            if !known.is_empty() {
                sample.point += known.iter().sum::<DVec3>() / known.len() as f64;
                break;
            }
            reach *= 2;
        }
    }
    0.5 * usual
}

/// The vertices near a curve inside a limb of this half thickness that are connected with the `seen` ones, on the model's
/// surface after these displacements. Behind its first point, where the body begins, there are none: they would turn with
/// the first bone.
pub(super) fn around(
    curve: &Curve,
    half: f64,
    seen: &[SurfaceVertex],
    model: &Model,
    displacements: &[DVec3],
) -> Vec<SurfaceVertex> {
    const SPANS: usize = 32;
    let at = |span: usize| curve.position(curve.length() * span as f64 / SPANS as f64);
    let shown = Shown { model, displacements };
    let line: Vec<DVec3> = (0..=SPANS).map(at).collect();
    let outwards = line[1] - line[0];
    // From the line to a vertex near it.
    let way_within = |vertex: SurfaceVertex, halves: f64| {
        let point = shown.position(vertex);
        let is_behind = (point - line[0]).dot(outwards) < 0.0;
        let ahead = if is_behind { &line[SPANS / 4..] } else { &line[..] };
        let ways = ahead.windows(2).map(|ends| way_to(point, ends));
        let shortest = ways.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
        (shortest.length() <= halves * half).then_some(shortest)
    };
    let way = |vertex: SurfaceVertex| way_within(vertex, GIRTH);
    let side = |vertex: SurfaceVertex| {
        let way = way(vertex)?.normalize_or_zero();
        Some(way.dot(shown.normal(vertex).normalize_or_zero()))
    };
    // The person sees the outside, whichever way the triangles are turned.
    let outside = seen
        .iter()
        .filter_map(|vertex| side(*vertex))
        .map(f64::signum)
        .sum::<f64>();
    let is_of_limb = |vertex: SurfaceVertex| side(vertex).is_some_and(|side| side * outside.signum() >= LEAST_FACING);
    let topology = &model.topology;
    let mut is_passed = vec![false; model.surface.positions.len()];
    let mut found = flood(seen.to_vec(), &mut is_passed, topology, is_of_limb);
    // What turns to the line is another limb, unless it is only a fold of this one.
    let mut is_fold_passed = vec![false; model.surface.positions.len()];
    found.iter().for_each(|vertex| is_fold_passed[vertex.index()] = true);
    let rim = found.iter().flat_map(|vertex| topology.neighbours(*vertex));
    let rim: Vec<SurfaceVertex> = rim.copied().filter(|vertex| !is_fold_passed[vertex.index()]).collect();
    for start in rim {
        let fold = flood(vec![start], &mut is_fold_passed, topology, |vertex| {
            way(vertex).is_some()
        });
        let is_open = |vertex: &SurfaceVertex| topology.neighbours(*vertex).iter().any(|beside| way(*beside).is_none());
        if !fold.iter().any(is_open) {
            found.extend(fold);
        }
    }
    let is_near = |vertex: SurfaceVertex| way_within(vertex, TIP).is_some();
    found.extend(tips(&found, topology, is_passed.len(), is_near));
    found.sort_unstable();
    found
}

/// The vertices that are connected with these through vertices that belong, and were not passed before.
fn flood(
    mut front: Vec<SurfaceVertex>,
    is_passed: &mut [bool],
    topology: &Topology,
    belongs: impl Fn(SurfaceVertex) -> bool,
) -> Vec<SurfaceVertex> {
    let mut found = Vec::new();
    while let Some(vertex) = front.pop() {
        if !std::mem::replace(&mut is_passed[vertex.index()], true) && belongs(vertex) {
            found.push(vertex);
            front.extend(topology.neighbours(vertex));
        }
    }
    found
}

/// A surface after its displacements.
#[derive(Clone, Copy)]
struct Shown<'a> {
    model: &'a Model,
    displacements: &'a [DVec3],
}

impl Shown<'_> {
    fn position(&self, vertex: SurfaceVertex) -> DVec3 {
        self.model.surface.positions[vertex.index()] + self.displacements[vertex.index()]
    }

    /// The normal at a vertex, of any length.
    fn normal(&self, vertex: SurfaceVertex) -> DVec3 {
        let triangles = &self.model.surface.triangles;
        let faces = self.model.topology.faces(vertex, triangles);
        let normals = faces.map(|face| {
            let [a, b, c] = triangles[face as usize].map(|corner| self.position(corner));
            (b - a).cross(c - a)
        });
        normals.sum()
    }
}

/// The shortest way to a point from a segment.
fn way_to(point: DVec3, ends: &[DVec3]) -> DVec3 {
    let (from, along) = (ends[0], ends[1] - ends[0]);
    let share = (point - from).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    point - (from + along * share.clamp(0.0, 1.0))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec3;
    use pliant_mesh::{Curve, Model, SurfaceVertex, shapes};

    use super::around;

    const LEG: f64 = 8.0;

    /// Half the distance between the middles of both legs, which are 1 thick from the middle.
    const APART: f64 = 1.25;

    /// Two legs that hang down from a bend at y = 0, one at negative x and one at positive x: a tube of radius 1.
    fn legs() -> Model {
        let mut tube = shapes::tube(40, 140, 2.0 * LEG + PI * APART);
        for p in &mut tube.positions {
            let bend = (p.z - LEG).clamp(0.0, PI * APART) / APART;
            let below = (LEG - p.z).max(p.z - LEG - PI * APART).max(0.0);
            let out = DVec3::new(-bend.cos(), bend.sin(), 0.0);
            *p = (APART + p.x) * out + DVec3::new(0.0, -below, p.y);
        }
        shapes::model(tube)
    }

    #[test]
    fn the_limb_is_closed_round_the_spine_and_leaves_the_limb_beside_it_and_the_body() {
        let model = legs();
        let positions = &model.surface.positions;
        let (from, to) = (DVec3::new(-APART, -1.0, 0.0), DVec3::new(-APART, -6.0, 0.0));
        let points = (0..5).map(|point| from.lerp(to, f64::from(point) / 4.0)).collect();
        let curve = Curve::new(points, false).unwrap();
        let rest = vec![DVec3::ZERO; positions.len()];
        let all = (0..positions.len() as u32).map(SurfaceVertex);
        let is_seen = |p: DVec3| p.z > 0.9 && (-6.0..-1.0).contains(&p.y) && p.x < 0.0;
        let seen: Vec<SurfaceVertex> = all.clone().filter(|v| is_seen(positions[v.index()])).collect();
        let found = around(&curve, 1.0, &seen, &model, &rest);
        for vertex in all {
            let p = positions[vertex.index()];
            let is_found = found.binary_search(&vertex).is_ok();
            if p.x < 0.0 && (-5.9..-1.1).contains(&p.y) {
                assert!(is_found, "the leg at {p}");
            }
            assert!(!is_found || p.y <= -1.0, "the body at {p}");
            assert!(!is_found || p.x < 0.0, "the other leg at {p}");
        }
    }
}
