//! The motion of a drag of the pose brush: the limb turns after the pointer, twists about its axis, or grows.

use glam::{DQuat, DVec2, DVec3};

use crate::document::HandleTransform;
use crate::input::Modifiers;
use crate::tool::constraint::{on_plane, rotation};
use crate::view::{ControlShape, View, arc_shapes};

/// The smallest factor of scaling by the pointer.
const MIN_FACTOR: f64 = 1e-3;

/// The shortest path of the pointer for a twist by a radian, in pixels.
const MIN_LEVER_PX: f64 = 24.0;

/// The kind of motion of the limb.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Pose {
    /// A turn about the joint: the grabbed point follows the pointer.
    Turn,
    /// A twist about the limb's axis.
    Twist,
    /// A scale about the joint.
    Scale,
}

impl Pose {
    /// The kind for these modifiers.
    pub(super) fn of(modifiers: Modifiers) -> Self {
        match modifiers {
            Modifiers { ctrl: true, .. } => Self::Twist,
            Modifiers { shift: true, .. } => Self::Scale,
            _ => Self::Turn,
        }
    }

    /// Its name in the history.
    pub(super) fn verb(self) -> &'static str {
        match self {
            Self::Turn => "Turn",
            Self::Twist => "Twist",
            Self::Scale => "Scale",
        }
    }
}

/// A motion about a joint, from the pointer's place at its beginning.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) pose: Pose,
    /// The visible position of the joint.
    pub(super) centre: DVec3,
    /// The limb's direction from the joint at the beginning, a unit vector.
    pub(super) axis: DVec3,
    /// The grabbed point of the limb.
    pub(super) grip: DVec3,
    /// The distance of the limb's farthest vertex from the joint.
    pub(super) reach: f64,
    /// The mean distance of the limb's vertices from its axis.
    pub(super) girth: f64,
    /// The handle's transform and turn in degrees at the beginning.
    pub(super) start: (HandleTransform, DVec3),
}

/// The extent of a motion.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Way {
    /// A turn about a unit axis by an angle in radians.
    Turn(DVec3, f64),
    /// A factor.
    Scale(f64),
}

impl Way {
    /// The text beside the joint.
    pub(super) fn label(self) -> String {
        match self {
            Self::Turn(_, angle_rad) => format!("{:.0}°", angle_rad.to_degrees()),
            Self::Scale(factor) => format!("×{factor:.2}"),
        }
    }
}

impl Motion {
    /// The point under the pointer at the depth of the grip.
    pub(super) fn held(&self, view: &View, position_px: DVec2) -> DVec3 {
        let ray = view.camera().ray(position_px, view.viewport_px());
        on_plane(ray, self.grip, view.camera().forward()).unwrap_or(self.grip)
    }

    /// The extent of the limb's motion by the pointer.
    pub(super) fn way(&self, view: &View, position_px: DVec2) -> Way {
        let (from, to) = (self.grip - self.centre, self.held(view, position_px) - self.centre);
        match self.pose {
            Pose::Turn => turn(from, to, view.camera().forward()),
            Pose::Twist => Way::Turn(self.axis, self.twist_rad(view, from, to)),
            Pose::Scale => {
                let [from_length, to_length] = [from, to].map(|arm| arm.reject_from(view.camera().forward()).length());
                // Near the joint the bare ratio would grow without bound.
                let whole = from_length.max(self.reach);
                let factor = if whole > 0.0 {
                    1.0 + (to_length - from_length) / whole
                } else {
                    1.0
                };
                Way::Scale(factor.max(MIN_FACTOR))
            }
        }
    }

    /// The angle in radians by which the grabbed point follows the pointer; near the axis the limb's girth is the lever.
    /// Where that point would move along the line of sight, the limb rolls like a ball under the pointer; where the axis
    /// is along it, a path to the right counts.
    fn twist_rad(&self, view: &View, from: DVec3, to: DVec3) -> f64 {
        let (camera, path) = (view.camera(), to - from);
        let least = MIN_LEVER_PX * camera.world_per_px(self.grip, view.viewport_px());
        let sight = camera.towards_eye(self.grip);
        let across = self.axis.cross(sight);
        let is_across = across.length() > 0.4;
        let radius = from.reject_from(self.axis);
        let tangent = self.axis.cross(radius);
        let seen = tangent.reject_from(sight);
        let is_seen = radius.length() >= least && seen.length() > 0.5 * tangent.length();
        let lever = self.girth.max(least);
        match (is_seen, is_across) {
            (true, true) => path.dot(seen.normalize()) / seen.length().max(lever),
            (true, false) => {
                let to = to.reject_from(self.axis);
                self.axis.dot(radius.cross(to)).atan2(radius.dot(to))
            }
            (false, true) => path.dot(across.normalize()) / radius.length().max(lever),
            (false, false) => -path.dot(camera.axes().x_axis) * self.axis.dot(sight).signum() / lever,
        }
    }

    /// The arc of the turn so far; none for a scale.
    pub(super) fn arc(&self, view: &View, position_px: DVec2) -> Vec<ControlShape> {
        match self.way(view, position_px) {
            Way::Turn(axis, angle_rad) if angle_rad != 0.0 => {
                let (camera, viewport_px) = (view.camera(), view.viewport_px());
                arc_shapes(
                    self.centre,
                    axis,
                    self.grip - self.centre,
                    angle_rad,
                    camera,
                    viewport_px,
                )
                .into()
            }
            _ => Vec::new(),
        }
    }

    /// The handle's transform after this motion, about its pivot on the rest shape.
    pub(super) fn transform(&self, way: Way, pivot: DVec3) -> HandleTransform {
        match way {
            Way::Turn(axis, angle_rad) => self.start.0.turned_by(rotation(axis, angle_rad), pivot),
            Way::Scale(factor) => self.start.0.scaled_by(DVec3::splat(factor), pivot),
        }
    }

    /// The motion that continues from there as another kind.
    pub(super) fn go_on(&self, pose: Pose, way: Way, held: DVec3, start: (HandleTransform, DVec3)) -> Self {
        let (turn, factor) = match way {
            Way::Turn(axis, angle_rad) => (rotation(axis, angle_rad), 1.0),
            Way::Scale(factor) => (DQuat::IDENTITY, factor),
        };
        Self {
            pose,
            centre: self.centre,
            axis: (turn * self.axis).normalize(),
            grip: held,
            reach: factor * self.reach,
            girth: factor * self.girth,
            start,
        }
    }
}

/// The shortest turn from one direction to another; half a turn is about the line of sight.
fn turn(from: DVec3, to: DVec3, forward: DVec3) -> Way {
    let normal = from.cross(to);
    let angle_rad = normal.length().atan2(from.dot(to));
    let about = normal.try_normalize().unwrap_or(forward);
    Way::Turn(about, angle_rad)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::{Way, turn};
    use crate::tool::constraint::rotation;

    #[test]
    fn a_turn_takes_one_direction_to_the_other_also_where_they_are_opposite() {
        let directions = [DVec3::X, DVec3::Y, DVec3::new(1.0, -2.0, 0.3), DVec3::NEG_X];
        for from in directions {
            for to in directions {
                let Way::Turn(axis, angle_rad) = turn(from, to, DVec3::Z) else {
                    panic!("a turn is a turn");
                };
                let met = rotation(axis, angle_rad) * from.normalize();
                assert!(met.distance(to.normalize()) < 1e-9, "{from} {to}: {met}");
            }
        }
    }
}
