//! The program without a window: its parts, and the single function through which everything changes.

mod queries;
mod waiting;

use std::collections::VecDeque;
use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::Model;

use crate::Beginning;
use crate::command::{Command, KeyMap, Scope, frame_all};
use crate::document::{Document, SavedAs};
use crate::event::Event;
use crate::input::{Button, Key, Modifiers, Pointer};
use crate::jobs::{Activity, Asked, Executor, JobDone, JobKind};
use crate::tool::{
    Adjust, Brush, Context, Gesture, Lit, Next, Overlay, ToolMode, ToolSettings, begin, drop_unseen, hover, tint,
};
use crate::view::{Shading, UpAxis, View, up_axis_of};
use crate::workspace::{ColouredBy, Workspace, merge_held, take_mirrored, take_stitched};

/// The factor by which a notch of the wheel changes the brush's size.
const WHEEL_STEP: f64 = 1.15;
/// The softening of the stiffness brush by a notch of the wheel.
const WHEEL_FALLOFF: f64 = 0.1;

/// The program without a window.
pub struct Editor {
    workspace: Workspace,
    view: View,
    settings: ToolSettings,
    brush: Brush,
    overlay: Overlay,
    /// The state of the pointer.
    gesture: Option<Box<dyn Gesture>>,
    pointer: Option<Pointer>,
    /// The place at which the pointer left the view.
    left_at: Option<Pointer>,
    /// The notches of the wheel, below one, that have not chosen another joint yet.
    joint_lines: f64,
    key_map: KeyMap,
    /// The held key that shows the original.
    showing_original: Option<Key>,
    /// Events that wait until the hierarchy for rays has the drawn shape.
    waiting: VecDeque<Event>,
    /// The mesh after the last event.
    mesh: Option<Arc<Model>>,
}

impl Editor {
    /// An editor without a file. Jobs go to `executor`.
    pub fn new(executor: Box<dyn Executor>) -> Self {
        Self {
            workspace: Workspace::new(executor),
            view: View::default(),
            settings: ToolSettings::default(),
            brush: Brush::default(),
            overlay: Overlay::default(),
            gesture: None,
            pointer: None,
            left_at: None,
            joint_lines: 0.0,
            key_map: KeyMap::default(),
            showing_original: None,
            waiting: VecDeque::new(),
            mesh: None,
        }
    }

    /// The one function through which everything changes.
    pub fn handle(&mut self, event: Event) {
        let picked = matches!(&event, Event::JobDone(done) if done.kind == JobKind::Pick);
        // A frame has many events, and each of them would otherwise let some more through.
        let goes_on = matches!(&event, Event::Tick) || !self.is_catching_up();
        if self.must_wait(&event) {
            self.waiting.push_back(event);
        } else {
            self.dispatch(event);
        }
        self.conclude();
        if picked || (goes_on && self.is_catching_up()) {
            self.catch_up();
        }
        let lit = self.gesture.as_ref().map_or((Lit::Pointed, Vec::new()), |gesture| {
            (gesture.lit(), gesture.shapes(&self.view))
        });
        self.overlay
            .renew(lit, &self.workspace, &self.view, &self.settings, self.pointer);
    }

    fn dispatch(&mut self, event: Event) {
        match event {
            Event::Viewport { size_px } => self.resize(size_px),
            Event::PointerMoved(pointer) => {
                self.pointer = Some(pointer);
                self.ask_gesture(|gesture, context| gesture.moved(context, pointer));
            }
            Event::PointerRested => {
                let pointer_px = self.pointer.map(|pointer| pointer.position_px);
                self.overlay.rest(pointer_px, &self.view);
            }
            Event::PointerLeft => {
                if self.gesture.is_none() {
                    self.left_at = self.pointer.take().or(self.left_at);
                }
            }
            Event::PointerPressed(pointer, button) => self.press(pointer, button),
            Event::PointerReleased(pointer, button) => {
                self.pointer = Some(pointer);
                self.ask_gesture(|gesture, context| gesture.released(context, pointer, button));
            }
            Event::Wheel { pointer, lines } => self.wheel(pointer, lines),
            Event::Pinch { pointer, factor } => {
                if factor.is_finite() && factor > 0.0 {
                    self.zoom(pointer, |view, anchor| {
                        view.travel(|camera| camera.zoom(factor, anchor))
                    });
                }
            }
            Event::Pressure(pressure) => self.settings.set_pressure(pressure),
            Event::Key(key, modifiers) => self.key(key, modifiers),
            Event::KeyReleased(key) => self.key_released(key),
            Event::Command(command) => self.execute(command),
            Event::Keys(key_map) => self.key_map = key_map,
            Event::Memory(most) => {
                let Workspace { jobs, document, .. } = &mut self.workspace;
                if jobs.allow_memory(most, document) {
                    self.workspace.refusal = None;
                }
            }
            Event::Adjust(command) => self.adjust(command),
            Event::Adjusted => {
                if self.workspace.is_adjusting() {
                    self.workspace.commit_adjusting();
                    self.gesture = None;
                }
            }
            Event::Tick => self.workspace.tick(),
            Event::JobDone(done) => self.job_done(done),
            Event::Opened { model, name, beginning } => self.open(model, name, beginning),
            Event::OpenedSequence { count, shown, fps } => {
                self.workspace.open_sequence(count, shown, fps);
                self.view.look.timeline = true;
            }
            Event::Frame(frame, shape) => self.workspace.take_frame(frame, shape),
            Event::MixFrame(sequence, frame, shape) => {
                let shape = shape.as_ref().map(|shape| shape.as_slice()).map_err(String::clone);
                self.workspace.take_mix_frame(&sequence, frame, shape);
            }
            Event::Followed(following, frames) => self.workspace.take_followed(&following, frames),
            Event::Stitched(result) => {
                self.abort_gesture();
                take_stitched(&mut self.workspace, result.map(|new| *new));
            }
            Event::Recovered(needed) => self.workspace.history.mark_unsaved(needed),
            Event::Saved(what, mark) => {
                let Workspace { history, document, .. } = &mut self.workspace;
                history.sync(document);
                history.mark_saved(what, mark, document);
            }
        }
    }

    /// Applies the consequences of an event's changes: jobs, colours, the camera's history.
    fn conclude(&mut self) {
        self.follow_mesh();
        // Any other gesture is about the shown frame.
        if self.gesture.is_none() || self.workspace.is_adjusting() {
            self.workspace.show_wanted_frame();
        }
        self.workspace.follow_path();
        self.view.follow_body(self.workspace.body_motion());
        let gesture = self.gesture.as_deref();
        let activity = match gesture.map(Gesture::activity) {
            // Nothing prepares for the pointer between two frames.
            None | Some(Activity::Still) if self.workspace.keys.is_playing() => Activity::Dragging,
            None => Activity::Still,
            Some(activity) => activity,
        };
        let by = match self.settings.mode {
            ToolMode::PaintStiffness => ColouredBy::Stiffness,
            ToolMode::Flow => ColouredBy::Dye,
            _ => ColouredBy::Region,
        };
        let look = &self.view.look;
        let selected = self.workspace.selection.selected();
        let asked = Asked {
            weights_of: selected.filter(|_| look.shading == Shading::Weights),
            base: look.base,
        };
        let is_posing = self.settings.mode == ToolMode::Pose;
        let pointer_px = self.pointer.map(|pointer| pointer.position_px);
        let hovering_px = pointer_px.filter(|_| is_posing && gesture.is_none());
        if !is_posing {
            self.workspace.jobs.forget_joint();
        } else if gesture.is_none() {
            hover(&mut self.workspace, &self.view, hovering_px, self.settings.whole_limb);
        }
        tint(&mut self.workspace, &self.view, hovering_px, self.settings.whole_limb);
        drop_unseen(&mut self.workspace, &self.settings);
        self.workspace.follow_flow(gesture.is_none());
        self.workspace.follow_skins(&self.view.look, activity);
        self.workspace.conclude(activity, by, asked);
        if !gesture.is_some_and(Gesture::moves_camera) {
            self.view.rest();
        }
    }

    /// Forgets everything that belongs to another mesh, if an event has changed it.
    fn follow_mesh(&mut self) {
        let mesh = self.workspace.model();
        let is_same = match (&self.mesh, mesh) {
            (Some(before), Some(now)) => Arc::ptr_eq(before, now),
            (before, now) => before.is_some() == now.is_some(),
        };
        if is_same {
            return;
        }
        self.mesh = mesh.cloned();
        self.gesture = None;
        self.waiting.clear();
        self.showing_original = None;
        self.view.look.original = false;
        self.settings.want_nothing();
        self.brush = Brush::default();
    }

    /// The active gesture, and separately everything that it may change.
    fn parts(&mut self) -> (&mut Option<Box<dyn Gesture>>, Context<'_>) {
        let context = Context {
            workspace: &mut self.workspace,
            view: &mut self.view,
            settings: &mut self.settings,
            brush: &mut self.brush,
            overlay: &self.overlay,
            pointer: self.pointer,
            left_at: self.left_at,
        };
        (&mut self.gesture, context)
    }

    /// Passes an event to the active gesture, if there is one, and returns the next step.
    fn ask_gesture(&mut self, ask: impl FnOnce(&mut dyn Gesture, &mut Context<'_>) -> Next) -> Option<Next> {
        let (gesture, mut context) = self.parts();
        let next = ask(gesture.as_deref_mut()?, &mut context);
        if next != Next::Stay {
            *gesture = None;
        }
        Some(next)
    }

    /// Ends the gesture without a trace.
    fn abort_gesture(&mut self) {
        self.ask_gesture(|gesture, context| {
            gesture.abort(context);
            Next::End
        });
    }

    fn press(&mut self, pointer: Pointer, button: Button) {
        self.pointer = Some(pointer);
        let next = self.ask_gesture(|gesture, context| gesture.pressed(context, pointer, button));
        if matches!(next, None | Some(Next::EndBefore)) {
            let (gesture, mut context) = self.parts();
            *gesture = begin(&mut context, pointer, button);
        }
    }

    fn key(&mut self, key: Key, modifiers: Modifiers) {
        let mut is_taken = false;
        self.ask_gesture(|gesture, context| {
            let next = gesture.key(context, key, modifiers);
            is_taken = next.is_some();
            next.unwrap_or(Next::Stay)
        });
        if is_taken {
            return;
        }
        if key == Key::Enter
            && let Some(pairs) = self.settings.pairs()
        {
            if self.workspace.stitching.is_none() {
                self.workspace.refusal = None;
                merge_held(&mut self.workspace, pairs, self.settings.merge.clone());
            }
            return;
        }
        if key == Key::Escape && self.workspace.keys.is_playing() {
            self.workspace.pause_keys();
        } else if key == Key::Escape {
            // The most recent mode ends first: one that waits for a click, then the comparison.
            let waits = self.settings.waits_for_press() || self.workspace.selection.wants_new_handle;
            if !waits {
                self.workspace.jobs.end_comparing();
            }
            self.workspace.refusal = None;
            self.workspace.selection.wants_new_handle = false;
            self.workspace.controls.put([]);
            self.settings.want_nothing();
        } else if let Some(command) = self.key_map.command(key, modifiers) {
            // A held key repeats: its display stays until it goes up.
            let is_held = command == Command::ToggleOriginal && self.showing_original == Some(key);
            if !is_held {
                self.showing_original = (command == Command::ToggleOriginal).then_some(key);
                self.execute(command);
            }
        }
    }

    /// Ends the display of a held key.
    fn key_released(&mut self, key: Key) {
        if self.showing_original == Some(key) {
            self.showing_original = None;
            self.view.look.original = false;
        }
    }

    /// Executes the command; one that is not available now is ignored.
    fn execute(&mut self, command: Command) {
        if !self.is_enabled(&command) {
            return;
        }
        let scope = command.scope();
        let activity = self.gesture.as_ref().map(|gesture| gesture.activity());
        let had_gesture = activity.is_some();
        if scope != Scope::View {
            self.abort_gesture();
        }
        if !matches!(scope, Scope::View | Scope::Tool) {
            self.workspace.refusal = None;
        }
        if activity == Some(Activity::Dragging) && scope == Scope::Document {
            self.workspace.refuse("The active drag was cancelled: drag again.");
        }
        // Undo during a drag aborts the drag, and nothing before it.
        if !(had_gesture && scope == Scope::History) {
            self.act(command);
        }
    }

    fn act(&mut self, command: Command) {
        let (gesture, mut context) = self.parts();
        if let Some(begun) = command.act(&mut context) {
            *gesture = Some(begun);
        }
    }

    /// Adds a command to the step of the adjusted widget; the first command begins the step.
    fn adjust(&mut self, command: Command) {
        // Commands that make their own steps or gestures can't be part of a step.
        if matches!(command.scope(), Scope::History | Scope::Gesture) {
            return;
        }
        if !self.workspace.is_adjusting() {
            self.abort_gesture();
            self.gesture = Some(Box::new(Adjust::begin(&mut self.workspace)));
        }
        if self.is_enabled(&command) {
            self.act(command);
        }
    }

    /// The wheel zooms; with Ctrl it sizes the brush or chooses the joint of the limb, with Shift it softens the brush
    /// for stiffness.
    fn wheel(&mut self, pointer: Pointer, lines: f64) {
        let (modifiers, settings) = (pointer.modifiers, &mut self.settings);
        if modifiers.ctrl && settings.mode.has_brush() {
            settings.set_brush_radius(settings.brush().radius_px * WHEEL_STEP.powf(lines));
        } else if modifiers.ctrl && settings.mode == ToolMode::Pose {
            self.joint_lines += lines;
            let places = self.joint_lines.trunc();
            self.joint_lines -= places;
            if places != 0.0 && self.gesture.is_none() {
                self.workspace.jobs.want_joint(Some(places as i32));
            }
        } else if modifiers.shift && settings.mode == ToolMode::PaintStiffness {
            let mut brush = settings.stiffness_brush;
            brush.falloff = (brush.falloff + WHEEL_FALLOFF * lines).clamp(0.0, 1.0);
            settings.stiffness_brush = brush.clamped().unwrap_or(settings.stiffness_brush);
        } else {
            self.zoom(pointer, |view, anchor| {
                view.travel(|camera| camera.zoom_lines(lines, anchor));
            });
        }
    }

    fn zoom(&mut self, pointer: Pointer, zoom: impl FnOnce(&mut View, DVec3)) {
        if !self.gesture.as_ref().is_some_and(|gesture| gesture.holds_camera()) {
            let anchor = self.workspace.anchor(&self.view, pointer.position_px);
            zoom(&mut self.view, anchor);
        }
    }

    fn resize(&mut self, size_px: glam::DVec2) {
        if self.view.resize(size_px) && self.view.is_framed() {
            frame_all(&self.workspace, &mut self.view);
        }
    }

    fn job_done(&mut self, done: JobDone) {
        let kind = done.kind;
        let arrival = self.workspace.jobs.accept(done);
        match self.workspace.take_arrival(arrival) {
            Some(JobKind::Enclose) => {
                let inside = self.workspace.jobs.computed.slots.enclose.take().unwrap_or_default();
                self.ask_gesture(|gesture, context| gesture.found(context, inside));
            }
            Some(JobKind::Joint) => {
                self.ask_gesture(|gesture, context| gesture.found_joint(context));
            }
            Some(JobKind::Mirror) => take_mirrored(&mut self.workspace, self.gesture.is_none()),
            _ => {}
        }
        if kind == JobKind::Flow {
            self.workspace.take_flowed();
            self.ask_gesture(|gesture, context| gesture.flowed(context));
        }
        // The search has ended without a result: it was stopped, or it failed.
        let is_search = matches!(kind, JobKind::Enclose | JobKind::Joint);
        if is_search && self.is_looking() && !self.workspace.jobs.is_busy(kind) {
            self.abort_gesture();
        }
    }

    fn open(&mut self, model: Arc<Model>, name: String, beginning: Option<Beginning>) {
        let count = model.surface.positions.len();
        let begun = beginning.as_ref().map(|beginning| beginning.document(&model));
        let (document, refusal) = match begun {
            None => (Document::new(count), None),
            Some(Ok(document)) => (document, None),
            Some(Err(error)) => (Document::new(count), Some(error.to_string())),
        };
        let size = model.bounds_without_specks().map(|bounds| bounds.diagonal());
        self.begin_file(size, up_axis_of(&model), |workspace| {
            workspace.open(model, name, document);
            workspace.refusal = refusal;
        });
        let animation = self.workspace.document.animation();
        self.view.look.path = animation.path().is_some();
        self.view.look.timeline |= self.view.look.path || !animation.keys().is_empty();
        if matches!(beginning, Some(Beginning::Project(_))) {
            self.workspace.history.needs(SavedAs::Project);
        }
        if let Some(camera) = beginning.as_ref().and_then(Beginning::camera) {
            self.view.travel(|present| *present = camera);
        }
    }

    /// Opens another file in the workspace, and frames all of it.
    fn begin_file(&mut self, size: Option<f64>, up: UpAxis, open: impl FnOnce(&mut Workspace)) {
        self.abort_gesture();
        open(&mut self.workspace);
        self.view.open(size.map(|size| if size > 0.0 { size } else { 1.0 }), up);
        frame_all(&self.workspace, &mut self.view);
    }
}

impl std::fmt::Debug for Editor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Editor")
            .field("file_name", &self.file_name())
            .field("mode", &self.settings.mode)
            .finish_non_exhaustive()
    }
}
