//! The requested jobs, and the consequences of their results.
//!
//! [`Jobs::pump`] compares the existing results with the needs of the present revisions and requests the missing ones;
//! it is called after every event, so no event needs to know its jobs. Revisions come from one counter: *model*
//! (another file), *problem* (paint, reach, rest shape, stiffness, options), *targets* (handles' transforms) and
//! *shape* (the drawn shape).

use std::sync::Arc;

use pliant_mesh::{Cancel, Model};

use super::allowance::Allowance;
use super::comparison::Comparison;
use super::computed::Computed;
use super::frame_skins::FrameSkinSource;
use super::inspected::Asked;
use super::ordering::{order_work, serves};
use super::skins::SkinSource;
use super::slot::{Ended, Scheduled, Slot, Unfinished, Work};
use super::solved::{ControlPlaces, SolveResult, Solved};
use super::solving::{controls_work, solve_work};
use super::table::{Executor, Input, JobDone, JobKind, Slots};
use super::work::{bind_work, pick_work, region_work};
use crate::document::{Document, Version};
use crate::pickable::ShownTriangles;
use crate::region::{Region, region_input};
use crate::revision::Revision;

/// The person's activity, as far as it affects jobs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Activity {
    /// No change of the document.
    Still,
    /// A stroke: the regions change at every event.
    Painting,
    /// A drag: the targets change at every event.
    Dragging,
}

/// The jobs and their last results.
pub(crate) struct Jobs {
    pub(super) executor: Box<dyn Executor>,
    pub(super) allowance: Allowance,
    counter: u64,
    pub(crate) computed: Computed,
    /// The other methods' results for the edit, during a comparison.
    pub(crate) comparison: Option<Comparison>,
    /// A different number for every measured region.
    pub(crate) roles_revision: Revision,
    /// The shape, the triangle, the candidate and the extent (all joints of the limb?) of the last request for a joint.
    pub(super) joint_asked: Option<(Revision, u32, i32, bool)>,
    /// The candidate that is wanted, from the guess towards the body.
    pub(super) joint_up: i32,
    /// True if the last requested solve begins anew.
    solves_anew: bool,
    /// The sources of the requested shapes of other moments.
    pub(super) skin_source: Option<SkinSource>,
    /// The sources of the ghosts of a sequence.
    pub(super) frame_skin_source: Option<FrameSkinSource>,
    /// The inspection job: its binding, and its targets if it depends on them, from its request on.
    pub(super) inspection: (Revision, Asked, Revision),
}

/// The effect of a job's result on the editor.
pub(crate) enum Arrival {
    /// No visible effect.
    Nothing,
    /// The slot of this kind has a new result.
    Result(JobKind),
    /// A new shape; the flag says whether it is the final one.
    Shape(Solved, Finality),
    /// A failure, in one sentence.
    Problem(String),
}

/// Whether a shape is the last one for its targets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Finality {
    /// Better ones will follow.
    Preview,
    /// It is the solution for the transforms.
    Final,
}

impl Jobs {
    pub(crate) fn new(executor: Box<dyn Executor>) -> Self {
        Self {
            allowance: Allowance::new(executor.budget()),
            executor,
            counter: 0,
            computed: Computed::default(),
            comparison: None,
            roles_revision: Revision(0),
            joint_asked: None,
            joint_up: 0,
            solves_anew: false,
            skin_source: None,
            frame_skin_source: None,
            inspection: (Revision(0), Asked::default(), Revision(0)),
        }
    }

    /// A revision that was never used.
    pub(super) fn next_revision(&mut self) -> Revision {
        self.counter += 1;
        Revision(self.counter)
    }

    /// Another file: all results are dropped, running jobs are stopped.
    pub(crate) fn open(&mut self, model: Arc<Model>) {
        self.comparison = None;
        self.joint_asked = None;
        self.joint_up = 0;
        self.skin_source = None;
        self.frame_skin_source = None;
        let mut slots = std::mem::take(&mut self.computed.slots);
        slots.reset(self.next_revision());
        self.computed = Computed {
            region: Region::still(model.surface.positions.len()),
            model: Some(model),
            slots,
            ..Computed::default()
        };
        self.roles_revision = self.next_revision();
        self.problem_changed();
        self.shape_changed();
    }

    /// Paint, reach, rest shape, stiffness or options have changed.
    pub(crate) fn problem_changed(&mut self) {
        let revision = self.next_revision();
        self.computed.slots.renew(Input::Problem, revision);
        self.drop_solves();
    }

    /// Sets the most bytes for bindings, or all available memory. If that selects another factor than the bound one,
    /// the problem is bound anew, and refused bindings are tried again. Returns whether it does.
    pub(crate) fn allow_memory(&mut self, most: Option<u64>, document: &Document) -> bool {
        let free_count = self.computed.region.counts.free;
        let before = self.allowance;
        self.allowance = before.with_most(most);
        let chooses_otherwise = self.allowance.chooses_otherwise(before, &document.method, free_count);
        let has_given_up = self.computed.slots.bind.has_given_up();
        let binds_anew = before.most() != most && (has_given_up || chooses_otherwise);
        if binds_anew {
            self.problem_changed();
        }
        if before.most() != most && self.comparison.is_some() {
            self.end_comparing();
            self.begin_comparing(document);
        }
        binds_anew
    }

    /// The most bytes for bindings, if a person has set it.
    pub(crate) fn most_memory(&self) -> Option<u64> {
        self.allowance.most()
    }

    /// The handles' transforms have changed.
    pub(crate) fn targets_changed(&mut self) {
        let revision = self.next_revision();
        // A solve that begins anew goes on to its end, for which newer targets don't wait.
        match std::mem::take(&mut self.solves_anew) {
            true => self.computed.slots.solve.renew(revision),
            false => self.computed.slots.solve.follow(revision),
        }
        self.computed.newer_targets.cancel();
        self.computed.newer_targets = Cancel::new();
    }

    /// The solve for this version of the targets begins where every frame of an animation begins, and goes on to its
    /// end.
    pub(crate) fn solve_anew(&mut self, targets: Version) {
        self.computed.anew = Some(targets);
    }

    /// Restricts rays to these triangles.
    pub(crate) fn show_triangles(&mut self, shown: Option<Arc<Vec<u32>>>) {
        self.computed.shown = ShownTriangles {
            revision: self.next_revision(),
            triangles: shown,
        };
        self.shape_changed();
    }

    /// The drawn shape has changed.
    pub(crate) fn shape_changed(&mut self) {
        let revision = self.next_revision();
        self.computed.slots.follow(Input::LastShape, revision);
        self.computed.slots.renew(Input::Shape, revision);
    }

    /// Solves that run or are done but have not arrived must no longer change the shape.
    pub(crate) fn drop_solves(&mut self) {
        self.stop_asking(|slots| &mut slots.solve);
        self.computed.blind_to.clear();
        self.targets_changed();
    }

    /// A stroke begins: the running binding is no longer wanted.
    pub(crate) fn stop_binding(&mut self) {
        self.computed.slots.region.cancel();
        self.computed.slots.bind.cancel();
    }

    /// Stops every job but the pointer's and the flow's for good: each is tried again only after its input has changed.
    pub(crate) fn give_up(&mut self, document: &Document) {
        if let Some(comparison) = &mut self.comparison {
            comparison.stop(document);
        }
        let goes_on = |kind: &&JobKind| matches!(kind, JobKind::Pick | JobKind::Flow);
        for &kind in JobKind::ALL.iter().filter(|kind| !goes_on(kind)) {
            self.computed.slots.of_mut(kind).give_up();
        }
    }

    /// The revision of the file.
    pub(crate) fn model_revision(&self) -> Revision {
        self.computed.slots.order.wanted()
    }

    /// The revision of the drawn shape.
    pub(crate) fn shape_revision(&self) -> Revision {
        self.computed.slots.pick.wanted()
    }

    /// Whether the hierarchy for rays is that of the drawn shape.
    pub(crate) fn is_picking_current(&self) -> bool {
        self.computed.slots.pick.current().is_some()
    }

    /// Whether the region belongs to the present paint.
    pub(crate) fn is_region_current(&self) -> bool {
        self.computed.slots.region.is_current()
    }

    /// Whether the factorisation belongs to the present problem.
    pub(crate) fn is_bound(&self) -> bool {
        self.computed.slots.bind.current().is_some()
    }

    /// Whether the preparation of solves failed or was stopped for the present state.
    pub(crate) fn has_given_up_binding(&self) -> bool {
        let slots = &self.computed.slots;
        slots.order.has_given_up() || slots.region.has_given_up() || slots.bind.has_given_up()
    }

    /// Whether a job of this kind runs or waits.
    pub(crate) fn is_busy(&self, kind: JobKind) -> bool {
        self.computed.slots.of(kind).is_busy()
    }

    /// The running jobs, with their progress.
    pub(crate) fn running(&self) -> Vec<(JobKind, f32)> {
        let progress = |&kind: &JobKind| Some((kind, self.computed.slots.of(kind).running()?.progress.get()));
        JobKind::ALL.iter().filter_map(progress).collect()
    }

    /// Requests all missing results, and starts the jobs that can start.
    pub(crate) fn pump(&mut self, document: &Document, activity: Activity) {
        let Some(model) = self.computed.model.clone() else {
            return;
        };
        if model.surface.positions.is_empty() {
            return;
        }
        if activity != Activity::Dragging && !self.is_picking_current() {
            self.want(
                |slots| &mut slots.pick,
                |computed| pick_work(computed, &model, document),
            );
        }
        let missing = document
            .method
            .ordering_power()
            .filter(|&power| self.computed.ordering(power).is_none());
        if let Some(power) = missing
            && self.may_order(document, &model, activity)
        {
            let large = self.executor.large_mesh();
            self.want(
                |slots| &mut slots.order,
                |computed| order_work(&model, &computed.region, large, power),
            );
        }
        if activity != Activity::Painting {
            if !self.is_region_current() {
                self.want(
                    |slots| &mut slots.region,
                    |computed| region_work(region_input(Arc::clone(&model), document, &computed.contacts)),
                );
            } else if missing.is_none() && !self.is_bound() && self.binds_something(document) {
                let (revision, allowance) = (self.computed.slots.bind.wanted().0, self.allowance);
                self.want(
                    |slots| &mut slots.bind,
                    |computed| bind_work(computed, &model, document, revision, allowance),
                );
            }
            if self.is_bound() && !document.settled {
                self.want(|slots| &mut slots.solve, |computed| solve_work(computed, document));
                self.solves_anew = self.computed.solves_anew(document);
            } else if self.is_bound() && self.are_controls_behind() {
                self.want(|slots| &mut slots.solve, |computed| controls_work(computed, document));
            }
            self.compare(document, &model);
        }
        self.computed.slots.start(&mut *self.executor);
    }

    /// Requests a job for the present state, unless that is under way or was given up.
    pub(super) fn want<T>(
        &mut self,
        slot: fn(&mut Slots) -> &mut Slot<T>,
        work: impl FnOnce(&Computed) -> Option<Work<T>>,
    ) {
        let own = slot(&mut self.computed.slots);
        if own.may_request()
            && let Some(work) = work(&self.computed)
        {
            slot(&mut self.computed.slots).request(work);
        }
    }

    /// Whether the binding has control points whose positions are for other targets.
    fn are_controls_behind(&self) -> bool {
        self.computed.controls().is_some() && self.computed.controls_revision != self.computed.slots.solve.wanted()
    }

    /// Whether there is something to bind: handles, or control points or examples that move the surface without them.
    pub(super) fn binds_something(&self, document: &Document) -> bool {
        !self.computed.region.handles.is_empty() || document.bends_without_handles()
    }

    /// Whether an ordering can be made: one by region waits for the region, and for something that bends it.
    fn may_order(&self, document: &Document, model: &Model, activity: Activity) -> bool {
        let is_by_region = model.surface.positions.len() >= self.executor.large_mesh();
        !is_by_region || (activity != Activity::Painting && self.is_region_current() && self.binds_something(document))
    }

    /// Requests the next shape of the comparison if the document's own binding is not pending: its memory has priority.
    fn compare(&mut self, document: &Document, model: &Arc<Model>) {
        let Some(comparison) = &mut self.comparison else { return };
        if comparison.follow(document) {
            self.stop_asking(|slots| &mut slots.compare);
        }
        let awaited = [JobKind::Order, JobKind::Region, JobKind::Bind, JobKind::Compare];
        if awaited.into_iter().any(|kind| self.is_busy(kind)) || !self.is_region_current() {
            return;
        }
        if self.computed.region.handles.is_empty() {
            return self.end_comparing();
        }
        let times = (self.allowance, self.executor.clock_ms());
        let Some(comparison) = &mut self.comparison else { return };
        if let Some(power) = comparison.missing_ordering(&self.computed) {
            if self.computed.slots.order.has_given_up() {
                comparison.stop(document);
            }
            let large = self.executor.large_mesh();
            self.want(
                |slots| &mut slots.order,
                |computed| order_work(model, &computed.region, large, power),
            );
        } else if let Some(work) = comparison.next_work(document, &self.computed, times) {
            self.ask(|slots| &mut slots.compare, work);
        }
    }

    /// Stores a job's result; results for past states are dropped.
    pub(crate) fn accept(&mut self, done: JobDone) -> Arrival {
        let (kind, stamp) = (done.kind, done.stamp);
        let ended = self.computed.slots.finish(done);
        if kind == JobKind::Compare {
            self.take_compared(ended);
            return Arrival::Nothing;
        }
        match ended {
            Ended::Failed(sentence) => return Arrival::Problem(sentence),
            Ended::Stopped | Ended::Dropped => return Arrival::Nothing,
            Ended::Stored => {}
        }
        match kind {
            JobKind::Order => {
                let made = self.computed.slots.order.take();
                let region = &self.computed.region;
                // The region may have grown since it was asked for.
                self.computed.orderings.extend(made.filter(|made| serves(made, region)));
            }
            JobKind::Region => {
                if let Some(region) = self.computed.slots.region.take() {
                    self.computed.orderings.retain(|ordering| serves(ordering, &region));
                    self.computed.region = region;
                }
                self.roles_revision = self.next_revision();
            }
            JobKind::Bind => self.take_binding(),
            JobKind::Solve => match self.computed.slots.solve.take() {
                Some(SolveResult::Shape(solved)) => return self.take_solved(solved, stamp),
                Some(SolveResult::Controls(places)) => self.put_controls(&places, stamp),
                None => {}
            },
            _ => {}
        }
        Arrival::Result(kind)
    }

    /// Gives the comparison its job's outcome.
    fn take_compared(&mut self, ended: Ended) {
        let Some(comparison) = &mut self.comparison else { return };
        let outcome = match ended {
            Ended::Stored => self.computed.slots.compare.take().ok_or(Unfinished::Cancelled),
            Ended::Failed(sentence) => Err(Unfinished::Failed(sentence)),
            Ended::Stopped => Err(Unfinished::Cancelled),
            Ended::Dropped => return,
        };
        comparison.take(outcome);
    }

    /// Another binding: the data of the last one's solves are dropped, and those of its shown parts that it lacks.
    fn take_binding(&mut self) {
        let computed = &mut self.computed;
        let inspectable = computed.inspectable();
        if let Some(inspected) = computed.slots.inspect.last_mut() {
            inspected.weights.take_if(|_| !inspectable.weights);
            inspected.base.take_if(|_| !inspectable.base);
        }
        computed.blind_to.clear();
        computed.controls_revision = Revision(0);
        computed.carried = None;
        computed.example_weights.clear();
    }

    /// A shape has arrived, with the targets of this revision.
    fn take_solved(&mut self, solved: Solved, stamp: Revision) -> Arrival {
        let is_last = stamp == self.computed.slots.solve.wanted() && solved.finished;
        if solved.carried.is_some() {
            self.computed.carried.clone_from(&solved.carried);
        }
        self.computed.blind_to.clone_from(&solved.blind_to);
        self.computed.example_weights.clone_from(&solved.example_weights);
        if let Some(places) = &solved.controls {
            self.put_controls(places, stamp);
        }
        Arrival::Shape(solved, if is_last { Finality::Final } else { Finality::Preview })
    }

    /// The control points have arrived, with the targets of this revision.
    fn put_controls(&mut self, places: &ControlPlaces, stamp: Revision) {
        if let Some(binding) = self.computed.slots.bind.last_mut()
            && let Some(controls) = &mut binding.controls
            && controls.positions.len() == places.positions.len()
        {
            controls.positions = Arc::clone(&places.positions);
            controls.attachment = controls.attachment.with_moved(Arc::clone(&places.moved));
            self.computed.controls_revision = stamp;
        }
    }
}
