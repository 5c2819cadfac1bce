//! Accelerations of the fluid on each triangle.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::dye::Dye;
use crate::fluid::Fluid;
use crate::hinges::{WALL, last};
use crate::sums::CHUNK;

/// Adds gravity along the surface for `seconds`, in proportion to the coverage by dye; `dye` may be empty.
pub(crate) fn pull(fluid: &Fluid<'_>, dye: &[Dye], gravity: DVec3, seconds: f64, velocity: &mut [DVec2]) {
    if gravity == DVec3::ZERO || dye.is_empty() {
        return;
    }
    let add = |(triangle, velocity): (usize, &mut DVec2)| {
        let coverage = fluid
            .corners(triangle)
            .iter()
            .map(|&corner| dye[corner][3])
            .sum::<f64>()
            / 3.0;
        if coverage > 0.0 {
            // The part along the surface is the gradient of the height that gravity sees.
            let [a, b, c] = fluid.sheets.surface.corners(triangle);
            let falls = [0.0, gravity.dot(b - a), gravity.dot(c - a)];
            *velocity += fluid.domain.charts[triangle].gradient(falls) * (coverage * seconds);
        }
    };
    velocity.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(add);
}

/// Vorticity confinement [FSJ01, equation 11] for `seconds`: pushes the fluid around the places at which it turns
/// fastest, in proportion to the vorticity and to the size of the triangle.
pub(crate) fn confine(fluid: &Fluid<'_>, strength: f64, seconds: f64, velocity: &mut [DVec2]) {
    if strength == 0.0 {
        return;
    }
    let vorticity = vorticity(fluid, velocity);
    let add = |(triangle, velocity): (usize, &mut DVec2)| {
        let values = fluid.corners(triangle).map(|corner| vorticity[corner]);
        let chart = &fluid.domain.charts[triangle];
        let uphill = chart.gradient(values.map(f64::abs)).normalize_or_zero();
        let mean = values.iter().sum::<f64>() / 3.0;
        *velocity -= uphill.perp() * (strength * chart.area().sqrt() * mean * seconds);
    };
    velocity.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(add);
}

/// The vorticity at each vertex: the circulation around its share of the triangles, over their area. It is 0 at borders,
/// where the share has an end.
fn vorticity(fluid: &Fluid<'_>, velocity: &[DVec2]) -> Vec<f64> {
    let domain = &fluid.domain;
    let of = |vertex: usize| {
        let corners = domain.fans.corners(vertex);
        let is_inside = corners
            .first()
            .is_some_and(|&first| domain.crossings.beside(last(first)) != WALL);
        if !is_inside {
            return 0.0;
        }
        let around = |&corner: &u32| {
            let triangle = corner as usize / 3;
            0.5 * domain.charts[triangle]
                .edge(corner as usize % 3)
                .dot(velocity[triangle])
        };
        corners.iter().map(around).sum::<f64>() / fluid.masses[vertex]
    };
    (0..fluid.vertex_count())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(of)
        .collect()
}
