//! The middle of a limb along a stroke, and the limb around it.
//!
//! A stroke tells only roughly where the limb is, and nothing about its depth. Rays from each sample across the stroke
//! find the limb's walls, in depth and beside the stroke, and the sample moves half way between them.

use glam::DVec3;
use pliant_mesh::{Curve, Model, SurfaceVertex, face_normal};

use crate::view::{Pick, Picking, Ray};

/// The limb around a spine has the vertices within this many of its half thicknesses.
const GIRTH: f64 = 1.6;

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

/// The vertices near a curve inside a limb of this half thickness that are connected with the `seen` ones and face away
/// from the curve, on the model's surface after these displacements. The skin of a limb beside it faces the curve.
pub(super) fn around(
    curve: &Curve,
    half: f64,
    seen: &[SurfaceVertex],
    model: &Model,
    displacements: &[DVec3],
) -> Vec<SurfaceVertex> {
    const SPANS: usize = 32;
    let limit = GIRTH * half;
    let at = |span: usize| curve.position(curve.length() * span as f64 / SPANS as f64);
    let line: Vec<DVec3> = (0..=SPANS).map(at).collect();
    let position = |vertex: SurfaceVertex| model.surface.positions[vertex.index()] + displacements[vertex.index()];
    let from_curve = |vertex: SurfaceVertex| {
        let ways = line.windows(2).map(|ends| way_from(position(vertex), ends));
        ways.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
    };
    let normal = |vertex: SurfaceVertex| -> DVec3 {
        let corners = |face: u32| model.surface.triangles[face as usize].map(position);
        let faces = model.topology.faces(vertex, &model.surface.triangles);
        faces.map(|face| face_normal(corners(face))).sum()
    };
    let facing = |vertex: SurfaceVertex| from_curve(vertex).map_or(0.0, |way| normal(vertex).dot(way));
    // Where the surface is inside out, the skin's normals are turned, too.
    let outward = seen.iter().map(|&vertex| facing(vertex)).sum::<f64>().signum();
    let is_own = |vertex: SurfaceVertex| {
        from_curve(vertex).is_some_and(|way| way.length() <= limit && outward * normal(vertex).dot(way) >= 0.0)
    };
    let mut is_met = vec![false; model.surface.positions.len()];
    let mut found: Vec<SurfaceVertex> = Vec::new();
    let mut stack: Vec<SurfaceVertex> = seen.to_vec();
    while let Some(vertex) = stack.pop() {
        if !std::mem::replace(&mut is_met[vertex.index()], true) && is_own(vertex) {
            found.push(vertex);
            stack.extend(model.topology.neighbours(vertex));
        }
    }
    found.sort_unstable();
    found
}

/// The way to a point from the nearest point of a segment.
fn way_from(point: DVec3, ends: &[DVec3]) -> DVec3 {
    let (from, along) = (ends[0], ends[1] - ends[0]);
    let share = (point - from).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    point - (from + along * share.clamp(0.0, 1.0))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that can't go on fails")]
mod tests {
    use std::f64::consts::PI;

    use pliant_mesh::shapes;

    use super::*;

    /// Half of the distance between the axes of the hairpin's arms, and their length below the bend.
    const APART: f64 = 1.2;
    const ARM: f64 = 6.0;

    /// A tube of radius 1 along a hairpin: up at x = -[`APART`], around a bend, and down at x = [`APART`].
    fn hairpin(side: f64) -> Model {
        let length = 2.0 * ARM + PI * APART;
        let mut drawn = shapes::tube(24, 160, length);
        for p in &mut drawn.positions {
            let turn = ((p.z - ARM) / APART).clamp(0.0, PI);
            let (sin, cos) = turn.sin_cos();
            let outwards = DVec3::new(-cos, 0.0, sin);
            let height = p.z.min(ARM).min(length - p.z);
            *p = outwards * (APART + side * p.x) + DVec3::Y * p.y + DVec3::Z * height;
        }
        shapes::model(drawn)
    }

    #[test]
    fn the_limb_around_a_spine_has_all_of_its_own_skin_and_none_of_that_of_a_limb_beside_it() {
        let curve = Curve::new(vec![DVec3::new(-APART, 0.0, ARM), DVec3::new(-APART, 0.0, 0.5)], false).unwrap();
        for side in [1.0, -1.0] {
            let model = hairpin(side);
            let positions = &model.surface.positions;
            let all = (0..).map(SurfaceVertex).zip(positions);
            let seen: Vec<SurfaceVertex> = all
                .filter(|(_, p)| p.x < 0.0 && p.y > 0.9 && p.z < ARM)
                .map(|(v, _)| v)
                .collect();
            let displacements = vec![DVec3::ZERO; positions.len()];
            let found = around(&curve, 1.0, &seen, &model, &displacements);
            for (vertex, p) in (0..).map(SurfaceVertex).zip(positions) {
                let is_found = found.binary_search(&vertex).is_ok();
                match p.x < 0.0 {
                    true => assert!(is_found || !(0.5..ARM).contains(&p.z), "{p}"),
                    false => assert!(!is_found || p.z > ARM - 0.5, "{p}"),
                }
            }
            let near = positions
                .iter()
                .filter(|p| p.x > 0.0 && p.x + APART < GIRTH && p.z < ARM - 0.5);
            assert!(near.count() > 20, "the other arm is near the spine");
        }
    }
}
