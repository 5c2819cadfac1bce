//! The points at which a space method fits the handles and the fixed vertices, and the box around the moving part.

use glam::DVec3;

use super::field::moving;
use super::shaping::shaping;
use crate::Role;
use crate::handles::controls::{Hold, Holder};
use crate::method::BindInput;
use crate::needs::HandleFit;
use crate::numerical::samples::thinned;

/// Fixed vertices are near the region up to this share of the moving part's diagonal outside its box.
const NEAR: f64 = 0.25;

/// The box exceeds its contents by this share of the same diagonal, so that it has some thickness around flat shapes.
const MARGIN: f64 = 0.05;

/// The box around everything that moves and the fixed vertices near it, along the axes of space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionBox {
    /// Its lowest corner.
    pub low: DVec3,
    /// Its sides, all positive.
    pub extent: DVec3,
    /// The diagonal of the moving part, in world units; 1 if it has none.
    pub diagonal: f64,
}

/// A point with a prescribed displacement of the field.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub world_point: DVec3,
    /// The handle that it moves with, and its coordinates there; `None` if it is fixed.
    pub handle: Option<(usize, [f64; 4])>,
    /// Its weight in a least-squares fit. The weights of each hard handle and of the fixed part sum to 1, so that each
    /// has equal weight for any density of its samples.
    pub weight: f64,
}

impl RegionBox {
    /// The box of the problem's vertices.
    pub fn of(input: &BindInput<'_>) -> Self {
        let positions = &input.problem.surface.positions;
        let moving = moving(HandleFit::LeastSquares, input).into_iter();
        let moving = shaping(input.problem, moving).into_iter();
        let (low, high) = bounds(moving.map(|vertex| positions[vertex as usize]));
        let diagonal = low.distance(high);
        let (low, high) = if low.is_finite() {
            (low, high)
        } else {
            (DVec3::ZERO, DVec3::ZERO)
        };
        let diagonal = if diagonal > 0.0 && diagonal.is_finite() {
            diagonal
        } else {
            1.0
        };
        let around = |low: DVec3, high: DVec3, share: f64| Self {
            low: low - share * diagonal,
            extent: high - low + 2.0 * share * diagonal,
            diagonal,
        };
        let near = around(low, high, NEAR);
        let roles = input.problem.roles;
        let fixed = (0..roles.len() as u32).filter(|&vertex| roles[vertex as usize] == Role::Fixed);
        let fixed = fixed.filter(|&vertex| near.contains(positions[vertex as usize]));
        let fixed = shaping(input.problem, fixed)
            .into_iter()
            .map(|vertex| positions[vertex as usize]);
        let (low, high) = bounds(fixed.chain([low, high]));
        around(low, high, MARGIN)
    }

    /// Its middle.
    pub fn middle(&self) -> DVec3 {
        self.low + 0.5 * self.extent
    }

    /// Returns true if a point is in it.
    pub fn contains(&self, point: DVec3) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.low + self.extent).all()
    }
}

/// The samples of all handles, and of the fixed vertices in the box. Those of a soft handle of weight w have the total
/// weight `soft_unit` w. A handle, or the fixed part, with more than `most` vertices is thinned out to about as many,
/// evenly in space.
pub(crate) fn samples(input: &BindInput<'_>, within: &RegionBox, soft_unit: f64, most: usize) -> Vec<Sample> {
    let positions = &input.problem.surface.positions;
    let mut samples = Vec::new();
    for (number, (handle, soft)) in input.handles.iter().zip(&input.partition.soft).enumerate() {
        let vertices = thinned(
            &shaping(input.problem, handle.vertices.iter().copied()),
            positions,
            most,
        );
        let all = soft.map_or(1.0, |weight| weight * soft_unit);
        let weight = all / vertices.len() as f64;
        samples.extend(vertices.into_iter().map(|vertex| {
            let world_point = positions[vertex as usize];
            Sample {
                world_point,
                handle: Some((number, handle.coordinates(world_point))),
                weight,
            }
        }));
    }
    let fixed = (0..)
        .zip(input.problem.roles)
        .filter_map(|(vertex, role)| (*role == Role::Fixed).then_some(vertex))
        .filter(|&vertex: &u32| within.contains(positions[vertex as usize]));
    let fixed = thinned(&shaping(input.problem, fixed), positions, most);
    let weight = 1.0 / fixed.len() as f64;
    samples.extend(fixed.into_iter().map(|vertex| Sample {
        world_point: positions[vertex as usize],
        handle: None,
        weight,
    }));
    samples
}

/// The samples as holds of control points against the hand.
pub(crate) fn holds(samples: &[Sample]) -> Vec<Hold> {
    let hold = |sample: &Sample| Hold {
        weight: sample.weight,
        by: match sample.handle {
            Some(_) => Holder::Handle,
            None => Holder::Fixed,
        },
    };
    samples.iter().map(hold).collect()
}

fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| {
        (low.min(point), high.max(point))
    })
}
