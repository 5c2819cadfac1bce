//! The continuity with which the bi-Laplacian joins constrained vertices ([BK04], section 4.2, in a symmetric form).
//!
//! The free surface depends on the slope at a constrained vertex only through the curvature there, u_i = (M⁻¹ L d)_i,
//! and on the curvature only through its change across the faces beyond. So M⁻¹ damped to zero at constrained vertices
//! makes a hinge, C⁰ with u = 0; without damping the slope is kept, C¹. At order 3 the middle L of L M⁻¹ L M⁻¹ L makes
//! C² with the faces between constrained vertices and C¹ without them. The recursion of [BK04] damps the outer M⁻¹
//! only, which is not symmetric; with both damped alike the system has an energy.
//!
//! Between two whole numbers there is a spring against the rotation (or the curvature), of stiffness t / (1 − t) per
//! diagonal: the damping depends on the size of the cell, so that the shape does not depend on the resolution.

use pliant_mesh::{SurfaceVertex, area_of_lengths};

use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::systems::operator::BilaplacianOperator;
use crate::{Discretisation, Laplacian, Role};

/// Damps the operator at constrained vertices according to [`crate::Constraints::continuity`]; `rows` are its full
/// rows.
pub(crate) fn join(
    operator: &mut BilaplacianOperator,
    triangulation: &Triangulation,
    problem: &BoundaryProblem,
    discretisation: Discretisation,
    rows: &[u32],
    diagonal: f64,
) {
    let continuity = problem.constraints.continuity;
    if continuity.is_empty() || operator.power == 1 {
        return;
    }
    let of = |vertex: u32| match problem.roles[vertex as usize] {
        Role::Free => None,
        Role::Handle(handle) if problem.constraints.weight(handle).is_some() => None,
        Role::Fixed | Role::Handle(_) => Some(continuity[vertex as usize]),
    };
    if operator.power == 3 {
        let beyond = |corners: [SurfaceVertex; 3], lengths: [f64; 3]| {
            let [Some(a), Some(b), Some(c)] = corners.map(|corner| of(corner.0)) else {
                return 1.0;
            };
            damping(a.min(b).min(c) - 1.0, area_of_lengths(lengths).sqrt() / diagonal)
        };
        operator.middle = Some(Laplacian::on(
            triangulation,
            problem.stiffness,
            rows,
            discretisation,
            &beyond,
        ));
    }
    for laplacian in std::iter::once(&mut operator.laplacian).chain(&mut operator.middle) {
        let factors: Vec<f64> = laplacian
            .vertices()
            .iter()
            .zip(laplacian.inverse_areas())
            .map(|(&vertex, inverse)| match of(vertex) {
                Some(continuity) if *inverse > 0.0 => damping(continuity, inverse.sqrt().recip() / diagonal),
                _ => 1.0,
            })
            .collect();
        laplacian.scale_inverse_areas(|local| factors[local]);
    }
}

/// The damping of a cell of the size `size`, in diagonals, for the fractional part `t` of a continuity.
fn damping(t: f64, size: f64) -> f64 {
    if t <= 0.0 {
        return 0.0;
    }
    if t >= 1.0 {
        return 1.0;
    }
    let spring = t / (1.0 - t) * size;
    spring / (1.0 + spring)
}
