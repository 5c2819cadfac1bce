//! The settings of tools: the chosen one, its selection of vertices, the gizmo's orientation.

use super::brush::{BRUSH_RADIUS_PX, BrushSize};
use super::correction_brush::CorrectionBrush;
use super::mode::{Depth, StrokeShape, ToolMode};
use super::stiffness_brush::StiffnessBrush;
use crate::document::{HandleId, Paint};
use crate::view::{GizmoMode, GizmoOrientation};

/// The tool, its brushes and the gizmo.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct ToolSettings {
    pub(crate) mode: ToolMode,
    pub(crate) stroke_shape: StrokeShape,
    pub(crate) depth: Depth,
    pub(crate) brush: BrushSize,
    pub(crate) stiffness_brush: StiffnessBrush,
    pub(crate) correction_brush: CorrectionBrush,
    /// The pressure of a pen, 0 to 1; `None` until the system reports it.
    pub(crate) pressure: Option<f64>,
    pub(crate) gizmo_mode: GizmoMode,
    pub(crate) orientation: GizmoOrientation,
    /// True if the next click moves the selected handle's pivot.
    pub(crate) wants_pivot: bool,
}

impl ToolSettings {
    /// The role for region commands: the tool's, else the selected handle's.
    pub(crate) fn selected_role(&self, selected: Option<HandleId>) -> Option<Paint> {
        match self.mode {
            ToolMode::PaintFree => Some(Paint::Free),
            ToolMode::PaintFixed => Some(Paint::Fixed),
            _ => selected.map(Paint::Handle),
        }
    }

    /// Chooses the brush's radius, clamped to its range.
    pub(crate) fn set_brush_radius(&mut self, radius_px: f64) {
        if radius_px.is_finite() {
            self.brush.radius_px = radius_px.clamp(*BRUSH_RADIUS_PX.start(), *BRUSH_RADIUS_PX.end());
        }
    }

    /// The pressure of the pen; 1 for a device that reports no force.
    pub(crate) fn set_pressure(&mut self, pressure: Option<f64>) {
        let usable = pressure.filter(|pressure| pressure.is_finite());
        if pressure.is_some() || self.pressure.is_some() {
            self.pressure = Some(usable.map_or(1.0, |pressure| pressure.clamp(0.0, 1.0)));
        }
    }
}
