//! Multiresolution bending [BS08, section 2.4]: the surface is a smooth base and details on it, the bi-Laplacian bends
//! the base, and the details are put back on the bent base.
//!
//! Parts: `base` fairs and poses the base, `carry` keeps rigid motions rigid, `frames` turns displacements, `volumes`
//! corrects their heights, `transfer` transfers gradients, `sheets` keeps the sides of thin sheets apart.
//!
//! The base is a mesh of the surface's connectivity. A region that is long or has protrusions makes parts of it shrink
//! exponentially, so its bases are kept in f64, and if too little is left for a direction the nearest sound place lends
//! its own (`donors`).

mod base;
mod carry;
mod donors;
pub(crate) mod frames;
mod sheets;
mod transfer;
mod volumes;

use std::sync::Arc;

use glam::DVec3;

use self::base::{Base, Faired};
use self::frames::Frames;
use self::sheets::Sheets;
use self::transfer::{Transfer, left_by};
use self::volumes::Volumes;
use crate::bilaplacian::solver::BilaplacianSolver;
use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::method::{BindInput, BoundMethod, Stepped};
use crate::{Bilaplacian, BindError, Detail, ReusableFactor, SolveError};

/// The bound bi-Laplacian with details.
#[derive(Debug)]
pub(crate) struct Multiresolution {
    bending: BilaplacianSolver<f64>,
    base: Base,
    reconstruction: Reconstruction,
    sheets: Option<Sheets>,
    /// The base's points after the last step, one for each local vertex.
    posed: Vec<DVec3>,
}

/// The way of putting details back.
#[derive(Debug)]
enum Reconstruction {
    /// No details: there are no vertices with details.
    Plain,
    Normals(Frames),
    Volumes(Box<Volumes>),
    Gradients(Box<Transfer>),
}

impl Multiresolution {
    /// Fairs the base, then binds its bending.
    ///
    /// # Errors
    /// The bi-Laplacian's errors.
    pub fn bind(options: &Bilaplacian, input: &BindInput<'_>) -> Result<Self, BindError> {
        let &BindInput { problem, progress, .. } = input;
        let faired = Faired::of(options, input)?;
        progress.set(0.4);
        let (sheets, bending) = rayon::join(|| Sheets::of(input), || BilaplacianSolver::bind(options, input));
        let bending = bending?;
        let base = Base::of(&faired, &bending, input);
        input.cancel.check()?;
        let reconstruction = match options.detail {
            Detail::DeformationTransfer => {
                let budget = left_by(bending.factor_len(), input)?;
                let transfer = Transfer::bind(&base, budget, input)?;
                transfer.map_or(Reconstruction::Plain, |transfer| {
                    Reconstruction::Gradients(Box::new(transfer))
                })
            }
            Detail::DisplacementVolumes => {
                let volumes = Volumes::of(&base, sheets.as_ref(), options.volume_iterations, problem);
                Reconstruction::Volumes(Box::new(volumes))
            }
            Detail::None | Detail::NormalDisplacements => {
                Reconstruction::Normals(Frames::of(&base, &problem.surface.triangles, problem.topology))
            }
        };
        input.cancel.check()?;
        progress.set(1.0);
        Ok(Self {
            bending,
            posed: base.patch.rest.clone(),
            sheets,
            base,
            reconstruction,
        })
    }

    /// Puts the details on the base that `displacements` bend, and replaces these by the surface's.
    fn reconstruct(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<(), SolveError> {
        let turns = self.base.turns(motions);
        let mut posed = std::mem::take(&mut self.posed);
        self.base.pose(displacements, &turns, &mut posed);
        let base = &self.base;
        let mut reconstructed = Ok(());
        match &mut self.reconstruction {
            Reconstruction::Plain => write(base, &posed, displacements, |_| DVec3::ZERO),
            Reconstruction::Normals(frames) => write(base, &posed, displacements, |row| {
                frames.turned(base, row, &posed, &turns) - frames.at_rest()[row]
            }),
            Reconstruction::Volumes(volumes) => {
                volumes.frame(base, &posed, &turns);
                write(base, &posed, displacements, |row| volumes.change(row));
            }
            Reconstruction::Gradients(transfer) => {
                write(base, &posed, displacements, |_| DVec3::ZERO);
                reconstructed = transfer.frame(base, &posed, &turns, displacements);
            }
        }
        self.posed = posed;
        reconstructed?;
        if let Some(sheets) = &mut self.sheets {
            sheets.restore(displacements);
        }
        Ok(())
    }
}

/// Replaces the solved vertices' displacements by those of the bent base and the `change` of a row's detail.
fn write(base: &Base, posed: &[DVec3], displacements: &mut [DVec3], change: impl Fn(usize) -> DVec3 + Sync) {
    let patch = &base.patch;
    patch.write(displacements, |row, local| {
        (posed[local] - patch.rest[local]) + change(row)
    });
}

impl BoundMethod for Multiresolution {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        if !self.bending.is_affine() {
            return self.step_by_back_substitution(motions, displacements);
        }
        self.bending.frame(motions, displacements);
        self.reconstruct(motions, displacements)?;
        Ok(Stepped::at_once(self.bending.energy(motions), Finite::Unknown))
    }

    fn step_by_back_substitution(
        &mut self,
        motions: &[Motion],
        displacements: &mut [DVec3],
    ) -> Result<Stepped, SolveError> {
        self.bending.frame_by_back_substitution(motions, displacements)?;
        let energy = self.bending.energy_of(motions, displacements);
        self.reconstruct(motions, displacements)?;
        Ok(Stepped::at_once(energy, Finite::Unknown))
    }

    fn set_offsets(&mut self, offsets: &Arc<Offsets>) {
        self.bending.set_offsets(offsets);
    }

    fn rest(&mut self) {
        self.posed.clone_from(&self.base.patch.rest);
    }

    fn base(&self, displacements: &mut [DVec3]) -> bool {
        self.base.show(&self.posed, displacements);
        true
    }

    fn reusable_factor(&self) -> Option<ReusableFactor> {
        Some(ReusableFactor(Arc::clone(self.bending.factored())))
    }

    fn solved_count(&self) -> usize {
        self.base.patch.rows.len()
    }

    fn factor_len(&self) -> usize {
        let transfer = match &self.reconstruction {
            Reconstruction::Gradients(transfer) => transfer.factor_len(),
            Reconstruction::Plain | Reconstruction::Normals(_) | Reconstruction::Volumes(_) => 0,
        };
        self.bending.factor_len() + transfer
    }

    fn step_cost(&self) -> usize {
        4 * self.solved_count()
    }

    fn warnings(&self) -> Vec<String> {
        self.bending.warnings()
    }
}
