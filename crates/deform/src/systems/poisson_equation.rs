//! The Poisson equation −L p = b of functions on a whole surface, factored once for all loads b.
//!
//! Without prescribed values a solution is determined up to a constant on each component, and exists if the load's sum
//! over each component is zero. So one vertex of each component is held at zero: its own equation follows from the
//! others'.

use pliant_mesh::{Cancel, Surface, Topology, bounding_box};
use rayon::prelude::*;

use crate::numerical::rows::CHUNK;
use crate::operators::triangulation::Triangulation;
use crate::region::slender;
use crate::sparse::refactorisation::Refactorisation;
use crate::sparse::system_error::SystemError;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::poisson_system::settled;
use crate::systems::setup::bent_rows;
use crate::{BindError, Budget, Discretisation, Laplacian, Ordering, SolveError};

/// The factored Laplacian of a whole surface, with one vertex of each component held at zero.
#[derive(Debug)]
pub struct PoissonEquation {
    /// `None` if no component has more than one vertex.
    system: Option<BilaplacianSystem>,
}

impl PoissonEquation {
    /// Factors the Laplacian, with even stiffness. `ordering` is for power 1.
    ///
    /// # Errors
    /// The errors of a method's binding: degenerate triangles, a strip without end, memory, [`BindError::Cancelled`].
    pub fn bind(
        surface: &Surface,
        topology: &Topology,
        ordering: &Ordering,
        budget: Budget,
        cancel: &Cancel,
    ) -> Result<Self, BindError> {
        let mut is_held = vec![false; surface.positions.len()];
        for component in 0..topology.components().len() {
            if let Some(first) = topology.vertices_of(component as u32).next() {
                is_held[first.index()] = true;
            }
        }
        let solved: Vec<u32> = (0..is_held.len() as u32).filter(|&v| !is_held[v as usize]).collect();
        if solved.is_empty() {
            return Ok(Self { system: None });
        }
        let triangulation = Triangulation::of_surface(surface, topology);
        slender::check(&triangulation, &solved, slender::most_edges(1), Some(1))?;
        let stiffness = vec![1.0; surface.positions.len()];
        let rows = bent_rows(&triangulation, &solved, &[]);
        let metric = Discretisation::CotangentArea;
        let laplacian = Laplacian::on(&triangulation, &stiffness, &rows, metric, &|_, _| 1.0);
        let operator = BilaplacianOperator::new(laplacian, PlateEnergy::of_power(1), diagonal_of(surface));
        let elimination = ordering.elimination(&solved);
        let refuse = |error: SystemError| error.into_bind_error(topology, solved.len());
        let mut system =
            BilaplacianSystem::new(operator, elimination, Refactorisation::Never, budget, cancel).map_err(refuse)?;
        let mut constant = vec![[1.0]; system.operator.field_len()];
        system.check(&mut constant, cancel).map_err(refuse)?;
        Ok(Self { system: Some(system) })
    }

    /// Fills `solution` with p, for a load b; both have an entry for each vertex of the surface. The load of a held
    /// vertex is not read: it must be the one that makes its component's sum zero.
    ///
    /// # Errors
    /// If the solution stays too inaccurate.
    pub fn solve(&self, load: &[f64], solution: &mut [f64]) -> Result<(), SolveError> {
        solution.fill(0.0);
        let Some(system) = &self.system else {
            return Ok(());
        };
        let (vertices, factor) = (system.operator.laplacian.vertices(), self.load_factor());
        let row = |&local: &u32| [load[vertices[local as usize] as usize] * factor];
        let load: Vec<[f64; 1]> = system.columns().par_iter().with_min_len(CHUNK).map(row).collect();
        let mut field = vec![[0.0]; system.operator.field_len()];
        settled(system.solve_frame(&load, &mut field))?;
        for (&vertex, [value]) in vertices.iter().zip(field) {
            solution[vertex as usize] = value;
        }
        Ok(())
    }

    /// The number of entries that the factor stores.
    pub fn factor_len(&self) -> usize {
        self.system.as_ref().map_or(0, BilaplacianSystem::factor_len)
    }

    /// The factored system A p = A's stiffness times b; `None` if no component has more than one vertex.
    pub(crate) fn system(&self) -> Option<&BilaplacianSystem> {
        self.system.as_ref()
    }

    /// k in A = −k L.
    pub(crate) fn load_factor(&self) -> f64 {
        let operator = self.system.as_ref().map(|system| &system.operator);
        operator.map_or(1.0, |operator| operator.stretching + operator.bending)
    }
}

/// The diagonal of the box around a surface's triangles: bare points do not count.
pub(crate) fn diagonal_of(surface: &Surface) -> f64 {
    let corners = surface.triangles.iter().flatten();
    let places: Vec<_> = corners.map(|corner| surface.positions[corner.index()]).collect();
    bounding_box(&places).map_or(0.0, |bounds| bounds.diagonal())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use pliant_mesh::{Progress, SurfaceVertex, shapes};

    use super::*;

    #[test]
    fn the_solution_of_a_function_s_laplacian_is_the_function_up_to_a_constant_on_each_component() {
        for (name, drawn) in shapes::classes() {
            let model = shapes::model(drawn);
            let (surface, topology) = (&model.surface, &model.topology);
            let cancel = Cancel::new();
            let ordering = Ordering::of(topology, 1, &Progress::new(), &cancel).unwrap();
            let equation = PoissonEquation::bind(surface, topology, &ordering, Budget::default(), &cancel).unwrap();
            let count = surface.positions.len();
            let function: Vec<[f64; 1]> = (0..count).map(|v| [((v * 7) % 11) as f64]).collect();
            let laplacian = Laplacian::of(surface, topology, &vec![1.0; count]);
            let mut load = vec![0.0; count];
            for (local, &vertex) in laplacian.vertices().iter().enumerate() {
                load[vertex as usize] = -laplacian.row(local, &function)[0];
            }
            let mut solution = vec![f64::NAN; count];
            equation.solve(&load, &mut solution).unwrap();
            for component in 0..topology.components().len() as u32 {
                let first = topology.vertices_of(component).next().unwrap().index();
                for v in topology.vertices_of(component).map(SurfaceVertex::index) {
                    let error = solution[v] - (function[v][0] - function[first][0]);
                    assert!(error.abs() < 1e-6, "{name}, vertex {v}: {error}");
                }
            }
        }
    }
}
