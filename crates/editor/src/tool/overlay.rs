//! The overlay: the brush's ring and the selected handle's gizmo.
//!
//! While a brush is active the gizmo is faded and strokes go through it: only the part that the pointer rests on is
//! highlighted, and a press grabs it.

use glam::{DVec2, DVec3};

use super::brush::ring;
use super::mode::{StrokeShape, ToolMode};
use super::settings::ToolSettings;
use crate::view::{Camera, GizmoAxes, GizmoPart, GizmoShape, View, gizmo_shapes, hit_gizmo};
use crate::workspace::Workspace;

/// What of the overlay is shown, by what goes on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Lit {
    /// Without a gesture: the gizmo, with the part under the pointer highlighted, or else the brush's ring.
    Pointed,
    /// The gizmo, with this part lit.
    Gizmo(Option<GizmoPart>),
    /// The brush's ring.
    Ring,
}

/// The overlay as it is shown.
#[derive(Debug, Default)]
pub(crate) struct Overlay {
    pub(crate) ring: Vec<DVec3>,
    pub(crate) gizmo: Vec<GizmoShape>,
    /// The part of the gizmo under the pointer, without a gesture.
    pub(crate) hovered: Option<GizmoPart>,
    pub(crate) is_over_surface: bool,
    pub(crate) revision: u64,
    /// The part that the pointer rests on.
    rested: Option<GizmoPart>,
}

/// How much of its colour the gizmo keeps while a brush is active.
const FADED: f64 = 0.4;

impl Overlay {
    /// The part of the gizmo that a press at a point of the viewport grabs.
    pub(crate) fn grabbed(&self, position_px: DVec2, view: &View, settings: &ToolSettings) -> Option<GizmoPart> {
        let part = hit_gizmo(&self.gizmo, position_px, view.camera(), view.viewport_px());
        part.filter(|part| settings.mode == ToolMode::Select || self.rested == Some(*part))
    }

    /// The pointer rests at a point of the viewport. Squares and the centre lie over what the next stroke paints, so only
    /// lines can be rested on.
    pub(crate) fn rest(&mut self, pointer_px: Option<DVec2>, view: &View) {
        let part = pointer_px.and_then(|px| hit_gizmo(&self.gizmo, px, view.camera(), view.viewport_px()));
        self.rested = part.filter(|part| !matches!(part, GizmoPart::Centre | GizmoPart::Square(_)));
    }

    /// Computes the overlay anew; its revision grows if it looks different.
    pub(crate) fn renew(
        &mut self,
        lit: Lit,
        workspace: &Workspace,
        view: &View,
        settings: &ToolSettings,
        pointer_px: Option<DVec2>,
    ) {
        let (camera, viewport_px) = (view.camera(), view.viewport_px());
        let gizmo_of = |part| gizmo(lit, workspace, camera, viewport_px, settings, part).unwrap_or_default();
        let mut gizmo = gizmo_of(None);
        let highlighted = match (lit, pointer_px) {
            (Lit::Pointed, Some(pointer_px)) => hit_gizmo(&gizmo, pointer_px, camera, viewport_px),
            (Lit::Gizmo(part), _) => part,
            _ => None,
        };
        let is_painting = settings.mode != ToolMode::Select && lit == Lit::Pointed;
        // A pointer that leaves the part, or any other action, ends the rest.
        self.rested = self
            .rested
            .filter(|part| lit == Lit::Pointed && highlighted == Some(*part));
        let highlighted = if is_painting { self.rested } else { highlighted };
        if highlighted.is_some() {
            gizmo = gizmo_of(highlighted);
        }
        if is_painting {
            for shape in gizmo.iter_mut().filter(|shape| Some(shape.part) != highlighted) {
                shape.colour[3] = (f64::from(shape.colour[3]) * FADED) as u8;
            }
        }
        let (mut line, mut is_over_surface) = (Vec::new(), false);
        if let (Some(pointer_px), Some(picking)) = (pointer_px, workspace.picking(view))
            && !matches!(lit, Lit::Gizmo(_))
            && highlighted.is_none()
            && let Some(pick) = picking.at(pointer_px)
        {
            is_over_surface = true;
            let has_ring = settings.mode != ToolMode::Select && settings.stroke_shape == StrokeShape::Brush;
            if has_ring && !settings.wants_pivot {
                line = ring(&picking, pointer_px, &pick, &settings.brush);
            }
        }
        self.hovered = highlighted.filter(|_| lit == Lit::Pointed);
        self.is_over_surface = is_over_surface;
        if self.ring != line || self.gizmo != gizmo {
            self.ring = line;
            self.gizmo = gizmo;
            self.revision += 1;
        }
    }
}

/// The selected handle's gizmo, if it is to be shown.
fn gizmo(
    lit: Lit,
    workspace: &Workspace,
    camera: &Camera,
    viewport_px: DVec2,
    settings: &ToolSettings,
    highlighted: Option<GizmoPart>,
) -> Option<Vec<GizmoShape>> {
    let handle = workspace.selected()?;
    if lit == Lit::Ring || !handle.visible || handle.locked || handle.is_pin {
        return None;
    }
    let axes = GizmoAxes::of(&handle.transform, settings.orientation, camera);
    let (mode, centre) = (settings.gizmo_mode, handle.centre());
    Some(gizmo_shapes(mode, centre, axes, camera, viewport_px, highlighted))
}
