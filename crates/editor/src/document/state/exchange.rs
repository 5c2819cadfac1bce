//! The document's exchanges: it restores earlier states, and takes over another document's.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, Loose, Method};
use pliant_mesh::SurfaceVertex;

use super::{Document, Repainted};
use crate::document::access::Access;
use crate::document::content::{Content, Paint, Tips};
use crate::document::handle::Handle;
use crate::document::kept_shape::KeptShape;
use crate::document::sparse::Sparse;
use crate::document::version::Aspect;

impl Document {
    /// Restores the earlier state, versions included.
    pub(crate) fn go_back_to(&mut self, before: Self) {
        let is_same = |aspect| !self.versions().differ(before.versions(), aspect);
        let coloured = [Aspect::Paint, Aspect::Stiffness, Aspect::Fluid];
        if !coloured.into_iter().all(is_same) {
            self.repainted = Repainted::All;
        }
        self.marks.go_back_to(before.versions());
        self.content = before.content;
    }

    /// Replaces another document, of which nothing remains.
    pub(crate) fn replace(&mut self, mut by: Self) {
        by.marks.count_on_from(&self.marks);
        by.marks.mark(&Aspect::ALL);
        *self = by;
    }

    /// Exchanges everything with a document on another mesh.
    pub(in crate::document) fn swap_content(&mut self, content: &mut Content) {
        std::mem::swap(content, &mut self.content);
        self.repainted = Repainted::All;
        self.marks.mark(&Aspect::ALL);
    }

    pub(in crate::document) fn swap_kept(&mut self, kept: &mut Option<Arc<KeptShape>>) {
        std::mem::swap(kept, &mut self.content.kept);
        self.renew_corrections();
    }

    pub(in crate::document) fn swap_paint(&mut self, paint: &mut Sparse<Paint>) {
        paint.swap(Arc::make_mut(&mut self.content.paint).as_mut_slice());
        self.marks.mark(&[Aspect::Paint]);
        let vertices = paint.indices.iter().copied().map(SurfaceVertex);
        self.repainted.note(vertices, self.content.paint.len());
    }

    pub(in crate::document) fn swap_handles(&mut self, handles: &mut Vec<Handle>, next_handle: &mut u16) {
        std::mem::swap(handles, &mut self.content.handles);
        std::mem::swap(next_handle, &mut self.content.next_handle);
        self.mark_handles(handles);
    }

    /// `is_field` says whether the other state has a field at all: without one, it is 1 everywhere.
    pub(in crate::document) fn swap_stiffness(&mut self, stiffness: &mut Sparse<f64>, is_field: &mut bool) {
        let was_field = self.content.stiffness.is_some();
        let count = self.content.paint.len();
        let field = self.content.stiffness.get_or_insert_with(|| Arc::new(vec![1.0; count]));
        stiffness.swap(Arc::make_mut(field).as_mut_slice());
        if !*is_field {
            self.content.stiffness = None;
        }
        *is_field = was_field;
        self.marks.mark(&[Aspect::Stiffness]);
        let vertices = stiffness.indices.iter().copied().map(SurfaceVertex);
        self.repainted.note(vertices, count);
    }

    pub(in crate::document) fn swap_continuity(&mut self, continuity: &mut Option<Arc<Vec<f64>>>) {
        std::mem::swap(continuity, &mut self.content.continuity);
        self.marks.mark(&[Aspect::Continuity]);
    }

    pub(in crate::document) fn swap_options(
        &mut self,
        method: &mut Method,
        loose: &mut Loose,
        parts: &mut Arc<BTreeMap<u32, Loose>>,
    ) {
        let before = std::mem::replace(method, self.content.method.clone());
        self.set_method(before);
        let (former, former_parts) = (self.content.loose, Arc::clone(&self.content.loose_parts));
        self.set_loose(*loose, (**parts).clone());
        (*loose, *parts) = (former, former_parts);
    }

    /// Another rest shape is another problem; moved points are other targets.
    pub(in crate::document) fn swap_attachments(&mut self, attachments: &mut Arc<BTreeMap<&'static str, Attachment>>) {
        std::mem::swap(attachments, &mut self.content.attachments);
        let (before, after) = (&**attachments, &*self.content.attachments);
        let rest_alike = before.len() == after.len()
            && after
                .iter()
                .all(|(name, own)| before.get(name).is_some_and(|other| own.rests_as(other)));
        if !rest_alike {
            self.marks.mark(&[Aspect::Attachments]);
        }
        if before != after {
            self.marks.mark(&[Aspect::Targets]);
            self.content.strength = None;
        }
    }

    pub(in crate::document) fn swap_tips(&mut self, tips: &mut Tips) {
        std::mem::swap(tips, &mut self.content.tips);
        self.marks.mark(&[Aspect::Tips]);
    }

    pub(in crate::document) fn swap_rest(&mut self, rest: &mut Sparse<DVec3>, applied: &mut bool) {
        rest.swap(Arc::make_mut(&mut self.content.rest).as_mut_slice());
        std::mem::swap(applied, &mut self.content.applied);
        self.content.sum_shapes();
        self.marks.mark(&[Aspect::Rest, Aspect::Drawn]);
    }

    pub(in crate::document) fn swap_inside_out(&mut self, inside_out: &mut Arc<BTreeSet<u32>>) {
        std::mem::swap(inside_out, &mut self.content.inside_out);
        self.marks.mark(&[Aspect::InsideOut]);
    }

    pub(in crate::document) fn swap_access(&mut self, access: &mut Arc<Access>) {
        if self.content.access.locks() != access.locks() {
            self.marks.mark(&[Aspect::Locks]);
        }
        std::mem::swap(access, &mut self.content.access);
        self.marks.mark(&[Aspect::Access]);
    }

    pub(in crate::document) fn swap_settled(&mut self, settled: &mut bool) {
        std::mem::swap(settled, &mut self.content.settled);
        // Solves that ended earlier no longer apply.
        if *settled && !self.content.settled {
            self.marks.mark(&[Aspect::Targets]);
        }
    }

    pub(in crate::document) fn swap_shape(&mut self, shape: &mut Sparse<DVec3>) {
        shape.swap(Arc::make_mut(&mut self.content.from_rest).as_mut_slice());
        self.content.sum_shapes();
        self.renew_corrections();
        self.marks.mark(&[Aspect::Shape, Aspect::Drawn]);
    }
}
