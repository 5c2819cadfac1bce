//! Soft handles: a spring from each of their vertices to its target; and dead loads.
//!
//! The handles' vertices are solved like free ones, and E gains ½ Σ W_i |d_i − c_i|² with the strengths W of
//! [`crate::Constraints`]: the resistance of the method's own material. This term is already quadratic, so the
//! majorising quadratic has the same W on its diagonal.

use glam::DVec3;

use crate::handles::offsets::Offsets;
use crate::handles::{Handle, Motion};
use crate::sparse::solve::rhs::Real;

/// The springs of all soft handles, and the dead loads. Gradients have numbers of `T`.
#[derive(Clone, Debug)]
pub(crate) struct Springs<T> {
    springs: Vec<Spring>,
    /// The target c of each spring.
    wanted: Vec<DVec3>,
    /// A dead load at each solved vertex, or none, in units of `unit`: they lower E by Σ load · d.
    pub loads: Vec<[T; 3]>,
    /// The unit of length of gradients.
    unit: f64,
}

/// A spring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    /// The solved vertex that it pulls at.
    pub local: u32,
    pub handle: usize,
    /// W_i.
    pub strength: f64,
    surface_vertex: u32,
    coordinates: [f64; 4],
    /// The offset of its target from the handle's motion.
    offset: DVec3,
}

impl<T: Real> Springs<T> {
    /// The springs of those handles that have a weight in `soft`. `area` is that around a surface vertex, `None` if the
    /// energy does not see it; `resistance` is that of the material for the square wave number of a handle's whole
    /// area; `local_of` is the number of a solved vertex. Gradients are measured in `unit`.
    pub fn of(
        (handles, soft): (&[Handle], &[Option<f64>]),
        world_rest: &[DVec3],
        area: impl Fn(u32) -> Option<f64>,
        resistance: impl Fn(f64) -> f64,
        local_of: impl Fn(u32) -> Option<u32>,
        unit: f64,
    ) -> Self {
        let mut springs = Vec::new();
        for (number, (handle, weight)) in handles.iter().zip(soft).enumerate() {
            let Some(weight) = *weight else { continue };
            let with_area = |&vertex: &u32| Some((vertex, area(vertex)?));
            let vertices: Vec<(u32, f64)> = handle.vertices.iter().filter_map(with_area).collect();
            let whole: f64 = vertices.iter().map(|(_, area)| area).sum();
            let resistance = resistance(std::f64::consts::PI.powi(2) / whole);
            let spring = |(vertex, area): (u32, f64)| {
                Some(Spring {
                    local: local_of(vertex)?,
                    handle: number,
                    strength: weight * resistance * area,
                    surface_vertex: vertex,
                    coordinates: handle.coordinates(world_rest[vertex as usize]),
                    offset: DVec3::ZERO,
                })
            };
            let of_handle = vertices.into_iter().filter_map(spring);
            springs.extend(of_handle.filter(|spring| spring.strength.is_finite()));
        }
        Self {
            wanted: vec![DVec3::ZERO; springs.len()],
            springs,
            loads: Vec::new(),
            unit,
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

    /// Sets the targets' offsets from the handles' motions, for the next aim.
    pub fn set_offsets(&mut self, offsets: &Offsets) {
        for spring in &mut self.springs {
            spring.offset = offsets.at(spring.surface_vertex);
        }
    }

    /// Sets the targets to the handles' motions.
    pub fn aim(&mut self, motions: &[Motion]) {
        for (wanted, spring) in self.wanted.iter_mut().zip(&self.springs) {
            *wanted = motions[spring.handle].displace(spring.coordinates) + spring.offset;
        }
    }

    /// The energy `other`, and that of springs and loads. `displacement` is that of a solved vertex.
    pub fn added_energy(&self, other: f64, displacement: impl Fn(usize) -> DVec3) -> f64 {
        let each = self.wanted().zip(&self.springs);
        let held = each.fold(other, |energy, ((local, wanted), spring)| {
            energy + 0.5 * spring.strength * displacement(local).distance_squared(wanted)
        });
        held + self.load_energy(displacement)
    }

    /// −Σ load · d.
    pub fn load_energy(&self, displacement: impl Fn(usize) -> DVec3) -> f64 {
        let given = |(local, load): (usize, &[T; 3])| DVec3::from_array(load.map(T::wide)).dot(displacement(local));
        -self.unit * self.loads.iter().enumerate().map(given).sum::<f64>()
    }

    /// Adds the forces of springs and loads to a gradient.
    pub fn add_gradient(&self, displacement: impl Fn(usize) -> DVec3, gradient: &mut [[T; 3]]) {
        for ((local, wanted), spring) in self.wanted().zip(&self.springs) {
            let pull = (displacement(local) - wanted) * spring.strength / self.unit;
            for (own, pull) in gradient[local].iter_mut().zip(pull.to_array()) {
                *own = *own + T::of(pull);
            }
        }
        for (own, load) in gradient.iter_mut().zip(&self.loads) {
            for (own, load) in own.iter_mut().zip(load) {
                *own = *own - *load;
            }
        }
    }
}
