//! The gesture that a button begins: the gizmo comes first, then the surface, then the camera.

use super::constraint::Constraint;
use super::context::Context;
use super::gesture::Gesture;
use super::mode::{StrokeShape, ToolMode};
use super::navigate::Navigate;
use super::outline::OutlineStroke;
use super::paint::PaintStroke;
use super::stiffness::StiffnessStroke;
use super::transform::TransformDrag;
use super::transform_measure::TransformKind;
use crate::document::Paint;
use crate::input::{Button, Pointer};
use crate::view::{GizmoPart, Pick};
use crate::workspace::set_pivot;

/// What has begun, if anything.
type Begun = Option<Box<dyn Gesture>>;

/// A button went down.
pub(crate) fn begin(context: &mut Context<'_>, pointer: Pointer, button: Button) -> Begun {
    let modifiers = pointer.modifiers;
    match button {
        Button::Secondary => return None,
        Button::Middle => return navigate(context, pointer, button),
        Button::Primary if modifiers.alt || modifiers.shift => return navigate(context, pointer, button),
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
    if mode != ToolMode::Select && matches!(shape, StrokeShape::Lasso | StrokeShape::Box) {
        return outline(context, pointer, shape);
    }
    let Some(pick) = context.workspace.pick(context.view, pointer.position_px) else {
        return navigate(context, pointer, button);
    };
    context.workspace.refusal = None;
    if std::mem::take(&mut context.settings.wants_pivot) {
        if let Some(id) = context.workspace.selection.selected() {
            set_pivot(context.workspace, id, pick.point);
        }
        return None;
    }
    match mode {
        ToolMode::PaintStiffness => Some(Box::new(StiffnessStroke::begin(context, pointer))),
        ToolMode::Select => select(context, pointer, button, pick),
        _ if shape == StrokeShape::Component => {
            let mut stroke = PaintStroke::begin_without_dab(context.workspace, context.settings, pointer)?;
            let part = context.workspace.part_of(pick.vertex);
            stroke.finish_with(context.workspace, part);
            None
        }
        _ => Some(Box::new(PaintStroke::begin(context, pointer)?)),
    }
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
    if context.settings.mode == ToolMode::PaintStiffness {
        let why = "Stiffness is painted with the brush: press B for it.";
        context.workspace.refuse(why);
        return None;
    }
    context.workspace.refusal = None;
    Some(Box::new(OutlineStroke::begin(context, pointer, shape)?))
}

/// Selects the handle that was clicked, and begins to drag it; beside handles the camera moves.
fn select(context: &mut Context<'_>, pointer: Pointer, button: Button, pick: Pick) -> Begun {
    let Some(Paint::Handle(handle)) = context.workspace.document.paint().get(pick.vertex.index()).copied() else {
        return navigate(context, pointer, button);
    };
    if pointer.modifiers.ctrl {
        context.workspace.selection.toggle(handle);
        return None;
    }
    context.workspace.selection.click(handle);
    let drag = TransformDrag::begin(context, TransformKind::Move, Constraint::Free, pointer.position_px)?;
    Some(Box::new(drag.held(button, None)))
}
