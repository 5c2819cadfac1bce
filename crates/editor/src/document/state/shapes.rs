//! The changes of the shapes: the rest shape, and the present one over it.

use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, Examples, Solve};

use super::Document;
use crate::document::kept_shape::KeptShape;
use crate::document::version::Aspect;

impl Document {
    /// Makes the present shape the rest shape. No drawn vertex moves; the handles' pivots move with the shape. Cages
    /// and lattices fitted the former one and are removed; examples keep their shapes, with the weight 0.
    pub(crate) fn apply_shape(&mut self) {
        if !self.is_displaced() {
            return;
        }
        let content = &mut self.content;
        let before = Arc::clone(&content.rest);
        content.strength = None;
        content.rest = Arc::clone(&content.from_file);
        content.applied = true;
        content.from_rest = Arc::new(vec![DVec3::ZERO; content.rest.len()]);
        content.kept = None;
        content.corrections = None;
        content.settled = true;
        self.marks.mark(&[Aspect::Rest, Aspect::Shape]);
        let mut attachments = Arc::clone(&self.content.attachments);
        Arc::make_mut(&mut attachments).retain(|_, own| matches!(own, Attachment::Shapes(_)));
        self.set_attachments(attachments);
        self.rest_examples();
        self.rebase_examples(&before);
        let handles = self.content.handles.clone();
        if !self.content.poses.is_empty() {
            self.change_poses(|poses| poses.iter_mut().for_each(|pose| pose.rebase(&handles)));
        }
        self.content.animation.rebase(&handles);
        self.change_handles(|handles| {
            for handle in handles {
                handle.apply();
            }
        });
    }

    /// Keeps the visible shape before a change of the constraints: handles keep their transforms, and the next drag
    /// begins from the visible shape.
    pub(crate) fn keep_shape(&mut self) {
        if !self.is_displaced() {
            return;
        }
        self.content.settled = true;
        if !self.shows_kept_shape() {
            self.content.kept = Some(Arc::new(self.seen()));
        }
    }

    /// The visible shape, with the positions of handles, control points and examples.
    pub(super) fn seen(&self) -> KeptShape {
        let controls = self.moved_controls().cloned();
        let content = &self.content;
        KeptShape::of(
            &content.handles,
            controls,
            self.example_weights(),
            &content.from_rest,
            content.corrections.as_ref(),
        )
    }

    /// Returns true if the kept shape is the visible one, with everything in the same places.
    fn shows_kept_shape(&self) -> bool {
        let (controls, weights, content) = (self.moved_controls(), self.example_weights(), &self.content);
        let is_seen = |kept: &Arc<KeptShape>| {
            kept.is_of(
                &content.handles,
                controls.map(|own| &**own),
                weights,
                &content.from_rest,
                content.corrections.as_ref(),
            )
        };
        content.kept.as_ref().is_some_and(is_seen)
    }

    /// Returns true if handles and method alone may not lead back to the visible shape: the end of a descent can depend
    /// on its path.
    pub(crate) fn depends_on_way(&self) -> bool {
        self.content.settled && self.is_moved() && self.content.method.solve() != Solve::Direct
    }

    /// The shape from which a solve without knowledge of the path continues: the visible one if it [depends on the
    /// way](Self::depends_on_way), else the kept one.
    pub(crate) fn to_go_on_from(&self) -> Option<Arc<KeptShape>> {
        match &self.content.kept {
            _ if self.depends_on_way() && !self.shows_kept_shape() => Some(Arc::new(self.seen())),
            kept => kept.clone(),
        }
    }

    /// Returns true if opening a project makes the kept shape again ([`Self::keep_way`]).
    pub(crate) fn keeps_way_alone(&self) -> bool {
        self.depends_on_way() && self.shows_kept_shape()
    }

    /// Keeps the visible shape if it depends on the path, so that the next drag begins from it.
    pub(crate) fn keep_way(&mut self) {
        if self.depends_on_way() {
            self.keep_shape();
        }
    }

    /// Changes the present shape, displacements from the rest shape, by hand. It is kept: the next drag begins from it.
    pub(crate) fn correct(&mut self, change: impl FnOnce(&mut [DVec3])) {
        let before = Arc::clone(&self.content.from_rest);
        let mut from_rest = before.to_vec();
        change(&mut from_rest);
        self.bend(from_rest);
        let content = &mut self.content;
        content.settled = true;
        let none = || Arc::new(vec![DVec3::ZERO; before.len()]);
        let corrections = Arc::make_mut(content.corrections.get_or_insert_with(none));
        for ((correction, after), before) in corrections.iter_mut().zip(&*content.from_rest).zip(&*before) {
            *correction += *after - *before;
        }
        self.content.kept = Some(Arc::new(self.seen()));
    }

    /// Notes the corrections by hand that a solve has left.
    pub(crate) fn see_corrections(&mut self, left: Option<Arc<Vec<DVec3>>>) {
        self.content.corrections = left;
    }

    /// The corrections are those of the kept shape, as long as no solve changes them.
    pub(in crate::document) fn renew_corrections(&mut self) {
        let kept = self.content.kept.as_ref();
        self.content.corrections = kept.and_then(|kept| kept.corrections.clone());
    }

    /// Shows the handles' solution; `from_file` is its sum with the rest shape.
    pub(crate) fn show(&mut self, from_rest: Arc<Vec<DVec3>>, from_file: Arc<Vec<DVec3>>) {
        (self.content.from_rest, self.content.from_file) = (from_rest, from_file);
        self.marks.mark(&[Aspect::Shape, Aspect::Drawn]);
    }

    /// Shows a shape by its displacements from the rest shape.
    pub(crate) fn bend(&mut self, from_rest: Vec<DVec3>) {
        self.content.from_rest = Arc::new(from_rest);
        self.content.sum_shapes();
        self.marks.mark(&[Aspect::Shape, Aspect::Drawn]);
    }

    /// Shows an earlier shape, to continue from it.
    pub(crate) fn go_on_from(&mut self, kept: KeptShape) {
        self.bend(kept.shape.to_vec());
        self.content.kept = Some(Arc::new(kept));
        self.renew_corrections();
        if !self.content.handles.is_empty() {
            self.unsettle();
        }
    }

    /// Shows the rest shape, which is final.
    pub(crate) fn unbend(&mut self) {
        self.bend(vec![DVec3::ZERO; self.content.from_rest.len()]);
        self.content.corrections = None;
        self.settle();
    }

    /// Takes the rest shape and the present one back to the file's; handles keep their transforms.
    pub(crate) fn forget_shapes(&mut self) {
        let content = &mut self.content;
        let before = Arc::clone(&content.rest);
        content.strength = None;
        content.applied = false;
        content.rest = Arc::new(vec![DVec3::ZERO; content.paint.len()]);
        content.from_rest = Arc::clone(&content.rest);
        content.from_file = Arc::clone(&content.rest);
        content.kept = None;
        content.corrections = None;
        content.settled = true;
        self.marks.mark(&[Aspect::Rest, Aspect::Shape, Aspect::Drawn]);
        self.rebase_examples(&before);
    }

    /// Takes some vertices back to the file's shape, in the rest shape and the present one; the others keep their
    /// visible positions.
    pub(crate) fn forget_shape_at(&mut self, is_taken: &[bool]) {
        let content = &mut self.content;
        let before = Arc::clone(&content.rest);
        let corrections = content.corrections.as_mut();
        for field in [&mut content.rest, &mut content.from_rest]
            .into_iter()
            .chain(corrections)
        {
            for (displacement, _) in Arc::make_mut(field)
                .iter_mut()
                .zip(is_taken)
                .filter(|(_, taken)| **taken)
            {
                *displacement = DVec3::ZERO;
            }
        }
        content.kept = None;
        content.settled = true;
        content.sum_shapes();
        self.marks.mark(&[Aspect::Rest, Aspect::Shape, Aspect::Drawn]);
        self.rebase_examples(&before);
        if self
            .content
            .from_rest
            .iter()
            .any(|displacement| *displacement != DVec3::ZERO)
        {
            self.content.kept = Some(Arc::new(self.seen()));
        }
    }

    /// Marks the shape as final for the handles' transforms.
    pub(crate) fn settle(&mut self) {
        self.content.settled = true;
    }

    /// Marks the shape as not final: a solve is needed.
    pub(crate) fn unsettle(&mut self) {
        self.swap_settled(&mut false);
    }

    /// Sets the weight of every example with a set weight to 0.
    pub(crate) fn rest_examples(&mut self) {
        if !self.content.method.examples_bend() {
            return;
        }
        self.change_examples(|examples| {
            examples.weights.iter_mut().flatten().for_each(|weight| *weight = 0.0);
        });
    }

    /// Keeps the examples' shapes after a change of the rest shape, whose displacements from the file's were these
    /// before.
    fn rebase_examples(&mut self, before: &Arc<Vec<DVec3>>) {
        let now = Arc::clone(&self.content.rest);
        if Arc::ptr_eq(before, &now) || before == &now {
            return;
        }
        self.change_examples(|examples| {
            for shape in Arc::make_mut(&mut examples.shapes) {
                let displacements = Arc::make_mut(&mut shape.displacements).iter_mut();
                for ((own, before), now) in displacements.zip(&**before).zip(&*now) {
                    *own += *before - *now;
                }
            }
        });
    }

    fn change_examples(&mut self, mut change: impl FnMut(&mut Examples)) {
        let mut attachments = Arc::clone(&self.content.attachments);
        if attachments.values().any(|own| matches!(own, Attachment::Shapes(_))) {
            for own in Arc::make_mut(&mut attachments).values_mut() {
                if let Attachment::Shapes(examples) = own {
                    change(examples);
                }
            }
            self.set_attachments(attachments);
        }
    }

    /// Marks the shape as not final if any handle is away from its rest position. The solution is computed from the
    /// rest shape alone, and corrections by hand are added to it.
    pub(crate) fn unsettle_if_displaced(&mut self) {
        if self.is_displaced() {
            let kept = self.content.kept.take();
            self.content.kept = kept.and_then(|kept| kept.for_another_solution()).map(Arc::new);
            self.unsettle();
        }
    }
}
