//! With which continuity the bi-Laplacian joins what holds it ([BK04], section 4.2, in a symmetric form).
//!
//! What is free sees the slope at a constrained vertex only through the curvature there, u_i = (M⁻¹ L d)_i, and the
//! curvature only through its change across the faces beyond. So a damped M⁻¹ at constrained vertices makes a hinge, C⁰
//! with u = 0; undamped, the slope is kept, C¹; and at order 3 the middle L of L M⁻¹ L M⁻¹ L, with the faces between
//! constrained vertices or without them, makes C² or C¹. Their recursion damps the outer M⁻¹ alone, which is not
//! symmetric; both of them damped alike, the system is that of an energy.
//!
//! Between two whole numbers stands a spring against the turn (or the curvature), of stiffness t / (1 − t) per
//! diagonal: a damping that knows the size of its cell, so that the resolution does not show.

use pliant_mesh::{SurfaceVertex, area_of_lengths};

use crate::bilaplacian::operator::BilaplacianOperator;
use crate::operators::triangulation::Triangulation;
use crate::{Bilaplacian, Laplacian, Problem, Role};

/// Damps the operator at constrained vertices as [`crate::Constraints::continuity`] says; `rows` are its full rows.
pub(crate) fn join(
    operator: &mut BilaplacianOperator,
    triangulation: &Triangulation,
    problem: &Problem,
    options: &Bilaplacian,
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
            options.discretisation,
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

/// What a cell of the size `size`, in diagonals, is damped by for the share `t` of a continuity.
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
