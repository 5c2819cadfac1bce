//! What each command does.

use std::sync::Arc;

use glam::DVec2;
use pliant_deform::Loose;
use pliant_mesh::SurfaceVertex;

use crate::camera_history::CameraStep;
use crate::command::Command;
use crate::constraint::Constraint;
use crate::document::{HandleId, Paint};
use crate::editor::Editor;
use crate::format::without_pivot;
use crate::tool::{Tool, TransformDrag, TransformKind, Widen};
use crate::{HandleTransform, Orbit, Projection, STIFFNESS_RANGE};

/// The factor by which a key sizes the brush.
const BRUSH_STEP: f64 = 1.2;
/// How far a key turns the view: 15 degrees.
const VIEW_STEP_RAD: f64 = std::f64::consts::PI / 12.0;

impl Editor {
    /// Does what the command says; a command that can't do anything now is ignored.
    pub(crate) fn execute(&mut self, command: Command) {
        if !self.is_enabled(&command) {
            return;
        }
        if concerns_document(&command) && self.open_step.is_none() {
            let was_idle = matches!(self.tool, Tool::Idle);
            self.abort_tool();
            self.problem = None;
            // Undo during a drag takes back the drag, and nothing before it.
            if !was_idle && matches!(command, Command::Undo | Command::Redo | Command::GoToStep(_)) {
                return;
            }
        }
        match command {
            Command::Undo => {
                self.engine.drop_solves();
                self.history.undo(&mut self.document);
            }
            Command::Redo => {
                self.engine.drop_solves();
                self.history.redo(&mut self.document);
                // A handle that has come back is most likely what one wants to go on with.
                self.selected = self.selected.or(self.document.handles.last().map(|handle| handle.id));
            }
            Command::SetTool(mode) => {
                self.abort_tool();
                self.mode = mode;
            }
            Command::NewHandle => {
                self.mode = crate::ToolMode::PaintHandle;
                self.wants_new_handle = true;
                self.selected = None;
            }
            Command::SelectHandle(id) => {
                self.companions.clear();
                self.selected = Some(id);
            }
            Command::Deselect => {
                self.companions.clear();
                self.selected = None;
            }
            Command::ToggleSelected(id) => self.toggle_selected(id),
            Command::NextHandle => self.select_next(),
            Command::DeleteHandle => self.delete_selected(),
            Command::ResetHandle => {
                if let Some(id) = self.selected {
                    self.transform_handle("Reset", id, HandleTransform::IDENTITY);
                }
            }
            Command::RenameHandle(id, name) => {
                self.change("Rename handle", |document| {
                    if let Some(handle) = document.handle_mut(id) {
                        handle.name = name;
                    }
                });
            }
            Command::SetHandleTransform(id, transform) => {
                if transform.affine(glam::DVec3::ZERO).is_finite() {
                    self.transform_handle("Move", id, without_pivot(transform));
                } else {
                    self.problem = Some("The handle's transform is not finite: enter other numbers.".to_owned());
                }
            }
            Command::SetTurn(id, turn_deg) => self.set_turn(id, turn_deg),
            Command::SetReach(id, reach) => self.set_reach(id, reach),
            Command::SetSoft(id, soft) => self.set_soft(id, soft),
            Command::Apply => {
                self.change("Apply shape", |document| document.apply_shape());
                self.engine.drop_solves();
            }
            Command::ResetShape => self.reset_shape(),
            Command::ClearRegions => {
                self.engine.drop_solves();
                self.change("Clear regions", |document| {
                    document.apply_shape();
                    document.paint = Arc::new(vec![Paint::Bare; document.paint.len()]);
                    document.handles.clear();
                });
            }
            Command::SetMethod(method) => {
                self.change("Change method", |document| {
                    document.settled &= document.method == method || !document.is_displaced();
                    document.method = method;
                });
            }
            Command::SetLoose(loose) => {
                self.change("Change loose parts", |document| {
                    let is_same = document.loose == loose && document.loose_parts.is_empty();
                    document.settled &= is_same || !document.is_displaced();
                    document.loose = loose;
                    document.loose_parts = Arc::default();
                });
            }
            Command::SetLoosePart(part, loose) => self.set_loose_part(part, loose),
            Command::FramePart(part) => self.frame_part(part),
            Command::SetContinuity(id, continuity) => self.set_continuity(id, continuity),
            Command::SetStiffness(field) => self.set_stiffness(field),
            Command::SetBrushRadius(radius_px) => self.set_brush_radius(radius_px),
            Command::GrowBrush => self.set_brush_radius(self.brush_radius_px * BRUSH_STEP),
            Command::ShrinkBrush => self.set_brush_radius(self.brush_radius_px / BRUSH_STEP),
            Command::FrameAll => self.frame_all(),
            Command::FrameSelected => self.frame_selected(),
            Command::FrameFileVertex(vertex) => self.frame_file_vertex(vertex),
            Command::CameraBack => self.camera_step(CameraStep::Back),
            Command::CameraForth => self.camera_step(CameraStep::Forth),
            Command::View(view) => {
                self.camera.look_from(view);
                self.is_framed = false;
            }
            Command::SetUp(up) => self.camera.up = up,
            Command::SetShading(shading) => self.look.shading = shading,
            Command::SetClay(clay) => {
                self.look.clay = clay;
                self.look.shading = crate::Shading::Clay;
            }
            Command::ToggleFlat => self.look.flat = !self.look.flat,
            Command::ToggleWireframe => self.look.wireframe = !self.look.wireframe,
            Command::ToggleBorders => self.look.borders = !self.look.borders,
            Command::ToggleOutlines => self.look.outlines = !self.look.outlines,
            Command::ToggleRegions => self.look.regions = !self.look.regions,
            Command::ToggleGrid => self.look.grid = !self.look.grid,
            Command::ToggleProjection => {
                self.camera.projection = match self.camera.projection {
                    Projection::Perspective => Projection::Orthographic,
                    Projection::Orthographic => Projection::Perspective,
                };
            }
            Command::SetOrbit(orbit) => {
                self.orbit = orbit;
                if orbit == Orbit::Turntable {
                    self.camera.roll_rad = 0.0;
                }
            }
            Command::StepView(steps) => {
                self.camera.turn(DVec2::from(steps.map(f64::from)) * VIEW_STEP_RAD);
                self.is_framed = false;
            }
            Command::TurnAround => {
                self.camera.turn_around();
                self.is_framed = false;
            }
            Command::SetGizmo(mode) => self.gizmo_mode = mode,
            Command::SetOrientation(orientation) => self.orientation = orientation,
            Command::SetStrokeShape(shape) => {
                self.abort_tool();
                self.stroke_shape = shape;
                if self.mode == crate::ToolMode::Select {
                    self.mode = crate::ToolMode::PaintHandle;
                }
            }
            Command::SetDepth(depth) => self.depth = depth,
            Command::SetBrushMetric(metric) => self.brush_metric = metric,
            Command::SetStiffnessBrush(brush) => self.stiffness_brush = brush.clamped().unwrap_or(self.stiffness_brush),
            Command::ClearStiffness => {
                self.change("Clear stiffness", |document| {
                    document.settled &= !document.is_displaced();
                    document.stiffness = None;
                });
            }
            Command::Region(action) => self.act_on_region(action),
            Command::Widen => {
                if let Some(widen) = Widen::begin(self) {
                    self.tool = Tool::Widen(Box::new(widen));
                }
            }
            Command::SetHandleColour(id, colour) => {
                self.change_handle("Change colour", id, |handle| handle.colour = colour);
            }
            Command::ToggleHandleVisible(id) => {
                self.change_handle("Show or hide handle", id, |handle| handle.visible = !handle.visible);
            }
            Command::ToggleHandleLocked(id) => {
                self.change_handle("Lock or unlock handle", id, |handle| handle.locked = !handle.locked);
            }
            Command::SetPivotPlace(id, place) => self.set_pivot_place(id, place),
            Command::SetPivot(id, point) => self.set_pivot(id, point),
            Command::PickPivot => self.wants_pivot = true,
            Command::DuplicateHandle => self.split_selected(),
            Command::MakeTwin(axis) => self.make_twin(axis),
            Command::Untwin => self.untwin(),
            Command::ResetRegion => self.reset_region(),
            Command::Objects(action, objects) => self.act_on_objects(action, &objects),
            Command::ObjectHere(action) => self.act_on_object_here(action),
            Command::Isolate => self.isolate(),
            Command::ShowEverything => self.show_everything(),
            Command::GoToStep(steps) => {
                self.engine.drop_solves();
                while self.history.names().1 > steps && self.history.undo(&mut self.document).is_some() {}
                while self.history.names().1 < steps && self.history.redo(&mut self.document).is_some() {}
            }
            Command::Move => self.begin_transform(TransformKind::Move),
            Command::Turn => self.begin_transform(TransformKind::Turn),
            Command::Scale => self.begin_transform(TransformKind::Scale),
            Command::CancelJobs => self.engine.give_up(),
        }
    }

    fn begin_transform(&mut self, kind: TransformKind) {
        let start_px = self
            .pointer
            .map_or(self.viewport_px * 0.5, |pointer| pointer.position_px);
        if let Some(drag) = TransformDrag::begin(self, kind, Constraint::Free, start_px) {
            self.tool = Tool::Transform(Box::new(drag));
        }
    }

    fn select_next(&mut self) {
        let handles = &self.document.handles;
        let present = self
            .selected
            .and_then(|id| handles.iter().position(|handle| handle.id == id));
        let next = present.map_or(0, |index| (index + 1) % handles.len().max(1));
        self.selected = handles.get(next).map(|handle| handle.id);
    }

    fn delete_selected(&mut self) {
        let Some(id) = self.selected else { return };
        let name = self
            .document
            .handle(id)
            .map_or_else(String::new, |handle| handle.name.clone());
        self.engine.drop_solves();
        self.change(format!("Delete {name}"), |document| {
            document.apply_shape();
            for paint in Arc::make_mut(&mut document.paint) {
                if *paint == Paint::Handle(id) {
                    *paint = Paint::Bare;
                }
            }
            document.handles.retain(|handle| handle.id != id);
            for handle in &mut document.handles {
                handle.twin = handle.twin.filter(|twin| twin.handle != id);
            }
        });
    }

    fn set_loose_part(&mut self, part: u32, loose: Option<Loose>) {
        let count = self
            .engine
            .model
            .as_ref()
            .map_or(0, |model| model.topology.components().len());
        if part as usize >= count {
            self.problem = Some(format!(
                "The mesh has {count} parts and none of this number: choose one of the list."
            ));
            return;
        }
        self.change("Change loose part", |document| {
            let mut parts = (*document.loose_parts).clone();
            match loose {
                Some(loose) => parts.insert(part, loose),
                None => parts.remove(&part),
            };
            if parts != *document.loose_parts {
                document.settled &= !document.is_displaced();
                document.loose_parts = Arc::new(parts);
            }
        });
    }

    fn reset_shape(&mut self) {
        let Some(model) = self.engine.model.clone() else { return };
        self.engine.drop_solves();
        self.change("Reset shape", |document| {
            let was_applied = std::mem::take(&mut document.applied);
            document.rest = Arc::new(vec![glam::DVec3::ZERO; document.paint.len()]);
            document.from_rest = Arc::clone(&document.rest);
            document.from_file = Arc::clone(&document.rest);
            document.settled = true;
            for handle in &mut document.handles {
                handle.put(HandleTransform::IDENTITY);
                if was_applied {
                    handle.pivot = pivot_of(handle.id, &document.paint, &model.surface.positions);
                }
            }
        });
    }

    fn set_stiffness(&mut self, field: Vec<f64>) {
        let count = self.document.paint.len();
        let bad = field.iter().find(|stiffness| !STIFFNESS_RANGE.contains(stiffness));
        if field.len() != count {
            self.problem = Some(format!(
                "The stiffness has {} values for {count} vertices: give one for each.",
                field.len()
            ));
        } else if let Some(bad) = bad {
            let (low, high) = (STIFFNESS_RANGE.start(), STIFFNESS_RANGE.end());
            self.problem = Some(format!(
                "A stiffness of {bad} is not between {low} and {high}: paint another."
            ));
        } else {
            self.change("Change stiffness", |document| {
                let field = field.iter().any(|&stiffness| stiffness != 1.0).then(|| Arc::new(field));
                if document.stiffness != field {
                    document.settled &= !document.is_displaced();
                    document.stiffness = field;
                }
            });
        }
    }
}

/// The mean position of a handle's vertices.
fn pivot_of(id: HandleId, paint: &[Paint], positions: &[glam::DVec3]) -> glam::DVec3 {
    let members = paint
        .iter()
        .enumerate()
        .filter(|(_, paint)| **paint == Paint::Handle(id));
    crate::region::centroid(positions, members.map(|(vertex, _)| SurfaceVertex(vertex as u32)))
}

/// Whether the command would change the document, or start to.
fn concerns_document(command: &Command) -> bool {
    matches!(
        command,
        Command::Undo
            | Command::Redo
            | Command::DeleteHandle
            | Command::ResetHandle
            | Command::RenameHandle(..)
            | Command::SetHandleTransform(..)
            | Command::SetTurn(..)
            | Command::SetReach(..)
            | Command::SetSoft(..)
            | Command::SetContinuity(..)
            | Command::SetLoosePart(..)
            | Command::Apply
            | Command::ResetShape
            | Command::ClearRegions
            | Command::SetMethod(_)
            | Command::SetLoose(_)
            | Command::SetStiffness(_)
            | Command::Move
            | Command::Turn
            | Command::Scale
            | Command::Widen
            | Command::Region(_)
            | Command::ClearStiffness
            | Command::SetHandleColour(..)
            | Command::ToggleHandleVisible(_)
            | Command::ToggleHandleLocked(_)
            | Command::SetPivotPlace(..)
            | Command::SetPivot(..)
            | Command::PickPivot
            | Command::DuplicateHandle
            | Command::MakeTwin(_)
            | Command::Untwin
            | Command::ResetRegion
            | Command::Objects(..)
            | Command::ObjectHere(_)
            | Command::Isolate
            | Command::ShowEverything
            | Command::GoToStep(_)
            | Command::ToggleSelected(_)
            | Command::SelectHandle(_)
            | Command::Deselect
            | Command::NextHandle
            | Command::NewHandle
    )
}
