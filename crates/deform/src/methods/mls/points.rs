//! The fitted points: samples of each handle, and of the fixed vertices.

use glam::DVec3;

use crate::Role;
use crate::method::BindInput;
use crate::numerical::nearest::NearestPoints;
use crate::numerical::samples::{farthest, thinned};
use crate::space::unit::Unit;

/// The most samples of a handle.
pub(super) const MOST: usize = 160;

/// Sets with more vertices than these are thinned on a grid before the samples are spread.
const CANDIDATES: usize = 8192;

/// ε of a soft handle of weight 1, in the unit of all points.
pub(super) const SOFT: f64 = 0.5;

/// ε of a hard handle: nearer points have the same weight.
const HARD: f64 = 1e-9;

/// All sets: the handles, then the fixed vertices, if there are any.
pub(super) struct Points {
    pub sets: Vec<Set>,
    pub unit: Unit,
}

/// Points that move by one affine map.
pub(super) struct Set {
    /// The samples, in the unit of all points.
    pub samples: Vec<DVec3>,
    /// The mean of all its vertices, in world units.
    nearest: NearestPoints,
    /// ε².
    pub softening: f64,
}

impl Points {
    /// The sets of all handles and fixed vertices.
    pub fn of(input: &BindInput<'_>) -> Self {
        let positions = &input.problem.surface.positions;
        let fixed = (0..).zip(input.problem.roles);
        let fixed: Vec<u32> = fixed
            .filter_map(|(vertex, role)| (*role == Role::Fixed).then_some(vertex))
            .collect();
        let softening = |soft: &Option<f64>| soft.map_or(HARD * HARD, |weight| (SOFT * SOFT / weight).max(HARD * HARD));
        let handles = input.handles.iter().zip(&input.partition.soft);
        let mut sets: Vec<(&[u32], f64)> = handles
            .map(|(handle, soft)| (&handle.vertices[..], softening(soft)))
            .collect();
        if !fixed.is_empty() {
            sets.push((&fixed, softening(&None)));
        }
        let everything = sets.iter().flat_map(|(vertices, _)| *vertices);
        let unit = Unit::of(everything.map(|&vertex| positions[vertex as usize]));
        let set = |(vertices, softening): (&[u32], f64)| {
            let samples = farthest(&thinned(vertices, positions, CANDIDATES), positions, MOST).into_iter();
            Set {
                samples: samples.map(|vertex| unit.local(positions[vertex as usize])).collect(),
                nearest: NearestPoints::of(positions, vertices.iter().copied()),
                softening,
            }
        };
        Self {
            sets: sets.into_iter().map(set).collect(),
            unit,
        }
    }
}

impl Set {
    /// The nearest of its vertices, relative to the point, in the unit of all points.
    pub fn to_nearest(&self, world_point: DVec3, positions: &[DVec3], unit: &Unit) -> DVec3 {
        let nearest = self.nearest.nearest(world_point);
        nearest.map_or(DVec3::ZERO, |(vertex, _)| {
            (positions[vertex as usize] - world_point) / unit.length
        })
    }
}
