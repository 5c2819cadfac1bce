//! A lasso or a box over the view: when the button goes up, the vertices inside are painted like those of a stroke.

use glam::DVec2;

use super::context::Context;
use super::enclosed::Search;
use super::mode::StrokeShape;
use super::paint::PaintStroke;
use super::sought_stroke::{Drawing, Outcome, SoughtStroke};
use crate::input::Pointer;
use crate::jobs::Enclosed;

/// An outline during its drawing.
#[derive(Debug)]
pub(crate) struct OutlineStroke {
    shape: StrokeShape,
    /// Corners in points of the view.
    points_px: Vec<DVec2>,
    phase: Phase,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    /// The button is held.
    Drawing,
    /// It was let go, and a job searches for the vertices inside.
    Looking,
}

impl OutlineStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer, shape: StrokeShape) -> Option<SoughtStroke<Self>> {
        let stroke = PaintStroke::begin(context.workspace, context.settings, pointer)?;
        let drawing = Self {
            shape,
            points_px: vec![pointer.position_px],
            phase: Phase::Drawing,
        };
        Some(SoughtStroke::new(stroke, drawing))
    }
}

impl Drawing for OutlineStroke {
    fn status(&self) -> Option<String> {
        let shape = if self.shape == StrokeShape::Box { "box" } else { "lasso" };
        Some(match self.phase {
            Phase::Drawing => format!("Drawing a {shape}: release to paint everything inside, Esc to cancel"),
            Phase::Looking => format!("Finding the vertices in the {shape}: Esc to cancel"),
        })
    }

    fn outline_px(&self) -> Vec<DVec2> {
        match (self.shape, self.points_px.as_slice()) {
            (StrokeShape::Box, [from, .., to]) => vec![*from, DVec2::new(to.x, from.y), *to, DVec2::new(from.x, to.y)],
            _ => self.points_px.clone(),
        }
    }

    fn is_looking(&self) -> bool {
        self.phase == Phase::Looking
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) {
        // Not every pixel is a corner.
        let is_far = |last: &DVec2| last.distance(pointer.position_px) >= 2.0;
        if self.points_px.last().is_none_or(is_far) {
            if self.shape == StrokeShape::Box {
                self.points_px.truncate(1);
            }
            self.points_px.push(pointer.position_px);
        }
    }

    fn released(&mut self, context: &mut Context<'_>) -> Outcome {
        let (outline_px, depth) = (self.outline_px(), context.settings.depth);
        let Some(search) = Search::of(context.workspace, context.view, &outline_px, depth) else {
            return self.found(context, Enclosed::default());
        };
        let work = Box::new(move |progress: &_, cancel: &_| Ok(search.run(progress, cancel)?.into()));
        context.workspace.jobs.ask(|slots| &mut slots.enclose, work);
        self.phase = Phase::Looking;
        Outcome::Looks
    }

    fn found(&mut self, _: &mut Context<'_>, inside: Enclosed) -> Outcome {
        Outcome::Ends(Box::new(move |stroke, workspace| {
            stroke.take(workspace, inside.vertices)
        }))
    }
}
