//! A stroke that draws a part of the model's outline anew: the outline that it means becomes a handle that follows it.

use glam::{DVec2, DVec3};
use pliant_mesh::{SurfaceVertex, bounding_box};

use super::context::Context;
use super::drawn_path::DrawnPath;
use super::sought_stroke::{Drawing, Outcome, SoughtStroke};
use crate::document::{HandleLine, HandleSketch, Reach};
use crate::input::Pointer;
use crate::jobs::Enclosed;
use crate::outline;
use crate::region::displaced;
use crate::view::View;

/// The distance between two points of the line, in points of the view.
const STEP_PX: f64 = 4.0;

/// A line begins and ends within this distance of the outline that it means, in points.
const NEAR_PX: f64 = 60.0;

/// The reach of the outline in diagonals of its own box.
const REACH: f64 = 0.5;

/// A stroke during its drawing.
#[derive(Debug)]
pub(crate) struct SketchStroke {
    path: DrawnPath,
    /// The line, while a job searches for the outline that it means.
    sketch: Option<HandleSketch>,
}

impl SketchStroke {
    pub(super) fn begin(context: &mut Context<'_>, pointer: Pointer) -> Option<SoughtStroke<Self>> {
        let path = DrawnPath::begin(pointer, STEP_PX);
        SoughtStroke::of_new_handle(context, pointer, Self { path, sketch: None })
    }

    /// The line in the present view.
    fn drawn(&self, view: &View) -> Result<HandleSketch, String> {
        let size_px = view.viewport_px();
        let line = self.path.points_px().iter().map(|px| {
            let share = *px / size_px;
            DVec2::new(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y)
        });
        HandleSketch::new(view.camera().clip_from_world(size_px), line.collect(), 1.0)
    }
}

impl Drawing for SketchStroke {
    fn status(&self) -> Option<String> {
        Some(match self.sketch {
            None => "Drawing the new outline beside the old one: release at its end, Esc to cancel".to_owned(),
            Some(_) => "Finding the outline that the line means: Esc to cancel".to_owned(),
        })
    }

    fn outline_px(&self) -> Vec<DVec2> {
        self.path.as_outline_px()
    }

    fn is_looking(&self) -> bool {
        self.sketch.is_some()
    }

    fn holds_camera(&self) -> bool {
        true
    }

    fn moved(&mut self, _: &mut Context<'_>, pointer: Pointer) {
        self.path.follow(pointer);
    }

    fn released(&mut self, context: &mut Context<'_>) -> Outcome {
        let (Ok(sketch), Some(model)) = (self.drawn(context.view), context.workspace.model().cloned()) else {
            return Outcome::Refuses(
                "That is too short for an outline: draw a longer line beside the one that you see.",
            );
        };
        let displacements = context.workspace.document.from_file().clone();
        let access = &context.workspace.vertex_access;
        let count = model.surface.positions.len();
        let is_open: Vec<bool> = (0..count).map(|vertex| access.may_be_painted(vertex)).collect();
        let (meant, size_px) = (sketch.clone(), context.view.viewport_px());
        let work = Box::new(move |_: &_, cancel: &pliant_mesh::Cancel| {
            cancel.check()?;
            let surface = displaced(&model.surface, &displacements);
            let matched = outline::matched(&meant, &surface, |vertex| is_open[vertex.index()]).unwrap_or_default();
            let begins_at = |end: Option<&(SurfaceVertex, DVec3)>, of_line: DVec2| {
                let seen = end.and_then(|(vertex, _)| meant.seen(surface.positions[vertex.index()]));
                seen.is_some_and(|seen| ((seen - of_line) * 0.5 * size_px).length() <= NEAR_PX)
            };
            let line = meant.line();
            if !begins_at(matched.first(), line[0]) || !begins_at(matched.last(), line[line.len() - 1]) {
                return Ok(Enclosed::default());
            }
            let mut vertices: Vec<SurfaceVertex> = matched.into_iter().map(|(vertex, _)| vertex).collect();
            vertices.sort_unstable();
            Ok(vertices.into())
        });
        context.workspace.jobs.ask(|slots| &mut slots.enclose, work);
        self.sketch = Some(sketch);
        Outcome::Looks
    }

    fn found(&mut self, context: &mut Context<'_>, found: Enclosed) -> Outcome {
        let outline = found.vertices;
        let Some(sketch) = self.sketch.take().filter(|_| !outline.is_empty()) else {
            return Outcome::Refuses(
                "The line leads from no outline to none: begin and end it at the edge of the model that you see.",
            );
        };
        let positions: Vec<DVec3> = outline
            .iter()
            .map(|&vertex| context.workspace.position(vertex))
            .collect();
        let reach = REACH * bounding_box(&positions).map_or(0.0, |bounds| bounds.diagonal());
        Outcome::Ends(Box::new(move |stroke, workspace| {
            stroke.take_with_line(workspace, outline, HandleLine::Sketch(sketch), Reach::Length(reach));
        }))
    }
}
