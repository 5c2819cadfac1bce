//! A lasso or a box over the view: what stands inside of it when the button goes up is painted as a stroke would.

use glam::DVec2;
use pliant_mesh::SurfaceVertex;

use super::Tool;
use super::enclosed::Search;
use super::paint::PaintStroke;
use crate::editor::Editor;
use crate::{Button, JobOutcome, Pointer};

/// How the left button takes vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum StrokeShape {
    /// With the brush.
    #[default]
    Brush,
    /// Within a line drawn freely around them.
    Lasso,
    /// Within a box.
    Box,
    /// All that hang together with the one under the pointer.
    Component,
}

/// How deep a lasso or a box goes.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Depth {
    /// Only what is seen.
    #[default]
    Visible,
    /// Through the surface to its back.
    Through,
}

/// An outline that is being drawn.
#[derive(Debug)]
pub(crate) struct OutlineStroke {
    shape: StrokeShape,
    /// Corners in points of the view.
    points_px: Vec<DVec2>,
    /// What takes the vertices in the end.
    stroke: PaintStroke,
    phase: Phase,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    /// The button is held.
    Drawing,
    /// It was let go, and a job looks for the vertices inside.
    Looking,
}

impl OutlineStroke {
    pub(crate) fn begin(editor: &mut Editor, pointer: Pointer, shape: StrokeShape) -> Option<Self> {
        let stroke = PaintStroke::begin_without_dab(editor, pointer)?;
        Some(Self {
            shape,
            points_px: vec![pointer.position_px],
            stroke,
            phase: Phase::Drawing,
        })
    }

    /// The closed line as it is drawn.
    pub(crate) fn outline_px(&self) -> Vec<DVec2> {
        match (self.shape, self.points_px.as_slice()) {
            (StrokeShape::Box, [from, .., to]) => vec![*from, DVec2::new(to.x, from.y), *to, DVec2::new(from.x, to.y)],
            _ => self.points_px.clone(),
        }
    }

    pub(crate) fn is_looking(&self) -> bool {
        self.phase == Phase::Looking
    }

    pub(crate) fn status(&self) -> String {
        let shape = if self.shape == StrokeShape::Box { "box" } else { "lasso" };
        match self.phase {
            Phase::Drawing => format!("Drawing a {shape}: let go to paint what is inside, Esc to leave it"),
            Phase::Looking => format!("Looking for what is in the {shape}: Esc to leave it"),
        }
    }

    pub(crate) fn moved(mut self: Box<Self>, pointer: Pointer) -> Tool {
        // Not every pixel is a corner.
        if self.phase == Phase::Drawing
            && self
                .points_px
                .last()
                .is_none_or(|last| last.distance(pointer.position_px) >= 2.0)
        {
            if self.shape == StrokeShape::Box {
                self.points_px.truncate(1);
            }
            self.points_px.push(pointer.position_px);
        }
        Tool::Outline(self)
    }

    pub(crate) fn released(self: Box<Self>, editor: &mut Editor, pointer: Pointer, button: Button) -> Tool {
        if button != Button::Primary || self.is_looking() {
            return Tool::Outline(self);
        }
        let Tool::Outline(mut outline) = self.moved(pointer) else {
            return Tool::Idle;
        };
        let Some(search) = Search::of(editor, &outline.outline_px(), editor.depth) else {
            outline.take(editor, Vec::new());
            return Tool::Idle;
        };
        editor
            .engine
            .enclose(Box::new(move |progress, cancel| match search.run(progress, cancel) {
                Ok(vertices) => JobOutcome::Enclosed(vertices),
                Err(_) => JobOutcome::Cancelled,
            }));
        outline.phase = Phase::Looking;
        Tool::Outline(outline)
    }

    /// Paints the vertices inside, and ends.
    pub(crate) fn take(self, editor: &mut Editor, inside: Vec<SurfaceVertex>) {
        self.stroke.finish_with(editor, inside);
    }

    pub(crate) fn abort(self, editor: &mut Editor) {
        editor.engine.stop_enclosing();
        self.stroke.abort(editor);
    }
}
