//! A person's work: the document with its history, the jobs' results, and the selected handles.
//!
//! The document changes in named steps ([`Workspace::step`]), or in a transaction that a gesture holds.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_mesh::{Model, SurfaceVertex};

use super::colour_revisions::Colours;
use super::control_selection::ControlSelection;
use super::crease_distances::CreaseDistances;
use super::flow_play::FlowPlay;
use super::frame_work::FrameWork;
use super::key_work::KeyWork;
use super::mirror_request::Mirroring;
use super::selection::HandleSelection;
use super::stitching_request::Stitching;
use crate::document::{
    Aspect, Document, HISTORY_BYTES, Handle, HandleId, History, Transaction, Version, Versions, VertexAccess,
};
use crate::jobs::{BothSides, Computed, Descent, Executor, Intersections, Jobs, Symmetry};
use crate::revision::Revision;
use crate::view::{Pick, Picking, View};
use crate::warning::in_window_words;

/// The document and its consequences.
pub(crate) struct Workspace {
    pub(crate) document: Document,
    pub(crate) history: History,
    pub(crate) jobs: Jobs,
    pub(crate) selection: HandleSelection,
    /// The selected points of the method's cage or lattice.
    pub(crate) controls: ControlSelection,
    /// The last refusal or failure, in one sentence.
    pub(crate) refusal: Option<String>,
    /// The open file's name.
    pub(crate) file_name: String,
    /// Zero displacements: the file's own shape.
    pub(crate) original: Arc<Vec<DVec3>>,
    /// The progress of the shape's descent, if its method takes steps.
    pub(crate) descent: Option<Descent>,
    pub(crate) vertex_access: VertexAccess,
    /// The model and the access behind it.
    pub(super) vertex_access_of: Option<(Revision, Version)>,
    pub(super) colours: Colours,
    /// Grows when the drawn shape changes.
    pub(super) shape_revision: u64,
    /// The versions that jobs and colours last followed.
    pub(super) seen: Versions,
    /// Whether anything is painted, and the paint for which that was computed.
    pub(super) painted: (bool, Version),
    /// Whether the selected handle's crease is narrower than the edges beside it, and for which it was measured.
    pub(super) narrow_crease: (bool, Option<(HandleId, f64, Version)>),
    pub(crate) flow: FlowPlay,
    pub(crate) keys: KeyWork,
    pub(super) frames: FrameWork,
    /// The step of an active widget.
    adjusting: Option<Transaction>,
    /// Distances from creases before that step.
    pub(super) crease_distances: CreaseDistances,
    pub(super) mirroring: Option<Mirroring>,
    pub(super) symmetry: Symmetry,
    /// Both sides of the plane of symmetry, once they are found.
    pub(super) both_sides: Option<Arc<BothSides>>,
    /// The change of the mesh that is under way.
    pub(crate) stitching: Option<Stitching>,
}

impl Workspace {
    /// A workspace without a file. Jobs go to `executor`.
    pub(crate) fn new(executor: Box<dyn Executor>) -> Self {
        let document = Document::new(0);
        Self {
            jobs: Jobs::new(executor),
            history: History::new(&document, None, HISTORY_BYTES),
            seen: *document.versions(),
            painted: (false, document.versions().of(Aspect::Paint)),
            narrow_crease: (false, None),
            document,
            selection: HandleSelection::default(),
            controls: ControlSelection::default(),
            refusal: None,
            file_name: String::new(),
            original: Arc::default(),
            descent: None,
            vertex_access: VertexAccess::default(),
            vertex_access_of: None,
            colours: Colours::default(),
            shape_revision: 0,
            flow: FlowPlay::default(),
            keys: KeyWork::default(),
            frames: FrameWork::default(),
            adjusting: None,
            crease_distances: CreaseDistances::default(),
            mirroring: None,
            symmetry: Symmetry::None,
            both_sides: None,
            stitching: None,
        }
    }

    /// Opens another file, which begins with this document.
    pub(crate) fn open(&mut self, model: Arc<Model>, name: String, document: Document) {
        self.document.replace(document);
        self.history = History::new(&self.document, Some(Arc::clone(&model)), HISTORY_BYTES);
        self.selection = HandleSelection::default();
        self.selection
            .put(self.document.handles().first().map(|handle| handle.id));
        self.refusal = None;
        self.file_name = name;
        self.jobs.open(model);
        self.begin_mesh();
        self.keys = KeyWork::default();
        self.frames = FrameWork::default();
    }

    /// Returns true if anything was painted at the end of the last event outside a stroke.
    pub(crate) fn is_painted(&self) -> bool {
        self.painted.0
    }

    /// The open file's vertex sets.
    pub(crate) fn model(&self) -> Option<&Arc<Model>> {
        self.jobs.computed.model.as_ref()
    }

    /// The results of the jobs.
    pub(crate) fn computed(&self) -> &Computed {
        &self.jobs.computed
    }

    /// The selected handle.
    pub(crate) fn selected(&self) -> Option<&Handle> {
        self.document.handle(self.selection.selected()?)
    }

    /// Grows when the drawn shape changes.
    pub(crate) fn shape_revision(&self) -> u64 {
        self.shape_revision
    }

    /// The places where the settled shape passes through itself; `None` before the search, and while it moves.
    pub(crate) fn intersections(&self) -> Option<&Intersections> {
        self.computed().intersections().filter(|_| self.document.is_settled())
    }

    pub(crate) fn colours(&self) -> &Colours {
        &self.colours
    }

    /// Sets the reason why an action was refused.
    pub(crate) fn refuse(&mut self, why: impl Into<String>) {
        self.refusal = Some(in_window_words(&why.into()));
    }
}

/// Steps of the document.
impl Workspace {
    /// Begins a step, to be committed or aborted. A stretch of play ends before it.
    pub(crate) fn begin(&mut self, name: impl Into<String>) -> Transaction {
        self.pause_keys();
        Transaction::begin(name, &self.document, &mut self.history)
    }

    /// Begins a step that paints: running bindings and solves are no longer wanted.
    pub(crate) fn begin_stroke(&mut self, name: impl Into<String>) -> Transaction {
        self.jobs.stop_binding();
        self.jobs.drop_solves();
        self.begin(name)
    }

    /// Enters a step into the history; false if it changed nothing.
    pub(crate) fn commit(&mut self, transaction: &Transaction) -> bool {
        transaction.commit(&self.document, &mut self.history)
    }

    /// Restores the beginning of a step.
    pub(crate) fn abort(&mut self, transaction: &Transaction) {
        transaction.abort(&mut self.document);
        self.jobs.drop_solves();
    }

    /// Changes the document in one named step, or in the adjusted step; false if that changed nothing. Running solves
    /// are dropped if the shape has changed.
    pub(crate) fn step(&mut self, name: impl Into<String>, act: impl FnOnce(&mut Self)) -> bool {
        let shape = self.document.versions().of(Aspect::Shape);
        let begun = match &mut self.adjusting {
            Some(open) => {
                open.rename(name);
                None
            }
            None => Some(self.begin(name)),
        };
        act(self);
        if self.document.versions().of(Aspect::Shape) != shape {
            self.jobs.drop_solves();
        }
        begun.is_none_or(|transaction| self.commit(&transaction))
    }

    /// Changes the document in one named step; false if that changed nothing.
    pub(crate) fn change(&mut self, name: impl Into<String>, change: impl FnOnce(&mut Document)) -> bool {
        self.step(name, |workspace| change(&mut workspace.document))
    }

    /// Returns true if the selected handle's crease is narrower than the edges beside it, so that only the line moves.
    pub(crate) fn is_crease_narrow(&self) -> bool {
        self.narrow_crease.0
    }

    /// Returns true if a widget is adjusting a step.
    pub(crate) fn is_adjusting(&self) -> bool {
        self.adjusting.is_some()
    }

    /// The document before the step that a widget is adjusting, or the present one.
    pub(crate) fn before_adjusting(&self) -> &Document {
        self.adjusting.as_ref().map_or(&self.document, Transaction::before)
    }

    /// All following steps are one, until it is committed or aborted.
    pub(crate) fn begin_adjusting(&mut self) {
        self.adjusting = Some(self.begin("Adjust"));
        self.crease_distances = CreaseDistances::default();
    }

    /// Enters the adjusted step into the history.
    pub(crate) fn commit_adjusting(&mut self) {
        if let Some(transaction) = self.adjusting.take() {
            self.crease_distances = CreaseDistances::default();
            self.end_scrubbing(transaction.before().animation());
            self.commit(&transaction);
        }
    }

    /// Aborts the adjusted step.
    pub(crate) fn abort_adjusting(&mut self) {
        if let Some(transaction) = self.adjusting.take() {
            self.crease_distances = CreaseDistances::default();
            self.abort(&transaction);
        }
    }

    /// Undoes the last step, or the stretch of the flow that plays.
    pub(crate) fn undo(&mut self) {
        if !self.flow.is_still() {
            return self.flow.drop_stretch();
        }
        self.pause_keys();
        self.frames.stop();
        self.jobs.drop_solves();
        let before: Vec<HandleId> = self.document.handles().iter().map(|handle| handle.id).collect();
        self.history.undo(&mut self.document);
        self.follow_mesh();
        // After undo of a deletion the handle is selected, as before.
        let mut handles = self.document.handles().iter().map(|handle| handle.id);
        if let Some(back) = handles.find(|id| !before.contains(id)) {
            self.selection.put(Some(back));
        }
    }

    /// Redoes the last undone step.
    pub(crate) fn redo(&mut self) {
        self.pause_keys();
        self.frames.stop();
        self.jobs.drop_solves();
        self.flow.drop_stretch();
        self.history.redo(&mut self.document);
        self.follow_mesh();
        // A restored handle is probably the next one to be edited.
        let last = self.document.handles().last().map(|handle| handle.id);
        self.selection.put(self.selection.selected().or(last));
    }

    /// Goes back or forth to the state after this many steps of the history.
    pub(crate) fn go_to_step(&mut self, steps: usize) {
        self.pause_keys();
        self.frames.stop();
        self.jobs.drop_solves();
        self.flow.drop_stretch();
        while self.history.names().1 > steps && self.history.undo(&mut self.document).is_some() {}
        while self.history.names().1 < steps && self.history.redo(&mut self.document).is_some() {}
        self.follow_mesh();
    }
}

/// Picking under a point of the view.
impl Workspace {
    /// The data that answer rays; `None` before a file's hierarchy is built.
    pub(crate) fn picking<'a>(&'a self, view: &'a View) -> Option<Picking<'a>> {
        Some(Picking::of(
            self.model()?,
            self.document.from_file(),
            self.computed().pickable()?,
            (view.camera(), view.viewport_px()),
            self.jobs.is_picking_current(),
        ))
    }

    /// The first point of the surface under a point of the view.
    pub(crate) fn pick(&self, view: &View, position_px: DVec2) -> Option<Pick> {
        self.picking(view)?.at(position_px)
    }

    /// The point that zooming keeps in place: on the surface under the pointer, or at the target's depth.
    pub(crate) fn anchor(&self, view: &View, position_px: DVec2) -> DVec3 {
        match self.pick(view, position_px) {
            Some(pick) => pick.point,
            None => {
                let camera = view.camera();
                let ray = camera.ray(position_px, view.viewport_px());
                ray.origin + ray.direction * (camera.distance / ray.direction.dot(camera.forward()))
            }
        }
    }

    /// The drawn position of a surface vertex; the origin before the first file.
    pub(crate) fn position(&self, vertex: SurfaceVertex) -> DVec3 {
        let rest = self.model().map(|model| model.surface.positions[vertex.index()]);
        rest.unwrap_or_default() + self.document.from_file[vertex.index()]
    }

    /// Every vertex connected to this one.
    pub(crate) fn part_of(&self, vertex: SurfaceVertex) -> Vec<SurfaceVertex> {
        let Some(model) = self.model() else { return Vec::new() };
        let part = model.topology.component(vertex);
        (0..self.document.paint.len() as u32)
            .map(SurfaceVertex)
            .filter(|&vertex| model.topology.component(vertex) == part)
            .collect()
    }

    /// The positions of all shown vertices, without specks.
    pub(crate) fn shown_positions(&self) -> Vec<DVec3> {
        let Some(model) = self.model() else { return Vec::new() };
        let all = model.vertices_without_specks();
        let shown = all.filter(|vertex| self.vertex_access.is_shown(vertex.index()));
        // A filter's size is unknown; growing by doubling would copy millions several times.
        let mut positions = Vec::with_capacity(model.surface.positions.len());
        positions.extend(shown.map(|vertex| self.position(vertex)));
        positions
    }
}
