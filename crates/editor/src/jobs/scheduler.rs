//! The requested jobs, and their last results: the picking structure, the ordering, the region, the factorisation, the
//! shape.
//!
//! [`Jobs::pump`] compares the existing results with the needs of the present revisions and requests the missing ones;
//! it is called after every event, so no event needs to know its jobs. Revisions come from one counter: *model*
//! (another file), *problem* (paint, reach, rest shape, stiffness, options), *targets* (handles' transforms) and
//! *shape* (the drawn shape).

use std::sync::{Arc, Mutex};

use glam::DVec3;
use pliant_mesh::{Cancel, Joint, Model, SurfaceVertex};

use super::allowance::Allowance;
use super::both_sides::BothSides;
use super::bound_controls::BoundControls;
use super::comparison::Comparison;
use super::computed::Computed;
use super::inspected::{Asked, Inspected};
use super::inspection::inspect_work;
use super::intersections::Intersections;
use super::job::{ControlPlaces, Executor, Job, JobDone, JobKind, JobOutcome, Solved, Work};
use super::job_queue::{JobQueue, Running};
use super::solving::{controls_work, solve_work};
use super::work::{bind_work, intersect_work, order_work, pick_work, region_work};
use crate::document::Document;
use crate::pickable::ShownTriangles;
use crate::region::{Region, region_input};
use crate::revision::Revision;
use crate::warning::HandleWarning;

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
    executor: Box<dyn Executor>,
    allowance: Allowance,
    queues: [JobQueue<Work>; JobKind::ALL.len()],
    /// For each kind the revision that failed or was stopped by the person, which is not tried again.
    given_up: [Option<Revision>; JobKind::ALL.len()],
    counter: u64,
    pub(crate) computed: Computed,
    /// The other methods' results for the edit, during a comparison.
    pub(crate) comparison: Option<Comparison>,
    pub(crate) model_revision: Revision,
    problem_revision: Revision,
    target_revision: Revision,
    pub(crate) shape_revision: Revision,
    /// Requests before this are dropped.
    solve_floor: Revision,
    bvh_revision: Revision,
    region_revision: Revision,
    /// A different number for every measured region.
    pub(crate) roles_revision: Revision,
    bound_revision: Revision,
    /// The targets for which [`Computed::controls`] has the control points' positions.
    controls_revision: Revision,
    mirror_revision: Revision,
    enclose_revision: Revision,
    symmetry_revision: Revision,
    compare_revision: Revision,
    inspect_revision: Revision,
    joint_revision: Revision,
    /// Requests before this are dropped.
    joint_floor: Revision,
    /// The shape and the triangle of the last request for a joint.
    joint_asked: Option<(Revision, u32)>,
    /// The inspection job: its binding, and its targets if it depends on them, from its request on.
    inspection: (Revision, Asked, Revision),
    /// Requests before this are dropped.
    inspect_floor: Revision,
}

/// The effect of a job's result on the editor.
pub(crate) enum Arrival {
    /// No visible effect.
    Nothing,
    /// Rays can be answered from a newer shape.
    Picking,
    /// The vertices of a mirror image.
    Mirrored(Vec<usize>),
    /// Both sides of the plane of symmetry, or that there is none.
    Symmetry(Option<Arc<BothSides>>),
    /// The joint of the limb under the pointer, or that it has none.
    Joint,
    /// The vertices inside an outline.
    Enclosed(Vec<SurfaceVertex>),
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
            queues: std::array::from_fn(|_| JobQueue::default()),
            given_up: [None; JobKind::ALL.len()],
            counter: 0,
            computed: Computed::default(),
            comparison: None,
            model_revision: Revision(0),
            problem_revision: Revision(0),
            target_revision: Revision(0),
            shape_revision: Revision(0),
            solve_floor: Revision(0),
            bvh_revision: Revision(0),
            region_revision: Revision(0),
            roles_revision: Revision(0),
            bound_revision: Revision(0),
            controls_revision: Revision(0),
            mirror_revision: Revision(0),
            enclose_revision: Revision(0),
            symmetry_revision: Revision(0),
            compare_revision: Revision(0),
            inspect_revision: Revision(0),
            joint_revision: Revision(0),
            joint_floor: Revision(0),
            joint_asked: None,
            inspection: (Revision(0), Asked::default(), Revision(0)),
            inspect_floor: Revision(0),
        }
    }

    /// A revision that was never used.
    fn next_revision(&mut self) -> Revision {
        self.counter += 1;
        Revision(self.counter)
    }

    /// Another file: all results are dropped, running jobs are stopped.
    pub(crate) fn open(&mut self, model: Arc<Model>) {
        for kind in JobKind::ALL {
            self.queues[kind as usize].cancel();
        }
        self.comparison = None;
        self.forget_joint();
        self.computed = Computed {
            region: Region::still(model.surface.positions.len()),
            model: Some(model),
            ..Computed::default()
        };
        self.model_revision = self.next_revision();
        self.roles_revision = self.next_revision();
        self.problem_changed();
        self.region_revision = Revision(0);
        self.shape_changed();
    }

    /// Paint, reach, rest shape, stiffness or options have changed.
    pub(crate) fn problem_changed(&mut self) {
        self.problem_revision = self.next_revision();
        self.queues[JobKind::Region as usize].cancel();
        self.queues[JobKind::Bind as usize].cancel();
        self.drop_solves();
        self.targets_changed();
    }

    /// Sets the most bytes for bindings, or all available memory. If that selects another factor than the bound one,
    /// the problem is bound anew, and refused bindings are tried again. Returns whether it does.
    pub(crate) fn allow_memory(&mut self, most: Option<u64>, document: &Document) -> bool {
        let free_count = self.computed.region.counts.free;
        let before = self.allowance;
        self.allowance = before.with_most(most);
        let chooses_otherwise = self.allowance.chooses_otherwise(before, &document.method, free_count);
        let binds_anew = before.most() != most && (self.has_given_up(JobKind::Bind) || chooses_otherwise);
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
        self.target_revision = self.next_revision();
        self.computed.newer_targets.cancel();
        self.computed.newer_targets = Cancel::new();
    }

    /// Requests a mirror image, in place of an earlier request.
    pub(crate) fn mirror(&mut self, work: Work) {
        self.queues[JobKind::Mirror as usize].cancel();
        self.mirror_revision = self.next_revision();
        self.queues[JobKind::Mirror as usize].request(self.mirror_revision, work);
    }

    /// Requests the plane of symmetry.
    pub(crate) fn look_for_symmetry(&mut self, work: Work) {
        self.queues[JobKind::Symmetry as usize].request(self.symmetry_revision, work);
    }

    /// No plane of symmetry is wanted now, or another one.
    pub(crate) fn stop_looking_for_symmetry(&mut self) {
        self.queues[JobKind::Symmetry as usize].cancel();
        self.symmetry_revision = self.next_revision();
    }

    /// Requests an outline's vertices.
    pub(crate) fn enclose(&mut self, work: Work) {
        self.stop_enclosing();
        self.queues[JobKind::Enclose as usize].request(self.enclose_revision, work);
    }

    /// An outline's vertices are no longer wanted.
    pub(crate) fn stop_enclosing(&mut self) {
        self.queues[JobKind::Enclose as usize].cancel();
        self.enclose_revision = self.next_revision();
    }

    /// Whether the joint under a triangle of the present shape has not been requested yet.
    pub(crate) fn asks_for_joint(&self, triangle: u32) -> bool {
        self.joint_asked != Some((self.shape_revision, triangle))
    }

    /// Requests the joint under a triangle of the present shape. The running search continues, so that a steadily
    /// moving pointer still shows joints; the newest request waits.
    pub(crate) fn look_for_joint(&mut self, triangle: u32, work: Work) {
        if self.joint_asked.is_some_and(|(shape, _)| shape != self.shape_revision) {
            self.forget_joint();
        }
        self.joint_asked = Some((self.shape_revision, triangle));
        self.joint_revision = self.next_revision();
        self.queues[JobKind::Joint as usize].request(self.joint_revision, work);
    }

    /// A joint is no longer wanted.
    pub(crate) fn forget_joint(&mut self) {
        if self.joint_asked.take().is_some() {
            self.queues[JobKind::Joint as usize].cancel();
            self.computed.joint = None;
            self.joint_floor = self.next_revision();
        }
    }

    /// The last joint that was found.
    pub(crate) fn joint(&self) -> Option<&Arc<Joint>> {
        self.computed.joint.as_ref()
    }

    /// Begins a comparison of the methods on the edit.
    pub(crate) fn begin_comparing(&mut self, document: &Document) {
        self.comparison = Some(Comparison::new(document));
        // A new request also needs the ordering that was stopped before.
        self.given_up[JobKind::Order as usize] = None;
    }

    /// Ends the comparison; the methods' bindings are dropped.
    pub(crate) fn end_comparing(&mut self) {
        self.comparison = None;
        self.queues[JobKind::Compare as usize].cancel();
    }

    /// Requests the shown parts of the present binding, unless they are known or under way. If only the targets differ,
    /// the running job continues, so that the base visibly bends during a drag; the newest request waits.
    pub(crate) fn inspect(&mut self, asked: Asked, document: &Document) {
        let has_binding = self.binds_something(document) && !self.has_given_up(JobKind::Bind);
        let asked = if has_binding { asked } else { Asked::default() };
        let targets = if asked.base { self.target_revision } else { Revision(0) };
        let wanted = (self.bound_revision, asked, targets);
        if self.inspection == wanted || !(self.is_bound() || asked == Asked::default()) {
            return;
        }
        let (bound, before, _) = std::mem::replace(&mut self.inspection, wanted);
        self.inspect_revision = self.next_revision();
        if (bound, before) != (self.bound_revision, asked) {
            self.queues[JobKind::Inspect as usize].cancel();
            self.inspect_floor = self.inspect_revision;
        }
        let work = inspect_work(&self.computed, document, asked);
        match work.filter(|_| asked != Asked::default()) {
            Some(work) => self.queues[JobKind::Inspect as usize].request(self.inspect_revision, work),
            None => self.computed.inspected = Inspected::default(),
        }
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
        self.shape_revision = self.next_revision();
        self.queues[JobKind::Intersect as usize].cancel();
    }

    /// Requests the places where the present shape, `displacements` away from the file's, passes through itself, once
    /// its hierarchy exists.
    pub(crate) fn intersect(&mut self, displacements: &Arc<Vec<DVec3>>) {
        let Some(model) = self.computed.model.clone() else {
            return;
        };
        let is_known = self.intersections().is_some();
        if !is_known && self.is_picking_current() {
            self.want(JobKind::Intersect, |computed| {
                intersect_work(computed, &model, displacements)
            });
        }
    }

    /// The places where the present shape passes through itself; `None` before the search.
    pub(crate) fn intersections(&self) -> Option<&Intersections> {
        let (of, found) = self.computed.intersections.as_ref()?;
        (*of == self.shape_revision).then_some(found)
    }

    /// Solves that run or are done but have not arrived must no longer change the shape.
    pub(crate) fn drop_solves(&mut self) {
        self.queues[JobKind::Solve as usize].cancel();
        self.computed.blind_to.clear();
        self.solve_floor = self.next_revision();
        self.targets_changed();
    }

    /// A stroke begins: the running binding is no longer wanted.
    pub(crate) fn stop_binding(&mut self) {
        self.queues[JobKind::Region as usize].cancel();
        self.queues[JobKind::Bind as usize].cancel();
    }

    /// Stops every job for good: each is tried again only after its input has changed.
    pub(crate) fn give_up(&mut self, document: &Document) {
        if let Some(comparison) = &mut self.comparison {
            comparison.stop(document);
            self.queues[JobKind::Compare as usize].cancel();
        }
        for kind in [
            JobKind::Order,
            JobKind::Region,
            JobKind::Bind,
            JobKind::Solve,
            JobKind::Mirror,
            JobKind::Symmetry,
            JobKind::Enclose,
            JobKind::Joint,
            JobKind::Intersect,
        ] {
            let queue = &mut self.queues[kind as usize];
            if queue.is_busy() {
                queue.cancel();
                self.given_up[kind as usize] = Some(self.stamp(kind));
            }
        }
    }

    /// Whether the hierarchy for rays is that of the drawn shape.
    pub(crate) fn is_picking_current(&self) -> bool {
        self.computed.pickable.is_some() && self.bvh_revision == self.shape_revision
    }

    /// Whether the region belongs to the present paint.
    pub(crate) fn is_region_current(&self) -> bool {
        self.region_revision == self.problem_revision
    }

    /// Whether the factorisation belongs to the present problem.
    pub(crate) fn is_bound(&self) -> bool {
        self.computed.bound.is_some() && self.bound_revision == self.problem_revision
    }

    /// Whether a job of this kind runs or waits.
    pub(crate) fn is_busy(&self, kind: JobKind) -> bool {
        self.queues[kind as usize].is_busy()
    }

    /// Whether a job of this kind failed or was stopped for the present state.
    pub(crate) fn has_given_up(&self, kind: JobKind) -> bool {
        self.given_up[kind as usize] == Some(self.stamp(kind))
    }

    /// The running jobs, with their progress.
    pub(crate) fn running(&self) -> Vec<(JobKind, f32)> {
        let progress = |kind: JobKind| Some((kind, self.queues[kind as usize].running()?.progress.get()));
        JobKind::ALL.into_iter().filter_map(progress).collect()
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
            self.want(JobKind::Pick, |computed| pick_work(computed, &model, document));
        }
        let missing = document
            .method
            .ordering_power()
            .filter(|&power| self.computed.ordering(power).is_none());
        if let Some(power) = missing {
            self.want(JobKind::Order, |_| order_work(&model, power));
        }
        if activity != Activity::Painting {
            if !self.is_region_current() {
                self.want(JobKind::Region, |computed| {
                    region_work(region_input(&model, document, &computed.contacts))
                });
            } else if missing.is_none() && !self.is_bound() && self.binds_something(document) {
                let (revision, allowance) = (self.problem_revision.0, self.allowance);
                self.want(JobKind::Bind, |computed| {
                    bind_work(computed, &model, document, revision, allowance)
                });
            }
            if self.is_bound() && !document.settled {
                self.want(JobKind::Solve, |computed| solve_work(computed, document));
            } else if self.is_bound()
                && self.computed.controls.is_some()
                && self.controls_revision != self.target_revision
            {
                self.want(JobKind::Solve, |computed| controls_work(computed, document));
            }
        }
        if activity != Activity::Painting {
            self.compare(document, &model);
        }
        self.start();
    }

    /// Whether there is something to bind: handles, or control points or examples that move the surface without them.
    fn binds_something(&self, document: &Document) -> bool {
        !self.computed.region.handles.is_empty() || document.bends_without_handles()
    }

    /// Requests the next shape of the comparison if the document's own binding is not pending: its memory has priority.
    fn compare(&mut self, document: &Document, model: &Arc<Model>) {
        let Some(comparison) = &mut self.comparison else { return };
        if comparison.follow(document) {
            self.queues[JobKind::Compare as usize].cancel();
        }
        let awaited = [JobKind::Order, JobKind::Region, JobKind::Bind, JobKind::Compare];
        let is_awaited = awaited.into_iter().any(|kind| self.queues[kind as usize].is_busy());
        if is_awaited || self.region_revision != self.problem_revision {
            return;
        }
        if self.computed.region.handles.is_empty() {
            return self.end_comparing();
        }
        if let Some(power) = comparison.missing_ordering(&self.computed) {
            if self.given_up[JobKind::Order as usize] == Some(self.model_revision) {
                comparison.stop(document);
            }
            self.want(JobKind::Order, |_| order_work(model, power));
        } else if let Some(work) =
            comparison.next_work(document, &self.computed, (self.allowance, self.executor.clock_ms()))
        {
            self.compare_revision = self.next_revision();
            self.queues[JobKind::Compare as usize].request(self.compare_revision, work);
        }
    }

    /// Stores a job's result; results for past states are dropped.
    pub(crate) fn accept(&mut self, done: JobDone) -> Arrival {
        let JobDone { kind, stamp, outcome } = done;
        let Some(running) = self.queues[kind as usize].finish(stamp) else {
            return Arrival::Nothing;
        };
        let wanted = stamp >= self.model_revision;
        if kind == JobKind::Compare {
            if let Some(comparison) = &mut self.comparison
                && !running.cancel.is_cancelled()
            {
                comparison.take(outcome);
            }
            return Arrival::Nothing;
        }
        match outcome {
            // Something else stopped it: requesting it again at once could go on for ever.
            JobOutcome::Cancelled if !running.cancel.is_cancelled() => self.given_up[kind as usize] = Some(stamp),
            JobOutcome::Failed(sentence) if wanted && !running.cancel.is_cancelled() => {
                self.given_up[kind as usize] = Some(stamp);
                if stamp == self.stamp(kind) {
                    return Arrival::Problem(sentence);
                }
            }
            JobOutcome::Pick(pickable) if wanted => {
                self.computed.pickable = Some(pickable);
                self.bvh_revision = stamp;
                return Arrival::Picking;
            }
            JobOutcome::Ordered(ordering) if stamp == self.model_revision => self.computed.orderings.push(ordering),
            JobOutcome::Region(region) if stamp == self.problem_revision => {
                self.computed.region = region;
                self.roles_revision = self.next_revision();
                self.region_revision = stamp;
            }
            JobOutcome::Bound(bound, inspectable) if stamp == self.problem_revision => {
                self.computed.inspectable = inspectable;
                let inspected = &mut self.computed.inspected;
                inspected.weights.take_if(|_| !inspectable.weights);
                inspected.base.take_if(|_| !inspectable.base);
                let handles = &self.computed.region.handles;
                self.computed.warnings = HandleWarning::list(bound.warnings(), handles);
                self.computed.blind_to.clear();
                self.computed.controls = BoundControls::of(&bound);
                self.controls_revision = Revision(0);
                self.computed.reusable_factor = bound.reusable_factor();
                self.computed.bound = Some(Arc::new(Mutex::new(*bound)));
                self.computed.carried = None;
                self.computed.example_weights.clear();
                self.bound_revision = stamp;
            }
            JobOutcome::Controls(places) if stamp >= self.solve_floor => self.put_controls(&places, stamp),
            JobOutcome::Inspected(inspected) if stamp >= self.inspect_floor => self.computed.inspected = inspected,
            JobOutcome::Joint(joint) if stamp > self.joint_floor => {
                self.computed.joint = joint;
                return Arrival::Joint;
            }
            JobOutcome::Intersections(found) if stamp == self.shape_revision => {
                self.computed.intersections = Some((stamp, found));
            }
            JobOutcome::Mirrored(image) if stamp == self.mirror_revision => return Arrival::Mirrored(image),
            JobOutcome::Symmetry(found) if stamp == self.symmetry_revision => return Arrival::Symmetry(found),
            JobOutcome::Enclosed(vertices) if stamp == self.enclose_revision => return Arrival::Enclosed(vertices),
            JobOutcome::Solved(solved) if stamp >= self.solve_floor => {
                let last = stamp == self.target_revision && solved.finished;
                if solved.carried.is_some() {
                    self.computed.carried.clone_from(&solved.carried);
                }
                self.computed.blind_to.clone_from(&solved.blind_to);
                self.computed.example_weights.clone_from(&solved.example_weights);
                if let Some(places) = &solved.controls {
                    self.put_controls(places, stamp);
                }
                return Arrival::Shape(solved, if last { Finality::Final } else { Finality::Preview });
            }
            _ => {}
        }
        Arrival::Nothing
    }

    /// The control points have arrived, with the targets of this revision.
    fn put_controls(&mut self, places: &ControlPlaces, stamp: Revision) {
        if let Some(controls) = &mut self.computed.controls
            && controls.positions.len() == places.positions.len()
        {
            controls.positions = Arc::clone(&places.positions);
            controls.attachment = controls.attachment.with_moved(Arc::clone(&places.moved));
            self.controls_revision = stamp;
        }
    }

    /// The revision for which a job of this kind would be made now.
    fn stamp(&self, kind: JobKind) -> Revision {
        match kind {
            JobKind::Pick | JobKind::Intersect => self.shape_revision,
            JobKind::Order => self.model_revision,
            JobKind::Region | JobKind::Bind => self.problem_revision,
            JobKind::Solve => self.target_revision,
            JobKind::Mirror => self.mirror_revision,
            JobKind::Symmetry => self.symmetry_revision,
            JobKind::Enclose => self.enclose_revision,
            JobKind::Compare => self.compare_revision,
            JobKind::Inspect => self.inspect_revision,
            JobKind::Joint => self.joint_revision,
        }
    }

    fn want(&mut self, kind: JobKind, work: impl FnOnce(&Computed) -> Option<Work>) {
        let stamp = self.stamp(kind);
        if self.queues[kind as usize].wants(stamp) || self.given_up[kind as usize] == Some(stamp) {
            return;
        }
        if let Some(work) = work(&self.computed) {
            self.queues[kind as usize].request(stamp, work);
        }
    }

    fn start(&mut self) {
        for kind in JobKind::ALL {
            if let Some((
                Running {
                    stamp,
                    progress,
                    cancel,
                },
                work,
            )) = self.queues[kind as usize].start_next()
            {
                let (job_progress, job_cancel) = (progress.clone(), cancel.clone());
                let work = Box::new(move || work(&job_progress, &job_cancel));
                self.executor.start(Job {
                    kind,
                    stamp,
                    progress,
                    cancel,
                    work,
                });
            }
        }
    }
}
