//! Bending: steps towards the handles' targets, from the shown shape or from a kept one.

use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, Bound, Solve, SolveError, Step};
use pliant_mesh::{Cancel, SurfaceVertex};

use super::carried::Carried;
use super::computed::Computed;
use super::slot::{Unfinished, Work};
use super::solved::{Bent, ControlPlaces, Descent, Solved};
use crate::document::{Document, HandleId, KeptShape, sum_of_shapes};
use crate::warning::HandleWarning;

/// A solve takes steps for this many vertices before it shows its shape: about as many as fit into a frame. The editor
/// has no clock.
const VERTEX_STEPS: usize = 100_000;

/// The most steps of one solve, even with few vertices.
const MOST_STEPS: usize = 16;

/// The solution at a kept shape gets this many times the steps of one solve: it is so close to the end of the descent
/// that the drag hides the rest.
const MOST_FIRST_ROUNDS: usize = 8;

/// Takes steps towards the handles' targets; `None` while nothing is bound.
pub(super) fn solve_work(computed: &Computed, document: &Document) -> Option<Work<Bent>> {
    let (bound, model) = (Arc::clone(&computed.slots.bind.last()?.bound), computed.model.clone()?);
    let handles = &computed.region.handles;
    let wanted = Wanted::of(document, handles, &document.from_rest, computed.carried.as_ref())?;
    let newer_targets = computed.newer_targets.clone();
    Some(Box::new(move |_, cancel| {
        cancel.check()?;
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        bound.set_cancel(&newer_targets);
        let is_from_file = wanted.rest.is_none();
        match wanted.solve(&mut bound, cancel) {
            Err(error) => Err(Unfinished::Failed(
                error
                    .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                    .to_string(),
            )),
            Ok(mut solved) => {
                if is_from_file && solved.carried.is_none() {
                    solved.jacobians = bound.jacobians();
                }
                Ok(Bent::Shape(solved))
            }
        }
    }))
}

/// Computes the control points' positions for the document's targets, whose shape is known; `None` while nothing is
/// bound.
pub(super) fn controls_work(computed: &Computed, document: &Document) -> Option<Work<Bent>> {
    let bound = Arc::clone(&computed.slots.bind.last()?.bound);
    let handles = targets(document, &computed.region.handles)?;
    let attachments = Arc::clone(&document.attachments);
    Some(Box::new(move |_, cancel| {
        cancel.check()?;
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        let own = bound.attachment().and_then(|(name, _)| attachments.get(name));
        let targets = Targets {
            handles: &handles,
            controls: own.and_then(Attachment::moved),
            weights: &[],
        };
        match targets.set(&mut bound) {
            Err(error) => Err(Unfinished::Failed(error.to_string())),
            Ok(()) => ControlPlaces::of(&bound)
                .map(Bent::Controls)
                .ok_or(Unfinished::Cancelled),
        }
    }))
}

/// The task of a solve, and its start.
pub(super) struct Wanted {
    handles: Vec<HandleId>,
    targets: Vec<DAffine3>,
    beginning: Beginning,
    attachments: Arc<BTreeMap<&'static str, Attachment>>,
    /// The weights of the examples.
    weights: Vec<Option<f64>>,
    /// The shown shape.
    from_rest: Arc<Vec<DVec3>>,
    /// The rest shape, if it is not the file's.
    rest: Option<Arc<Vec<DVec3>>>,
}

impl Wanted {
    /// The document's targets for `handles`, from the shown shape and from the last solution, if that continues a kept
    /// shape; `None` if a handle no longer exists.
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

/// The targets of handles and control points, and the weights of the examples.
struct Targets<'a> {
    handles: &'a [DAffine3],
    /// The brought points, moved by hand.
    controls: Option<&'a Arc<Vec<DVec3>>>,
    /// The weights, `None` for one to be found.
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

/// The result of a solve.
struct Stepped {
    /// The shown shape, as displacements from the rest shape.
    shown: Arc<Vec<DVec3>>,
    /// The start of the next solve, if a shape was kept.
    carried: Option<Carried>,
    /// The progress of the descent.
    step: Step,
}

/// The start of a solve.
enum Beginning {
    /// The shown shape.
    Shown,
    /// A kept shape for the first time: its solution must be found, with its own targets.
    Kept(Arc<KeptShape>, Vec<DAffine3>),
    /// The last solution, with the residual.
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
                // Undo has brought another shape: its path is computed again from the beginning.
                carried.solution = Arc::clone(&carried.at_first);
            }
            return Some(Self::Carried(carried));
        }
        let handles = handles.iter();
        let first: Option<Vec<DAffine3>> = handles.map(|id| kept.targets.get(id).copied()).collect();
        first.map(|first| Self::Kept(Arc::clone(kept), first))
    }

    /// The next shown shape, and the start of the following solve.
    fn solve(
        self,
        bound: &mut Bound,
        targets: &Targets<'_>,
        from_rest: &Arc<Vec<DVec3>>,
        cancel: &Cancel,
    ) -> Result<Stepped, SolveError> {
        let (kept, at_first, mut solution) = match self {
            Self::Shown => {
                let mut solution = from_rest.to_vec();
                let step = steps(bound, targets, &mut solution, cancel)?;
                return Ok(Stepped {
                    shown: Arc::new(solution),
                    carried: None,
                    step,
                });
            }
            Self::Kept(kept, first) => {
                let mut at_first = kept.shape.to_vec();
                // Points of another attachment do not apply to the one in force.
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
        Ok(Stepped {
            shown,
            carried: Some(carried),
            step,
        })
    }
}

/// Takes steps towards the targets until the shape is worth showing; it continues from the end of the last solve.
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

/// The maps of the handles in the region's order; `None` if one of them no longer exists.
pub(super) fn targets(document: &Document, handles: &[HandleId]) -> Option<Vec<DAffine3>> {
    handles
        .iter()
        .map(|&id| document.handle(id).map(|handle| handle.affine()))
        .collect()
}
