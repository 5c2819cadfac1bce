//! Deformation transfer: each triangle of the surface takes on the deformation gradient of its triangle of the base,
//! and a Poisson system joins the triangles [BSPG06; SP04, equation 4].
//!
//! With M = (e₁ e₂ n) of a triangle of the base, two edges and the unit normal, the gradient is F = M' M⁻¹: it
//! stretches as the base does within the triangle and keeps lengths along the normal. A rest edge e of the surface's
//! triangle becomes F e, so with q = M⁻¹ e its change is (M' − M) q, zero to the last bit if the base rests.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::base::Base;
use super::donors::{NONE, nearest};
use super::frames::{NARROWEST, SLIMMEST};
use super::triangle_frame::triangle_frame;
use crate::budget::{Budget, bytes_of};
use crate::method::BindInput;
use crate::numerical::rows::CHUNK;
use crate::operators::gradients::{EdgeChanges, Face, Gradients};
use crate::operators::triangulation::Triangulation;
use crate::sparse::ordering::hubs::hub_degree;
use crate::sparse::refactorisation::Refactorisation;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::poisson_system::{refused, settled, write_field};
use crate::systems::setup::bent_rows;
use crate::{BindError, Discretisation, Laplacian, SolveError};

/// The Poisson system of the surface, and each triangle in terms of the base's.
#[derive(Debug)]
pub(crate) struct Transfer {
    system: BilaplacianSystem,
    gradients: Gradients,
    triangles: Vec<Triangle>,
    scratch: Scratch,
}

/// The change of a triangle's edges.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    /// The corners of the base's triangle as local vertices of the base. A degenerate triangle is replaced by the
    /// nearest sound one; the same vertex three times if there is none.
    corners: [u32; 3],
    /// The row of a corner that only this triangle has.
    row: u32,
    /// The base's unit normal at rest.
    normal: DVec3,
    /// q of the surface's two edges.
    coordinates: [DVec3; 2],
}

/// Buffers kept from frame to frame, so that no frame allocates them.
#[derive(Clone, Debug, Default)]
struct Scratch {
    changes: Vec<EdgeChanges>,
    load: Vec<[f64; 3]>,
    field: Vec<[f64; 3]>,
}

impl Transfer {
    /// Factors the surface's Laplacian at the base's rows, without soft handles, which move with the base.
    ///
    /// # Errors
    /// The errors of the bi-Laplacian of order 1.
    pub fn bind(base: &Base, budget: Budget, input: &BindInput<'_>) -> Result<Option<Self>, BindError> {
        let &BindInput {
            problem,
            partition,
            cancel,
            ..
        } = input;
        let soft: Vec<u32> = soft_vertices(input);
        let solved: Vec<u32> = partition
            .solved
            .iter()
            .copied()
            .filter(|vertex| soft.binary_search(vertex).is_err())
            .collect();
        if solved.is_empty() {
            return Ok(None);
        }
        let triangulation = Triangulation::of_surface(problem.surface, problem.topology);
        let rows = bent_rows(&triangulation, &solved, &[]);
        let metric = Discretisation::CotangentArea;
        // A soft part's triangles keep to their base like all others: with less weight they would compensate everything
        // that the stiff ones' gradients lack, and swell.
        let firmness: Vec<f64> = problem.stiffness.iter().map(|stiffness| stiffness.max(1.0)).collect();
        let laplacian = Laplacian::on(&triangulation, &firmness, &rows, metric, &|_, _| 1.0);
        let size = problem.size();
        let mut operator = BilaplacianOperator::new(laplacian, PlateEnergy::of_power(1), size);
        operator.hub_degree = hub_degree(problem.surface.positions.len());
        let elimination = input.ordering()?.elimination(&solved);
        let refuse = |error| refused(error, input);
        let mut system =
            BilaplacianSystem::new(operator, elimination, Refactorisation::Never, budget, cancel).map_err(refuse)?;
        let mut constant = vec![[1.0]; system.operator.field_len()];
        system.check(&mut constant, cancel).map_err(refuse)?;
        let gradients = Gradients::of(
            problem.surface,
            problem.topology,
            &firmness,
            &system.operator.laplacian,
            system.columns(),
        );
        cancel.check()?;
        Ok(Some(Self {
            triangles: triangles(base, &system, &gradients),
            system,
            gradients,
            scratch: Scratch::default(),
        }))
    }

    /// Replaces the displacements of vertices with details, given those of all others, by displacements that follow the
    /// bent base.
    ///
    /// # Errors
    /// If the solution stays too inaccurate.
    pub fn frame(
        &mut self,
        base: &Base,
        posed: &[DVec3],
        turns: &[DMat3],
        displacements: &mut [DVec3],
    ) -> Result<(), SolveError> {
        let Scratch { changes, load, field } = &mut self.scratch;
        changes.resize(self.triangles.len(), EdgeChanges::default());
        changes
            .par_chunks_mut(CHUNK)
            .zip(
                self.triangles
                    .par_chunks(CHUNK)
                    .zip(self.gradients.faces().par_chunks(CHUNK)),
            )
            .for_each(|(changes, (triangles, faces))| {
                for ((changes, triangle), face) in changes.iter_mut().zip(triangles).zip(faces) {
                    *changes = triangle.changes(face, base, posed, turns);
                }
            });
        let operator = &self.system.operator;
        self.gradients
            .divergence(changes, operator.stretching + operator.bending, load);
        let vertices = operator.laplacian.vertices();
        vertices
            .par_iter()
            .with_min_len(CHUNK)
            .map(|&vertex| displacements[vertex as usize].to_array())
            .collect_into_vec(field);
        let solved = settled(self.system.solve_frame(load, field));
        write_field(field, vertices, displacements);
        solved
    }

    /// The number of entries that the factor stores.
    pub fn factor_len(&self) -> usize {
        self.system.factor_len()
    }
}

/// The part of the budget that bending leaves.
///
/// # Errors
/// [`BindError::Budget`] if nothing is left.
pub(crate) fn left_by(factor_len: usize, input: &BindInput<'_>) -> Result<Budget, BindError> {
    let budget = input.partition.budget.without(bytes_of(factor_len, size_of::<f64>()));
    budget.map_err(|limit| BindError::budget(input.partition.solved.len(), limit))
}

/// The vertices of soft handles, ascending.
fn soft_vertices(input: &BindInput<'_>) -> Vec<u32> {
    let handles = input.partition.handles.iter().zip(&input.partition.soft);
    let mut vertices: Vec<u32> = handles
        .filter(|(_, weight)| weight.is_some())
        .flat_map(|(vertices, _)| vertices.iter().copied())
        .collect();
    vertices.sort_unstable();
    vertices
}

/// The triangles of the gradients' faces.
fn triangles(base: &Base, system: &BilaplacianSystem, gradients: &Gradients) -> Vec<Triangle> {
    let vertices = system.operator.laplacian.vertices();
    // Every vertex of a face around a solved one is local to the base.
    let local = |of_laplacian: u32| {
        base.patch
            .vertices
            .partition_point(|&v| v < vertices[of_laplacian as usize]) as u32
    };
    let mut row_of = vec![NONE; base.patch.vertices.len()];
    for (row, &local) in base.patch.rows.iter().enumerate() {
        row_of[local as usize] = row as u32;
    }
    let corners: Vec<[u32; 3]> = gradients.faces().iter().map(|face| face.locals.map(local)).collect();
    let is_sound: Vec<bool> = corners.iter().map(|corners| is_sound(base, *corners)).collect();
    let mut faces_of = vec![
        Vec::new();
        if is_sound.contains(&false) {
            base.patch.vertices.len()
        } else {
            0
        }
    ];
    if !faces_of.is_empty() {
        for (place, corners) in corners.iter().enumerate() {
            corners
                .iter()
                .for_each(|&corner| faces_of[corner as usize].push(place as u32));
        }
    }
    let sources = nearest(&is_sound, |place, visit| {
        for &corner in &corners[place] {
            faces_of[corner as usize].iter().for_each(|&next| visit(next));
        }
    });
    let triangle = |place: usize| {
        let own = corners[place];
        let row = own
            .iter()
            .map(|&corner| row_of[corner as usize])
            .find(|&row| row != NONE);
        let row = row.unwrap_or_default();
        let edges = gradients.faces()[place].edges;
        match corners.get(sources[place] as usize) {
            Some(&corners) => {
                let places = corners.map(|corner| base.patch.rest[corner as usize]);
                let frame = triangle_frame(places).unwrap_or(DMat3::IDENTITY);
                let inverse = frame.inverse();
                Triangle {
                    corners,
                    row,
                    normal: frame.z_axis,
                    coordinates: edges.map(|edge| inverse * edge),
                }
            }
            None => Triangle {
                corners: [own[0]; 3],
                row,
                normal: DVec3::Z,
                coordinates: edges,
            },
        }
    };
    (0..corners.len())
        .into_par_iter()
        .with_min_len(CHUNK)
        .map(triangle)
        .collect()
}

/// Returns true if a triangle of the base has a gradient.
fn is_sound(base: &Base, corners: [u32; 3]) -> bool {
    let [a, b, c] = corners.map(|corner| base.patch.rest[corner as usize]);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let height = (b - a).cross(c - a).length() / longest;
    height > (NARROWEST * base.patch.size).max(SLIMMEST * longest)
}

impl Triangle {
    /// (F − I) e of the surface's two edges.
    #[inline]
    fn changes(&self, face: &Face, base: &Base, posed: &[DVec3], turns: &[DMat3]) -> EdgeChanges {
        let [a, b, c] = self.corners.map(|corner| corner as usize);
        if a == b {
            let turn = base.turn(self.row as usize, turns);
            return face.edges.map(|edge| turn * edge);
        }
        let (first, second) = (posed[b] - posed[a], posed[c] - posed[a]);
        // A triangle that is bent to a line keeps its normal.
        let normal = first.cross(second).try_normalize().unwrap_or(self.normal);
        let (rest_first, rest_second) = (
            base.patch.rest[b] - base.patch.rest[a],
            base.patch.rest[c] - base.patch.rest[a],
        );
        let change = DMat3::from_cols(first - rest_first, second - rest_second, normal - self.normal);
        self.coordinates.map(|q| change * q)
    }
}
