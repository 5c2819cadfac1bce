//! A problem's operator, and the values that its handles prescribe.

use pliant_mesh::SurfaceVertex;

use crate::Laplacian;
use crate::handles::Handle;
use crate::numerical::graph::Graph;
use crate::operators::triangulation::Triangulation;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::partition::Partition;
use crate::sparse::ordering::hubs::hub_degree;
use crate::systems::boundaries::make_natural;
use crate::systems::continuity::join;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::plate_energy::PlateEnergy;

/// A handle's places in a field, at its vertices or, if it is soft, at their springs, and their coordinates.
pub(crate) type Prescribed = Vec<(u32, [f64; 4])>;

/// The boundary condition of the plate where stiffness jumps and at free borders.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Boundaries {
    /// That of L M⁻¹ L.
    OfLaplacian,
    /// That of the squared Hessian: see [`crate::systems::natural`].
    Natural,
}

/// The problem's operator, and each handle's places in a field and their coordinates.
pub(crate) fn operator(
    problem: &BoundaryProblem,
    energy: PlateEnergy,
    partition: &Partition,
    handles: &[Handle],
    boundaries: Boundaries,
) -> (BilaplacianOperator, Vec<Prescribed>) {
    let triangulation = &partition.triangulation;
    let rows = bent_rows(triangulation, &partition.solved, handles);
    let size = problem.size();
    let on = |stiffness: &[f64]| Laplacian::on(triangulation, stiffness, &rows, energy.discretisation, &|_, _| 1.0);
    let is_painted = problem.stiffness.iter().any(|stiffness| *stiffness != 1.0);
    let mut operator;
    if is_painted && energy.power > 1 {
        operator = BilaplacianOperator::new(on(&vec![1.0; problem.stiffness.len()]), energy, size);
        match operator.power {
            2 => {
                let vertices = operator.laplacian.vertices().iter();
                operator.cell_stiffness = vertices.map(|&vertex| problem.stiffness[vertex as usize]).collect();
            }
            _ => operator.middle = Some(on(problem.stiffness)),
        }
        operator.stretched = (operator.stretching > 0.0).then(|| on(problem.stiffness));
    } else {
        operator = BilaplacianOperator::new(on(problem.stiffness), energy, size);
    }
    operator.hub_degree = hub_degree(triangulation.vertex_count());
    if operator.power == 2 && boundaries == Boundaries::Natural {
        make_natural(&mut operator, triangulation, problem, partition);
    }
    join(
        &mut operator,
        triangulation,
        problem,
        energy.discretisation,
        &rows,
        size,
    );
    let prescribed = prescribe(&mut operator, problem, partition, handles);
    (operator, prescribed)
}

/// The vertices at which L d can differ from zero: solved ones, handles and their neighbours, ascending. These rows are
/// enough at every order, because further out all inner factors are zero.
pub(crate) fn bent_rows(triangulation: &Triangulation, solved: &[u32], handles: &[Handle]) -> Vec<u32> {
    let mut bent = vec![false; triangulation.vertex_count()];
    for &vertex in solved.iter().chain(handles.iter().flat_map(|handle| &handle.vertices)) {
        bent[vertex as usize] = true;
        for neighbour in triangulation.neighbours(SurfaceVertex(vertex)) {
            bent[neighbour.index()] = true;
        }
    }
    (0..bent.len())
        .filter(|&vertex| bent[vertex])
        .map(|vertex| vertex as u32)
        .collect()
}

/// Each handle's places in a field and their coordinates; soft handles get springs.
fn prescribe(
    operator: &mut BilaplacianOperator,
    problem: &BoundaryProblem,
    partition: &Partition,
    handles: &[Handle],
) -> Vec<Vec<(u32, [f64; 4])>> {
    let mut prescribed = Vec::with_capacity(handles.len());
    for (handle, &weight) in handles.iter().zip(&partition.soft) {
        let (mut places, mut coordinates) = (Vec::new(), Vec::new());
        for &vertex in &handle.vertices {
            if let Some(local) = operator.laplacian.local(vertex) {
                places.push(local as u32);
                coordinates.push(handle.coordinates(problem.surface.positions[vertex as usize]));
            }
        }
        if let Some(weight) = weight {
            places = operator.soften(&places, weight);
        }
        prescribed.push(places.into_iter().zip(coordinates).collect());
    }
    prescribed
}
