//! The one door: every event comes in here.

use std::sync::Arc;

use glam::DVec2;
use pliant_mesh::Model;

use crate::document::Document;
use crate::document::{HISTORY_BYTES, History};
use crate::editor::Editor;
use crate::jobs::{Arrival, Finality};
use crate::tool::Tool;
use crate::tool::brush::Brush;
use crate::view::CameraHistory;
use crate::{Beginning, Button, Event, JobDone, JobKind, Key, Modifiers};

impl Editor {
    /// The one function through which everything changes.
    pub fn handle(&mut self, event: Event) {
        let picked = matches!(&event, Event::JobDone(done) if done.kind == JobKind::Pick);
        if self.must_wait(&event) {
            self.held.push_back(event);
        } else {
            self.dispatch(event);
        }
        self.conclude();
        let answers = picked || self.engine.is_picking_current() || !self.engine.is_busy(JobKind::Pick);
        if !self.held.is_empty() && answers {
            for event in std::mem::take(&mut self.held) {
                if self.tool.is_looking() {
                    self.held.push_back(event);
                } else {
                    self.dispatch(event);
                    self.conclude();
                }
            }
        }
        self.refresh_overlay();
    }

    fn dispatch(&mut self, event: Event) {
        match event {
            Event::Viewport { size_px } => self.resize(size_px),
            Event::PointerMoved(pointer) => {
                self.pointer = Some(pointer);
                let tool = std::mem::take(&mut self.tool);
                self.tool = tool.moved(self, pointer);
            }
            Event::PointerLeft => {
                if matches!(self.tool, Tool::Idle) {
                    self.pointer = None;
                }
            }
            Event::PointerPressed(pointer, button) => {
                self.pointer = Some(pointer);
                let tool = std::mem::take(&mut self.tool);
                self.tool = tool.pressed(self, pointer, button);
            }
            Event::PointerReleased(pointer, button) => {
                self.pointer = Some(pointer);
                let tool = std::mem::take(&mut self.tool);
                self.tool = tool.released(self, pointer, button);
            }
            // A transform measures the pointer's way with the camera that it began with.
            Event::Wheel { .. } | Event::Pinch { .. } if matches!(self.tool, Tool::Transform(_)) => {}
            Event::Wheel { pointer, lines } => {
                let anchor = self.anchor(pointer.position_px);
                self.camera.zoom_lines(lines, anchor);
                self.is_framed = false;
            }
            Event::Pinch { pointer, factor } => {
                if factor.is_finite() && factor > 0.0 {
                    let anchor = self.anchor(pointer.position_px);
                    self.camera.zoom(factor, anchor);
                    self.is_framed = false;
                }
            }
            Event::Pressure(pressure) => {
                self.reports_pressure |= pressure.is_some();
                self.pressure = pressure
                    .filter(|pressure| pressure.is_finite())
                    .map_or(1.0, |p| p.clamp(0.0, 1.0));
            }
            Event::Key(key, modifiers) => self.key(key, modifiers),
            Event::Command(command) => self.execute(command),
            Event::Keys(key_map) => self.key_map = key_map,
            Event::Adjust(command) => self.adjust(command),
            Event::Adjusted => self.adjusted(),
            Event::JobDone(done) => self.job_done(done),
            Event::Opened { model, name, beginning } => self.open(model, name, beginning),
            Event::Recovered => self.history.mark_unsaved(),
            Event::Saved => {
                self.history.sync(&self.document);
                self.history.mark_saved();
            }
        }
    }

    fn resize(&mut self, size_px: DVec2) {
        let is_usable = size_px.is_finite() && size_px.x >= 1.0 && size_px.y >= 1.0;
        if !is_usable || size_px == self.viewport_px {
            return;
        }
        self.viewport_px = size_px;
        self.camera_revision += 1;
        if self.is_framed {
            self.frame_all();
        }
    }

    fn key(&mut self, key: Key, modifiers: Modifiers) {
        let tool = std::mem::take(&mut self.tool);
        let (tool, taken) = tool.key(self, key, modifiers);
        self.tool = tool;
        if taken {
            return;
        }
        if key == Key::Escape {
            self.problem = None;
            self.wants_new_handle = false;
            self.wants_pivot = false;
        } else if let Some(command) = self.key_map.command(key, modifiers) {
            self.execute(command);
        }
    }

    fn job_done(&mut self, done: JobDone) {
        let kind = done.kind;
        match self.engine.accept(done) {
            Arrival::Nothing | Arrival::Picking => {}
            Arrival::Enclosed(vertices) => match std::mem::take(&mut self.tool) {
                Tool::Outline(outline) => outline.take(self, vertices),
                other => self.tool = other,
            },
            Arrival::Mirrored(image) => self.take_mirrored(image),
            Arrival::Problem(sentence) => self.problem = Some(sentence),
            Arrival::Shape(solved, finality) => {
                if self.document.settled || solved.from_rest.len() != self.document.from_rest.len() {
                    return;
                }
                self.descent = solved.descent;
                self.document.show(solved.from_rest, solved.from_file);
                if finality == Finality::Final {
                    self.document.settled = true;
                }
            }
        }
        // Nobody looks any more, and nothing was found: it was stopped, or it failed.
        if kind == JobKind::Enclose && self.tool.is_looking() && !self.engine.is_busy(kind) {
            self.abort_tool();
        }
    }

    fn open(&mut self, model: Arc<Model>, name: String, beginning: Option<Beginning>) {
        self.abort_tool();
        self.held.clear();
        self.problem = None;
        self.mirroring = None;
        self.descent = None;
        self.selected = None;
        self.companions.clear();
        self.wants_new_handle = false;
        self.wants_pivot = false;
        self.file_name = name;
        self.document = match beginning.as_ref().map(|beginning| beginning.document(&model)) {
            None => Document::new(model.surface.positions.len()),
            Some(Ok(document)) => document,
            Some(Err(error)) => {
                self.problem = Some(error.to_string());
                Document::new(model.surface.positions.len())
            }
        };
        self.selected = self.document.handles.first().map(|handle| handle.id);
        self.history = History::new(Arc::clone(&self.document.from_rest), HISTORY_BYTES);
        self.brush = Brush::default();
        if let Some(bounds) = model.bounds() {
            self.camera.scale = if bounds.diagonal() > 0.0 {
                bounds.diagonal()
            } else {
                1.0
            };
        }
        self.camera_history = CameraHistory::default();
        self.engine.open(model);
        self.known = self.document.clone();
        self.shape_counter += 1;
        self.regions_revision += 1;
        self.recolouring.whole(self.regions_revision);
        self.rims_revision += 1;
        self.frame_all();
        if let Some(camera) = beginning.as_ref().and_then(Beginning::camera) {
            self.camera = camera;
            self.is_framed = false;
        }
    }

    /// Whether the event must wait for rays that answer from what is drawn, for what an outline holds, or for those
    /// that wait already.
    fn must_wait(&mut self, event: &Event) -> bool {
        let waits = !self.held.is_empty() || self.tool.is_looking();
        match event {
            Event::Key(Key::Escape, _) | Event::PointerLeft => {
                self.held.clear();
                false
            }
            Event::PointerMoved(_) | Event::PointerReleased(..) | Event::Wheel { .. } | Event::Key(..) => waits,
            Event::PointerPressed(pointer, button) => {
                let asks = *button == Button::Primary && !pointer.modifiers.alt && matches!(self.tool, Tool::Idle);
                waits
                    || (asks
                        && self.engine.is_busy(JobKind::Pick)
                        && !self.engine.is_picking_current()
                        && self
                            .overlay
                            .hit(pointer.position_px, &self.camera, self.viewport_px)
                            .is_none())
            }
            _ => false,
        }
    }
}
