//! What lies over the surface: the brush's ring and the selected handle's gizmo.

use glam::{DVec2, DVec3};

use crate::editor::Editor;
use crate::tool::Tool;
use crate::tool::brush::ring;
use crate::view::Camera;
use crate::view::{GizmoPart, GizmoShape, gizmo_shapes, hit_gizmo};
use crate::{StrokeShape, ToolMode};

/// The overlay as it is shown.
#[derive(Debug, Default)]
pub(crate) struct Overlay {
    pub(crate) ring: Vec<DVec3>,
    pub(crate) gizmo: Vec<GizmoShape>,
    /// The part of the gizmo under the pointer.
    pub(crate) hovered: Option<GizmoPart>,
    pub(crate) is_over_surface: bool,
    pub(crate) revision: u64,
}

impl Overlay {
    /// The part of the gizmo at a point of the viewport.
    pub(crate) fn hit(&self, position_px: DVec2, camera: &Camera, viewport_px: DVec2) -> Option<GizmoPart> {
        hit_gizmo(&self.gizmo, position_px, camera, viewport_px)
    }
}

impl Editor {
    /// Computes the overlay anew; its revision grows if it looks different.
    pub(crate) fn refresh_overlay(&mut self) {
        let idle = matches!(self.tool, Tool::Idle);
        let painting = matches!(self.tool, Tool::Paint(_) | Tool::Stiffness(_) | Tool::Outline(_));
        let position_px = self.pointer.map(|pointer| pointer.position_px);
        let gizmo_of = |highlighted| {
            let handle = self.selected.and_then(|id| self.document.handle(id))?;
            if painting || !handle.visible || handle.locked {
                return None;
            }
            Some(gizmo_shapes(
                self.gizmo_mode,
                handle.centre(),
                self.gizmo_axes(handle),
                &self.camera,
                self.viewport_px,
                highlighted,
            ))
        };
        let mut gizmo = gizmo_of(None).unwrap_or_default();
        let highlighted = match (&self.tool, position_px) {
            (Tool::Idle, Some(position_px)) => hit_gizmo(&gizmo, position_px, &self.camera, self.viewport_px),
            (Tool::Transform(drag), _) => drag.part(),
            _ => None,
        };
        if highlighted.is_some() {
            gizmo = gizmo_of(highlighted).unwrap_or_default();
        }
        let mut outline = Vec::new();
        let mut is_over_surface = false;
        if let (Some(position_px), Some(picking)) = (position_px, self.picking())
            && (idle || painting)
            && highlighted.is_none()
            && let Some(pick) = picking.at(position_px)
        {
            is_over_surface = true;
            if self.mode != ToolMode::Select && self.stroke_shape == StrokeShape::Brush && !self.wants_pivot {
                outline = ring(&picking, position_px, &pick, &self.brush_size());
            }
        }
        let overlay = &mut self.overlay;
        (overlay.hovered, overlay.is_over_surface) = (if idle { highlighted } else { None }, is_over_surface);
        if overlay.ring != outline || overlay.gizmo != gizmo {
            overlay.ring = outline;
            overlay.gizmo = gizmo;
            overlay.revision += 1;
        }
    }
}
