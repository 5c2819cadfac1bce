//! Each handle's weight at each vertex, by which its rotation and stretch spread [BS08, sections 3.2.1 to 3.2.3].

use pliant_mesh::{SurfaceVertex, distances_along_surface};
use rayon::prelude::*;

use super::Propagation;
use crate::budget::filled;
use crate::method::BindInput;
use crate::sparse::refactorisation::Refactorisation;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::poisson_system::PoissonSystem;
use crate::{BindError, Role};

/// The number of handles whose weights are solved for at once.
const AT_ONCE: usize = 4;

/// One row for each local vertex of the system, one weight from 0 to 1 per handle. The weights of the system itself are
/// `material`: the same factor is used for both. `harmonic` has the same factor if nothing is painted.
pub(crate) fn weights(
    propagation: Propagation,
    system: &PoissonSystem,
    input: &BindInput<'_>,
) -> Result<Vec<f64>, BindError> {
    let stiffness = input.problem.stiffness;
    let mut weights = match propagation {
        Propagation::Geodesic => by_distance(system, input)?,
        Propagation::Harmonic if stiffness.iter().any(|&value| value != 1.0) => {
            let even = vec![1.0; stiffness.len()];
            harmonic(
                &PoissonSystem::bind(PlateEnergy::of_power(1), &even, Refactorisation::Never, input)?,
                input,
            )?
        }
        Propagation::Harmonic | Propagation::Material => harmonic(system, input)?,
    };
    let count = input.handles.len();
    for (&vertex, row) in system.vertices().iter().zip(weights.chunks_exact_mut(count.max(1))) {
        // Negative cotangents may move a weight outside.
        row.iter_mut().for_each(|weight| *weight = weight.clamp(0.0, 1.0));
        let component = input.problem.topology.component(SurfaceVertex(vertex));
        let sum: f64 = row.iter().sum();
        if sum > 0.0 && !input.partition.held[component as usize] {
            row.iter_mut().for_each(|weight| *weight /= sum);
        }
    }
    Ok(weights)
}

/// L w = 0 with w = 1 on the handle, or pulled there by its springs, and 0 on all other constrained vertices.
fn harmonic(system: &PoissonSystem, input: &BindInput<'_>) -> Result<Vec<f64>, BindError> {
    let count = input.handles.len();
    let mut weights = zero_weights(system, input)?;
    for first in (0..count).step_by(AT_ONCE) {
        let mut field = system.field::<AT_ONCE>();
        let own = first..count.min(first + AT_ONCE);
        for (k, prescribed) in system.prescribed[own.clone()].iter().enumerate() {
            for &(place, _) in prescribed {
                field[place as usize][k] = 1.0;
            }
        }
        system.extend(&mut field, input)?;
        for (row, values) in weights.chunks_exact_mut(count).zip(&field) {
            row[own.clone()].copy_from_slice(&values[..own.len()]);
        }
    }
    Ok(weights)
}

/// The inverse distances along the surface, normalised.
fn by_distance(system: &PoissonSystem, input: &BindInput<'_>) -> Result<Vec<f64>, BindError> {
    let &BindInput { problem, handles, .. } = input;
    let count = handles.len();
    let fixed = (0..).zip(problem.roles).filter(|(_, role)| **role == Role::Fixed);
    let mut sources: Vec<Vec<SurfaceVertex>> = handles
        .iter()
        .map(|handle| handle.vertices.iter().map(|&vertex| SurfaceVertex(vertex)).collect())
        .collect();
    sources.push(fixed.map(|(vertex, _)| SurfaceVertex(vertex)).collect());
    let mut weights = zero_weights(system, input)?;
    let mut sums = vec![0.0; system.vertices().len()];
    // There are few at a time: a handle has one distance per vertex of the surface.
    for (group, own) in sources.chunks(AT_ONCE).enumerate() {
        input.cancel.check()?;
        let search = |sources: &Vec<SurfaceVertex>| {
            distances_along_surface(problem.surface, problem.topology, sources, f64::INFINITY)
        };
        let distances: Vec<Vec<f64>> = own.par_iter().map(search).collect();
        for (place, distances) in distances.iter().enumerate() {
            let handle = group * AT_ONCE + place;
            for (local, &vertex) in system.vertices().iter().enumerate() {
                // A source that no path reaches does not count.
                let nearness = distances[vertex as usize].max(f64::MIN_POSITIVE.sqrt()).recip();
                sums[local] += nearness;
                if handle < count {
                    weights[local * count + handle] = nearness;
                }
            }
        }
    }
    for (local, row) in weights.chunks_exact_mut(count.max(1)).enumerate() {
        let sum = sums[local];
        match problem.roles[system.vertices()[local] as usize] {
            Role::Fixed => row.fill(0.0),
            Role::Handle(own) => (0..)
                .zip(row)
                .for_each(|(handle, weight)| *weight = f64::from(handle == own)),
            Role::Free => row.iter_mut().for_each(|weight| *weight /= sum.max(f64::MIN_POSITIVE)),
        }
    }
    Ok(weights)
}

fn zero_weights(system: &PoissonSystem, input: &BindInput<'_>) -> Result<Vec<f64>, BindError> {
    let entries = system.vertices().len() * input.handles.len();
    filled(0.0, entries).map_err(|_| BindError::OutOfMemory {
        free_count: input.partition.solved.len(),
    })
}
