//! The smooth base: L^k x = 0 on the bending part, the surface itself elsewhere [BS08, section 2.4].
//!
//! Or the surface after a finite time of fairing, by one implicit step [DMSB99]: with a length ℓ and rest positions p,
//! (M ℓ⁻²ᵏ + (−L)(−M⁻¹ L)ᵏ⁻¹) x = M ℓ⁻²ᵏ p. A wave of the surface with wave number q keeps the share 1 / (1 + (ℓ q)²ᵏ),
//! so details shorter than about 2π ℓ vanish and a limb of radius r keeps r / (1 + (ℓ / r)²ᵏ). Without end, every limb
//! shrinks to a line.
//!
//! Where stiffness s is painted, the time is shorter: a stiff part is its own base and has no details.
//!
//! L is measured on the surface, as for bending. Handles, fixed vertices and borders keep their positions. At a border
//! L x is the flux across it, which does not vanish on a plane, so the border's cells are left out of the energy: a
//! flat sheet is then its own base, with free borders or without.

use glam::{DMat3, DVec3};
use pliant_mesh::SurfaceVertex;

use super::carry::Carried;
use crate::handles::Motion;
use crate::method::BindInput;
use crate::methods::bilaplacian::solver::BilaplacianSolver;
use crate::region::boundary_problem::BoundaryProblem;
use crate::region::patch::Patch;
use crate::region::slender;
use crate::sparse::ordering::hubs::hub_degree;
use crate::sparse::refactorisation::Refactorisation;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::poisson_system::refused;
use crate::systems::refine::TOLERANCE;
use crate::systems::setup::bent_rows;
use crate::{Bilaplacian, BindError, Laplacian};

/// The base's rest shape.
#[derive(Debug)]
pub(crate) struct Base {
    /// The base's points relative to the centre of the surface's bounding box.
    pub patch: Patch,
    /// The surface's vertex less the base's, for each row.
    pub offsets: Vec<DVec3>,
    /// Whether fairing moved the row.
    pub is_faired: Vec<bool>,
    /// The centre of the surface's bounding box.
    pub centre: DVec3,
    carried: Carried,
}

/// A part of stiffness s is faired for no longer than the time of this length ℓ (s − 1)^(−1/2k), in sizes. It is much
/// less than the radius of a limb: with 0.05 a scan's arm lost half of its radius at s = 10.
const STIFF_LENGTH: f64 = 0.005;

/// The base's points, one for each surface vertex, relative to the centre of the surface's bounding box.
pub(crate) struct Faired {
    points: Vec<DVec3>,
    /// The solved surface vertices, ascending.
    vertices: Vec<u32>,
}

impl Faired {
    /// Fairs the solved part of the surface, without soft handles and borders, for a time of this length in world
    /// units, or without end.
    ///
    /// # Errors
    /// The errors of the bi-Laplacian of that order.
    pub fn of(options: &Bilaplacian, length: Option<f64>, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput {
            problem,
            partition,
            cancel,
            ..
        } = input;
        let bounds = problem.bounds();
        let centre = bounds.map_or(DVec3::ZERO, |bounds| bounds.centre());
        let mut points: Vec<DVec3> = problem.surface.positions.iter().map(|p| *p - centre).collect();
        let mut is_held = vec![false; points.len()];
        for vertex in problem.topology.boundary_edge_list().as_flattened() {
            is_held[vertex.index()] = true;
        }
        let is_border = is_held.clone();
        for handle in &partition.handles {
            handle.iter().for_each(|&vertex| is_held[vertex as usize] = true);
        }
        let solved = partition.solved.iter().copied();
        let faired: Vec<u32> = solved.filter(|&vertex| !is_held[vertex as usize]).collect();
        if faired.is_empty() {
            return Ok(Self {
                points,
                vertices: faired,
            });
        }
        let order = options.base_order.number();
        let triangulation = &partition.triangulation;
        slender::check(triangulation, &faired, slender::most_edges(order), Some(order))?;
        let fairing = PlateEnergy {
            discretisation: options.discretisation,
            ..PlateEnergy::of_power(order)
        };
        let rows = bent_rows(triangulation, &faired, &[]);
        let even = vec![1.0; points.len()];
        let mut laplacian = Laplacian::on(triangulation, &even, &rows, options.discretisation, &|_, _| 1.0);
        let factors: Vec<f64> = laplacian
            .vertices()
            .iter()
            .map(|&vertex| if is_border[vertex as usize] { 0.0 } else { 1.0 })
            .collect();
        laplacian.scale_inverse_areas(|local| factors[local]);
        let diagonal = bounds.map_or(0.0, |bounds| bounds.diagonal());
        let mut operator = BilaplacianOperator::new(laplacian, fairing, diagonal);
        operator.hub_degree = hub_degree(triangulation.vertex_count());
        let ties = Ties::of(problem, &faired, length, operator.power);
        ties.add_to(&mut operator);
        let elimination = input.ordering()?.elimination(&faired);
        let refuse = |error| refused(error, input);
        let budget = partition.budget;
        let mut system =
            BilaplacianSystem::new(operator, elimination, Refactorisation::Never, budget, cancel).map_err(refuse)?;
        let vertices = system.operator.laplacian.vertices();
        let row = |&vertex: &u32| {
            let point = points[vertex as usize];
            [point.x, point.y, point.z, 1.0]
        };
        let mut field: Vec<[f64; 4]> = vertices.iter().map(row).collect();
        field.extend(ties.vertices.iter().map(row));
        let error = system.check(&mut field, cancel).map_err(refuse)?;
        if error.is_nan() || error > TOLERANCE {
            let vertex = faired[0];
            let component = problem.topology.component(SurfaceVertex(vertex));
            return Err(BindError::Inaccurate {
                component,
                vertex,
                error,
            });
        }
        for (&vertex, [x, y, z, _]) in system.operator.laplacian.vertices().iter().zip(&field) {
            if faired.binary_search(&vertex).is_ok() {
                points[vertex as usize] = DVec3::new(*x, *y, *z);
            }
        }
        Ok(Self {
            points,
            vertices: faired,
        })
    }
}

/// The faired vertices that springs of M k_b ℓ⁻²ᵏ tie to their rest positions, and ℓ⁻²ᵏ of each.
#[derive(Default)]
struct Ties {
    vertices: Vec<u32>,
    firmness: Vec<f64>,
}

impl Ties {
    /// Ties for a time of this length, and where the surface is stiff.
    ///
    /// A stiff part's displacements are those of a body, taken at the surface: on a base that has shrunk away from the
    /// surface they would be those of a larger body, and the base would swell.
    fn of(problem: &BoundaryProblem<'_>, faired: &[u32], length: Option<f64>, power: u32) -> Self {
        let own = |length: f64| length.powi(-2 * power as i32);
        let stiff = own(STIFF_LENGTH * problem.size());
        let firmness = |vertex: u32| {
            let excess = (problem.stiffness[vertex as usize] - 1.0).max(0.0);
            length.map_or(0.0, own) + stiff * excess
        };
        let tied = faired.iter().map(|&vertex| (vertex, firmness(vertex)));
        let (vertices, firmness) = tied.filter(|(_, firmness)| *firmness > 0.0).unzip();
        Self { vertices, firmness }
    }

    fn add_to(&self, operator: &mut BilaplacianOperator) {
        if self.vertices.is_empty() {
            return;
        }
        let laplacian = &operator.laplacian;
        let locals = laplacian.locals(&self.vertices);
        let strength =
            |(&local, firmness): (&u32, &f64)| operator.bending * firmness / laplacian.inverse_areas()[local as usize];
        let strengths: Vec<f64> = locals.iter().zip(&self.firmness).map(strength).collect();
        operator.hang(&locals, &strengths);
    }
}

impl Base {
    /// The faired part of the surface as `solver` bends it.
    pub fn of(faired: &Faired, solver: &BilaplacianSolver<f64>, input: &BindInput<'_>) -> Self {
        let &BindInput { problem, partition, .. } = input;
        let bounds = problem.bounds();
        let centre = bounds.map_or(DVec3::ZERO, |bounds| bounds.centre());
        let solved = &partition.solved;
        let patch = Patch::of(problem, solved, |vertex| faired.points[vertex]);
        let surface = &problem.surface.positions;
        let offset = |&vertex: &u32| surface[vertex as usize] - centre - faired.points[vertex as usize];
        Self {
            offsets: solved.iter().map(offset).collect(),
            is_faired: solved
                .iter()
                .map(|vertex| faired.vertices.binary_search(vertex).is_ok())
                .collect(),
            carried: Carried::of(&patch, centre, solver, input),
            centre,
            patch,
        }
    }

    /// The turns R − I of the components in which nothing is fixed.
    pub fn turns(&self, motions: &[Motion]) -> Vec<DMat3> {
        self.carried.turns(motions)
    }

    /// The turn R − I of a row whose component has nothing fixed; zero elsewhere.
    #[inline]
    pub fn turn(&self, row: usize, turns: &[DMat3]) -> DMat3 {
        self.carried.turn(row, turns)
    }

    /// Fills `posed` with the bent base's points: one for each local vertex, displaced by the surface's
    /// `displacements`.
    pub fn pose(&self, displacements: &[DVec3], turns: &[DMat3], posed: &mut Vec<DVec3>) {
        self.patch.pose(displacements, posed);
        self.carried.correct(&self.patch.rows, turns, posed);
    }

    /// Replaces the solved vertices' displacements by those that take the surface to the `posed` base.
    pub fn show(&self, posed: &[DVec3], displacements: &mut [DVec3]) {
        self.patch.write(displacements, |row, local| {
            (posed[local] - self.patch.rest[local]) - self.offsets[row]
        });
    }
}
