//! The settings of tools: the chosen one, its selection of vertices, the gizmo's orientation.

use pliant_mesh::SurfaceVertex;

use super::brush::{BRUSH_RADIUS_PX, BrushMetric, BrushSize};
use super::correction_brush::{Correction, CorrectionBrush};
use super::flow_brush::FlowBrush;
use super::mode::{Depth, StrokeShape, ToolMode};
use super::rim::RimUse;
use super::stiffness_brush::{StiffnessAction, StiffnessBrush};
use crate::cut::CutStroke;
use crate::document::{HandleId, Paint};
use crate::stitching::MergeSettings;
use crate::view::{GizmoMode, GizmoOrientation};
use crate::workspace::ControlSource;

/// The tool, its brushes and the gizmo.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct ToolSettings {
    pub(crate) mode: ToolMode,
    pub(crate) stroke_shape: StrokeShape,
    pub(crate) depth: Depth,
    brush_radius_px: f64,
    /// The measure of the brush for handles: half a shell of a limb would turn into the limb.
    handle_metric: BrushMetric,
    /// The measure for everything else that is painted.
    other_metric: BrushMetric,
    pub(crate) stiffness_brush: StiffnessBrush,
    pub(crate) correction_brush: CorrectionBrush,
    pub(crate) flow_brush: FlowBrush,
    /// The pressure of a pen, 0 to 1; `None` until the system reports it.
    pub(crate) pressure: Option<f64>,
    pub(crate) gizmo_mode: GizmoMode,
    pub(crate) orientation: GizmoOrientation,
    /// True if the points of a curve follow a dragged one at their distances.
    pub(crate) chain: bool,
    /// True if a drag of the pose brush bends a limb at all its joints.
    pub(crate) whole_limb: bool,
    /// True if the next click moves the selected handle's pivot.
    pub(crate) wants_pivot: bool,
    /// The use of the rim that the next click takes.
    pub(crate) wants_rim: Option<RimUse>,
    /// The pairs of places on borders that were picked for a merge.
    pub(super) picked_pairs: Vec<[SurfaceVertex; 2]>,
    /// The line or curve that the next drag draws, along which the surface is cut.
    pub(crate) wants_cut: Option<CutStroke>,
    /// How parts are merged.
    pub(crate) merge: MergeSettings,
}

impl Default for ToolSettings {
    fn default() -> Self {
        Self {
            mode: ToolMode::default(),
            stroke_shape: StrokeShape::default(),
            depth: Depth::default(),
            brush_radius_px: 30.0,
            handle_metric: BrushMetric::Round,
            other_metric: BrushMetric::Screen,
            stiffness_brush: StiffnessBrush::default(),
            correction_brush: CorrectionBrush::default(),
            flow_brush: FlowBrush::default(),
            pressure: None,
            gizmo_mode: GizmoMode::default(),
            orientation: GizmoOrientation::default(),
            chain: false,
            whole_limb: false,
            wants_pivot: false,
            wants_rim: None,
            picked_pairs: Vec::new(),
            wants_cut: None,
            merge: MergeSettings::default(),
        }
    }
}

impl ToolSettings {
    /// The brush of the chosen tool.
    pub(crate) fn brush(&self) -> BrushSize {
        let is_for_handles = paints_handles(self.mode);
        BrushSize {
            radius_px: self.brush_radius_px,
            metric: if is_for_handles {
                self.handle_metric
            } else {
                self.other_metric
            },
        }
    }

    /// The share of the radius at which the chosen tool's brush has half of its strength; `None` for a hard rim.
    pub(crate) fn soft_share(&self) -> Option<f64> {
        let soft = |falloff: f64| (falloff > 0.0).then_some(1.0 - falloff / 2.0);
        match self.mode {
            ToolMode::PaintStiffness if self.stiffness_brush.action == StiffnessAction::Rigid => None,
            ToolMode::PaintStiffness => soft(self.stiffness_brush.falloff),
            ToolMode::Flow => soft(self.flow_brush.falloff),
            // Where (1 - s²)² is a half.
            ToolMode::Correct if self.correction_brush.correction != Correction::Grab => {
                Some((1.0 - 0.5_f64.sqrt()).sqrt())
            }
            _ => None,
        }
    }

    /// Returns true if a stroke draws a curve that a new handle follows.
    pub(crate) fn draws_curves(&self) -> bool {
        let is_curve = self.stroke_shape.is_line() && self.stroke_shape != StrokeShape::Sketch;
        self.mode == ToolMode::PaintHandle && is_curve
    }

    /// Returns true if the chosen tool shows these control points: those of a curve always, and a cage or lattice only
    /// if it can move them.
    pub(crate) fn shows(&self, source: &ControlSource) -> bool {
        self.mode == ToolMode::Select || matches!(source, ControlSource::Curve(..))
    }

    /// Returns true if the next press has a purpose of its own.
    pub(crate) fn waits_for_press(&self) -> bool {
        self.wants_pivot || self.wants_rim.is_some() || self.wants_cut.is_some()
    }

    /// The next press is the tool's again.
    pub(crate) fn want_nothing(&mut self) {
        (self.wants_pivot, self.wants_rim, self.wants_cut) = (false, None, None);
        self.picked_pairs.clear();
    }

    /// Chooses the measure of the chosen tool's brush; the tools that paint handles share one, and so do the others.
    pub(crate) fn set_brush_metric(&mut self, metric: BrushMetric) {
        if paints_handles(self.mode) {
            self.handle_metric = metric;
        } else {
            self.other_metric = metric;
        }
    }

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
            self.brush_radius_px = radius_px.clamp(*BRUSH_RADIUS_PX.start(), *BRUSH_RADIUS_PX.end());
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

/// Returns true if a tool paints handles or erases them.
fn paints_handles(mode: ToolMode) -> bool {
    matches!(mode, ToolMode::PaintHandle | ToolMode::Erase | ToolMode::Select)
}
