//! A limb that bends at all its joints, so that the grabbed point follows the pointer: inverse kinematics.

use glam::{DQuat, DVec2, DVec3};
use pliant_mesh::{BendRange, JointLimits, pulled_within};

use crate::document::{HandleId, HandleTransform, Transaction, accumulated};
use crate::tool::constraint::on_plane;
use crate::view::{ControlShape, View};
use crate::workspace::{Workspace, count_turn, held_because, put_handles};

const COLOUR: [u8; 4] = [255, 150, 30, 255];

/// Lines inside the limb are visible.
const HIDDEN_SHARE: f32 = 0.7;

/// A part of the limb at the beginning of the drag.
#[derive(Clone, Copy, Debug)]
struct Part {
    handle: HandleId,
    /// Its pivot on the rest shape.
    pivot: DVec3,
    transform: HandleTransform,
    turn_deg: DVec3,
}

/// A limb whose parts are handles, each the child of the one before it.
#[derive(Debug)]
pub(super) struct Reaching {
    pub(super) transaction: Transaction,
    /// From the body on; the last one has the grabbed point.
    parts: Vec<Part>,
    /// The joints and the grabbed point at the beginning.
    points: Vec<DVec3>,
    /// The bends that the joints may have.
    bends: Vec<BendRange>,
    /// The same now.
    pulled: Vec<DVec3>,
    pub(super) is_armed: bool,
}

impl Reaching {
    /// Grabs these handles, from the body on, at a point; `None`, with a sentence, if one of them is locked.
    pub(super) fn begin(
        workspace: &mut Workspace,
        transaction: Transaction,
        handles: &[HandleId],
        grip: DVec3,
    ) -> Option<Self> {
        if let Some(why) = handles.iter().find_map(|id| held_because(workspace, *id)) {
            workspace.refuse(why);
            return None;
        }
        let (mut parts, mut points, mut bends) = (Vec::new(), Vec::new(), Vec::new());
        for &id in handles {
            let handle = workspace.document.handle(id)?;
            points.push(handle.centre());
            bends.push(handle.bend_deg.map(f64::to_radians));
            parts.push(Part {
                handle: id,
                pivot: handle.pivot,
                transform: handle.transform,
                turn_deg: handle.turn_deg,
            });
        }
        points.push(grip);
        Some(Self {
            transaction,
            parts,
            pulled: points.clone(),
            points,
            bends,
            is_armed: false,
        })
    }

    /// Bends the limb towards the point under the pointer at the depth of the grabbed one.
    pub(super) fn follow(&mut self, workspace: &mut Workspace, view: &View, position_px: DVec2) {
        let Some(&grip) = self.points.last().filter(|_| self.is_armed) else {
            return;
        };
        let ray = view.camera().ray(position_px, view.viewport_px());
        let target = on_plane(ray, grip, view.camera().forward()).unwrap_or(grip);
        let limits = JointLimits {
            bends: &self.bends,
            before: None,
        };
        self.pulled = pulled_within(&self.points, target, limits);
        let turns = turns(&self.points, &self.pulled);
        let put: Vec<(HandleId, HandleTransform)> = (self.parts.iter().zip(&turns).enumerate())
            .map(|(place, (part, turn))| {
                let way = self.pulled[place] - self.points[place];
                let turned = part.transform.turned_by(*turn, part.pivot);
                (part.handle, turned.moved_by(way))
            })
            .collect();
        put_handles(workspace, &put);
        for (part, turn) in self.parts.iter().zip(turns) {
            if let HandleTransform::Trs { rotation, .. } = part.transform {
                let (axis, angle_rad) = turn.to_axis_angle();
                let counted = accumulated(part.turn_deg, rotation, axis, angle_rad);
                count_turn(workspace, part.handle, counted);
            }
        }
    }

    /// Lines from joint to joint.
    pub(super) fn shapes(&self) -> Vec<ControlShape> {
        let lines = self.pulled.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        vec![ControlShape::lines(COLOUR, lines).with_hidden_share(HIDDEN_SHARE)]
    }
}

/// The turn of each part between two points: that of the part before it, and the shortest one from there.
fn turns(from: &[DVec3], to: &[DVec3]) -> Vec<DQuat> {
    let way = |points: &[DVec3], place: usize| (points[place + 1] - points[place]).normalize_or(DVec3::X);
    let turns = (0..from.len() - 1).scan(DQuat::IDENTITY, |turn, place| {
        let carried = *turn * way(from, place);
        *turn = (DQuat::from_rotation_arc(carried, way(to, place)) * *turn).normalize();
        Some(*turn)
    });
    turns.collect()
}

#[cfg(test)]
mod tests {
    use pliant_mesh::pulled_chain;

    use super::*;

    #[test]
    fn turns_take_each_part_to_its_new_direction() {
        let from = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::new(1.8, 0.3, 0.1),
            DVec3::new(2.2, 0.3, 0.9),
        ];
        let to = pulled_chain(&from, DVec3::new(0.4, 0.8, -0.5));
        let turns = turns(&from, &to);
        for (place, turn) in turns.into_iter().enumerate() {
            let met = turn * (from[place + 1] - from[place]);
            assert!(met.distance(to[place + 1] - to[place]) < 1e-9, "{place}: {met}");
        }
    }
}
