//! Undo and redo by deltas: each step has the other state of its changes, and swaps it with the document.
//!
//! A step has one copy of each changed value: the old ones while it is done, the new ones while it is undone. So undo
//! and redo are the same exchange, and restore every bit.
//!
//! The shape is special: it may arrive after the commit of the step that requested it (a drag whose last solve is still
//! running, a surface that catches up with an early drag). The history therefore remembers the shape to which its
//! deltas are relative, and [`History::sync`] re-bases the two neighbouring steps onto the shown one.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, ExampleShape, Loose, Method};
use pliant_mesh::Model;

use super::access::Access;
use super::animation::Animation;
use super::content::{Content, Paint, Tips, WorkPose};
use super::fluid::FlowOptions;
use super::handle::{Handle, HandleId};
use super::kept_shape::KeptShape;
use super::packed_fluid::PackedFluid;
use super::pose::{Placed, Pose};
use super::saved::{SaveMark, Saved, SavedAs};
use super::sparse::Sparse;
use super::state::Document;
use super::strength::{Stance, Strength};
use super::version::{Aspect, Version};

/// The bytes of deltas that are kept before the oldest steps are forgotten.
pub const HISTORY_BYTES: usize = 256 << 20;

/// A changed part of the document: the values of its other state.
#[derive(Clone, Debug)]
pub(crate) enum Change {
    /// Painted vertices.
    Paint(Sparse<Paint>),
    /// The list of handles and the next one's number.
    Handles(Vec<Handle>, u16),
    /// The stiffness at some vertices, and whether there is a field at all: without one, it is 1 everywhere.
    Stiffness(Sparse<f64>, bool),
    /// The continuity field.
    Continuity(Option<Arc<Vec<f64>>>),
    /// Method and loose components.
    Options(Method, Loose, Arc<BTreeMap<u32, Loose>>),
    /// The methods' inputs beside handles.
    Attachments(Arc<BTreeMap<&'static str, Attachment>>),
    /// The rest shape, and whether it differs from the file's.
    Rest(Sparse<DVec3>, bool),
    /// The state of the tips: free or fixed.
    Tips(Tips),
    /// The parts that are turned inside out.
    InsideOut(Arc<BTreeSet<u32>>),
    /// The hidden and locked parts.
    Access(Arc<Access>),
    /// The shape at the last change of the constraints.
    Kept(Option<Arc<KeptShape>>),
    /// True if the shape is final for the handles' transforms.
    Settled(bool),
    /// The full values of which handles and attachments are a share.
    Strength(Option<Arc<Strength>>),
    /// The kept poses.
    Poses(Arc<Vec<Pose>>),
    /// The edit over time.
    Animation(Animation),
    /// The state to which a work pose returns.
    WorkPose(Option<Arc<WorkPose>>),
    /// The fluid on the surface.
    Fluid(PackedFluid),
    /// The forces in its flow.
    FlowOptions(FlowOptions),
    /// Another mesh, with the whole document on it. It is alone in its step, which has no shape of its own.
    Mesh(Box<OtherMesh>),
}

/// A mesh, and the document on it.
#[derive(Clone, Debug)]
pub(crate) struct OtherMesh {
    pub(crate) model: Arc<Model>,
    pub(crate) content: Content,
}

impl OtherMesh {
    /// About its memory.
    fn bytes(&self) -> usize {
        /// Position, normal, shapes, paint and neighbours of a vertex, and its drawn vertex.
        const OF_VERTEX: usize = 240;
        /// Corners and neighbours of a triangle, and its drawn triangle.
        const OF_TRIANGLE: usize = 48;
        let surface = &self.model.surface;
        surface.positions.len() * OF_VERTEX + surface.triangles.len() * OF_TRIANGLE
    }
}

/// A named step.
#[derive(Clone, Debug)]
struct Step {
    name: String,
    /// The state of the document after it.
    state: u64,
    changes: Vec<Change>,
    /// The shape on the other side, relative to [`History::shape`] if the step is a neighbour of the present.
    shape: Sparse<DVec3>,
}

impl Step {
    /// The mesh on its other side, if that is another one.
    fn other_mesh(&self) -> Option<&OtherMesh> {
        match &self.changes[..] {
            [Change::Mesh(other)] => Some(other),
            _ => None,
        }
    }

    fn bytes(&self) -> usize {
        let changes: usize = self
            .changes
            .iter()
            .map(|change| match change {
                Change::Paint(sparse) => sparse.bytes(),
                Change::Rest(sparse, _) => sparse.bytes(),
                Change::Stiffness(sparse, _) => sparse.bytes(),
                Change::Continuity(Some(field)) => field.len() * size_of::<f64>(),
                Change::Handles(handles, _) => handles.len() * size_of::<Handle>(),
                Change::InsideOut(parts) => size_of::<Change>() + parts.len() * size_of::<u32>(),
                Change::Access(access) => {
                    size_of::<Access>() + (access.hidden.len() + access.locked.len()) * size_of::<u32>()
                }
                Change::Mesh(other) => other.bytes(),
                // Tables that steps share are counted in each.
                Change::Attachments(attachments) => attachments.values().map(attachment_bytes).sum(),
                Change::Kept(Some(kept)) => {
                    let corrections = kept.corrections.as_ref().map_or(0, |corrections| corrections.len());
                    (kept.shape.len() + corrections) * size_of::<DVec3>()
                }
                Change::Strength(Some(strength)) => {
                    let attachments: usize = strength.attachments.values().map(attachment_bytes).sum();
                    attachments + strength.handles.len() * size_of::<(HandleId, Stance)>()
                }
                Change::Poses(poses) => {
                    let of_handles = |pose: &Pose| pose.handles.len() * size_of::<(HandleId, Placed)>();
                    let of_points = |pose: &Pose| pose.controls.values().map(|points| points.len()).sum::<usize>();
                    let of_pose = |pose| size_of::<Pose>() + of_handles(pose) + of_points(pose) * size_of::<DVec3>();
                    poses.iter().map(of_pose).sum()
                }
                Change::Animation(animation) => size_of::<Change>() + animation.bytes(),
                Change::WorkPose(Some(work)) => {
                    // Its content shares the long vectors with the document until these change.
                    let corrected = work.corrected.as_ref().map_or(0, |corrected| corrected.len());
                    size_of::<WorkPose>() + (work.before.from_rest.len() + corrected) * size_of::<DVec3>()
                }
                Change::Fluid(fluid) => fluid.bytes(),
                Change::Kept(None)
                | Change::Strength(None)
                | Change::WorkPose(None)
                | Change::Continuity(None)
                | Change::Options(..)
                | Change::Tips(_)
                | Change::FlowOptions(_)
                | Change::Settled(_) => size_of::<Change>(),
            })
            .sum();
        size_of::<Self>() + self.name.len() + changes + self.shape.bytes()
    }
}

/// The memory of an attachment. Examples share their shapes from step to step, so each holder counts its share of them.
fn attachment_bytes(attachment: &Attachment) -> usize {
    let of_shape = |shape: &ExampleShape| {
        shape.name.len() + shape.displacements.len() * size_of::<DVec3>() / Arc::strong_count(&shape.displacements)
    };
    match attachment {
        Attachment::Shapes(examples) => {
            let shapes: usize = examples.shapes.iter().map(of_shape).sum();
            shapes / Arc::strong_count(&examples.shapes) + size_of_val(&*examples.weights)
        }
        other => 2 * other.point_count() * size_of::<DVec3>(),
    }
}

/// The steps before and after the present.
#[derive(Clone, Debug)]
pub struct History {
    done: VecDeque<Step>,
    undone: Vec<Step>,
    /// The present mesh; `None` before the first file.
    mesh: Option<Arc<Model>>,
    /// The shape to which the neighbouring steps' deltas are relative.
    shape: Arc<Vec<DVec3>>,
    /// That shape's version of the document's shape.
    shape_version: Version,
    cap_bytes: usize,
    /// The state before the oldest step.
    oldest: u64,
    /// The number of states so far: each has its own number.
    states: u64,
    /// The states that files have.
    saved: Saved,
    /// Grows with every step that is made, undone or redone.
    revision: u64,
}

impl History {
    /// An empty history of a document on a mesh.
    pub(crate) fn new(document: &Document, mesh: Option<Arc<Model>>, cap_bytes: usize) -> Self {
        Self {
            done: VecDeque::new(),
            undone: Vec::new(),
            mesh,
            shape: Arc::clone(&document.from_rest),
            shape_version: document.versions().of(Aspect::Shape),
            cap_bytes,
            oldest: 0,
            states: 1,
            saved: Saved::opened(0),
            revision: 0,
        }
    }

    /// The name of the step that undo takes back.
    pub fn undo_name(&self) -> Option<&str> {
        self.done.back().map(|step| step.name.as_str())
    }

    /// The name of the step that redo makes again.
    pub fn redo_name(&self) -> Option<&str> {
        self.undone.last().map(|step| step.name.as_str())
    }

    /// The names of all steps, oldest first, and the number of those that are done.
    pub fn names(&self) -> (Vec<&str>, usize) {
        let undone = self.undone.iter().rev();
        (
            self.done.iter().chain(undone).map(|step| step.name.as_str()).collect(),
            self.done.len(),
        )
    }

    /// The bytes of the deltas.
    pub fn bytes(&self) -> usize {
        self.done.iter().chain(&self.undone).map(Step::bytes).sum()
    }

    /// Returns true if the document differs from the saved one: the project, if there is one, else the model.
    pub fn is_unsaved(&self) -> bool {
        !self.saved.has(self.state())
    }

    /// The present state and shape, for a save that begins now; `is_final` if no other shape can arrive for it.
    pub(crate) fn mark(&self, document: &Document, is_final: bool) -> SaveMark {
        SaveMark {
            state: self.state(),
            shape: document.versions().of(Aspect::Shape),
            is_final,
        }
    }

    /// Notes that a file was written with the state of the mark.
    pub(crate) fn mark_saved(&mut self, what: SavedAs, mark: SaveMark, document: &Document) {
        let now = (self.state(), document.versions().of(Aspect::Shape));
        self.saved.written(what, mark, now);
    }

    /// Notes that the document comes from such a file, without which its changes are lost.
    pub(crate) fn needs(&mut self, file: SavedAs) {
        self.saved.need(file);
    }

    /// Notes that no state of this history was saved, and the file that is needed.
    pub(crate) fn mark_unsaved(&mut self, needed: SavedAs) {
        self.saved.forget(needed);
    }

    /// Notes that another shape has arrived for the present state, after its step was made.
    pub(crate) fn reshaped(&mut self) {
        self.saved.reshaped(self.state());
    }

    /// Notes that free handles, which were these before, have slid with the present state's shape: the neighbouring steps
    /// give each side its own handles.
    pub(crate) fn slid(&mut self, before: &[Handle], next_handle: u16) {
        let neighbours = self.done.back_mut().into_iter().chain(self.undone.last_mut());
        for step in neighbours.filter(|step| step.other_mesh().is_none()) {
            if !step.changes.iter().any(|change| matches!(change, Change::Handles(..))) {
                step.changes.push(Change::Handles(before.to_vec(), next_handle));
            }
        }
    }

    fn state(&self) -> u64 {
        self.done.back().map_or(self.oldest, |step| step.state)
    }

    /// Makes the neighbouring steps relative to the shape that the document shows.
    pub(crate) fn sync(&mut self, document: &Document) {
        if self.shape_version == document.versions().of(Aspect::Shape) {
            return;
        }
        let neighbours = self.done.back_mut().into_iter().chain(self.undone.last_mut());
        // The document before another mesh is whole in its step.
        for step in neighbours.filter(|step| step.other_mesh().is_none()) {
            let other = step.shape.applied(&self.shape);
            step.shape = Sparse::difference(&document.from_rest, &other);
        }
        self.keep_shape_of(document);
        self.forget_oldest();
    }

    fn keep_shape_of(&mut self, document: &Document) {
        self.shape = Arc::clone(&document.from_rest);
        self.shape_version = document.versions().of(Aspect::Shape);
    }

    /// Adds a step with the document's earlier values; `before` is the earlier document.
    ///
    /// Undone steps can't be redone after this.
    pub(crate) fn push(&mut self, name: String, changes: Vec<Change>, before: &Document) {
        self.revision += 1;
        self.undone.clear();
        self.done.push_back(Step {
            name,
            state: self.states,
            changes,
            shape: Sparse::default(),
        });
        self.states += 1;
        // The step's own shape delta is empty relative to the shape at its beginning: `sync` makes it the difference to
        // the resulting shape.
        self.keep_shape_of(before);
    }

    /// Adds a step to another mesh, on which the document is `after`; `before` is the earlier document.
    ///
    /// Undone steps can't be redone after this.
    pub(crate) fn push_mesh(&mut self, name: String, mesh: Arc<Model>, before: Content, after: &Document) {
        let Some(model) = self.mesh.replace(mesh) else { return };
        let content = before;
        let change = Change::Mesh(Box::new(OtherMesh { model, content }));
        self.push(name, vec![change], after);
        self.forget_oldest();
    }

    /// The present mesh; `None` before the first file.
    pub(crate) fn mesh(&self) -> Option<&Arc<Model>> {
        self.mesh.as_ref()
    }

    /// All meshes to which undo and redo can lead, and the present one.
    pub fn meshes(&self) -> impl Iterator<Item = &Arc<Model>> {
        let others = self.done.iter().chain(&self.undone).filter_map(Step::other_mesh);
        others.map(|other| &other.model).chain(&self.mesh)
    }

    /// Undoes the last step; returns its name, or `None` if there is none.
    pub(crate) fn undo(&mut self, document: &mut Document) -> Option<String> {
        self.sync(document);
        let mut step = self.done.pop_back()?;
        self.exchange(&mut step, document);
        let name = step.name.clone();
        self.undone.push(step);
        Some(name)
    }

    /// Redoes the last undone step; returns its name, or `None` if there is none.
    pub(crate) fn redo(&mut self, document: &mut Document) -> Option<String> {
        self.sync(document);
        let mut step = self.undone.pop()?;
        self.exchange(&mut step, document);
        let name = step.name.clone();
        self.done.push_back(step);
        Some(name)
    }

    /// Grows with every step that is made, undone or redone.
    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    fn exchange(&mut self, step: &mut Step, document: &mut Document) {
        self.revision += 1;
        if let [Change::Mesh(other)] = &mut step.changes[..] {
            document.swap_content(&mut other.content);
            if let Some(mesh) = &mut self.mesh {
                std::mem::swap(mesh, &mut other.model);
            }
            return self.keep_shape_of(document);
        }
        // It is apart from the document, which forgets it when a handle moves.
        let mut strength = document.take_strength();
        for change in &mut step.changes {
            swap(change, document, &mut strength);
        }
        document.put_strength(strength);
        if !step.shape.is_empty() {
            document.swap_shape(&mut step.shape);
        }
        self.keep_shape_of(document);
    }

    fn forget_oldest(&mut self) {
        let mut bytes = self.bytes();
        while bytes > self.cap_bytes && self.done.len() > 1 {
            if let Some(oldest) = self.done.pop_front() {
                bytes -= oldest.bytes();
                self.oldest = oldest.state;
            }
        }
    }
}

/// Exchanges the change's values with the document's, or with its strength.
fn swap(change: &mut Change, document: &mut Document, strength: &mut Option<Arc<Strength>>) {
    match change {
        Change::Paint(sparse) => document.swap_paint(sparse),
        Change::Handles(handles, next_handle) => document.swap_handles(handles, next_handle),
        Change::Stiffness(sparse, is_field) => document.swap_stiffness(sparse, is_field),
        Change::Continuity(continuity) => document.swap_continuity(continuity),
        Change::Options(method, loose, parts) => document.swap_options(method, loose, parts),
        Change::Attachments(attachments) => document.swap_attachments(attachments),
        Change::Tips(tips) => document.swap_tips(tips),
        Change::Rest(sparse, applied) => document.swap_rest(sparse, applied),
        Change::InsideOut(parts) => document.swap_inside_out(parts),
        Change::Access(access) => document.swap_access(access),
        Change::Kept(kept) => document.swap_kept(kept),
        Change::Settled(settled) => document.swap_settled(settled),
        Change::Poses(poses) => document.swap_poses(poses),
        Change::Animation(animation) => document.swap_animation(animation),
        Change::WorkPose(work) => document.swap_work_pose(work),
        Change::Fluid(packed) => {
            let mut fluid = packed.unpacked();
            document.swap_fluid(&mut fluid);
            *packed = PackedFluid::of(&fluid);
        }
        Change::FlowOptions(options) => document.swap_flow_options(options),
        Change::Strength(other) => std::mem::swap(other, strength),
        Change::Mesh(other) => document.swap_content(&mut other.content),
    }
}
