//! The smooth base: L^k x = 0 on the bending part, the surface itself elsewhere [BS08, section 2.4].
//!
//! Or the surface after a finite time of fairing, by one implicit step [DMSB99]: with a length ℓ and rest positions p,
//! (M ℓ⁻²ᵏ + (−L)(−M⁻¹ L)ᵏ⁻¹) x = M ℓ⁻²ᵏ p. A wave of the surface with wave number q keeps the share 1 / (1 + (ℓ q)²ᵏ),
//! so details shorter than about 2π ℓ vanish and a limb of radius r keeps r / (1 + (ℓ / r)²ᵏ). Without end, every limb
//! shrinks to a line.
//!
//! L is measured on the surface, as for bending. Handles, fixed vertices and borders keep their positions. At a border
//! L x is the flux across it, which does not vanish on a plane, so the border's cells are left out of the energy: a
//! flat sheet is then its own base, with free borders or without.

use glam::{DMat3, DVec3};
use pliant_mesh::SurfaceVertex;

use super::carry::Carried;
use crate::bilaplacian::factored::BilaplacianSystem;
use crate::bilaplacian::loaded::refused;
use crate::bilaplacian::operator::BilaplacianOperator;
use crate::bilaplacian::refine::TOLERANCE;
use crate::bilaplacian::setup::bent_rows;
use crate::bilaplacian::solver::BilaplacianSolver;
use crate::handles::Motion;
use crate::method::BindInput;
use crate::region::patch::Patch;
use crate::region::slender;
use crate::sparse::ordering::hubs::hub_degree;
use crate::sparse::refactorisation::Refactorisation;
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
        let fairing = Bilaplacian {
            order: options.base_order,
            bending: 1.0,
            stretching: 0.0,
            ..options.clone()
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
        let mut operator = BilaplacianOperator::new(laplacian, &fairing, diagonal);
        operator.hub_degree = hub_degree(triangulation.vertex_count());
        let tied = length.map(|length| tie(&mut operator, &faired, length));
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
        field.extend(tied.into_iter().flatten().map(|vertex| row(&vertex)));
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

/// Ties the faired vertices to their rest positions by springs of M ℓ⁻²ᵏ; returns the vertices, in the order of the
/// springs.
fn tie<'a>(operator: &mut BilaplacianOperator, faired: &'a [u32], length: f64) -> impl Iterator<Item = u32> + use<'a> {
    let laplacian = &operator.laplacian;
    let locals = laplacian.locals(faired);
    let firmness = operator.bending / length.powi(2 * operator.power as i32);
    let strength = |&local: &u32| firmness / laplacian.inverse_areas()[local as usize];
    let strengths: Vec<f64> = locals.iter().map(strength).collect();
    operator.hang(&locals, &strengths);
    faired.iter().copied()
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
