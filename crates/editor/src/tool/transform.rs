//! Moving, turning and scaling a handle, by its gizmo or by G, R and S: begin, preview, commit or abort.
//!
//! A drag of the gizmo ends when its button goes up; a transform begun by a key follows the pointer without a button
//! and ends with a click or Enter. Both understand x, y, z (with Shift: every axis but that one), typed numbers, and
//! Escape.

use glam::{DQuat, DVec2, DVec3};

use super::Tool;
use crate::document::HandleId;
use crate::document::Transaction;
use crate::document::accumulated;
use crate::editor::Editor;
use crate::tool::constraint::{
    Constraint, along_axis, angle_about_axis_rad, axis_vector, on_plane, rotation, screen_angle_rad, short_turn_rad,
};
use crate::tool::number_entry::NumberEntry;
use crate::view::GizmoPart;
use crate::{Button, HandleTransform, Key, Modifiers, Pointer, Readout};

/// A held button must move the pointer this far before a handle follows.
const THRESHOLD_PX: f64 = 3.0;
/// The smallest factor that the pointer can scale by.
const MIN_FACTOR: f64 = 1e-3;
/// What Ctrl holds turns to: 5 degrees.
const SNAP_RAD: f64 = std::f64::consts::PI / 36.0;
/// What Ctrl holds factors to.
const SNAP_FACTOR: f64 = 0.1;
/// What Ctrl holds lengths to is the largest power of ten below this many points.
const SNAP_PX: f64 = 40.0;

/// What is done to the handle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum TransformKind {
    Move,
    Turn,
    Scale,
}

/// When it ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Ending {
    /// With a click or Enter.
    Click,
    /// When the button goes up.
    Release(Button),
}

/// A transform that goes on.
#[derive(Debug)]
pub(crate) struct TransformDrag {
    transaction: Transaction,
    handle: HandleId,
    kind: TransformKind,
    constraint: Constraint,
    ending: Ending,
    part: Option<GizmoPart>,
    /// The handle's transform when it began.
    start: HandleTransform,
    /// Where the handle's pivot is, on the rest shape and when it began.
    pivot: DVec3,
    centre: DVec3,
    start_px: DVec2,
    last_px: DVec2,
    /// Whether the pointer has moved far enough.
    is_armed: bool,
    /// The turn so far, which may exceed a full circle.
    turned_rad: f64,
    number: NumberEntry,
    /// Whether Ctrl holds the pointer's way to round numbers.
    snaps: bool,
    /// The gizmo's axes when it began.
    basis: DQuat,
    /// Handles that go along, as they were when it began.
    companions: Vec<Companion>,
}

/// A handle that goes along.
#[derive(Clone, Copy, Debug)]
struct Companion {
    id: HandleId,
    start: HandleTransform,
    pivot: DVec3,
    centre: DVec3,
}

impl TransformDrag {
    /// Begins with the selected handle; `None` if none is selected. It ends with a click.
    pub(crate) fn begin(
        editor: &mut Editor,
        kind: TransformKind,
        constraint: Constraint,
        start_px: DVec2,
    ) -> Option<Self> {
        let handle = editor.document.handle(editor.selected?)?.clone();
        if let Some(why) = editor.held_because(handle.id) {
            editor.problem = Some(why);
            return None;
        }
        let companions = editor
            .companions
            .iter()
            .filter(|&&id| id != handle.id && handle.twin.is_none_or(|twin| twin.handle != id))
            .filter_map(|&id| editor.document.handle(id))
            .map(|companion| Companion {
                id: companion.id,
                start: companion.transform,
                pivot: companion.pivot,
                centre: companion.centre(),
            })
            .collect();
        let basis = editor.gizmo_axes(&handle).basis;
        let verb = kind.verb();
        let transaction = editor.begin(format!("{verb} {}", handle.name));
        Some(Self {
            transaction,
            handle: handle.id,
            kind,
            constraint,
            ending: Ending::Click,
            part: None,
            start: handle.transform,
            pivot: handle.pivot,
            centre: handle.centre(),
            start_px,
            last_px: start_px,
            is_armed: true,
            turned_rad: 0.0,
            number: NumberEntry::default(),
            snaps: false,
            basis,
            companions,
        })
    }

    /// The same, held by a button: it ends when that goes up.
    pub(crate) fn held(mut self, button: Button, part: Option<GizmoPart>) -> Self {
        self.ending = Ending::Release(button);
        self.part = part;
        self.is_armed = false;
        self
    }

    /// The part of the gizmo that was grabbed.
    pub(crate) fn part(&self) -> Option<GizmoPart> {
        self.part
    }

    pub(crate) fn moved(mut self: Box<Self>, editor: &mut Editor, pointer: Pointer) -> Tool {
        self.is_armed |= pointer.position_px.distance(self.start_px) >= THRESHOLD_PX;
        self.snaps = pointer.modifiers.ctrl;
        if self.kind == TransformKind::Turn {
            self.turned_rad += self.turn_rad(editor, self.last_px, pointer.position_px);
        }
        self.last_px = pointer.position_px;
        self.preview(editor);
        Tool::Transform(self)
    }

    pub(crate) fn pressed(self: Box<Self>, editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
        match (self.ending, button) {
            (_, Button::Secondary) => {
                self.abort(editor);
                Tool::Idle
            }
            (Ending::Click, Button::Primary) => {
                let Tool::Transform(drag) = self.moved(editor, pointer) else {
                    return Tool::Idle;
                };
                drag.commit(editor)
            }
            _ => Tool::Transform(self),
        }
    }

    pub(crate) fn released(self: Box<Self>, editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
        if self.ending != Ending::Release(button) {
            return Tool::Transform(self);
        }
        let Tool::Transform(drag) = self.moved(editor, pointer) else {
            return Tool::Idle;
        };
        drag.commit(editor)
    }

    pub(crate) fn key(mut self: Box<Self>, editor: &mut Editor, key: Key, modifiers: Modifiers) -> (Tool, bool) {
        match key {
            Key::Escape => {
                self.abort(editor);
                return (Tool::Idle, true);
            }
            Key::Enter => return (self.commit(editor), true),
            Key::Character(letter @ 'x'..='z') if !modifiers.ctrl && !modifiers.alt => {
                let axis = usize::from(letter as u8 - b'x');
                let wanted = if modifiers.shift {
                    Constraint::Plane(axis)
                } else {
                    Constraint::Axis(axis)
                };
                self.constraint = if self.constraint == wanted {
                    Constraint::Free
                } else {
                    wanted
                };
                self.restart(editor);
            }
            Key::Character(letter @ ('g' | 'r' | 's'))
                if modifiers == Modifiers::NONE && self.ending == Ending::Click =>
            {
                let kind = match letter {
                    'g' => TransformKind::Move,
                    'r' => TransformKind::Turn,
                    _ => TransformKind::Scale,
                };
                if kind != self.kind {
                    self.kind = kind;
                    self.constraint = Constraint::Free;
                    let name = self
                        .transaction
                        .before()
                        .handle(self.handle)
                        .map_or("", |handle| handle.name.as_str());
                    let name = format!("{} {name}", kind.verb());
                    self.transaction.rename(name);
                    self.start_px = self.last_px;
                    self.restart(editor);
                }
            }
            _ if self.number.take(key) => {
                self.is_armed = true;
            }
            // Other commands (undo above all) would act on a document that is about to change.
            _ => return (Tool::Transform(self), true),
        }
        self.preview(editor);
        (Tool::Transform(self), true)
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        self.transaction.abort(&mut editor.document);
        editor.engine.drop_solves();
    }

    /// What goes on, for the status line.
    pub(crate) fn status(&self, editor: &Editor) -> String {
        let verb = match self.kind {
            TransformKind::Move => "Moving",
            TransformKind::Turn => "Turning",
            TransformKind::Scale => "Scaling",
        };
        let value = format!(" by {}", self.measure(editor));
        let end = match self.ending {
            Ending::Click => "click or Enter to keep it",
            Ending::Release(_) => "let go to keep it",
        };
        format!(
            "{verb}{}{value}: x, y, z hold it to an axis, numbers type, {end}, Esc to leave it",
            self.constraint.label()
        )
    }

    /// The number to show beside the handle, once there is one.
    pub(crate) fn readout(&self, editor: &Editor) -> Option<Readout> {
        let at = editor.document.handle(self.handle)?.centre();
        self.is_armed.then(|| Readout {
            at,
            text: self.measure(editor),
        })
    }

    /// How far, by what angle or factor it has come, as typed or as the pointer says.
    fn measure(&self, editor: &Editor) -> String {
        let typed = self.number.text();
        match (typed.is_empty(), self.kind) {
            (false, TransformKind::Turn) => format!("{typed}°"),
            (false, TransformKind::Scale) => format!("×{typed}"),
            (false, TransformKind::Move) => typed,
            (true, TransformKind::Move) => length_label(self.translation(editor).length()),
            (true, TransformKind::Turn) => format!("{:.1}°", self.angle_rad().to_degrees()),
            (true, TransformKind::Scale) => format!("×{:.3}", self.factor(editor)),
        }
    }

    /// The turn, typed or made by the pointer.
    fn angle_rad(&self) -> f64 {
        match self.number.value() {
            Some(degrees) => degrees.to_radians(),
            None if self.snaps => (self.turned_rad / SNAP_RAD).round() * SNAP_RAD,
            None => self.turned_rad,
        }
    }

    fn commit(self, editor: &mut Editor) -> Tool {
        self.transaction.commit(&editor.document, &mut editor.history);
        Tool::Idle
    }

    /// The turn counts from the start again, along another constraint.
    fn restart(&mut self, editor: &Editor) {
        self.turned_rad = 0.0;
        if self.kind == TransformKind::Turn {
            self.turned_rad = self.turn_rad(editor, self.start_px, self.last_px);
        }
    }

    fn preview(&self, editor: &mut Editor) {
        if !self.is_armed {
            return;
        }
        match self.kind {
            TransformKind::Move => {
                let way = self.translation(editor);
                editor.put_handle(self.handle, self.start.moved_by(way));
                for other in &self.companions {
                    editor.put_handle(other.id, other.start.moved_by(way));
                }
            }
            TransformKind::Turn => {
                let (axis, angle_rad) = (self.turn_axis(editor), self.angle_rad());
                let turn = rotation(axis, angle_rad);
                editor.put_handle(self.handle, self.start.turned_by(turn, self.pivot));
                if let (HandleTransform::Trs { rotation, .. }, Some(before)) =
                    (self.start, self.transaction.before().handle(self.handle))
                {
                    let counted = accumulated(before.turn_deg, rotation, axis, angle_rad);
                    editor.count_turn(self.handle, counted);
                }
                for other in &self.companions {
                    let way = turn * (other.centre - self.centre) - (other.centre - self.centre);
                    editor.put_handle(other.id, other.start.turned_by(turn, other.pivot).moved_by(way));
                }
            }
            TransformKind::Scale => {
                let (factors, own) = (self.scale(editor), self.own_rotation());
                editor.put_handle(self.handle, self.start.scaled_by(factors, self.pivot));
                for other in &self.companions {
                    let arm = other.centre - self.centre;
                    let way = own * (factors * (own.inverse() * arm)) - arm;
                    editor.put_handle(other.id, other.start.scaled_by(factors, other.pivot).moved_by(way));
                }
            }
        }
    }

    /// An axis of the gizmo.
    fn axis(&self, axis: usize) -> DVec3 {
        self.basis * axis_vector(axis)
    }

    /// How far the handle goes, in world units.
    fn translation(&self, editor: &Editor) -> DVec3 {
        if let Some(length) = self.number.value() {
            return match self.constraint {
                Constraint::Free => self.axis(0) * length,
                Constraint::Axis(axis) => self.axis(axis) * length,
                Constraint::Plane(axis) => self.basis * ((DVec3::ONE - axis_vector(axis)) * length),
            };
        }
        let [from, to] = [self.start_px, self.last_px].map(|px| editor.camera.ray(px, editor.viewport_px));
        match self.constraint {
            Constraint::Axis(axis) => {
                let axis = self.axis(axis);
                let way = along_axis(from, self.centre, axis).zip(along_axis(to, self.centre, axis));
                way.map_or(DVec3::ZERO, |(from, to)| axis * self.snapped(editor, to - from))
            }
            Constraint::Free | Constraint::Plane(_) => {
                let normal = match self.constraint {
                    Constraint::Plane(axis) => self.axis(axis),
                    _ => editor.camera.forward(),
                };
                let way = on_plane(from, self.centre, normal).zip(on_plane(to, self.centre, normal));
                way.map_or(DVec3::ZERO, |(from, to)| {
                    let way = to - from;
                    match self.constraint {
                        // Exactly within the plane, so that the other coordinate keeps its bits.
                        Constraint::Plane(axis) if self.basis == DQuat::IDENTITY => {
                            let snapped = way.to_array().map(|part| self.snapped(editor, part));
                            DVec3::from(snapped) * (DVec3::ONE - axis_vector(axis))
                        }
                        Constraint::Free if self.snaps => {
                            let axes = editor.camera.axes();
                            let along = |axis: DVec3| axis * self.snapped(editor, way.dot(axis));
                            along(axes.x_axis) + along(axes.y_axis)
                        }
                        _ => way,
                    }
                })
            }
        }
    }

    /// A length, held to round numbers while Ctrl is: the power of ten that some dozens of points of the screen span.
    fn snapped(&self, editor: &Editor, length: f64) -> f64 {
        if !self.snaps {
            return length;
        }
        let seen = SNAP_PX * editor.camera.world_per_px(self.centre, editor.viewport_px);
        let step = 10.0_f64.powf(seen.log10().floor());
        (length / step).round() * step
    }

    fn turn_axis(&self, editor: &Editor) -> DVec3 {
        match self.constraint {
            Constraint::Free => -editor.camera.forward(),
            Constraint::Axis(axis) | Constraint::Plane(axis) => self.axis(axis),
        }
    }

    /// The turn that the pointer's way from one point to another means.
    fn turn_rad(&self, editor: &Editor, from_px: DVec2, to_px: DVec2) -> f64 {
        let axis = self.turn_axis(editor);
        let to_eye = editor.camera.towards_eye(self.centre);
        // Within the ring's plane where that is seen well, else on the screen.
        if self.part.is_some() && axis.dot(to_eye).abs() > 0.25 {
            let [from, to] = [from_px, to_px].map(|px| {
                let point = on_plane(editor.camera.ray(px, editor.viewport_px), self.centre, axis)?;
                angle_about_axis_rad(point, self.centre, axis)
            });
            if let (Some(from), Some(to)) = (from, to) {
                return short_turn_rad(from, to);
            }
        }
        let Some(centre_px) = editor.camera.project(self.centre, editor.viewport_px) else {
            return 0.0;
        };
        let sign = if axis.dot(to_eye) < 0.0 { -1.0 } else { 1.0 };
        match (screen_angle_rad(from_px, centre_px), screen_angle_rad(to_px, centre_px)) {
            (Some(from), Some(to)) => sign * short_turn_rad(from, to),
            _ => 0.0,
        }
    }

    /// The factor that the pointer's way means.
    fn factor(&self, editor: &Editor) -> f64 {
        match self.number.value() {
            Some(factor) => factor,
            None if self.snaps => (self.pointed_factor(editor) / SNAP_FACTOR).round().max(1.0) * SNAP_FACTOR,
            None => self.pointed_factor(editor),
        }
    }

    fn pointed_factor(&self, editor: &Editor) -> f64 {
        if let (Some(GizmoPart::Box(axis)), Constraint::Axis(_)) = (self.part, self.constraint) {
            let axis = self.own_rotation() * axis_vector(axis);
            let [from, to] = [self.start_px, self.last_px]
                .map(|px| along_axis(editor.camera.ray(px, editor.viewport_px), self.centre, axis));
            if let (Some(from), Some(to)) = (from, to)
                && from.abs() > 0.0
            {
                return (to / from).max(MIN_FACTOR);
            }
        }
        match editor.camera.project(self.centre, editor.viewport_px) {
            Some(centre_px) => {
                let start = self.start_px.distance(centre_px).max(1.0);
                (self.last_px.distance(centre_px) / start).max(MIN_FACTOR)
            }
            None => 1.0,
        }
    }

    /// One factor for each of the handle's own axes.
    fn scale(&self, editor: &Editor) -> DVec3 {
        let factor = self.factor(editor);
        match self.constraint {
            Constraint::Free => DVec3::splat(factor),
            Constraint::Axis(axis) => DVec3::ONE + axis_vector(axis) * (factor - 1.0),
            Constraint::Plane(axis) => DVec3::splat(factor) + axis_vector(axis) * (1.0 - factor),
        }
    }

    fn own_rotation(&self) -> DQuat {
        match self.start {
            HandleTransform::Trs { rotation, .. } => rotation,
            HandleTransform::Matrix(_) => DQuat::IDENTITY,
        }
    }
}

/// A length in four digits.
fn length_label(length: f64) -> String {
    let digits = match length.abs() {
        size if size >= 1000.0 => 0,
        size if size >= 100.0 => 1,
        size if size >= 10.0 => 2,
        size if size >= 0.01 || size == 0.0 => 4,
        _ => return format!("{length:.2e}"),
    };
    format!("{length:.digits$}")
}

impl TransformKind {
    fn verb(self) -> &'static str {
        match self {
            Self::Move => "Move",
            Self::Turn => "Turn",
            Self::Scale => "Scale",
        }
    }
}
