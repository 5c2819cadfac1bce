//! Laplacian editing [SCL+04, LSC+04; BS08, sections 3.1.2, 3.2.5 and 3.2.6]: each vertex' differential coordinate L p
//! is transformed, and the bi-Laplacian system L M⁻¹ L d = L M⁻¹ (T − I) L p reassembles the surface.
//!
//! Painted stiffness s scales the density of the energy ½ ∫ s |Δp' − T Δp|², as for a thin plate, and each stiff part
//! turns as a whole (`parts`).
//!
//! Parts: `similarity`, `rings` and `estimate` give the transformations, `coupled`, `implicit` and `bases` the first
//! shape of implicit ones, `shape` computes a frame, and `systems::poisson_system` solves.

mod bases;
mod coupled;
mod declaration;
mod estimate;
mod implicit;
mod moments;
mod options;
mod parts;
mod rings;
mod shape;
mod similarity;

use glam::DVec3;
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::{LaplacianEditing, LocalScale, Transforms};

use self::bases::ImplicitBases;
use self::coupled::CoupledEnergy;
use self::parts::TurningParts;
use self::rings::Rings;
use self::similarity::Similarity;
use crate::handles::polar::{Polar, polars_of};
use crate::handles::{Handle, Motion};
use crate::method::BindInput;
use crate::numerical::rows::CHUNK;
use crate::systems::plate_energy::PlateEnergy;
use crate::systems::poisson_system::PoissonSystem;
use crate::{BindError, Laplacian, SolveError};

/// The bound method.
#[derive(Debug)]
pub(crate) struct LaplacianSolver {
    options: LaplacianEditing,
    system: PoissonSystem,
    /// Rest positions of the local vertices, relative to the first one.
    rest: Vec<DVec3>,
    /// (L p)_i of the local vertices, 0 if the row is not full.
    curvature: Vec<DVec3>,
    rings: Option<Rings>,
    implicit: Option<Implicit>,
    parts: TurningParts,
    handles: Vec<Handle>,
    /// The handles' maps at the last frame, from which turns continue.
    polars: Vec<Polar>,
    scratch: Scratch,
}

/// The data for implicit transformations.
#[derive(Debug)]
struct Implicit {
    similarities: Vec<Similarity>,
    bases: ImplicitBases,
}

/// Buffers kept from frame to frame, so that no frame allocates them.
#[derive(Clone, Debug, Default)]
struct Scratch {
    field: Vec<[f64; 3]>,
    /// (T_i − I)(L p)_i of the local vertices.
    changes: Vec<DVec3>,
    stress: Vec<[f64; 3]>,
    load: Vec<[f64; 3]>,
}

impl LaplacianSolver {
    /// Factors the bi-Laplacian and, for implicit transformations, the coupled system, and solves for its bases.
    pub fn bind(options: &LaplacianEditing, input: &BindInput<'_>) -> Result<Self, BindError> {
        let (problem, progress, cancel) = (input.problem, input.progress, input.cancel);
        let (mut parts, mut spring_count) = (TurningParts::default(), 0);
        let energy = PlateEnergy::of_power(2);
        let system = PoissonSystem::bind_tied(energy, problem.stiffness, input.refactorisation, input, |operator| {
            spring_count = operator.springs.len();
            if options.transforms == Transforms::Implicit && options.steps == 1 {
                parts = TurningParts::attach(operator, input);
            }
        })?;
        progress.set(0.3);
        let positions = &problem.surface.positions;
        let laplacian = &system.operator().laplacian;
        let origin = system
            .vertices()
            .first()
            .map_or(DVec3::ZERO, |&vertex| positions[vertex as usize]);
        let rest: Vec<DVec3> = system
            .vertices()
            .iter()
            .map(|&v| positions[v as usize] - origin)
            .collect();
        let coordinates: Vec<[f64; 3]> = rest.iter().map(|p| p.to_array()).collect();
        let curvature: Vec<DVec3> = (0..rest.len())
            .map(|local| DVec3::from_array(laplacian.row(local, &coordinates)))
            .collect();
        let estimates = match options.transforms {
            Transforms::Implicit => options.steps > 1,
            Transforms::InitialGuess => true,
            Transforms::None => false,
        };
        let rings = estimates.then(|| Rings::of(laplacian, options.ring));
        cancel.check()?;
        let implicit = if options.transforms == Transforms::Implicit {
            let edges = |local: usize| {
                let (rest, own) = (&rest, rest[local]);
                laplacian
                    .neighbours(local)
                    .iter()
                    .map(move |&other| rest[other as usize] - own)
            };
            let similarity = |(local, &vertex): (usize, &u32)| {
                let similarity = Similarity::of(edges(local));
                if problem.topology.is_boundary_vertex(SurfaceVertex(vertex)) {
                    similarity.without_scale()
                } else {
                    similarity
                }
            };
            let similarities: Vec<Similarity> = system.vertices().iter().enumerate().map(similarity).collect();
            let energy = CoupledEnergy::of(system.operator(), spring_count, &similarities, &rest, &curvature);
            let energy = energy.map_err(|_| BindError::OutOfMemory {
                free_count: system.columns().len(),
            })?;
            let bases = ImplicitBases::of(&system, energy, input)?;
            Some(Implicit { similarities, bases })
        } else {
            None
        };
        progress.set(1.0);
        let mut solver = Self {
            options: options.clone(),
            rest,
            curvature,
            rings,
            implicit,
            parts,
            handles: input.handles.to_vec(),
            polars: vec![Polar::default(); input.handles.len()],
            scratch: Scratch::default(),
            system,
        };
        solver.scratch = solver.new_scratch();
        Ok(solver)
    }

    fn new_scratch(&self) -> Scratch {
        Scratch {
            field: self.system.field(),
            changes: vec![DVec3::ZERO; self.rest.len()],
            stress: vec![[0.0; 3]; self.rest.len()],
            load: vec![[0.0; 3]; self.system.columns().len()],
        }
    }

    /// Solves for the motions; returns the energy.
    fn frame(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<f64, SolveError> {
        self.polars = polars_of(&self.polars, &self.handles, motions);
        let mut scratch = std::mem::take(&mut self.scratch);
        let solved = self.shape(motions, &mut scratch);
        self.system.write(&scratch.field, displacements);
        let energy = self.energy(&scratch.changes, &scratch.field);
        self.scratch = scratch;
        solved.map(|()| energy)
    }

    fn laplacian(&self) -> &Laplacian {
        &self.system.operator().laplacian
    }

    /// s_i / M_ii.
    fn density(&self, local: usize) -> f64 {
        self.system.operator().cell_stiffness(local) * self.laplacian().inverse_areas()[local]
    }

    /// ½ Σ s_i / M_ii |(L d)_i − (T_i − I)(L p)_i|², and the springs'.
    fn energy(&self, changes: &[DVec3], field: &[[f64; 3]]) -> f64 {
        let laplacian = self.laplacian();
        let of = |local: usize| {
            let bend = DVec3::from_array(laplacian.row(local, field)) - changes[local];
            0.5 * self.density(local) * bend.length_squared()
        };
        let count = self.rest.len();
        let partial: Vec<f64> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| (chunk * CHUNK..((chunk + 1) * CHUNK).min(count)).map(of).sum())
            .collect();
        partial.iter().sum::<f64>() + self.system.spring_energy(field)
    }

    /// Like [`LaplacianSolver::energy`], for any displacements and these motions; `None` if they can't be solved.
    fn energy_of(&self, motions: &[Motion], displacements: &[DVec3]) -> Option<f64> {
        let mut field = self.system.read(motions, displacements);
        let mut scratch = self.new_scratch();
        match &self.implicit {
            // The transformations are the shape's own.
            Some(implicit) if self.is_settled_by_bases() => {
                self.change_by(&mut scratch.changes, |local| {
                    self.fitted(implicit, local, &field).change()
                });
            }
            _ => {
                self.shape(motions, &mut scratch).ok()?;
                self.parts.copy_anchors(&scratch.field, &mut field);
            }
        }
        Some(self.energy(&scratch.changes, &field))
    }
}
