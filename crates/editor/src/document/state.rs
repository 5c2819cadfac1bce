//! What is saved and undone: the paint, the handles, the options, and the shape they have brought about.
//!
//! The [`Document`] holds what a person has said and what has come of it. What follows from it alone, and can be
//! computed again at any time (the region around the handles, the factorisation), is not in it.
//!
//! Everybody may read a document's [`Content`]; only the functions here change it, and each says what it has changed
//! ([`Versions`]), undo and redo included. Cloning is cheap: the long vectors are shared until one side changes.

use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Arap, CONTINUITY_RANGE, Loose, Method};
use pliant_mesh::SurfaceVertex;

use super::access::Access;
use super::handle::{Handle, HandleId};
use super::handle_transform::HandleTransform;
use super::sparse::Sparse;
use super::version::{Aspect, Marks, Versions};

/// What was painted on a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Paint {
    /// Nothing: free where a handle reaches, held still elsewhere.
    #[default]
    Bare,
    /// Held still, whatever reaches it.
    Fixed,
    /// Free to bend.
    Free,
    /// A part of a handle.
    Handle(HandleId),
}

/// What a document holds. Every vector has one element per surface vertex.
#[derive(Clone, Debug)]
pub struct Content {
    pub(crate) paint: Arc<Vec<Paint>>,
    pub(crate) handles: Vec<Handle>,
    /// The next handle's number.
    pub(crate) next_handle: u16,
    /// Painted stiffness; `None` is 1 everywhere.
    pub(crate) stiffness: Option<Arc<Vec<f64>>>,
    /// With which continuity the surface joins what holds it; `None` is the highest everywhere.
    pub(crate) continuity: Option<Arc<Vec<f64>>>,
    pub(crate) method: Method,
    pub(crate) loose: Loose,
    /// What single parts do that nothing holds, by their component's number, in place of `loose`.
    pub(crate) loose_parts: Arc<BTreeMap<u32, Loose>>,
    /// What is hidden and locked.
    pub(crate) access: Arc<Access>,
    /// The rest shape's displacements from the file's.
    pub(crate) rest: Arc<Vec<DVec3>>,
    /// Whether a shape was applied: without, `rest` is zero.
    pub(crate) applied: bool,
    /// The present shape's displacements from the rest shape.
    pub(crate) from_rest: Arc<Vec<DVec3>>,
    /// The sum of both, what is drawn: follows from them.
    pub(crate) from_file: Arc<Vec<DVec3>>,
    /// Whether `from_rest` is final for the handles' transforms.
    pub(crate) settled: bool,
}

impl Content {
    /// What a fresh document holds: everything is held still. It bends by ARAP, which turns and moves at once.
    pub(crate) fn new(vertex_count: usize) -> Self {
        let zero = Arc::new(vec![DVec3::ZERO; vertex_count]);
        Self {
            paint: Arc::new(vec![Paint::Bare; vertex_count]),
            handles: Vec::new(),
            next_handle: 0,
            stiffness: None,
            continuity: None,
            method: Method::Arap(Arap::default()),
            loose: Loose::default(),
            loose_parts: Arc::default(),
            access: Arc::default(),
            rest: Arc::clone(&zero),
            applied: false,
            from_rest: Arc::clone(&zero),
            from_file: zero,
            settled: true,
        }
    }

    fn sum_shapes(&mut self) {
        self.from_file = sum_of_shapes(self.applied.then_some(&self.rest), &self.from_rest);
    }
}

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
        !self.content.settled || self.content.handles.iter().any(Handle::is_displaced)
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
    pub(crate) fn paint_vertices(&mut self, changes: impl IntoIterator<Item = (SurfaceVertex, Paint)>) {
        let mut changes = changes.into_iter().peekable();
        if changes.peek().is_none() {
            return;
        }
        self.marks.mark(&[Aspect::Paint]);
        let painted = Arc::make_mut(&mut self.content.paint);
        for (vertex, paint) in changes {
            painted[vertex.index()] = paint;
            note(&mut self.repainted, [vertex]);
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
        note(&mut self.repainted, changed);
    }

    /// Forgets a field of stiffness that is 1 everywhere.
    pub(crate) fn drop_plain_stiffness(&mut self) {
        let field = self.content.stiffness.as_ref();
        if field.is_some_and(|field| field.iter().all(|&value| value == 1.0)) {
            self.content.stiffness = None;
            self.marks.mark(&[Aspect::Stiffness]);
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
            for aspect in [Aspect::Handles, Aspect::Holds, Aspect::Targets, Aspect::Appearance] {
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
        let mut changed = vec![Aspect::Handles];
        if !are_same(before, after, |h| (h.id, h.reach, h.soft, h.continuity)) {
            changed.push(Aspect::Holds);
        }
        if !are_same(before, after, Handle::affine) {
            changed.push(Aspect::Targets);
        }
        if !are_same(before, after, |h| (h.id, h.colour, h.visible)) {
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
            self.marks.mark(&[Aspect::Method]);
        }
    }

    /// Chooses what loose parts do: all, and single ones in place of that.
    pub(crate) fn set_loose(&mut self, loose: Loose, parts: BTreeMap<u32, Loose>) {
        if self.content.loose != loose || *self.content.loose_parts != parts {
            (self.content.loose, self.content.loose_parts) = (loose, Arc::new(parts));
            self.marks.mark(&[Aspect::Loose]);
        }
    }

    /// Chooses what is hidden and locked.
    pub(crate) fn set_access(&mut self, mut access: Arc<Access>) {
        self.swap_access(&mut access);
    }
}

/// The shapes.
impl Document {
    /// Makes the present shape the rest shape. No drawn vertex moves; the handles' pivots go along.
    pub(crate) fn apply_shape(&mut self) {
        if !self.is_displaced() {
            return;
        }
        let content = &mut self.content;
        content.rest = Arc::clone(&content.from_file);
        content.applied = true;
        content.from_rest = Arc::new(vec![DVec3::ZERO; content.rest.len()]);
        content.settled = true;
        self.marks.mark(&[Aspect::Rest, Aspect::Shape]);
        self.change_handles(|handles| {
            for handle in handles {
                handle.pivot = handle.centre();
                handle.put(HandleTransform::IDENTITY);
            }
        });
    }

    /// Shows a shape that the handles have brought about; `from_file` is its sum with the rest shape.
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

    /// Shows the rest shape, which is final.
    pub(crate) fn unbend(&mut self) {
        self.bend(vec![DVec3::ZERO; self.content.from_rest.len()]);
        self.settle();
    }

    /// Takes the rest shape and the present one back to the file's; handles stay where they are put.
    pub(crate) fn forget_shapes(&mut self) {
        let content = &mut self.content;
        content.applied = false;
        content.rest = Arc::new(vec![DVec3::ZERO; content.paint.len()]);
        content.from_rest = Arc::clone(&content.rest);
        content.from_file = Arc::clone(&content.rest);
        content.settled = true;
        self.marks.mark(&[Aspect::Rest, Aspect::Shape, Aspect::Drawn]);
    }

    /// Takes some vertices of the rest shape back to the file's.
    pub(crate) fn forget_rest_at(&mut self, is_taken: &[bool]) {
        let rest = Arc::make_mut(&mut self.content.rest);
        for (displacement, _) in rest.iter_mut().zip(is_taken).filter(|(_, taken)| **taken) {
            *displacement = DVec3::ZERO;
        }
        self.content.sum_shapes();
        self.marks.mark(&[Aspect::Rest, Aspect::Drawn]);
    }

    /// The shape is final for the handles' transforms.
    pub(crate) fn settle(&mut self) {
        self.content.settled = true;
    }

    /// The shape is not final: there is something to be solved.
    pub(crate) fn unsettle(&mut self) {
        self.swap_settled(&mut false);
    }

    /// The same, if any handle is elsewhere than where it rests.
    pub(crate) fn unsettle_if_displaced(&mut self) {
        if self.is_displaced() {
            self.unsettle();
        }
    }
}

/// Taking back, and taking over.
impl Document {
    /// Takes everything back to how it was, versions included.
    pub(crate) fn go_back_to(&mut self, before: Self) {
        let is_same = |aspect| !self.versions().differ(before.versions(), aspect);
        if !(is_same(Aspect::Paint) && is_same(Aspect::Stiffness)) {
            self.repainted = Repainted::All;
        }
        self.marks.go_back_to(before.versions());
        self.content = before.content;
    }

    /// Takes the place of another document, of which nothing remains.
    pub(crate) fn replace(&mut self, mut by: Self) {
        by.marks.count_on_from(&self.marks);
        by.marks.mark(&Aspect::ALL);
        *self = by;
    }

    /// Takes over what another document has, but for the method. `known` are its versions when that was done last. The
    /// shape stays what this document's method has made, as long as the rest shape does, and is to be solved anew.
    pub(crate) fn follow(&mut self, leader: &Self, known: Option<&Versions>, method: &Method) {
        let is_new = |aspect| known.is_none_or(|known| leader.versions().differ(known, aspect));
        let is_own = |aspect| matches!(aspect, Aspect::Method | Aspect::Shape | Aspect::Drawn);
        let theirs = Aspect::ALL
            .into_iter()
            .filter(|&aspect| !is_own(aspect) && is_new(aspect));
        let mut changed: Vec<Aspect> = theirs.collect();
        if self.content.method != *method {
            changed.push(Aspect::Method);
        }
        let own = std::mem::replace(&mut self.content, leader.content.clone());
        self.content.method = method.clone();
        if is_new(Aspect::Rest) {
            self.content.sum_shapes();
            changed.extend([Aspect::Shape, Aspect::Drawn]);
        } else {
            (self.content.from_rest, self.content.from_file) = (own.from_rest, own.from_file);
        }
        self.marks.mark(&changed);
        self.repainted = Repainted::All;
        self.content.settled = true;
        self.unsettle();
    }

    pub(super) fn swap_paint(&mut self, paint: &mut Sparse<Paint>) {
        paint.swap(Arc::make_mut(&mut self.content.paint).as_mut_slice());
        self.marks.mark(&[Aspect::Paint]);
        note(&mut self.repainted, paint.indices.iter().copied().map(SurfaceVertex));
    }

    pub(super) fn swap_handles(&mut self, handles: &mut Vec<Handle>, next_handle: &mut u16) {
        std::mem::swap(handles, &mut self.content.handles);
        std::mem::swap(next_handle, &mut self.content.next_handle);
        self.mark_handles(handles);
    }

    /// `is_field` tells whether there is a field at all on the other side: without, it is 1 everywhere.
    pub(super) fn swap_stiffness(&mut self, stiffness: &mut Sparse<f64>, is_field: &mut bool) {
        let was_field = self.content.stiffness.is_some();
        let count = self.content.paint.len();
        let field = self.content.stiffness.get_or_insert_with(|| Arc::new(vec![1.0; count]));
        stiffness.swap(Arc::make_mut(field).as_mut_slice());
        if !*is_field {
            self.content.stiffness = None;
        }
        *is_field = was_field;
        self.marks.mark(&[Aspect::Stiffness]);
        note(
            &mut self.repainted,
            stiffness.indices.iter().copied().map(SurfaceVertex),
        );
    }

    pub(super) fn swap_continuity(&mut self, continuity: &mut Option<Arc<Vec<f64>>>) {
        std::mem::swap(continuity, &mut self.content.continuity);
        self.marks.mark(&[Aspect::Continuity]);
    }

    pub(super) fn swap_options(
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

    pub(super) fn swap_rest(&mut self, rest: &mut Sparse<DVec3>, applied: &mut bool) {
        rest.swap(Arc::make_mut(&mut self.content.rest).as_mut_slice());
        std::mem::swap(applied, &mut self.content.applied);
        self.content.sum_shapes();
        self.marks.mark(&[Aspect::Rest, Aspect::Drawn]);
    }

    pub(super) fn swap_access(&mut self, access: &mut Arc<Access>) {
        if self.content.access.locked != access.locked {
            self.marks.mark(&[Aspect::Locks]);
        }
        std::mem::swap(access, &mut self.content.access);
        self.marks.mark(&[Aspect::Access]);
    }

    pub(super) fn swap_settled(&mut self, settled: &mut bool) {
        std::mem::swap(settled, &mut self.content.settled);
        // Solves that ended before are no answer any more.
        if *settled && !self.content.settled {
            self.marks.mark(&[Aspect::Targets]);
        }
    }

    pub(super) fn swap_shape(&mut self, shape: &mut Sparse<DVec3>) {
        shape.swap(Arc::make_mut(&mut self.content.from_rest).as_mut_slice());
        self.content.sum_shapes();
        self.marks.mark(&[Aspect::Shape, Aspect::Drawn]);
    }
}

/// Above so many vertices all count as repainted: to tell them apart would cost more than it saves.
const MOST_TOLD: usize = 1 << 19;

fn note(repainted: &mut Repainted, vertices: impl IntoIterator<Item = SurfaceVertex>) {
    if let Repainted::Vertices(told) = repainted {
        told.extend(vertices);
        if told.len() > MOST_TOLD {
            *repainted = Repainted::All;
        }
    }
}

fn are_same<K: PartialEq>(a: &[Handle], b: &[Handle], key: impl Fn(&Handle) -> K) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| key(a) == key(b))
}

/// What is drawn: the rest shape's displacements, if there are any, plus those from it.
///
/// Where nothing is added the bits of the rest shape stay, so that applying a shape moves nothing.
pub(crate) fn sum_of_shapes(rest: Option<&Arc<Vec<DVec3>>>, from_rest: &Arc<Vec<DVec3>>) -> Arc<Vec<DVec3>> {
    match rest {
        None => Arc::clone(from_rest),
        Some(rest) => Arc::new(
            rest.iter()
                .zip(from_rest.iter())
                .map(|(&rest, &more)| if more == DVec3::ZERO { rest } else { rest + more })
                .collect(),
        ),
    }
}
