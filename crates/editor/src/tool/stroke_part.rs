//! The part of a surface that a stroke is meant for.
//!
//! A stroke along an arm may begin on the muzzle in front of it, or cross a hand. Its places there are at another depth,
//! on a part from which a way leads to the arm only far around. The stroke follows the part with most of its places; as
//! if the other parts were transparent, the rest of them go on to the surface behind these, as far as that is connected.

use std::collections::BTreeSet;
use std::ops::Range;

use pliant_mesh::SurfaceVertex;

use super::drawn_path::STEP_PX;
use crate::view::{Pick, Picking, Ray};

/// Neighbouring places are on one part if they are no farther apart than this many steps of the stroke.
const NEAR_STEPS: f64 = 2.0;

/// Other places are on one part if a way leads from one to the other in a ball around both, whose radius has this share
/// of their distance.
const BALL: f64 = 0.75;

/// A place that goes on behind another part is at most so many steps from its neighbour.
const FARTHEST_STEPS: f64 = 8.0;

/// The most surfaces behind each other that are looked at.
const MOST_HITS: usize = 12;

/// A place of a stroke on the surface, and the ray to it.
pub(super) type Place = (Pick, Ray);

/// The places of a stroke, on the one part with most of them: places on other parts go to the surface behind these, or
/// are left out if there is none near the next place.
pub(super) fn on_one_part(places: Vec<Place>, picking: &Picking<'_>) -> Vec<Place> {
    let runs = runs(&places, picking);
    if runs.len() < 2 {
        return places;
    }
    let is_of_part = of_largest_part(&runs, &places, picking);
    let mut carried: Vec<Option<Place>> = places
        .iter()
        .zip(&is_of_part)
        .map(|(place, is_of_part)| is_of_part.then_some(*place))
        .collect();
    // From each place of the part on, in both directions.
    let last = places.len() - 1;
    for at in 1..=last {
        carry(&mut carried, [at - 1, at], places[at].1, picking);
    }
    for at in (0..last).rev() {
        carry(&mut carried, [at + 1, at], places[at].1, picking);
    }
    carried.into_iter().flatten().collect()
}

/// The runs of neighbouring places that are on one part.
fn runs(places: &[Place], picking: &Picking<'_>) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for at in 0..places.len() {
        match runs.last_mut() {
            Some(run) if are_beside(&places[at - 1].0, &places[at].0, picking) => run.end = at + 1,
            _ => runs.push(at..at + 1),
        }
    }
    runs
}

/// For each place whether it is on the part with most of them. A part goes on after a run on another one.
fn of_largest_part(runs: &[Range<usize>], places: &[Place], picking: &Picking<'_>) -> Vec<bool> {
    let mut part_of: Vec<usize> = Vec::with_capacity(runs.len());
    for (number, run) in runs.iter().enumerate() {
        let goes_on = |&former: &usize| are_beside(&places[runs[former].end - 1].0, &places[run.start].0, picking);
        let former = (0..number.saturating_sub(1)).rev().find(goes_on);
        part_of.push(former.map_or(number, |former| part_of[former]));
    }
    let mut counts = vec![0; runs.len()];
    for (run, part) in runs.iter().zip(&part_of) {
        counts[*part] += run.len();
    }
    // The last one wins a tie, because a stroke goes from the body to the tip.
    let largest = (0..counts.len()).max_by_key(|&part| counts[part]);
    let of_part = runs.iter().zip(&part_of);
    of_part
        .flat_map(|(run, part)| run.clone().map(move |_| Some(*part) == largest))
        .collect()
}

/// Gives a place without a point the nearest one to that of its neighbour, along its ray.
fn carry(carried: &mut [Option<Place>], [from, at]: [usize; 2], ray: Ray, picking: &Picking<'_>) {
    let (None, Some((beside, _))) = (carried[at], carried[from]) else {
        return;
    };
    let step = STEP_PX * picking.camera.world_per_px(beside.point, picking.viewport_px);
    let away = |pick: &Pick| pick.point.distance(beside.point);
    let hits = along_all(ray, picking);
    let near = hits
        .into_iter()
        .filter(|hit| hit.front == beside.front && away(hit) <= FARTHEST_STEPS * step);
    let nearest = near.min_by(|a, b| away(a).total_cmp(&away(b)));
    carried[at] = nearest
        .filter(|hit| are_beside(&beside, hit, picking))
        .map(|hit| (hit, ray));
}

/// All points of the surface along a ray, up to a number.
fn along_all(ray: Ray, picking: &Picking<'_>) -> Vec<Pick> {
    let mut hits: Vec<Pick> = Vec::new();
    let mut origin = ray.origin;
    while let Some(hit) = picking.along(Ray { origin, ..ray })
        && hits.len() < MOST_HITS
    {
        // A little beyond it, so that the next hit is another one.
        let beyond = 1e-2 * picking.camera.world_per_px(hit.point, picking.viewport_px);
        origin = hit.point + ray.direction * beyond;
        hits.push(hit);
    }
    hits
}

/// Whether two places are on one part: near each other, or connected by the surface between them.
fn are_beside(one: &Pick, other: &Pick, picking: &Picking<'_>) -> bool {
    let apart = one.point.distance(other.point);
    let step = STEP_PX * picking.camera.world_per_px(one.point, picking.viewport_px);
    if one.triangle == other.triangle || apart <= NEAR_STEPS * step {
        return true;
    }
    let corners = |pick: &Pick| picking.model.surface.triangles[pick.triangle as usize];
    let middle = one.point.midpoint(other.point);
    let is_inside = |vertex: SurfaceVertex| picking.position(vertex).distance(middle) <= BALL * apart;
    let ends = corners(other);
    let mut front = corners(one).to_vec();
    // Few vertices of a large surface are in the ball.
    let mut passed = BTreeSet::new();
    while let Some(vertex) = front.pop() {
        if !passed.insert(vertex) {
            continue;
        }
        if ends.contains(&vertex) {
            return true;
        }
        // The corners of large triangles are outside.
        if is_inside(vertex) || corners(one).contains(&vertex) {
            front.extend(picking.model.topology.neighbours(vertex));
        }
    }
    false
}
