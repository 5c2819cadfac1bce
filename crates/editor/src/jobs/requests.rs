//! The jobs that a person or a tool asks for, one by one: mirror images, symmetry, outlines, joints, comparisons, looks
//! into the binding and intersections. The scheduler starts them with the others.

use std::sync::Arc;

use crate::region::FoundLimb;
use glam::DVec3;

use super::comparison::Comparison;
use super::flowed::{FlowRequest, flow_work};
use super::frame_skins::{FrameSkin, FrameSkinSource, frame_skins_work};
use super::inspected::Asked;
use super::inspection::inspect_work;
use super::scheduler::Jobs;
use super::skinned::Skin;
use super::skins::{SkinSource, skins_work};
use super::slot::{Slot, Work};
use super::table::Slots;
use super::work::intersect_work;
use crate::document::Document;
use crate::revision::Revision;

impl Jobs {
    /// Requests a job that a person has asked for, in place of an earlier one.
    pub(crate) fn ask<T>(&mut self, slot: fn(&mut Slots) -> &mut Slot<T>, work: Work<T>) {
        self.stop_asking(slot);
        slot(&mut self.computed.slots).request(work);
    }

    /// The job that a person has asked for is no longer wanted.
    pub(crate) fn stop_asking<T>(&mut self, slot: fn(&mut Slots) -> &mut Slot<T>) {
        let revision = self.next_revision();
        slot(&mut self.computed.slots).renew(revision);
    }

    /// The candidate of the joint that is wanted, if the joint under a triangle of the present shape has not been
    /// requested yet; `is_chain` if all joints of the limb are wanted.
    pub(crate) fn asks_for_joint(&self, triangle: u32, is_chain: bool) -> Option<i32> {
        let wanted = (self.shape_revision(), triangle, self.joint_up, is_chain);
        (self.joint_asked != Some(wanted)).then_some(self.joint_up)
    }

    /// Wants the candidate that is so many places farther from the limb's tip than the shown joint, or the guess again.
    pub(crate) fn want_joint(&mut self, places: Option<i32>) {
        let shown = self.computed.joint().map_or(self.joint_up, |joint| joint.up);
        self.joint_up = places.map_or(0, |places| shown + places);
    }

    /// Requests the joint under a triangle of the present shape. The running search continues, so that a steadily
    /// moving pointer still shows joints; the newest request waits.
    pub(crate) fn look_for_joint(&mut self, triangle: u32, is_chain: bool, work: Work<Option<FoundLimb>>) {
        let shape = self.shape_revision();
        if self
            .joint_asked
            .is_some_and(|(asked, .., chain)| (asked, chain) != (shape, is_chain))
        {
            self.forget_joint();
        }
        self.joint_asked = Some((shape, triangle, self.joint_up, is_chain));
        let revision = self.next_revision();
        self.computed.slots.joint.follow(revision);
        self.computed.slots.joint.request(work);
    }

    /// A joint is no longer wanted.
    pub(crate) fn forget_joint(&mut self) {
        self.joint_up = 0;
        if self.joint_asked.take().is_some() {
            self.stop_asking(|slots| &mut slots.joint);
            self.computed.slots.joint.take();
        }
    }

    /// Requests a step of the flow; none must be under way.
    pub(crate) fn flow(&mut self, request: FlowRequest) {
        let (revision, allowance) = (self.next_revision(), self.allowance);
        self.computed.slots.flow.follow(revision);
        self.computed.slots.flow.request(flow_work(request, allowance));
    }

    /// Requests the shapes of these moments around the shown one, each with its place and its time in seconds, unless they are known or under way. The running job
    /// continues, so that they follow a drag; the newest request waits.
    pub(crate) fn follow_skins(&mut self, moments: Vec<(i8, f64)>, document: &Document) {
        if !self.is_bound() {
            return;
        }
        let source = SkinSource::of(moments, document, self.computed.slots.bind.made());
        if self.skin_source.as_ref() == Some(&source) {
            return;
        }
        if let Some(work) = skins_work(&self.computed, document, source.moments(), self.allowance) {
            self.skin_source = Some(source);
            let revision = self.next_revision();
            self.computed.slots.skins.follow(revision);
            self.computed.slots.skins.request(work);
        }
    }

    /// Returns true if the ghosts in these frames of a sequence, with all handles followed or not, are neither known nor
    /// under way.
    pub(crate) fn wants_frame_skins(&self, frames: &[(i8, usize)], knows_way: bool, document: &Document) -> bool {
        let source = FrameSkinSource::of(frames.to_vec(), knows_way, document);
        self.is_region_current() && self.frame_skin_source.as_ref() != Some(&source)
    }

    /// Requests the ghosts in these frames of a sequence. The last ones stay until the new ones are solved.
    pub(crate) fn follow_frame_skins(
        &mut self,
        (frames, knows_way): (Vec<(i8, usize)>, bool),
        skins: Vec<FrameSkin>,
        document: &Document,
    ) {
        if let Some(work) = frame_skins_work(&self.computed, document, skins, self.allowance) {
            self.frame_skin_source = Some(FrameSkinSource::of(frames, knows_way, document));
            let revision = self.next_revision();
            self.computed.slots.skins.renew(revision);
            self.computed.slots.skins.request(work);
        }
    }

    /// Stops the ghosts of a sequence that are under way; the last ones stay.
    pub(crate) fn pause_skins(&mut self) {
        if !self.computed.slots.skins.is_current() && self.frame_skin_source.take().is_some() {
            self.stop_asking(|slots| &mut slots.skins);
        }
    }

    /// The shapes of other moments are no longer wanted.
    pub(crate) fn forget_skins(&mut self) {
        let had_frames = self.frame_skin_source.take().is_some();
        if self.skin_source.take().is_some() || had_frames {
            self.stop_asking(|slots| &mut slots.skins);
            self.computed.slots.skins.take();
        }
    }

    /// The shapes of other moments that were solved last.
    pub(crate) fn skins(&self) -> &[Skin] {
        self.computed.slots.skins.last().map_or(&[], |skinned| &skinned.skins)
    }

    /// The time in milliseconds since some moment, for the speed of a stroke; constant in an executor that does not
    /// measure.
    pub(crate) fn now_ms(&self) -> f64 {
        self.executor.clock_ms()()
    }

    /// Begins a comparison of the methods on the edit.
    pub(crate) fn begin_comparing(&mut self, document: &Document) {
        self.comparison = Some(Comparison::new(document));
        // A new request also needs the ordering that was stopped before.
        self.computed.slots.order.try_again();
    }

    /// Ends the comparison; the methods' bindings are dropped.
    pub(crate) fn end_comparing(&mut self) {
        self.comparison = None;
        self.stop_asking(|slots| &mut slots.compare);
    }

    /// Requests the shown parts of the present binding, unless they are known or under way. If only the targets differ,
    /// the running job continues, so that the base visibly bends during a drag; the newest request waits.
    pub(crate) fn inspect(&mut self, asked: Asked, document: &Document) {
        let has_binding = self.binds_something(document) && !self.computed.slots.bind.has_given_up();
        let asked = if has_binding { asked } else { Asked::default() };
        let targets = match asked.base {
            true => self.computed.slots.solve.wanted(),
            false => Revision(0),
        };
        let bound_revision = self.computed.slots.bind.made();
        let wanted = (bound_revision, asked, targets);
        if self.inspection == wanted || !(self.is_bound() || asked == Asked::default()) {
            return;
        }
        let (bound, before, _) = std::mem::replace(&mut self.inspection, wanted);
        let revision = self.next_revision();
        let work = inspect_work(&self.computed, document, asked).filter(|_| asked != Asked::default());
        let slot = &mut self.computed.slots.inspect;
        if (bound, before) == (bound_revision, asked) {
            slot.follow(revision);
        } else {
            slot.renew(revision);
        }
        match work {
            Some(work) => slot.request(work),
            None => drop(slot.take()),
        }
    }

    /// Requests the places where the present shape, `displacements` away from the file's, passes through itself, once
    /// its hierarchy exists.
    pub(crate) fn intersect(&mut self, displacements: &Arc<Vec<DVec3>>) {
        let Some(model) = self.computed.model.clone() else {
            return;
        };
        if self.is_picking_current() && !self.computed.slots.intersect.is_current() {
            self.want(
                |slots| &mut slots.intersect,
                |computed| intersect_work(computed, &model, displacements),
            );
        }
    }
}
