//! The consequences of an event: the growing revisions, and the requested jobs.
//!
//! The versions of the document's aspects record its changes. Data that follow from some aspects are renewed when these
//! differ from their sources; the code that makes a change need not know its consequences.

use super::colour_revisions::{ColouredBy, Sources};
use super::crease_width::measure_crease;
use super::state::Workspace;
use super::symmetry::take_symmetry;
use crate::document::{Aspect, Paint, VertexAccess};
use crate::jobs::{Activity, Arrival, Asked, Finality, JobKind, Solved};

impl Workspace {
    /// Computes the consequences of an event's changes: revisions grow, and jobs are requested.
    pub(crate) fn conclude(&mut self, activity: Activity, coloured_by: ColouredBy, asked: Asked) {
        self.renew_vertex_access();
        self.settle_what_needs_no_solve();
        self.follow_versions(activity);
        self.look_for_paint(activity);
        self.selection.drop_lost(&self.document);
        measure_crease(self);
        self.drop_lost_keys();
        if !self.controls.is_empty() {
            let count = self.shown_controls().map_or(0, |shown| shown.positions.len());
            self.controls.drop_lost(count);
        }
        self.jobs.inspect(asked, &self.document);
        let is_at_rest = activity == Activity::Still && self.document.is_settled();
        let is_bent = self.document.is_displaced() || self.document.is_applied();
        // Frames of a sequence may touch themselves: that is no fault of the edit.
        if is_at_rest && is_bent && self.document.animation().frames().is_none() {
            self.jobs.intersect(&self.document.from_file);
        }
        self.jobs.pump(&self.document, activity);
        let versions = self.document.versions();
        let sources = Sources {
            appearance: versions.of(Aspect::Appearance),
            access: versions.of(Aspect::Access),
            roles: self.jobs.roles_revision,
            by: coloured_by,
            flow: self.flow.revision(),
            selected: self.selection.selected(),
        };
        self.colours.follow(sources, self.document.take_repainted());
    }

    /// Computes whether anything is painted, once for each version of the paint, because commands ask at every frame.
    fn look_for_paint(&mut self, activity: Activity) {
        let version = self.document.versions().of(Aspect::Paint);
        if activity != Activity::Painting && self.painted.1 != version {
            let is_painted = self.document.paint().iter().any(|paint| *paint != Paint::Bare);
            self.painted = (is_painted, version);
        }
    }

    /// Reports changes to the jobs. During a stroke the problem changes with every event; this counts once, at the end,
    /// and not at all if the stroke was aborted.
    fn follow_versions(&mut self, activity: Activity) {
        let versions = *self.document.versions();
        let seen = std::mem::replace(&mut self.seen, versions);
        if activity == Activity::Painting {
            self.seen = seen;
            self.seen.take(&versions, Aspect::Drawn);
        } else if versions.are_other_problem(&seen) {
            self.jobs.problem_changed();
        } else if versions.differ(&seen, Aspect::Targets) {
            self.jobs.targets_changed();
        }
        if versions.differ(&seen, Aspect::Drawn) {
            self.jobs.shape_changed();
            self.shape_revision += 1;
        }
    }

    /// Handles and control points that all rest need no solve: the rest shape is known. Nor is a solve needed if all
    /// handles are on locked parts: the visible shape stays.
    fn settle_what_needs_no_solve(&mut self) {
        if self.document.is_settled() {
            return;
        }
        if self.document.kept.is_none() && !self.document.is_moved() {
            self.jobs.drop_solves();
            self.document.unbend();
        } else if self.jobs.is_region_current()
            // The known region is not that of a handle that was made just now.
            && !self.document.versions().are_other_problem(&self.seen)
            && self.computed().region.handles.is_empty()
            && !self.document.is_moved_without_handles()
        {
            self.jobs.drop_solves();
            self.document.keep_shape();
        }
    }

    /// The hidden and locked parts, triangle by triangle.
    fn renew_vertex_access(&mut self) {
        let Some(model) = self.model() else { return };
        let of = (self.jobs.model_revision(), self.document.versions().of(Aspect::Access));
        if self.vertex_access_of == Some(of) {
            return;
        }
        let had = self.vertex_access.triangles.is_some();
        self.vertex_access = VertexAccess::of(self.document.access(), model);
        self.vertex_access_of = Some(of);
        if had || self.vertex_access.triangles.is_some() {
            self.jobs.show_triangles(self.vertex_access.triangles.clone());
        }
    }

    /// Stores a job's result; returns its kind if that may be for a gesture or for a waiting action.
    pub(crate) fn take_arrival(&mut self, arrival: Arrival) -> Option<JobKind> {
        match arrival {
            Arrival::Nothing => {}
            Arrival::Problem(sentence) => self.refuse(sentence),
            Arrival::Shape(solved, finality) => self.take_shape(solved, finality),
            Arrival::Result(JobKind::Symmetry) => take_symmetry(self),
            Arrival::Result(kind) => return Some(kind),
        }
        None
    }

    fn take_shape(&mut self, solved: Solved, finality: Finality) {
        if self.document.is_settled() || solved.from_rest.len() != self.document.from_rest.len() {
            return;
        }
        self.descent = solved.descent;
        if solved.from_rest != self.document.from_rest {
            self.history.reshaped();
        }
        if let Some(carried) = solved.carried {
            self.document.see_corrections(carried.corrections);
        }
        self.document.show(solved.from_rest, solved.from_file);
        if finality == Finality::Final {
            let handles = self.document.handles().to_vec();
            let has_held = self.document.hold_free_points(&solved.point_slides);
            if self.document.slide_handles(&solved.slides) || has_held {
                self.history.slid(&handles, self.document.next_handle);
            }
            self.document.settle();
        }
    }
}
