//! The program's whole state, and what is to be shown of it.

use std::collections::VecDeque;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_deform::Role;
use pliant_mesh::{Model, SurfaceVertex};

use crate::access::Masks;
use crate::brush::{Brush, BrushSize};
use crate::camera_history::CameraHistory;
use crate::document::{Document, HandleId};
use crate::engine::{Engine, moved_alone};
use crate::history::{HISTORY_BYTES, History};
use crate::mirror::Mirroring;
use crate::overlay::Overlay;
use crate::picking::{Pick, Picking};
use crate::recolouring::Recolouring;
use crate::tool::{Tool, ToolMode};
use crate::transaction::Transaction;
use crate::turn::means;
use crate::{
    Access, BRUSH_RADIUS_PX, BrushMetric, Camera, Command, Cursor, Depth, Descent, Event, Executor, GizmoMode,
    GizmoOrientation, HandleTransform, JobKind, KeyMap, Look, Orbit, Pointer, Readout, Revision, SceneView, Shortcut,
    StiffnessBrush, StrokeShape,
};

/// The program without a window.
pub struct Editor {
    pub(crate) engine: Engine,
    pub(crate) document: Document,
    pub(crate) history: History,
    pub(crate) file_name: String,
    /// What the present revisions belong to.
    pub(crate) known: Document,
    pub(crate) known_roles: Arc<Vec<Role>>,
    pub(crate) known_selected: Option<HandleId>,
    pub(crate) known_camera: Camera,
    pub(crate) known_stiffness: Option<Arc<Vec<f64>>>,
    pub(crate) showed_stiffness: bool,
    /// Whether paint has changed during the stroke that goes on.
    pub(crate) repainted: bool,
    /// Whether the stroke that ended has said of every vertex that it recoloured it.
    pub(crate) has_filed_paint: bool,
    pub(crate) recolouring: Recolouring,
    pub(crate) regions_revision: u64,
    pub(crate) rims_revision: u64,
    pub(crate) camera_revision: u64,
    pub(crate) camera: Camera,
    pub(crate) camera_history: CameraHistory,
    pub(crate) viewport_px: DVec2,
    /// Whether nobody has moved the camera since everything was framed.
    pub(crate) is_framed: bool,
    pub(crate) tool: Tool,
    pub(crate) mode: ToolMode,
    pub(crate) pointer: Option<Pointer>,
    pub(crate) brush: Brush,
    pub(crate) brush_radius_px: f64,
    pub(crate) gizmo_mode: GizmoMode,
    pub(crate) orientation: GizmoOrientation,
    pub(crate) stroke_shape: StrokeShape,
    pub(crate) depth: Depth,
    pub(crate) brush_metric: BrushMetric,
    pub(crate) stiffness_brush: StiffnessBrush,
    /// How hard a pen presses; 1 for a mouse.
    pub(crate) pressure: f64,
    pub(crate) reports_pressure: bool,
    /// Whether the next click puts the selected handle's pivot.
    pub(crate) wants_pivot: bool,
    /// Handles that are selected along with `selected`.
    pub(crate) companions: Vec<HandleId>,
    pub(crate) selected: Option<HandleId>,
    pub(crate) wants_new_handle: bool,
    pub(crate) look: Look,
    pub(crate) orbit: Orbit,
    pub(crate) key_map: KeyMap,
    pub(crate) problem: Option<String>,
    /// How far the shape's descent is, where its method takes steps.
    pub(crate) descent: Option<Descent>,
    /// The step that a widget is adjusting, while a command is added to it.
    pub(crate) open_step: Option<Transaction>,
    pub(crate) overlay: Overlay,
    /// What follows from what is hidden and locked, and what that was on which model.
    pub(crate) masks: Masks,
    pub(crate) masked: Option<(Arc<Model>, Arc<Access>)>,
    /// The document of another editor as this one has taken it over.
    pub(crate) followed: Option<Document>,
    /// The mirror image that is being looked for.
    pub(crate) mirroring: Option<Mirroring>,
    /// Events that wait until rays can be answered from what is drawn.
    pub(crate) held: VecDeque<Event>,
    pub(crate) shape_counter: u64,
}

impl Editor {
    /// An editor without a file. Jobs go to `executor`.
    pub fn new(executor: Box<dyn Executor>) -> Self {
        let document = Document::new(0);
        Self {
            engine: Engine::new(executor),
            history: History::new(Arc::clone(&document.from_rest), HISTORY_BYTES),
            known: document.clone(),
            known_roles: Arc::default(),
            known_selected: None,
            known_camera: Camera::default(),
            known_stiffness: None,
            showed_stiffness: false,
            repainted: false,
            has_filed_paint: false,
            recolouring: Recolouring::default(),
            document,
            file_name: String::new(),
            regions_revision: 0,
            rims_revision: 0,
            camera_revision: 0,
            camera: Camera::default(),
            camera_history: CameraHistory::default(),
            viewport_px: DVec2::new(1280.0, 800.0),
            is_framed: true,
            tool: Tool::Idle,
            mode: ToolMode::default(),
            pointer: None,
            brush: Brush::default(),
            brush_radius_px: 30.0,
            gizmo_mode: GizmoMode::default(),
            orientation: GizmoOrientation::default(),
            stroke_shape: StrokeShape::default(),
            depth: Depth::default(),
            brush_metric: BrushMetric::default(),
            stiffness_brush: StiffnessBrush::default(),
            pressure: 1.0,
            reports_pressure: false,
            wants_pivot: false,
            companions: Vec::new(),
            selected: None,
            wants_new_handle: false,
            look: Look::default(),
            orbit: Orbit::default(),
            key_map: KeyMap::default(),
            problem: None,
            descent: None,
            open_step: None,
            overlay: Overlay::default(),
            masks: Masks::default(),
            masked: None,
            mirroring: None,
            followed: None,
            held: VecDeque::new(),
            shape_counter: 0,
        }
    }

    /// What the window must show now.
    pub fn view(&self) -> SceneView<'_> {
        SceneView {
            model: self.engine.model.as_ref(),
            camera: &self.camera,
            viewport_px: self.viewport_px,
            shape_revision: self.shape_counter,
            displacements: &self.document.from_file,
            regions_revision: self.regions_revision,
            rims_revision: self.rims_revision,
            overlay_revision: self.overlay.revision,
            camera_revision: self.camera_revision,
            brush_ring: &self.overlay.ring,
            gizmo: &self.overlay.gizmo,
            look: self.look,
            orbit: self.orbit,
            readout: self.readout(),
            tool: self.mode,
            cursor: self.cursor(),
            outline_px: match &self.tool {
                Tool::Outline(outline) => outline.outline_px(),
                _ => Vec::new(),
            },
            stroke_shape: self.stroke_shape,
            depth: self.depth,
            brush_metric: self.brush_metric,
            stiffness_brush: self.stiffness_brush,
            pressure: self.reports_pressure.then_some(self.pressure),
            orientation: self.orientation,
            wants_pivot: self.wants_pivot,
            brush_radius_px: self.brush_radius_px,
            handles: &self.document.handles,
            selected: self.selected,
            companions: &self.companions,
            status: self.status(),
            problem: self.problem.as_deref(),
            jobs: self.engine.running(),
            counts: self.engine.region.counts,
            undo: self.history.undo_name(),
            redo: self.history.redo_name(),
            unsaved: self.history.is_unsaved(),
            settled: self.is_settled(),
        }
    }

    /// The keys that send a listed command; the first is shown.
    pub fn shortcuts(&self, command: &Command) -> &[Shortcut] {
        self.key_map.shortcuts(command)
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The steps that can be undone and redone.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// What each surface vertex does, as of the last measured region.
    pub fn roles(&self) -> &[Role] {
        &self.engine.region.roles
    }

    /// The connected parts that nothing holds within some handle's reach, and those that were told what to do, by
    /// their component's number, as of the last measured region.
    pub fn loose_components(&self) -> &[u32] {
        &self.engine.region.loose
    }

    /// Sentences about the present factorisation: what loose parts do, what was repaired.
    pub fn warnings(&self) -> &[String] {
        &self.engine.warnings
    }

    /// The open file's name; empty before the first.
    pub fn file_name(&self) -> &str {
        &self.file_name
    }

    /// What lies under a point of the view, in points; answered from the last shape that rays can be answered from.
    pub fn pick(&self, position_px: DVec2) -> Option<Pick> {
        self.picking()?.at(position_px)
    }

    /// Whether shape and regions are final: nothing is being dragged or painted, and no job runs but those that get
    /// ready for the pointer or the first drag.
    pub fn is_settled(&self) -> bool {
        let awaited = |kind| match kind {
            JobKind::Pick => false,
            JobKind::Order => self.document.is_displaced(),
            JobKind::Region | JobKind::Bind | JobKind::Solve | JobKind::Mirror | JobKind::Enclose => true,
        };
        let is_idle = matches!(self.tool, Tool::Idle) && self.held.is_empty();
        is_idle
            && !JobKind::ALL
                .into_iter()
                .any(|kind| awaited(kind) && self.engine.is_busy(kind))
    }

    pub(crate) fn picking(&self) -> Option<Picking<'_>> {
        Some(Picking::of(
            self.engine.model.as_deref()?,
            &self.document.from_file,
            self.engine.pickable.as_ref()?,
            (&self.camera, self.viewport_px),
            self.engine.is_picking_current(),
        ))
    }

    /// Begins a step of the document.
    pub(crate) fn begin(&mut self, name: impl Into<String>) -> Transaction {
        Transaction::begin(name, &self.document, &mut self.history)
    }

    /// Changes the document in one named step; false if that changed nothing.
    pub(crate) fn change(&mut self, name: impl Into<String>, change: impl FnOnce(&mut Document)) -> bool {
        self.step(name, |editor| {
            let shape = Arc::clone(&editor.document.from_rest);
            change(&mut editor.document);
            if !Arc::ptr_eq(&shape, &editor.document.from_rest) {
                editor.engine.drop_solves();
            }
        })
    }

    /// Does something to the document in one named step, or in the step that is being adjusted; false if that changed
    /// nothing.
    pub(crate) fn step(&mut self, name: impl Into<String>, act: impl FnOnce(&mut Self)) -> bool {
        if let Some(open) = &mut self.open_step {
            open.rename(name);
            act(self);
            return true;
        }
        let transaction = self.begin(name);
        act(self);
        transaction.commit(&self.document, &mut self.history)
    }

    fn readout(&self) -> Option<Readout> {
        match &self.tool {
            Tool::Transform(drag) => drag.readout(self),
            _ => None,
        }
    }

    /// Puts a handle somewhere, in the document as it stands: the surface follows as soon as it can.
    pub(crate) fn put_handle(&mut self, id: HandleId, transform: HandleTransform) {
        if let Some(why) = self.held_because(id) {
            self.problem = Some(why);
            return;
        }
        let Some(handle) = self.document.handle_mut(id) else {
            return;
        };
        if handle.transform == transform {
            return;
        }
        if !transform.can_be_undone() {
            self.problem = Some("That would flatten the handle for good: give a scale other than 0.".to_owned());
            return;
        }
        // A number that is typed digit by digit passes by 0.
        self.problem = None;
        let twin = handle.twin;
        handle.put(transform);
        self.document.settled = false;
        if !self.engine.is_bound()
            && let Some(model) = self.engine.model.clone()
        {
            moved_alone(&mut self.document, &model, &self.masks, id);
        }
        if let Some(twin) = twin
            && self.held_because(twin.handle).is_none()
            && let Some(other) = self.document.handle_mut(twin.handle)
        {
            other.put(twin.plane.mirrored_transform(transform));
            if !self.engine.is_bound()
                && let Some(model) = self.engine.model.clone()
            {
                moved_alone(&mut self.document, &model, &self.masks, twin.handle);
            }
        }
    }

    /// Says how a handle's turn is counted, if that means its rotation.
    pub(crate) fn count_turn(&mut self, id: HandleId, turn_deg: DVec3) {
        if let Some(handle) = self.document.handle_mut(id)
            && let HandleTransform::Trs { rotation, .. } = handle.transform
            && means(turn_deg, rotation)
        {
            handle.turn_deg = turn_deg;
        }
    }

    /// Ends what the tool is doing without a trace.
    pub(crate) fn abort_tool(&mut self) {
        let tool = std::mem::take(&mut self.tool);
        tool.abort(self);
    }

    /// The point that zooming keeps in place: on the surface under the pointer, or at the target's depth.
    pub(crate) fn anchor(&self, position_px: DVec2) -> DVec3 {
        match self.pick(position_px) {
            Some(pick) => pick.point,
            None => {
                let ray = self.camera.ray(position_px, self.viewport_px);
                ray.origin + ray.direction * (self.camera.distance / ray.direction.dot(self.camera.forward()))
            }
        }
    }

    pub(crate) fn brush_size(&self) -> BrushSize {
        BrushSize {
            radius_px: self.brush_radius_px,
            metric: self.brush_metric,
        }
    }

    /// Every vertex that hangs together with this one.
    pub(crate) fn part_of(&self, vertex: SurfaceVertex) -> Vec<SurfaceVertex> {
        let Some(model) = &self.engine.model else {
            return Vec::new();
        };
        let part = model.topology.component(vertex);
        (0..self.document.paint.len() as u32)
            .map(SurfaceVertex)
            .filter(|&vertex| model.topology.component(vertex) == part)
            .collect()
    }

    pub(crate) fn set_brush_radius(&mut self, radius_px: f64) {
        if radius_px.is_finite() {
            self.brush_radius_px = radius_px.clamp(*BRUSH_RADIUS_PX.start(), *BRUSH_RADIUS_PX.end());
        }
    }

    fn cursor(&self) -> Cursor {
        match &self.tool {
            Tool::Navigate(_) => Cursor::Grabbing,
            Tool::Transform(_) | Tool::Widen(_) => Cursor::Move,
            Tool::Paint(_) | Tool::Stiffness(_) | Tool::Outline(_) => Cursor::Brush,
            Tool::Idle if self.overlay.hovered.is_some() => Cursor::Grab,
            Tool::Idle if self.overlay.is_over_surface && self.mode != ToolMode::Select => Cursor::Brush,
            Tool::Idle | Tool::Adjust(_) => Cursor::Arrow,
        }
    }

    /// The revision of the shape that jobs are stamped with, for tests of lateness.
    pub fn shape_stamp(&self) -> Revision {
        self.engine.shape_revision
    }
}

impl std::fmt::Debug for Editor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Editor")
            .field("file_name", &self.file_name)
            .field("mode", &self.mode)
            .finish_non_exhaustive()
    }
}
