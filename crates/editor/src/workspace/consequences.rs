//! What follows from an event: which revisions grow, and which jobs are asked for.
//!
//! No event says what it makes stale. The editor compares the document with the one that the present revisions belong
//! to; the long vectors are shared, so that a comparison of pointers tells whether they changed.

use std::sync::Arc;

use glam::DVec3;

use crate::document::{Document, Handle};
use crate::editor::Editor;
use crate::jobs::Activity;

impl Editor {
    /// Draws the conclusions from what an event changed: revisions grow, and jobs are asked for.
    pub(crate) fn conclude(&mut self) {
        let activity = self.tool.activity();
        self.refresh_masks();
        self.rest_if_undisplaced();
        let (known, document) = (&self.known, &self.document);
        let has_filed_paint = std::mem::take(&mut self.has_filed_paint);
        let is_painted_unsaid = !has_filed_paint && activity != Activity::Painting;
        let repainted =
            std::mem::take(&mut self.repainted) || (is_painted_unsaid && !Arc::ptr_eq(&known.paint, &document.paint));
        let recoloured = known.handles.len() != document.handles.len()
            || known
                .handles
                .iter()
                .zip(&document.handles)
                .any(|(a, b)| (a.id, a.colour, a.visible) != (b.id, b.colour, b.visible));
        let moved = !same(&known.handles, &document.handles, |a, b| a.affine() == b.affine());
        let reshaped = !Arc::ptr_eq(&known.from_file, &document.from_file);
        // While a stroke goes on the problem changes with every event; it counts once, at the end.
        let problem_changed = activity != Activity::Painting && is_other_problem(known, document);
        let unsettled_anew = known.settled && !document.settled;
        if problem_changed {
            self.engine.problem_changed();
            self.known = self.document.clone();
        } else if activity == Activity::Painting {
            // What the problem is known to be stays.
            self.known.from_file = Arc::clone(&self.document.from_file);
        } else {
            if moved || unsettled_anew {
                self.engine.targets_changed();
            }
            self.known = self.document.clone();
        }
        if reshaped {
            self.engine.shape_changed();
            self.shape_counter += 1;
        }
        if self.selected.is_some_and(|id| self.document.handle(id).is_none()) {
            self.selected = self.document.handles.last().map(|handle| handle.id);
        }
        let document = &self.document;
        self.companions
            .retain(|&id| document.handle(id).is_some() && self.selected != Some(id));
        self.engine.pump(&self.document, activity);
        // A stroke says itself what it recolours.
        let restiffened =
            activity != Activity::Painting && !same_field(&self.known_stiffness, &self.document.stiffness);
        let shows_stiffness = self.mode == crate::ToolMode::PaintStiffness;
        let reshown = std::mem::replace(&mut self.showed_stiffness, shows_stiffness) != shows_stiffness;
        if activity != Activity::Painting {
            self.known_stiffness.clone_from(&self.document.stiffness);
        }
        let reselected = std::mem::replace(&mut self.known_selected, self.selected) != self.selected;
        if reselected || recoloured || !Arc::ptr_eq(&self.known_roles, &self.engine.region.roles) {
            self.rims_revision += 1;
        }
        if restiffened
            || reshown
            || repainted
            || recoloured
            || !Arc::ptr_eq(&self.known_roles, &self.engine.region.roles)
        {
            self.known_roles = Arc::clone(&self.engine.region.roles);
            self.regions_revision += 1;
            self.recolouring.whole(self.regions_revision);
        } else if self.recolouring.is_pending() {
            self.regions_revision += 1;
            self.recolouring.part(self.regions_revision);
        }
        self.note_camera();
        if self.known_camera != self.camera {
            self.known_camera = self.camera;
            self.camera_revision += 1;
        }
    }

    /// Handles that all rest need no solve: the rest shape is known.
    fn rest_if_undisplaced(&mut self) {
        if self.document.settled || self.document.handles.iter().any(Handle::is_displaced) {
            return;
        }
        self.engine.drop_solves();
        let zero = vec![DVec3::ZERO; self.document.from_rest.len()];
        self.document.from_rest = Arc::new(zero);
        self.document.refresh_from_file();
        self.document.settled = true;
    }
}

/// Whether region and factorisation of one document are no good for the other.
pub(crate) fn is_other_problem(a: &Document, b: &Document) -> bool {
    !Arc::ptr_eq(&a.paint, &b.paint)
        || !Arc::ptr_eq(&a.rest, &b.rest)
        || a.applied != b.applied
        || !same_field(&a.stiffness, &b.stiffness)
        || !same_field(&a.continuity, &b.continuity)
        || a.method != b.method
        || a.loose != b.loose
        || a.loose_parts != b.loose_parts
        || a.access.locked != b.access.locked
        || !same(&a.handles, &b.handles, |a, b| {
            (a.id, a.reach, a.soft, a.continuity) == (b.id, b.reach, b.soft, b.continuity)
        })
}

fn same_field(a: &Option<Arc<Vec<f64>>>, b: &Option<Arc<Vec<f64>>>) -> bool {
    match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        _ => false,
    }
}

fn same(a: &[Handle], b: &[Handle], equal: impl Fn(&Handle, &Handle) -> bool) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| equal(a, b))
}
