//! Fairing: values on a part of the surface from the values around it [BS08, section 2.4; Lie03].
//!
//! The free vertices get the field x with L M⁻¹ L x = 0 (or the equation of another order), all other vertices keep
//! theirs. With positions as values, order 2 joins the surface around with continuous tangents; with colours or texture
//! coordinates, order 1 gives values that never leave the range of those around. No displacement enters, unlike in
//! bending: the free vertices' own values don't matter, only the metric of their triangles.

use pliant_mesh::{Cancel, Progress, Surface, SurfaceVertex, Topology, bounding_box};

use crate::operators::triangulation::Triangulation;
use crate::region::slender;
use crate::sparse::refactorisation::Refactorisation;
use crate::sparse::system_error::SystemError;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::refine::TOLERANCE;
use crate::systems::setup::bent_rows;
use crate::{BilaplacianOrder, BindError, Budget, Discretisation, Laplacian, Ordering};

/// Replaces the values of the vertices `free` (ascending) by the smoothest ones of the given order that fit the other
/// vertices' values. `values` has a row of three numbers for each vertex of the surface; sums are best conditioned if
/// they are small, so give positions relative to a centre.
///
/// A connected part of the surface must have a vertex that is not free. At borders of the surface among the vertices
/// next to free ones, order 2 does not bend (see `bilaplacian/detail/base.rs`).
///
/// # Errors
/// Those of binding the bi-Laplacian: a strip without end, memory, [`BindError::Cancelled`].
pub fn fair(
    surface: &Surface,
    topology: &Topology,
    free: &[u32],
    order: BilaplacianOrder,
    values: &mut [[f64; 3]],
    budget: Budget,
    cancel: &Cancel,
) -> Result<(), BindError> {
    let Some(&first) = free.first() else {
        return Ok(());
    };
    if values.len() != surface.positions.len() {
        return Err(BindError::Length {
            table: "values",
            found: values.len(),
            expected: surface.positions.len(),
        });
    }
    let triangulation = Triangulation::of_surface(surface, topology);
    let power = order.number();
    slender::check(&triangulation, free, slender::most_edges(power), Some(power))?;
    let rows = bent_rows(&triangulation, free, &[]);
    let even = vec![1.0; values.len()];
    let metric = Discretisation::CotangentArea;
    let mut laplacian = Laplacian::on(&triangulation, &even, &rows, metric, &|_, _| 1.0);
    let factors: Vec<f64> = laplacian
        .vertices()
        .iter()
        .map(|&vertex| f64::from(u8::from(!topology.is_boundary_vertex(SurfaceVertex(vertex)))))
        .collect();
    laplacian.scale_inverse_areas(|local| factors[local]);
    let diagonal = bounding_box(&surface.positions).map_or(1.0, |bounds| bounds.diagonal());
    let operator = BilaplacianOperator::new(laplacian, PlateEnergy::of_power(power), diagonal);
    let ordering = Ordering::of(topology, power, &Progress::new(), cancel)?;
    let refuse = |error: SystemError| error.into_bind_error(topology, free.len());
    let elimination = ordering.elimination(free);
    let mut system =
        BilaplacianSystem::new(operator, elimination, Refactorisation::Never, budget, cancel).map_err(refuse)?;
    let vertices = system.operator.laplacian.vertices();
    let row = |&vertex: &u32| {
        let [x, y, z] = values[vertex as usize];
        [x, y, z, 1.0]
    };
    let mut field: Vec<[f64; 4]> = vertices.iter().map(row).collect();
    let error = system.check(&mut field, cancel).map_err(refuse)?;
    if error.is_nan() || error > TOLERANCE {
        let component = topology.component(SurfaceVertex(first));
        return Err(BindError::Inaccurate {
            component,
            vertex: first,
            error,
        });
    }
    for &vertex in free {
        if let Some(local) = system.operator.laplacian.local(vertex) {
            let [x, y, z, _] = field[local];
            values[vertex as usize] = [x, y, z];
        }
    }
    Ok(())
}
