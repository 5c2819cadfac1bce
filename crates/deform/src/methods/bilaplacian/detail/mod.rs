//! Multiresolution bending [BS08, section 2.4]: the surface is a smooth base and details on it, the bi-Laplacian bends
//! the base, and the details are put back on the bent base.
//!
//! Parts: `base` fairs and poses the base, `carry` keeps rigid motions rigid, `normals` displaces along the base's
//! normals from the points that `foot` finds, `volumes` keeps the volumes of the prisms (`prism`) over it, `transfer`
//! transfers gradients, `sheets` keeps the sides of thin sheets apart (`opposing` excludes most vertices), and `folds` finds what came out badly.
//!
//! The base is a mesh of the surface's connectivity. For deformation transfer it is faired without end. A region that is
//! long or has protrusions makes parts of it shrink exponentially then, so its bases are kept in f64, and if too little
//! is left for a direction the nearest sound place lends its own (`donors`). Normals of a base that shrinks to a line
//! have no meaning, so for the other two it is faired for a time.

mod base;
mod carry;
mod donors;
mod faces;
mod folds;
mod foot;
pub(crate) mod frames;
mod normals;
mod opposing;
mod prism;
mod sheets;
mod transfer;
mod triangle_frame;
mod volumes;

use std::sync::Arc;

use glam::DVec3;

use self::base::{Base, Faired};
use self::folds::Folds;
use self::normals::NormalDisplacements;
use self::sheets::Sheets;
use self::transfer::{Transfer, left_by};
use self::volumes::Volumes;
use crate::handles::Motion;
use crate::handles::finite::Finite;
use crate::handles::offsets::Offsets;
use crate::method::{BindInput, BoundMethod, Stepped};
use crate::methods::bilaplacian::solver::BilaplacianSolver;
use crate::{Bilaplacian, BindError, Detail, ReusableFactor, SolveError};

/// The bound bi-Laplacian with details.
#[derive(Debug)]
pub(crate) struct Multiresolution {
    bending: BilaplacianSolver<f64>,
    base: Base,
    reconstruction: Reconstruction,
    sheets: Option<Sheets>,
    /// The search for folded details; the kinds that displace have one.
    folds: Option<Folds>,
    /// The sentence on the details that the last step folded.
    folded: Option<String>,
    /// The base's points after the last step, one for each local vertex.
    posed: Vec<DVec3>,
}

/// The way of putting details back.
#[derive(Debug)]
enum Reconstruction {
    /// No details: there are no vertices with details.
    Plain,
    Normals(Box<NormalDisplacements>),
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
        let length = match options.detail {
            Detail::NormalDisplacements | Detail::DisplacementVolumes => Some(options.base_length * problem.size()),
            Detail::None | Detail::DeformationTransfer => None,
        };
        let faired = Faired::of(options, length.filter(|length| *length > 0.0), input)?;
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
                let volumes = Volumes::of(&base, options.volume_iterations, problem);
                Reconstruction::Volumes(Box::new(volumes))
            }
            Detail::None | Detail::NormalDisplacements => {
                Reconstruction::Normals(Box::new(NormalDisplacements::of(&base, problem)))
            }
        };
        input.cancel.check()?;
        let folds = match &reconstruction {
            Reconstruction::Normals(normals) => Some(Folds::of(&base, &normals.faces)),
            Reconstruction::Volumes(volumes) => Some(Folds::of(&base, volumes.faces())),
            Reconstruction::Plain | Reconstruction::Gradients(_) => None,
        };
        progress.set(1.0);
        Ok(Self {
            bending,
            folds,
            folded: None,
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
            Reconstruction::Plain => bend(base, &posed, displacements),
            Reconstruction::Normals(normals) => {
                normals.bend(&posed);
                base.patch.write(displacements, |row, _| {
                    normals.point(base, row, &posed, &turns) - normals.at_rest[row]
                });
            }
            Reconstruction::Volumes(volumes) => {
                volumes.frame(base, &posed, &turns);
                base.patch.write(displacements, |row, _| volumes.change(base, row));
            }
            Reconstruction::Gradients(transfer) => {
                bend(base, &posed, displacements);
                reconstructed = transfer.frame(base, &posed, &turns, displacements);
            }
        }
        if reconstructed.is_ok()
            && let Some(sheets) = &mut self.sheets
        {
            sheets.restore(displacements);
        }
        let folds = self.folds.as_ref();
        self.folded = folds.and_then(|folds| folds.on_the_surface(base, &posed, displacements));
        self.posed = posed;
        reconstructed
    }
}

/// Replaces the solved vertices' displacements by those of the bent base.
fn bend(base: &Base, posed: &[DVec3], displacements: &mut [DVec3]) {
    let patch = &base.patch;
    patch.write(displacements, |_, local| posed[local] - patch.rest[local]);
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
        let each = match &self.reconstruction {
            Reconstruction::Plain | Reconstruction::Gradients(_) => 4,
            Reconstruction::Normals(_) => 8,
            Reconstruction::Volumes(_) => 200,
        };
        each * self.solved_count()
    }

    fn warnings(&self) -> Vec<String> {
        let mut sentences = self.bending.warnings();
        sentences.extend(self.folds.as_ref().and_then(Folds::on_the_base));
        sentences
    }

    fn faults(&self) -> Vec<String> {
        self.folded.iter().cloned().collect()
    }
}
