//! Control points that a transform moves: their positions at its beginning, and their new positions.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::document::{FreePoint, HandleCurve, HandleId, put_curve};
use crate::view::Camera;
use crate::workspace::{ControlSource, Workspace, middle, put_attachment};

/// The selected points of the selected handle's curve, or of the method's cage or lattice.
#[derive(Debug)]
pub(super) struct MovedControls {
    /// The owner at the beginning of the transform; the first move makes an attachment the document's.
    source: ControlSource,
    /// The points, and their visible positions.
    points: Vec<(u32, DVec3)>,
    /// True if a curve is a chain: the others follow a moved point at their distances.
    is_chain: bool,
}

impl MovedControls {
    /// The selected points; `None` if there are none.
    pub(super) fn of_selected(workspace: &Workspace, is_chain: bool) -> Option<Self> {
        if workspace.controls.is_empty() {
            return None;
        }
        let shown = workspace.shown_controls()?;
        let seen = |point: u32| shown.positions.get(point as usize).map(|position| (point, *position));
        let points: Vec<(u32, DVec3)> = workspace
            .controls
            .points()
            .iter()
            .filter_map(|&point| seen(point))
            .collect();
        (!points.is_empty()).then_some(Self {
            source: shown.source,
            points,
            is_chain,
        })
    }

    /// Their name in the history.
    pub(super) fn designation(&self) -> String {
        let of = match &self.source {
            ControlSource::Attachment(name, _) => name,
            ControlSource::Curve(..) => "curve",
        };
        match self.points.as_slice() {
            [(point, _)] => format!("point {point} of the {of}"),
            points => format!("{} points of the {of}", points.len()),
        }
    }

    /// The middle of their visible positions at the beginning.
    pub(super) fn centre(&self) -> DVec3 {
        middle(self.points.iter().map(|(_, seen)| *seen))
    }

    /// The middle of their present visible positions.
    pub(super) fn centre_now(&self, workspace: &Workspace) -> Option<DVec3> {
        let shown = workspace.shown_controls()?;
        let seen: Option<Vec<DVec3>> = self
            .points
            .iter()
            .map(|(point, _)| shown.positions.get(*point as usize).copied())
            .collect();
        Some(middle(seen?.into_iter()))
    }

    /// Moves each point by the displacement of its visible position.
    pub(super) fn put(&self, workspace: &mut Workspace, way: impl Fn(DVec3) -> DVec3) {
        match &self.source {
            ControlSource::Attachment(name, attachment) => {
                let mut moved = attachment.moved().map_or_else(Vec::new, |moved| moved.to_vec());
                for (point, seen) in &self.points {
                    moved[*point as usize] += way(*seen);
                }
                if moved.iter().all(|point| point.is_finite()) {
                    workspace.refusal = None;
                    let attachment = attachment.with_moved(Arc::new(moved));
                    put_attachment(&mut workspace.document, name, attachment);
                }
            }
            ControlSource::Curve(handle, curve, then) => {
                let moved = self.moved_curve(curve, then, way);
                let curve = curve.with(moved, curve.twist_deg().to_vec(), curve.scale().to_vec());
                put(workspace, *handle, curve);
            }
        }
    }

    /// Frees a single point of a curve along the direction of sight, if the curve's handle is free in depth: it has been
    /// moved just now.
    pub(super) fn free_depth(&self, workspace: &mut Workspace, camera: &Camera) {
        let (ControlSource::Curve(id, _, then), [(point, _)]) = (&self.source, self.points.as_slice()) else {
            return;
        };
        let handle = workspace
            .document
            .handle(*id)
            .filter(|handle| handle.free_along.is_some());
        let curve = handle.and_then(|handle| handle.line.as_ref()?.curve().cloned());
        let Some((curve, place)) = curve.and_then(|curve| Some((curve.clone(), *curve.moved().get(*point as usize)?)))
        else {
            return;
        };
        let sight = -camera.towards_eye(then.transform_point3(place));
        let free = FreePoint {
            point: *point,
            along: then.inverse().transform_vector3(sight),
            is_chain: self.is_chain && !curve.rest().is_closed(),
        };
        put(workspace, *id, Some(curve.freed_at(Some(free))));
    }

    /// Turns a single point of a curve about the curve's tangent there, by a turn about `axis`; false for anything else.
    pub(super) fn twist(&self, workspace: &mut Workspace, axis: DVec3, angle_rad: f64) -> bool {
        self.change_point(workspace, |curve, then, point, twist_deg, _| {
            let place = curve.rest().point_places()[point];
            let tangent = curve.motion_at(1.0).turn_at(place) * curve.rest().frame(place).z_axis;
            let side = then.transform_vector3(tangent).dot(axis).signum();
            twist_deg[point] += side * angle_rad.to_degrees();
        })
    }

    /// Scales the surface around a single point of a curve; false for anything else.
    pub(super) fn scale(&self, workspace: &mut Workspace, factors: DVec3) -> bool {
        let factor = (factors.x * factors.y * factors.z).abs().cbrt();
        self.change_point(workspace, |_, _, point, _, scale| scale[point] *= factor)
    }

    fn change_point(
        &self,
        workspace: &mut Workspace,
        change: impl FnOnce(&HandleCurve, &DAffine3, usize, &mut [f64], &mut [f64]),
    ) -> bool {
        let (ControlSource::Curve(handle, curve, then), [(point, _)]) = (&self.source, self.points.as_slice()) else {
            return false;
        };
        let (mut twist_deg, mut scale) = (curve.twist_deg().to_vec(), curve.scale().to_vec());
        change(curve, then, *point as usize, &mut twist_deg, &mut scale);
        put(workspace, *handle, curve.with(curve.moved().to_vec(), twist_deg, scale));
        true
    }

    /// The control points of a curve after the points' displacements.
    fn moved_curve(&self, curve: &HandleCurve, then: &DAffine3, way: impl Fn(DVec3) -> DVec3) -> Vec<DVec3> {
        let back = then.inverse();
        let mut seen: Vec<DVec3> = curve.moved().iter().map(|p| then.transform_point3(*p)).collect();
        match self.points.as_slice() {
            [(point, from)] if self.is_chain && !curve.rest().is_closed() => {
                seen = curve.chain(seen).pulled(*point as usize, *from + way(*from));
            }
            points => {
                for (point, from) in points {
                    seen[*point as usize] = *from + way(*from);
                }
            }
        }
        // Points that stay keep their bits.
        let moved = seen.into_iter().zip(curve.moved());
        let moved = moved.map(|(seen, before)| {
            let stays = seen == then.transform_point3(*before);
            if stays { *before } else { back.transform_point3(seen) }
        });
        moved.collect()
    }
}

/// Gives a handle a curve, if it is one.
fn put(workspace: &mut Workspace, handle: HandleId, curve: Option<HandleCurve>) {
    if let Some(curve) = curve {
        workspace.refusal = None;
        put_curve(&mut workspace.document, handle, curve);
    }
}
