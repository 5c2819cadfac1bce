//! The gesture that a button begins: the gizmo comes first, then control points, the surface
//! and the camera.

use super::constraint::Constraint;
use super::context::Context;
use super::control_box::ControlBox;
use super::correct;
use super::crease_stroke::CreaseStroke;
use super::curve_stroke::CurveStroke;
use super::cut_curve::CutCurveStroke;
use super::cut_line::CutLine;
use super::flow_stroke::FlowStroke;
use super::gesture::Gesture;
use super::large_stroke::LargeStroke;
use super::mode::{StrokeShape, ToolMode};
use super::navigate::Navigate;
use super::outline::OutlineStroke;
use super::paint::PaintStroke;
use super::path_drag::PathDrag;
use super::pose::PoseDrag;
use super::rim::RimUse;
use super::sketch_stroke::SketchStroke;
use super::smooth::SmoothStroke;
use super::stiffness::StiffnessStroke;
use super::taken_handle::is_taken_along;
use super::transform::TransformDrag;
use super::transform_measure::TransformKind;
use crate::cut::CutStroke;
use crate::document::Paint;
use crate::input::{Button, Pointer};
use crate::stitching::MeshChange;
use crate::view::{GizmoPart, Pick};
use crate::workspace::{free_path, set_pivot, stitch};

/// The beginning of a gesture.
type Begun = Option<Box<dyn Gesture>>;

/// A button went down.
pub(crate) fn begin(context: &mut Context<'_>, pointer: Pointer, button: Button) -> Begun {
    let modifiers = pointer.modifiers;
    match button {
        Button::Secondary | Button::Middle => return navigate(context, pointer, button),
        Button::Primary if !modifiers.alt && context.settings.wants_rim.is_some() => {
            return take_rim(context, pointer);
        }
        Button::Primary
            if !modifiers.alt
                && let Some(stroke) = context.settings.wants_cut =>
        {
            context.workspace.refusal = None;
            return Some(match stroke {
                CutStroke::Line(kept) => Box::new(CutLine::begin(context.workspace, pointer, kept)),
                CutStroke::Curve(kept) => Box::new(CutCurveStroke::begin(context.workspace, pointer, kept)),
            });
        }
        Button::Primary
            if !modifiers.alt
                && let Some(point) = control_under(context, pointer) =>
        {
            return take_control(context, pointer, point);
        }
        Button::Primary
            if !modifiers.alt
                && let Some(frame) = path_under(context, pointer) =>
        {
            return take_path(context, pointer, frame);
        }
        Button::Primary if modifiers.ctrl && boxes_controls(context) => {
            return Some(Box::new(ControlBox::begin(pointer, StrokeShape::Box)));
        }
        Button::Primary if modifiers.alt || (modifiers.shift && !heeds_shift(context)) => {
            return navigate(context, pointer, button);
        }
        Button::Primary => {}
    }
    if let Some(part) = context
        .overlay
        .grabbed(pointer.position_px, context.view, context.settings)
        && let Some(drag) = grab(context, pointer, part)
    {
        return Some(drag);
    }
    let (mode, shape) = (context.settings.mode, context.settings.stroke_shape);
    if matches!(shape, StrokeShape::Lasso | StrokeShape::Box) && boxes_controls(context) {
        return Some(Box::new(ControlBox::begin(pointer, shape)));
    }
    if mode.has_brush() && matches!(shape, StrokeShape::Lasso | StrokeShape::Box) {
        return outline(context, pointer, shape);
    }
    let is_sketching = mode == ToolMode::PaintHandle && shape == StrokeShape::Sketch && !modifiers.ctrl;
    // A new outline is drawn beside the model, too.
    if is_sketching && !context.settings.wants_pivot {
        context.workspace.refusal = None;
        return Some(Box::new(SketchStroke::begin(context, pointer)?));
    }
    let Some(pick) = context.workspace.pick(context.view, pointer.position_px) else {
        return navigate(context, pointer, button);
    };
    context.workspace.refusal = None;
    if mode != ToolMode::Select {
        // The gizmo of the painted handle is wanted next.
        context.workspace.controls.put([]);
    }
    if std::mem::take(&mut context.settings.wants_pivot) {
        if let Some(id) = context.workspace.selection.selected() {
            set_pivot(context.workspace, id, pick.point);
        }
        return None;
    }
    match mode {
        mode if modifiers.shift && mode.paints_roles() => Some(Box::new(SmoothStroke::begin(context, pointer))),
        ToolMode::PaintStiffness => Some(Box::new(StiffnessStroke::begin(context, pointer))),
        ToolMode::Correct if context.workspace.document.animation().frames().is_some() => {
            let why = "A correction would fit only one frame of the sequence: move a handle and set a key.";
            context.workspace.refuse(why);
            None
        }
        ToolMode::Correct => Some(correct::begin(context, pointer, &pick)),
        ToolMode::Flow => Some(Box::new(FlowStroke::begin(context, pointer))),
        ToolMode::Select => select(context, pointer, button, pick),
        ToolMode::Pose => Some(Box::new(PoseDrag::begin(context, pointer, pick)?)),
        _ if shape == StrokeShape::Component => {
            let mut stroke = PaintStroke::begin(context.workspace, context.settings, pointer)?;
            let part = context.workspace.part_of(pick.vertex);
            stroke.finish_with(context.workspace, |stroke, workspace| stroke.take(workspace, part));
            None
        }
        ToolMode::PaintHandle if context.settings.draws_curves() && !modifiers.ctrl => Some(match shape {
            StrokeShape::Crease => Box::new(CreaseStroke::begin(context, pointer)?),
            _ => Box::new(CurveStroke::begin(context, pointer, shape)?),
        }),
        _ if shape.is_line() => {
            let why = "A line makes a handle: choose the Handle tool, or press B for the brush.";
            context.workspace.refuse(why);
            None
        }
        _ if is_taken_along(context.workspace, context.settings, &pick, modifiers) => {
            let drag = TransformDrag::begin(context, TransformKind::Move, Constraint::Free, pointer.position_px)?;
            Some(Box::new(drag.held(button, None)))
        }
        _ => {
            let mut stroke = PaintStroke::begin(context.workspace, context.settings, pointer)?;
            if LargeStroke::suits(context) {
                return Some(Box::new(LargeStroke::begin(context, stroke, pointer)));
            }
            stroke.dab(context, pointer.position_px);
            Some(Box::new(stroke))
        }
    }
}

/// Returns true if Shift changes the tool's effect on the surface: a brush smooths, a limb grows.
fn heeds_shift(context: &Context<'_>) -> bool {
    let settings = &*context.settings;
    let is_brush = settings.mode.has_brush() && settings.stroke_shape == StrokeShape::Brush;
    settings.mode == ToolMode::Pose || is_brush
}

/// The control point under the pointer, if a press takes it: the gizmo is in front of the points, and a brush paints
/// the surface behind them.
fn control_under(context: &Context<'_>, pointer: Pointer) -> Option<u32> {
    let point = context.overlay.pointed_control?;
    let at_px = pointer.position_px;
    let is_gizmo = context.overlay.grabbed(at_px, context.view, context.settings).is_some();
    (!is_gizmo).then_some(point)
}

/// The frame of the body's path under the pointer, if a press takes it.
fn path_under(context: &Context<'_>, pointer: Pointer) -> Option<usize> {
    let frame = context.overlay.pointed_frame?;
    let at_px = pointer.position_px;
    let is_gizmo = context.overlay.grabbed(at_px, context.view, context.settings).is_some();
    (!is_gizmo).then_some(frame)
}

/// Begins to drag the body's path at a frame; with Ctrl it is no longer moved there.
fn take_path(context: &mut Context<'_>, pointer: Pointer, frame: usize) -> Begun {
    context.workspace.refusal = None;
    if pointer.modifiers.ctrl {
        free_path(context.workspace, frame);
        return None;
    }
    Some(Box::new(PathDrag::begin(context, pointer, frame)?))
}

/// Returns true if a box or a lasso selects control points.
fn boxes_controls(context: &Context<'_>) -> bool {
    context.settings.mode == ToolMode::Select && !context.overlay.control_points.is_empty()
}

/// Selects a control point, and begins to drag it with the other selected ones.
fn take_control(context: &mut Context<'_>, pointer: Pointer, point: u32) -> Begun {
    context.workspace.refusal = None;
    if pointer.modifiers.shift || pointer.modifiers.ctrl {
        context.workspace.controls.toggle(point);
        return None;
    }
    context.workspace.controls.click(point);
    let drag = TransformDrag::begin(context, TransformKind::Move, Constraint::Free, pointer.position_px)?;
    Some(Box::new(drag.held(Button::Primary, None)))
}

/// Takes the rim under the pointer; beside all rims the camera moves.
fn take_rim(context: &mut Context<'_>, pointer: Pointer) -> Begun {
    let Some((wanted, rim)) = context.settings.wants_rim.zip(context.overlay.rim.as_ref()) else {
        return navigate(context, pointer, Button::Primary);
    };
    context.workspace.refusal = None;
    context.settings.wants_rim = None;
    match wanted {
        RimUse::Fill => stitch(context.workspace, MeshChange::FillAt(rim.vertex)),
        RimUse::Bridge { first: None } => {
            let first = Some(rim.vertex);
            context.settings.wants_rim = Some(RimUse::Bridge { first });
        }
        RimUse::Bridge { first: Some(first) } => stitch(context.workspace, MeshChange::Bridge([first, rim.vertex])),
        RimUse::Merge { first } => context.settings.pick_for_pair(first, rim.vertex),
    }
    None
}

fn navigate(context: &mut Context<'_>, pointer: Pointer, button: Button) -> Begun {
    let navigate = Navigate::begin(context.workspace, context.view, pointer, button);
    Some(Box::new(navigate))
}

/// Grabs a part of the gizmo.
fn grab(context: &mut Context<'_>, pointer: Pointer, part: GizmoPart) -> Begun {
    let (kind, constraint) = match part {
        GizmoPart::Centre => (TransformKind::Move, Constraint::Free),
        GizmoPart::Arrow(axis) => (TransformKind::Move, Constraint::Axis(axis)),
        GizmoPart::Square(axis) => (TransformKind::Move, Constraint::Plane(axis)),
        GizmoPart::Ring(axis) => (TransformKind::Turn, Constraint::Axis(axis)),
        GizmoPart::Box(axis) => (TransformKind::Scale, Constraint::Axis(axis)),
    };
    let drag = TransformDrag::begin(context, kind, constraint, pointer.position_px)?;
    Some(Box::new(drag.held(Button::Primary, Some(part))))
}

/// Begins a lasso or a box.
fn outline(context: &mut Context<'_>, pointer: Pointer, shape: StrokeShape) -> Begun {
    let why = match context.settings.mode {
        ToolMode::PaintStiffness => Some("Stiffness is painted with the brush: press B for it."),
        ToolMode::Correct => Some("The shape is corrected with the brush: press B for it."),
        ToolMode::Flow => Some("Colour is poured with the brush: press B for it."),
        _ => None,
    };
    if let Some(why) = why {
        context.workspace.refuse(why);
        return None;
    }
    context.workspace.refusal = None;
    Some(Box::new(OutlineStroke::begin(context, pointer, shape)?))
}

/// Selects the clicked handle, and begins to drag it; outside handles the camera moves.
fn select(context: &mut Context<'_>, pointer: Pointer, button: Button, pick: Pick) -> Begun {
    let Some(Paint::Handle(handle)) = context.workspace.document.paint().get(pick.vertex.index()).copied() else {
        return navigate(context, pointer, button);
    };
    context.workspace.controls.put([]);
    if pointer.modifiers.ctrl {
        context.workspace.selection.toggle(handle);
        return None;
    }
    context.workspace.selection.click(handle);
    let drag = TransformDrag::begin(context, TransformKind::Move, Constraint::Free, pointer.position_px)?;
    Some(Box::new(drag.held(button, None)))
}
