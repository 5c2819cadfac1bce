//! What each job of the engine does, as a closure that owns all it needs.

use std::sync::{Arc, PoisonError};

use glam::{DAffine3, DVec3};
use pliant_deform::{BindError, Bound, Ordering, Problem, Solve, SolveError, Step};
use pliant_mesh::{Bvh, Cancel, Model, SurfaceVertex};

use super::{Engine, Work};
use crate::document::{Document, HandleId, sum_of_shapes};
use crate::job::Pickable;
use crate::region::{Region, RegionInput};
use crate::{Descent, JobOutcome, Setup, Solved};

/// A solve takes so many vertices' worth of steps before it shows its shape: about what a window's frame has time for.
/// There is no clock here.
const VERTEX_STEPS: usize = 100_000;

/// The most steps of one solve, however few its vertices are.
const MOST_STEPS: usize = 16;

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

impl Engine {
    pub(super) fn pick_work(&self, model: &Arc<Model>, document: &Document) -> Option<Work> {
        let (model, displacements, shown) = (Arc::clone(model), Arc::clone(&document.from_file), self.shown.clone());
        let is_of_shown = |pickable: &&Pickable| match (&pickable.triangles, &shown) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        let bvh = self
            .pickable
            .as_ref()
            .filter(is_of_shown)
            .map(|pickable| pickable.bvh.clone());
        Some(Box::new(move |_, cancel| {
            if cancel.is_cancelled() {
                return JobOutcome::Cancelled;
            }
            let surface = &model.surface;
            let mut bvh = bvh.unwrap_or_else(|| match &shown {
                None => Bvh::build(&surface.positions, &surface.triangles),
                Some(shown) => {
                    let triangles = shown.iter().map(|&triangle| surface.triangles[triangle as usize]);
                    Bvh::build(&surface.positions, &triangles.collect::<Vec<_>>())
                }
            });
            bvh.refit(|vertex| surface.positions[vertex.index()] + displacements[vertex.index()]);
            JobOutcome::Pick(Pickable { bvh, triangles: shown })
        }))
    }

    pub(super) fn bind_work(&self, model: &Arc<Model>, document: &Document) -> Option<Work> {
        let ordering = match document.method.ordering_power() {
            Some(power) => Some(self.ordering(power)?),
            None => None,
        };
        let (model, document, region) = (Arc::clone(model), document.clone(), self.region.clone());
        let revision = self.problem_revision.0;
        let remains = self.remains.clone();
        Some(Box::new(move |progress, cancel| {
            let setup = Setup::of_document(&document, &region);
            let problem = Problem {
                revision,
                ..setup.problem(&model)
            };
            match problem.rebind(ordering.as_deref(), remains.as_ref(), progress, cancel) {
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

    pub(super) fn solve_work(&self, document: &Document) -> Option<Work> {
        let (bound, model) = (self.bound.clone()?, self.model.clone()?);
        let targets = targets(document, &self.region.handles)?;
        let from_rest = Arc::clone(&document.from_rest);
        let rest = document.applied.then(|| Arc::clone(&document.rest));
        Some(Box::new(move |_, cancel| {
            if cancel.is_cancelled() {
                return JobOutcome::Cancelled;
            }
            let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
            let mut displacements = from_rest.to_vec();
            match steps(&mut bound, &targets, &mut displacements, cancel) {
                Err(error) => JobOutcome::Failed(
                    error
                        .renumbered(|vertex| model.first_file_vertex(SurfaceVertex(vertex)).0)
                        .to_string(),
                ),
                Ok(step) => {
                    let from_rest = Arc::new(displacements);
                    let from_file = sum_of_shapes(rest.as_ref(), &from_rest);
                    JobOutcome::Solved(Solved {
                        from_rest,
                        from_file,
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

/// Everything that the region follows from.
pub(crate) fn region_input(model: &Arc<Model>, document: &Document) -> RegionInput {
    RegionInput {
        model: Arc::clone(model),
        paint: Arc::clone(&document.paint),
        handles: document
            .handles
            .iter()
            .map(|handle| (handle.id, handle.reach))
            .collect(),
        rest: document.applied.then(|| Arc::clone(&document.rest)),
        loose: document.loose,
        loose_parts: Arc::clone(&document.loose_parts),
        access: Arc::clone(&document.access),
    }
}
