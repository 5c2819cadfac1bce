//! The saved and undone state: the paint, the handles, the options, and the resulting shape.
//!
//! The [`Document`] has a person's input and the result. Data that follow from it alone, and can be recomputed at any
//! time (the region around the handles, the factorisation), are not in it.
//!
//! All code may read a document's [`Content`]; only the functions here change it, and each records its change
//! ([`Versions`]), undo and redo included. Cloning is cheap: the long vectors are shared until one side changes.

mod animation;
mod exchange;
mod fluid;
mod frames;
mod freedom;
mod poses;
mod reloaded;
mod shapes;
mod strength;
mod work_pose;

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Deref;
use std::sync::Arc;

use pliant_deform::{Attachment, AttachmentKind, CONTINUITY_RANGE, Examples, Loose, Method};
use pliant_mesh::SurfaceVertex;

use glam::DVec3;

use super::access::Access;
use super::content::{Content, Paint, Tips};
use super::handle::{Handle, HandleId};
use super::kept_shape::KeptShape;
use super::parents::{find_parents_anew, is_within};
use super::version::{Aspect, Marks, Versions};

/// The edited state of one mesh.
#[derive(Clone, Debug)]
pub struct Document {
    content: Content,
    marks: Marks,
    repainted: Repainted,
}

/// The vertices whose paint or stiffness has changed since the last query.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Repainted {
    /// These vertices, with repeats.
    Vertices(Vec<SurfaceVertex>),
    /// Perhaps all.
    All,
}

/// Above this share of the vertices all count as repainted: distinguishing so many costs more than it saves.
const MOST_TOLD: f64 = 0.125;

impl Repainted {
    /// The list for `more` vertices, of `count` in all; `None` if all count as repainted.
    fn room_for(&mut self, more: usize, count: usize) -> Option<&mut Vec<SurfaceVertex>> {
        if let Self::Vertices(told) = self
            && (told.len() + more) as f64 > MOST_TOLD * count as f64
        {
            *self = Self::All;
        }
        match self {
            Self::Vertices(told) => {
                told.reserve(more);
                Some(told)
            }
            Self::All => None,
        }
    }

    /// Notes vertices, of `count` in all.
    fn note(&mut self, vertices: impl ExactSizeIterator<Item = SurfaceVertex>, count: usize) {
        if let Some(told) = self.room_for(vertices.len(), count) {
            told.extend(vertices);
        }
    }
}

impl Default for Repainted {
    fn default() -> Self {
        Self::Vertices(Vec::new())
    }
}

impl Deref for Document {
    type Target = Content;

    fn deref(&self) -> &Content {
        &self.content
    }
}

impl From<Content> for Document {
    fn from(mut content: Content) -> Self {
        content.sum_shapes();
        content.corrections = content.kept.as_ref().and_then(|kept| kept.corrections.clone());
        Self {
            content,
            marks: Marks::default(),
            repainted: Repainted::All,
        }
    }
}

/// The document's description of itself.
impl Document {
    /// A fresh document: everything is fixed. It bends by ARAP, which turns and moves at once.
    pub fn new(vertex_count: usize) -> Self {
        Content::new(vertex_count).into()
    }

    /// The paint of each surface vertex.
    pub fn paint(&self) -> &[Paint] {
        &self.content.paint
    }

    /// The handles, in the order of their making.
    pub fn handles(&self) -> &[Handle] {
        &self.content.handles
    }

    /// The handle with this number.
    pub fn handle(&self, id: HandleId) -> Option<&Handle> {
        self.content.handles.iter().find(|handle| handle.id == id)
    }

    /// The handles with which this one can ride along: neither itself nor its descendants, and no pins.
    pub fn possible_parents(&self, id: HandleId) -> impl Iterator<Item = &Handle> {
        let handles = &self.content.handles;
        handles
            .iter()
            .filter(move |other| !other.is_pin && !is_within(handles, other.id, id))
    }

    /// Painted stiffness per surface vertex; `None` is 1 everywhere.
    pub fn stiffness(&self) -> Option<&[f64]> {
        self.content.stiffness.as_ref().map(|field| field.as_slice())
    }

    /// The continuity with which the surface joins constrained vertices, per surface vertex; `None` is the highest
    /// everywhere.
    pub fn continuity(&self) -> Option<&[f64]> {
        self.content.continuity.as_ref().map(|field| field.as_slice())
    }

    /// The method and its options.
    pub fn method(&self) -> &Method {
        &self.content.method
    }

    /// The declared name of the method's examples, if it takes some.
    pub(crate) fn examples_name(&self) -> Option<&'static str> {
        let mut declared = self.method.declaration().attachments.iter();
        declared
            .find(|own| own.kind == AttachmentKind::Shapes)
            .map(|own| own.name)
    }

    /// The methods' inputs beside handles.
    pub fn attachments(&self) -> &BTreeMap<&'static str, Attachment> {
        &self.content.attachments
    }

    /// The inputs of the present method.
    pub fn attachment(&self) -> Option<(&'static str, &Attachment)> {
        let declared = self.content.method.declaration();
        let mut attachments = self.content.attachments.iter();
        let (name, attachment) = attachments.find(|(name, _)| declared.attachment(name).is_some())?;
        Some((name, attachment))
    }

    /// The examples of the present method, if there are some.
    pub fn examples(&self) -> Option<&Examples> {
        match self.attachment()? {
            (_, Attachment::Shapes(examples)) => Some(examples),
            _ => None,
        }
    }

    /// Their weights; none without examples.
    pub(crate) fn example_weights(&self) -> &[Option<f64>] {
        self.examples().map_or(&[], |examples| &examples.weights)
    }

    /// Returns true if an example that bends the surface has a weight other than 0, or a control point was moved by
    /// hand.
    pub(crate) fn is_moved_without_handles(&self) -> bool {
        let mut weights = self.example_weights().iter().flatten();
        let are_weighed = self.content.method.examples_bend() && weights.any(|weight| *weight != 0.0);
        are_weighed || self.moved_controls().is_some()
    }

    /// Returns true if the method can move the surface without handles: by control points, which it makes if none were
    /// brought, or by examples.
    pub(crate) fn bends_without_handles(&self) -> bool {
        let mut declared = self.content.method.declaration().attachments.iter();
        let bends_by_examples = self.content.method.examples_bend() && self.examples().is_some();
        declared.any(|own| own.kind != AttachmentKind::Shapes) || bends_by_examples
    }

    /// The moved positions of its control points, if any of them was moved.
    pub fn moved_controls(&self) -> Option<&Arc<Vec<DVec3>>> {
        let (_, attachment) = self.attachment()?;
        let moved = attachment.moved()?;
        (**moved != self.content.method.control_rest(attachment)).then_some(moved)
    }

    /// The state of the tips: free or fixed.
    pub fn tips(&self) -> Tips {
        self.content.tips
    }

    /// The behaviour of components that nothing holds.
    pub fn loose(&self) -> Loose {
        self.content.loose
    }

    /// The behaviour of single components that nothing holds, instead of [`Document::loose`].
    pub fn loose_parts(&self) -> &BTreeMap<u32, Loose> {
        &self.content.loose_parts
    }

    /// The continuity per surface vertex, with the own continuity of handles that have one; `None` is the highest
    /// everywhere.
    pub fn joints(&self) -> Option<Vec<f64>> {
        let handles = self.content.handles.iter();
        let own: BTreeMap<HandleId, f64> = handles
            .filter_map(|handle| Some((handle.id, handle.continuity?)))
            .collect();
        let painted = self.content.continuity.as_ref();
        if own.is_empty() {
            return painted.map(|field| field.to_vec());
        }
        let highest = *CONTINUITY_RANGE.end();
        let joint = |(vertex, paint): (usize, &Paint)| match paint {
            Paint::Handle(id) if own.contains_key(id) => own[id],
            _ => painted.map_or(highest, |field| field[vertex]),
        };
        Some(self.content.paint.iter().enumerate().map(joint).collect())
    }

    /// The connected parts that are turned inside out, by their numbers.
    pub fn inside_out(&self) -> &Arc<BTreeSet<u32>> {
        &self.content.inside_out
    }

    /// The file's hidden and locked parts.
    pub fn access(&self) -> &Access {
        &self.content.access
    }

    /// The rest shape's displacements from the file's shape, per surface vertex.
    pub fn rest(&self) -> &[DVec3] {
        &self.content.rest
    }

    /// The present shape's displacements from the rest shape, per surface vertex.
    pub fn from_rest(&self) -> &[DVec3] {
        &self.content.from_rest
    }

    /// The present shape's displacements from the file's shape, per surface vertex, which are drawn.
    pub fn from_file(&self) -> &Arc<Vec<DVec3>> {
        &self.content.from_file
    }

    /// The shape at the last change of the constraints, from which the next drag begins; `None` if the shape is the
    /// solution for the handles.
    pub fn kept(&self) -> Option<&KeptShape> {
        self.content.kept.as_deref()
    }

    /// Returns true if a shape was applied, so that the rest shape differs from the file's.
    pub fn is_applied(&self) -> bool {
        self.content.applied
    }

    /// Returns true if the shape is final for the handles' transforms.
    pub fn is_settled(&self) -> bool {
        self.content.settled
    }

    /// Returns true if the present shape differs from the rest shape.
    pub fn is_displaced(&self) -> bool {
        !self.content.settled || self.content.kept.is_some() || self.is_moved()
    }

    /// Returns true if a handle or a control point is away from its rest position.
    pub(crate) fn is_moved(&self) -> bool {
        self.content.handles.iter().any(Handle::is_displaced) || self.is_moved_without_handles()
    }

    /// The version of each aspect.
    pub(crate) fn versions(&self) -> &Versions {
        self.marks.versions()
    }

    /// The vertices whose paint or stiffness changed since the last call.
    pub(crate) fn take_repainted(&mut self) -> Repainted {
        std::mem::take(&mut self.repainted)
    }
}

/// Paint.
impl Document {
    /// Paints vertices.
    pub(crate) fn paint_vertices(
        &mut self,
        changes: impl IntoIterator<Item = (SurfaceVertex, Paint), IntoIter: ExactSizeIterator>,
    ) {
        let changes = changes.into_iter();
        if changes.len() == 0 {
            return;
        }
        self.marks.mark(&[Aspect::Paint]);
        let painted = Arc::make_mut(&mut self.content.paint);
        let mut told = self.repainted.room_for(changes.len(), painted.len());
        for (vertex, paint) in changes {
            painted[vertex.index()] = paint;
            if let Some(told) = &mut told {
                told.push(vertex);
            }
        }
    }

    /// Removes all paint and every handle.
    pub(crate) fn clear_paint(&mut self) {
        self.marks.mark(&[Aspect::Paint]);
        self.repainted = Repainted::All;
        self.content.paint = Arc::new(vec![Paint::Bare; self.content.paint.len()]);
        self.change_handles(Vec::clear);
    }

    /// Sets the stiffness of every vertex; `None` is 1 everywhere.
    pub(crate) fn set_stiffness(&mut self, stiffness: Option<Vec<f64>>) {
        self.marks.mark(&[Aspect::Stiffness]);
        self.repainted = Repainted::All;
        self.content.stiffness = stiffness.map(Arc::new);
    }

    /// Changes the stiffness of some vertices, those that `change` returns.
    pub(crate) fn stiffen(&mut self, change: impl FnOnce(&mut [f64]) -> Vec<SurfaceVertex>) {
        let count = self.content.paint.len();
        let field = self.content.stiffness.get_or_insert_with(|| Arc::new(vec![1.0; count]));
        let changed = change(Arc::make_mut(field).as_mut_slice());
        self.marks.mark(&[Aspect::Stiffness]);
        self.repainted.note(changed.into_iter(), count);
    }

    /// Forgets a field of stiffness that is 1 everywhere. If `before` had none, nothing has changed.
    pub(crate) fn drop_plain_stiffness(&mut self, before: &Self) {
        let field = self.content.stiffness.as_ref();
        if !field.is_some_and(|field| field.iter().all(|&value| value == 1.0)) {
            return;
        }
        self.content.stiffness = None;
        match before.content.stiffness {
            None => self.marks.go_back(before.versions(), Aspect::Stiffness),
            Some(_) => self.marks.mark(&[Aspect::Stiffness]),
        }
    }
}

/// The handles.
impl Document {
    /// A new handle without vertices, the last of the list.
    pub(crate) fn add_handle(&mut self) -> HandleId {
        let id = HandleId(self.content.next_handle);
        self.content.next_handle = self.content.next_handle.saturating_add(1);
        let name = format!("handle {}", u32::from(id.0) + 1);
        self.change_handles(|handles| handles.push(Handle::new(id, name)));
        id
    }

    /// Removes the handles that were made since `before`; their numbers are used again.
    pub(crate) fn drop_handles_made_since(&mut self, before: &Self) {
        self.change_handles(|handles| {
            let former = handles.clone();
            handles.retain(|handle| before.handle(handle.id).is_some());
            find_parents_anew(handles, &former);
        });
        self.content.next_handle = before.content.next_handle;
        if self.content.handles == before.content.handles {
            for aspect in [
                Aspect::Handles,
                Aspect::Constraints,
                Aspect::Targets,
                Aspect::Appearance,
            ] {
                self.marks.go_back(before.versions(), aspect);
            }
        }
    }

    /// Changes one handle; `None` if it no longer exists.
    pub(crate) fn change_handle<R>(&mut self, id: HandleId, change: impl FnOnce(&mut Handle) -> R) -> Option<R> {
        self.change_handles(|handles| handles.iter_mut().find(|handle| handle.id == id).map(change))
    }

    /// Changes the list of handles.
    pub(crate) fn change_handles<R>(&mut self, change: impl FnOnce(&mut Vec<Handle>) -> R) -> R {
        let before = self.content.handles.clone();
        let result = change(&mut self.content.handles);
        self.mark_handles(&before);
        result
    }

    /// Marks the aspects of the handles that differ from `before`.
    fn mark_handles(&mut self, before: &[Handle]) {
        let after = &self.content.handles;
        if before == after {
            return;
        }
        self.forget_strength_unless_handles_stay(before);
        let after = &self.content.handles;
        let mut changed = vec![Aspect::Handles];
        if !are_same(before, after, |h| (h.id, h.reach, h.twin, h.soft, h.continuity))
            || !before
                .iter()
                .zip(after)
                .all(|(before, after)| before.line_binds_as(after))
        {
            changed.push(Aspect::Constraints);
        }
        if !are_same(before, after, |h| {
            (h.affine(), h.line.clone(), h.freedom(), h.held.clone())
        }) {
            changed.push(Aspect::Targets);
        }
        if !are_same(before, after, |h| (h.id, h.colour, h.visible, h.is_pin)) {
            changed.push(Aspect::Appearance);
        }
        self.marks.mark(&changed);
    }
}

/// Options and access.
impl Document {
    /// Chooses the method and its options.
    pub(crate) fn set_method(&mut self, method: Method) {
        if self.content.method != method {
            self.content.method = method;
            if !self.content.attachments.is_empty() {
                // Other points and weights apply now, or the same with other rest positions.
                self.forget_strength();
            }
            self.marks.mark(&[Aspect::Method]);
        }
    }

    /// Replaces the methods' inputs beside handles.
    pub(crate) fn set_attachments(&mut self, mut attachments: Arc<BTreeMap<&'static str, Attachment>>) {
        self.swap_attachments(&mut attachments);
    }

    /// Chooses whether tips are free.
    pub(crate) fn set_tips(&mut self, mut tips: Tips) {
        if self.content.tips != tips {
            self.swap_tips(&mut tips);
        }
    }

    /// Chooses the behaviour of loose parts: of all, and of single ones instead.
    pub(crate) fn set_loose(&mut self, loose: Loose, parts: BTreeMap<u32, Loose>) {
        if self.content.loose != loose || *self.content.loose_parts != parts {
            (self.content.loose, self.content.loose_parts) = (loose, Arc::new(parts));
            self.marks.mark(&[Aspect::Loose]);
        }
    }

    /// Chooses the parts that are turned inside out.
    pub(crate) fn set_inside_out(&mut self, mut inside_out: Arc<BTreeSet<u32>>) {
        if self.content.inside_out != inside_out {
            self.swap_inside_out(&mut inside_out);
        }
    }

    /// Chooses the hidden and locked parts.
    pub(crate) fn set_access(&mut self, mut access: Arc<Access>) {
        self.swap_access(&mut access);
    }
}

fn are_same<K: PartialEq>(a: &[Handle], b: &[Handle], key: impl Fn(&Handle) -> K) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| key(a) == key(b))
}
