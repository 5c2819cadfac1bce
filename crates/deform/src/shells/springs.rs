//! Soft handles: a spring from each of their vertices to its target.
//!
//! Their vertices are solved for like free ones, and E gains ½ Σ W_i |d_i − c_i|² with the strengths W of
//! [`crate::Constraints`]: the resistance of a sheet of these stiffnesses, q A_i (k_s + k_b D² q) for the handle's
//! square wave number q.

use glam::DVec3;

use super::Shells;
use super::elements::Elements;
use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::numerical::sums::Field;
use crate::primo::edges::area;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;

/// The springs of all soft handles, and the dead loads.
#[derive(Clone, Debug, Default)]
pub(super) struct Springs {
    springs: Vec<Spring>,
    /// c of each, in world units.
    wanted: Vec<DVec3>,
    /// A dead load at each solved vertex, or none: they lower E by Σ load · d.
    pub loads: Field,
}

/// A spring.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    /// The solved vertex that it pulls at.
    pub local: u32,
    pub handle: usize,
    /// W_i.
    pub strength: f64,
    coordinates: [f64; 4],
    /// The offset of its target from the handle's motion.
    offset: DVec3,
}

impl Springs {
    /// Makes the springs of the soft handles of `partition`.
    pub fn of(
        problem: &BoundaryProblem,
        options: &Shells,
        partition: &Partition,
        handles: &[Handle],
        elements: &Elements,
    ) -> Self {
        if partition.soft.iter().all(Option::is_none) {
            return Self::default();
        }
        let surface = problem.surface;
        let mut areas = vec![0.0; surface.positions.len()];
        for (face, corners) in (0..).zip(&surface.triangles) {
            let share = area(surface, face) / 3.0;
            corners.iter().for_each(|corner| areas[corner.index()] += share);
        }
        let size = problem.size();
        let local_of = elements.local_of(surface.positions.len());
        let mut springs = Vec::new();
        for (number, (handle, weight)) in handles.iter().zip(&partition.soft).enumerate() {
            let Some(weight) = *weight else { continue };
            let whole: f64 = handle.vertices.iter().map(|&vertex| areas[vertex as usize]).sum();
            let square_wave_number = std::f64::consts::PI.powi(2) / whole;
            let bending = options.bending * size * size * square_wave_number;
            let resistance = square_wave_number * (options.stretching + bending);
            springs.extend(handle.vertices.iter().map(|&vertex| Spring {
                local: local_of[vertex as usize],
                handle: number,
                strength: weight * resistance * areas[vertex as usize],
                coordinates: handle.coordinates(surface.positions[vertex as usize]),
                offset: DVec3::ZERO,
            }));
        }
        springs.retain(|spring| (spring.local as usize) < elements.solved_count && spring.strength.is_finite());
        let wanted = vec![DVec3::ZERO; springs.len()];
        Self {
            springs,
            wanted,
            loads: Field::new(),
        }
    }

    /// All springs.
    pub fn all(&self) -> &[Spring] {
        &self.springs
    }

    /// The solved vertices with their wanted displacements.
    pub fn wanted(&self) -> impl Iterator<Item = (usize, DVec3)> + '_ {
        let each = self.springs.iter().zip(&self.wanted);
        each.map(|(spring, wanted)| (spring.local as usize, *wanted))
    }

    /// Sets the targets' offsets from the handles' motions, for the next aim; `vertices` has the surface vertex of each
    /// local vertex.
    pub fn set_offsets(&mut self, vertices: &[u32], offsets: &Offsets) {
        for spring in &mut self.springs {
            spring.offset = offsets.at(vertices[spring.local as usize]);
        }
    }

    /// Sets the targets to the handles' motions.
    pub fn aim(&mut self, motions: &[Motion]) {
        for (wanted, spring) in self.wanted.iter_mut().zip(&self.springs) {
            *wanted = motions[spring.handle].displace(spring.coordinates) + spring.offset;
        }
    }

    /// The energy of the springs.
    pub fn energy(&self, displacements: &[DVec3]) -> f64 {
        let each = self.springs.iter().zip(&self.wanted);
        let held = each
            .map(|(spring, wanted)| spring.strength * displacements[spring.local as usize].distance_squared(*wanted));
        0.5 * held.sum::<f64>() + self.load_energy(displacements)
    }

    /// −Σ load · d.
    pub fn load_energy(&self, displacements: &[DVec3]) -> f64 {
        let given = self.loads.iter().zip(displacements);
        -given
            .map(|(load, moved)| DVec3::from_array(*load).dot(*moved))
            .sum::<f64>()
    }

    /// Adds the springs' and loads' gradient.
    pub fn add_gradient(&self, displacements: &[DVec3], gradient: &mut [[f64; 3]]) {
        for (spring, wanted) in self.springs.iter().zip(&self.wanted) {
            let pull = (displacements[spring.local as usize] - *wanted) * spring.strength;
            let own = &mut gradient[spring.local as usize];
            own.iter_mut().zip(pull.to_array()).for_each(|(own, pull)| *own += pull);
        }
        for (own, load) in gradient.iter_mut().zip(&self.loads) {
            own.iter_mut().zip(load).for_each(|(own, load)| *own -= load);
        }
    }
}
