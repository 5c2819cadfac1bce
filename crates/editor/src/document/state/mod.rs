//! What is saved and undone: the paint, the handles, the options, and the shape they have brought about.
//!
//! The [`Document`] holds what a person has said and what has come of it. What follows from it alone, and can be
//! computed again at any time (the region around the handles, the factorisation), is not in it.
//!
//! Everybody may read a document's [`Content`]; only the functions here change it, and each says what it has changed
//! ([`Versions`]), undo and redo included. Cloning is cheap: the long vectors are shared until one side changes.

mod exchange;
mod poses;
mod reloaded;
mod shapes;
mod strength;

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
use super::version::{Aspect, Marks, Versions};

/// The edited state of one mesh.
#[derive(Clone, Debug)]
pub struct Document {
    content: Content,
    marks: Marks,
    repainted: Repainted,
}

/// On which vertices paint or stiffness has changed since somebody asked.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Repainted {
    /// On these, with repeats.
    Vertices(Vec<SurfaceVertex>),
    /// Perhaps on all.
    All,
}

/// Above this share of the vertices all count as repainted: to tell so many apart costs more than it saves.
const MOST_TOLD: f64 = 0.125;

impl Repainted {
    /// Where to note `more` vertices, of `count` that there are; `None` where all count as repainted.
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

    /// Notes vertices, of `count` that there are.
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

/// What a document says of itself.
impl Document {
    /// A fresh document: everything is held still. It bends by ARAP, which turns and moves at once.
    pub fn new(vertex_count: usize) -> Self {
        Content::new(vertex_count).into()
    }

    /// What was painted on each surface vertex.
    pub fn paint(&self) -> &[Paint] {
        &self.content.paint
    }

    /// The handles, in the order in which they were made.
    pub fn handles(&self) -> &[Handle] {
        &self.content.handles
    }

    /// The handle with this number.
    pub fn handle(&self, id: HandleId) -> Option<&Handle> {
        self.content.handles.iter().find(|handle| handle.id == id)
    }

    /// Painted stiffness per surface vertex; `None` is 1 everywhere.
    pub fn stiffness(&self) -> Option<&[f64]> {
        self.content.stiffness.as_ref().map(|field| field.as_slice())
    }

    /// With which continuity the surface joins what holds it, per surface vertex; `None` is the highest everywhere.
    pub fn continuity(&self) -> Option<&[f64]> {
        self.content.continuity.as_ref().map(|field| field.as_slice())
    }

    /// The method and its options.
    pub fn method(&self) -> &Method {
        &self.content.method
    }

    /// What methods take beside handles, by the names that they declare.
    pub fn attachments(&self) -> &BTreeMap<&'static str, Attachment> {
        &self.content.attachments
    }

    /// What of that the present method takes.
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

    /// Whether an example that bends the surface is given a weight other than 0, or a control point was moved by hand.
    pub(crate) fn is_moved_without_handles(&self) -> bool {
        let mut weights = self.example_weights().iter().flatten();
        let are_weighed = self.content.method.examples_bend() && weights.any(|weight| *weight != 0.0);
        are_weighed || self.moved_controls().is_some()
    }

    /// Whether the method can move the surface without handles: by control points, which it makes where none were
    /// brought, or by examples.
    pub(crate) fn bends_without_handles(&self) -> bool {
        let mut declared = self.content.method.declaration().attachments.iter();
        let bends_by_examples = self.content.method.examples_bend() && self.examples().is_some();
        declared.any(|own| own.kind != AttachmentKind::Shapes) || bends_by_examples
    }

    /// Where its control points were moved to, if any of them was.
    pub fn moved_controls(&self) -> Option<&Arc<Vec<DVec3>>> {
        let (_, attachment) = self.attachment()?;
        let moved = attachment.moved()?;
        (**moved != self.content.method.control_rest(attachment)).then_some(moved)
    }

    /// Whether the parts that a reach cuts off from the body come along.
    pub fn tips(&self) -> Tips {
        self.content.tips
    }

    /// What components that nothing holds do.
    pub fn loose(&self) -> Loose {
        self.content.loose
    }

    /// What single components do that nothing holds, in place of [`Document::loose`].
    pub fn loose_parts(&self) -> &BTreeMap<u32, Loose> {
        &self.content.loose_parts
    }

    /// The continuity per surface vertex, with that of handles which say one of their own; `None` is the highest
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

    /// What of the file is hidden and locked.
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

    /// The present shape's displacements from the file's shape, per surface vertex: what is drawn.
    pub fn from_file(&self) -> &Arc<Vec<DVec3>> {
        &self.content.from_file
    }

    /// What was seen when what holds the surface changed last, from which the next drag begins; `None` where the shape is
    /// the one that the handles mean.
    pub fn kept(&self) -> Option<&KeptShape> {
        self.content.kept.as_deref()
    }

    /// Whether a shape was applied, so that the rest shape is another than the file's.
    pub fn is_applied(&self) -> bool {
        self.content.applied
    }

    /// Whether the shape is final for the handles' transforms.
    pub fn is_settled(&self) -> bool {
        self.content.settled
    }

    /// Whether the present shape is another than the rest shape.
    pub fn is_displaced(&self) -> bool {
        !self.content.settled || self.content.kept.is_some() || self.is_moved()
    }

    /// Whether a handle or a control point is elsewhere than where it rests.
    pub(crate) fn is_moved(&self) -> bool {
        self.content.handles.iter().any(Handle::is_displaced) || self.is_moved_without_handles()
    }

    /// Which state of each aspect this is.
    pub(crate) fn versions(&self) -> &Versions {
        self.marks.versions()
    }

    /// The vertices whose paint or stiffness changed since this was asked last.
    pub(crate) fn take_repainted(&mut self) -> Repainted {
        std::mem::take(&mut self.repainted)
    }
}

/// What is painted.
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

    /// Takes all paint and every handle away.
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

    /// Changes the stiffness of some vertices, those that `change` gives back.
    pub(crate) fn stiffen(&mut self, change: impl FnOnce(&mut [f64]) -> Vec<SurfaceVertex>) {
        let count = self.content.paint.len();
        let field = self.content.stiffness.get_or_insert_with(|| Arc::new(vec![1.0; count]));
        let changed = change(Arc::make_mut(field).as_mut_slice());
        self.marks.mark(&[Aspect::Stiffness]);
        self.repainted.note(changed.into_iter(), count);
    }

    /// Forgets a field of stiffness that is 1 everywhere. Where `before` had none, nothing has changed.
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

    /// Takes away the handles that were made since `before`; their numbers are given again.
    pub(crate) fn drop_handles_made_since(&mut self, before: &Self) {
        self.change_handles(|handles| handles.retain(|handle| before.handle(handle.id).is_some()));
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

    /// Changes one handle; `None` if it is gone.
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

    /// Marks what about the handles is another than `before`.
    fn mark_handles(&mut self, before: &[Handle]) {
        let after = &self.content.handles;
        if before == after {
            return;
        }
        self.forget_strength_unless_handles_stay(before);
        let after = &self.content.handles;
        let mut changed = vec![Aspect::Handles];
        if !are_same(before, after, |h| (h.id, h.reach, h.soft, h.continuity)) {
            changed.push(Aspect::Constraints);
        }
        if !are_same(before, after, Handle::affine) {
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
                // Other points and weights count now, or the same with other rests.
                self.forget_strength();
            }
            self.marks.mark(&[Aspect::Method]);
        }
    }

    /// Puts what methods take beside handles in the place of what there is.
    pub(crate) fn set_attachments(&mut self, mut attachments: Arc<BTreeMap<&'static str, Attachment>>) {
        self.swap_attachments(&mut attachments);
    }

    /// Chooses whether tips come along.
    pub(crate) fn set_tips(&mut self, mut tips: Tips) {
        if self.content.tips != tips {
            self.swap_tips(&mut tips);
        }
    }

    /// Chooses what loose parts do: all, and single ones in place of that.
    pub(crate) fn set_loose(&mut self, loose: Loose, parts: BTreeMap<u32, Loose>) {
        if self.content.loose != loose || *self.content.loose_parts != parts {
            (self.content.loose, self.content.loose_parts) = (loose, Arc::new(parts));
            self.marks.mark(&[Aspect::Loose]);
        }
    }

    /// Chooses which parts are turned inside out.
    pub(crate) fn set_inside_out(&mut self, mut inside_out: Arc<BTreeSet<u32>>) {
        if self.content.inside_out != inside_out {
            self.swap_inside_out(&mut inside_out);
        }
    }

    /// Chooses what is hidden and locked.
    pub(crate) fn set_access(&mut self, mut access: Arc<Access>) {
        self.swap_access(&mut access);
    }
}

fn are_same<K: PartialEq>(a: &[Handle], b: &[Handle], key: impl Fn(&Handle) -> K) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| key(a) == key(b))
}
