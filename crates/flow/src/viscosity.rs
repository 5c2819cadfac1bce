//! Viscosity: neighbouring triangles' velocities become alike.
//!
//! An implicit step: (A + ν Δt W) u' = A u, with the triangles' areas A and W u = Σ w (u_t − u_s), where the velocity
//! of the triangle beside is turned over the edge, and w is the edge's length over the distance of the two middles
//! across it. It is stable for any viscosity. Conjugate gradients with A as preconditioner begin at zero, so that each
//! of their iterates has less kinetic energy than u.

use glam::DVec2;
use rayon::prelude::*;

use crate::fluid::Fluid;
use crate::hinges::WALL;
use crate::plane::turned_back;
use crate::sums::{CHUNK, sum};

/// The most steps of conjugate gradients.
const MOST: usize = 100;

/// They end when the residual is below this share of the first.
const ENOUGH: f64 = 1e-5;

/// The exchange between each triangle and those beside it.
#[derive(Debug)]
pub(crate) struct Friction {
    /// For each edge: w times the rotation to the triangle beside; zero at a border.
    exchange: Vec<[DVec2; 3]>,
}

impl Friction {
    pub fn of(fluid: &Fluid<'_>) -> Self {
        let domain = &fluid.domain;
        let of = |corner: u32| match domain.crossings.beside(corner) {
            WALL => DVec2::ZERO,
            other => {
                let chart = &domain.charts[corner as usize / 3];
                let areas = chart.area() + domain.charts[other as usize / 3].area();
                // A middle is a third of its triangle's height from the edge.
                let weight = 1.5 * chart.edge(corner as usize % 3).length_squared() / areas;
                domain.turn(corner, other) * weight
            }
        };
        let exchange = (0..fluid.triangle_count() as u32)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|triangle| [0, 1, 2].map(|k| of(3 * triangle + k)))
            .collect();
        Self { exchange }
    }

    /// A u + `time` W u.
    fn apply(&self, fluid: &Fluid<'_>, time: f64, u: &[DVec2], out: &mut [DVec2]) {
        let row = |(triangle, out): (usize, &mut DVec2)| {
            let own = u[triangle];
            let mut sum = DVec2::ZERO;
            for (k, &exchange) in self.exchange[triangle].iter().enumerate() {
                let other = fluid.domain.crossings.beside((3 * triangle + k) as u32);
                if other != WALL {
                    sum += own * exchange.length() - turned_back(exchange, u[other as usize / 3]);
                }
            }
            *out = own * fluid.domain.charts[triangle].area() + sum * time;
        };
        out.par_iter_mut().with_min_len(CHUNK).enumerate().for_each(row);
    }

    /// Replaces a velocity by that after `time` times the viscosity.
    pub fn smooth(&self, fluid: &Fluid<'_>, time: f64, velocity: &mut [DVec2]) {
        let area = |triangle: usize| fluid.domain.charts[triangle].area();
        let count = velocity.len();
        let mut x = vec![DVec2::ZERO; count];
        let mut r: Vec<DVec2> = (0..count).map(|triangle| velocity[triangle] * area(triangle)).collect();
        let mut p = velocity.to_vec();
        let mut product = vec![DVec2::ZERO; count];
        let squared = |r: &[DVec2]| sum(count, |t| [r[t].length_squared() / area(t)])[0];
        let mut rho = squared(&r);
        let enough = rho * ENOUGH * ENOUGH;
        for _ in 0..MOST {
            if rho <= enough {
                break;
            }
            self.apply(fluid, time, &p, &mut product);
            let [curvature] = sum(count, |t| [p[t].dot(product[t])]);
            if curvature <= 0.0 {
                break;
            }
            let step = rho / curvature;
            let rows = x.par_iter_mut().zip(&mut r).zip(&p).zip(&product).with_min_len(CHUNK);
            rows.for_each(|(((x, r), p), product)| {
                *x += *p * step;
                *r -= *product * step;
            });
            let next = squared(&r);
            let turn = next / rho;
            rho = next;
            let rows = p.par_iter_mut().zip(&r).with_min_len(CHUNK).enumerate();
            rows.for_each(|(triangle, (p, r))| *p = *r / area(triangle) + *p * turn);
        }
        velocity.copy_from_slice(&x);
    }
}
