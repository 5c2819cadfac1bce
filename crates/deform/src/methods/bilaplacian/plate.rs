//! The thin plate's system with all effects of paint and free borders, or the plain one if that does not fit.

use crate::method::BindInput;
use crate::methods::bilaplacian::parts::StiffParts;
use crate::sparse::system_error::SystemError;
use crate::systems::elimination_plan::EliminationPlan;
use crate::systems::factored::BilaplacianSystem;
use crate::systems::setup::{Boundaries, Prescribed, operator};
use crate::systems::stiff_parts::Level;
use crate::{Bilaplacian, Detail};

/// The factored system, the values that its handles and stiff parts prescribe, and the parts.
pub(crate) struct Plate {
    pub system: BilaplacianSystem,
    /// The handles' places, then the parts'.
    pub prescribed: Vec<Prescribed>,
    pub parts: StiffParts,
    /// True if natural boundaries were left out, because their factor does not fit.
    pub is_plain: bool,
}

impl Plate {
    /// Assembles and factors it.
    ///
    /// # Errors
    /// The bi-Laplacian's errors.
    pub fn of(options: &Bilaplacian, plan: &EliminationPlan, input: &BindInput<'_>) -> Result<Self, SystemError> {
        let &BindInput {
            problem,
            partition,
            handles,
            refactorisation,
            cancel,
            ..
        } = input;
        let budget = partition.budget;
        let with = |boundaries| operator(problem, options.energy(), partition, handles, boundaries);
        let (mut natural, mut prescribed) = with(Boundaries::Natural);
        let is_natural = natural.natural.is_some();
        cancel.check().map_err(|_| SystemError::Cancelled)?;
        if !is_natural {
            let system = BilaplacianSystem::planned(natural, plan, refactorisation, budget, cancel)?;
            return Ok(Self::plain(system, prescribed, false));
        }
        if let Some(elimination) = plan.direct(natural.power, budget) {
            // Details restore a rigid motion of everything by the handles' bases alone.
            let may_turn = |component: u32| options.detail == Detail::None || partition.held[component as usize];
            // With details a part of ordinary stiffness has a base that is smaller than it is, and which the motion of a
            // body would make swell.
            let levels = match options.detail {
                Detail::None => Level::all(&natural, problem),
                _ => vec![Level::stiff(&natural, problem)],
            };
            let (parts, of_parts) = StiffParts::attach(
                &mut natural,
                &partition.triangulation,
                problem,
                handles,
                &levels,
                may_turn,
            );
            prescribed.extend(of_parts);
            match BilaplacianSystem::new(natural, elimination, refactorisation, budget, cancel) {
                Ok(system) => {
                    return Ok(Self {
                        system,
                        prescribed,
                        parts,
                        is_plain: false,
                    });
                }
                Err(refused) if !refused.is_for_memory() => return Err(refused),
                Err(_) => {}
            }
        }
        let (operator, prescribed) = with(Boundaries::OfLaplacian);
        let system = BilaplacianSystem::planned(operator, plan, refactorisation, budget, cancel)?;
        Ok(Self::plain(system, prescribed, true))
    }

    fn plain(system: BilaplacianSystem, prescribed: Vec<Prescribed>, is_plain: bool) -> Self {
        Self {
            system,
            prescribed,
            parts: StiffParts::default(),
            is_plain,
        }
    }
}

/// The sentence about natural boundaries that were left out.
pub(crate) const PLAIN: &str = "the plate's own factor does not fit the free memory, so stiff parts may shear, soft \
                                ones swell, and free borders curl: raise the memory limit";
