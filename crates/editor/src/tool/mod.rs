//! What the pointer is doing: one state machine a file, and the idle state that starts them.
//!
//! Each takes itself and gives back what comes after it, so a tool that has ended can't be asked anything. A tool that
//! is aborted leaves no trace.

mod adjust;
pub(crate) mod brush;
pub(crate) mod constraint;
mod enclosed;
mod navigate;
pub(crate) mod number_entry;
mod outline;
pub(crate) mod overlay;
mod paint;
mod stiffness;
mod transform;
mod widen;

use glam::DVec2;

pub(crate) use adjust::Adjust;
pub use brush::{BRUSH_RADIUS_PX, BrushMetric};
pub use constraint::Constraint;
pub(crate) use navigate::Navigate;
pub(crate) use outline::OutlineStroke;
pub use outline::{Depth, StrokeShape};
pub(crate) use paint::{PaintStroke, border_middle, tidy_handles};
pub(crate) use stiffness::StiffnessStroke;
pub use stiffness::{StiffnessAction, StiffnessBrush};
pub(crate) use transform::{TransformDrag, TransformKind};
pub(crate) use widen::Widen;

use crate::document::Paint;
use crate::editor::Editor;
use crate::jobs::Activity;
use crate::view::GizmoPart;
use crate::{Button, Key, Modifiers, Pointer};

/// What the left button does on the surface.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum ToolMode {
    /// Paints the selected handle, or a new one.
    #[default]
    PaintHandle,
    /// Paints the free region.
    PaintFree,
    /// Paints what is held still.
    PaintFixed,
    /// Takes paint away.
    Erase,
    /// Paints how stiff the surface is.
    PaintStiffness,
    /// Selects a handle and drags it.
    Select,
}

/// What the pointer is doing.
#[derive(Debug, Default)]
pub(crate) enum Tool {
    /// Nothing.
    #[default]
    Idle,
    /// Moving the camera.
    Navigate(Navigate),
    /// Painting.
    Paint(Box<PaintStroke>),
    /// Moving, turning or scaling a handle.
    Transform(Box<TransformDrag>),
    /// Painting stiffness.
    Stiffness(Box<StiffnessStroke>),
    /// Drawing a lasso or a box.
    Outline(Box<OutlineStroke>),
    /// Widening a handle's reach.
    Widen(Box<Widen>),
    /// Following a widget that is being dragged.
    Adjust(Box<Adjust>),
}

impl Tool {
    pub(crate) fn activity(&self) -> Activity {
        match self {
            Self::Idle | Self::Navigate(_) | Self::Adjust(_) | Self::Widen(_) => Activity::Still,
            Self::Paint(_) | Self::Stiffness(_) | Self::Outline(_) => Activity::Painting,
            Self::Transform(_) => Activity::Dragging,
        }
    }

    /// Whether a job looks for what an outline holds.
    pub(crate) fn is_looking(&self) -> bool {
        matches!(self, Self::Outline(outline) if outline.is_looking())
    }

    pub(crate) fn moved(self, editor: &mut Editor, pointer: Pointer) -> Self {
        match self {
            Self::Idle => Self::Idle,
            Self::Adjust(adjust) => Self::Adjust(adjust),
            Self::Navigate(navigate) => navigate.moved(editor, pointer),
            Self::Paint(stroke) => stroke.moved(editor, pointer),
            Self::Stiffness(stroke) => stroke.moved(editor, pointer),
            Self::Outline(stroke) => stroke.moved(pointer),
            Self::Widen(widen) => widen.moved(editor, pointer),
            Self::Transform(drag) => drag.moved(editor, pointer),
        }
    }

    pub(crate) fn pressed(self, editor: &mut Editor, pointer: Pointer, button: Button) -> Self {
        match (self, button) {
            (Self::Idle, _) => begin(editor, pointer, button),
            (Self::Transform(drag), _) => drag.pressed(editor, pointer, button),
            (Self::Widen(widen), _) => widen.pressed(editor, pointer, button),
            (Self::Adjust(adjust), _) => {
                adjust.commit(editor);
                begin(editor, pointer, button)
            }
            (tool, Button::Secondary) => tool.abort(editor),
            (tool, _) => tool,
        }
    }

    pub(crate) fn released(self, editor: &mut Editor, pointer: Pointer, button: Button) -> Self {
        match self {
            Self::Idle => Self::Idle,
            Self::Adjust(adjust) => Self::Adjust(adjust),
            Self::Navigate(navigate) => navigate.released(button),
            Self::Paint(stroke) => stroke.released(editor, pointer, button),
            Self::Stiffness(stroke) => stroke.released(editor, pointer, button),
            Self::Outline(stroke) => stroke.released(editor, pointer, button),
            Self::Widen(widen) => Self::Widen(widen),
            Self::Transform(drag) => drag.released(editor, pointer, button),
        }
    }

    /// The tool after the key, and whether the key was its own.
    pub(crate) fn key(self, editor: &mut Editor, key: Key, modifiers: Modifiers) -> (Self, bool) {
        match self {
            Self::Idle => (Self::Idle, false),
            Self::Transform(drag) => drag.key(editor, key, modifiers),
            Self::Widen(widen) => (widen.key(editor, key), true),
            tool if key == Key::Escape => (tool.abort(editor), true),
            tool => (tool, false),
        }
    }

    /// Puts everything back to how it was before the tool began.
    pub(crate) fn abort(self, editor: &mut Editor) -> Self {
        match self {
            Self::Idle => {}
            Self::Navigate(navigate) => navigate.abort(editor),
            Self::Paint(stroke) => stroke.abort(editor),
            Self::Stiffness(stroke) => stroke.abort(editor),
            Self::Outline(stroke) => stroke.abort(editor),
            Self::Widen(widen) => widen.abort(editor),
            Self::Transform(drag) => drag.abort(editor),
            Self::Adjust(adjust) => adjust.abort(editor),
        }
        Self::Idle
    }
}

/// A button went down while nothing was going on: the gizmo comes first, then the surface, then the camera.
fn begin(editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
    let Pointer { position_px, modifiers } = pointer;
    match button {
        Button::Secondary => return Tool::Idle,
        Button::Middle => return Tool::Navigate(Navigate::begin(editor, pointer, button)),
        Button::Primary if modifiers.alt || modifiers.shift => {
            return Tool::Navigate(Navigate::begin(editor, pointer, button));
        }
        Button::Primary => {}
    }
    if let Some(part) = editor.overlay.hit(position_px, &editor.camera, editor.viewport_px)
        && let Some(drag) = begin_gizmo(editor, position_px, part)
    {
        return drag;
    }
    let shape = editor.stroke_shape;
    if editor.mode != ToolMode::Select && matches!(shape, StrokeShape::Lasso | StrokeShape::Box) {
        if editor.mode == ToolMode::PaintStiffness {
            editor.problem = Some("Stiffness is painted with the brush: press B for it.".to_owned());
            return Tool::Idle;
        }
        editor.problem = None;
        let outline = OutlineStroke::begin(editor, pointer, shape);
        return outline.map_or(Tool::Idle, |outline| Tool::Outline(Box::new(outline)));
    }
    let Some(pick) = editor.pick(position_px) else {
        return Tool::Navigate(Navigate::begin(editor, pointer, button));
    };
    editor.problem = None;
    if std::mem::take(&mut editor.wants_pivot) {
        if let Some(id) = editor.selected {
            editor.set_pivot(id, pick.point);
        }
        return Tool::Idle;
    }
    if editor.mode == ToolMode::PaintStiffness {
        return Tool::Stiffness(Box::new(StiffnessStroke::begin(editor, pointer)));
    }
    if editor.mode != ToolMode::Select {
        let stroke = match shape {
            StrokeShape::Component => PaintStroke::begin_without_dab(editor, pointer),
            _ => PaintStroke::begin(editor, pointer),
        };
        let Some(stroke) = stroke else { return Tool::Idle };
        if shape == StrokeShape::Component {
            let part = editor.part_of(pick.vertex);
            stroke.finish_with(editor, part);
            return Tool::Idle;
        }
        return Tool::Paint(Box::new(stroke));
    }
    let Some(Paint::Handle(handle)) = editor.document.paint().get(pick.vertex.index()).copied() else {
        return Tool::Navigate(Navigate::begin(editor, pointer, button));
    };
    if modifiers.ctrl {
        editor.toggle_selected(handle);
        return Tool::Idle;
    }
    if !editor.companions.contains(&handle) {
        editor.companions.clear();
    }
    editor.select(handle);
    match TransformDrag::begin(editor, TransformKind::Move, Constraint::Free, position_px) {
        Some(drag) => Tool::Transform(Box::new(drag.held(button, None))),
        None => Tool::Idle,
    }
}

fn begin_gizmo(editor: &mut Editor, position_px: DVec2, part: GizmoPart) -> Option<Tool> {
    let (kind, constraint) = match part {
        GizmoPart::Centre => (TransformKind::Move, Constraint::Free),
        GizmoPart::Arrow(axis) => (TransformKind::Move, Constraint::Axis(axis)),
        GizmoPart::Square(axis) => (TransformKind::Move, Constraint::Plane(axis)),
        GizmoPart::Ring(axis) => (TransformKind::Turn, Constraint::Axis(axis)),
        GizmoPart::Box(axis) => (TransformKind::Scale, Constraint::Axis(axis)),
    };
    let drag = TransformDrag::begin(editor, kind, constraint, position_px)?;
    Some(Tool::Transform(Box::new(drag.held(Button::Primary, Some(part)))))
}
