//! Soft handles: a spring from each of their vertices to its target.
//!
//! Their vertices are solved like free ones, and E gains ½ Σ W_i |d_i − c_i|² with the strengths W of
//! [`crate::Constraints`]: the resistance of a membrane of stiffness 1 and, if the energy is smooth, of a plate of
//! stiffness κ A. This term is already quadratic, so the majorising quadratic has the same W on its diagonal.

use glam::DVec3;

use super::cells::{Quad, minus, quad};
use super::history::Field;
use super::shape::Shape;
use crate::Laplacian;
use crate::coarse::domain::Domain;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;

/// The springs of all soft handles, and the dead loads.
#[derive(Clone, Debug)]
pub(crate) struct Springs {
    springs: Vec<Spring>,
    /// The target c of each spring.
    wanted: Vec<Quad>,
    /// A dead load at each solved vertex, or none, in units of `unit`: they lower E by Σ load · d.
    pub loads: Field,
    /// The unit of length of gradients.
    unit: f64,
}

/// A spring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    /// The solved vertex that it pulls at.
    pub local: u32,
    /// W_i.
    pub strength: f64,
    handle: usize,
    coordinates: [f64; 4],
    /// The offset of its target from the handle's motion.
    offset: DVec3,
}

impl Springs {
    /// The springs of the soft handles of `partition`; `laplacian` has rows for their vertices, and the energy bends
    /// with the stiffness `bending`; gradients are measured in `unit`.
    pub fn of(
        problem: &BoundaryProblem,
        partition: &Partition,
        handles: &[Handle],
        domain: &Domain,
        laplacian: &Laplacian,
        bending: f64,
        unit: f64,
    ) -> Self {
        let mut springs = Vec::new();
        for (number, (handle, weight)) in handles.iter().zip(&partition.soft).enumerate() {
            let Some(weight) = *weight else { continue };
            let own = |&vertex: &u32| {
                let area = laplacian.inverse_areas()[laplacian.local(vertex)?].recip();
                Some((vertex, area))
            };
            let vertices: Vec<(u32, f64)> = handle.vertices.iter().filter_map(own).collect();
            let square_wave_number = std::f64::consts::PI.powi(2) / vertices.iter().map(|(_, area)| area).sum::<f64>();
            let resistance = square_wave_number + bending * square_wave_number.powi(2);
            springs.extend(vertices.into_iter().map(|(vertex, area)| Spring {
                local: domain.local_of[vertex as usize],
                strength: weight * resistance * area,
                handle: number,
                coordinates: handle.coordinates(problem.surface.positions[vertex as usize]),
                offset: DVec3::ZERO,
            }));
        }
        let wanted = vec![[0.0; 4]; springs.len()];
        Self {
            springs,
            wanted,
            loads: Field::new(),
            unit,
        }
    }

    /// All springs.
    pub fn all(&self) -> &[Spring] {
        &self.springs
    }

    /// Sets the targets' offsets from the handles' motions, for the next aim.
    pub fn set_offsets(&mut self, domain: &Domain, offsets: &Offsets) {
        for spring in &mut self.springs {
            spring.offset = offsets.at(domain.vertices[spring.local as usize]);
        }
    }

    /// Sets the targets to the handles' motions.
    pub fn aim(&mut self, motions: &[Motion]) {
        for (wanted, spring) in self.wanted.iter_mut().zip(&self.springs) {
            *wanted = quad(motions[spring.handle].displace(spring.coordinates) + spring.offset, 0.0);
        }
    }

    /// Adds the energy of springs and loads to a shape's.
    pub fn add_energy(&self, shape: &mut Shape) {
        for (spring, wanted) in self.springs.iter().zip(&self.wanted) {
            let [x, y, z, _] = minus(shape.displacements[spring.local as usize], *wanted);
            shape.energy += 0.5 * spring.strength * (x * x + y * y + z * z);
        }
        shape.energy += self.load_energy(shape);
    }

    /// −Σ load · d.
    pub fn load_energy(&self, shape: &Shape) -> f64 {
        let given = |(load, [a, b, c, _]): (&[f32; 3], &Quad)| {
            let [x, y, z] = load.map(f64::from);
            x * a + y * b + z * c
        };
        -self.unit * self.loads.iter().zip(&shape.displacements).map(given).sum::<f64>()
    }

    /// Adds the forces of springs and loads to a shape's gradient.
    pub fn add_gradient(&self, shape: &mut Shape) {
        for (spring, wanted) in self.springs.iter().zip(&self.wanted) {
            let beyond = minus(shape.displacements[spring.local as usize], *wanted);
            for (own, beyond) in shape.gradient[spring.local as usize].iter_mut().zip(beyond) {
                *own += (spring.strength * beyond / self.unit) as f32;
            }
        }
        for (load, own) in self.loads.iter().zip(&mut shape.gradient) {
            for (own, load) in own.iter_mut().zip(load) {
                *own -= load;
            }
        }
    }
}
