//! What each job does, as a closure that owns all it needs.

use std::sync::{Arc, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{BindError, Bound, Budget, Ordering, Problem, Solve, SolveError, Step};
use pliant_mesh::{Bvh, Cancel, Model, SurfaceVertex};

use super::computed::Computed;
use super::job::{Carried, Descent, JobOutcome, Pickable, Solved, Work};
use super::region::{Region, RegionInput};
use crate::Setup;
use crate::document::{Document, HandleId, KeptShape, sum_of_shapes};

/// A solve takes so many vertices' worth of steps before it shows its shape: about what a window's frame has time for.
/// There is no clock here.
const VERTEX_STEPS: usize = 100_000;

/// The most steps of one solve, however few its vertices are.
const MOST_STEPS: usize = 16;

/// So many times the steps of one solve are taken for the solution at a kept shape: close enough to where the descent
/// ends that what is left of it hides in the drag.
const MOST_FIRST_ROUNDS: usize = 8;

/// Makes the ordering for a power of the Laplacian.
pub(super) fn order_work(model: &Arc<Model>, power: u32) -> Option<Work> {
    let model = Arc::clone(model);
    Some(Box::new(move |progress, cancel| {
        match Ordering::of(&model.topology, power, progress, cancel) {
            Ok(ordering) => JobOutcome::Ordered(Arc::new(ordering)),
            Err(_) => JobOutcome::Cancelled,
        }
    }))
}

/// Measures the region.
pub(super) fn region_work(input: RegionInput) -> Option<Work> {
    Some(Box::new(move |_, cancel| match Region::measure(&input, cancel) {
        Ok(region) => JobOutcome::Region(region),
        Err(_) => JobOutcome::Cancelled,
    }))
}

/// Builds or refits what rays are answered from.
pub(super) fn pick_work(computed: &Computed, model: &Arc<Model>, document: &Document) -> Option<Work> {
    let (model, displacements, shown) = (
        Arc::clone(model),
        Arc::clone(&document.from_file),
        computed.shown.clone(),
    );
    let is_of_shown = |pickable: &&Pickable| pickable.shown.revision == shown.revision;
    let bvh = computed
        .pickable
        .as_ref()
        .filter(is_of_shown)
        .map(|pickable| pickable.bvh.clone());
    Some(Box::new(move |_, cancel| {
        if cancel.is_cancelled() {
            return JobOutcome::Cancelled;
        }
        let surface = &model.surface;
        let mut bvh = bvh.unwrap_or_else(|| match &shown.triangles {
            None => Bvh::build(&surface.positions, &surface.triangles),
            Some(shown) => {
                let triangles = shown.iter().map(|&triangle| surface.triangles[triangle as usize]);
                Bvh::build(&surface.positions, &triangles.collect::<Vec<_>>())
            }
        });
        bvh.refit(|vertex| surface.positions[vertex.index()] + displacements[vertex.index()]);
        JobOutcome::Pick(Pickable { bvh, shown })
    }))
}

/// Factorises; `None` while the ordering that the method needs is missing.
pub(super) fn bind_work(
    computed: &Computed,
    model: &Arc<Model>,
    document: &Document,
    revision: u64,
    budget: fn() -> Budget,
) -> Option<Work> {
    let ordering = match document.method.ordering_power() {
        Some(power) => Some(computed.ordering(power)?),
        None => None,
    };
    let (model, document, region) = (Arc::clone(model), document.clone(), computed.region.clone());
    let reusable_factor = computed.reusable_factor.clone();
    Some(Box::new(move |progress, cancel| {
        let setup = Setup::of_document(&document, &region);
        let problem = Problem {
            revision,
            ..setup.problem(&model)
        };
        let (ordering, reusable_factor) = (ordering.as_deref(), reusable_factor.as_ref());
        match problem.rebind_within(ordering, reusable_factor, budget(), progress, cancel) {
            Ok(bound) => JobOutcome::Bound(Box::new(bound)),
            Err(BindError::Cancelled(_)) => JobOutcome::Cancelled,
            Err(error) => JobOutcome::Failed(
                error
                    .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                    .to_string(),
            ),
        }
    }))
}

/// Takes steps towards the handles' targets; `None` while nothing is bound.
pub(super) fn solve_work(computed: &Computed, document: &Document) -> Option<Work> {
    let (bound, model) = (computed.bound.clone()?, computed.model.clone()?);
    let targets = targets(document, &computed.region.handles)?;
    let from_rest = Arc::clone(&document.from_rest);
    let rest = document.applied.then(|| Arc::clone(&document.rest));
    let beginning = Beginning::of(computed, document)?;
    Some(Box::new(move |_, cancel| {
        if cancel.is_cancelled() {
            return JobOutcome::Cancelled;
        }
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        match beginning.solve(&mut bound, &targets, &from_rest, cancel) {
            Err(error) => JobOutcome::Failed(
                error
                    .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                    .to_string(),
            ),
            Ok(Bent {
                shown: from_rest,
                carried,
                step,
            }) => {
                let from_file = sum_of_shapes(rest.as_ref(), &from_rest);
                let is_own = rest.is_none() && carried.is_none();
                JobOutcome::Solved(Solved {
                    jacobians: is_own.then(|| bound.jacobians()).flatten(),
                    from_rest,
                    from_file,
                    carried,
                    finished: step.finished,
                    descent: (bound.solve() != Solve::Direct).then_some(Descent {
                        energy: step.energy,
                        converged: step.converged,
                        finished: step.finished,
                    }),
                })
            }
        }
    }))
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
    fn of(computed: &Computed, document: &Document) -> Option<Self> {
        let Some(kept) = &document.kept else {
            return Some(Self::Shown);
        };
        let carried = computed.carried.as_ref();
        if let Some(carried) = carried.filter(|carried| Arc::ptr_eq(&carried.kept, kept)) {
            let mut carried = carried.clone();
            if !Arc::ptr_eq(&carried.shown, &document.from_rest) {
                // Undo has brought another shape: the way to it is found again from where all began.
                carried.solution = Arc::clone(&carried.at_first);
            }
            return Some(Self::Carried(carried));
        }
        let handles = computed.region.handles.iter();
        let first: Option<Vec<DAffine3>> = handles.map(|id| kept.targets.get(id).copied()).collect();
        first.map(|first| Self::Kept(Arc::clone(kept), first))
    }

    /// What is shown next, and what the solve after it goes on from.
    fn solve(
        self,
        bound: &mut Bound,
        targets: &[DAffine3],
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
    targets: &[DAffine3],
    displacements: &mut [DVec3],
    cancel: &Cancel,
) -> Result<Step, SolveError> {
    bound.set_targets(targets)?;
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
fn targets(document: &Document, handles: &[HandleId]) -> Option<Vec<DAffine3>> {
    handles
        .iter()
        .map(|&id| document.handle(id).map(|handle| handle.affine()))
        .collect()
}
