//! Bending: steps towards the handles' targets, from what is shown or from what is carried along beside it.

use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, Bound, Solve, SolveError, Step};
use pliant_mesh::{Cancel, SurfaceVertex};

use super::carried::Carried;
use super::computed::Computed;
use super::job::{ControlPlaces, Descent, JobOutcome, Solved, Work};
use crate::document::{Document, HandleId, KeptShape, sum_of_shapes};
use crate::warning::HandleWarning;

/// A solve takes so many vertices' worth of steps before it shows its shape: about what a window's frame has time for.
/// There is no clock here.
const VERTEX_STEPS: usize = 100_000;

/// The most steps of one solve, however few its vertices are.
const MOST_STEPS: usize = 16;

/// So many times the steps of one solve are taken for the solution at a kept shape: close enough to where the descent
/// ends that what is left of it hides in the drag.
const MOST_FIRST_ROUNDS: usize = 8;

/// Takes steps towards the handles' targets; `None` while nothing is bound.
pub(super) fn solve_work(computed: &Computed, document: &Document) -> Option<Work> {
    let (bound, model) = (computed.bound.clone()?, computed.model.clone()?);
    let handles = &computed.region.handles;
    let wanted = Wanted::of(document, handles, &document.from_rest, computed.carried.as_ref())?;
    Some(Box::new(move |_, cancel| {
        if cancel.is_cancelled() {
            return JobOutcome::Cancelled;
        }
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        let is_from_file = wanted.rest.is_none();
        match wanted.solve(&mut bound, cancel) {
            Err(error) => JobOutcome::Failed(
                error
                    .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                    .to_string(),
            ),
            Ok(mut solved) => {
                if is_from_file && solved.carried.is_none() {
                    solved.jacobians = bound.jacobians();
                }
                JobOutcome::Solved(solved)
            }
        }
    }))
}

/// Asks where the control points are with the document's targets, whose shape is known; `None` while nothing is bound.
pub(super) fn controls_work(computed: &Computed, document: &Document) -> Option<Work> {
    let bound = computed.bound.clone()?;
    let handles = targets(document, &computed.region.handles)?;
    let attachments = Arc::clone(&document.attachments);
    Some(Box::new(move |_, cancel| {
        if cancel.is_cancelled() {
            return JobOutcome::Cancelled;
        }
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        let own = bound.attachment().and_then(|(name, _)| attachments.get(name));
        let targets = Targets {
            handles: &handles,
            controls: own.and_then(Attachment::moved),
            weights: &[],
        };
        match targets.set(&mut bound) {
            Err(error) => JobOutcome::Failed(error.to_string()),
            Ok(()) => ControlPlaces::of(&bound).map_or(JobOutcome::Cancelled, JobOutcome::Controls),
        }
    }))
}

/// What a solve is to find, and from where it goes on.
pub(super) struct Wanted {
    handles: Vec<HandleId>,
    targets: Vec<DAffine3>,
    beginning: Beginning,
    attachments: Arc<BTreeMap<&'static str, Attachment>>,
    /// Of the examples.
    weights: Vec<Option<f64>>,
    /// What is shown.
    from_rest: Arc<Vec<DVec3>>,
    /// The rest shape, where it is not the file's.
    rest: Option<Arc<Vec<DVec3>>>,
}

impl Wanted {
    /// The document's targets for `handles`, from what is shown and from the last solution, where that carries a kept
    /// shape along; `None` if a handle is gone.
    pub(super) fn of(
        document: &Document,
        handles: &[HandleId],
        from_rest: &Arc<Vec<DVec3>>,
        carried: Option<&Carried>,
    ) -> Option<Self> {
        Some(Self {
            handles: handles.to_vec(),
            targets: targets(document, handles)?,
            beginning: Beginning::of(document, handles, from_rest, carried)?,
            attachments: Arc::clone(&document.attachments),
            weights: document.example_weights().to_vec(),
            from_rest: Arc::clone(from_rest),
            rest: document.applied.then(|| Arc::clone(&document.rest)),
        })
    }

    /// Takes steps until the shape is worth showing.
    pub(super) fn solve(self, bound: &mut Bound, cancel: &Cancel) -> Result<Solved, SolveError> {
        let own = bound.attachment().and_then(|(name, _)| self.attachments.get(name));
        let targets = Targets {
            handles: &self.targets,
            controls: own.and_then(Attachment::moved),
            weights: &self.weights,
        };
        let bent = self.beginning.solve(bound, &targets, &self.from_rest, cancel)?;
        let step = bent.step;
        Ok(Solved {
            jacobians: None,
            controls: ControlPlaces::of(bound),
            from_file: sum_of_shapes(self.rest.as_ref(), &bent.shown),
            from_rest: bent.shown,
            carried: bent.carried,
            example_weights: bound.weights().to_vec(),
            blind_to: HandleWarning::list(bound.blind_to(), &self.handles),
            finished: step.finished,
            descent: (bound.solve() != Solve::Direct).then_some(Descent {
                energy: step.energy,
                converged: step.converged,
                finished: step.finished,
            }),
        })
    }
}

/// Where handles and control points are to go, and how much of each example is wanted.
struct Targets<'a> {
    handles: &'a [DAffine3],
    /// What was brought to the binding and moved by hand.
    controls: Option<&'a Arc<Vec<DVec3>>>,
    /// `None` where one is to be found.
    weights: &'a [Option<f64>],
}

impl Targets<'_> {
    fn set(&self, bound: &mut Bound) -> Result<(), SolveError> {
        bound.set_targets(self.handles)?;
        // Another method's binding has no examples.
        if bound.weights().len() == self.weights.len() {
            bound.set_weights(self.weights)?;
        }
        self.controls.map_or(Ok(()), |moved| bound.set_controls(moved))
    }
}

/// What a solve has brought.
struct Bent {
    /// What is shown, as displacements from the rest shape.
    shown: Arc<Vec<DVec3>>,
    /// What the next solve goes on from, where a shape was kept.
    carried: Option<Carried>,
    /// How the descent stands.
    step: Step,
}

/// From where a solve goes on.
enum Beginning {
    /// From what is shown.
    Shown,
    /// From a kept shape for the first time: the solution there is to be found, with the targets at which it was kept.
    Kept(Arc<KeptShape>, Vec<DAffine3>),
    /// From the last solution, with what is carried along beside it.
    Carried(Carried),
}

impl Beginning {
    fn of(
        document: &Document,
        handles: &[HandleId],
        from_rest: &Arc<Vec<DVec3>>,
        carried: Option<&Carried>,
    ) -> Option<Self> {
        let Some(kept) = &document.kept else {
            return Some(Self::Shown);
        };
        if let Some(carried) = carried.filter(|carried| Arc::ptr_eq(&carried.kept, kept)) {
            let mut carried = carried.clone();
            if !Arc::ptr_eq(&carried.shown, from_rest) {
                // Undo has brought another shape: the way to it is found again from where all began.
                carried.solution = Arc::clone(&carried.at_first);
            }
            return Some(Self::Carried(carried));
        }
        let handles = handles.iter();
        let first: Option<Vec<DAffine3>> = handles.map(|id| kept.targets.get(id).copied()).collect();
        first.map(|first| Self::Kept(Arc::clone(kept), first))
    }

    /// What is shown next, and what the solve after it goes on from.
    fn solve(
        self,
        bound: &mut Bound,
        targets: &Targets<'_>,
        from_rest: &Arc<Vec<DVec3>>,
        cancel: &Cancel,
    ) -> Result<Bent, SolveError> {
        let (kept, at_first, mut solution) = match self {
            Self::Shown => {
                let mut solution = from_rest.to_vec();
                let step = steps(bound, targets, &mut solution, cancel)?;
                return Ok(Bent {
                    shown: Arc::new(solution),
                    carried: None,
                    step,
                });
            }
            Self::Kept(kept, first) => {
                let mut at_first = kept.shape.to_vec();
                // Points of another attachment than the one in force say nothing of it.
                let is_same = |kept: &&Arc<Vec<DVec3>>| targets.controls.is_some_and(|own| own.len() == kept.len());
                let first_controls = kept.controls.as_ref().filter(is_same).or(targets.controls);
                let first = Targets {
                    handles: &first,
                    controls: first_controls,
                    weights: &kept.weights,
                };
                for _ in 0..MOST_FIRST_ROUNDS {
                    if steps(bound, &first, &mut at_first, cancel)?.finished || cancel.is_cancelled() {
                        break;
                    }
                }
                (kept, Arc::new(at_first.clone()), at_first)
            }
            Self::Carried(carried) => (carried.kept, carried.at_first, carried.solution.to_vec()),
        };
        let step = steps(bound, targets, &mut solution, cancel)?;
        let shown = Arc::new(kept.carried(&at_first, &solution));
        let carried = Carried {
            corrections: kept.corrections_left(&at_first, &solution),
            kept,
            at_first,
            solution: Arc::new(solution),
            shown: Arc::clone(&shown),
        };
        Ok(Bent {
            shown,
            carried: Some(carried),
            step,
        })
    }
}

/// Takes steps towards the targets until the shape is worth showing; it goes on from where the last solve ended.
fn steps(
    bound: &mut Bound,
    targets: &Targets<'_>,
    displacements: &mut [DVec3],
    cancel: &Cancel,
) -> Result<Step, SolveError> {
    targets.set(bound)?;
    let mut step = bound.step(displacements)?;
    for _ in 1..(VERTEX_STEPS / bound.step_cost().max(1)).clamp(1, MOST_STEPS) {
        if step.finished || cancel.is_cancelled() {
            break;
        }
        step = bound.step(displacements)?;
    }
    Ok(step)
}

/// The maps of the handles in the region's order; `None` if one of them is gone.
pub(super) fn targets(document: &Document, handles: &[HandleId]) -> Option<Vec<DAffine3>> {
    handles
        .iter()
        .map(|&id| document.handle(id).map(|handle| handle.affine()))
        .collect()
}
