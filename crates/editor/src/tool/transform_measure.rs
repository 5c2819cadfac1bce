//! The length, angle or factor of a transform, from the pointer or a typed number.

use glam::{DQuat, DVec2, DVec3};

use super::constraint::{Constraint, along_axis, angle_about_axis_rad, on_plane, screen_angle_rad, short_turn_rad};
use super::number_entry::NumberEntry;
use crate::document::HandleTransform;
use crate::input::Pointer;
use crate::view::{ControlShape, GizmoPart, View, arc_shapes, axis_vector};

/// The smallest factor of scaling by the pointer.
const MIN_FACTOR: f64 = 1e-3;
/// The share of the pointer's movement that counts while Shift is held.
const DAMPED: f64 = 0.1;
/// Ctrl snaps turns to this: 15 degrees.
const SNAP_RAD: f64 = std::f64::consts::PI / 12.0;
/// Ctrl snaps factors to this.
const SNAP_FACTOR: f64 = 0.1;
/// Ctrl snaps lengths to the largest power of ten below this many points.
const SNAP_PX: f64 = 40.0;
/// Ctrl snaps objects nearer to the ground than this many points to it.
const GROUND_PX: f64 = 12.0;

/// The kind of transform.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum TransformKind {
    Move,
    Turn,
    Scale,
}

/// The beginning of a transform, and its extent by the pointer.
#[derive(Debug)]
pub(super) struct Measure {
    pub(super) kind: TransformKind,
    pub(super) constraint: Constraint,
    /// The grabbed part of the gizmo.
    pub(super) part: Option<GizmoPart>,
    /// The handle's transform at the beginning; the identity for control points.
    pub(super) start: HandleTransform,
    /// The position of the handle's pivot, or of the points' middle, at the beginning.
    pub(super) centre: DVec3,
    pub(super) start_px: DVec2,
    pub(super) last_px: DVec2,
    /// The pointer's way that Shift has held back so far.
    held_back_px: DVec2,
    /// The turn so far, which may exceed a full circle.
    turned_rad: f64,
    pub(super) number: NumberEntry,
    /// True if Ctrl snaps the pointer's movement to round numbers, and objects near the ground to it.
    snaps: bool,
    /// The height of the object's lowest point above the ground at the beginning.
    above_ground: Option<f64>,
    /// The gizmo's axes at the beginning.
    basis: DQuat,
}

impl Measure {
    /// The beginning for an object with this transform, about this centre.
    pub(super) fn begin(
        kind: TransformKind,
        constraint: Constraint,
        (start, centre): (HandleTransform, DVec3),
        basis: DQuat,
        start_px: DVec2,
    ) -> Self {
        Self {
            kind,
            constraint,
            part: None,
            start,
            centre,
            start_px,
            last_px: start_px,
            held_back_px: DVec2::ZERO,
            turned_rad: 0.0,
            number: NumberEntry::default(),
            snaps: false,
            above_ground: None,
            basis,
        }
    }

    /// The same with the ground this far below the object.
    pub(super) fn above_ground(mut self, height: Option<f64>) -> Self {
        self.above_ground = height;
        self
    }

    /// The pointer moved; Ctrl snaps, and Shift damps the movement.
    pub(super) fn move_to(&mut self, view: &View, pointer: Pointer) {
        self.snaps = pointer.modifiers.ctrl;
        if pointer.modifiers.shift {
            let way_px = pointer.position_px - self.held_back_px - self.last_px;
            self.held_back_px += way_px * (1.0 - DAMPED);
        }
        let position_px = pointer.position_px - self.held_back_px;
        if self.kind == TransformKind::Turn {
            self.turned_rad += self.turn_rad(view, self.last_px, position_px);
        }
        self.last_px = position_px;
    }

    /// Returns true if Ctrl snaps a move that no axis and no number restricts.
    pub(super) fn snaps_freely(&self) -> bool {
        let is_free = self.kind == TransformKind::Move && self.constraint == Constraint::Free;
        self.snaps && is_free && self.number.value().is_none()
    }

    /// The angle starts again, about another axis.
    pub(super) fn restart(&mut self, view: &View) {
        self.turned_rad = 0.0;
        if self.kind == TransformKind::Turn {
            self.turned_rad = self.turn_rad(view, self.start_px, self.last_px);
        }
    }

    /// The length, angle or factor, as typed or as the pointer gives it.
    pub(super) fn label(&self, view: &View) -> String {
        let typed = self.number.text();
        match (typed.is_empty(), self.kind) {
            (false, TransformKind::Turn) => format!("{typed}°"),
            (false, TransformKind::Scale) => format!("×{typed}"),
            (false, TransformKind::Move) => typed,
            (true, TransformKind::Move) => length_label(self.translation(view).length()),
            (true, TransformKind::Turn) => format!("{:.1}°", self.angle_rad().to_degrees()),
            (true, TransformKind::Scale) => format!("×{:.3}", self.factor(view)),
        }
    }

    /// The turn, typed or made by the pointer.
    pub(super) fn angle_rad(&self) -> f64 {
        match self.number.value() {
            Some(degrees) => degrees.to_radians(),
            None if self.snaps => (self.turned_rad / SNAP_RAD).round() * SNAP_RAD,
            None => self.turned_rad,
        }
    }

    /// The arc of the turn so far; none without a turn.
    pub(super) fn arc(&self, view: &View) -> Vec<ControlShape> {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        if self.kind != TransformKind::Turn || self.angle_rad() == 0.0 {
            return Vec::new();
        }
        let axis = self.turn_axis(view);
        let grabbed = on_plane(camera.ray(self.start_px, viewport_px), self.centre, axis);
        let from = grabbed.map_or(DVec3::ZERO, |point| point - self.centre);
        arc_shapes(self.centre, axis, from, self.angle_rad(), camera, viewport_px).into()
    }

    /// An axis of the gizmo.
    fn axis(&self, axis: usize) -> DVec3 {
        self.basis * axis_vector(axis)
    }

    /// The displacement of the handle, in world units.
    pub(super) fn translation(&self, view: &View) -> DVec3 {
        let way = self.way(view);
        let lands = self.snaps && self.number.value().is_none();
        match self.above_ground.filter(|_| lands) {
            Some(height) => way + self.landing(view, height + way.dot(view.camera().up.vector())),
            None => way,
        }
    }

    /// The displacement that brings the lowest point, this far above the ground, onto it, if that is near and the
    /// constraint allows it.
    fn landing(&self, view: &View, height: f64) -> DVec3 {
        let near = GROUND_PX * view.camera().world_per_px(self.centre, view.viewport_px());
        let up = view.camera().up.vector();
        let along = match self.constraint {
            Constraint::Free => Some(up),
            Constraint::Axis(axis) => Some(self.axis(axis)),
            // Within the plane only if it is vertical.
            Constraint::Plane(axis) => (self.axis(axis).dot(up).abs() < 1e-6).then_some(up),
        };
        let steep = along.filter(|along| along.dot(up).abs() > 0.5 && height.abs() <= near);
        steep.map_or(DVec3::ZERO, |along| along * (-height / along.dot(up)))
    }

    /// This holds for every height of the ground.
    fn way(&self, view: &View) -> DVec3 {
        if let Some(length) = self.number.value() {
            return match self.constraint {
                Constraint::Free => self.axis(0) * length,
                Constraint::Axis(axis) => self.axis(axis) * length,
                Constraint::Plane(axis) => self.basis * ((DVec3::ONE - axis_vector(axis)) * length),
            };
        }
        let [from, to] = [self.start_px, self.last_px].map(|px| view.camera().ray(px, view.viewport_px()));
        match self.constraint {
            Constraint::Axis(axis) => {
                let axis = self.axis(axis);
                let way = along_axis(from, self.centre, axis).zip(along_axis(to, self.centre, axis));
                way.map_or(DVec3::ZERO, |(from, to)| axis * self.snapped(view, to - from))
            }
            Constraint::Free | Constraint::Plane(_) => {
                let normal = match self.constraint {
                    Constraint::Plane(axis) => self.axis(axis),
                    _ => view.camera().forward(),
                };
                let way = on_plane(from, self.centre, normal).zip(on_plane(to, self.centre, normal));
                way.map_or(DVec3::ZERO, |(from, to)| {
                    let way = to - from;
                    match self.constraint {
                        // It stays exactly within the plane, so that the other coordinate keeps its bits.
                        Constraint::Plane(axis) if self.basis == DQuat::IDENTITY => {
                            let snapped = way.to_array().map(|part| self.snapped(view, part));
                            DVec3::from(snapped) * (DVec3::ONE - axis_vector(axis))
                        }
                        Constraint::Free if self.snaps => {
                            let axes = view.camera().axes();
                            let along = |axis: DVec3| axis * self.snapped(view, way.dot(axis));
                            along(axes.x_axis) + along(axes.y_axis)
                        }
                        _ => way,
                    }
                })
            }
        }
    }

    /// A length, snapped to round numbers while Ctrl is held: to the power of ten of some dozens of points on the
    /// screen.
    fn snapped(&self, view: &View, length: f64) -> f64 {
        if !self.snaps {
            return length;
        }
        let seen = SNAP_PX * view.camera().world_per_px(self.centre, view.viewport_px());
        let step = 10.0_f64.powf(seen.log10().floor());
        (length / step).round() * step
    }

    /// The axis of a turn.
    pub(super) fn turn_axis(&self, view: &View) -> DVec3 {
        match self.constraint {
            Constraint::Free => -view.camera().forward(),
            Constraint::Axis(axis) | Constraint::Plane(axis) => self.axis(axis),
        }
    }

    /// The turn by the pointer's movement from one point to another.
    fn turn_rad(&self, view: &View, from_px: DVec2, to_px: DVec2) -> f64 {
        let axis = self.turn_axis(view);
        let to_eye = view.camera().towards_eye(self.centre);
        // Within the ring's plane if that is clearly visible, else on the screen.
        if self.part.is_some() && axis.dot(to_eye).abs() > 0.25 {
            let [from, to] = [from_px, to_px].map(|px| {
                let point = on_plane(view.camera().ray(px, view.viewport_px()), self.centre, axis)?;
                angle_about_axis_rad(point, self.centre, axis)
            });
            if let (Some(from), Some(to)) = (from, to) {
                return short_turn_rad(from, to);
            }
        }
        let Some(centre_px) = view.camera().project(self.centre, view.viewport_px()) else {
            return 0.0;
        };
        let sign = if axis.dot(to_eye) < 0.0 { -1.0 } else { 1.0 };
        match (screen_angle_rad(from_px, centre_px), screen_angle_rad(to_px, centre_px)) {
            (Some(from), Some(to)) => sign * short_turn_rad(from, to),
            _ => 0.0,
        }
    }

    /// The factor by the pointer's movement.
    fn factor(&self, view: &View) -> f64 {
        match self.number.value() {
            Some(factor) => factor,
            None if self.snaps => (self.pointed_factor(view) / SNAP_FACTOR).round().max(1.0) * SNAP_FACTOR,
            None => self.pointed_factor(view),
        }
    }

    fn pointed_factor(&self, view: &View) -> f64 {
        if let (Some(GizmoPart::Box(axis)), Constraint::Axis(_)) = (self.part, self.constraint) {
            let axis = self.own_rotation() * axis_vector(axis);
            let [from, to] = [self.start_px, self.last_px]
                .map(|px| along_axis(view.camera().ray(px, view.viewport_px()), self.centre, axis));
            if let (Some(from), Some(to)) = (from, to)
                && from.abs() > 0.0
            {
                return (to / from).max(MIN_FACTOR);
            }
        }
        match view.camera().project(self.centre, view.viewport_px()) {
            Some(centre_px) => {
                let start = self.start_px.distance(centre_px).max(1.0);
                (self.last_px.distance(centre_px) / start).max(MIN_FACTOR)
            }
            None => 1.0,
        }
    }

    /// One factor for each of the handle's own axes.
    pub(super) fn scale(&self, view: &View) -> DVec3 {
        let factor = self.factor(view);
        match self.constraint {
            Constraint::Free => DVec3::splat(factor),
            Constraint::Axis(axis) => DVec3::ONE + axis_vector(axis) * (factor - 1.0),
            Constraint::Plane(axis) => DVec3::splat(factor) + axis_vector(axis) * (1.0 - factor),
        }
    }

    /// The handle's rotation at the beginning.
    pub(super) fn own_rotation(&self) -> DQuat {
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
    /// Its name in the history.
    pub(super) fn verb(self) -> &'static str {
        match self {
            Self::Move => "Move",
            Self::Turn => "Turn",
            Self::Scale => "Scale",
        }
    }

    /// Its text in the status line while it is active.
    pub(super) fn doing(self) -> &'static str {
        match self {
            Self::Move => "Moving",
            Self::Turn => "Turning",
            Self::Scale => "Scaling",
        }
    }
}
