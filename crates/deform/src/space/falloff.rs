//! The fading of a deformation towards fixed vertices: by the straight distance to them, smoothly, so that nothing
//! tears at the region's border.

use glam::DVec3;
use rayon::prelude::*;

use super::shaping::shaping;
use crate::Role;
use crate::numerical::nearest::NearestPoints;
use crate::region::boundary_problem::BoundaryProblem;

/// A factor from 0 to 1 for each of some vertices, and its gradient per world unit.
#[derive(Clone, Debug, Default)]
pub(crate) struct Falloff {
    /// Empty if nothing is fixed: 1 everywhere.
    factors: Vec<(f64, DVec3)>,
}

impl Falloff {
    /// s(t) = t² (3 − 2 t) with t the distance to the nearest fixed vertex over `width`, in world units, of each of
    /// these vertices. With a width of 0 only fixed vertices have the factor 0.
    pub fn of(problem: &BoundaryProblem, vertices: &[u32], width: f64) -> Self {
        let positions = &problem.surface.positions;
        let fixed = (0..)
            .zip(problem.roles)
            .filter_map(|(vertex, role)| (*role == Role::Fixed).then_some(vertex));
        let fixed = shaping(problem, fixed);
        if fixed.is_empty() {
            return Self::default();
        }
        let fixed = NearestPoints::of(positions, fixed.into_iter());
        let factor = |&vertex: &u32| {
            let point = positions[vertex as usize];
            let Some((nearest, distance)) = fixed.nearest(point) else {
                return (1.0, DVec3::ZERO);
            };
            if distance >= width {
                return (1.0, DVec3::ZERO);
            }
            let t = distance / width;
            let away = (point - positions[nearest as usize]).normalize_or_zero();
            (t * t * (3.0 - 2.0 * t), away * (6.0 * t * (1.0 - t) / width))
        };
        Self {
            factors: vertices.par_iter().map(factor).collect(),
        }
    }

    /// The factor of the vertex at this place of the list, and its gradient.
    pub fn at(&self, place: usize) -> (f64, DVec3) {
        self.factors.get(place).copied().unwrap_or((1.0, DVec3::ZERO))
    }
}
